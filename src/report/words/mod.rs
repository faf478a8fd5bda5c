//! Sets of words as documents.

mod spaced;
mod text;

use serde_json::{Value, json};

use text::{describe, face, headline, how_many, meetings};

use super::crosstalk::{MOST_DRAWN, histogram};
use super::document::{Document, Entries, PagePart, Table, rows};
use super::files::{PAGE, REPORT};
use super::page::Meetings;
use super::page::meetings::{Carrier, Met};
use super::plots::chart::{Chart, ChartPoint, Dimension, Look};
use super::values::positive_zero;
use jobs::output::Command;
use jobs::word_sets::{Sought, WordsResult, file};
use physics::configuration::Configuration;
use physics::units::si;
use physics::words::frontier::FrontierPoint;
use physics::words::set::name;
use physics::words::{Answer, Bar, Fault, Word, WrongContact};

/// The files of the command.
pub const FILES: Command = Command {
    name: "words",
    files: &[
        REPORT,
        PAGE,
        "words.csv",
        "crosstalk.csv",
        "frontier.csv",
        "words.toml",
    ],
    pictures: &["crosstalk", "gaps", "frontier"],
};

/// Sets with more words than this are not listed in full on a terminal.
const LISTED: usize = 40;

/// The document of a search for words.
pub fn document(found: &WordsResult) -> Document<'_> {
    match found {
        WordsResult::Even(sought) => of_sought(sought),
        WordsResult::Anywhere(spaced) => spaced::document(spaced),
    }
}

fn of_sought(sought: &Sought) -> Document<'_> {
    let (answer, bar) = (&sought.answer, &sought.bar);
    let words = &answer.words;
    let is_drawn = (1..=MOST_DRAWN).contains(&words.len());
    let map = is_drawn.then(|| map(sought));
    let headline = headline(sought);
    let set = file::of_words(
        &headline,
        words,
        bar,
        sought.side(),
        sought.task.rules.own(),
    );
    let mut pictures = Vec::new();
    if let Some(map) = &map {
        pictures.push(map.picture());
        pictures.push(histogram("Gaps of all pairs of words", sought.gaps()).into());
    }
    if !answer.frontier.is_empty() {
        pictures.push(frontier_chart(answer).into());
    }
    let beyond = answer.beyond.as_ref().and_then(|point| {
        let many = how_many(point.found.words.len(), point.found.upper);
        let gap = point.judgement.as_ref()?.gap;
        (point.found.words.len() > words.len()).then(|| {
            format!(
                "By contact counts alone this gap is a tie, which the attraction between neighbouring \
                 magnets decides: {many} with the gap {gap:.4}."
            )
        })
    });
    let drawn = (!answer.complete).then(|| {
        format!(
            "Chosen from {} randomly drawn words: there are too many to search all.",
            answer.candidates
        )
    });
    let fault = sought.request.tolerate.map(Fault::name);
    let faulty = fault.map(|kind| {
        format!(
            "All figures are for the worst case of {kind} in every \
        face."
        )
    });
    Document {
        title: format!("{} words of {} magnets", words.len(), sought.task.magnets),
        answer: headline,
        remarks: faulty.into_iter().chain(too_long(sought)).collect(),
        entries: entries(sought),
        pictures,
        part: map.map(PagePart::Meetings),
        beside: [("words.toml".to_owned(), set.into_bytes())].into(),
        notes: beyond.into_iter().chain(drawn).collect(),
        origin: format!(
            "seed {}; {}; {} magnets, positions {} apart",
            sought.request.seed,
            meetings(&sought.task.rules),
            bar.model.name(),
            si(bar.pitch, "m", 3)
        ),
        ..Document::default()
    }
}

/// A note that the words do not fit on the face, and the pitch with which they do.
fn too_long(sought: &Sought) -> Option<String> {
    let fits = sought.pitch_that_fits()?;
    let [needed, face, pitch] =
        [sought.needed(), sought.face, sought.bar.pitch].map(|length| si(length, "m", 4));
    let whose = match sought.design {
        Some(_) => "the design's target face",
        None => "the paper's face",
    };
    let width = sought.bar.size[1];
    let slots = sought.task.magnets < sought.task.places;
    let way_out = match fits * (1.0 + 1e-9) >= width || (slots && fits > 0.0) {
        // Rounded down, so that it fits.
        true => format!(
            "use --pitch {:.4} or less, fewer positions, or longer tiles",
            (fits * 1e4 + 1e-6).floor() / 1e4
        ),
        false => "use fewer positions or longer tiles".to_owned(),
    };
    Some(format!(
        "! {} positions {pitch} apart take {needed} of face, and {whose} has {face}: {way_out}",
        sought.task.places
    ))
}

