//! The traps of a word and its own mate, besides their bond.
//!
//! Local minima of a grid over tilt and slide in contact, each refined; those that end in the bond
//! are not traps.

use ordered_float::OrderedFloat;

use super::sampled::{Setting, tilts};
use super::{Couple, Stage, energies};
use crate::configuration::Configuration;
use crate::order::Order;
use crate::parallel;
use crate::words::Word;

/// Number of minima of the grid that are refined for a word.
const POLISHED: usize = 8;
/// Poses closer to the bond than this (m, rad) are the bond.
const SAME: f64 = 2e-3;

impl Stage {
    /// For each word and its mate, the deepest trap found: energy (J) and pose.
    pub(super) fn traps(&self, words: &[Word]) -> Vec<Option<(f64, Configuration)>> {
        let own = |word: &Word| Couple {
            first: *word,
            second: word.mate(),
        };
        let couples: Vec<Couple> = words.iter().map(own).collect();
        let mut tilts = tilts();
        tilts.order_by(f64::total_cmp);
        let slides = self.slides();
        let rows = parallel::map(&tilts, |tilt| -> Vec<Vec<f64>> {
            let at = |slide: &f64| self.all_at([*tilt, *slide, 0.0], &couples);
            slides.iter().map(at).collect()
        });
        parallel::map(0..words.len(), |number| {
            let level = |i: usize, j: usize| rows[i][j][number];
            let mut minima: Vec<(f64, Setting)> = Vec::new();
            for i in 0..tilts.len() {
                for j in 0..slides.len() {
                    let about = |k: usize, count: usize| k.saturating_sub(1)..(k + 2).min(count);
                    let here = level(i, j);
                    let lies_low = |i: usize| about(j, slides.len()).all(|j| level(i, j) >= here);
                    if here < 0.0 && about(i, tilts.len()).all(lies_low) {
                        minima.push((here, [tilts[i], slides[j], 0.0]));
                    }
                }
            }
            minima.order_by_key(|(energy, _)| OrderedFloat(*energy));
            let problem = self.problem_of(words[number], words[number].mate());
            let (bond, same) = (self.pair.bound, self.contact.scaled(SAME));
            let polished = minima
                .into_iter()
                .take(POLISHED)
                .filter_map(|(_, setting)| self.polished(&problem, setting))
                .filter(|(_, q)| {
                    let step = bond.step_to(q);
                    step.xy().amax() > same || step.z.abs() > SAME
                });
            polished.min_by_key(|(energy, _)| OrderedFloat(*energy))
        })
    }

    /// The energies (J) of couples at a setting; infinite if the tiles do not touch.
    fn all_at(&self, setting: Setting, couples: &[Couple]) -> Vec<f64> {
        let Some(q) = self.placed(setting) else {
            return vec![f64::INFINITY; couples.len()];
        };
        let by_magnets = energies(&self.magnets, &q);
        let energy = |couple: &Couple| {
            let sign = |number: usize| couple.sign(number / self.places, number % self.places);
            let pairs = by_magnets.iter().enumerate();
            pairs.map(|(number, energy)| energy * sign(number)).sum()
        };
        couples.iter().map(energy).collect()
    }
}
