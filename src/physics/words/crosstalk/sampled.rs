//! The strongest attraction of all pairs of faces: the lowest poses of the grid, refined.
//!
//! Every couple keeps its lowest poses of the grid with different tilts; compass search, which may
//! also separate the tiles, moves these to their minima. This is a sample: poses between those of
//! the grid may be lower.

use ordered_float::OrderedFloat;

use super::grid::{AtTilt, FINE, Setting};
use super::{Couple, Stage};
use crate::configuration::Configuration;
use crate::parallel;
use crate::problem::Problem;

/// Number of poses of a couple that are refined.
pub(super) const POLISHED: usize = 4;
/// Final step of compass search (m).
const FINEST: f64 = 1e-6;

impl Stage {
    /// The lowest energy (J) found for each couple, and its pose.
    pub(super) fn sampled(&self, couples: &[Couple], grid: &[AtTilt]) -> Vec<(f64, Configuration)> {
        parallel::map(0..couples.len(), |number| {
            let couple = &couples[number];
            let mut starts: Vec<(f64, Setting)> =
                grid.iter().map(|tilt| tilt.best[number]).collect();
            // The best of every few neighbouring tilts, so that one deep place does not take all.
            let mut chosen = Vec::new();
            while chosen.len() < POLISHED && !starts.is_empty() {
                let lowest = (0..starts.len()).min_by_key(|i| OrderedFloat(starts[*i].0));
                let at = lowest.unwrap_or(0);
                chosen.push(starts[at]);
                let tilt = starts[at].1[0];
                starts.retain(|(_, setting)| (setting[0] - tilt).abs() > 2.5 * FINE.0);
            }
            let problem = self.problem_of(couple.first, couple.second);
            chosen
                .into_iter()
                .filter_map(|(_, setting)| self.polished(&problem, setting))
                .min_by_key(|(energy, _)| OrderedFloat(*energy))
                .unwrap_or((0.0, self.pair.bound))
        })
    }

    /// Compass search from a setting.
    pub(super) fn polished(
        &self,
        problem: &Problem,
        start: Setting,
    ) -> Option<(f64, Configuration)> {
        let value = |setting: Setting| {
            let q = self.placed(setting)?;
            Some((problem.energy(&q), q))
        };
        let lever = self.pair.target_face().length() / 2.0;
        // Faces that repel each other would be drawn back for ever.
        let farthest = 2.0 * lever;
        let mut here = start;
        let mut best = value(here)?;
        let mut step = self.slide_step() / 2.0;
        while step > self.contact.scaled(FINEST) {
            let steps = [step / lever, step, step];
            let moves = (0..3).flat_map(|axis| [1.0, -1.0].map(|sign| (axis, sign)));
            let tried = moves.filter_map(|(axis, sign)| {
                let mut there = here;
                there[axis] += sign * steps[axis];
                there[2] = there[2].clamp(0.0, farthest);
                value(there).map(|found| (found, there))
            });
            let lowest = tried.min_by_key(|((energy, _), _)| OrderedFloat(*energy));
            match lowest {
                Some((found, there)) if found.0 < best.0 => (best, here) = (found, there),
                _ => step /= 2.0,
            }
        }
        Some(best)
    }
}
