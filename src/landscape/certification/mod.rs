//! Certified bounds for the barriers of an inventory.

mod joined;

use std::time::{Duration, Instant};

use super::certificate::{Bracket, Certifier, Effort, End};
use super::inventory::{Inventory, LEAST_GAIN};
use super::pathway;
use super::results::{Barrier, Place, StateKind, highest_point};
use crate::configuration::Configuration;
use crate::observer::Observer;
use crate::potential::Unbounded;
use crate::problem::Problem;

/// Cells spent on narrowing the bounds of a small barrier further.
const MORE_CELLS: usize = 20_000;
/// Bounds are narrowed to this share of the bond's depth, and to this share of the barrier, but not
/// below that share of the bond's depth.
const SHARE_OF_BOND: f64 = 0.01;
const SHARE_OF_BARRIER: f64 = 0.05;
const LEAST_SHARE: f64 = 1e-5;
/// Energy tolerance of pathways, as a fraction of the bond's depth.
const BEND: f64 = 1e-3;

/// How barriers are certified.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CertificationSettings {
    /// Width (J) to which bounds are narrowed; where `None`, a hundredth of the bond or a twentieth
    /// of the barrier, whichever is less.
    pub tolerance: Option<f64>,
    /// Time (s) after which the bounds known by then are kept; 0 for no certificate.
    pub seconds: f64,
    /// Cells spent on the bounds of one barrier at most.
    pub cells: usize,
    /// Which barriers are certified.
    pub claims: Claims,
}

/// The barriers of which more is claimed than the roadmap's estimate: they are certified, and
/// checked by moving tiles where that is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claims {
    /// All that are reported.
    All,
    /// The ways out of the bond to `free` and out of the deepest trap.
    BondAndDeepestTrap,
}

impl Claims {
    /// Whether a barrier of an inventory is among them.
    pub fn include(self, barrier: &Barrier, inventory: &Inventory) -> bool {
        let is_from = |kind| {
            let first = inventory.first(kind).map(|state| Place::State(state.id));
            first == Some(barrier.from)
        };
        let is_out_of_the_bond = is_from(StateKind::Bond) && barrier.to == Place::Free;
        self == Self::All || is_out_of_the_bond || is_from(StateKind::Trap)
    }
}

/// Why barriers have no certified bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Uncertified {
    /// None was asked for.
    #[error("no time was given to the certificate")]
    NoTime,
    /// None can be.
    #[error(transparent)]
    Unbounded(#[from] Unbounded),
}

/// Brackets every barrier of an inventory between two bounds that hold for the model, and takes
/// over pathways of the certificate that lie lower. Where the bound state has no way to `free`, a
/// proof is tried that there is none. Returns the number of cells assessed.
///
/// Only results within the time limit are the same on every machine.
///
/// # Errors
/// Where nothing is certified; the inventory is then left as it is.
pub fn certify(
    problem: &Problem,
    inventory: &mut Inventory,
    settings: &CertificationSettings,
    observer: &dyn Observer,
) -> Result<usize, Uncertified> {
    let bounds = problem.bounds()?;
    let limit = Duration::from_secs_f64(settings.seconds.clamp(0.0, 1e9));
    if limit.is_zero() {
        return Err(Uncertified::NoTime);
    }
    let depth = problem.depth();
    let mut certifier = Certifier::new(bounds, problem.contact.as_ref(), &problem.space);
    let since = Instant::now();
    let count = inventory.barriers.len();
    let passes: &[Pass] = match settings.tolerance {
        Some(tolerance) => &[(settings.cells, &move |_| tolerance)],
        None => &[
            (settings.cells, &|_| SHARE_OF_BOND * depth),
            (MORE_CELLS.min(settings.cells), &|barrier| {
                narrow_width(barrier, depth)
            }),
        ],
    };
    for (pass, (cells, width)) in passes.iter().enumerate() {
        for number in 0..count {
            observer.part("certificate", pass * count + number, passes.len() * count);
            let barrier = &inventory.barriers[number];
            if !settings.claims.include(barrier, inventory) {
                continue;
            }
            let effort = Effort {
                tolerance: width(barrier),
                cells: *cells,
                time: Some(limit.saturating_sub(since.elapsed())),
            };
            if barrier.bounds.width() <= effort.tolerance {
                continue;
            }
            if let Some(bracket) = bracket(&mut certifier, inventory, barrier, &effort) {
                let barrier = &mut inventory.barriers[number];
                take_over(problem, barrier, &bracket, BEND * depth);
            }
        }
        joined::take_over_chains(&problem.space, inventory, LEAST_GAIN * depth);
    }
    Ok(certifier.assessed())
}

/// Cells spent on a barrier at most, and the width (J) that its bounds are to have.
type Pass<'a> = (usize, &'a dyn Fn(&Barrier) -> f64);

fn bracket(
    certifier: &mut Certifier,
    inventory: &Inventory,
    barrier: &Barrier,
    effort: &Effort,
) -> Option<Bracket> {
    let Place::State(from) = barrier.from else {
        return None;
    };
    let start = inventory.states[from].configuration;
    let to = match barrier.to {
        Place::State(to) => End::At(inventory.states[to].configuration),
        Place::Free => End::Free,
    };
    let known: Vec<Configuration> = barrier.pathway.iter().map(|p| p.configuration).collect();
    certifier.bracket(&start, &to, &known, effort).ok()
}

/// Width (J) that tells something of a barrier much smaller than the bond, too.
fn narrow_width(barrier: &Barrier, depth: f64) -> f64 {
    let of_barrier = (SHARE_OF_BARRIER * barrier.forward()).max(LEAST_SHARE * depth);
    of_barrier.min(SHARE_OF_BOND * depth)
}

fn take_over(problem: &Problem, barrier: &mut Barrier, bracket: &Bracket, bend: f64) {
    barrier.bounds.tighten(bracket.bounds);
    // In place of a pathway that could not be proved the certificate's own may lie higher.
    let lower = |upper: &f64| bracket.improved && *upper < barrier.saddle_energy;
    let Some(upper) = bracket.bounds.upper.filter(lower) else {
        return;
    };
    // The certificate's own leads through the middles of its cells.
    let direct = pathway::shortened(problem, &bracket.pathway, upper, 0.1 * bend);
    for points in [&direct, &bracket.pathway] {
        let pathway = pathway::of_configurations(problem, points, bend);
        if highest_point(&pathway).is_some_and(|highest| highest.energy <= upper) {
            barrier.lead_along(pathway);
            return;
        }
    }
}
