//! Simulations of many tiles on a table: the request, the runs, and their statistics.

mod comparison;
mod crowds;
mod ensemble;
mod forecast;
mod goal;
mod request;
mod start_file;
mod starting;
mod statistics;
mod subject;
mod target;
mod workload;

pub use comparison::{Prediction, compared};
pub use crowds::{of_assembly, of_designs};
pub use ensemble::{Ensemble, PART};
pub use goal::Wanted;
pub use request::Request;
pub use start_file::{StartFileError, read as read_start};
pub use statistics::{Built, EndOfTable, Lifetime, MeanInterval, Moment, Statistics};
pub use subject::About;
pub use target::Target;
pub use workload::Workload;

use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::Instant;

use crate::request::Unanswered;
use forecast::Forecast;
use physics::observer::Observer;
use physics::parallel;
use physics::table::run::{Run, RunError, Start, watched};
use physics::table::{Crowd, usual_step};

/// The result of a table.
pub struct TableResult {
    /// The tiles and their interactions.
    pub crowd: Crowd,
    /// All runs, of which these may be a part.
    pub ensemble: Ensemble,
    /// The runs, in order.
    pub runs: Vec<Run>,
    /// Statistics over the runs.
    pub statistics: Statistics,
    /// How much of the target is complete.
    pub target: Target,
    /// Wall time (s).
    pub wall_s: f64,
    /// Number of threads.
    pub threads: usize,
}

/// Why there is no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// A run failed.
    #[error("run {index}: {error}")]
    Run {
        /// The run's index, from 0.
        index: usize,
        /// Why.
        error: RunError,
    },
    /// The files are not the parts of these runs.
    #[error("{0}")]
    Parts(String),
    /// The runs do not fit into memory.
    #[error("{0}")]
    Memory(String),
}

/// Starts and steps are part of the request.
impl Unanswered for TableError {}

/// Simulates the requested runs, or joins them from the files of all parts, given by their names and
/// texts. The same request gives the same result on any number of threads and from any parts.
///
/// # Errors
/// If the runs do not fit into memory, tiles cannot start as requested, steps are too long, or the
/// files are not the parts of these runs.
pub fn table(
    (about, crowd): (&About, Crowd),
    request: &Request,
    start: Start,
    parts: &[(String, String)],
    progress: &dyn Observer,
) -> Result<TableResult, TableError> {
    let clock = Instant::now();
    let workload = Workload::of(request, usual_step(&crowd), &start);
    workload.check().map_err(TableError::Memory)?;
    let ensemble = Ensemble::of(about, &crowd, request, start);
    let runs = match parts.is_empty() {
        true => simulated(&ensemble, &crowd, &request.made(), progress)?,
        false => ensemble.merge(&crowd, parts).map_err(TableError::Parts)?,
    };
    Ok(TableResult {
        target: Target::of(about, (&crowd, &ensemble.kinds()), &runs),
        statistics: Statistics::of(&runs, &ensemble.settings),
        wall_s: clock.elapsed().as_secs_f64(),
        threads: parallel::threads(),
        ensemble,
        crowd,
        runs,
    })
}

/// The runs of these indices.
fn simulated(
    ensemble: &Ensemble,
    crowd: &Crowd,
    made: &[usize],
    progress: &dyn Observer,
) -> Result<Vec<Run>, TableError> {
    progress.stage("runs", 0.0);
    let done = AtomicUsize::new(0);
    let forecast = Forecast::new(made.len(), progress);
    let one = |(number, &index): (usize, &usize)| {
        let frames = index == made[0] || ensemble.frames;
        let (settings, seed, start) = (&ensemble.settings, ensemble.seed, &ensemble.start);
        let watch = |share: f64| forecast.done(number, share);
        let found = watched(crowd, settings, (seed, index), start, (frames, &watch));
        let done = 1 + done.fetch_add(1, Relaxed);
        progress.part("runs", done, made.len());
        found.map_err(|error| TableError::Run { index, error })
    };
    let made: Vec<(usize, &usize)> = made.iter().enumerate().collect();
    let runs = parallel::inside(|| parallel::map(&made, |it| one(*it)));
    runs.into_iter().collect()
}
