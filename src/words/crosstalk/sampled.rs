//! The strongest attraction of all pairs of faces: the local minima of the grid, refined.
//!
//! Compass search, which may also separate the tiles, moves a couple's minima of the grid to those
//! of the energy, from the lowest up, until the next could not become the lowest. This is a sample:
//! a well so narrow that the grid misses it may be deeper.

use ordered_float::OrderedFloat;

use super::minima::{Grid, Setting, reach};
use super::{Couple, Stage};
use tiles::configuration::Configuration;
use tiles::parallel;
use tiles::problem::Problem;

/// Final step of compass search (m).
const FINEST: f64 = 1e-6;

impl Stage {
    /// The lowest energy (J) found for each couple, and its pose.
    pub(super) fn sampled(&self, couples: &[Couple], grid: &Grid) -> Vec<(f64, Configuration)> {
        parallel::map(0..couples.len(), |number| {
            let found = self.lowest(&couples[number], grid.minima(number), |_| true);
            found.unwrap_or((0.0, self.pair.bound))
        })
    }

    /// The lowest energy (J) of an accepted pose from minima of the grid, given from the lowest up,
    /// and the pose.
    pub(super) fn lowest(
        &self,
        couple: &Couple,
        minima: Vec<(f64, Setting)>,
        accepted: impl Fn(&Configuration) -> bool,
    ) -> Option<(f64, Configuration)> {
        let problem = self.problem_of(couple.first, couple.second);
        let mut lowest: Option<(f64, Configuration)> = None;
        for (energy, setting) in minima {
            if lowest.is_some_and(|(lowest, _)| energy > reach(lowest)) {
                break;
            }
            let found = self.polished(&problem, setting);
            let found = found.filter(|(_, pose)| accepted(pose));
            lowest = lowest
                .into_iter()
                .chain(found)
                .min_by_key(|it| OrderedFloat(it.0));
        }
        lowest
    }

    /// Compass search from a setting.
    fn polished(&self, problem: &Problem, start: Setting) -> Option<(f64, Configuration)> {
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
