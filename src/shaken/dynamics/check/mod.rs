//! A check of barriers that is independent of the roadmap: trajectories of moving tiles must not
//! contradict them.
//!
//! A barrier states that every free path from a state to another place reaches at least the
//! saddle's energy. A tile without drag conserves its energy, so one that starts in the state's
//! basin with less total energy (kinetic and potential) never reaches the other place, whatever its
//! collisions and rotations. Three tests are made for each barrier:
//!
//! - **Below.** Many trajectories with less total energy than the barrier's certified lower bound
//!   ([`Below`]); none may cross. As a control, further trajectories start with that much more
//!   energy, and their crossings are counted as well ([`BarrierCheck::above`]).
//! - **Sides.** A tile released at rest on the pathway on either side of the saddle, just below the
//!   certified energy and with light drag, ends at the pathway's end on that side ([`Side`]).
//! - **Kick.** The smallest of a series of kicks along the pathway's beginning that expels the tile
//!   has at least the barrier's energy ([`BarrierCheck::kick`]).
//!
//! # What counts as below, and what as free
//!
//! Energy alone does not determine on which side of a barrier a configuration lies, and `free` is
//! not an energy level: tiles just out of each other's reach still attract or repel by some µJ, so
//! a barrier to `free` may be below 0 and below the energy of far configurations. Therefore
//!
//! - a start is on the pathway before it first reaches the start's total energy, so that it is
//!   connected to the state by a free path below the barrier: it is in the basin, not merely low in
//!   energy;
//! - `free` is the same set as in the roadmap and the certificate: the configurations whose
//!   reference points are at least [`free_distance`](tiles::ConfigurationSpace::free_distance)
//!   apart; a trajectory crosses when it enters that set, with any energy;
//! - another state is entered when overdamped motion leads from the tile's configuration into its
//!   minimum, along a path that never climbs (tested if a rough descent also leads there);
//! - the rim keeps the reference point on the table, as in the certificate, and collisions only
//!   dissipate energy. A trajectory that the integration error raises to the barrier proves
//!   nothing: it is counted as spoilt and replaced.
//!
//! With these definitions a crossing is a path below the lower bound: either the bound or this
//! simulation is wrong. If a barrier has no certified bound, trajectories stay below its saddle
//! energy less its convergence tolerance, and a crossing only shows that the estimate was too high
//! ([`BarrierCheck::is_overestimated`]).

mod checker;
mod results;

use super::Body;
use checker::Checker;
use landscape::minimum::{Known, learn};
use landscape::{Barrier, Place, State};
pub use results::{BarrierCheck, Below, CheckSettings, Side, SideVerdict};
use tiles::configuration::Configuration;
use tiles::parallel;
use tiles::problem::Problem;

/// Largest number of overdamped motions followed from each pathway.
const SLOW: usize = 16;

/// Checks the barriers that lead out of a state: those with a pathway, and those proved to be
/// without one. `done` is called after each barrier with the number of finished ones and of all.
///
/// The same arguments give the same result on any number of threads. A trajectory below a barrier
/// takes a few hundred steps: 15 cm at the speed of a tile with the barrier's energy, in steps of
/// at most 0.5 mm.
pub fn check(
    problem: &Problem,
    body: Body,
    states: &[State],
    barriers: &[&Barrier],
    settings: &CheckSettings,
    done: &(dyn Fn(usize, usize) + Sync),
) -> Vec<BarrierCheck> {
    let chosen: Vec<(usize, &Barrier)> = barriers
        .iter()
        .copied()
        .enumerate()
        .filter(|(_, barrier)| is_checkable(barrier))
        .collect();
    let known = slides_below(problem, states, &chosen);
    let checked = std::sync::atomic::AtomicUsize::new(0);
    parallel::map(&chosen, |&(number, barrier)| {
        let checker = Checker::new(problem, body, (states, &known), barrier, settings);
        let check = checker.check(settings.seed.wrapping_add(number as u64));
        let before = checked.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        done(before + 1, chosen.len());
        check
    })
}

/// The overdamped motions down from the pathways: trajectories end on the same ones.
fn slides_below(problem: &Problem, states: &[State], barriers: &[(usize, &Barrier)]) -> Known {
    let mut known = Known::minima(states.iter().map(|state| state.configuration));
    let points = barriers.iter().flat_map(|(_, barrier)| {
        let every = barrier.pathway.len().div_ceil(SLOW).max(1);
        barrier.pathway.iter().step_by(every)
    });
    let starts: Vec<Configuration> = points.map(|point| point.configuration).collect();
    learn(problem, &starts, &mut known, &|_| ());
    known
}

fn is_checkable(barrier: &Barrier) -> bool {
    matches!(barrier.from, Place::State(_))
        && (barrier.bounds.caged || (barrier.pathway.len() > 1 && barrier.forward() > 0.0))
}
