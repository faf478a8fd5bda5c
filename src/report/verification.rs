//! Checks of results folders, as a document.

use super::document::{Document, Entries, Table, rows};
use jobs::verification::{Subject, Verified};
use physics::units::counted;

/// Contradictions listed on a terminal.
const LISTED: usize = 20;

/// The document of checks.
pub fn document(found: &Verified) -> Document<'_> {
    let folders = counted(found.folders.len(), "folder");
    let (confirmed, open) = (found.confirmed(), found.open());
    let contradicted = found.contradictions().count();
    let open = match open {
        0 => String::new(),
        open => format!(", {open} are undecided"),
    };
    let answer = match contradicted {
        0 => format!(
            "verified: {confirmed} statements of {folders} are confirmed, none is contradicted{open}"
        ),
        _ => format!(
            "contradicted: {contradicted} statements of {folders} are wrong, {confirmed} are confirmed{open}"
        ),
    };
    let told = found.contradictions().take(LISTED);
    let mut remarks: Vec<String> = told.map(str::to_owned).collect();
    if contradicted > LISTED {
        remarks.push(format!("and {} more", contradicted - LISTED));
    }
    let unchecked = found.unchecked.iter();
    Document {
        title: "Results checked by a second reader".to_owned(),
        answer,
        remarks,
        entries: entries(found),
        notes: unchecked.map(|it| format!("not checked: {it}")).collect(),
        origin: "formulas and geometry of their own; lower bounds are not proved again".to_owned(),
        ..Document::default()
    }
}

fn entries(found: &Verified) -> Entries {
    Entries::default()
        .data("tilebind", env!("CARGO_PKG_VERSION"))
        .data("verified", found.contradictions().next().is_none())
        .table(folders(found))
        .table(checks(found))
        .data("contradictions", found.contradictions().collect::<Vec<_>>())
        .data("unchecked", found.unchecked.clone())
}

fn folders(found: &Verified) -> Table {
    rows(&found.folders)
        .data("folder", |it| it.0.clone())
        .data("design", |it| it.1.clone())
        .table("folders")
        .in_data()
}

// One line a column.
#[rustfmt::skip]
fn checks(found: &Verified) -> Table {
    let named = |subject: Subject| Subject::ALL[subject as usize];
    rows(&found.checks)
        .column("check", "check", "", move |it| named(it.subject).1)
        .column("confirmed", "confirmed", "", |it| it.confirmed)
        .column("contradicted", "contradicted", "", |it| it.contradicted.len())
        .column("undecided", "undecided", "", |it| it.open)
        .column("allowed", "allowed error", "", move |it| named(it.subject).2)
        .table("checks")
}
