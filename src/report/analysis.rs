//! An analysis as a document, with all its files.
//!
//! Every number carries its unit in its key (`energy_J`); poses are `[x, y, theta]` in m, m and
//! rad. Everything that depends on the machine is under `timing`; everything else is the same for
//! the same design, settings and version. Unknown or infinite numbers are null.

use serde_json::{Value, json};

use super::document::{Document, Drawing, Entries, PagePart};
use super::figures::percent;
use super::files::{Files, PAGE, PICTURES, REPORT};
use super::names::{self, alternative_file, pathway_file, place};
use super::page::{Landscape, pathways};
use super::plots::style::minus;
use super::plots::{self, PictureError, Scene, Sheet};
use super::summary::{self, ended_by, left_out};
use super::values::{pose, positive_zero, proportion};
use super::{csv, dynamics, geometry, states, topsearch};
use jobs::design::Design;
use jobs::output::Command;
use jobs::pipeline::Analysis;
use physics::budget::Ended;
use physics::landscape::{Alternative, Barrier, PathwayCost};
use physics::units::{counted, si, si_range};

/// The files of the command.
pub const FILES: Command = Command {
    name: "analyse",
    files: &[
        REPORT,
        PAGE,
        "states.csv",
        "barriers.csv",
        "dynamics.csv",
        "pathways/#-#.csv",
        "pathways/#-#-by-*.csv",
        "topsearch/min.data",
        "topsearch/min.coords",
        "topsearch/ts.data",
        "topsearch/ts.coords",
        "topsearch/pairlist",
    ],
    pictures: &[
        "map",
        "approach",
        "profiles",
        "docking",
        "models",
        "disconnectivity",
        "roadmap",
    ],
};

/// The extent of the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Everything.
    Full,
    /// Without the pathways of copies, the page and the files for TopSearch; pictures only as SVG
    /// (and PDF), without their numbers. For results in a repository.
    Compact,
    /// As [`Extent::Compact`], and without pictures, which can take longer than the analysis.
    Numbers,
}

impl Extent {
    /// Whether a file of this name may be written.
    pub fn may_hold(self, name: &str) -> bool {
        let folder = name.split_once('/').map(|(folder, _)| folder);
        let is_vector = name.ends_with(".svg") || name.ends_with(".pdf");
        match (self, folder) {
            (Self::Full, _) => true,
            (Self::Compact, Some(PICTURES)) => is_vector,
            (Self::Numbers, Some(PICTURES)) => false,
            (_, folder) => name != PAGE && folder != Some(topsearch::FOLDER),
        }
    }
}

/// The document of an analysis, with its duration (s).
pub fn document<'a>(
    design: &'a Design,
    analysis: &'a Analysis,
    scene: &'a Scene<'a>,
    extent: Extent,
    wall: f64,
) -> Document<'a> {
    let is_whole = extent == Extent::Full;
    let played = pathways::played(scene);
    let mut shown = facts(design, analysis, scene)
        .table(summary::listed(design, analysis))
        .table(states::kinds(design, analysis, scene))
        .table(states::shown_barriers(analysis, scene, |barrier| {
            played.iter().position(|way| way.is_over(barrier))
        }))
        .table(pathways::table(&played));
    if let Some(checks) = &analysis.dynamics {
        shown = shown.table(dynamics::table(checks));
    }
    Document {
        title: design.name.clone(),
        answer: summary::answer(design, analysis),
        remarks: summary::remarks(design, analysis),
        entries: report(design, analysis, is_whole, wall).and(shown),
        part: is_whole
            .then(|| PagePart::Landscape(Box::new(Landscape::new(design, scene, played)))),
        pictures: match extent {
            Extent::Numbers => Vec::new(),
            _ => pictures(analysis, scene),
        },
        notes: summary::notes(design, analysis),
        beside: beside(analysis, scene, is_whole),
        origin: format!(
            "seed {}, design sha256 {}",
            analysis.request.seed, design.sha256
        ),
        ..Document::default()
    }
}

