//! Refines a mesh until the bounds are as close to each other as requested.

use super::field::{DIVIDED, Field};
use super::results::{Certify, MeshRates};

/// Additional share of the error that is refined near the goal.
const MARGIN: f64 = 0.1;

/// The bounds of one mesh.
pub(super) struct Step {
    /// From below and above.
    pub bounds: Vec<[f64; 2]>,
    /// The indices of the bounds that must be narrow.
    pub deciding: Vec<usize>,
    /// Corners of the mesh.
    pub unknowns: usize,
    /// The contribution of each cell to the width.
    pub shares: Vec<f64>,
    /// Values between the bounds, of rates.
    pub rates: Option<MeshRates>,
}

/// Refines a mesh until bounds are as narrow as requested, or it has too many unknowns. Returns the
/// bounds of all meshes, which are valid independently; empty if there are no bounds.
///
/// # Errors
/// The errors of a step.
pub(super) fn narrowed<E>(
    field: &mut Field,
    certify: &Certify,
    step: impl Fn(&mut Field) -> Result<Option<Step>, E>,
) -> Result<Vec<Step>, E> {
    let goal = certify.distance;
    let mut all: Vec<Step> = Vec::new();
    loop {
        let Some(found) = step(field)? else {
            return Ok(Vec::new());
        };
        let deciding = found.deciding.iter().map(|&at| found.bounds[at]);
        let distances = deciding.map(|[lower, upper]| upper / lower - 1.0);
        // NaN counts as far.
        let farthest = distances.fold(0.0, |far: f64, one| if one <= far { far } else { one });
        let is_done = farthest <= goal || found.unknowns > certify.unknowns;
        // Cells that are divided keep about a third of their share.
        let missing = 1.5 * (1.0 - goal / farthest) + MARGIN;
        let part = if missing < DIVIDED { missing } else { DIVIDED };
        let is_done = is_done || !field.refine(&found.shares, part);
        all.push(found);
        if is_done {
            return Ok(all);
        }
    }
}