// One line an entry.
#[rustfmt::skip]
fn entries(sought: &Sought) -> Entries {
    let Sought { request, task, bar, answer, .. } = sought;
    let judgement = answer.judgement.as_ref();
    let worst = judgement.and_then(|it| it.worst);
    let proof = match answer.proved {
        true => "proved".to_owned(),
        false => format!("at most {}", answer.upper),
    };
    let points = points(&answer.frontier).titled("Number of words versus gap", "");
    Entries::default()
        .data("tilebind", env!("CARGO_PKG_VERSION"))
        .data("words", texts(&answer.words))
        .fact("count", "words", answer.words.len()).noted(proof)
        .data("upper_bound", answer.upper)
        .data("proved", answer.proved)
        .fact("gap", "gap", judgement.map(|it| it.gap)).digits(4)
        .fact("bond_J", "weakest bond", judgement.map(|it| it.bond)).digits(4).noted("depth, \
            flush, in contact")
        .fact("worst", "strongest wrong meeting", worst.map(|it| meeting(&it, bar)))
            .viewed(worst.map_or(String::new(), |it| si(it.energy, "J", 4)))
            .noted(worst.map_or(String::new(), |it| describe(&it, sought)))
        // If the widest gap for a number of words was requested: an upper bound of it.
        .data("gap_upper_bound", answer.gap_upper)
        // If the requested gap coincides with a number of contacts: the number of words just beyond
        // it.
        .data("beyond_tie", answer.beyond.as_ref().map(|it| self::points(std::slice::from_ref(it)).json()[0].take()))
        .data("frontier", (!answer.frontier.is_empty()).then(|| points.json()))
        .table(points.in_view().in_file("frontier"))
        .table(list(sought).in_view().in_file("words"))
        .table(pairs(sought).in_csv("crosstalk"))
        .data("candidates", answer.candidates)
        // Whether these were all words that satisfy the constraints by themselves.
        .data("all_candidates", answer.complete)
        .data("seed", request.seed)
        .data("settings", json!({
            "design": sought.design,
            "places": task.places,
            "magnets": task.magnets,
            "gap": request.gap,
            "count": request.count,
            "contacts": request.contacts,
            "faces": if task.rules.words_meet() { "all" } else { "mates" },
            "self": task.rules.own(),
            "shape": request.shape.name(),
            "flip": request.flip,
            "tolerate": request.tolerate.map(Fault::name),
            "model": bar.model.name(),
            "magnet_size_m": bar.size,
            "magnet_moment_Am2": bar.moment,
            "inset_m": bar.inset,
            "pitch_m": bar.pitch,
            "face_needed_m": sought.needed(),
            "balanced": request.balanced,
            "longest_run": request.max_run,
            "mismatches": request.min_mismatch.unwrap_or_default(),
            "consecutive": request.consecutive,
            "least_bond_J": request.min_bond,
            "ranges_J": [request.word_word, request.word_mate, request.mate_mate],
            "seconds": request.seconds,
        }))
}

fn texts(words: &[Word]) -> Vec<String> {
    words.iter().map(Word::to_string).collect()
}

fn meeting(meeting: &WrongContact, bar: &Bar) -> Value {
    json!({
        "first": meeting.first.to_string(),
        "second": meeting.second.to_string(),
        "slide": meeting.slide,
        "slide_m": f64::from(meeting.slide) * bar.pitch,
        "flipped": meeting.flipped,
        // Places of the faulty magnets, if faults are allowed.
        "faulty": meeting.faulty,
        "energy_J": positive_zero(meeting.energy),
    })
}

#[rustfmt::skip]
fn points(points: &[FrontierPoint]) -> Table {
    rows(points)
        .column("asked_gap", "gap asked", "smallest gap of the words", |it| it.asked).digits(4)
        .column("count", "words", "number found", |it| it.found.words.len())
        .column("upper_bound", "at most", "proved upper bound", |it| it.found.upper)
            .viewed(|it| if it.found.is_proved() { "proved".to_owned() } else { it.found.upper.to_string() })
        .data("proved", |it| it.found.is_proved())
        .column("gap", "gap reached", "of the words found", |it| it.judgement.as_ref().map(|it| it.gap)).digits(4)
        .data("words", |it| json!(texts(&it.found.words))).in_json()
        .table("frontier")
}

