//! Simulations of many tiles on a table: the request, the runs, and their statistics.

mod comparison;
mod crowds;
mod request;
mod start_file;
mod statistics;
mod subject;
mod target;

pub use comparison::compared;
pub use crowds::{of_assembly, of_designs};
pub use request::Request;
pub use start_file::{StartFileError, read as read_start};
pub use statistics::{Interval, Lifetime, Moment, Statistics, Verdict};
pub use subject::About;
pub use target::Target;

use std::time::Instant;

use crate::request::Unanswered;
use physics::observer::Observer;
use physics::parallel;
use physics::table::run::{Run, RunError, Start, run};
use physics::table::{Crowd, TableSettings};

/// The result of a table.
pub struct Found {
    /// The tiles and their interactions.
    pub crowd: Crowd,
    /// The settings of the runs.
    pub settings: TableSettings,
    /// The index of each tile's kind.
    pub kinds: Vec<usize>,
    /// The runs, in order.
    pub runs: Vec<Run>,
    /// Statistics over the runs.
    pub statistics: Statistics,
    /// How much of the target is complete.
    pub target: Target,
    /// Whether poses are recorded in all runs, not only in the first.
    pub frames: bool,
    /// Wall time (s).
    pub wall_s: f64,
    /// Number of threads.
    pub threads: usize,
}

/// Why there is no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("run {index}: {error}")]
pub struct TableError {
    /// The run's index, from 0.
    pub index: usize,
    /// Why.
    pub error: RunError,
}

/// Starts and steps are part of the request.
impl Unanswered for TableError {}

/// Simulates all runs. The same request gives the same result on any number of threads.
///
/// # Errors
/// If tiles cannot start as requested, or steps are too long.
pub fn table(
    (about, crowd): (&About, Crowd),
    request: &Request,
    start: &Start,
    progress: &dyn Observer,
) -> Result<Found, TableError> {
    let settings = request.settings();
    let clock = Instant::now();
    progress.stage("runs", 0.0);
    let done = std::sync::atomic::AtomicUsize::new(0);
    let made = request.made();
    let runs = parallel::map(&made[..], |&index| {
        let frames = index == made[0] || request.keeps_frames();
        let found = run(&crowd, &settings, (request.seed, index), start, frames);
        let done = 1 + done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        progress.part("runs", done, made.len());
        found.map_err(|error| TableError { index, error })
    });
    let runs = runs.into_iter().collect::<Result<Vec<Run>, _>>()?;
    let kinds: Vec<usize> = match start {
        Start::Random(counts) => {
            let of_kind = counts.iter().enumerate();
            of_kind
                .flat_map(|(kind, count)| std::iter::repeat_n(kind, *count))
                .collect()
        }
        Start::Given(movers) => movers.iter().map(|mover| mover.kind).collect(),
    };
    Ok(Found {
        target: Target::of(about, (&crowd, &kinds), &runs),
        statistics: Statistics::of(&runs, &settings),
        wall_s: clock.elapsed().as_secs_f64(),
        threads: parallel::threads(),
        frames: request.keeps_frames(),
        crowd,
        settings,
        kinds,
        runs,
    })
}