/// What is found before anything is proved, for somebody who waits for the proofs.
pub fn unproved<'a>(design: &Design, analysis: &Analysis) -> Document<'a> {
    let begun = "not proved yet: the proofs refine barriers and may add states".to_owned();
    Document {
        title: design.name.clone(),
        answer: summary::answer(design, analysis),
        entries: Entries::default().table(summary::listed(design, analysis)),
        notes: vec![begun],
        ..Document::default()
    }
}

fn pictures<'a>(analysis: &'a Analysis, scene: &'a Scene<'a>) -> Vec<Drawing<'a>> {
    let pictures = [
        Drawing::several("", |sheet| plots::draw_all(scene, sheet)),
        Drawing::new("Roadmap", |sheet| {
            plots::roadmap::draw(scene, &analysis.roadmap, sheet)
        }),
    ];
    pictures.into_iter().map(Drawing::off_page).collect()
}

/// All files of an analysis, with its duration (s), made by `command`; see [`Document::files`].
pub fn files(
    document: &Document,
    extent: Extent,
    sheet: &Sheet,
    command: &str,
) -> (Files, Result<(), PictureError>) {
    let sheet = match extent {
        Extent::Full => *sheet,
        Extent::Compact | Extent::Numbers => sheet.without_bitmaps(),
    };
    let (mut files, drawn) = document.files(&sheet, command);
    files.retain(|name, _| extent.may_hold(name));
    (files, drawn)
}

/// The entries of `report.json`; `is_whole` says whether escapes of copies name their pathways.
// One line an entry.
#[rustfmt::skip]
pub fn report(design: &Design, analysis: &Analysis, is_whole: bool, wall: f64) -> Entries {
    let (counts, catalogue) = (&analysis.counts, &analysis.catalogue);
    Entries::default()
        .data("tilebind", env!("CARGO_PKG_VERSION"))
        .data("design", identity(design))
        .data("tiles", geometry::tiles(design))
        .data("seed", analysis.request.seed)
        .data("settings", settings(design, analysis))
        // The configuration in which the target faces coincide, and the state in which the tiles are
        // bound; null if the bond does not hold.
        .data("bound", json!({
            "pose": pose(&analysis.bound.0),
            "energy_J": positive_zero(analysis.bound.1),
            "state": catalogue.bound_state,
        }))
        .table(states::states(design, analysis, is_whole))
        .data("inventory", missing(analysis))
        // Share of the far starts that ended in no state: those at rest in a minimum too shallow to
        // be listed, and those that left the table; inner and outer radius of the ring of starts.
        .data("free", json!({
            "capture": proportion(analysis.uncaptured.all()),
            "ring_m": analysis.ring,
            "at_rest": proportion(analysis.uncaptured.at_rest),
            "gone": proportion(analysis.uncaptured.gone),
        }))
        .table(states::barriers(&catalogue.barriers))
        // Why the bounds of all barriers are null; itself null if they are certified.
        .data("uncertified", analysis.uncertified.map(|why| why.to_string()))
        // What ended the certification before all bounds were as narrow as requested: "work" or
        // "clock" (only with the latter can runs differ); null if nothing did.
        .data("certificate_ended_by", analysis.certificate_ended.map(Ended::name))
        .data("dynamics", dynamics::json(analysis))
        .data("alternatives", catalogue.alternatives.iter().map(alternative).collect::<Value>())
        .data("counts", json!({
            "milestones": counts.milestones,
            "edges": counts.edges,
            "transition_states": counts.transition_states,
            // Minima omitted because their barriers are negligible.
            "shallow_minima": catalogue.shallow,
            "energy_evaluations": counts.energy_evaluations,
            // Of the certificate.
            "cells": counts.cells,
        }))
        .data("timing", json!({"total_wall_s": wall, "stages": analysis.stages}))
}

/// The analysed design; the checksum is that of the design file's bytes.
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

/// The order of settings in reports; others follow.
#[rustfmt::skip]
const ORDER: &[&str] = &[
    "model", "shields", "milestones", "neighbours", "boltzmann_J", "thermal_energy_J", "settled", "least_depth",
    "kinds", "far_starts", "repeats", "tolerance_J", "certify_work", "certify_s", "certify_cells", "claims",
    "complete_below", "complete_escape", "complete_cells", "complete_work", "complete_s",
];

