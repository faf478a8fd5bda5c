//! Sets of words.

mod spaced;
mod text;

use serde_json::{Value, json};

pub use spaced::document as document_of_spaced;
use text::{face, fault, headline, how_many, meetings, told};

use super::document::{Document, Entries, Part, Table, rows};
use super::page::Meetings;
use super::page::meetings::{Carrier, Met};
use super::plots::chart::{Chart, Dimension, Look, Point};
use super::values::positive_zero;
use jobs::word_sets::{Request, file};
use physics::configuration::Configuration;
use physics::units::si;
use physics::words::set::name;
use physics::words::{Answer, Bar, Judgement, Meeting, Question, Shape, Word, frontier};

/// Sets of more words have no map.
pub(super) const MOST_DRAWN: usize = 80;
/// Sets of more words are not listed in full on a terminal.
const LISTED: usize = 40;
/// Bars of a histogram.
const BINS: usize = 40;

/// What there is to know of a set of words.
pub fn document<'a>(request: &'a Request, answer: &'a Answer) -> Document<'a> {
    let (words, bar) = (&answer.words, &request.bar);
    let is_drawn = (1..=MOST_DRAWN).contains(&words.len());
    let map = is_drawn.then(|| map(request, answer));
    let headline = headline(request, answer);
    let set = file::of_words(&headline, words, bar, request.side());
    let mut pictures = Vec::new();
    if let Some(map) = &map {
        pictures.push(map.picture());
        pictures.push(histogram("Gaps of all pairs of words", request.gaps(words)).into());
    }
    if !answer.frontier.is_empty() {
        pictures.push(frontier_chart(answer).into());
    }
    let fault = request.task.rules.fault.map(fault);
    let beyond = answer.beyond.as_ref().and_then(|(point, judgement)| {
        let many = how_many(point.found.words.len(), point.found.upper);
        let gap = judgement.as_ref()?.gap;
        (point.found.words.len() > words.len()).then(|| {
            format!(
                "This gap is a tie of contacts, which neighbours' magnets decide: {many} with the gap \
                 {gap:.4}."
            )
        })
    });
    let drawn = (!answer.complete).then(|| {
        format!(
            "Chosen from {} words drawn at random: there are too many to look at all.",
            answer.candidates
        )
    });
    Document {
        title: format!("{} words of {} magnets", words.len(), request.task.magnets),
        answer: headline,
        remarks: fault
            .map(|kind| format!("All figures with the worst of {kind} in every face."))
            .into_iter()
            .collect(),
        entries: entries(request, answer),
        pictures,
        part: map.map(Part::Meetings),
        beside: [("words.toml".to_owned(), set.into_bytes())].into(),
        notes: beyond.into_iter().chain(drawn).collect(),
        origin: format!(
            "seed {}; {}; {} magnets, places {} apart",
            request.seed,
            meetings(request),
            bar.model.name(),
            si(bar.pitch, "m", 3)
        ),
        ..Document::default()
    }
}

// One line an entry.
#[rustfmt::skip]
fn entries(request: &Request, answer: &Answer) -> Entries {
    let (task, bar, judgement) = (&request.task, &request.bar, answer.judgement.as_ref());
    let worst = judgement.and_then(|it| it.worst);
    let proof = match answer.proved {
        true => "proved".to_owned(),
        false => format!("at most {}", answer.upper),
    };
    let points = points(&answer.frontier).titled("Number of words against the gap", "");
    Entries::default()
        .data("tilebind", env!("CARGO_PKG_VERSION"))
        .data("words", texts(&answer.words))
        .fact("count", "words", answer.words.len()).noted(proof)
        .data("upper_bound", answer.upper)
        .data("proved", answer.proved)
        .fact("gap", "gap", judgement.map(|it| it.gap)).digits(4)
        .fact("bond_J", "weakest bond", judgement.map(|it| it.bond)).digits(4).noted("depth, flush, at contact")
        .fact("worst", "strongest wrong meeting", worst.map(|it| meeting(&it, bar)))
            .viewed(worst.map_or(String::new(), |it| si(it.energy, "J", 4)))
            .noted(worst.map_or(String::new(), |it| told(&it, request, answer)))
        // Where the widest gap of a number of words was asked for: none is wider than this.
        .data("gap_upper_bound", answer.gap_upper)
        // Where the gap asked for is a tie of contacts: the words just beyond it.
        .data("beyond_tie", answer.beyond.as_ref().map(|it| self::points(std::slice::from_ref(it)).json()[0].take()))
        .data("frontier", (!answer.frontier.is_empty()).then(|| points.json()))
        .table(points.in_view().in_file("frontier"))
        .table(list(request, answer).in_view().in_file("words"))
        .table(pairs(request, &answer.words).in_csv("crosstalk"))
        .data("candidates", answer.candidates)
        // Whether these were all words that satisfy the constraints by themselves.
        .data("all_candidates", answer.complete)
        .data("seed", request.seed)
        .data("settings", json!({
            "design": request.design,
            "places": task.places,
            "magnets": task.magnets,
            "gap": match request.question {
                Question::Gap(gap) if request.contacts.is_none() => Some(gap),
                _ => None,
            },
            "count": match request.question {
                Question::Count(count) => Some(count),
                _ => None,
            },
            "contacts": request.contacts,
            "faces": if task.rules.words_meet() { "all" } else { "mates" },
            "shape": match task.rules.shape {
                Shape::None => "none",
                Shape::Shared => "shared",
                Shape::Polar => "polar",
            },
            "flip": task.rules.flip,
            "tolerate": task.rules.fault.map(fault),
            "model": bar.model.name(),
            "magnet_size_m": bar.size,
            "magnet_moment_Am2": bar.moment,
            "inset_m": bar.inset,
            "pitch_m": bar.pitch,
            "balanced": task.constraints.balanced,
            "longest_run": task.constraints.longest_run,
            "mismatches": [
                task.constraints.mismatches,
                task.constraints.complement_mismatches,
                task.constraints.slide_mismatches,
            ],
            "consecutive": task.constraints.consecutive.as_ref().map(|it| [*it.start(), *it.end()]),
            "least_bond_J": task.constraints.least_bond,
            "ranges_J": task.constraints.ranges.iter()
                .map(|it| json!(it.as_ref().map(|it| [*it.start(), *it.end()])))
                .collect::<Value>(),
            "seconds": request.seconds,
        }))
}

