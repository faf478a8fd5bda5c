//! Rates of states over a range of kT, compared with closed forms for corner wells.

use super::diffusion;
use super::table::{AtKt, StateRates};
use crate::design::Design;
use physics::kinetics::corner;
use physics::kinetics::rates::{RateSettings, Rates, rates};
use physics::parallel;
use physics::problem::Problem;

/// Ratios to the requested kT.
const SHAKINGS: [f64; 5] = [0.6, 0.8, 1.0, 1.3, 1.7];
/// Meshes for plots: the committors' relative error, and the largest number of unknowns.
const ROUGH: (f64, usize) = (0.04, 12_000);

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
                certify: None,
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
}
