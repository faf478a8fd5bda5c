//! The constraints on words of Majumder and Reif (sections 4.3.1 and 4.3.2), after Tulpan, Hoos and
//! Condon, *Stochastic local search algorithms for DNA word design* (DNA8, 2002).
//!
//! Two words *match* at a place where both have the same pole: there one attracts the other's mate.
//! In slid positions, overhanging places count as mismatches. The complement of a word is its mate.

use std::ops::RangeInclusive;

use super::lag::Lags;
use super::rules::Rules;
use super::word::Word;

/// The constraints on words besides the gap; `None`, zero and false mean no constraint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Constraints {
    /// As many north as south poles, or one more of either where their number is odd.
    pub balanced: bool,
    /// Longest run of equal poles.
    pub longest_run: Option<usize>,
    /// Smallest distance of two magnets, in places.
    pub least_spacing: usize,
    /// Smallest number of mismatches of two words, aligned.
    pub mismatches: usize,
    /// Smallest number of mismatches of a word and a complement (its own included), aligned.
    pub complement_mismatches: usize,
    /// Smallest number of mismatches of two words, or a word and a complement, over all slides; for
    /// a word and itself, over slides by at least one place.
    pub slide_mismatches: usize,
    /// Longest run of consecutive matches over all these slides.
    pub consecutive: Option<RangeInclusive<usize>>,
    /// Smallest depth of a bond (J), with the worst faults if faults are allowed.
    pub least_bond: Option<f64>,
    /// Allowed ranges of the lowest energy (J) of two words, of a word and another's mate, and of
    /// two mates.
    pub ranges: [Option<RangeInclusive<f64>>; 3],
}

impl Constraints {
    /// Whether a single word satisfies the constraints.
    pub fn allow(&self, lags: &Lags, rules: &Rules, word: Word) -> bool {
        let excess = word.excess().unsigned_abs();
        let run = self.longest_run;
        (!self.balanced || excess <= word.magnets() % 2)
            && run.is_none_or(|longest| word.longest_run() <= longest)
            && (self.least_spacing < 2 || word.least_spacing() >= self.least_spacing)
            && self
                .least_bond
                .is_none_or(|least| rules.bond(lags, word) >= least)
            && self.allow_both(lags, rules, word, word)
    }

    /// Whether two words that satisfy them individually do so together; also for a word and itself.
    pub fn allow_both(&self, lags: &Lags, rules: &Rules, u: Word, v: Word) -> bool {
        (u == v || mismatches(u, v, 0) >= self.mismatches)
            && mismatches(u, v.mate(), 0) >= self.complement_mismatches
            && self.slides_allow(u, v)
            && self.energies_allow(lags, rules, u, v)
    }

    /// Whether a word may be exchanged for its mate without changing what is allowed.
    pub fn exchangeable(&self) -> bool {
        self.mismatches == self.complement_mismatches && self.ranges.iter().all(Option::is_none)
    }

    fn slides_allow(&self, u: Word, v: Word) -> bool {
        if self.slide_mismatches == 0 && self.consecutive.is_none() {
            return true;
        }
        let last = u.places() as i32 - 1;
        let mut longest = 0;
        for other in [v, v.mate()] {
            for lag in (-last..=last).filter(|lag| *lag != 0 || u != other) {
                if mismatches(u, other, lag) < self.slide_mismatches {
                    return false;
                }
                longest = longest.max(run(u.facing(other, lag)[0]));
            }
        }
        let range = self.consecutive.as_ref();
        range.is_none_or(|range| range.contains(&longest))
    }

    fn energies_allow(&self, lags: &Lags, rules: &Rules, u: Word, v: Word) -> bool {
        let kinds = [
            ([u, v], false),
            ([u, v], true),
            ([u.mate(), v.mate()], false),
        ];
        self.ranges.iter().zip(kinds).all(|(range, (words, mate))| {
            range.as_ref().is_none_or(|range| {
                let energies = rules.energies(lags, words, mate);
                energies.is_empty()
                    || range.contains(&energies.into_iter().fold(f64::INFINITY, f64::min))
            })
        })
    }
}

/// Places of a word that do not match, including overhanging ones.
fn mismatches(u: Word, v: Word, lag: i32) -> usize {
    u.places() - u.facing(v, lag)[0].count_ones() as usize
}

/// The longest run of members of a set.
fn run(mut set: u64) -> usize {
    let mut length = 0;
    while set != 0 {
        set &= set >> 1;
        length += 1;
    }
    length
}

#[cfg(test)]
mod tests {
    use super::*;

    fn allow(constraints: &Constraints, texts: [&str; 2]) -> bool {
        let [u, v] = texts.map(|text| Word::parse(text).unwrap());
        constraints.allow_both(&Lags::contacts(u.places()), &Rules::default(), u, v)
    }

    #[test]
    fn aligned_and_complement() {
        let two = Constraints {
            mismatches: 2,
            ..Constraints::default()
        };
        assert!(allow(&two, ["NNNS", "NNSN"]) && !allow(&two, ["NNNS", "NNNN"]));
        let complement = Constraints {
            complement_mismatches: 1,
            ..Constraints::default()
        };
        // NNSS is its own mate.
        assert!(!allow(&complement, ["NNSS", "NNSS"]) && allow(&complement, ["NNNS", "NNNS"]));
    }

    #[test]
    fn slides_count_what_hangs_over() {
        let least = |slide_mismatches| Constraints {
            slide_mismatches,
            ..Constraints::default()
        };
        // Slid by one place NNNN matches itself three times of four.
        assert!(allow(&least(1), ["NNNN", "NNNN"]) && !allow(&least(2), ["NNNN", "NNNN"]));
    }

    #[test]
    fn consecutive_matches() {
        let range = |range| Constraints {
            consecutive: Some(range),
            ..Constraints::default()
        };
        assert!(allow(&range(3..=3), ["NNNN", "NNNN"]) && !allow(&range(0..=2), ["NNNN", "NNNN"]));
        assert_eq!(run(0b1101_1101), 3);
    }
}
