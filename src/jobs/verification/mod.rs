//! A second reader of analyses: checks what results folders state, with other code than made them.
//!
//! report.json holds the tiles as plain numbers. From these this module computes energies and
//! clearances again, by its own formulas, and checks every state, saddle and point of a pathway; that
//! no pathway exceeds its upper bound, over whole segments, by interval arithmetic; that no pathway
//! stays below a lower bound; that counts add up; and that bounds of the same barrier by several runs
//! overlap. It uses nothing else of this crate but the reader of text and threads.
//!
//! It does not search: that lower bounds hold for all other paths, and that no state is missing, it
//! cannot confirm.

mod charges;
mod checks;
mod distance;
mod energy;
mod faces;
mod folder;
mod given;
mod interval;
mod radial;
mod stacks;

use std::path::PathBuf;

pub use checks::{Check, Subject};

use crate::refused::Refused;
use checks::Book;
use folder::{apart, named};
use given::{BarrierEnd, Given, Pose};
use physics::observer::Observer;

/// Poses of one state by two runs differ by less than this (m and rad).
const SAME: f64 = 1e-5;

/// What was checked.
#[derive(Clone, Debug)]
pub struct Verified {
    /// The folders with the names of their designs.
    pub folders: Vec<(String, String)>,
    /// All checks, in the order of [`Subject::ALL`].
    pub checks: Vec<Check>,
    /// What could not be checked, and why.
    pub unchecked: Vec<String>,
}

impl Verified {
    /// Everything that does not hold, in sentences.
    pub fn contradictions(&self) -> impl Iterator<Item = &str> {
        self.checks
            .iter()
            .flat_map(|it| &it.contradicted)
            .map(String::as_str)
    }

    /// The number of statements that hold.
    pub fn confirmed(&self) -> usize {
        self.checks.iter().map(|it| it.confirmed).sum()
    }

    /// The number of statements that could not be decided.
    pub fn open(&self) -> usize {
        self.checks.iter().map(|it| it.open).sum()
    }
}

/// Checks results folders of analyses.
///
/// # Errors
/// If a folder holds no report of an analysis.
pub fn verify(folders: &[PathBuf], observer: &dyn Observer) -> Result<Verified, Refused> {
    observer.stage("reading", 0.0);
    let given: Result<Vec<Given>, String> = folders.iter().map(|it| given::read(it)).collect();
    let given = given?;
    observer.stage("checks", 0.05);
    let mut book = Book::default();
    let mut unchecked = Vec::new();
    let mut names = Vec::new();
    for (done, (folder, given)) in folders.iter().zip(&given).enumerate() {
        observer.part("folders", done, folders.len());
        let name = folder.display().to_string();
        let found = folder::check(given);
        book.add(found.book, &format!("{name}: "));
        unchecked.extend(
            found
                .unchecked
                .into_iter()
                .map(|it| format!("{name}: {it}")),
        );
        names.push((name, given.report.design.name.clone()));
    }
    for (number, first) in given.iter().enumerate() {
        for (other, second) in given.iter().enumerate().skip(number + 1) {
            let names = [&names[number].0, &names[other].0];
            compare(names, [first, second], &mut book);
        }
    }
    Ok(Verified {
        folders: names,
        checks: book.checks(),
        unchecked,
    })
}

/// Whether the bounds of the same barriers by two runs overlap.
fn compare(names: [&String; 2], given: [&Given; 2], book: &mut Book) {
    let [first, second] = given.map(|it| &it.report);
    let (ours, theirs) = (&first.settings, &second.settings);
    if first.design.sha256 != second.design.sha256
        || ours.model != theirs.model
        || ours.shields != theirs.shields
    {
        return;
    }
    let depth = first.bound.energy.abs().max(second.bound.energy.abs());
    let pose = |it: &Given, place: BarrierEnd| -> Option<Pose> {
        match place {
            BarrierEnd::State(id) => it.report.states.get(id).map(|it| it.pose),
            BarrierEnd::Free(_) => None,
        }
    };
    let is_same = |a: BarrierEnd, b: BarrierEnd| match (pose(given[0], a), pose(given[1], b)) {
        (Some(a), Some(b)) => apart(a, b) <= SAME,
        (None, None) => true,
        _ => false,
    };
    for a in &first.barriers {
        let mut all = second.barriers.iter();
        let Some(b) = all.find(|b| is_same(a.from, b.from) && is_same(a.to, b.to)) else {
            continue;
        };
        let lower = a
            .lower
            .into_iter()
            .chain(b.lower)
            .fold(f64::NEG_INFINITY, f64::max);
        let upper = a
            .upper
            .into_iter()
            .chain(b.upper)
            .fold(f64::INFINITY, f64::min);
        let holds = lower <= upper + 1e-9 * depth && (a.caged == b.caged || upper.is_infinite());
        book.note(Subject::Brackets, holds, || {
            format!(
                "barrier {} to {} of {} and {}: a lower bound of {lower:e} J and an upper bound of \
                 {upper:e} J",
                named(a.from),
                named(a.to),
                names[0],
                names[1]
            )
        });
    }
}
