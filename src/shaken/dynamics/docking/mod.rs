//! Docking experiments: tiles launched towards each other, and how they end.

mod arrival;
mod experiment;
mod map;
mod rate;
mod release;
mod results;
mod starts;

pub use crate::matching::{MatchRule, NoMagnets};
pub use arrival::{Arrival, Arrivals, Caught, MOST_REPEATS, arrivals};
use experiment::Experiment;
pub(super) use experiment::{minimum_below, out_of_contact};
pub use map::{DockingMap, MapCell};
pub use rate::{OnRate, exponential_statistic, poisson_at_least, poisson_interval};
pub use release::{Release, off_rate, releases};
pub use results::{Docking, DockingError, DockingRun, DockingSettings, End, Trap};
pub use starts::{Start, Starts, stream};

use std::time::Instant;

use super::Snapshot;
use tiles::parallel;
use tiles::problem::Problem;

/// Simulates docking. The same problem and settings give the same result on any number of threads.
/// `done` is called after each trajectory.
///
/// # Errors
/// If a setting is invalid, or the target has no magnets to match.
pub fn dock(
    problem: &Problem,
    settings: &DockingSettings,
    done: &(dyn Fn() + Sync),
) -> Result<Docking, DockingError> {
    let experiment = Experiment::new(problem, settings)?;
    let clock = Instant::now();
    let ended: Vec<_> = parallel::map(0..settings.runs, |index| {
        let ended = experiment.run(index);
        done();
        ended
    });
    Ok(experiment.docking(ended, clock.elapsed().as_secs_f64()))
}

/// The snapshots of one trajectory of an experiment, as far as it is solved, at most `interval` (s) apart in
/// free flight.
///
/// # Errors
/// As [`dock`].
pub fn trajectory(
    problem: &Problem,
    settings: &DockingSettings,
    index: usize,
    interval: f64,
) -> Result<Vec<Snapshot>, DockingError> {
    let mut settings = settings.clone();
    settings.motion.longest_step = settings.motion.longest_step.min(interval);
    let experiment = Experiment::new(problem, &settings)?;
    let (start, mut rng) = experiment.start(index);
    let simulation = &experiment.simulation;
    let mut snapshots = vec![simulation.snapshot(&start.motion)];
    let mut last = None;
    simulation.run(&start.motion, settings.duration, &mut rng, &mut |now| {
        let earlier = snapshots.last().map_or(0.0, |s: &Snapshot| s.time);
        if now.time - earlier >= 0.5 * interval {
            snapshots.push(*now);
        }
        last = Some(*now);
        false
    });
    snapshots.extend(last.filter(|last| snapshots.last() != Some(last)));
    Ok(snapshots)
}
