//! Crosstalk as a document: the attraction of every two words over all poses.

use super::document::{Document, Drawing, Entries, PagePart, Table, rows};
use super::files::{PAGE, REPORT};
use super::page::Meetings;
use super::page::meetings::{Carrier, Met};
use super::plots::chart::{Chart, Dimension, Look};
use super::values::{pose, positive_zero, read_pose};
use jobs::design::WordSet;
use jobs::output::Command;
use physics::configuration::Configuration;
use physics::order::Order;
use physics::units::{counted, si};
use physics::words::crosstalk::{ContactKind, Crosstalk, StrongestContact};
use physics::words::set::name;

/// The files of the command.
pub const FILES: Command = Command {
    name: "crosstalk",
    files: &[REPORT, PAGE, "crosstalk.csv"],
    pictures: &["crosstalk", "gaps"],
};

/// Number of contacts shown to people, strongest first, and on a terminal.
const SHOWN: usize = 100;
const LISTED: usize = 5;
/// Sets with more words than this have no map.
pub(super) const MOST_DRAWN: usize = 80;
/// Bars of a histogram.
const BINS: usize = 40;

/// The document of the crosstalk of a set.
pub fn document<'a>(set: &'a WordSet, found: &'a Crosstalk) -> Document<'a> {
    let map = map(set, found);
    Document {
        title: format!("Crosstalk of {} words", found.words.len()),
        answer: headline(set, found),
        entries: entries(set, found),
        pictures: pictures(map.as_ref(), found),
        part: map.map(PagePart::Meetings),
        notes: vec![
            "Words may also trap their own mates. Traps are found by search, not proved complete."
                .to_owned(),
        ],
        origin: format!(
            "{} magnets; all poses in which two faces can meet",
            set.stage.interaction.model.name()
        ),
        ..Document::default()
    }
}

// One line an entry.
#[rustfmt::skip]
fn entries(set: &WordSet, found: &Crosstalk) -> Entries {
    let numbers = |matrix: &Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        matrix.iter().map(|row| row.iter().copied().map(positive_zero).collect()).collect()
    };
    let worst = found.strongest_wrong();
    let [all, strongest] = tables(set, found);
    Entries::default()
        .data("tilebind", env!("CARGO_PKG_VERSION"))
        .data("words", found.words.iter().map(ToString::to_string).collect::<Vec<_>>())
        .fact("count", "words", found.words.len())
        // Rows and columns: words, then their mates.
        .data("faces", found.faces().map(|word| word.to_string()).collect::<Vec<_>>())
        // The positions of the words' places along the face, if they are not one pitch apart.
        .data("places_m", set.places.clone())
        .data("strongest_J", numbers(&found.strongest))
        .data("lower_J", found.lower.as_ref().map(numbers))
        .data("poses", found.poses.iter().map(|row| row.iter().map(pose).collect()).collect::<Vec<Vec<_>>>())
        // For each word and its own mate, the deepest stable contact found besides the bond.
        .data("traps_J", found.traps.iter().map(|it| it.map(|it| positive_zero(it.0))).collect::<Vec<_>>())
        .data("trap_poses", found.traps.iter().map(|it| it.map(|it| pose(&it.1))).collect::<Vec<_>>())
        .fact("bond_J", "weakest bond", found.weakest_bond().map(|bond| -bond.1)).digits(4).noted("depth")
        .fact("gap", "gap", found.gap()).digits(4).noted("over sampled poses")
        .fact("worst_J", "strongest wrong meeting", worst.map(|it| it.energy)).digits(4)
            .noted(worst.map_or(String::new(), |it| met(set, found, &it)))
        .table(strongest)
        .table(all)
        .data("model", set.stage.interaction.model.name())
        .data("pitch_m", set.stage.pitch)
        // Whether all lower bounds are as close as requested.
        .data("settled", found.lower.as_ref().map(|_| found.settled))
        .data("cells", found.cells)
}

