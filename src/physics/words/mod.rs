//! Sets of words: barcodes that bind their mates strongly and everything else weakly.
//!
//! A [`Task`] says what a word is (places, magnets, energies, constraints) and which meetings are
//! wrong; [`search::largest`] finds a largest set with a given gap, [`frontier::widest`] the widest
//! gap of a given number of words, both with a proof where the work asked for suffices. The gap of a
//! set is 1 less the strongest wrong attraction over the weakest bond, in energies of flush faces at
//! contact over all slides.
//!
//! - [`word`] - words as bits; [`lag`] - energies of magnets so many places apart;
//! - [`rules`] - which meetings are wrong; [`fault`] - badly made faces; [`constraint`] - what else
//!   is asked of words;
//! - [`candidates`], [`graph`] - words that will do, and which go together;
//! - [`codes`] - known sets to set out from;
//! - [`clique`], [`local`], [`bound`] - largest sets, with proof; large sets; bounds without search;
//! - [`search`], [`frontier`] - of gaps, counts and both; [`set`] - what a set is worth;
//! - [`answer`](mod@answer) - a question answered;
//! - [`continuous`] - positions and poles together, over all poses;
//! - [`crosstalk`] - attraction of every two words over all poses.

pub mod answer;
pub mod bound;
pub mod candidates;
pub mod clique;
pub mod codes;
pub mod constraint;
pub mod continuous;
pub mod crosstalk;
mod effort;
pub mod fault;
pub mod frontier;
pub mod graph;
pub mod lag;
pub mod local;
pub mod rules;
pub mod search;
pub mod set;
pub mod word;

#[cfg(test)]
mod tests;

pub use answer::{Answer, Question, answer};
pub use constraint::Constraints;
pub use effort::Effort;
pub use fault::Fault;
pub use lag::{Bar, BarError, Lags, PAPER_FACE};
pub use rules::{Faces, Meeting, Rules, Shape};
pub use set::Judgement;
pub use word::Word;

/// Products of energies and correlations that take a unit of work.
const WEIGHED_A_UNIT: u64 = 12;

/// What words are wanted.
#[derive(Clone, Debug)]
pub struct Task {
    /// Places of a word.
    pub places: usize,
    /// Magnets of a word: as many as places, or fewer where spacing is part of the code.
    pub magnets: usize,
    /// Whether they stand: north is up.
    pub stands: bool,
    /// Energies of magnets.
    pub lags: Lags,
    /// Which meetings are wrong.
    pub rules: Rules,
    /// What else words must satisfy.
    pub constraints: Constraints,
}

impl Task {
    /// The word with these north and south poles.
    fn word(&self, north: u64, south: u64) -> Word {
        Word::new(north, south, self.places).standing(self.stands)
    }

    /// Whether a word and its mate may be exchanged for one another: then one of the two is enough.
    fn exchangeable(&self) -> bool {
        self.rules.exchangeable() && self.constraints.exchangeable()
    }

    /// Whether two different words, each sound by itself, go together.
    fn compatible(&self, [u, v]: [Word; 2], limit: f64) -> bool {
        // Two names of the same two faces are no two words.
        (!self.rules.words_meet() || u != v.mate())
            && self.rules.within(&self.lags, u, v, limit)
            && self.constraints.allow_both(&self.lags, &self.rules, u, v)
    }

    /// Units of work that finding the strongest wrong meetings of so many words counts as.
    fn weighing(&self, words: usize) -> u64 {
        (words * words / 2) as u64 * self.weighing_two()
    }

    /// How many words can be weighed with so much work.
    fn weighed_with(&self, work: u64) -> usize {
        (2 * work / self.weighing_two()).isqrt() as usize
    }

    fn weighing_two(&self) -> u64 {
        let lags = 2 * self.places as u64;
        let each = match self.rules.fault {
            Some(_) => self.rules.meetings(self.places) as u64 * lags * lags,
            None => self.rules.ways_of_meeting() as u64 * lags * lags / WEIGHED_A_UNIT,
        };
        20 + each
    }

    /// Units of work that finding out whether two words go together counts as.
    pub fn judgement(&self) -> u64 {
        let meetings = self.rules.meetings(self.places) as u64;
        let one = match self.rules.fault {
            Some(_) => (self.places * self.places) as u64,
            None => 1,
        };
        match self.magnets == self.places {
            // Most pairs that conflict do so at once.
            true => 8 + one * meetings / 4,
            false => 8 + one * meetings,
        }
    }

    /// What a set of words is worth; `None` of no words.
    pub fn judge(&self, words: &[Word]) -> Option<Judgement> {
        Judgement::of(words, &self.lags, &self.rules)
    }

    /// The deepest bond (J) that any word may have.
    fn deepest_bond(&self) -> f64 {
        let magnets = self.magnets as f64;
        magnets * self.lags.contact() + self.rest()
    }

    /// The most (J) that all pairs but the facing ones add to any energy.
    fn rest(&self) -> f64 {
        self.lags.rest(self.magnets as u32, self.magnets as u32)
    }

    /// In how many places two words differ at least that attract by at most `limit` (J) where they
    /// lie aligned and only facing magnets count; `None` of words with empty places, and where any two
    /// will do.
    fn distance(&self, limit: f64) -> Option<usize> {
        let contacts = (limit / self.lags.contact() + 1e-9).floor().max(-1.0);
        // Equal less unequal poles are as even or odd as their number.
        let differ = (self.places as f64 - contacts) / 2.0;
        (self.magnets == self.places && differ > 0.0).then(|| differ.ceil() as usize)
    }

    /// Known codes whose words differ enough for a limit (J), largest first.
    fn codes(&self, limit: f64) -> Vec<Vec<Word>> {
        let Some(distance) = self.distance(limit) else {
            return Vec::new();
        };
        let codes = codes::of(self.places, distance).into_iter();
        let word = |bits: u64| {
            let word = self.word(bits, !bits);
            match self.exchangeable() {
                true => word.min(word.mate()),
                false => word,
            }
        };
        codes
            .map(|code| code.into_iter().map(word).collect())
            .collect()
    }

    /// An upper bound of the number of words with wrong attractions up to `limit` (J), from codes;
    /// the largest number there is where codes say nothing.
    fn code_bound(&self, limit: f64) -> usize {
        let Some(distance) = self.distance(limit + self.rest()) else {
            return usize::MAX;
        };
        let code = bound::binary_code(self.places, distance);
        match self.rules.words_meet() {
            true => code / 2,
            false => code,
        }
    }
}
