//! Meshes refined until bounds are as near each other as asked.

use super::field::{DIVIDED, Field};
use super::proof::Closeness;
use super::rates::MeshRates;
use crate::potential::MagnetModel;
use crate::problem::Problem;

/// Near the goal so much more of the error is divided than should do.
const MARGIN: f64 = 0.1;

/// How near each other bounds are asked to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certify {
    /// Their distance as a share of the lower one.
    pub distance: f64,
    /// Unknowns up to which meshes are refined for it.
    pub unknowns: usize,
    /// Pieces of cells, at most, in which integrals are enclosed to prove bounds; 0 for no proof.
    pub pieces: usize,
}

/// Why nothing is proved of blocks.
const BLOCKS_HAVE_NO_PROOF: &str = "of blocks nothing can be proved here: where they touch their \
    energy is not enclosed closely enough; ask for the model dipole, or for no proof";

/// Why nothing can be proved of a pair of tiles whose magnets are modelled so, whatever their shapes;
/// `None` where it can be tried.
pub fn why_unprovable(problem: &Problem, model: MagnetModel) -> Option<String> {
    if model == MagnetModel::Cuboid {
        return Some(BLOCKS_HAVE_NO_PROOF.to_owned());
    }
    let why = problem.bounds().err()?;
    Some(format!(
        "nothing can be proved here: {why}; ask for no proof"
    ))
}

/// Where bounds are to be proved they are no farther apart on the mesh: fluxes are laid in the same
/// way all over it then, and cost more.
const TO_PROVE: f64 = 0.5;
/// Share of the distance asked for that integrals' enclosures may take.
const OF_INTEGRALS: f64 = 0.5;

impl Default for Certify {
    /// As near as it comes within seconds.
    fn default() -> Self {
        Self {
            distance: 0.1,
            unknowns: 60_000,
            pieces: 0,
        }
    }
}

impl Certify {
    /// The same for an exit, which asks for fewer functions.
    pub fn of_exit() -> Self {
        Self {
            unknowns: 80_000,
            ..Self::default()
        }
    }

    /// So near, if that can be had at all.
    pub fn to(distance: f64) -> Self {
        Self {
            distance,
            unknowns: 400_000,
            pieces: 0,
        }
    }

    /// The same, with what can be proved.
    pub fn proved(self) -> Self {
        Self {
            pieces: 800_000,
            ..self
        }
    }

    /// How near each other bounds are to be on a mesh.
    fn on_mesh(&self) -> f64 {
        match self.pieces {
            0 => self.distance,
            _ => self.distance.min(TO_PROVE),
        }
    }

    /// How closely integrals are to be enclosed, if bounds are to be proved.
    pub(super) fn proof(&self) -> Option<Closeness> {
        (self.pieces > 0).then_some(Closeness {
            apart: OF_INTEGRALS * self.distance,
            pieces: self.pieces,
        })
    }
}

/// What one mesh says.
pub(super) struct Step {
    /// From below and above.
    pub bounds: Vec<[f64; 2]>,
    /// Those that should be narrow.
    pub deciding: Vec<usize>,
    /// Corners of the mesh.
    pub unknowns: usize,
    /// What refining the cells may bring.
    pub shares: Vec<f64>,
    /// Values between the bounds, of rates.
    pub rates: Option<MeshRates>,
}

/// Refines a mesh until bounds are as narrow as asked, or it has too many unknowns. Gives the
/// steps of all meshes, each of whose bounds hold by themselves; none where there are no bounds.
///
/// # Errors
/// Those of a step.
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
        // What is no number is far, too.
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