/// All contacts, traps last, for programs; and the strongest wrong ones for people.
pub(super) fn tables(set: &WordSet, found: &Crosstalk) -> [Table; 2] {
    let mut wrong: Vec<StrongestContact> = found.wrong().collect();
    wrong.order_by(|a, b| a.energy.total_cmp(&b.energy));
    let note = match wrong.len().saturating_sub(SHOWN) {
        0 => String::new(),
        more => format!("{more} weaker ones are in crosstalk.csv"),
    };
    wrong.truncate(SHOWN);
    let strongest = table(set, found, wrong).titled("Strongest wrong meetings", note);
    [
        table(set, found, found.meetings().collect()).in_csv("crosstalk"),
        strongest.listing(LISTED).in_view(),
    ]
}

// One line a column.
#[rustfmt::skip]
fn table(set: &WordSet, found: &Crosstalk, all: Vec<StrongestContact>) -> Table {
    let codes: Vec<String> = found.faces().map(|word| word.to_string()).collect();
    let face = |it: &StrongestContact, k: usize| face_name(set, found, it.faces[k]);
    let kind = |it: &StrongestContact| match it.kind {
        ContactKind::Bond => "bond",
        ContactKind::Wrong => "wrong",
        ContactKind::Trap => "trap",
    };
    rows(all)
        .column("faces", "faces", "the two faces", |it| met(set, found, it)).in_view()
        .data("first", |it| face(it, 0))
        .data("second", |it| face(it, 1))
        .data("first_code", |it| codes[it.faces[0]].clone())
        .data("second_code", |it| codes[it.faces[1]].clone())
        .column("lower_J", "no lower than", "proved", |it| it.lower).digits(4)
        .column("upper_J", "energy", "lowest energy found", |it| positive_zero(it.energy)).digits(4)
        .column("pose", "x, y (mm), angle", "of the second face's tile in the first one's frame", |it| it.pose)
        .data("meeting", kind)
        .table("meetings")
}

/// The map of all pairs of faces, unless there are too many.
pub(super) fn map(set: &WordSet, found: &Crosstalk) -> Option<Meetings> {
    let pair = &set.stage.pair;
    let (face, magnets) = (pair.target_face(), &pair.fixed.magnets);
    let along = face.tangent();
    let place = |at: nalgebra::Vector2<f64>| (at - face.middle()).dot(&along);
    let places = magnets.iter().map(|magnet| place(magnet.position));
    let carrier = Carrier::of_magnets(face.length(), face.normal(), magnets, places.collect());
    let m = found.words.len();
    let codes: Vec<_> = found.faces().collect();
    // Without mates, if every word is its own.
    let shown = if (0..m).all(|k| found.binds_itself(k)) {
        0..m
    } else {
        0..2 * m
    };
    let named = shown.map(|k| (face_name(set, found, k), codes[k]));
    let faces: Vec<_> = named.collect();
    let met = |i: usize, j: usize| {
        let worst = found.worst(i, j)?;
        Some(Met {
            energy: worst.energy,
            lower: worst.lower,
            pose: worst.pose,
            over: false,
        })
    };
    let bond = found.weakest_bond().map_or(1.0, |bond| -bond.1);
    let map = || {
        Meetings::new(&carrier, &faces, bond, met).titled(
            "Strongest wrong attraction between every two faces, over all poses",
            match faces.len() == m {
                true => {
                    "Rows and columns are words. Numbers are attractions relative to the weakest bond, over \
                     slid, tilted and separated poses. Framed: a word and its own kind, in their deepest trap. \
                     Click a cell to see the tiles."
                }
                false => {
                    "Rows and columns are words and their mates. Numbers are attractions relative to the \
                     weakest bond, over slid, tilted and separated poses. Framed: a word and its own mate, \
                     in their deepest trap. Click a cell to see the tiles."
                }
            },
        )
    };
    (1..=MOST_DRAWN).contains(&m).then(map)
}

