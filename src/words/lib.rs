//! Sets of words: barcodes that bind their mates strongly and everything else weakly.
//!
//! A [`Task`] defines a word (places, magnets, energies, constraints) and the wrong contacts of
//! faces; [`search::largest`] finds a largest set with a given gap, [`frontier::widest`] the widest
//! gap of a given number of words, both with a proof if the effort suffices. The gap of a set is
//! `1 - strongest wrong attraction / weakest bond`, for flush faces at contact over all slides.
//!
//! - [`word`] - words as bits; [`lag`] - energies of magnets as a function of the places between
//!   them;
//! - [`rules`] - the wrong contacts; [`fault`] - faulty faces; [`constraint`] - further constraints
//!   on words;
//! - [`candidates`], [`graph`] - possible words, and their compatibility;
//! - [`codes`] - known codes as starting points;
//! - [`clique`], [`local`], [`bound`] - largest sets, with proof; large sets; bounds without search;
//! - [`search`], [`frontier`] - for gaps, counts and both; [`set`] - the evaluation of a set;
//! - [`answer`](mod@answer) - the request of a search and its result;
//! - [`continuous`] - positions and poles together, over all poses;
//! - [`crosstalk`] - attraction of all pairs of words over all poses.

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
pub use rules::{FaceShape, Faces, Rules, WrongContact};
pub use set::Judgement;
pub use word::Word;

/// Number of products of energies and correlations per unit of work.
const WEIGHED_A_UNIT: u64 = 12;

/// The words to search for.
#[derive(Clone, Debug)]
pub struct Task {
    /// Places of a word.
    pub places: usize,
    /// Magnets of a word: as many as places, or fewer if spacing is part of the code.
    pub magnets: usize,
    /// Whether they are upright: north is up.
    pub stands: bool,
    /// Energies of magnets.
    pub lags: Lags,
    /// The wrong contacts.
    pub rules: Rules,
    /// Further constraints on words.
    pub constraints: Constraints,
}

impl Task {
    /// The word with these north and south poles.
    fn word(&self, north: u64, south: u64) -> Word {
        Word::new(north, south, self.places).standing(self.stands)
    }

    /// Whether a word and its mate are interchangeable, so that one of the two suffices.
    fn exchangeable(&self) -> bool {
        self.rules.exchangeable() && self.constraints.exchangeable()
    }

    /// Whether two different words, each valid by itself, are compatible.
    fn compatible(&self, [u, v]: [Word; 2], limit: f64) -> bool {
        // Two names of the same pair of faces are not two words.
        (!self.rules.words_meet() || self.rules.own() || u != v.mate())
            && self.rules.within(&self.lags, u, v, limit)
            && self.constraints.allow_both(&self.lags, &self.rules, u, v)
    }

    /// Units of work to find the strongest wrong contacts of this many words.
    fn weighing(&self, words: usize) -> u64 {
        (words * words / 2) as u64 * self.weighing_two()
    }

    /// How many words can be weighed with this much work.
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

    /// Units of work to check whether two words are compatible.
    pub fn judgement(&self) -> u64 {
        let meetings = self.rules.meetings(self.places) as u64;
        let one = match self.rules.fault {
            Some(_) => (self.places * self.places) as u64,
            None => 1,
        };
        match self.magnets == self.places {
            // Most conflicts are found immediately.
            true => 8 + one * meetings / 4,
            false => 8 + one * meetings,
        }
    }

    /// The evaluation of a set of words; `None` without words.
    pub fn judge(&self, words: &[Word]) -> Option<Judgement> {
        Judgement::of(words, &self.lags, &self.rules)
    }

    /// The deepest bond (J) that any word may have.
    fn deepest_bond(&self) -> f64 {
        let magnets = self.magnets as f64;
        magnets * self.lags.contact() + self.rest()
    }

    /// Bound (J) of the contribution of all pairs except the facing ones to any energy.
    fn rest(&self) -> f64 {
        self.lags.rest(self.magnets as u32, self.magnets as u32)
    }

    /// The smallest number of places in which two words differ that attract by at most `limit` (J)
    /// when aligned, counting only facing magnets; `None` for words with empty places, for words
    /// that bind their own kind (their codes are not those of words with mates), and if any two are
    /// allowed.
    fn distance(&self, limit: f64) -> Option<usize> {
        let contacts = (limit / self.lags.contact() + 1e-9).floor().max(-1.0);
        // Equal minus unequal poles has the parity of their number.
        let differ = (self.places as f64 - contacts) / 2.0;
        let has_mates = !self.rules.own();
        (has_mates && self.magnets == self.places && differ > 0.0).then(|| differ.ceil() as usize)
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
    /// the largest representable number if codes give no bound.
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
