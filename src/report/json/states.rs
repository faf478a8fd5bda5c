//! The states, and how often tiles end in them.

use serde::Serialize;

use super::{BarrierEntry, pose, positive_zero};
use crate::design::Design;
use crate::landscape::{Barrier, Proportion, State, StateKind};
use crate::pipeline::Analysis;
use crate::tile::Tile;

/// A local minimum.
#[derive(Debug, Serialize)]
#[allow(non_snake_case)]
pub struct StateEntry {
    pub id: usize,
    pub kind: &'static str,
    pub pose: [f64; 3],
    pub energy_J: f64,
    /// Energy of uniformly magnetised blocks in this pose, where `energy_J` is that of point
    /// dipoles; null otherwise.
    pub block_energy_J: Option<f64>,
    /// Lowest id among the states that symmetries of the tiles map onto this one.
    pub class: usize,
    /// How many states there are in the class.
    pub copies: usize,
    /// Names of the faces in contact: of the fixed tile, of the moving tile.
    pub faces: Vec<[String; 2]>,
    pub attracting: usize,
    pub repelling: usize,
    pub capture: Option<ProportionEntry>,
    /// Barrier to the nearest lower state or to free; null where no way out was found.
    pub escape: Option<BarrierEntry>,
}

/// What is said of the tiles apart.
#[derive(Debug, Serialize)]
#[allow(non_snake_case)]
pub struct FreeEntry {
    /// Share of the far starts that ended in no state.
    pub capture: ProportionEntry,
    /// Inner and outer radius of the ring from which the far starts are drawn.
    pub ring_m: [f64; 2],
}

/// A sampled proportion with its 95 % Wilson interval.
#[derive(Debug, Serialize)]
pub struct ProportionEntry {
    pub share: f64,
    pub low: f64,
    pub high: f64,
    pub count: usize,
    pub of: usize,
}

impl StateEntry {
    pub(super) fn new(
        design: &Design,
        state: &State,
        all: &[State],
        escape: Option<&Barrier>,
    ) -> Self {
        Self {
            id: state.id,
            kind: kind(state.kind),
            pose: pose(&state.configuration),
            energy_J: positive_zero(state.energy),
            block_energy_J: state.block_energy,
            class: state.class,
            copies: copies(state, all),
            faces: face_names(design, state),
            attracting: state.attracting,
            repelling: state.repelling,
            capture: state.capture.as_ref().map(ProportionEntry::from),
            escape: escape.map(BarrierEntry::new),
        }
    }
}

impl FreeEntry {
    pub(super) fn new(analysis: &Analysis) -> Self {
        Self {
            capture: (&analysis.uncaptured).into(),
            ring_m: analysis.ring,
        }
    }
}

/// What a kind of state is called.
pub fn kind(kind: StateKind) -> &'static str {
    match kind {
        StateKind::Bound => "bound",
        StateKind::Misbound => "misbound",
    }
}

/// How many states there are in the class of one.
pub fn copies(state: &State, all: &[State]) -> usize {
    all.iter()
        .filter(|other| other.class == state.class)
        .count()
}

/// Names of the faces in contact: of the fixed tile, of the moving tile.
pub fn face_names(design: &Design, state: &State) -> Vec<[String; 2]> {
    let name = |tile: &Tile, i: usize| tile.faces[i].name.clone();
    state
        .faces
        .iter()
        .map(|&(f, m)| [name(&design.pair.fixed, f), name(&design.pair.moving, m)])
        .collect()
}

impl From<&Proportion> for ProportionEntry {
    fn from(proportion: &Proportion) -> Self {
        Self {
            share: proportion.share(),
            low: proportion.low,
            high: proportion.high,
            count: proportion.count,
            of: proportion.of,
        }
    }
}
