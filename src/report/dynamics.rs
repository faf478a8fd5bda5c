//! The check of barriers by moving tiles, as JSON, CSV and a few lines of text.

use serde_json::{Value, json};

use super::document::{Table, rows};
use super::names::place;
use jobs::pipeline::Analysis;
use physics::dynamics::check::{BarrierCheck, Side, SideVerdict};

/// The check in `report.json`; null if the barriers were not checked.
pub fn json(analysis: &Analysis) -> Value {
    let Some(checks) = &analysis.dynamics else {
        return Value::Null;
    };
    json!({
        // Requested number of trajectories below each barrier.
        "runs": analysis.request.check.dynamics_runs,
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
        // Trajectories stayed below this total energy; null if the state is proved to be caged.
        "ceiling_J": check.ceiling,
        "below": {
            "runs": check.below.runs,
            "crossed": check.below.crossed,
            // Further trajectories that prove nothing, because the integration error raised them
            // above the ceiling.
            "spoilt": check.below.spoilt,
            // The start of one that crossed: pose, velocity of the centre of mass (m/s, m/s) and
            // angular velocity (rad/s).
            "example": check.below.example.as_ref().map(|motion| json!({
                "pose": motion.configuration.to_array(),
                "velocity": <[f64; 3]>::from(motion.velocity),
            })),
        },
        // The same with more energy than the pathway needs.
        "above": {"runs": check.above.1, "crossed": check.above.0},
        // From both sides of the saddle; null if not requested.
        "sides": check.sides.map(side),
        // Smallest kick energy that expelled the tile, and its lower bound.
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

/// The checks, one barrier per row.
// One line a column.
#[rustfmt::skip]
pub fn table(checks: &[BarrierCheck]) -> Table {
    let side = |k: usize| move |it: &&BarrierCheck| it.sides[k];
    let ended = move |k: usize| move |it: &&BarrierCheck| side(k)(it)?.ended;
    let judged = move |k: usize| move |it: &&BarrierCheck| side(k)(it).map(|side| verdict(&side));
    rows(checks)
        .data("from", |it| it.from)
        .data("to", |it| it.to)
        .data("contradicted", |it| it.is_contradicted())
        .data("overestimated", |it| it.is_overestimated())
        .data("certified", |it| it.certified)
        .data("ceiling_J", |it| it.ceiling)
        .data("below_runs", |it| it.below.runs)
        .data("below_crossed", |it| it.below.crossed)
        .data("below_spoilt", |it| it.below.spoilt)
        .data("above_runs", |it| it.above.1)
        .data("above_crossed", |it| it.above.0)
        .data("before_saddle_ended", ended(0))
        .data("before_saddle_verdict", judged(0))
        .data("behind_saddle_ended", ended(1))
        .data("behind_saddle_verdict", judged(1))
        .data("kick_J", |it| it.kick)
        .data("climb_J", |it| it.climb)
        .table("dynamics")
        .in_csv("dynamics")
}

/// The result of the check in one line, and another line for each refuted barrier.
pub fn notes(analysis: &Analysis) -> Vec<String> {
    let Some(checks) = &analysis.dynamics else {
        return Vec::new();
    };
    let sum = |count: fn(&BarrierCheck) -> usize| checks.iter().map(count).sum::<usize>();
    let sides = checks.iter().flat_map(|check| check.sides.iter().flatten());
    let on_the_pathway = |side: &&Side| side.verdict == SideVerdict::OnThePathway;
    let told = format!(
        "simulated tiles: {} of {} trajectories started below {} barriers crossed them ({} of {} \
         started above); from beside the saddle {} of {} ended on the pathway",
        sum(|check| check.below.crossed),
        sum(|check| check.below.runs),
        checks.len(),
        sum(|check| check.above.0),
        sum(|check| check.above.1),
        sides.clone().filter(on_the_pathway).count(),
        sides.count(),
    );
    let refuted = analysis.contradicted().chain(analysis.overestimated());
    [told]
        .into_iter()
        .chain(refuted.map(BarrierCheck::describe))
        .collect()
}
