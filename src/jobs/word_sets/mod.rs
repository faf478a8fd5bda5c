//! Sets of barcodes: requests, results, the magnets that words are made of, and sets as files.
//!
//! - [`Request`] - the options; [`Sought`] - the result, with everything needed to reproduce it;
//! - [`Spaced`] - words with magnets anywhere along the face, searched and evaluated over all
//!   poses;
//! - [`CrosstalkRequest`] - the options of the crosstalk of a set;
//! - [`bar()`] - the magnets of a design's face; [`mod@file`] - `words.toml`, as [`crate::design::WordSet`]
//!   reads it.

mod bar;
mod crosstalk;
pub mod file;
mod request;
mod search;
mod spaced;

pub use bar::{bar, least_spacing};
pub use crosstalk::CrosstalkRequest;
pub use request::{Request, gap, shape};
pub use search::WordsResult;
pub use spaced::Spaced;

use crate::design::Design;
use physics::words::{Answer, Bar, Lags, Question, Task, Word, WrongContact};

/// The result of a search for words, with everything needed to reproduce it.
pub struct Sought {
    /// The request.
    pub request: Request,
    /// The design of the magnets; `None` for the paper's.
    pub design: Option<String>,
    /// The magnets.
    pub bar: Bar,
    /// Length (m) of the design's target face, or of the paper's.
    pub face: f64,
    /// The requirements of the words.
    pub task: Task,
    /// The same, as given to the search.
    pub question: Question,
    /// The energies of the magnets.
    pub energies: Lags,
    /// The answer.
    pub answer: Answer,
}

impl Sought {
    /// Side (m) of square tiles with room for the words' magnets: that of the design if they fit.
    pub fn side(&self) -> f64 {
        match self.design.is_some() && self.pitch_that_fits().is_none() {
            true => self.face,
            false => side(&self.bar, self.task.places),
        }
    }

    /// Distance (m) from the first to the last place of a face's magnets.
    pub fn needed(&self) -> f64 {
        (self.task.places as f64 - 1.0) * self.bar.pitch + self.bar.size[1]
    }

    /// The largest pitch (m) with which the words fit on the face, if they do not fit with their
    /// own.
    pub fn pitch_that_fits(&self) -> Option<f64> {
        let places = self.task.places as f64 - 1.0;
        let pitch = (self.face - self.bar.size[1]) / places;
        (self.needed() > self.face * (1.0 + 1e-9)).then_some(pitch)
    }

    /// The strongest wrong contact of two words and their mates, by energies.
    pub fn strongest(&self, u: Word, v: Word) -> Option<WrongContact> {
        self.task.rules.strongest(&self.energies, u, v)
    }

    /// The word of the set with the strongest wrong contact with a given word, and that contact.
    pub fn worst(&self, word: Word) -> Option<WrongContact> {
        let all = self.answer.words.iter();
        let all = all.filter_map(|other| self.strongest(word, *other));
        all.min_by(|a, b| a.energy.total_cmp(&b.energy))
    }

    /// All pairs of words, by their indices in the set.
    pub fn pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        let count = self.answer.words.len();
        (0..count).flat_map(move |i| (i..count).map(move |j| [i, j]))
    }

    /// The gap of every two words: 1 - strongest wrong attraction / weakest bond of the set.
    pub fn gaps(&self) -> impl Iterator<Item = f64> {
        let set = &self.answer.words;
        let bonds = set.iter();
        let bonds = bonds.map(|word| self.task.rules.bond(&self.energies, *word));
        let weakest = bonds.fold(f64::INFINITY, f64::min);
        self.pairs().map(move |[i, j]| {
            let worst = self.strongest(set[i], set[j]);
            1.0 - worst.map_or(0.0, |it| (-it.energy / weakest).max(0.0))
        })
    }
}

/// Length (m) of a design's target face.
pub fn face(design: &Design) -> f64 {
    let pair = &design.pair;
    pair.fixed.faces[pair.target.0].length()
}

/// Side (m) of a square tile with a number of places on each face, whose magnets leave room for
/// each other at the corners.
pub fn side(bar: &Bar, places: usize) -> f64 {
    let places = places as f64;
    let depth = bar.inset + bar.size[0];
    (places * bar.pitch).max((places - 1.0) * bar.pitch + bar.size[1] + 2.0 * depth)
}
