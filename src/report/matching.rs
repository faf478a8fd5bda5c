//! Fits of two outlines, as a document.

use super::document::{Document, Drawing, Table, entries, rows};
use super::files::{PAGE, REPORT};
use super::plots::poses;
use jobs::design::Design;
use jobs::output::Command;
use physics::contact::matching::Match;
use physics::units::si;

/// The files of the command.
pub const FILES: Command = Command {
    name: "match",
    files: &[REPORT, PAGE, "matches.csv"],
    pictures: &["matches"],
};

/// Number of fits on a terminal, and in the picture.
const LISTED: usize = 20;
const DRAWN: usize = 12;

/// The document of the fits of two outlines, longest contact first.
pub fn document<'a>(design: &'a Design, found: &'a [Match]) -> Document<'a> {
    let longest = found.first().map(|longest| {
        let as_long = found
            .iter()
            .filter(|it| it.contact > longest.contact * (1.0 - 1e-5));
        format!(
            "Longest contact {}, in {} of {} fits listed",
            si(longest.contact, "m", 4),
            as_long.count(),
            found.len()
        )
    });
    let drawn = found.iter().take(DRAWN);
    let drawn: Vec<_> = drawn
        .map(|it| {
            (
                it.pose,
                format!("{}, gap {}", si(it.contact, "m", 4), area(it)),
            )
        })
        .collect();
    let title = match found.len() {
        ..=DRAWN => "How the outlines fit, by the length of their contact".to_owned(),
        _ => format!("The {DRAWN} longest contacts"),
    };
    let picture = (!drawn.is_empty()).then(|| {
        Drawing::new(title.clone(), move |sheet| {
            let numbers = table(&found[..drawn.len()]).csv();
            poses::draw(("matches", &title), &design.pair, &drawn, numbers, sheet)
        })
    });
    Document {
        title: format!("{}: how the outlines fit", design.name),
        answer: longest.unwrap_or("no two edges fit together".to_owned()),
        entries: entries(design).table(table(found).in_file("matches").listing(LISTED)),
        printed: Some("matches"),
        pictures: picture.into_iter().collect(),
        origin: "exact polygons, without magnets".to_owned(),
        ..Document::default()
    }
}

/// The fits, longest contact first.
// One line a column.
#[rustfmt::skip]
pub fn table(found: &[Match]) -> Table {
    rows(found)
        .column("pose", "x, y (mm), angle", "of the moving tile", |it| it.pose)
        .column("contact_m", "contact", "length over which the outlines touch", |it| it.contact).digits(4)
        .column("gap_m2", "gap", "area between the tiles inside the convex hull of their contact", |it| it.gap).viewed(|it| area(it))
        .table("matches")
}

fn area(found: &Match) -> String {
    format!("{:.1} cm\u{b2}", 1e4 * found.gap)
}