/// Everything that determines the result, besides the design and the seed: the request, with the
/// roadmap's settings that follow from it. Limits of work are null if there are none.
fn settings(design: &Design, analysis: &Analysis) -> Value {
    let mut all = json!(analysis.request);
    let shields = &design.interaction.shields;
    all["model"] = json!(design.interaction.model.name());
    // The rule of the shields; null for bare magnets.
    all["shields"] = json!((!shields.is_none()).then(|| shields.rule.name()));
    all["neighbours"] = json!(analysis.roadmap.neighbours);
    all["thermal_energy_J"] = json!(analysis.roadmap.edges.thermal_energy);
    // Null for all.
    all["kinds"] = json!(analysis.request.survey.kinds);
    let place = |key: &str| ORDER.iter().position(|known| *known == key);
    let mut all: Vec<(String, Value)> = all.as_object().cloned().into_iter().flatten().collect();
    // The seed and the trajectories of the check have places of their own.
    all.retain(|(key, _)| {
        !["seed", "dynamics_runs", "most_kinds", "added_milestones"].contains(&&key[..])
    });
    all.sort_by_key(|(key, _)| place(key).unwrap_or(ORDER.len()));
    all.into_iter().collect()
}

/// What is proved about missing states: besides the listed states there is no configuration below
/// `below_J` from which every way out rises by more than `escape_J`, except in the `open` regions
/// (`share` is their share of the space). `unproved` says why nothing is proved, and is null
/// otherwise.
fn missing(analysis: &Analysis) -> Value {
    let known = analysis.completeness.as_ref().ok();
    let open = known.iter().flat_map(|known| &known.open).map(|region| {
        json!({
            "pose": pose(&region.pose),
            "volume": region.volume,
            "lowest_J": region.lowest,
        })
    });
    json!({
        "below_J": known.map(|it| it.below),
        "escape_J": known.map(|it| it.escape),
        "complete": known.is_some_and(|it| it.is_complete()),
        "open": open.collect::<Value>(),
        "share": known.map_or(1.0, |it| it.share),
        "cells": known.map_or(0, |it| it.cells),
        // What ended the proof before it was complete; null if nothing did.
        "ended_by": known.and_then(|it| it.ended).map(Ended::name),
        "unproved": analysis.completeness.as_ref().err().map(ToString::to_string),
        // Kinds of states that were found but exceed the requested number, and the energy of the
        // deepest; null if all are listed.
        "left_out": analysis.counts.left_out.map(|left| json!({
            "kinds": left.kinds,
            "lowest_J": left.lowest,
        })),
        // Estimated share of far starts that would end in a kind of state in which none has ended yet.
        "unseen": proportion(analysis.catalogue.unseen()),
    })
}

/// A pathway by a cost other than the maximum energy: the work against the energy on the path, or
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

/// Pathways, and the graph for TopSearch.
fn beside(analysis: &Analysis, scene: &Scene, is_whole: bool) -> Files {
    let catalogue = &analysis.catalogue;
    let states = catalogue.states.iter();
    let states = states.filter(|state| is_whole || state.id == state.class);
    let escapes = states.filter_map(|state| analysis.escape(state.id));
    let barriers = escapes.chain(catalogue.barriers.iter().cloned());
    let barriers = barriers.filter(Barrier::has_way);
    let barriers = barriers.map(|barrier| (pathway_file(&barrier), csv::pathway(&barrier.pathway)));
    let others = catalogue.alternatives.iter();
    let others = others.map(|way| (alternative_file(way), csv::pathway(&way.pathway)));
    let pathways = barriers.chain(others);
    let pathways = pathways.map(|(name, text)| (name, text.into_bytes()));
    pathways
        .chain(topsearch::files(scene, analysis.ring[1]))
        .collect()
}

