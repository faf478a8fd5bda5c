//! Words that tolerate a faulty tile: one magnet of a face missing, or inserted the wrong way
//! round.
//!
//! Every face may have one such fault, at any place, so that two faces in contact have at most two.
//! With `e[k][j]` the energy of magnet k of the first and j of the second one, and f = 1 for a
//! missing and 2 for a flipped magnet, the energy with faults at k and j is `U - f sum_j e[k][j] -
//! f sum_k e[k][j] + f^2 e[k][j]`.

use super::lag::Lags;
use super::word::{MOST_PLACES, Word};

/// The fault that one magnet of every face may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// It is missing.
    Missing,
    /// It lies the wrong way round.
    Flipped,
}

/// The places of the faulty magnets of two faces; `None` for a face without a fault.
pub type Faulty = [Option<usize>; 2];

impl Fault {
    /// The name of each.
    pub const NAMES: [(&'static str, Self); 2] =
        [("missing=1", Self::Missing), ("flipped=1", Self::Flipped)];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize].0
    }

    /// How many times the energy of a magnet's pairs is subtracted.
    fn factor(self) -> f64 {
        match self {
            Self::Missing => 1.0,
            Self::Flipped => 2.0,
        }
    }

    /// The largest change of net contacts by the faults of two faces.
    pub fn contacts(self) -> i32 {
        match self {
            Self::Missing => 2,
            Self::Flipped => 4,
        }
    }

    /// The minimum of `sign` times the energy (J) of a word and a facing one, slid by s places,
    /// over all faults and none, and the faulty places.
    pub fn least(
        self,
        lags: &Lags,
        sign: f64,
        [first, facing]: [Word; 2],
        s: i32,
    ) -> (f64, Faulty) {
        let n = first.places();
        let pair = |k: usize, j: usize| {
            let poles = f64::from(first.at(k) * facing.at(j));
            sign * poles * lags.apart(j as i32 - k as i32 - s)
        };
        let (mut by_first, mut by_second) = ([0.0; MOST_PLACES], [0.0; MOST_PLACES]);
        for (k, of_first) in by_first[..n].iter_mut().enumerate() {
            for (j, of_second) in by_second[..n].iter_mut().enumerate() {
                let energy = pair(k, j);
                *of_first += energy;
                *of_second += energy;
            }
        }
        let whole: f64 = by_first[..n].iter().sum();
        let factor = self.factor();
        let mut least = (whole, [None, None]);
        let mut offer = |energy: f64, faulty: Faulty| {
            if energy < least.0 {
                least = (energy, faulty);
            }
        };
        for k in (0..n).filter(|k| first.at(*k) != 0) {
            offer(whole - factor * by_first[k], [Some(k), None]);
        }
        for j in (0..n).filter(|j| facing.at(*j) != 0) {
            let alone = whole - factor * by_second[j];
            offer(alone, [None, Some(j)]);
            for k in (0..n).filter(|k| first.at(*k) != 0) {
                let both = alone - factor * by_first[k] + factor * factor * pair(k, j);
                offer(both, [Some(k), Some(j)]);
            }
        }
        least
    }
}