fn texts(words: &[Word]) -> Vec<String> {
    words.iter().map(Word::to_string).collect()
}

fn meeting(meeting: &Meeting, bar: &Bar) -> Value {
    json!({
        "first": meeting.first.to_string(),
        "second": meeting.second.to_string(),
        "slide": meeting.slide,
        "slide_m": f64::from(meeting.slide) * bar.pitch,
        "flipped": meeting.flipped,
        // Places of the faulty magnets, where faces may have some.
        "faulty": meeting.faulty,
        "energy_J": positive_zero(meeting.energy),
    })
}

#[rustfmt::skip]
fn points(points: &[(frontier::Point, Option<Judgement>)]) -> Table {
    rows(points)
        .column("asked_gap", "gap asked", "the least gap of the words", |(it, _)| it.asked).digits(4)
        .column("count", "words", "as many were found", |(it, _)| it.found.words.len())
        .column("upper_bound", "at most", "there are no more, proved", |(it, _)| it.found.upper)
            .viewed(|(it, _)| if it.found.is_proved() { "proved".to_owned() } else { it.found.upper.to_string() })
        .column("proved", "", "", |(it, _)| it.found.is_proved())
        .column("gap", "gap reached", "of the words that were found", |(_, it)| it.as_ref().map(|it| it.gap)).digits(4)
        .column("words", "", "", |(it, _)| json!(texts(&it.found.words))).in_json()
        .table("frontier")
}

/// The words, each with its bond and its own worst meeting.
#[rustfmt::skip]
fn list(request: &Request, answer: &Answer) -> Table {
    type Row<'a> = (usize, Word, Option<Meeting>);
    let all = answer.words.iter().enumerate();
    let all = all.map(|(k, word)| -> Row { (k, *word, request.worst(*word, &answer.words)) });
    rows(all)
        .column("name", "name", "of the word; its mate is marked with *", |it| name(it.0))
        .column("word", "word", "read counter-clockwise: N a north pole out, S a south pole", |it| it.1.to_string())
        .column("mate", "mate", "the word that it binds", |it| it.1.mate().to_string())
        .column("bond_J", "bond", "depth of its bond, flush, at contact", |it| request.task.rules.bond(&request.energies, it.1)).digits(4)
        .column("worst_J", "worst meeting", "energy of the wrong meeting that attracts most", |it| it.2.map(|it| it.energy)).digits(4)
        .column("worst_with", "with", "the face of that meeting", |it| it.2.map(|it| it.second.to_string()))
            .viewed(|it| it.2.map_or("-".to_owned(), |it| face(it.second, answer)))
        .column("worst_slide", "slid by", "places", |it| it.2.map(|it| it.slide))
        .column("worst_flipped", "", "", |it| it.2.map(|it| it.flipped))
        .table("words")
        .titled("Words", "")
        .listing(LISTED)
}

