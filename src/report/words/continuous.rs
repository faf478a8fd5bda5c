//! Sets of words with magnets anywhere along the face, judged over all poses.

use std::fmt::Write;

use serde_json::{Value, json};

use super::{files::set_toml, name};
use crate::crosstalk;
use crate::csv::table;
use crate::files::{Files, with_report};
use crate::json as layout;
use crate::page::Page;
use crate::values::positive_zero;
use jobs::design::WordSet;
use physics::words::continuous::SpacedWord;
use physics::words::crosstalk::Crosstalk;
use physics::words::{Bar, Question};

/// Positions are told to so many metres.
const STEP: f64 = 1e-6;

/// A set of words with magnets anywhere, and what it is worth.
pub struct Spaced {
    /// The words; positions in whole micrometres.
    pub words: Vec<SpacedWord>,
    /// What was asked: gap or number of words.
    pub asked: Question,
    /// The magnets; the pitch is the least spacing.
    pub bar: Bar,
    /// Length of a face (m).
    pub face: f64,
    /// Of all random numbers.
    pub seed: u64,
    /// Work to do (s).
    pub seconds: f64,
    /// The set as a file, and its crosstalk; `None` of no words.
    pub judged: Option<(WordSet, Crosstalk)>,
}

/// A word with its positions rounded as they are told.
pub fn rounded(word: &SpacedWord) -> SpacedWord {
    let round = |at: f64| positive_zero((at / STEP).round() * STEP);
    // As few decimals as a text of it has.
    let told = |at: f64| format!("{:.6}", round(at)).parse().unwrap_or(at);
    SpacedWord {
        magnets: word
            .magnets
            .iter()
            .map(|(at, pole)| (told(*at), *pole))
            .collect(),
    }
}

/// `words.toml`: what `tilebind crosstalk` reads.
pub fn toml(words: &[SpacedWord], bar: &Bar, face: f64, headline: &str) -> String {
    let magnets = |word: &SpacedWord| {
        let letters = word.magnets.iter().map(|(at, pole)| {
            let pole = if *pole > 0 { 'N' } else { 'S' };
            format!("{{ at = {:?}, pole = \"{pole}\" }}", positive_zero(*at))
        });
        format!("magnets = [{}]", letters.collect::<Vec<_>>().join(", "))
    };
    let faces = words
        .iter()
        .map(|word| [magnets(word), magnets(&word.mate())]);
    set_toml(headline, "", bar, face, faces)
}

impl Spaced {
    /// The first sentence.
    pub fn headline(&self) -> String {
        match (&self.judged, self.asked) {
            (Some((set, found)), _) => format!(
                "{}; at least so many, no upper bound known",
                crosstalk::headline(set, found)
            ),
            (None, Question::Gap(gap)) => {
                format!("none found with the gap {gap}, nothing proved")
            }
            (None, _) => "none found, nothing proved".to_owned(),
        }
    }

    /// What the terminal is told.
    pub fn summary(&self) -> String {
        let mut text = self.headline() + ".\n";
        for (k, word) in self.words.iter().enumerate() {
            let places = word
                .magnets
                .iter()
                .map(|(at, _)| format!("{:.1}", 1e3 * at));
            let places = places.collect::<Vec<_>>().join(", ");
            let _ = writeln!(text, "  {:<3} {}   at {places} mm", name(k), word.code());
        }
        text
    }

    fn value(&self) -> Value {
        let (gap, count) = match self.asked {
            Question::Gap(gap) => (Some(gap), None),
            Question::Count(count) => (None, Some(count)),
            Question::Frontier => (None, None),
        };
        let found = self.judged.as_ref().map(|(_, found)| found);
        let worst = self.judged.as_ref().and_then(|(set, found)| {
            let ([i, j], energy, q) = found.strongest_wrong()?;
            let face = |k| crosstalk::face_name(set, found, k);
            Some(json!({
                "first": face(i),
                "second": face(j),
                "pose": q.to_array().map(positive_zero),
                "slide_m": positive_zero(q.y),
                "energy_J": positive_zero(energy),
            }))
        });
        json!({
            "tilebind": env!("CARGO_PKG_VERSION"),
            // Poles in order; where they lie along the face is in positions_m.
            "words": self.words.iter().map(SpacedWord::code).collect::<Vec<_>>(),
            "positions_m": self.words.iter().map(SpacedWord::positions).collect::<Vec<_>>(),
            "count": self.words.len(),
            // None is known: positions are numbers without end.
            "upper_bound": null,
            "proved": false,
            "gap": found.and_then(Crosstalk::gap),
            "bond_J": found.and_then(|found| found.weakest_bond()).map(|bond| -bond.1),
            "worst": worst,
            "seed": self.seed,
            "settings": {
                "continuous": true,
                "gap": gap,
                "count": count,
                "face_m": self.face,
                "least_spacing_m": self.bar.pitch,
                "model": self.bar.model.name(),
                "magnet_size_m": self.bar.size,
                "magnet_moment_Am2": self.bar.moment,
                "inset_m": self.bar.inset,
                "seconds": self.seconds,
            },
        })
    }

    /// What `--json` prints.
    pub fn json(&self) -> String {
        layout::text(&self.value())
    }

    /// All files, made by `command`.
    pub fn files(&self, command: &str) -> Files {
        let judged = self.judged.as_ref();
        let mut files =
            judged.map_or_else(Files::new, |(set, found)| crosstalk::tables(set, found));
        let text = toml(&self.words, &self.bar, self.face, &self.headline());
        files.insert("words.toml".to_owned(), text.into_bytes());
        files.insert("words.csv".to_owned(), self.csv().into_bytes());
        let page = judged.map(|(set, found)| Page::of_crosstalk(set, found));
        with_report(files, page, &self.value(), command)
    }

    /// Every magnet of every word.
    fn csv(&self) -> String {
        let rows = self.words.iter().enumerate().flat_map(|(k, word)| {
            word.magnets.iter().map(move |(at, pole)| {
                let pole = if *pole > 0 { "N" } else { "S" };
                vec![name(k), word.code(), at.to_string(), pole.to_owned()]
            })
        });
        let header = ["name", "word", "at_m", "pole"];
        table(header.map(str::to_owned), rows)
    }
}
