//! Sets of words, judged.

use super::lag::Lags;
use super::rules::{Meeting, Rules};
use super::word::Word;

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
        let mut worst: Option<Meeting> = None;
        for (i, u) in words.iter().enumerate() {
            for v in &words[i..] {
                let found = rules.strongest(lags, *u, *v);
                let worse = |it: &Meeting| worst.is_none_or(|worst| it.energy < worst.energy);
                worst = found.filter(worse).or(worst);
            }
        }
        // With faults a bond may be none at all.
        if bond <= 0.0 {
            return Some(Self {
                bond,
                worst,
                gap: f64::MIN,
            });
        }
        let attraction = worst.map_or(0.0, |worst| (-worst.energy).max(0.0));
        Some(Self {
            bond,
            worst,
            gap: 1.0 - attraction / bond,
        })
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
