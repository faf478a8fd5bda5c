//! Sets of barcodes: requests, results, the magnets that words are made of, and sets as files.
//!
//! - [`Request`] - what is asked; [`Sought`] - what is found, with all that reproduces it;
//! - [`Spaced`] - words with magnets anywhere along the face, searched and judged over all poses;
//! - [`CrosstalkRequest`] - what is asked of the crosstalk of a set;
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
pub use search::Found;
pub use spaced::Spaced;

use physics::words::{Answer, Bar, Lags, Meeting, Question, Task, Word};

/// Words that were sought, with all that reproduces them.
pub struct Sought {
    /// What was asked.
    pub request: Request,
    /// The design that the magnets are of; `None` for the paper's.
    pub design: Option<String>,
    /// The magnets.
    pub bar: Bar,
    /// Length (m) of the design's target face, or of the paper's.
    pub face: f64,
    /// What words are wanted.
    pub task: Task,
    /// The same, as it is answered.
    pub question: Question,
    /// The energies of the magnets.
    pub energies: Lags,
    /// The answer.
    pub answer: Answer,
}

impl Sought {
    /// Side (m) of square tiles whose faces hold the words' magnets.
    pub fn side(&self) -> f64 {
        side(&self.bar, self.task.places)
    }

    /// How long (m) a face is from the first to the last place of its magnets.
    pub fn needed(&self) -> f64 {
        (self.task.places as f64 - 1.0) * self.bar.pitch + self.bar.size[1]
    }

    /// The greatest pitch (m) with which the words fit on the face, if they do not with theirs.
    pub fn pitch_that_fits(&self) -> Option<f64> {
        let places = self.task.places as f64 - 1.0;
        let pitch = (self.face - self.bar.size[1]) / places;
        (self.needed() > self.face * (1.0 + 1e-9)).then_some(pitch)
    }

    /// The strongest wrong meeting of two words, with their mates, by energies.
    pub fn strongest(&self, u: Word, v: Word) -> Option<Meeting> {
        self.task.rules.strongest(&self.energies, u, v)
    }

    /// The word of the set that a word meets most strongly where it should not, and how.
    pub fn worst(&self, word: Word) -> Option<Meeting> {
        let all = self.answer.words.iter();
        let all = all.filter_map(|other| self.strongest(word, *other));
        all.min_by(|a, b| a.energy.total_cmp(&b.energy))
    }

    /// Every two words, by their places in the set.
    pub fn pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        let count = self.answer.words.len();
        (0..count).flat_map(move |i| (i..count).map(move |j| [i, j]))
    }

    /// 1 less the share of the weakest bond of the strongest wrong meeting of every two words.
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

/// Length (m) of a face with so many places.
pub fn side(bar: &Bar, places: usize) -> f64 {
    let places = places as f64;
    (places * bar.pitch).max((places - 1.0) * bar.pitch + bar.size[1])
}
