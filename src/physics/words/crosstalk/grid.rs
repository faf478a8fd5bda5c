//! The energies of all couples on one grid of poses.
//!
//! A pose is a tilt of the second tile about the midpoint of its face and a slide along the first
//! face, in contact. If the couples have more pairs of magnets than there are pairs of places, the
//! energies of the latter are computed once in a pose and summed with each couple's signs; otherwise
//! each couple's energy is that of its own tiles, all whose magnets are summed together.

use super::{Couple, Stage, energies};
use crate::configuration::Configuration;
use crate::parallel;
use crate::problem::Problem;
use crate::tile::face_to_face;
use crate::words::Word;

/// Number of slides per place, and in the width of a magnet at most.
const SLIDES_A_PLACE: f64 = 8.0;
const SLIDES_A_WIDTH: f64 = 4.0;
/// Tilts (rad): fine where faces are nearly flush, coarse beyond.
pub(super) const FINE: (f64, f64) = (0.01, 0.1);
const COARSE: (f64, f64) = (0.1, 1.6);
/// Pairs of magnets whose energies are computed, one by one, in the time of one whose energy is
/// computed with those of its tiles' others, or more.
const ALONE: usize = 8;

/// Tilt (rad), slide (m), and separation (m).
pub(super) type Setting = [f64; 3];

/// The energies at a tilt.
pub(super) struct AtTilt {
    /// The tilt (rad).
    pub tilt: f64,
    /// For each couple, the lowest energy (J) and its setting.
    pub best: Vec<(f64, Setting)>,
    /// By slide (m), the energies (J) of the words with their own mates; infinite if the tiles do not
    /// touch.
    pub own: Vec<(f64, Vec<f64>)>,
}

/// How the energies of couples are summed.
enum Sum<'a> {
    /// Each by itself.
    Apart(Vec<Problem>),
    /// From those of all pairs of places.
    Together(Together<'a>),
}

/// Couples as signs of the energies of pairs of places.
struct Together<'a> {
    stage: &'a Stage,
    /// The signs of each couple's first word.
    firsts: Vec<Vec<f64>>,
    /// The signs of the second words, which many couples share, and the one of each couple.
    seconds: Vec<Vec<f64>>,
    number: Vec<usize>,
}

impl Together<'_> {
    fn new<'a>(stage: &'a Stage, couples: &[Couple]) -> Together<'a> {
        let mut seconds: Vec<Word> = couples.iter().map(|couple| couple.second).collect();
        seconds.sort_unstable();
        seconds.dedup();
        let place = |couple: &Couple| seconds.binary_search(&couple.second).unwrap_or(0);
        let signs = |word: Word| {
            let at = |k| f64::from(word.at(k));
            (0..stage.places).map(at).collect()
        };
        Together {
            stage,
            firsts: couples.iter().map(|couple| signs(couple.first)).collect(),
            number: couples.iter().map(place).collect(),
            seconds: seconds.iter().map(|word| signs(*word)).collect(),
        }
    }

    fn energies(&self, q: &Configuration) -> Vec<f64> {
        let n = self.stage.places;
        let by_magnets = energies(self.stage.magnets(), q);
        let seconds = self.seconds.iter();
        let with_second: Vec<f64> = seconds
            .flat_map(|signs| by_magnets.chunks(n).map(|row| dot(row, signs)))
            .collect();
        let couples = self.firsts.iter().zip(&self.number);
        couples
            .map(|(first, second)| dot(&with_second[second * n..(second + 1) * n], first))
            .collect()
    }
}

impl Stage {
    /// The grid of these couples; `own` are the numbers of those of a word and its own mate.
    pub(super) fn grid(&self, couples: &[Couple], own: &[usize]) -> Vec<AtTilt> {
        let pairs = couples.iter().map(Couple::pairs).sum::<usize>();
        let sum = if pairs < ALONE * self.places * self.places {
            let problem =
                |number: usize| self.problem_of(couples[number].first, couples[number].second);
            Sum::Apart(parallel::map(0..couples.len(), problem))
        } else {
            Sum::Together(Together::new(self, couples))
        };
        let slides = self.slides();
        parallel::map(&tilts(), |&tilt| {
            let mut best = vec![(f64::INFINITY, [tilt, 0.0, 0.0]); couples.len()];
            let mut at = |slide: f64| {
                let setting = [tilt, slide, 0.0];
                let Some(q) = self.placed(setting) else {
                    return vec![f64::INFINITY; own.len()];
                };
                let energies: Vec<f64> = match &sum {
                    Sum::Apart(problems) => problems.iter().map(|it| it.energy(&q)).collect(),
                    Sum::Together(together) => together.energies(&q),
                };
                for (energy, best) in energies.iter().zip(&mut best) {
                    if *energy < best.0 {
                        *best = (*energy, setting);
                    }
                }
                own.iter().map(|number| energies[*number]).collect()
            };
            let own = slides.iter().map(|slide| (*slide, at(*slide))).collect();
            AtTilt { tilt, best, own }
        })
    }

    /// Slides (m) of the grid, along the whole face in both directions.
    fn slides(&self) -> Vec<f64> {
        let step = self.slide_step();
        let count = (self.pair.target_face().length() / step).round() as i64;
        (-count..=count)
            .map(|number| number as f64 * step)
            .collect()
    }

    /// The step (m) of slides.
    pub(super) fn slide_step(&self) -> f64 {
        let width = self.pair.fixed.magnets[0].size[1];
        slide_step(self.pair.target_face().length(), self.places, width)
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
}

/// The step (m) of slides along a face (m) with so many places for magnets of a width (m): energies
/// change little over a fraction of the width.
pub(super) fn slide_step(face: f64, places: usize, width: f64) -> f64 {
    (face / places as f64 / SLIDES_A_PLACE).max(width / SLIDES_A_WIDTH)
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
