//! The tables and first facts of an analysis' page.

use serde_json::{Value, json};

use super::{Column, Fact, Table, finite};
use crate::design::Design;
use crate::landscape::{Barrier, Kind, StateKind};
use crate::pipeline::Analysis;
use crate::report::json::{face_names, kind, place_name};
use crate::report::plots::Scene;
use crate::report::plots::scale::minus;
use crate::units::{si, si_range};

/// Significant digits of numbers in tables.
const DIGITS: usize = 7;

fn number(value: f64) -> Value {
    json!(finite(value, DIGITS))
}

fn optional(value: Option<f64>) -> Value {
    value.map_or(Value::Null, number)
}

fn energy(value: f64) -> String {
    minus(&si(value, "J", 4))
}

/// The lowest way out of a class of states.
fn escape<'a>(analysis: &'a Analysis, kind: &Kind) -> Option<&'a Barrier> {
    let Analysis {
        problem, inventory, ..
    } = analysis;
    inventory.escape_of_kind(problem, kind.first().id)
}

/// What to know first: the bond, how often it is found, how it is left, the deepest trap.
pub fn facts(design: &Design, analysis: &Analysis, scene: &Scene) -> Vec<Fact> {
    let fact = |name: &str, value: String, note: String| Fact {
        name: name.to_owned(),
        value,
        note,
    };
    let classes = scene.kinds();
    let first = |kind| classes.iter().find(move |class| class.first().kind == kind);
    let mut facts = Vec::new();
    let magnets = format!("magnets as {}s", design.interaction.model.name());
    let Some(bond) = first(StateKind::Bound) else {
        let value = energy(analysis.bound.1);
        let note = "the tiles do not stay where the target faces coincide".to_owned();
        facts.push(fact("no bond", value, note));
        return facts;
    };
    facts.push(fact("bond", energy(bond.first().energy), magnets));
    if let Some(share) = Some(bond.captured()).filter(|share| share.of > 0) {
        facts.push(fact(
            "far starts that bind",
            format!("{:.1} %", 100.0 * share.share()),
            format!(
                "{} of {}; 95 %: {:.1} to {:.1} %",
                share.count,
                share.of,
                100.0 * share.low,
                100.0 * share.high
            ),
        ));
    }
    let way_out = |class: &Kind| match escape(analysis, class) {
        None => ("not known".to_owned(), "no way out was found".to_owned()),
        Some(barrier) if barrier.bounds.caged => {
            ("none".to_owned(), "proved: no way out".to_owned())
        }
        Some(barrier) => {
            let certified = match (barrier.bounds.lower, barrier.bounds.upper) {
                (Some(lower), Some(upper)) => {
                    let from = barrier.from_energy;
                    let range = si_range(lower - from, upper - from, "J", 4);
                    format!("; certified {}", minus(&range))
                }
                _ => String::new(),
            };
            let to = place_name(barrier.to);
            (energy(barrier.forward()), format!("to {to}{certified}"))
        }
    };
    let (height, note) = way_out(bond);
    facts.push(fact("barrier out of the bond", height, note));
    match first(StateKind::Misbound) {
        None => facts.push(fact("traps", "none".to_owned(), String::new())),
        Some(trap) => {
            let note = format!(
                "state {}; {:.2} of the bond",
                trap.first().id,
                trap.first().energy / bond.first().energy
            );
            facts.push(fact("deepest trap", energy(trap.first().energy), note));
            let (height, note) = way_out(trap);
            facts.push(fact("barrier out of that trap", height, note));
        }
    }
    facts
}

/// The classes of states.
pub fn states(design: &Design, analysis: &Analysis, scene: &Scene) -> Table {
    let classes = scene.kinds();
    let rows = classes.iter().map(|class| {
        let state = class.first();
        let out = escape(analysis, class);
        let [x, y, theta] = state.configuration.to_array();
        let faces: Vec<_> = face_names(design, state)
            .iter()
            .map(|pair| pair.join("-"))
            .collect();
        vec![
            json!(state.id),
            json!(kind(state.kind)),
            json!(class.copies()),
            number(state.energy),
            optional(out.map(Barrier::forward)),
            out.map_or(Value::Null, |barrier| json!(place_name(barrier.to))),
            number(class.captured().share()),
            number(x),
            number(y),
            number(theta),
            json!(state.attracting),
            json!(state.repelling),
            json!(faces.join(" ")),
        ]
    });
    Table {
        title: "States".to_owned(),
        note: "One row for the states that symmetry maps onto each other: the one nearest to the \
               bound configuration. Captured: share of far starts that end in any of them. \
               Attracting, repelling: magnet pairs close together. A click shows the pose."
            .to_owned(),
        columns: vec![
            Column::new("state", ""),
            Column::new("kind", ""),
            Column::new("copies", ""),
            Column::new("energy", "J"),
            Column::new("way out", "J"),
            Column::new("leads to", ""),
            Column::new("captured", "%"),
            Column::new("x", "m"),
            Column::new("y", "m"),
            Column::new("\u{3b8}", "rad"),
            Column::new("attracting", ""),
            Column::new("repelling", ""),
            Column::new("faces", ""),
        ],
        rows: rows.collect(),
        states: classes.iter().map(|class| class.first().id).collect(),
    }
}

/// The barriers between classes.
pub fn barriers(analysis: &Analysis, scene: &Scene) -> Table {
    let rows = analysis.inventory.barriers.iter().map(|barrier| {
        vec![
            json!(scene.name_of(barrier.from)),
            json!(scene.name_of(barrier.to)),
            number(barrier.saddle_energy),
            optional(barrier.bounds.lower),
            optional(barrier.bounds.upper),
            number(barrier.forward()),
            number(barrier.reverse()),
        ]
    });
    Table {
        title: "Barriers".to_owned(),
        note:
            "The highest energy on the best way found, its certified bounds, and its height seen \
               from either end."
                .to_owned(),
        columns: vec![
            Column::new("from", ""),
            Column::new("to", ""),
            Column::new("saddle", "J"),
            Column::new("at least", "J"),
            Column::new("at most", "J"),
            Column::new("forward", "J"),
            Column::new("reverse", "J"),
        ],
        rows: rows.collect(),
        states: Vec::new(),
    }
}

/// What reproduces the result.
pub fn settings(design: &Design, analysis: &Analysis) -> Table {
    let settings = &analysis.settings;
    let rows = [
        ("magnets", json!(design.interaction.model.name())),
        ("seed", json!(settings.seed)),
        ("milestones", json!(analysis.counts.milestones)),
        ("edges", json!(analysis.counts.edges)),
        (
            "transition states",
            json!(analysis.counts.transition_states),
        ),
        (
            "energy evaluations",
            json!(analysis.counts.energy_evaluations),
        ),
        ("cells of the certificate", json!(analysis.counts.cells)),
        ("far starts", json!(settings.far_starts)),
        ("runs", json!(settings.repeats)),
    ];
    Table::of_settings(rows)
}
