//! Sets of words: the answer in words, tables, `words.toml`.

mod continuous;
mod files;

use std::fmt::Write;

use serde_json::{Value, json};

pub use continuous::{Spaced, rounded, toml as spaced_toml};
pub use files::files;

use super::json as layout;
use super::values::positive_zero;
use crate::units::si;
use crate::words::frontier::Point;
use crate::words::{Answer, Bar, Faces, Fault, Judgement, Lags, Meeting, Question, Shape, Task, Word};

/// What is written, for the terminal.
pub const FILES: &str = "report.html to look at; words.csv, crosstalk.csv, words.toml, report.json";

/// All that reproduces an answer.
#[derive(Clone, Debug)]
pub struct Request {
    /// The design that the magnets are of; `None` for the paper's.
    pub design: Option<String>,
    /// The magnets.
    pub bar: Bar,
    /// What words are wanted.
    pub task: Task,
    /// What is asked.
    pub question: Question,
    /// Most net contacts of wrong meetings, where contacts are counted in place of energies.
    pub contacts: Option<usize>,
    /// Of all random numbers.
    pub seed: u64,
    /// Work to do (s).
    pub seconds: f64,
    /// The energies of the magnets.
    pub energies: Lags,
}

impl Request {
    /// Side (m) of square tiles whose faces hold the words' magnets.
    pub fn side(&self) -> f64 {
        let places = self.task.places as f64;
        (places * self.bar.pitch).max((places - 1.0) * self.bar.pitch + self.bar.size[1])
    }

    /// What a set of words is worth, by energies.
    pub(super) fn strongest(&self, u: Word, v: Word) -> Option<Meeting> {
        self.task.rules.strongest(&self.energies, u, v)
    }
}

/// Letters of the words: A, B, ... Z, AA, ...
pub fn name(number: usize) -> String {
    let letter = char::from(b'A' + (number % 26) as u8);
    match number / 26 {
        0 => letter.to_string(),
        rest => name(rest - 1) + &letter.to_string(),
    }
}

/// `report.json` without its list of files, and what `--json` prints.
pub fn json(request: &Request, answer: &Answer) -> String {
    layout::text(&value(request, answer))
}

fn value(request: &Request, answer: &Answer) -> Value {
    let (task, bar) = (&request.task, &request.bar);
    let judgement = answer.judgement.as_ref();
    json!({
        "tilebind": env!("CARGO_PKG_VERSION"),
        "words": texts(&answer.words),
        "count": answer.words.len(),
        "upper_bound": answer.upper,
        "proved": answer.proved,
        "gap": judgement.map(|it| it.gap),
        "bond_J": judgement.map(|it| it.bond),
        "worst": judgement.and_then(|it| it.worst).map(|it| meeting(&it, bar)),
        // Where the widest gap of a number of words was asked for: none is wider than this.
        "gap_upper_bound": answer.gap_upper,
        // Where the gap asked for is a tie of contacts: the words just beyond it.
        "beyond_tie": answer.beyond.as_ref().map(point),
        "frontier": (!answer.frontier.is_empty())
            .then(|| answer.frontier.iter().map(point).collect::<Value>()),
        "candidates": answer.candidates,
        // Whether these were all words that satisfy the constraints by themselves.
        "all_candidates": answer.complete,
        // Whether the clock ended the search: only then another run may find other words.
        "stopped_by_clock": answer.late,
        "seed": request.seed,
        "settings": {
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
            "shape": shape(task.rules.shape),
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
        },
    })
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

fn point((point, judgement): &(Point, Option<Judgement>)) -> Value {
    json!({
        "asked_gap": point.asked,
        "count": point.found.words.len(),
        "upper_bound": point.found.upper,
        "proved": point.found.is_proved(),
        "gap": judgement.as_ref().map(|it| it.gap),
        "words": texts(&point.found.words),
    })
}

fn shape(shape: Shape) -> &'static str {
    match shape {
        Shape::None => "none",
        Shape::Shared => "shared",
        Shape::Polar => "polar",
    }
}

/// As `--tolerate` names it.
pub(super) fn fault(fault: Fault) -> &'static str {
    match fault {
        Fault::Missing => "missing=1",
        Fault::Flipped => "flipped=1",
    }
}

