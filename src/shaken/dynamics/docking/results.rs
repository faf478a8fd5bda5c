//! The settings and the results of docking experiments.

use super::NoMagnets;
use super::starts::{Start, Starts};
use crate::dynamics::{MotionSettings, SettingsError, Snapshot};
use landscape::Proportion;
use tiles::configuration::Configuration;
use tiles::problem::NoRoom;
use tiles::units::si;

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
    /// Threshold of a match (m); see [`MatchRule::new`](super::MatchRule::new) if `None`.
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
    #[error(transparent)]
    NoMagnets(#[from] NoMagnets),
    /// The table has no room for the moving tile.
    #[error(transparent)]
    Room(#[from] NoRoom),
    /// Nowhere on the table is |U| less than this kT (J).
    #[error(
        "at kT = {} the tiles are nowhere apart: everywhere on the table their energy is more than kT; \
         enlarge `size` in [table], or choose a larger kT", si(*.0, "J", 4)
    )]
    NeverApart(f64),
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
    /// Unknown: at the time of the last snapshot the impulses of contact were not found even in the shortest
    /// steps. Shares count it either way.
    Unsolved,
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
    /// Number of runs whose ends are unknown, see [`End::Unsolved`].
    pub unsolved: usize,
    /// Traps, most frequent first.
    pub traps: Vec<Trap>,
    /// Wall time (s).
    pub wall_s: f64,
    /// Number of threads.
    pub threads: usize,
}
