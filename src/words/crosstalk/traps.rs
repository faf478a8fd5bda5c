//! The traps of a word and its own mate, besides their bond.
//!
//! Local minima of the grid, refined; those that end in the bond are not traps.

use super::minima::Grid;
use super::{Couple, Stage};
use tiles::configuration::Configuration;
use tiles::parallel;

/// Poses closer to the bond than this (m, rad) are the bond.
const SAME: f64 = 2e-3;

impl Stage {
    /// For each of these numbers of couples of a word and its mate, the deepest trap found: energy
    /// (J) and pose.
    pub(super) fn traps(
        &self,
        couples: &[Couple],
        own: &[usize],
        grid: &Grid,
    ) -> Vec<Option<(f64, Configuration)>> {
        let (bond, same) = (self.pair.bound, self.contact.scaled(SAME));
        let is_apart = |q: &Configuration| {
            let step = bond.step_to(q);
            step.xy().amax() > same || step.z.abs() > SAME
        };
        parallel::map(own, |&number| {
            let mut minima = grid.minima(number);
            minima.retain(|(energy, _)| *energy < 0.0);
            self.lowest(&couples[number], minima, is_apart)
        })
    }
}
