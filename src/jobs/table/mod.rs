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

/// What came of a table.
pub struct Found {
    /// The tiles and what acts between them.
    pub crowd: Crowd,
    /// With what the runs were made.
    pub settings: TableSettings,
    /// The number of the kind of each tile.
    pub kinds: Vec<usize>,
    /// The runs, by their numbers.
    pub runs: Vec<Run>,
    /// What they tell together.
    pub statistics: Statistics,
    /// How much of what was meant has come about.
    pub target: Target,
    /// Whether places are kept in all runs, not the first only.
    pub frames: bool,
    /// Wall time (s).
    pub wall_s: f64,
    /// On so many threads.
    pub threads: usize,
}

/// Why there is nothing to tell.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("run {index}: {error}")]
pub struct TableError {
    /// Which run, from 0.
    pub index: usize,
    /// Why.
    pub error: RunError,
}

/// What tiles start with and how long steps are is asked for.
impl Unanswered for TableError {}

/// Makes all runs. The same request gives the same result on any number of threads.
///
/// # Errors
/// Where tiles cannot start as asked, or steps are too long.
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
