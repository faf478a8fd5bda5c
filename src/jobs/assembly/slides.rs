//! Slid contacts, which models of tile assembly leave out: faces that bind shifted by some places.
//!
//! In the engines a tile is either exactly in its place or absent. A magnetic tile that slides
//! along a face in overdamped motion stops at the nearest slide at which it is stable. Over all
//! slides by whole places, this module counts how many lead to the aligned contact and how many to
//! a slid one.

use super::Built;
use super::built::Shaken;
use crate::design::WordSet;
use physics::words::{Lags, Rules, Word};

/// The slid contacts of two faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Slid {
    /// The faces.
    pub faces: [usize; 2],
    /// The deepest stable slid contact: the shift of the second face along the first in places
    /// (counter-clockwise), and energy (J).
    pub deepest: Option<(i32, f64)>,
    /// Shares of slides that lead to the aligned contact, and to stable slid ones.
    pub captured: [f64; 2],
}

impl Slid {
    /// Computes them for two faces with their words.
    fn of(lags: &Lags, rules: &Rules, faces: [usize; 2], [first, second]: [Word; 2]) -> Self {
        // Energies (J) over slides, starting with the most clockwise one.
        let middle = usize::from(rules.slides()) * (first.places() - 1);
        let slide = |k: usize| k as i32 - middle as i32;
        let profile: Vec<f64> = (0..=2 * middle)
            .map(|k| rules.energy_at(lags, first, second, slide(k)))
            .collect();
        let at = |k: usize| profile[k];
        let mut ends = [0; 2];
        let mut deepest: Option<(i32, f64)> = None;
        for start in 0..profile.len() {
            let mut here = start;
            loop {
                let low = here.saturating_sub(1);
                let high = (here + 1).min(profile.len() - 1);
                let next = if at(low) < at(high) { low } else { high };
                if at(next) >= at(here) {
                    break;
                }
                here = next;
            }
            if at(here) >= 0.0 {
                continue;
            }
            ends[usize::from(here != middle)] += 1;
            if here != middle && deepest.is_none_or(|(_, energy)| at(here) < energy) {
                deepest = Some((slide(here), at(here)));
            }
        }
        let all = profile.len() as f64;
        Self {
            faces,
            deepest,
            captured: ends.map(|count| f64::from(count) / all),
        }
    }

    /// The energy (J) of the deepest slid contact; 0 if there is none.
    pub fn energy(&self) -> f64 {
        self.deepest.map_or(0.0, |it| it.1)
    }
}

/// The slid contacts of every two faces, if words have a pitch.
pub(super) fn of_all(built: &Built, words: &WordSet, rules: &Rules) -> Vec<Slid> {
    let Some(lags) = Built::lags(words).filter(|_| rules.slides()) else {
        return Vec::new();
    };
    let matrix = &built.matrix;
    let faces = matrix.energies.len();
    let pairs = (0..faces).flat_map(|i| (i..faces).map(move |j| [i, j]));
    let of = |faces: [usize; 2]| Slid::of(&lags, rules, faces, faces.map(|it| matrix.code(it)));
    pairs.map(of).collect()
}

/// A summary of slid contacts.
#[derive(Clone, Copy, Debug)]
pub struct Summary {
    /// The energy of the deepest (J).
    pub deepest: f64,
    /// Number of pairs of faces that a single slid contact holds against Gmc, on a shaken table.
    pub holding: Option<usize>,
    /// Number of all pairs of faces.
    pub pairs: usize,
    /// For a word and its mate: the mean share of slides that lead to slid contacts among those
    /// that lead to any contact.
    pub share: f64,
}

/// Summarises the slid contacts of all pairs of faces.
pub fn summary(built: &Built, shaken: Option<&Shaken>, slides: &[Slid]) -> Option<Summary> {
    let n = built.matrix.words.len();
    let deepest = slides.iter().map(Slid::energy).reduce(f64::min)?;
    let holding = |shaken: &Shaken| {
        let holds = |slid: &&Slid| -slid.energy() / shaken.shaking.kt > shaken.gmc;
        slides.iter().filter(holds).count()
    };
    let own = slides.iter().filter(|it| it.faces[1] - it.faces[0] == n);
    let shares = own.map(|it| it.captured[1] / (it.captured[0] + it.captured[1]));
    Some(Summary {
        deepest,
        holding: shaken.map(holding),
        pairs: slides.len(),
        share: shares.sum::<f64>() / n as f64,
    })
}
