//! Sets of words with magnets anywhere along the face, evaluated over all poses.

use serde_json::json;

use crate::crosstalk;
use crate::document::{Document, Entries, PagePart, Table, rows};
use crate::values::{pose, positive_zero};
use jobs::word_sets::{Spaced, file};
use physics::units::si;
use physics::words::continuous::SpacedWord;
use physics::words::crosstalk::Crosstalk;
use physics::words::set::name;

/// The document of words with magnets anywhere.
pub(super) fn document(spaced: &Spaced) -> Document<'_> {
    let headline = headline(spaced);
    let set = file::of_spaced(&headline, &spaced.words, &spaced.bar, spaced.face);
    let judged = spaced.judged.as_ref();
    let map = judged.and_then(|(set, found)| crosstalk::map(set, found));
    Document {
        title: format!("{} words with magnets anywhere", spaced.words.len()),
        answer: headline,
        entries: entries(spaced),
        pictures: judged.map_or(Vec::new(), |(_, found)| {
            crosstalk::pictures(map.as_ref(), found)
        }),
        part: map.map(PagePart::Meetings),
        beside: [("words.toml".to_owned(), set.into_bytes())].into(),
        origin: format!(
            "seed {}; {} magnets at least {} apart on faces of {}; all poses in which two faces can meet",
            spaced.request.seed,
            spaced.bar.model.name(),
            si(spaced.bar.pitch, "m", 3),
            si(spaced.face, "m", 3),
        ),
        ..Document::default()
    }
}

fn headline(spaced: &Spaced) -> String {
    match (&spaced.judged, spaced.request.gap) {
        (Some((set, found)), _) => format!(
            "{}; at least this many, no upper bound known",
            crosstalk::headline(set, found)
        ),
        (None, Some(gap)) => format!("none found with the gap {gap}, nothing proved"),
        (None, None) => "none found, nothing proved".to_owned(),
    }
}

// One line an entry.
#[rustfmt::skip]
fn entries(spaced: &Spaced) -> Entries {
    let judged = spaced.judged.as_ref().map(|(set, found)| (set, found));
    let found = judged.map(|it| it.1);
    let worst = judged.and_then(|(set, found)| Some((set, found, found.strongest_wrong()?)));
    let told = worst.map(|(set, found, it)| {
        let [first, second] = it.faces.map(|face| crosstalk::face_name(set, found, face));
        json!({
            "first": first, "second": second, "pose": pose(&it.pose),
            "slide_m": positive_zero(it.pose.y), "energy_J": positive_zero(it.energy),
        })
    });
    let entries = Entries::default()
        .data("tilebind", env!("CARGO_PKG_VERSION"))
        // Poles in order; their positions along the face are in positions_m.
        .data("words", spaced.words.iter().map(|it| it.code(stands(spaced))).collect::<Vec<_>>())
        .data("positions_m", spaced.words.iter().map(SpacedWord::positions).collect::<Vec<_>>())
        .fact("count", "words", spaced.words.len())
        // No bound is known, since positions are continuous.
        .data("upper_bound", ())
        .data("proved", false)
        .fact("gap", "gap", found.and_then(Crosstalk::gap)).digits(4).noted("over sampled poses")
        .fact("bond_J", "weakest bond", found.and_then(|it| it.weakest_bond()).map(|bond| -bond.1)).digits(4)
        .fact("worst", "strongest wrong meeting", told)
            .viewed(worst.map_or(String::new(), |it| si(it.2.energy, "J", 4)))
            .noted(worst.map_or(String::new(), |(set, found, it)| crosstalk::met(set, found, &it)))
        .table(words(spaced).in_view())
        .data("seed", spaced.request.seed)
        .data("settings", json!({
            "continuous": true,
            "gap": spaced.request.gap,
            "count": spaced.request.count,
            "face_m": spaced.face,
            "least_spacing_m": spaced.bar.pitch,
            "model": spaced.bar.model.name(),
            "magnet_size_m": spaced.bar.size,
            "magnet_moment_Am2": spaced.bar.moment,
            "inset_m": spaced.bar.inset,
            "seconds": spaced.request.seconds,
        }));
    judged.iter().fold(entries, |entries, (set, found)| {
        let [all, strongest] = crosstalk::tables(set, found);
        entries.table(strongest).table(all)
    })
}

fn stands(spaced: &Spaced) -> bool {
    spaced.bar.form.stands.is_some()
}

/// The words, and every magnet of each.
#[rustfmt::skip]
fn words(spaced: &Spaced) -> Table {
    let stands = stands(spaced);
    let magnets = |word: &SpacedWord| {
        let code = word.code(stands);
        let poles: Vec<char> = code.chars().collect();
        rows(word.positions().into_iter().zip(poles))
            .data("word", move |_| code.clone())
            .data("at_m", |it| it.0)
            .data("pole", |it| it.1.to_string())
            .table("magnets")
            .in_file("words")
    };
    let places = |word: &SpacedWord| {
        let places = word.magnets.iter().map(|it| format!("{:.1}", 1e3 * it.0));
        places.collect::<Vec<_>>().join(", ") + " mm"
    };
    rows(spaced.words.iter().enumerate())
        .column("name", "name", "of the word; mates are marked with *", |it| name(it.0))
        .column("word", "word", "its poles in order: N or S out of the face, U or D north up or down", |it| it.1.code(stands))
        .column("positions", "magnets at", "along the face, from its centre", move |it| places(it.1))
        .data("magnets", move |it| magnets(it.1))
        .table("words")
        .titled("Words", "")
}
