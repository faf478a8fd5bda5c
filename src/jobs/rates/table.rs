//! Rates between states and `free`, and quantities derived from them.

use nalgebra::DMatrix;

use super::diffusion;
use super::states::RatedState;
use crate::design::Design;
use physics::kinetics::population::chain::Chain;
use physics::kinetics::rates::map::Map;
use physics::kinetics::rates::{RateSettings, Rates, rates};
use physics::kinetics::{PathToFree, bond::corner};
use physics::parallel;
use physics::problem::Problem;

/// Ratios to the requested kT.
const SHAKINGS: [f64; 5] = [0.6, 0.8, 1.0, 1.3, 1.7];
/// Meshes for plots: the committors' relative error, and the largest number of unknowns.
const ROUGH: (f64, usize) = (0.04, 12_000);

/// Rates out of states at one kT.
#[derive(Clone, Debug, PartialEq)]
pub struct AtKt {
    /// kT (J).
    pub kt: f64,
    /// Rates out of each state (1/s), on a coarse mesh; `None` if it is not a state at this kT.
    pub leaving: Vec<Option<f64>>,
    /// Ratios of the same capacities to the closed form of corner wells, see
    /// [`physics::kinetics::bond::corner`]; `None` if the well is not of this kind. Paths to free have no
    /// pass for which there is a closed form.
    pub corner: Vec<Option<f64>>,
}

/// Rates between places: the states in order, and last `free`.
#[derive(Clone, Debug, PartialEq)]
pub struct StateRates {
    /// The request.
    pub asked: RateSettings,
    /// Drag rate c / mass (1/s).
    pub drag: f64,
    /// D = kT / c (m^2/s).
    pub diffusion: f64,
    /// The states, in the order of the requested basins.
    pub states: Vec<RatedState>,
    /// The results.
    pub found: Rates,
    /// Rates out of the states at other kT; empty if not requested.
    pub over_kt: Vec<AtKt>,
}

impl StateRates {
    /// The rates out of states at several kT around the requested one.
    pub(super) fn at_other_kts(&self, design: &Design, problem: &Problem) -> Vec<AtKt> {
        let energies = self.states.iter().map(|state| state.energy);
        let lowest = energies.fold(f64::INFINITY, f64::min);
        let at = |share: &f64| {
            let kt = share * self.asked.kt;
            let settings = RateSettings {
                kt,
                tolerance: ROUGH.0,
                unknowns: ROUGH.1,
                map: None,
                ..self.asked.clone()
            };
            let diffusion = diffusion(design, kt, self.drag);
            let found = match *share {
                1.0 => Some(self.found.clone()),
                _ => rates(problem, &settings).ok(),
            };
            let finest = found.as_ref().map(Rates::finest);
            let rate = |state: usize| -> Option<f64> {
                // If no path was found, nothing is known.
                found.as_ref().filter(|found| found.is_known_out(state))?;
                Some(finest?.rates[state].iter().sum::<f64>() * diffusion)
            };
            let by_corner = |state: usize| -> Option<f64> {
                let own = &self.states[state];
                let closed = corner::volume(problem, &own.at, kt)? * own.copies as f64;
                let volume = finest?.volumes[state] * libm::exp((own.energy - lowest) / kt);
                Some(rate(state)? * volume / closed)
            };
            AtKt {
                kt,
                leaving: (0..self.states.len()).map(rate).collect(),
                corner: (0..self.states.len()).map(by_corner).collect(),
            }
        };
        parallel::map(&SHAKINGS[..], at)
    }

    /// The number of places, including `free`.
    pub fn count(&self) -> usize {
        self.states.len() + 1
    }

    /// The name of a place.
    pub fn name(&self, place: usize) -> &str {
        self.states.get(place).map_or("free", |state| &state.name)
    }

    /// All ordered pairs of places.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize)> {
        let count = self.count();
        (0..count).flat_map(move |i| (0..count).filter(move |j| *j != i).map(move |j| (i, j)))
    }

    /// The map of the committor, if tiles reach the bond at all.
    pub fn map(&self) -> Option<&Map> {
        let bind = self.known_rate(self.states.len(), 0)?;
        self.found.map.as_ref().filter(|_| bind > 0.0)
    }

    /// Rate (1/s) from one place to another, if known.
    pub fn known_rate(&self, from: usize, to: usize) -> Option<f64> {
        let is_known = self.found.is_known(from, to);
        is_known.then(|| self.rate(from, to))
    }

    /// Rate (1/s) out of a place, if known.
    pub fn known_rate_out(&self, from: usize) -> Option<f64> {
        let is_known = self.found.is_known_out(from);
        is_known.then(|| self.rate_out(from))
    }

    /// A share of time spent in or around a place, if known: a basin without a path may lie between
    /// contacts where the mesh has no cell.
    pub fn known_share(&self, place: usize, part: f64) -> Option<f64> {
        let is_known = place == self.states.len() || self.found.ways[place] != PathToFree::Lost;
        is_known.then_some(part)
    }

    /// The probability that one place is the first one reached from another.
    pub fn first(&self, from: usize, to: usize) -> Option<f64> {
        let share = self.known_rate(from, to)? / self.known_rate_out(from)?;
        Some(share).filter(|share| share.is_finite())
    }

    /// Rate (1/s) from one place to another, 0 if no path is known.
    pub fn rate(&self, from: usize, to: usize) -> f64 {
        self.found.finest().rates[from][to] * self.diffusion
    }

    /// The rate (1/s) out of a place, 0 if no path is known.
    pub fn rate_out(&self, from: usize) -> f64 {
        (0..self.count()).map(|to| self.rate(from, to)).sum()
    }

    /// The relative error of a rate, estimated from meshes.
    pub fn error(&self, from: usize, to: usize) -> f64 {
        let spread = Some(self.found.spread(from, to)).filter(|spread| spread.is_finite());
        spread.unwrap_or(0.0).max(self.found.error())
    }

    /// The mean time (s) from one place to another, by any path; time outside of all places does
    /// not count.
    pub fn mean_first_passage(&self, from: usize, to: usize) -> f64 {
        let rate = |i: usize, j: usize| self.rate(i, j);
        let chain = Chain::new(DMatrix::from_fn(self.count(), self.count(), rate));
        chain.mean_times(&[to])[from]
    }
}
