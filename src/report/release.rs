//! Bound tiles that come loose, as JSON and as a sentence.

use serde_json::json;

use super::docking::rate_entry;
use super::json;
use crate::design::Design;
use crate::dynamics::docking::{DockingSettings, Release, off_rate};
use crate::units::{plain, si};

/// The off-rate, and everything that reproduces it.
pub fn json(design: &Design, settings: &DockingSettings, releases: &[Release]) -> String {
    let motion = &settings.motion;
    let rate = off_rate(releases);
    json::text(&json!({
        "tilebind": env!("CARGO_PKG_VERSION"),
        "design": {"name": design.name, "sha256": design.sha256},
        "seed": settings.seed,
        "settings": {
            "runs": settings.runs, "duration_s": settings.duration,
            "match_threshold_m": settings.threshold,
            "motion": {
                "drag_per_s": motion.drag, "restitution": motion.restitution,
                "friction": motion.friction, "walls": motion.walls,
                "shaking_J": motion.shaking, "fans": motion.fans.len(),
            },
        },
        "off_rate": rate_entry("detachments", &rate),
        "times_s": releases.iter().filter(|it| it.left).map(|it| it.time).collect::<Vec<_>>(),
    }))
}

/// A few lines for the terminal.
pub fn summary(design: &Design, settings: &DockingSettings, releases: &[Release]) -> String {
    let rate = off_rate(releases);
    let kt = settings.motion.shaking.unwrap_or(0.0);
    let exponential = match (rate.attachments, rate.is_exponential()) {
        (0, _) => "none came loose: the rate is not known to be above 0".to_owned(),
        (_, true) => {
            "times between detachments are compatible with an exponential distribution".to_owned()
        }
        (_, false) => "times between detachments refute an exponential distribution".to_owned(),
    };
    format!(
        "{}: bound tiles shaken at kT = {} come loose {} times a second ({} to {})\n  \
         {} of {} left the bond within {} each; {exponential}\n  drag {} per s, restitution {}; \
         the rate is of these, and of no temperature alone\n",
        design.name,
        si(kt, "J", 3),
        plain(rate.rate, 3),
        plain(rate.interval[0], 3),
        plain(rate.interval[1], 3),
        rate.attachments,
        releases.len(),
        si(settings.duration, "s", 3),
        settings.motion.drag,
        settings.motion.restitution,
    )
}
