//! `report.json`: what an analysis found, with all that reproduces it.
//!
//! Every number carries its unit in its key (`energy_J`); poses are `[x, y, theta]` in m, m and
//! rad. All that depends on the machine is under `timing`: everything else is the same for the
//! same design, settings and version. What is not known, or infinite, is null.

mod layout;

use std::borrow::Borrow;

use serde_json::{Value, json};

pub use super::values::positive_zero;
pub use layout::text;

use super::columns::{Column, Output, StateRow, barriers, object, states};
use super::dynamics;
use super::names::{self, alternative_file, place};
use super::values::{pose, proportion};
use jobs::design::Design;
use jobs::pipeline::Analysis;
use physics::budget::Ended;
use physics::landscape::{Alternative, Barrier, PathwayCost};

/// The content of `report.json`.
#[derive(Clone, Debug)]
pub struct Report(Value);

impl Report {
    /// The report of an analysis that took `total_wall` (s).
    pub fn new(design: &Design, analysis: &Analysis, total_wall: f64) -> Self {
        let counts = &analysis.counts;
        let stages = analysis.stages.iter().map(|stage| {
            json!({
                "name": stage.name,
                "wall_s": stage.wall_s,
                "energy_evaluations": stage.energy_evaluations,
            })
        });
        Self(json!({
            "tilebind": env!("CARGO_PKG_VERSION"),
            "design": identity(design),
            "seed": analysis.settings.seed,
            "settings": settings(design, analysis),
            // The configuration in which the target faces coincide, and the state in which the
            // tiles are bound; null if the bond does not hold.
            "bound": {
                "pose": pose(&analysis.bound.0),
                "energy_J": positive_zero(analysis.bound.1),
                "state": analysis.inventory.bound_state,
            },
            "states": entries(&states(Output::Json), StateRow::all(design, analysis, &analysis.inventory.names())),
            "inventory": inventory(analysis),
            // Share of the far starts that ended in no state, and of which rest in something too
            // shallow to be listed or leave the table; inner and outer radius of the ring from
            // which they are drawn.
            "free": {
                "capture": proportion(analysis.uncaptured.all()),
                "ring_m": analysis.ring,
                "at_rest": proportion(analysis.uncaptured.at_rest),
                "gone": proportion(analysis.uncaptured.gone),
            },
            "barriers": entries(&barriers(Output::Json), &analysis.inventory.barriers),
            // Why the bounds of all barriers are null; itself null where they are certified.
            "uncertified": analysis.uncertified.map(|why| why.to_string()),
            // What ended the certificate before all bounds were as narrow as was asked for: "work" or
            // "clock", of which only the latter makes another run differ; null where nothing did.
            "certificate_ended_by": analysis.certificate_ended.map(Ended::name),
            "dynamics": dynamics::json(analysis),
            "alternatives": analysis.inventory.alternatives.iter().map(alternative).collect::<Value>(),
            "counts": {
                "milestones": counts.milestones,
                "edges": counts.edges,
                "transition_states": counts.transition_states,
                // Minima left out because next to nothing keeps them.
                "shallow_minima": analysis.inventory.shallow,
                "energy_evaluations": counts.energy_evaluations,
                // Of the certificate.
                "cells": counts.cells,
            },
            "timing": {"total_wall_s": total_wall, "stages": stages.collect::<Value>()},
        }))
    }

    /// Names no pathway for the escapes of states that are copies of another one.
    pub fn without_copies(mut self) -> Self {
        let states = self.0["states"].as_array_mut().into_iter().flatten();
        for state in states.filter(|state| state["id"] != state["class"]) {
            if let Some(pathway) = state.pointer_mut("/escape/pathway") {
                *pathway = Value::Null;
            }
        }
        self
    }

    /// The text of `report.json`.
    pub fn to_text(&self) -> String {
        text(&self.0)
    }
}

/// A barrier as an entry of `report.json`.
pub fn barrier(barrier: &Barrier) -> Value {
    object(&barriers(Output::Json), barrier)
}

/// Which design was analysed; the checksum is of the design file's bytes.
fn identity(design: &Design) -> Value {
    let mut identity = json!({
        "name": design.name,
        "description": design.description,
        "sha256": design.sha256,
    });
    if !design.drawings.is_empty() {
        identity["drawings"] = json!(design.drawings);
    }
    identity
}

