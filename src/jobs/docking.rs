//! Paths of a docking experiment, to be looked at.

use physics::dynamics::Snapshot;
use physics::dynamics::docking::{Docking, DockingError, DockingRun, End, trajectory};
use physics::problem::Problem;

/// Paths that are drawn over each other.
const DRAWN: usize = 60;
/// Time between two points of a path (s).
const INTERVAL: f64 = 0.02;

/// A run, point by point.
pub type Path = (DockingRun, Vec<Snapshot>);

/// Some of an experiment's runs, point by point.
#[derive(Clone, Debug)]
pub struct Paths {
    /// To be played one by one: the run that was asked for or else the first bound one, and a few of
    /// each end.
    pub played: Vec<Path>,
    /// To be drawn over each other.
    pub drawn: Vec<Path>,
}

impl Paths {
    /// Of a finished experiment; `asked` is the run to be played first.
    ///
    /// # Errors
    /// As [`trajectory`].
    pub fn new(
        problem: &Problem,
        docking: &Docking,
        asked: Option<usize>,
    ) -> Result<Self, DockingError> {
        let trace = |run: &DockingRun| -> Result<Path, DockingError> {
            let snapshots = trajectory(problem, &docking.settings, run.index, INTERVAL)?;
            Ok((*run, snapshots))
        };
        Ok(Self {
            played: chosen(docking, asked)
                .iter()
                .map(trace)
                .collect::<Result<_, _>>()?,
            drawn: docking
                .runs
                .iter()
                .take(DRAWN)
                .map(trace)
                .collect::<Result<_, _>>()?,
        })
    }
}

fn chosen(docking: &Docking, asked: Option<usize>) -> Vec<DockingRun> {
    let runs = &docking.runs;
    let asked = asked.and_then(|index| runs.get(index));
    let mut chosen: Vec<DockingRun> = asked.copied().into_iter().collect();
    let mut take = |count: usize, is: &dyn Fn(&DockingRun) -> bool| {
        let fitting = runs.iter().filter(|run| is(run)).take(count);
        let new = fitting.filter(|run| !chosen.contains(run));
        let new: Vec<_> = new.copied().collect();
        chosen.extend(new);
    };
    take(4, &DockingRun::is_bound);
    for trap in 0..4 {
        take(1, &|run| run.end == End::Trapped { trap: Some(trap) });
    }
    take(2, &|run| run.end == End::Free);
    if chosen.is_empty() {
        chosen.extend(runs.first());
    }
    chosen
}
