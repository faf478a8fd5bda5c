//! Rates out of states over kT, and what corner wells in closed form say of them.

use super::{Motion, Place};
use jobs::design::Design;
use physics::kinetics::corner;
use physics::kinetics::rates::{RateSettings, Rates, rates};
use physics::parallel;
use physics::problem::Problem;

/// kT over the one asked for.
const SHAKINGS: [f64; 5] = [0.6, 0.8, 1.0, 1.3, 1.7];
/// Meshes of pictures: the committors' relative error, and unknowns at most.
const ROUGH: (f64, usize) = (0.04, 12_000);

/// Rates out of states at one kT.
#[derive(Clone, Debug, PartialEq)]
pub struct AtKt {
    /// kT (J).
    pub kt: f64,
    /// Out of each state (1/s), on a rough mesh; `None` where the states are none at this kT.
    pub leaving: Vec<Option<f64>>,
    /// The same capacities over the closed form of corner wells, see [`corner`]; `None` where contact
    /// holds the tile in no such way. Ways to free have no pass, whose closed form it could take.
    pub corner: Vec<Option<f64>>,
}

/// The rates out of states at some kT about the one asked for, at which `known` are the rates.
pub fn over_kt(
    design: &Design,
    problem: &Problem,
    places: &[Place],
    (asked, known): (&RateSettings, &Rates),
    motion: &Motion,
) -> Vec<AtKt> {
    let energies = places.iter().map(|place| place.energy);
    let lowest = energies.fold(f64::INFINITY, f64::min);
    let at = |share: &f64| {
        let kt = share * asked.kt;
        let settings = RateSettings {
            kt,
            tolerance: ROUGH.0,
            unknowns: ROUGH.1,
            certify: None,
            map: None,
            ..asked.clone()
        };
        let motion = Motion::new(design, kt, motion.drag);
        let found = match *share {
            1.0 => Some(known.clone()),
            _ => rates(problem, &settings).ok(),
        };
        let finest = found.as_ref().map(Rates::finest);
        let rate = |place: usize| -> Option<f64> {
            // Where no way was found nothing is known.
            found.as_ref().filter(|found| found.is_known_out(place))?;
            Some(finest?.rates[place].iter().sum::<f64>() * motion.diffusion)
        };
        let by_corner = |place: usize| -> Option<f64> {
            let own = &places[place];
            let closed = corner::volume(problem, &own.at, kt)? * own.copies as f64;
            let volume = finest?.volumes[place] * libm::exp((own.energy - lowest) / kt);
            Some(rate(place)? * volume / closed)
        };
        AtKt {
            kt,
            leaving: (0..places.len()).map(rate).collect(),
            corner: (0..places.len()).map(by_corner).collect(),
        }
    };
    parallel::map(&SHAKINGS[..], at)
}
