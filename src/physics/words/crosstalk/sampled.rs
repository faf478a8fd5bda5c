//! The strongest attraction of all pairs of faces, sampled on one grid of poses and then refined.
//!
//! A pose is a tilt of the second tile about the midpoint of its face and a slide along the first
//! face, in contact. Every couple keeps its lowest poses of the grid with different tilts; compass
//! search, which may also separate the tiles, moves these to their minima. This is a sample: poses
//! between those of the grid may be lower.

use ordered_float::OrderedFloat;

use super::{Couple, Stage, energies};
use crate::configuration::Configuration;
use crate::parallel;
use crate::problem::Problem;
use crate::tile::face_to_face;
use crate::words::Word;

/// Number of slides per place.
const SLIDES_A_PLACE: f64 = 8.0;
/// Tilts (rad): fine where faces are nearly flush, coarse beyond.
const FINE: (f64, f64) = (0.01, 0.1);
const COARSE: (f64, f64) = (0.1, 1.6);
/// Number of poses of a couple that are refined.
const POLISHED: usize = 4;
/// Final step of compass search (m).
const FINEST: f64 = 1e-6;

/// Units of work to sample couples of words with this many places, mostly for the energies of all
/// pairs of magnets at all poses of the grid.
pub fn work(places: usize) -> u64 {
    const A_PAIR: u64 = 30;
    let slides = 2 * (SLIDES_A_PLACE as usize * places) + 1;
    A_PAIR * (tilts().len() * slides * places * places) as u64
}

/// Tilt (rad), slide (m), and separation (m).
pub(super) type Setting = [f64; 3];

impl Stage {
    /// The lowest energy (J) found for each couple, and its pose.
    pub(super) fn sampled(&self, couples: &[Couple]) -> Vec<(f64, Configuration)> {
        let tilts = tilts();
        let best_by_tilt = parallel::map(&tilts, |tilt| self.best_at(*tilt, couples));
        parallel::map(0..couples.len(), |number| {
            let couple = &couples[number];
            let mut starts: Vec<(f64, Setting)> =
                best_by_tilt.iter().map(|best| best[number]).collect();
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

    /// For each couple, the lowest energy at a tilt, and its setting.
    fn best_at(&self, tilt: f64, couples: &[Couple]) -> Vec<(f64, Setting)> {
        let mut best = vec![(f64::INFINITY, [tilt, 0.0, 0.0]); couples.len()];
        // Energies of the second words with each magnet of the first tile are shared by many
        // couples.
        let mut seconds: Vec<Word> = couples.iter().map(|couple| couple.second).collect();
        seconds.sort_unstable();
        seconds.dedup();
        let place = |couple: &Couple| seconds.binary_search(&couple.second).unwrap_or(0);
        let places: Vec<usize> = couples.iter().map(place).collect();
        let n = self.places;
        let signs = |word: Word| (0..n).map(|k| f64::from(word.at(k))).collect();
        let first_signs: Vec<Vec<f64>> = couples.iter().map(|it| signs(it.first)).collect();
        let second_signs: Vec<Vec<f64>> = seconds.iter().map(|word| signs(*word)).collect();
        for slide in self.slides() {
            let setting = [tilt, slide, 0.0];
            let Some(q) = self.placed(setting) else {
                continue;
            };
            let by_magnets = energies(&self.magnets, &q);
            let with_second: Vec<f64> = second_signs
                .iter()
                .flat_map(|signs| by_magnets.chunks(n).map(|row| dot(row, signs)))
                .collect();
            for (number, best) in best.iter_mut().enumerate() {
                let from = places[number] * n;
                let energy = dot(&with_second[from..from + n], &first_signs[number]);
                if energy < best.0 {
                    *best = (energy, setting);
                }
            }
        }
        best
    }

    /// Slides (m) of the grid, along the whole face in both directions.
    pub(super) fn slides(&self) -> Vec<f64> {
        let face = self.pair.target_face().length();
        let step = face / self.places as f64 / SLIDES_A_PLACE;
        let count = (face / step).round() as i64;
        (-count..=count)
            .map(|number| number as f64 * step)
            .collect()
    }

    /// The pose of a setting; `None` if the tiles do not touch.
    pub(super) fn placed(&self, [tilt, slide, back]: Setting) -> Option<Configuration> {
        let pair = &self.pair;
        let moving = &pair.moving.faces[pair.target.1];
        let flush = face_to_face(pair.target_face(), moving, slide, tilt);
        let normal = pair.target_face().normal();
        let out = self.contact.landing(&flush, normal)? + back;
        let at = flush.position() + normal * out;
        Some(Configuration::new(at.x, at.y, flush.theta))
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
        let mut here = start;
        let mut best = value(here)?;
        let mut step = lever / self.places as f64 / SLIDES_A_PLACE;
        while step > self.contact.scaled(FINEST) {
            let steps = [step / lever, step, step];
            let moves = (0..3).flat_map(|axis| [1.0, -1.0].map(|sign| (axis, sign)));
            let tried = moves.filter_map(|(axis, sign)| {
                let mut there = here;
                there[axis] += sign * steps[axis];
                there[2] = there[2].max(0.0);
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

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Fine and coarse tilts, in both directions.
pub(super) fn tilts() -> Vec<f64> {
    let steps = |(step, end): (f64, f64)| {
        let count = (end / step).round() as i32;
        (1..=count).map(move |k| f64::from(k) * step)
    };
    let coarse = steps(COARSE).filter(|tilt| *tilt > FINE.1);
    let one_way: Vec<f64> = steps(FINE).chain(coarse).collect();
    let other = one_way.iter().map(|tilt| -tilt);
    std::iter::once(0.0)
        .chain(one_way.iter().copied())
        .chain(other)
        .collect()
}