/// All that decides the result, besides the design and the seed.
fn settings(design: &Design, analysis: &Analysis) -> Value {
    let settings = &analysis.settings;
    let shields = &design.interaction.shields;
    json!({
        "model": design.interaction.model.name(),
        // The rule by which shields act; null for bare magnets.
        "shields": (!shields.is_none()).then(|| shields.rule.name()),
        "milestones": settings.milestones,
        "neighbours": analysis.roadmap.neighbours,
        // Energy of Boltzmann's acceptance rule; null for the linear rule.
        "boltzmann_J": settings.boltzmann,
        "thermal_energy_J": analysis.roadmap.edges.thermal_energy,
        "settled": settings.settled,
        "least_depth": settings.least_depth,
        // The deepest kinds of states that are looked at; null for all.
        "kinds": settings.most_kinds,
        "far_starts": settings.far_starts,
        "repeats": settings.repeats,
        // Width to which certified bounds are narrowed; null for a hundredth of the bond or a
        // twentieth of the barrier, whichever is less.
        "tolerance_J": settings.tolerance,
        // Work, counted as what takes about so many seconds of a core, and seconds by the clock, at
        // which the certificate ends; null for no limit. Cells of one barrier at most.
        "certify_work": settings.certify.work,
        "certify_s": settings.certify.seconds,
        "certify_cells": settings.certify_cells,
        // Which barriers are certified, and checked by moving tiles.
        "claims": names::claims(settings.claims),
        // The proof that no state is missing: shares of the depth, and its limits.
        "complete_below": settings.completeness.below,
        "complete_escape": settings.completeness.escape,
        "complete_cells": settings.completeness.cells,
        "complete_work": settings.completeness.allowed.work,
        "complete_s": settings.completeness.allowed.seconds,
    })
}

/// What is proved of the states that may be missing: besides the listed ones no configuration lies
/// below `below_J` from which every way out rises by more than `escape_J`, except in the `open`
/// regions (their `share` is that of the space). `unproved` says why nothing is, and is null
/// otherwise.
fn inventory(analysis: &Analysis) -> Value {
    let mut entry = match &analysis.completeness {
        Ok(known) => json!({
            "below_J": known.below,
            "escape_J": known.escape,
            "complete": known.is_complete(),
            "open": known.open.iter().map(|region| json!({
                "pose": pose(&region.pose),
                "volume": region.volume,
                "lowest_J": region.lowest,
            })).collect::<Value>(),
            "share": known.share,
            "cells": known.cells,
            // What ended the proof before it was done; null where nothing did.
            "ended_by": known.ended.map(Ended::name),
            "unproved": null,
        }),
        Err(why) => json!({
            "below_J": null,
            "escape_J": null,
            "complete": false,
            "open": [],
            "share": 1.0,
            "cells": 0,
            "ended_by": null,
            "unproved": why.to_string(),
        }),
    };
    // Kinds of states that were found and are not listed, as fewer were asked for, and the energy of
    // the deepest; null where all that were found are listed.
    entry["left_out"] = json!(analysis.counts.left_out.map(|left| json!({
        "kinds": left.kinds,
        "lowest_J": left.lowest,
    })));
    // Estimated share of far starts that would end in a kind of state that none has ended in yet.
    entry["unseen"] = proportion(analysis.inventory.unseen());
    entry
}

/// A pathway by another cost than the highest energy: the work against the energy on the way, or
/// -ln of the product of the transition probabilities.
fn alternative(alternative: &Alternative) -> Value {
    let cost = |by: PathwayCost| (alternative.by == by).then_some(alternative.cost);
    json!({
        "from": place(alternative.from),
        "to": place(alternative.to),
        "by": names::cost(alternative.by),
        "work_J": cost(PathwayCost::Work),
        "minus_ln_probability": cost(PathwayCost::Probability),
        "pathway": alternative_file(alternative),
    })
}

fn entries<Row>(
    columns: &[Column<Row>],
    rows: impl IntoIterator<Item = impl Borrow<Row>>,
) -> Value {
    let rows = rows.into_iter();
    rows.map(|row| object(columns, row.borrow())).collect()
}
