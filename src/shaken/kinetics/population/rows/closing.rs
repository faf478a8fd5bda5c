//! How near the ends of a chain are to each other: the play of bonds, summed along the chain.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Rotation2, Vector2, Vector3};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::joints::Joints;
use tiles::configuration::Configuration;
use tiles::interruption;

/// Sweeps of the sampling of a bond's play, and those before, which set the lengths of its steps.
const SWEEPS: usize = 20_000;
const BEFORE: usize = 2_000;
/// The first lengths of steps, as a share of the tile's radius, and in rad.
const FIRST: f64 = 1e-3;
/// The play is sampled up to this many kT above the exact place: rare poses far out in a well would widen
/// the normal distribution, and say nothing of how near the ends are.
const CORE: f64 = 8.0;
/// Share of accepted steps at which lengths stay as they are.
const ACCEPTED: f64 = 0.4;

/// The mean and the covariance of the small motion (m, m, rad) by which the next tile is off its exact
/// place, in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Spread {
    mean: Vector3<f64>,
    covariance: Matrix3<f64>,
}

/// The play of every joint at one kT.
pub struct Spreads {
    /// By the face of the tile before and that of the next one.
    of: [[Option<Spread>; 2]; 2],
}

/// A motion composed of many: small ones are added as vectors.
fn small(motion: &Configuration) -> Vector3<f64> {
    Vector3::new(motion.x, motion.y, motion.theta)
}

/// The matrix by which a small motion before `later` becomes one after it.
fn carried(later: &Configuration) -> Matrix3<f64> {
    let back = Rotation2::new(-later.theta);
    let arm = back * Vector2::new(-later.y, later.x);
    let mut matrix = Matrix3::identity();
    matrix.fixed_view_mut::<2, 2>(0, 0).copy_from(back.matrix());
    matrix[(0, 2)] = arm.x;
    matrix[(1, 2)] = arm.y;
    matrix
}

impl Spreads {
    /// Sampled with the weights `exp(-U / kt)` below an energy `level` (J) around the intended bond.
    pub fn sampled(joints: &Joints, kt: f64, level: f64, rng: &mut ChaCha8Rng) -> Self {
        let samples = sampled(joints, kt, level, rng);
        let of = joints.each(|joint| {
            let exact = joint.pose.inverse();
            let off = |q: &Configuration| {
                small(&exact.compose(&joint.map.apply(q).compose(&joints.congruence)))
            };
            let all: Vec<Vector3<f64>> = samples.iter().map(off).collect();
            let count = all.len().max(1) as f64;
            let mean = all.iter().sum::<Vector3<f64>>() / count;
            let square = |it: &Vector3<f64>| (it - mean) * (it - mean).transpose();
            Spread {
                mean,
                covariance: all.iter().map(square).sum::<Matrix3<f64>>() / count,
            }
        });
        Self { of }
    }

    /// The density (1/(m^2 rad)) of the pose of a chain's one end at that at which it binds the other;
    /// 0 if the ends do not bind.
    pub fn density(&self, joints: &Joints, row: &[bool]) -> f64 {
        let n = row.len();
        let mut later = Configuration::new(0.0, 0.0, 0.0);
        let (mut mean, mut covariance) = (Vector3::zeros(), Matrix3::zeros());
        for k in (0..n).rev() {
            let (before, next) = (row[k], row[(k + 1) % n]);
            let spread = self.of[usize::from(!before)][usize::from(next)];
            let (Some(joint), Some(spread)) = (joints.joint(before, next), spread) else {
                return 0.0;
            };
            let carried = carried(&later);
            mean += carried * spread.mean;
            covariance += carried * spread.covariance * carried.transpose();
            later = joint.pose.compose(&later);
        }
        let off = small(&later) + mean;
        let Some(inverse) = covariance.try_inverse() else {
            return 0.0;
        };
        let volume = (TAU * TAU * TAU * covariance.determinant()).sqrt();
        let density = libm::exp(-0.5 * off.dot(&(inverse * off))) / volume;
        if density.is_finite() { density } else { 0.0 }
    }
}

/// Poses of the moving tile in the intended bond: Metropolis steps along the target face, away from it,
/// and around its middle.
fn sampled(joints: &Joints, kt: f64, level: f64, rng: &mut ChaCha8Rng) -> Vec<Configuration> {
    let problem = joints.problem;
    let Some(pair) = problem.pair.as_deref() else {
        return Vec::new();
    };
    let frame = pair.fixed.faces[pair.target.0].frame();
    let radius = pair.fixed.outline.circumradius();
    let energy = |q: &Configuration| match problem.is_free(q) {
        true => problem.energy(q),
        false => f64::INFINITY,
    };
    let level = level.min(problem.energy(&pair.bound) + CORE * kt);
    let mut here = pair.bound;
    let mut known = energy(&here);
    let mut steps = [FIRST * radius, FIRST * radius, FIRST];
    let mut all = Vec::with_capacity(SWEEPS);
    for sweep in 0..BEFORE + SWEEPS {
        if sweep % 64 == 0 {
            interruption::check();
        }
        for (k, length) in steps.iter_mut().enumerate() {
            let mut step = [0.0; 3];
            step[k] = *length * (2.0 * rng.random::<f64>() - 1.0);
            let moved = frame
                .compose(&Configuration::from(step))
                .compose(&frame.inverse())
                .compose(&here);
            let there = energy(&moved);
            // A start that overlaps by a rounding error is left at once.
            let is_taken =
                there < level && rng.random::<f64>() < libm::exp(((known - there) / kt).min(0.0));
            if is_taken {
                (here, known) = (moved, there);
            }
            if sweep < BEFORE {
                let towards = if is_taken { 1.0 - ACCEPTED } else { -ACCEPTED };
                *length *= libm::exp(0.1 * towards);
            }
        }
        if sweep >= BEFORE {
            all.push(here);
        }
    }
    all
}
