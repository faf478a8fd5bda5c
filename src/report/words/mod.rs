//! Sets of words: the answer in words, tables, `words.toml`.

mod bar;
mod continuous;
mod files;
mod spaced;
mod text;

use serde_json::{Value, json};

pub use bar::bar;
pub use continuous::Spaced;
use continuous::{rounded, toml as spaced_toml};
pub use files::{files, set_toml};
pub use spaced::SpacedError;
pub use text::{headline, meetings, summary};

use super::json as layout;
use super::values::positive_zero;
use physics::words::frontier::Point;
pub use physics::words::set::name;
use physics::words::{Answer, Bar, Fault, Judgement, Lags, Meeting, Question, Shape, Task, Word};

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
