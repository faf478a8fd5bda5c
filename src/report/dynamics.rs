//! What moving tiles say of the barriers, as JSON, CSV and a few lines.

use std::fmt::Write;

use serde_json::{Value, json};

use super::csv;
use super::names::{place, place_name};
use jobs::pipeline::Analysis;
use physics::dynamics::check::{BarrierCheck, Side, SideVerdict};

/// The file with a line for each barrier.
pub const TABLE: &str = "dynamics.csv";

/// The check in `report.json`; null where the barriers were not checked.
pub fn json(analysis: &Analysis) -> Value {
    let Some(checks) = &analysis.dynamics else {
        return Value::Null;
    };
    json!({
        // Trajectories below each barrier that were asked for.
        "runs": analysis.settings.dynamics_runs,
        "contradicted": analysis.contradicted().count(),
        "overestimated": analysis.overestimated().count(),
        "barriers": checks.iter().map(entry).collect::<Value>(),
    })
}

/// The check of one barrier.
fn entry(check: &BarrierCheck) -> Value {
    let side = |side: Option<Side>| {
        let entry = |side: Side| json!({"ended": side.ended.map(place), "verdict": verdict(&side)});
        side.map(entry)
    };
    json!({
        "from": place(check.from),
        "to": place(check.to),
        "contradicted": check.is_contradicted(),
        "overestimated": check.is_overestimated(),
        // Whether the ceiling is a certified bound, not an estimate.
        "certified": check.certified,
        // Trajectories stayed below this total energy; null where the state is proved caged.
        "ceiling_J": check.ceiling,
        "below": {
            "runs": check.below.runs,
            "crossed": check.below.crossed,
            // More of them that proved nothing, lifted over the ceiling by the integration's error.
            "spoilt": check.below.spoilt,
            // The start of one that crossed: pose, velocity of the centre of mass (m/s, m/s) and
            // turning rate (rad/s).
            "example": check.below.example.as_ref().map(|motion| json!({
                "pose": motion.configuration.to_array(),
                "velocity": <[f64; 3]>::from(motion.velocity),
            })),
        },
        // The same with more energy than the pathway needs.
        "above": {"runs": check.above.1, "crossed": check.above.0},
        // From before and from behind the saddle; null where not asked.
        "sides": check.sides.map(side),
        // Least energy of a kick that threw the tile out, and what it may not be less than.
        "kick_J": check.kick,
        "climb_J": check.climb,
    })
}

fn verdict(side: &Side) -> &'static str {
    match side.verdict {
        SideVerdict::OnThePathway => "on the pathway",
        SideVerdict::Elsewhere => "elsewhere",
        SideVerdict::Opposite => "opposite",
    }
}

/// A column of the table: its name, and its cell of a check.
type Column = (&'static str, fn(&BarrierCheck) -> String);

const COLUMNS: [Column; 17] = [
    ("from", |check| place_name(check.from)),
    ("to", |check| place_name(check.to)),
    ("contradicted", |check| check.is_contradicted().to_string()),
    ("overestimated", |check| {
        check.is_overestimated().to_string()
    }),
    ("certified", |check| check.certified.to_string()),
    ("ceiling_J", |check| energy(Some(check.ceiling))),
    ("below_runs", |check| check.below.runs.to_string()),
    ("below_crossed", |check| check.below.crossed.to_string()),
    ("below_spoilt", |check| check.below.spoilt.to_string()),
    ("above_runs", |check| check.above.1.to_string()),
    ("above_crossed", |check| check.above.0.to_string()),
    ("before_saddle_ended", |check| ended(check.sides[0])),
    ("before_saddle_verdict", |check| judged(check.sides[0])),
    ("behind_saddle_ended", |check| ended(check.sides[1])),
    ("behind_saddle_verdict", |check| judged(check.sides[1])),
    ("kick_J", |check| energy(check.kick)),
    ("climb_J", |check| energy(Some(check.climb))),
];

fn energy(value: Option<f64>) -> String {
    let value = value.filter(|value| value.is_finite());
    value.map_or_else(String::new, |value| format!("{value:.9e}"))
}

fn ended(side: Option<Side>) -> String {
    let ended = side.and_then(|side| side.ended);
    ended.map_or_else(String::new, place_name)
}

fn judged(side: Option<Side>) -> String {
    side.map_or_else(String::new, |side| verdict(&side).to_owned())
}

/// The table of the checks, a barrier a line.
pub fn csv(checks: &[BarrierCheck]) -> String {
    let rows = checks.iter().map(|check| COLUMNS.map(|(_, of)| of(check)));
    csv::table(COLUMNS.map(|(name, _)| name), rows)
}

/// What the check found in a line, and another line for each barrier that is refuted.
pub fn summary(analysis: &Analysis) -> String {
    let Some(checks) = &analysis.dynamics else {
        return String::new();
    };
    let sum = |count: fn(&BarrierCheck) -> usize| checks.iter().map(count).sum::<usize>();
    let sides: Vec<&Side> = checks
        .iter()
        .flat_map(|check| check.sides.iter().flatten())
        .collect();
    let on_the_pathway = sides
        .iter()
        .filter(|side| side.verdict == SideVerdict::OnThePathway);
    let mut text = format!(
        "moving tiles: {} of {} trajectories below {} barriers crossed them ({} of {} above); from \
         beside the saddle {} of {} ended on the pathway\n",
        sum(|check| check.below.crossed),
        sum(|check| check.below.runs),
        checks.len(),
        sum(|check| check.above.0),
        sum(|check| check.above.1),
        on_the_pathway.count(),
        sides.len(),
    );
    for check in analysis.contradicted().chain(analysis.overestimated()) {
        let _ = writeln!(text, "{}", check.describe());
    }
    text
}