/// The words, each with its bond and its worst contact.
#[rustfmt::skip]
fn list(sought: &Sought) -> Table {
    type Row<'a> = (usize, Word, Option<WrongContact>);
    let own = sought.task.rules.own();
    let all = sought.answer.words.iter().enumerate();
    let all = all.map(|(k, word)| -> Row { (k, *word, sought.worst(*word)) });
    rows(all)
        .column("name", "name", "of the word; mates are marked with *", |it| name(it.0))
        .column("word", "word", "read counter-clockwise: N or S out of the face, U or D north up or down", |it| it.1.to_string())
        .column("mate", "mate", "the word that binds it", move |it| match own { true => it.1, false => it.1.mate() }.to_string())
        .column("bond_J", "bond", "depth of its bond, flush, in contact", |it| sought.task.rules.bond(&sought.energies, it.1)).digits(4)
        .column("worst_J", "worst meeting", "energy of the strongest wrong attraction", |it| it.2.map(|it| it.energy)).digits(4)
        .column("worst_with", "with", "the face in that contact", |it| it.2.map(|it| it.second.to_string()))
            .viewed(|it| it.2.map_or("-".to_owned(), |it| face(it.second, sought)))
        .column("worst_slide", "slid by", "places", |it| it.2.map(|it| it.slide))
        .data("worst_flipped", |it| it.2.map(|it| it.flipped))
        .table("words")
        .titled("Words", "")
        .listing(LISTED)
}

/// All pairs of words, including mates: the strongest wrong contact, and the pose of the second
/// tile in the frame of the first for squares as wide as the words need.
#[rustfmt::skip]
fn pairs(sought: &Sought) -> Table {
    let words = &sought.answer.words;
    let met = sought.pairs().filter_map(|[i, j]| Some((i, j, sought.strongest(words[i], words[j])?)));
    let slide = |it: &WrongContact| f64::from(it.slide) * sought.bar.pitch;
    rows(met)
        .data("first", |it| name(it.0))
        .data("second", |it| name(it.1) + if it.2.second == words[it.1] { "" } else { "*" })
        .data("first_code", |it| it.2.first.to_string())
        .data("second_code", |it| it.2.second.to_string())
        .data("energy_J", |it| it.2.energy)
        .data("slide", |it| it.2.slide)
        .data("slide_m", move |it| slide(&it.2))
        .data("flipped", |it| it.2.flipped)
        .data("pose", move |it| Configuration::new(sought.side(), slide(&it.2), 0.0))
        .table("crosstalk")
}

/// The number of words over the gap; if not proved, with its upper bound.
fn frontier_chart(answer: &Answer) -> Chart {
    const MOST: usize = 1 << 20;
    let points = |is_proved: bool| {
        let points = answer.frontier.iter();
        let points = points.filter(move |it| it.found.is_proved() == is_proved);
        points.map(move |it| {
            let [count, most] = [it.found.words.len(), it.found.upper.min(MOST)];
            ChartPoint {
                x: it.asked,
                y: count as f64,
                ends: (!is_proved).then_some([count as f64, most as f64]),
            }
        })
    };
    Chart::new(
        "frontier",
        "Number of words versus gap",
        Dimension::new("asked_gap", "requested gap"),
        Dimension::new("words", "words").counting(),
    )
    .with("most, proved", Look::Dots, points(true))
    .with("found, and at most", Look::Rings, points(false))
}

/// The map of all pairs of flush faces.
fn map(sought: &Sought) -> Meetings {
    let Sought {
        task, bar, answer, ..
    } = sought;
    let words = &answer.words;
    let middle = (task.places as f64 - 1.0) / 2.0;
    let place = |k: usize| (k as f64 - middle) * bar.pitch;
    let carrier = Carrier {
        side: sought.side(),
        places: (0..task.places).map(place).collect(),
        size: [bar.size[0], bar.size[1]],
        inset: bar.inset,
        form: bar.form,
    };
    let named = words.iter().enumerate();
    let own = named.clone().map(|(k, word)| (name(k), *word));
    let mates = named.map(|(k, word)| (name(k) + "*", word.mate()));
    let has_mates = !task.rules.own();
    let faces: Vec<_> = own.chain(mates.filter(|_| has_mates)).collect();
    let m = words.len();
    let met = |i: usize, j: usize| {
        // If words only meet mates, two words do not meet, nor two mates.
        if !task.rules.words_meet() && (i < m) == (j < m) {
            return None;
        }
        let worst = task
            .rules
            .strongest_of(&sought.energies, faces[i].1, faces[j].1)?;
        Some(Met {
            energy: worst.energy,
            lower: None,
            pose: carrier.flush(f64::from(worst.slide) * bar.pitch),
            over: worst.flipped,
        })
    };
    let bond = answer.judgement.as_ref().map_or(1.0, |it| it.bond);
    let [faces_are, framed] = match has_mates {
        true => ["words and their mates", "a word and its own mate"],
        false => [
            "words, which bind their own kind",
            "a word and its own kind",
        ],
    };
    let note = format!(
        "Rows and columns are {faces_are}. Numbers are attractions relative to the weakest bond, \
         for flush faces at every slide by whole positions. Framed: {framed}, slid. Click a cell \
         to see the tiles."
    );
    let meetings = Meetings::new(&carrier, &faces, bond, met);
    meetings.titled("Strongest wrong attraction between every two faces", &note)
}
