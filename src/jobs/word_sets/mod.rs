//! Sets of barcodes: what is asked, the magnets that words are made of, and sets as files.
//!
//! - [`Request`] - all that reproduces an answer of [`physics::words::answer()`];
//! - [`Spaced`] - words with magnets anywhere along the face, searched and judged over all poses;
//! - [`bar()`] - the magnets of a design's face; [`mod@file`] - `words.toml`, as [`crate::design::WordSet`]
//!   reads it.

mod bar;
pub mod file;
mod spaced;

pub use bar::bar;
pub use spaced::{Spaced, SpacedError};

use physics::words::{Bar, Lags, Meeting, Question, Task, Word};

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
        side(&self.bar, self.task.places)
    }

    /// The strongest wrong meeting of two words, with their mates, by energies.
    pub fn strongest(&self, u: Word, v: Word) -> Option<Meeting> {
        self.task.rules.strongest(&self.energies, u, v)
    }

    /// The word of a set that a word meets most strongly where it should not, and how.
    pub fn worst(&self, word: Word, set: &[Word]) -> Option<Meeting> {
        let all = set.iter().filter_map(|other| self.strongest(word, *other));
        all.min_by(|a, b| a.energy.total_cmp(&b.energy))
    }

    /// 1 less the share of the weakest bond of the strongest wrong meeting of every two words.
    pub fn gaps(&self, set: &[Word]) -> impl Iterator<Item = f64> {
        let bonds = set.iter();
        let bonds = bonds.map(|word| self.task.rules.bond(&self.energies, *word));
        let weakest = bonds.fold(f64::INFINITY, f64::min);
        let pairs = (0..set.len()).flat_map(|i| (i..set.len()).map(move |j| (i, j)));
        pairs.map(move |(i, j)| {
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
