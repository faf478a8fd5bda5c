//! The energies of all couples on one grid of poses.
//!
//! A pose is a tilt of the second tile about the corner that touches, and a slide along the first
//! face, in contact. The slides resolve the wells of single pairs of magnets; flush faces also meet
//! where magnets face magnets. If the couples have more pairs of magnets than there are pairs of
//! places, the energies of the latter are computed once in a pose and summed with each couple's
//! signs; otherwise each couple's energy is that of its own tiles, all whose magnets are summed
//! together.

use std::f64::consts::FRAC_PI_2;

use super::minima::{Grid, Setting, Walk};
use super::{Couple, Stage, energies};
use crate::Word;
use tiles::configuration::Configuration;
use tiles::order::Order;
use tiles::parallel;
use tiles::potential::MagnetModel;
use tiles::problem::Problem;
use tiles::tile::{Face, Magnet, face_to_face};

/// Number of slides in the width of a well.
const SLIDES_A_WELL: f64 = 4.0;
/// Slides at which magnets face each other, nearer than this fraction of a step, are one.
pub(super) const THINNED: f64 = 0.125;
/// Tilts (rad), step and end: fine where faces are nearly flush, coarse beyond, up to the quarter
/// turn that lays the next faces of squares along each other.
const FINE: (f64, f64) = (0.01, 0.1);
const COARSE: (f64, f64) = (FRAC_PI_2 / 16.0, FRAC_PI_2);
/// The cosine of a right angle, within rounding.
const RIGHT: f64 = 1e-9;
/// Pairs of magnets whose energies are computed, one by one, in the time of one whose energy is
/// computed with those of its tiles' others, or more.
const ALONE: usize = 8;

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
    /// The grid of these couples.
    pub(super) fn grid(&self, couples: &[Couple]) -> Grid {
        let pairs = couples.iter().map(Couple::pairs).sum::<usize>();
        let sum = if pairs < ALONE * self.places * self.places {
            let problem =
                |number: usize| self.problem_of(couples[number].first, couples[number].second);
            Sum::Apart(parallel::map(0..couples.len(), problem))
        } else {
            Sum::Together(Together::new(self, couples))
        };
        let energies = |q: Configuration| -> Vec<f64> {
            match &sum {
                Sum::Apart(problems) => problems.iter().map(|it| it.energy(&q)).collect(),
                Sum::Together(together) => together.energies(&q),
            }
        };
        let row = |tilt: f64, slides: &[f64], lowest: Vec<f64>| {
            let mut walk = Walk::new(couples, lowest);
            for slide in slides {
                let pose = self.placed([tilt, *slide, 0.0]);
                let apart = || vec![f64::INFINITY; couples.len()];
                walk.step(*slide, pose.map_or_else(apart, energies).into_iter());
            }
            walk.end(tilt)
        };
        let step = self.slide_step();
        let even = even(self.pair.target_face().length(), step);
        let mut flush = [even.clone(), self.facing_slides()].concat();
        flush.order_by(f64::total_cmp);
        // Most couples attract most when flush, so that few minima are kept of other tilts.
        let (flush, lowest) = row(0.0, &flush, vec![f64::INFINITY; couples.len()]);
        let mut rows = parallel::map(&tilts(), |tilt| row(*tilt, &even, lowest.clone()).0);
        rows.push(flush);
        Grid::new(rows, step)
    }

    /// Slides (m) at which a magnet of each of two flush faces face each other.
    fn facing_slides(&self) -> Vec<f64> {
        let (pair, step) = (&self.pair, self.slide_step());
        let moving = &pair.moving.faces[pair.target.1];
        let along = |face: &Face, magnets: &[Magnet]| -> Vec<f64> {
            let at = |it: &Magnet| (it.position - face.middle()).dot(&face.tangent());
            magnets.iter().map(at).collect()
        };
        let first = along(pair.target_face(), &pair.fixed.magnets);
        let second = along(moving, &pair.moving.magnets);
        let mut slides: Vec<f64> = Vec::with_capacity(first.len() * second.len());
        for at in first {
            slides.extend(second.iter().map(|other| at + other));
        }
        slides.order_by(f64::total_cmp);
        slides.dedup_by(|next, kept| *next - *kept < THINNED * step);
        slides
    }

    /// The step (m) of slides.
    pub(super) fn slide_step(&self) -> f64 {
        let pair = &self.pair;
        let [first, second] = [
            &pair.fixed.magnets[0],
            &pair.moving.magnets[self.places - 1],
        ];
        let apart = (pair.bound.transform(second.position) - first.position).norm();
        slide_step(self.interaction.model, first.size[1], apart)
    }

    /// The pose of a setting; `None` if the tiles do not touch. Tilts turn the tile about the corner
    /// that touches the other face, so that the magnets beside it stay opposite each other.
    pub(super) fn placed(&self, [tilt, slide, back]: Setting) -> Option<Configuration> {
        let pair = &self.pair;
        let (fixed, moving) = (pair.target_face(), &pair.moving.faces[pair.target.1]);
        let (side, cos) = (tilt.signum(), libm::cos(tilt));
        // A corner of the second face lies on the first face, or one of the first on the second, if
        // the angle between them is less than a right one.
        let along = match side * slide > 0.0 {
            true if cos < RIGHT => return None,
            true => slide * cos,
            false => slide,
        };
        let middle = along + side * (1.0 - cos) * fixed.length() / 2.0;
        let flush = face_to_face(fixed, moving, middle, tilt);
        let normal = fixed.normal();
        let out = self.contact.landing(&flush, normal)? + back;
        let at = flush.position() + normal * out;
        Some(Configuration::new(at.x, at.y, flush.theta))
    }
}

/// The step (m) of slides. The well of two magnets is about as wide as their width (m) for blocks,
/// and as the distance (m) of the dipoles that face each other for dipoles.
pub(super) fn slide_step(model: MagnetModel, width: f64, apart: f64) -> f64 {
    let well = match model {
        MagnetModel::Dipole => apart,
        MagnetModel::Cuboid => width,
    };
    well / SLIDES_A_WELL
}

/// Slides (m) along a whole face (m), in both directions.
fn even(face: f64, step: f64) -> Vec<f64> {
    let count = (face / step).round() as i64;
    let slide = |number| number as f64 * step;
    (-count..=count).map(slide).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Fine and coarse tilts (rad) in both directions, without 0.
pub(super) fn tilts() -> Vec<f64> {
    let steps = |(step, end): (f64, f64)| {
        let count = (end / step).round() as i32;
        (1..=count).map(move |k| f64::from(k) * step)
    };
    let coarse = steps(COARSE).filter(|tilt| *tilt > FINE.1);
    let one_way = steps(FINE).chain(coarse);
    one_way.flat_map(|tilt| [tilt, -tilt]).collect()
}
