//! Sets of words, judged.

use super::Task;
use super::lag::Lags;
use super::rules::{Meeting, Rules};
use super::word::Word;
use crate::parallel;

/// What a set of words is worth: all of it worked out again from the words alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// Depth (J) of the weakest bond of a word and its mate.
    pub bond: f64,
    /// The strongest wrong meeting; `None` where there is none.
    pub worst: Option<Meeting>,
    /// 1 less the strongest wrong attraction over the weakest bond; 1 where nothing wrong attracts.
    pub gap: f64,
}

impl Judgement {
    /// Of words, each with its mate; `None` of no words.
    pub fn of(words: &[Word], lags: &Lags, rules: &Rules) -> Option<Self> {
        let bonds = words.iter().map(|word| rules.bond(lags, *word));
        let bond = bonds.reduce(f64::min)?;
        let strongest_from = |i: usize| {
            let found = words[i..]
                .iter()
                .filter_map(|v| rules.strongest(lags, words[i], *v));
            found.reduce(Meeting::stronger)
        };
        let strongest = parallel::flat_map(0..words.len(), strongest_from);
        let worst = strongest.into_iter().reduce(Meeting::stronger);
        let energy = worst.map_or(f64::INFINITY, |worst| worst.energy);
        Some(Self {
            bond,
            worst,
            gap: gap(bond, energy),
        })
    }
}

/// Words, with what the strongest wrong meeting of every two comes to, so that some can be taken away.
pub(super) struct Weighed<'a> {
    task: &'a Task,
    words: Vec<Word>,
    /// Depths (J).
    bonds: Vec<f64>,
    /// Energies (J) of every word with itself and those after it; infinite where they never meet.
    wrong: Vec<Vec<f64>>,
}

impl<'a> Weighed<'a> {
    pub fn new(task: &'a Task, words: Vec<Word>) -> Self {
        let (lags, rules) = (&task.lags, &task.rules);
        let energy = |u: &Word, v: &Word| {
            let worst = rules.strongest(lags, *u, *v);
            worst.map_or(f64::INFINITY, |worst| worst.energy)
        };
        let from = |i: usize| words[i..].iter().map(|v| energy(&words[i], v)).collect();
        Self {
            bonds: words.iter().map(|word| rules.bond(lags, *word)).collect(),
            wrong: parallel::map(0..words.len(), from),
            task,
            words,
        }
    }

    pub fn words(&self) -> &[Word] {
        &self.words
    }

    /// The first two words that meet most strongly where they should not, and the energy (J).
    fn worst(&self) -> (f64, [usize; 2]) {
        let all = self.wrong.iter().enumerate();
        let all =
            all.flat_map(|(i, row)| row.iter().enumerate().map(move |(k, u)| (*u, [i, i + k])));
        let first = (f64::INFINITY, [0; 2]);
        all.fold(first, |least, it| if it.0 < least.0 { it } else { least })
    }

    /// As [`Judgement`] has it; `None` of no words.
    pub fn gap(&self) -> Option<f64> {
        let bond = self.bonds.iter().copied().reduce(f64::min)?;
        Some(gap(bond, self.worst().0))
    }

    /// Takes a word of the strongest wrong meeting away.
    pub fn drop_worst(&mut self) {
        let (energy, [i, j]) = self.worst();
        let worst = match energy < f64::INFINITY {
            true => self
                .task
                .rules
                .strongest(&self.task.lags, self.words[i], self.words[j]),
            false => None,
        };
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

/// 1 less the strongest wrong attraction over the weakest bond (J), of energies.
fn gap(bond: f64, worst: f64) -> f64 {
    match bond > 0.0 {
        true => 1.0 - (-worst).max(0.0) / bond,
        // With faults a bond may be none at all.
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
