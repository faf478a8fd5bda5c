//! Docking: what becomes of tiles that are sent towards each other.

mod experiment;
mod map;
mod matching;
mod rate;
mod release;
mod starts;

use experiment::{Experiment, STEPS_BETWEEN_LOOKS};
pub(super) use experiment::{minimum_below, out_of_contact};
pub use map::{DockingMap, MapCell, share_within};
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

/// All that decides a docking experiment, besides the problem.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DockingSettings {
    /// How many trajectories.
    pub runs: usize,
    /// Of all random numbers.
    pub seed: u64,
    /// How long each trajectory lasts (s).
    pub duration: f64,
    /// How the starts are distributed.
    pub starts: Starts,
    /// How the tiles move.
    pub motion: MotionSettings,
    /// Threshold of a match (m); see [`MatchRule::new`] where `None`.
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

impl DockingSettings {
    /// The experiment that was also made with the Open Dynamics Engine on the paper's tile: the
    /// default starts, drag 0.5 per second, no rim, 5 s. See [`ENGINE`] for what it found.
    pub fn engine_comparison() -> Self {
        Self {
            motion: MotionSettings {
                drag: 0.5,
                walls: false,
                ..MotionSettings::default()
            },
            ..Self::default()
        }
    }
}

/// What the Open Dynamics Engine found in [`DockingSettings::engine_comparison`] on the paper's
/// tile, with 2000 starts at steps of 1 ms to 0.2 ms.
///
/// # Why it finds fewer
///
/// The engine is asked for a restitution of 0.01 but gives back [`EngineFigures::restitution`],
/// 0.10 in the mean and anything from 0.01 to 0.20: its correction of overlap (ERP 0.2) pushes the
/// tile out at 0.2 of the overlap a step, and how far a step takes the tile in is a matter of
/// chance, up to the whole way of the step. The velocity stays afterwards, and as overlap grows
/// with the step like the time to push it out, smaller steps do not help: a tile without magnets
/// that meets the other flush at 0.5 m/s leaves with 0.104 of it in the mean at steps of 1 ms and
/// with 0.099 at 0.2 ms. With the speed of the correction limited to 1 cm/s it leaves with 0.02,
/// and the engine's share rises to [`EngineFigures::corrected`]; the other way round, this
/// simulation falls to the engine's figure with a restitution of 0.1. From the same 8000 starts:
///
/// | | restitution | bound | slid by one magnet | other ends in contact |
/// |---|---|---|---|---|
/// | engine, as it is | 0.10 (0.01 to 0.20) | 7.2 % (6.6 to 7.8) | 4.2 % | 6.4 % |
/// | here | 0.1 | 6.9 % (6.3 to 7.4) | | |
/// | engine, correction at most 1 cm/s | 0.02 | 9.1 % (8.4 to 9.7) | 5.4 % | 8.4 % |
/// | here | 0.01 | 9.1 % (8.4 to 9.7) | | |
///
/// For the restitution that is stated, 0.01, the higher figure is right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EngineFigures {
    /// Share matched, lowest and highest over the steps.
    pub matched: [f64; 2],
    /// Half width of the interval of a share.
    pub margin: f64,
    /// Share slid, about.
    pub slid: f64,
    /// Range of speeds (m/s) in which most match, and the share there.
    pub best: ([f64; 2], f64),
    /// Restitution that its knocks have in the mean.
    pub restitution: f64,
    /// Share matched with the correction of overlap limited to 1 cm/s, and its interval's half
    /// width (8000 starts, steps of 1 ms).
    pub corrected: (f64, f64),
    /// Time for a step (s).
    pub cost: f64,
    /// The longest and the shortest step (s).
    pub steps: [f64; 2],
}

/// See [`EngineFigures`].
pub const ENGINE: EngineFigures = EngineFigures {
    matched: [0.072, 0.082],
    margin: 0.011,
    slid: 0.04,
    best: ([0.2, 0.6], 0.12),
    restitution: 0.10,
    corrected: (0.0905, 0.0063),
    cost: 1.0 / 0.6e6,
    steps: [1e-3, 0.2e-3],
};

/// Why docking could not be simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DockingError {
    /// A setting is out of its range.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// A target face has no magnets to match by.
    #[error("a match is declared by the magnets of the target faces, but one of them has none")]
    NoMagnets,
}

/// What became of one start.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum End {
    /// Matched since this time (s), and still so at the end.
    Bound {
        /// The time (s) at which the match was declared.
        since: f64,
    },
    /// Touching, unmatched, and too slow to come free; the number of the trap, where the tile's
    /// slow motion leads to one. Friction may hold it short of the minimum, even of the bond's.
    Trapped {
        /// The trap's number among [`Docking::traps`]; `None` where slow motion leads to none.
        trap: Option<usize>,
    },
    /// Neither: not in touch, or still fast enough to come free.
    Free,
}

/// One trajectory, in short.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DockingRun {
    /// The number of the run, from 0; it chooses the random stream.
    pub index: usize,
    /// Where and how it began.
    pub start: Start,
    /// Where and how it ended.
    pub last: Snapshot,
    /// What became of it.
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

/// The minimum below unmatched ends, symmetric copies counted as one. It may be the bond itself,
/// where friction holds tiles short of it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Trap {
    /// Of the minimum.
    pub configuration: Configuration,
    /// U (J).
    pub energy: f64,
    /// How many of all runs ended there.
    pub caught: Proportion,
}

/// The outcome of a docking experiment.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Docking {
    /// What the experiment was made with.
    pub settings: DockingSettings,
    /// The threshold of a match (m) that was used.
    pub threshold: f64,
    /// Every trajectory, by its number.
    pub runs: Vec<DockingRun>,
    /// How many ended matched.
    pub bound: Proportion,
    /// How many ended caught, unmatched.
    pub trapped: Proportion,
    /// How many ended otherwise.
    pub free: Proportion,
    /// Traps, that with most trajectories first.
    pub traps: Vec<Trap>,
    /// Wall time (s).
    pub wall_s: f64,
    /// On so many threads.
    pub threads: usize,
}

/// Simulates docking. The same problem and settings give the same result on any number of threads.
/// `done` is called after each trajectory.
///
/// # Errors
/// Where a setting makes no sense or no match can be declared.
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
    let mut rng = stream(settings.seed, index);
    let start = settings.starts.draw(experiment.pair, &mut rng);
    let mut snapshots = vec![experiment.simulation.snapshot(&start.motion)];
    let mut last = None;
    experiment.simulation.run(
        &start.motion,
        settings.duration,
        &mut rng,
        &mut |snapshot| {
            let earlier = snapshots.last().map_or(0.0, |s: &Snapshot| s.time);
            if snapshot.time - earlier >= 0.5 * interval {
                snapshots.push(*snapshot);
            }
            last = Some(*snapshot);
            false
        },
    );
    snapshots.extend(last.filter(|last| snapshots.last() != Some(last)));
    Ok(snapshots)
}
