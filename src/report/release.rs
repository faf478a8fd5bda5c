//! Bound tiles that are shaken loose, as a document.

use serde_json::{Value, json};

use super::docking::{rate, unsolved};
use crate::document::{Document, entries};
use crate::plots::chart::{Chart, Dimension, Look};
use jobs::design::Design;
use physics::dynamics::docking::{DockingSettings, OnRate, Release, off_rate};
use physics::kinetics::OVERDAMPED;
use physics::kinetics::rates::Loosening;
use physics::order::Order;
use physics::units::{plain, si};

/// The document of a release experiment; `overdamped` are the rates (1/s) of overdamped motion.
pub fn document(
    design: &Design,
    settings: &DockingSettings,
    releases: &[Release],
    overdamped: Option<Loosening>,
) -> Document<'static> {
    let off = off_rate(releases);
    let kt = si(settings.motion.shaking.unwrap_or(0.0), "J", 3);
    let [rate_told, low, high] =
        [off.rate, off.interval[0], off.interval[1]].map(|it| plain(it, 3));
    let mut left: Vec<f64> = releases
        .iter()
        .filter(|it| it.left == Some(true))
        .map(|it| it.time)
        .collect();
    let times = left.clone();
    left.order_by(f64::total_cmp);
    Document {
        title: format!("{}: detachment of bound tiles", design.name),
        answer: format!(
            "{}: bound tiles shaken at kT = {kt} detach {rate_told} times per second ({low} to \
             {high})",
            design.name
        ),
        remarks: vec![
            format!(
                "{} of {} detached within {} each; {}",
                off.attachments,
                releases.len(),
                si(settings.duration, "s", 3),
                exponential(&off),
            ),
            format!(
                "the rate holds for drag {} per s and restitution {}, not for a temperature alone",
                settings.motion.drag, settings.motion.restitution
            ),
        ],
        entries: entries(design)
            .data("seed", settings.seed)
            .data(
                "settings",
                json!({
                    "runs": settings.runs, "duration_s": settings.duration,
                    "match_threshold_m": settings.threshold,
                    "motion": settings.motion,
                }),
            )
            .fact(
                "",
                "detachment rate",
                format!("{rate_told} /s ({low} to {high})"),
            )
            .in_view()
            .noted("of bound tiles, 95 %")
            .data("off_rate", rate("detachments", &off))
            .data("unsolved", off.unsolved)
            .data(
                "overdamped",
                overdamped.as_ref().map_or(Value::Null, beside),
            )
            .data("times_s", times),
        pictures: vec![still_bound(&left, releases.len(), settings.duration).into()],
        notes: unsolved(off.unsolved, releases.len())
            .into_iter()
            .chain(overdamped.as_ref().map(describe_beside))
            .collect(),
        origin: format!(
            "seed {}, {} magnets",
            settings.seed,
            design.interaction.model.name()
        ),
        ..Document::default()
    }
}

fn exponential(rate: &OnRate) -> &'static str {
    match (rate.attachments, rate.is_exponential()) {
        (0, _) => "none detached: only an upper bound of the rate is known",
        (_, true) => "times between detachments are compatible with an exponential distribution",
        (_, false) => {
            "times between detachments are not compatible with an exponential distribution"
        }
    }
}

fn beside(found: &Loosening) -> Value {
    json!({
        "rate_per_s": found.rate, "in_well_per_s": found.in_well,
    })
}

fn describe_beside(found: &Loosening) -> String {
    let [rate, in_well] = [found.rate, found.in_well].map(|rate| plain(rate, 3));
    format!(
        "overdamped detachment rate at this kT and drag, with elastic collisions: {rate} /s \
         including the path to free tiles, {in_well} /s in the well;\nthe measured rate \
         counts a tile as detached when it last leaves the bond, so it lies between the two; motion is overdamped at a \
         drag of {OVERDAMPED} /s or more"
    )
}

/// The share still bound over time; `left` are the times (s) at which tiles came loose.
fn still_bound(left: &[f64], all: usize, duration: f64) -> Chart {
    let share = |gone: usize| 1.0 - gone as f64 / all.max(1) as f64;
    let steps = left.iter().enumerate();
    let steps = steps.flat_map(|(k, time)| [[*time, share(k)], [*time, share(k + 1)]]);
    let ends = [[0.0, 1.0], [duration, share(left.len())]];
    let points = [ends[0]].into_iter().chain(steps).chain([ends[1]]);
    Chart::new(
        "bound",
        "Fraction still bound over time",
        Dimension::new("time_s", "time"),
        Dimension::share("bound", "still bound"),
    )
    .with("still bound", Look::Steps, points)
}
