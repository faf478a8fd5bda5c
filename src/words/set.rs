//! Sets of words and their evaluation.

use super::lag::Lags;
use super::rules::{Rules, WrongContact};
use super::word::Word;
use tiles::parallel;

/// The evaluation of a set of words, computed from the words alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// Depth (J) of the weakest bond of a word and its mate.
    pub bond: f64,
    /// The strongest wrong contact; `None` if there is none.
    pub worst: Option<WrongContact>,
    /// 1 - strongest wrong attraction / weakest bond; 1 if nothing wrong attracts.
    pub gap: f64,
}

impl Judgement {
    /// The evaluation of words, each with its mate; `None` without words.
    pub fn of(words: &[Word], lags: &Lags, rules: &Rules) -> Option<Self> {
        let set = Weighed::new(lags, rules, words.to_vec());
        Some(Self {
            bond: set.bond()?,
            worst: set.worst_meeting(),
            gap: set.gap()?,
        })
    }
}

/// Words with the strongest wrong attractions of all pairs, so that some can be removed.
pub(super) struct Weighed<'a> {
    lags: &'a Lags,
    rules: &'a Rules,
    words: Vec<Word>,
    /// Depths (J).
    bonds: Vec<f64>,
    /// Energies (J) of every word with itself and those after it; infinite where they never meet.
    wrong: Vec<Vec<f64>>,
}

impl<'a> Weighed<'a> {
    pub fn new(lags: &'a Lags, rules: &'a Rules, words: Vec<Word>) -> Self {
        let energy = |u: &Word, v: &Word| {
            let worst = rules.strongest(lags, *u, *v);
            worst.map_or(f64::INFINITY, |worst| worst.energy)
        };
        let from = |i: usize| words[i..].iter().map(|v| energy(&words[i], v)).collect();
        Self {
            bonds: words.iter().map(|word| rules.bond(lags, *word)).collect(),
            wrong: parallel::map(0..words.len(), from),
            lags,
            rules,
            words,
        }
    }

    pub fn words(&self) -> &[Word] {
        &self.words
    }

    /// The depth (J) of the weakest bond; `None` without words.
    fn bond(&self) -> Option<f64> {
        self.bonds.iter().copied().reduce(f64::min)
    }

    /// The first two words with the strongest wrong attraction, and its energy (J).
    fn worst(&self) -> (f64, [usize; 2]) {
        let all = self.wrong.iter().enumerate();
        let all =
            all.flat_map(|(i, row)| row.iter().enumerate().map(move |(k, u)| (*u, [i, i + k])));
        let first = (f64::INFINITY, [0; 2]);
        all.fold(first, |least, it| if it.0 < least.0 { it } else { least })
    }

    fn worst_meeting(&self) -> Option<WrongContact> {
        let (energy, [i, j]) = self.worst();
        let meeting = || {
            self.rules
                .strongest(self.lags, self.words[i], self.words[j])
        };
        (energy < f64::INFINITY).then(meeting).flatten()
    }

    /// The gap as in [`Judgement`]; `None` without words.
    pub fn gap(&self) -> Option<f64> {
        Some(gap(self.bond()?, self.worst().0))
    }

    /// Removes a word of the strongest wrong contact.
    pub fn drop_worst(&mut self) {
        let worst = self.worst_meeting();
        let in_worst = |word: &Word| {
            worst.is_some_and(|it| [it.first, it.second, it.second.mate()].contains(word))
        };
        let last = self.words.len() - 1;
        let gone = self.words.iter().position(in_worst).unwrap_or(last);
        self.words.remove(gone);
        self.bonds.remove(gone);
        self.wrong.remove(gone);
        for (i, row) in self.wrong[..gone].iter_mut().enumerate() {
            row.remove(gone - i);
        }
    }
}

/// 1 - strongest wrong attraction / weakest bond, from energies (J).
fn gap(bond: f64, worst: f64) -> f64 {
    match bond > 0.0 {
        true => 1.0 - (-worst).max(0.0) / bond,
        // With faults, a bond may not attract at all.
        false => f64::MIN,
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
