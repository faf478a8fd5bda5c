//! The traps of a word and its own mate, besides their bond.
//!
//! Local minima of a grid over tilt and slide in contact, each refined; those that end in the bond
//! are not traps.

use ordered_float::OrderedFloat;

use super::Stage;
use super::grid::{AtTilt, Setting};
use crate::configuration::Configuration;
use crate::order::Order;
use crate::parallel;
use crate::words::Word;

/// Number of minima of the grid that are refined for a word.
pub(super) const POLISHED: usize = 8;
/// Poses closer to the bond than this (m, rad) are the bond.
const SAME: f64 = 2e-3;

impl Stage {
    /// For each word and its mate, the deepest trap found: energy (J) and pose.
    pub(super) fn traps(
        &self,
        words: &[Word],
        grid: &[AtTilt],
    ) -> Vec<Option<(f64, Configuration)>> {
        let mut rows: Vec<&AtTilt> = grid.iter().collect();
        rows.order_by(|a, b| a.tilt.total_cmp(&b.tilt));
        parallel::map(0..words.len(), |number| {
            let level = |i: usize, j: usize| rows[i].own[j].1[number];
            let mut minima: Vec<(f64, Setting)> = Vec::new();
            for i in 0..rows.len() {
                for j in 0..rows[i].own.len() {
                    let about = |k: usize, count: usize| k.saturating_sub(1)..(k + 2).min(count);
                    let here = level(i, j);
                    let lies_low =
                        |i: usize| about(j, rows[i].own.len()).all(|j| level(i, j) >= here);
                    if here < 0.0 && about(i, rows.len()).all(lies_low) {
                        minima.push((here, [rows[i].tilt, rows[i].own[j].0, 0.0]));
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
}
