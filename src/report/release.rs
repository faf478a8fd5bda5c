//! Bound tiles that come loose, as JSON and as a sentence.

use serde_json::json;

use super::docking::rate_entry;
use super::json;
use jobs::design::Design;
use physics::dynamics::docking::{DockingSettings, Release, off_rate};
use physics::kinetics::OVERDAMPED;
use physics::kinetics::rates::Loosening;
use physics::units::{plain, si};

/// The off-rate, and everything that reproduces it.
///
/// `overdamped` are the rates (1/s) of overdamped motion.
pub fn json(
    design: &Design,
    settings: &DockingSettings,
    releases: &[Release],
    overdamped: Option<Loosening>,
) -> String {
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
        "overdamped": overdamped.map(|found| json!({
            "lower_per_s": found.bounds[0], "rate_per_s": found.rate,
            "upper_per_s": found.bounds[1], "in_well_per_s": found.in_well,
        })),
        "times_s": releases.iter().filter(|it| it.left).map(|it| it.time).collect::<Vec<_>>(),
    }))
}

/// A few lines for the terminal.
pub fn summary(
    design: &Design,
    settings: &DockingSettings,
    releases: &[Release],
    overdamped: Option<Loosening>,
) -> String {
    let rate = off_rate(releases);
    let kt = settings.motion.shaking.unwrap_or(0.0);
    let exponential = match (rate.attachments, rate.is_exponential()) {
        (0, _) => "none came loose: the rate is not known to be above 0".to_owned(),
        (_, true) => {
            "times between detachments are compatible with an exponential distribution".to_owned()
        }
        (_, false) => "times between detachments refute an exponential distribution".to_owned(),
    };
    let beside = overdamped.map_or_else(String::new, |found| {
        let [lower, upper] = found.bounds.map(|rate| plain(rate, 3));
        let [rate, in_well] = [found.rate, found.in_well].map(|rate| plain(rate, 3));
        format!(
            "  overdamped motion at that kT and drag, knocks without loss, comes loose {rate} times a \
             second\n  ({lower} to {upper}), the way out to free tiles included, and {in_well} times a \
             second in the well;\n  what is counted ends where the bond is last left: between the two; \
             tiles move so from a drag of {OVERDAMPED} per s on\n"
        )
    });
    format!(
        "{}: bound tiles shaken at kT = {} come loose {} times a second ({} to {})\n  \
         {} of {} left the bond within {} each; {exponential}\n  drag {} per s, restitution {}; \
         the rate is of these, and of no temperature alone\n{beside}",
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
