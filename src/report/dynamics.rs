//! What moving tiles say of the barriers, as JSON, CSV and a few lines.

use std::fmt::Write;

use serde::Serialize;
use serde_json::Value;

use super::json::{place, place_name};
use crate::dynamics::Motion;
use crate::dynamics::check::{BarrierCheck, Side, SideVerdict};
use crate::pipeline::Analysis;

/// The file with a line for each barrier.
pub const TABLE: &str = "dynamics.csv";

/// The check in `report.json`.
#[derive(Debug, Serialize)]
pub struct DynamicsEntry {
    /// Trajectories below each barrier that were asked for.
    pub runs: usize,
    /// Barriers contradicted; 0 where all is well.
    pub contradicted: usize,
    /// Barriers without certified bounds that are shown to be estimated too high.
    pub overestimated: usize,
    /// One for each barrier that was checked.
    pub barriers: Vec<BarrierCheckEntry>,
}

/// The check of one barrier.
#[derive(Debug, Serialize)]
#[allow(non_snake_case)]
pub struct BarrierCheckEntry {
    /// The state that the pathway leaves.
    pub from: Value,
    /// The state that it leads to, or `free`.
    pub to: Value,
    /// Whether moving tiles refute what is proved of the barrier.
    pub contradicted: bool,
    /// Whether moving tiles refute its estimate, of which nothing is proved.
    pub overestimated: bool,
    /// Whether the ceiling is a certified bound, not an estimate.
    pub certified: bool,
    /// Trajectories stayed below this total energy; null where the state is proved caged.
    pub ceiling_J: f64,
    /// Trajectories below the ceiling.
    pub below: BelowEntry,
    /// The same with more energy than the pathway needs.
    pub above: CrossingsEntry,
    /// From before and from behind the saddle; null where not asked.
    pub sides: [Option<SideEntry>; 2],
    /// Least energy of a kick that threw the tile out; null where none did.
    pub kick_J: Option<f64>,
    /// What the kick may not be less than.
    pub climb_J: f64,
}

/// Trajectories and how many of them crossed.
#[derive(Debug, Serialize)]
pub struct CrossingsEntry {
    /// How many there were.
    pub runs: usize,
    /// How many of them crossed.
    pub crossed: usize,
}

/// Trajectories below a barrier.
#[derive(Debug, Serialize)]
pub struct BelowEntry {
    /// How many there were.
    pub runs: usize,
    /// How many of them crossed.
    pub crossed: usize,
    /// More of them that proved nothing, lifted over the ceiling by the integration's error.
    pub spoilt: usize,
    /// The start of one that crossed.
    pub example: Option<MotionEntry>,
}

/// A place and a velocity.
#[derive(Debug, Serialize)]
#[allow(non_snake_case)]
pub struct MotionEntry {
    /// x, y (m) and theta (rad).
    pub pose: [f64; 3],
    /// Of the centre of mass (m/s, m/s), and the turning rate (rad/s).
    pub velocity: [f64; 3],
}

/// Where a trajectory from beside the saddle ended.
#[derive(Debug, Serialize)]
pub struct SideEntry {
    /// Null for no reported state.
    pub ended: Option<Value>,
    /// `on the pathway`, `elsewhere` or `opposite`.
    pub verdict: &'static str,
}

impl DynamicsEntry {
    /// `None` where the barriers were not checked.
    pub fn new(analysis: &Analysis) -> Option<Self> {
        let checks = analysis.dynamics.as_ref()?;
        Some(Self {
            runs: analysis.settings.dynamics_runs,
            contradicted: analysis.contradicted().count(),
            overestimated: analysis.overestimated().count(),
            barriers: checks.iter().map(BarrierCheckEntry::new).collect(),
        })
    }
}

impl BarrierCheckEntry {
    fn new(check: &BarrierCheck) -> Self {
        Self {
            from: place(check.from),
            to: place(check.to),
            contradicted: check.is_contradicted(),
            overestimated: check.is_overestimated(),
            certified: check.certified,
            ceiling_J: check.ceiling,
            below: BelowEntry {
                runs: check.below.runs,
                crossed: check.below.crossed,
                spoilt: check.below.spoilt,
                example: check.below.example.as_ref().map(MotionEntry::new),
            },
            above: CrossingsEntry {
                crossed: check.above.0,
                runs: check.above.1,
            },
            sides: check.sides.map(|side| {
                side.map(|side| SideEntry {
                    ended: side.ended.map(place),
                    verdict: verdict(&side),
                })
            }),
            kick_J: check.kick,
            climb_J: check.climb,
        }
    }
}

impl MotionEntry {
    fn new(motion: &Motion) -> Self {
        Self {
            pose: motion.configuration.to_array(),
            velocity: motion.velocity.into(),
        }
    }
}

fn verdict(side: &Side) -> &'static str {
    match side.verdict {
        SideVerdict::OnThePathway => "on the pathway",
        SideVerdict::Elsewhere => "elsewhere",
        SideVerdict::Opposite => "opposite",
    }
}

/// The table of the checks, a barrier a line.
pub fn csv(checks: &[BarrierCheck]) -> String {
    let mut table =
        "from,to,contradicted,overestimated,certified,ceiling_J,below_runs,below_crossed,\
                     below_spoilt,above_runs,above_crossed,before_saddle_ended,\
                     before_saddle_verdict,behind_saddle_ended,behind_saddle_verdict,kick_J,\
                     climb_J\n"
            .to_owned();
    for check in checks {
        let finite = |value: Option<f64>| {
            let value = value.filter(|value| value.is_finite());
            value.map_or_else(String::new, |value| format!("{value:.9e}"))
        };
        let side = |side: Option<Side>| {
            side.map_or_else(
                || ",".to_owned(),
                |side| {
                    let ended = side.ended.map_or_else(String::new, place_name);
                    format!("{ended},{}", verdict(&side))
                },
            )
        };
        let _ = writeln!(
            table,
            "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
            place_name(check.from),
            place_name(check.to),
            check.is_contradicted(),
            check.is_overestimated(),
            check.certified,
            finite(Some(check.ceiling)),
            check.below.runs,
            check.below.crossed,
            check.below.spoilt,
            check.above.1,
            check.above.0,
            side(check.sides[0]),
            side(check.sides[1]),
            finite(check.kick),
            finite(Some(check.climb)),
        );
    }
    table
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
        let _ = writeln!(text, "{}", check.told());
    }
    text
}