/// Every two words, with their mates: the strongest wrong meeting, and the pose of the second tile
/// in the frame of the first where both are squares as wide as the words need.
#[rustfmt::skip]
fn pairs(request: &Request, words: &[Word]) -> Table {
    let pairs = (0..words.len()).flat_map(|i| (i..words.len()).map(move |j| (i, j)));
    let met = pairs.filter_map(|(i, j)| Some((i, j, request.strongest(words[i], words[j])?)));
    let slide = |it: &Meeting| f64::from(it.slide) * request.bar.pitch;
    rows(met)
        .column("first", "", "", |it| name(it.0))
        .column("second", "", "", |it| name(it.1) + if it.2.second == words[it.1] { "" } else { "*" })
        .column("first_code", "", "", |it| it.2.first.to_string())
        .column("second_code", "", "", |it| it.2.second.to_string())
        .column("energy_J", "", "", |it| it.2.energy)
        .column("slide", "", "", |it| it.2.slide)
        .column("slide_m", "", "", move |it| slide(&it.2))
        .column("flipped", "", "", |it| it.2.flipped)
        .column("pose", "", "", move |it| Configuration::new(request.side(), slide(&it.2), 0.0))
        .table("crosstalk")
}

/// How many pairs have which gap.
pub(super) fn histogram(title: &str, gaps: impl Iterator<Item = f64>) -> Chart {
    let mut counts = [0usize; BINS];
    for gap in gaps {
        counts[((gap.clamp(0.0, 1.0) * BINS as f64) as usize).min(BINS - 1)] += 1;
    }
    let middle = |k: usize| (k as f64 + 0.5) / BINS as f64;
    let bars = counts.iter().enumerate();
    let pairs = Dimension::new("pairs", "pairs");
    Chart {
        name: "gaps",
        title: title.to_owned(),
        x: Dimension::new("gap", "gap of the pair").within([0.0, 1.0]),
        y: match counts.iter().max() {
            // No halves.
            Some(most @ ..7) => pairs.marked((0..=*most).map(|count| count as f64)),
            _ => pairs,
        },
        series: Vec::new(),
        remark: String::new(),
    }
    .with(
        "pairs",
        Look::Bars,
        bars.map(|(k, count)| [middle(k), *count as f64]),
    )
}

/// The number of words over the gap; of what is not proved up to the most that there can be.
fn frontier_chart(answer: &Answer) -> Chart {
    const MOST: usize = 1 << 20;
    let points = |is_proved: bool| {
        let points = answer.frontier.iter().map(|it| &it.0);
        let points = points.filter(move |it| it.found.is_proved() == is_proved);
        points.map(move |it| {
            let [count, most] = [it.found.words.len(), it.found.upper.min(MOST)];
            Point {
                x: it.asked,
                y: count as f64,
                ends: (!is_proved).then_some([count as f64, most as f64]),
            }
        })
    };
    Chart {
        name: "frontier",
        title: "Number of words against the gap".to_owned(),
        x: Dimension::new("asked_gap", "gap asked for").within([0.0, 1.0]),
        y: Dimension::new("words", "words").counting(),
        series: Vec::new(),
        remark: String::new(),
    }
    .with("most, proved", Look::Dots, points(true))
    .with("found, and at most", Look::Rings, points(false))
}

/// All faces against all, flush.
fn map(request: &Request, answer: &Answer) -> Meetings {
    let (task, bar, words) = (&request.task, &request.bar, &answer.words);
    let middle = (task.places as f64 - 1.0) / 2.0;
    let place = |k: usize| (k as f64 - middle) * bar.pitch;
    let carrier = Carrier {
        side: request.side(),
        places: (0..task.places).map(place).collect(),
        size: [bar.size[0], bar.size[1]],
        inset: bar.inset,
    };
    let named = words.iter().enumerate();
    let own = named.clone().map(|(k, word)| (name(k), *word));
    let mates = named.map(|(k, word)| (name(k) + "*", word.mate()));
    let faces: Vec<_> = own.chain(mates).collect();
    let m = words.len();
    let met = |i: usize, j: usize| {
        // Where words meet mates only, two words do not, nor two mates.
        if !task.rules.words_meet() && (i < m) == (j < m) {
            return None;
        }
        let worst = task
            .rules
            .strongest_of(&request.energies, faces[i].1, faces[j].1)?;
        Some(Met {
            energy: worst.energy,
            lower: None,
            pose: carrier.flush(f64::from(worst.slide) * bar.pitch),
            over: worst.flipped,
        })
    };
    let bond = answer.judgement.as_ref().map_or(1.0, |it| it.bond);
    Meetings::new(&carrier, &faces, bond, met).titled(
        "Strongest wrong meeting of every two faces",
        "Rows and columns are words and their mates; a number is the attraction as a share of the \
         weakest bond, of flush faces at every slide by whole places. Framed: a word and its own \
         mate, slid. Click a cell to see the tiles.",
    )
}
