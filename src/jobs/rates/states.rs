//! The states for which rates are reported.

use crate::pipeline::Analysis;
use physics::configuration::Configuration;
use physics::kinetics::rates::Basin;
use physics::landscape::Place;

/// States whose energies differ by less than this share are twins.
const TWINS: f64 = 1e-6;

/// A state with rates.
#[derive(Clone, Debug, PartialEq)]
pub struct RatedState {
    /// Its letter.
    pub name: String,
    /// The minimum.
    pub at: Configuration,
    /// Its energy (J).
    pub energy: f64,
    /// Upper energy limit (J) of its basin.
    pub below: f64,
    /// Number of its symmetric copies.
    pub copies: usize,
}

impl RatedState {
    /// The bond and at most the given number of the deepest traps that hold a tile at kT (J). The
    /// bond's basin is below `basin_energy` (J) if that is given, else half way up to its lowest
    /// barrier, like others. Twins that are not separated by a barrier share the first one's basin.
    pub fn held(
        analysis: &Analysis,
        kt: f64,
        traps: usize,
        basin_energy: Option<f64>,
    ) -> Vec<Self> {
        let catalogue = &analysis.catalogue;
        let mut held: Vec<Self> = Vec::new();
        let mut passes: Vec<f64> = Vec::new();
        for kind in catalogue.kinds() {
            let state = kind.first();
            let Some(escape) = analysis.escape(state.id) else {
                continue;
            };
            // If no path is known, its height is assumed to be that of free tiles.
            let known = escape.forward();
            let barrier = if known.is_finite() {
                known
            } else {
                -state.energy
            };
            let sideways = state.sideways.map(|pass| pass - state.energy);
            let is_apart = sideways.is_none_or(|height| Basin::holds(height, kt));
            let is_twin = |other: &Self| (other.energy / state.energy - 1.0).abs() < TWINS;
            let holds = kind.is_bond() || Basin::holds(barrier, kt);
            if !holds || !is_apart && held.iter().any(is_twin) {
                continue;
            }
            let height = sideways.filter(|_| is_apart).unwrap_or(barrier);
            let usual = Basin::of_state(state.configuration, state.energy, height);
            let given = basin_energy.filter(|_| kind.is_bond());
            passes.push(state.energy + barrier);
            held.push(Self {
                name: catalogue.name_of(Place::State(state.id)),
                at: state.configuration,
                energy: state.energy,
                below: given.unwrap_or(usual.below),
                copies: kind.copies(),
            });
            if held.len() > traps {
                break;
            }
        }
        let first = usize::from(basin_energy.is_some());
        Self::keep_apart(&mut held, &passes, first);
        held
    }

    /// Lowers basins, from index `first` on, that extend over the pass (J) of another state's exit.
    fn keep_apart(held: &mut [Self], passes: &[f64], first: usize) {
        for (own, state) in held.iter_mut().enumerate().skip(first) {
            let others = passes.iter().enumerate().filter(|(other, _)| *other != own);
            let lowest = others.map(|(_, pass)| *pass).fold(f64::INFINITY, f64::min);
            if lowest > state.energy && lowest <= state.below {
                state.below = Basin::of_state(state.at, state.energy, lowest - state.energy).below;
            }
        }
    }

    /// Its basin.
    pub fn basin(&self) -> Basin {
        Basin {
            at: self.at,
            below: self.below,
        }
    }
}
