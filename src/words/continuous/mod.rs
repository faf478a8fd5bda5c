//! Words without slots, whose spacing is part of the code: positions and poles are optimised
//! together, against all poses of two flat faces.
//!
//! A word is a number of magnets anywhere along a face, with a minimum spacing. Simulated annealing
//! moves magnets, exchanges poles and redraws words to minimise the strongest wrong attraction over
//! the weakest bond. Wrong attractions are evaluated at poses in contact (`pose`): tilted, and slid
//! so that two attracting magnets face each other; the strongest is then refined. For a word and
//! its own mate, slides by at least half the minimum spacing are wrong: smaller ones lie on the
//! slope of the bond.
//!
//! It finds sets, and proves nothing about larger ones or wider gaps. Annealing uses point dipoles;
//! [`crosstalk`](super::crosstalk) evaluates a set over all poses, in the requested model.

mod anneal;
mod pose;

pub use anneal::{Annealed, search};

use super::Bar;
use tiles::tile::barcode::Pole;

/// A word whose magnets lie anywhere along the face.
#[derive(Clone, Debug, PartialEq)]
pub struct SpacedWord {
    /// Position along the face (m, counter-clockwise from its midpoint), ascending, and 1 for a
    /// north pole out (or up), -1 for a south pole.
    pub magnets: Vec<(f64, i32)>,
}

impl SpacedWord {
    /// The word that binds this one.
    pub fn mate(&self) -> Self {
        self.mirrored(-1)
    }

    /// The word on a face that is turned over.
    pub fn turned_over(&self) -> Self {
        self.mirrored(1)
    }

    /// Its poles in order as a code, for lying or upright magnets.
    pub fn code(&self, stands: bool) -> String {
        let poles = self.magnets.iter();
        let poles = poles.filter_map(|(_, pole)| Pole::of(*pole, stands));
        poles.map(Pole::letter).collect()
    }

    /// The positions of its magnets (m).
    pub fn positions(&self) -> Vec<f64> {
        self.magnets.iter().map(|(at, _)| *at).collect()
    }

    fn mirrored(&self, sign: i32) -> Self {
        let magnets = self.magnets.iter().rev();
        Self {
            magnets: magnets.map(|(at, pole)| (-at, sign * pole)).collect(),
        }
    }
}

/// The words to search for.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// Number of magnets of a word.
    pub magnets: usize,
    /// Their size and strength; `pitch` is the smallest distance of two on a face.
    pub bar: Bar,
    /// Length of a face (m); magnets do not reach its ends.
    pub face: f64,
    /// Whether words also meet words, not only mates.
    pub words_meet: bool,
    /// Whether tiles may lie upside down.
    pub flip: bool,
    /// As many north as south poles, or one more.
    pub balanced: bool,
    /// Longest run of equal poles.
    pub longest_run: Option<usize>,
}

impl Wanted {
    /// The length of a face available to the magnets' centres, besides the minimum spacings (m).
    pub fn room(&self) -> f64 {
        self.face - self.bar.size[1] - (self.magnets as f64 - 1.0) * self.bar.pitch
    }

    /// Whether a word satisfies the conditions on face, spacing and poles.
    fn allows(&self, word: &SpacedWord) -> bool {
        let end = (self.face - self.bar.size[1]) / 2.0 * (1.0 + 1e-12);
        let magnets = &word.magnets;
        let spaced = magnets.windows(2);
        let excess: i32 = magnets.iter().map(|(_, pole)| pole).sum();
        let runs = magnets.chunk_by(|a, b| a.1 == b.1).map(<[_]>::len);
        magnets.iter().all(|(at, _)| at.abs() <= end)
            && spaced
                .into_iter()
                .all(|two| two[1].0 - two[0].0 >= self.bar.pitch * (1.0 - 1e-12))
            && (!self.balanced || excess.unsigned_abs() as usize <= self.magnets % 2)
            && self
                .longest_run
                .is_none_or(|most| runs.max().unwrap_or(0) <= most)
    }
}

#[cfg(test)]
mod tests;