/// The map as a picture, and a histogram of the gaps of pairs.
pub(super) fn pictures(map: Option<&Meetings>, found: &Crosstalk) -> Vec<Drawing<'static>> {
    let gaps = histogram("Gaps of all pairs of faces", found.gaps());
    let map = map.map(|map| map.picture());
    map.into_iter().chain([gaps.into()]).collect()
}

/// A histogram of the gaps of pairs.
pub(super) fn histogram(title: &str, gaps: impl Iterator<Item = f64>) -> Chart {
    let mut counts = [0usize; BINS];
    for gap in gaps {
        counts[((gap.clamp(0.0, 1.0) * BINS as f64) as usize).min(BINS - 1)] += 1;
    }
    let middle = |k: usize| (k as f64 + 0.5) / BINS as f64;
    // From the bin below the lowest gap to the one above the highest.
    let first = counts.iter().position(|count| *count > 0).unwrap_or(0);
    let last = counts.iter().rposition(|count| *count > 0).unwrap_or(BINS);
    let bins = first.saturating_sub(1)..(last + 2).min(BINS);
    let ends = [bins.start, bins.end].map(|end| end as f64 / BINS as f64);
    let pairs = Dimension::new("pairs", "pairs");
    Chart::new(
        "gaps",
        title,
        Dimension::new("gap", "gap of the pair").within(ends),
        match counts.iter().max() {
            // Axis marks at whole numbers only.
            Some(most @ ..7) => pairs.marked((0..=*most).map(|count| count as f64)),
            _ => pairs,
        },
    )
    .with(
        "pairs",
        Look::Bars,
        bins.map(|k| [middle(k), counts[k] as f64]),
    )
}

/// The name of a contact, such as `A on B*`; that of a word and its own mate is a trap.
pub(super) fn met(set: &WordSet, found: &Crosstalk, meeting: &StrongestContact) -> String {
    let [a, b] = meeting.faces.map(|face| face_name(set, found, face));
    let trap = if meeting.kind == ContactKind::Trap {
        ", a trap"
    } else {
        ""
    };
    format!("{a} on {b}{trap}")
}

/// The name of a face: `A`, or `A*` for a mate that is another word.
pub(super) fn face_name(set: &WordSet, found: &Crosstalk, face: usize) -> String {
    let word = |k: usize| set.names.get(k).cloned().unwrap_or_else(|| name(k));
    match face.checked_sub(found.words.len()) {
        Some(mate) if found.binds_itself(mate) => word(mate),
        Some(mate) => word(mate) + "*",
        None => word(face),
    }
}

/// The headline: the gap over all poses and its certainty, the weakest bond and the strongest wrong
/// contact.
pub fn headline(set: &WordSet, found: &Crosstalk) -> String {
    let many = counted(found.words.len(), "word");
    let (Some((weakest, bond)), Some(gap)) = (found.weakest_bond(), found.gap()) else {
        return format!("{many}, of which one does not bind its mate");
    };
    let proof = found.proved_gap().map_or(String::new(), |proved| {
        format!("; proved at least {proved:.4}, except for words on their own mates")
    });
    let wrong = match found.strongest_wrong() {
        Some(worst) if worst.energy < 0.0 => format!(
            "strongest wrong meeting {}: {}{} at {}",
            si(-worst.energy, "J", 4),
            met(set, found, &worst),
            if worst.kind == ContactKind::Trap {
                ","
            } else {
                ""
            },
            describe(&worst.pose)
        ),
        _ => "no wrong meeting is attractive".to_owned(),
    };
    format!(
        "{many}: gap {gap:.4} over sampled poses{proof}; weakest bond {} ({}); {wrong}",
        si(-bond, "J", 4),
        face_name(set, found, weakest),
    )
}

/// A pose for the terminal.
fn describe(q: &Configuration) -> String {
    let [x, y, theta] = read_pose(q);
    format!("{x}, {y} mm, {theta} deg")
}
