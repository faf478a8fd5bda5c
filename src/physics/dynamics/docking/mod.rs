//! Docking experiments: tiles launched towards each other, and how they end.

mod experiment;
mod map;
mod matching;
mod rate;
mod release;
mod starts;

use experiment::Experiment;
pub(super) use experiment::{minimum_below, out_of_contact};
pub use map::{DockingMap, MapCell};
pub use matching::MatchRule;
pub use rate::{OnRate, exponential_statistic, poisson_interval};
pub use release::{Release, off_rate, releases};
pub use starts::{Start, Starts, stream};

use std::time::Instant;

use super::{MotionSettings, SettingsError, Snapshot};
use crate::configuration::Configuration;
use crate::landscape::Proportion;
use crate::parallel;
use crate::problem::Problem;

/// The settings of a docking experiment.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DockingSettings {
    /// Number of trajectories.
    pub runs: usize,
    /// The seed of all random numbers.
    pub seed: u64,
    /// Duration of each trajectory (s).
    pub duration: f64,
    /// The distribution of starts.
    pub starts: Starts,
    /// The settings of the motion.
    pub motion: MotionSettings,
    /// Threshold of a match (m); see [`MatchRule::new`] if `None`.
    pub threshold: Option<f64>,
}

impl Default for DockingSettings {
    fn default() -> Self {
        Self {
            runs: 2000,
            seed: 1,
            duration: 5.0,
            starts: Starts::default(),
            motion: MotionSettings::default(),
            threshold: None,
        }
    }
}

/// Why docking could not be simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DockingError {
    /// A setting is out of its range.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// A target face has no magnets to match by.
    #[error("a match needs magnets on both target faces, but one of them has none")]
    NoMagnets,
}

/// The outcome of one start.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum End {
    /// Matched since this time (s), and still so at the end.
    Bound {
        /// The time (s) at which the match was declared.
        since: f64,
    },
    /// Touching, unmatched, and too slow to come free. Friction may stop the tile short of the
    /// minimum, even of the bond's.
    Trapped {
        /// The trap's index in [`Docking::traps`]; `None` if overdamped motion leads to none.
        trap: Option<usize>,
    },
    /// Neither: not in contact, or still fast enough to come free.
    Free,
}

/// One trajectory, in short.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DockingRun {
    /// The index of the run, from 0, which selects the random stream.
    pub index: usize,
    /// The start.
    pub start: Start,
    /// The last snapshot.
    pub last: Snapshot,
    /// The outcome.
    pub end: End,
    /// Steps of free flight.
    pub free_steps: usize,
    /// Steps in contact.
    pub contact_steps: usize,
}

impl DockingRun {
    /// Whether it ended matched.
    pub fn is_bound(&self) -> bool {
        matches!(self.end, End::Bound { .. })
    }
}

/// The minimum below unmatched ends, with symmetric copies counted as one. It can be the bond
/// itself, if friction stops tiles short of it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Trap {
    /// The configuration of the minimum.
    pub configuration: Configuration,
    /// U (J).
    pub energy: f64,
    /// Share of all runs that ended there.
    pub caught: Proportion,
}

/// The outcome of a docking experiment.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Docking {
    /// The settings of the experiment.
    pub settings: DockingSettings,
    /// The threshold of a match (m) that was used.
    pub threshold: f64,
    /// All trajectories, in order.
    pub runs: Vec<DockingRun>,
    /// Share that ended matched.
    pub bound: Proportion,
    /// Share that ended trapped.
    pub trapped: Proportion,
    /// Share of other ends.
    pub free: Proportion,
    /// Traps, most frequent first.
    pub traps: Vec<Trap>,
    /// Wall time (s).
    pub wall_s: f64,
    /// Number of threads.
    pub threads: usize,
}

/// Simulates docking. The same problem and settings give the same result on any number of threads.
/// `done` is called after each trajectory.
///
/// # Errors
/// If a setting is invalid or the target has no magnets to match.
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

/// The snapshots of one trajectory of an experiment, at most `interval` (s) apart in free flight.
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
