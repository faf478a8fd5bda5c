//! The states that rates are told of.

use crate::configuration::Configuration;
use crate::kinetics::rates::Basin;
use crate::landscape;
use crate::pipeline::Analysis;

/// A state with rates.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// What people call it.
    pub name: String,
    /// The minimum.
    pub at: Configuration,
    /// Its energy (J).
    pub energy: f64,
    /// Its basin is where U is lower (J).
    pub below: f64,
    /// How many states the pair's symmetries make of it.
    pub copies: usize,
}

impl Place {
    /// The bond and the deepest traps, so many at most, that hold at kT (J). The bond's basin is
    /// below `basin_energy` (J) if that is given, else half way up to its lowest barrier as others.
    pub fn held(
        analysis: &Analysis,
        kt: f64,
        traps: usize,
        basin_energy: Option<f64>,
    ) -> Vec<Self> {
        let inventory = &analysis.inventory;
        let held = inventory.kinds().filter_map(|kind| {
            let state = kind.first();
            let barrier = analysis.escape(state.id)?.forward();
            let holds = kind.is_bond() || Basin::holds(barrier, kt);
            let usual = Basin::of_state(state.configuration, state.energy, barrier);
            let given = basin_energy.filter(|_| kind.is_bond());
            holds.then(|| Self {
                name: inventory.name_of(landscape::Place::State(state.id)),
                at: state.configuration,
                energy: state.energy,
                below: given.unwrap_or(usual.below),
                copies: kind.copies(),
            })
        });
        held.take(1 + traps).collect()
    }

    /// Its basin.
    pub fn basin(&self) -> Basin {
        Basin {
            at: self.at,
            below: self.below,
        }
    }
}
