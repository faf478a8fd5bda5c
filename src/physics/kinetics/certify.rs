//! Refines a mesh until the bounds are as close to each other as requested.

use super::field::{DIVIDED, Field};
use super::results::{Certify, MeshRates};
use crate::potential::MagnetModel;
use crate::problem::Problem;

/// Additional share of the error that is refined near the goal.
const MARGIN: f64 = 0.1;

/// Why nothing is proved for blocks.
const BLOCKS_HAVE_NO_PROOF: &str = "for blocks nothing can be proved here: the bounds on their \
    energy in contact are too wide; use the dipole model, or leave out --prove";

/// Why nothing can be proved for a pair of tiles with this magnet model, independent of their
/// shapes; `None` if it can be tried.
pub fn why_unprovable(problem: &Problem, model: MagnetModel) -> Option<String> {
    if model == MagnetModel::Cuboid {
        return Some(BLOCKS_HAVE_NO_PROOF.to_owned());
    }
    let why = problem.bounds().err()?;
    Some(format!(
        "nothing can be proved here: {why}; leave out --prove"
    ))
}

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
    let goal = certify.on_mesh();
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