/// The main facts: the bond, its captures, its escape, the deepest trap.
fn facts(design: &Design, analysis: &Analysis, scene: &Scene) -> Entries {
    let (kinds, names) = (scene.kinds(), scene.catalogue.names());
    let first = |is_bond| {
        let kind = kinds.iter().find(|kind| kind.is_bond() == is_bond)?;
        Some(states::StateRow::of_kind(design, analysis, &names, kind))
    };
    let facts = Entries::default();
    let describe = |facts: Entries, name, value: String, note: String| {
        facts.fact("", name, value).in_view().noted(note)
    };
    let Some(bond) = first(true) else {
        let note = "nothing holds the tiles where the target faces coincide".to_owned();
        return describe(facts, "no bond", energy(analysis.bound.1), note);
    };
    let (value, note) = match bond.state.block_energy {
        Some(blocks) => {
            let both = [bond.state.energy, blocks].map(|u| energy(u).replace(' ', "\u{a0}"));
            (
                both.join(" / "),
                format!("as point dipoles / as {}", design.pair.bodies()),
            )
        }
        None => {
            let magnets = format!(
                "magnets as {}",
                design.interaction.model.plural(&design.pair)
            );
            (energy(bond.state.energy), magnets)
        }
    };
    let mut facts = describe(facts, "bond", value, note);
    if let Some(share) = bond.capture.filter(|share| share.of > 0) {
        let note = format!("{} of {}", share.count, share.of);
        facts = describe(facts, "far starts that bind", percent(&share), note);
    }
    let way_out = |row: &states::StateRow| match &row.escape {
        Some(barrier) if barrier.has_way() => {
            let certified = barrier
                .certified()
                .map_or_else(String::new, |(lower, upper)| {
                    format!("; certified {}", minus(&si_range(lower, upper, "J", 4)))
                });
            let to = scene.name_of(barrier.to);
            (energy(barrier.forward()), format!("to {to}{certified}"))
        }
        other => {
            let why = other.as_ref().and_then(states::why_no_way);
            (
                why.unwrap_or("none found").to_owned(),
                "no way out".to_owned(),
            )
        }
    };
    let (height, note) = way_out(&bond);
    facts = describe(facts, "barrier out of the bond", height, note);
    facts = match first(false) {
        None => describe(facts, "traps", "none".to_owned(), String::new()),
        Some(trap) => {
            let share = trap.state.energy / bond.state.energy;
            let note = format!("{}; {share:.2} of the bond", trap.name);
            facts = describe(facts, "deepest trap", energy(trap.state.energy), note);
            let (height, note) = way_out(&trap);
            describe(facts, "barrier out of that trap", height, note)
        }
    };
    let (value, note) = list(analysis);
    facts = describe(facts, "list of states", value.to_owned(), note);
    match analysis.certificate_ended {
        Some(ended) => {
            let note = ended_by(ended, "certify", analysis.request.certify.allowed());
            describe(
                facts,
                "certified bounds",
                "wider than requested".to_owned(),
                note,
            )
        }
        None => facts,
    }
}

fn energy(value: f64) -> String {
    minus(&si(value, "J", 4))
}

/// Whether states may be missing from the list.
fn list(analysis: &Analysis) -> (&'static str, String) {
    let (value, note) = match &analysis.completeness {
        Err(why) => (
            "sampled",
            format!(
                "some may be missing: {why}; an estimated {} of further far starts would end in \
                 kinds not seen yet",
                percent(&analysis.catalogue.unseen())
            ),
        ),
        Ok(known) => {
            let [below, escape, lowest] =
                [known.below, known.escape, known.lowest()].map(|u| minus(&si(u, "J", 3)));
            let claim = format!("no other state below {below} needs more than {escape} to escape");
            let ended = known.ended.map_or(String::new(), |ended| {
                let allowed = analysis.request.completeness().allowed;
                format!("; {}", ended_by(ended, "complete", allowed))
            });
            match known.open.len() {
                0 => ("complete, proved", claim),
                count => (
                    "proved in part",
                    format!(
                        "{claim}, except in {} with states no deeper than {lowest}{ended}",
                        counted(count, "region")
                    ),
                ),
            }
        }
    };
    let left = analysis.counts.left_out.map_or(String::new(), |left| {
        let lowest = minus(&si(left.lowest, "J", 4));
        format!("; {}", left_out(left, &lowest))
    });
    (value, note + &left)
}
