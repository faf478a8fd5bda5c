//! The off-rate: how soon bound tiles come loose.

use super::experiment::Experiment;
use super::{DockingError, DockingSettings, OnRate, stream};
use crate::dynamics::{Motion, Snapshot, Stop};
use crate::rigid::thermal_velocity;
use tiles::configuration::Configuration;
use tiles::parallel;
use tiles::problem::Problem;

/// The outcome of one bound tile.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Release {
    /// The time at which it left the bond for good (s), or the duration of the observation.
    pub time: f64,
    /// Whether it left; `None` where the impulses of contact were not found after this time.
    pub left: Option<bool>,
}

/// Simulates bound tiles that are shaken, each starting in the bond with a thermal velocity, until
/// they are free or the time is over; the starts of `settings` are ignored. A tile leaves the bond
/// at the last time at which it is matched (by the rule of attachment) before it is far from the
/// other one, or before the time is over.
///
/// # Errors
/// As [`super::dock`].
pub fn releases(
    problem: &Problem,
    settings: &DockingSettings,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Release>, DockingError> {
    let experiment = Experiment::new(problem, settings)?;
    let kt = settings.motion.shaking.unwrap_or(0.0);
    let release = |index: usize| {
        let mut rng = stream(settings.seed, index);
        let start = Motion {
            configuration: experiment.pair.bound,
            velocity: thermal_velocity(&experiment.simulation.body, kt, &mut rng),
        };
        let (mut matched_last, mut left) = (0.0, false);
        let mut look = |now: &Snapshot, is_matched: bool| {
            left = !is_matched;
            if is_matched {
                matched_last = now.time;
            }
        };
        let is_far = |q: &Configuration| problem.space.is_far(q);
        let run = experiment.watched(&start, &mut rng, &mut look, &is_far);
        done();
        let (time, left) = match (run.stop, left) {
            (Stop::Failed, _) => (run.last.time, None),
            (_, true) => (matched_last, Some(true)),
            (_, false) => (settings.duration, Some(false)),
        };
        Release { time, left }
    };
    Ok(parallel::map(0..settings.runs, release))
}

/// The detachment rate, with its interval and the test for exponential times: the runs are
/// concatenated, as for attachment.
pub fn off_rate(releases: &[Release]) -> OnRate {
    OnRate::of_events(releases.iter().map(|release| (release.time, release.left)))
}