/// What the terminal is told.
pub fn summary(request: &Request, answer: &Answer) -> String {
    let mut text = headline(request, answer) + "\n";
    if let Some(kind) = request.task.rules.fault {
        let _ = writeln!(text, "All figures with the worst of {} in every face.", fault(kind));
    }
    if !answer.frontier.is_empty() {
        text += "\ngap asked   words   at most   gap reached\n";
        for (point, judgement) in &answer.frontier {
            let count = point.found.words.len();
            let most = match point.found.is_proved() {
                true => "proved".to_owned(),
                false => point.found.upper.to_string(),
            };
            let gap = judgement
                .as_ref()
                .map_or("-".to_owned(), |it| format!("{:.4}", it.gap));
            let _ = writeln!(text, "{:>9.4}{count:>8}{most:>10}{gap:>14}", point.asked);
        }
        text.push('\n');
    } else if !answer.words.is_empty() && answer.words.len() <= LISTED {
        for (k, word) in answer.words.iter().enumerate() {
            let _ = writeln!(text, "  {:<3} {word}   mate {}", name(k), word.mate());
        }
    }
    if let Some((point, Some(judgement))) = &answer.beyond
        && point.found.words.len() > answer.words.len()
    {
        let many = how_many(point.found.words.len(), point.found.upper);
        let _ = writeln!(
            text,
            "This gap is a tie of contacts, which neighbours' magnets decide: {many} with the gap \
             {:.4}.",
            judgement.gap
        );
    }
    if !answer.complete {
        let _ = writeln!(
            text,
            "Chosen from {} words drawn at random: there are too many to look at all.",
            answer.candidates
        );
    }
    text
}

/// Sets of more words are not listed on the terminal.
const LISTED: usize = 40;

/// The first sentence: how many words, how sure, the weakest bond and the strongest wrong meeting.
pub fn headline(request: &Request, answer: &Answer) -> String {
    let many = match request.question {
        Question::Gap(_) => how_many(answer.words.len(), answer.upper),
        Question::Count(count) if answer.words.is_empty() => match answer.proved {
            true => format!("no {count} words have a gap, proved"),
            false => format!("no {count} words found, nothing proved"),
        },
        Question::Count(count) => {
            let gap = answer.judgement.as_ref().map_or(0.0, |it| it.gap);
            match answer.proved {
                true => format!("{count} words with the gap {gap:.4}, proved widest"),
                false => {
                    let upper = answer.gap_upper.unwrap_or(1.0);
                    format!("{count} words with the gap {gap:.4}, at most {upper:.4}")
                }
            }
        }
        Question::Frontier => {
            let asked = answer.frontier.iter().map(|it| it.0.asked);
            let nearest = asked.min_by(|a, b| (a - 0.5).abs().total_cmp(&(b - 0.5).abs()));
            let many = how_many(answer.words.len(), answer.upper);
            format!("at the gap {:.4}: {many}", nearest.unwrap_or(0.5))
        }
    };
    let Some(judgement) = &answer.judgement else {
        return many;
    };
    let bond = si(judgement.bond, "J", 4);
    let wrong = match judgement.worst {
        Some(worst) if worst.energy < 0.0 => {
            let attraction = si(-worst.energy, "J", 4);
            format!(
                "strongest wrong meeting {attraction}: {}",
                told(&worst, request, answer)
            )
        }
        Some(_) => "nothing wrong attracts".to_owned(),
        None => "nothing wrong meets".to_owned(),
    };
    format!(
        "{many}; gap {:.4}; weakest bond {bond}; {wrong}",
        judgement.gap
    )
}

fn how_many(count: usize, upper: usize) -> String {
    let words = |count| if count == 1 { "word" } else { "words" };
    match (count, upper) {
        (0, 0) => "none exists, proved".to_owned(),
        (0, _) => format!("none found, at most {upper}"),
        (count, upper) if count == upper => format!("{count} {}, proved largest", words(count)),
        (count, upper) => format!("at least {count} {}, at most {upper}", words(count)),
    }
}

/// `A on B*, slid 40 mm`.
fn told(meeting: &Meeting, request: &Request, answer: &Answer) -> String {
    let face = |word: Word| {
        let find = |word| answer.words.iter().position(|other| *other == word);
        find(word)
            .map(name)
            .or_else(|| find(word.mate()).map(|k| name(k) + "*"))
    };
    let [first, second] =
        [meeting.first, meeting.second].map(|word| face(word).unwrap_or(word.to_string()));
    let slide = match meeting.slide {
        0 => "not slid".to_owned(),
        slide => format!("slid {}", si(f64::from(slide) * request.bar.pitch, "m", 3)),
    };
    let flipped = if meeting.flipped { ", turned over" } else { "" };
    format!("{first} on {second}{flipped}, {slide}")
}

/// How faces meet, in words.
pub fn meetings(request: &Request) -> String {
    let rules = &request.task.rules;
    let who = match (rules.faces, rules.words_meet()) {
        (Faces::All, true) | (_, true) => "every face can meet every face",
        _ => "words meet mates only",
    };
    let slides = match rules.shape {
        Shape::None => "at every slide by whole places",
        _ => "held by their shape, without slides",
    };
    let flip = if rules.flip { ", also turned over" } else { "" };
    let fault = rules.fault.map_or("", |fault| match fault {
        Fault::Missing => ", one magnet of each face missing",
        Fault::Flipped => ", one magnet of each face the wrong way round",
    });
    format!("{who}, {slides}{flip}{fault}")
}
