//! One barrier between two poses, as a document.

use crate::csv::{SEEN, pathway as csv_of, thinned};
use crate::document::{Cell, Document, Drawing, Entries, rows};
use crate::files::{Files, PAGE, REPORT};
use crate::plots::chart::{Chart, Dimension, Look};
use crate::plots::poses;
use crate::states::{barriers, why_no_way};
use jobs::design::Design;
use jobs::output::Command;
use jobs::query::{Answer, Request};
use physics::budget::Ended;
use physics::landscape::minimax::End;
use physics::units::{si, si_range};

/// The files of the command.
pub const FILES: Command = Command {
    name: "barrier",
    files: &[REPORT, PAGE, PATHWAY],
    pictures: &["profile", "poses"],
};

/// The file of the pathway in a results folder.
pub const PATHWAY: &str = "pathway.csv";

/// The document of a barrier; `file` is the file of its pathway, if it is written.
pub fn document<'a>(
    design: &'a Design,
    query: &Request,
    answer: &'a Answer,
    file: Option<&str>,
) -> Document<'a> {
    let barrier = &answer.barrier;
    let uncertified = answer.uncertified.map(|why| format!("no bounds: {why}"));
    let ended = answer.ended.map(Ended::describe);
    let ended = ended.map(|why| format!("bounds are wider than requested: {why}"));
    let mut pictures = vec![ends(design, query, answer)];
    let mut beside = Files::new();
    if barrier.has_way() {
        pictures.insert(0, profile(answer).into());
        let text = csv_of(&barrier.pathway);
        beside.insert(PATHWAY.to_owned(), text.into_bytes());
    }
    Document {
        title: format!("{}: one barrier", design.name),
        answer: sentence(design, query, answer),
        entries: entries(query, answer, file),
        pictures,
        beside,
        notes: uncertified.into_iter().chain(ended).collect(),
        origin: format!("{} magnets", design.interaction.model.name()),
        ..Document::default()
    }
}

/// The barrier as in a list of barriers, with its ends given by poses.
fn entries(query: &Request, answer: &Answer, file: Option<&str>) -> Entries {
    let to = match query.to {
        End::At(pose) => Cell::from(pose),
        End::Free => "free".into(),
    };
    Entries::default()
        .row(barriers([&answer.barrier]))
        .fact("from", "from", query.from)
        .fact("to", "to", to)
        // Why the bounds are null, if they are.
        .data("uncertified", answer.uncertified.map(|why| why.to_string()))
        // What ended the narrowing of bounds early: "work" or "clock" (only with the latter can
        // runs differ).
        .data("ended_by", answer.ended.map(Ended::name))
        .data("pathway", file)
}

fn sentence(design: &Design, query: &Request, answer: &Answer) -> String {
    let (name, barrier) = (&design.name, &answer.barrier);
    let to = match query.to {
        End::At(_) => "the second",
        End::Free => "free",
    };
    if let Some(why) = why_no_way(barrier) {
        return format!("{name}: no path from the first pose to {to}: {why}");
    }
    let certified = barrier
        .certified()
        .map_or_else(String::new, |(lower, upper)| {
            format!(" (certified: {})", si_range(lower, upper, "J", 4))
        });
    format!(
        "{name}: barrier from the first pose to {to} {}{certified}, reverse {}",
        si(barrier.forward(), "J", 4),
        si(barrier.reverse(), "J", 4)
    )
}

/// The energy along the path.
fn profile(answer: &Answer) -> Chart {
    let way = thinned(&answer.barrier.pathway, SEEN);
    Chart::new(
        "profile",
        "Energy along the path",
        Dimension::new("s_m", "way"),
        Dimension::new("energy_J", "energy"),
    )
    .with(
        "energy",
        Look::Line,
        way.into_iter().map(|point| [point.s, point.energy]),
    )
}

/// The tiles at the start, the saddle and the end of the path.
fn ends<'a>(design: &'a Design, query: &Request, answer: &Answer) -> Drawing<'a> {
    let barrier = &answer.barrier;
    let start = (query.from, barrier.from_energy, "start");
    let highest = (barrier.saddle, barrier.saddle_energy, "highest");
    let end = query.to.configuration();
    let end = end.map(|q| (*q, barrier.to_energy, "end"));
    let highest = barrier.has_way().then_some(highest);
    let all: Vec<_> = [start].into_iter().chain(highest).chain(end).collect();
    let title = "Start, saddle and end of the path";
    Drawing::new(title, move |sheet| {
        let told = all
            .iter()
            .map(|(q, energy, name)| (*q, format!("{name}: {}", si(*energy, "J", 4))));
        let numbers = rows(&all)
            .data("at", |(.., name)| *name)
            .data("pose", |(q, ..)| *q)
            .data("energy_J", |(_, energy, _)| *energy)
            .table("");
        let told: Vec<_> = told.collect();
        poses::draw(("poses", title), &design.pair, &told, numbers.csv(), sheet)
    })
}
