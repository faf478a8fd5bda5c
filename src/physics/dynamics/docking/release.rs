//! The off-rate: how soon bound tiles come loose.

use super::{DockingError, DockingSettings, MatchRule, OnRate, STEPS_BETWEEN_LOOKS, stream};
use crate::dynamics::trajectory::thermal_velocity;
use crate::dynamics::{Body, Motion, Simulation, Snapshot};
use crate::parallel;
use crate::problem::Problem;

/// What became of one bound tile.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Release {
    /// When it left the bond for good (s), or how long it was watched.
    pub time: f64,
    /// Whether it left.
    pub left: bool,
}

/// Bound tiles that are shaken, each from rest in the bond with a thermal velocity, until they are
/// free or their time is over; the starts of `settings` do not matter. A tile leaves the bond at the
/// last moment at which it is matched (the rule of attachment) before it is far from the other
/// one, or before its time is over.
///
/// # Errors
/// As [`super::dock`].
pub fn releases(
    problem: &Problem,
    settings: &DockingSettings,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Release>, DockingError> {
    let pair = problem.pair.as_deref().ok_or(DockingError::NoMagnets)?;
    let body = Body::of_tile(&pair.moving);
    let simulation = Simulation::new(problem, body, &settings.motion)?;
    let rule = MatchRule::new(problem, settings.threshold)?;
    let kt = settings.motion.shaking.unwrap_or(0.0);
    let release = |index: usize| {
        let mut rng = stream(settings.seed, index);
        let start = Motion {
            configuration: pair.bound,
            velocity: thermal_velocity(&body, kt, &mut rng),
        };
        let (mut steps, mut matched_last, mut is_matched) = (0, 0.0, true);
        let mut look = |snapshot: &Snapshot| {
            is_matched = rule.holds(&snapshot.motion.configuration);
            if is_matched {
                matched_last = snapshot.time;
            }
        };
        let run = simulation.run(&start, settings.duration, &mut rng, &mut |snapshot| {
            steps += 1;
            if !snapshot.in_contact_range || steps % STEPS_BETWEEN_LOOKS == 0 {
                look(snapshot);
            }
            problem.space.is_far(&snapshot.motion.configuration)
        });
        look(&run.last);
        done();
        Release {
            time: if is_matched {
                settings.duration
            } else {
                matched_last
            },
            left: !is_matched,
        }
    };
    Ok(parallel::map(0..settings.runs, release))
}

/// The rate of detachment, with its interval and whether the times are exponential: the runs are
/// taken one after the other, as for attachment.
pub fn off_rate(releases: &[Release]) -> OnRate {
    OnRate::of_events(releases.iter().map(|release| (release.time, release.left)))
}
