//! The tables and first facts of an analysis' page.

use std::borrow::Borrow;

use serde_json::json;

use super::pathways::Played;
use super::{Column, Fact, Table, finite};
use crate::columns::{self, Cell, Output, StateRow};
use crate::figures::percent;
use crate::plots::Scene;
use crate::plots::scale::minus;
use crate::summary::{ended_by, left_out};
use jobs::design::Design;
use jobs::pipeline::Analysis;
use physics::landscape::{Kind, Place};
use physics::units::{si, si_range};

/// Significant digits of numbers in tables.
const DIGITS: usize = 7;

fn energy(value: f64) -> String {
    minus(&si(value, "J", 4))
}

/// A kind of states through the first of them, with the share of the far starts that end in any.
fn row<'a>(
    design: &Design,
    analysis: &'a Analysis,
    names: &'a [String],
    kind: &Kind<'a>,
) -> StateRow<'a> {
    let mut row = StateRow::new(design, analysis, names, kind.first());
    row.capture = Some(kind.captured());
    row
}

/// What to know first: the bond, how often it is found, how it is left, the deepest trap.
pub fn facts(design: &Design, analysis: &Analysis, scene: &Scene) -> Vec<Fact> {
    let (kinds, names) = (scene.kinds(), scene.inventory.names());
    let first = |is_bond| {
        let kind = kinds.iter().find(|kind| kind.is_bond() == is_bond)?;
        Some(row(design, analysis, &names, kind))
    };
    let mut facts = Vec::new();
    let Some(bond) = first(true) else {
        let value = energy(analysis.bound.1);
        let note = "the tiles do not stay where the target faces coincide".to_owned();
        facts.push(fact("no bond", value, note));
        return facts;
    };
    facts.push(match bond.state.block_energy {
        Some(blocks) => {
            let both = [bond.state.energy, blocks].map(|u| energy(u).replace(' ', "\u{a0}"));
            fact(
                "bond",
                both.join(" / "),
                "as point dipoles / as blocks".to_owned(),
            )
        }
        None => {
            let magnets = format!("magnets as {}s", design.interaction.model.name());
            fact("bond", energy(bond.state.energy), magnets)
        }
    });
    if let Some(share) = bond.capture.filter(|share| share.of > 0) {
        facts.push(Fact::of_share("far starts that bind", &share));
    }
    let way_out = |row: &StateRow| match &row.escape {
        Some(barrier) if barrier.has_way() => {
            let certified = barrier.bounds.above(barrier.from_energy).both();
            let certified = certified.map_or_else(String::new, |(lower, upper)| {
                format!("; certified {}", minus(&si_range(lower, upper, "J", 4)))
            });
            let to = scene.name_of(barrier.to);
            (energy(barrier.forward()), format!("to {to}{certified}"))
        }
        other => {
            let why = other.as_ref().and_then(columns::why_no_way);
            let why = why.unwrap_or("none found").to_owned();
            (why, "no way out".to_owned())
        }
    };
    let (height, note) = way_out(&bond);
    facts.push(fact("barrier out of the bond", height, note));
    match first(false) {
        None => facts.push(fact("traps", "none".to_owned(), String::new())),
        Some(trap) => {
            let note = format!(
                "{}; {:.2} of the bond",
                names[trap.state.id],
                trap.state.energy / bond.state.energy
            );
            facts.push(fact("deepest trap", energy(trap.state.energy), note));
            let (height, note) = way_out(&trap);
            facts.push(fact("barrier out of that trap", height, note));
        }
    }
    facts.push(completeness(analysis));
    if let Some(ended) = analysis.certificate_ended {
        let note = ended_by(ended, "certify", analysis.settings.certify);
        facts.push(fact(
            "certified bounds",
            "wider than asked for".to_owned(),
            note,
        ));
    }
    facts
}

fn fact(name: &str, value: String, note: String) -> Fact {
    Fact {
        name: name.to_owned(),
        value,
        note,
    }
}

/// Whether states may be missing from the list.
fn completeness(analysis: &Analysis) -> Fact {
    let (value, note) = match &analysis.completeness {
        Err(why) => (
            "sampled",
            format!(
                "it may lack some: {why}; of more far starts {} would end in kinds not seen yet",
                percent(&analysis.inventory.unseen())
            ),
        ),
        Ok(known) => {
            let [below, escape, lowest] =
                [known.below, known.escape, known.lowest()].map(|u| minus(&si(u, "J", 3)));
            let claim = format!("no other below {below} takes more than {escape} to leave");
            let ended = known.ended.map_or(String::new(), |ended| {
                let allowed = analysis.settings.completeness.allowed;
                format!("; {}", ended_by(ended, "complete", allowed))
            });
            match known.open.len() {
                0 => ("complete, proved", claim),
                count => (
                    "proved in part",
                    format!(
                        "{claim}, but for {count} {} down to {lowest}{ended}",
                        if count == 1 { "region" } else { "regions" }
                    ),
                ),
            }
        }
    };
    let note = note
        + &analysis.counts.left_out.map_or(String::new(), |left| {
            let lowest = minus(&si(left.lowest, "J", 4));
            format!("; {}", left_out(left, &lowest))
        });
    fact("list of states", value.to_owned(), note)
}

/// The classes of states.
pub fn states(design: &Design, analysis: &Analysis, scene: &Scene) -> Table {
    let (kinds, names) = (scene.kinds(), scene.inventory.names());
    let rows = kinds.iter().map(|kind| row(design, analysis, &names, kind));
    Table {
        title: "States".to_owned(),
        note: "One row for the states that symmetry maps onto each other: the one nearest to the \
               bound configuration. Captured: share of far starts that end in any of them. \
               Attracting, repelling: magnet pairs close together. A click shows the pose."
            .to_owned(),
        states: kinds.iter().map(|kind| kind.first().id).collect(),
        ..of_columns(&columns::states(Output::Page), rows, |at| scene.name_of(at))
    }
}

/// The barriers between classes; a click on one plays its way.
pub fn barriers(analysis: &Analysis, scene: &Scene, played: &[Played]) -> Table {
    let columns = columns::barriers(Output::Page);
    Table {
        title: "Barriers".to_owned(),
        note:
            "The highest energy on the best way found, its certified bounds, and its height seen \
               from either end. A click plays the way."
                .to_owned(),
        paths: analysis
            .inventory
            .barriers
            .iter()
            .map(|barrier| played.iter().position(|way| way.is_over(barrier)))
            .collect(),
        ..of_columns(&columns, &analysis.inventory.barriers, |place| {
            scene.name_of(place)
        })
    }
}

/// A table of the columns that the page shows, `place` naming places.
fn of_columns<Row>(
    columns: &[columns::Column<Row>],
    rows: impl IntoIterator<Item = impl Borrow<Row>>,
    place: impl Fn(Place) -> String,
) -> Table {
    let cell = |cell: Cell| match cell {
        Cell::Value(value) => value,
        Cell::Real(value) => json!(finite(value, DIGITS)),
        Cell::Place(at) => json!(place(at)),
    };
    let cells = |row: &Row| columns.iter().map(|c| cell((c.get)(row))).collect();
    let heads = columns.iter().map(|c| Column::new(c.heading, c.unit));
    Table {
        title: String::new(),
        note: String::new(),
        columns: heads.collect(),
        rows: rows.into_iter().map(|row| cells(row.borrow())).collect(),
        states: Vec::new(),
        paths: Vec::new(),
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
