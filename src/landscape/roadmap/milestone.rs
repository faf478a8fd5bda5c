//! Milestones by rejection sampling.
//!
//! Configurations are proposed from a mixture and accepted by their energy. The mixture, for tiles:
//!
//! - one part in four: uniform over the table and over theta;
//! - three parts in four: around contact. A face of each tile is chosen and the two are set against
//!   each other, slid at most until they no longer overlap, tilted by an angle drawn log-uniformly
//!   from 1 mrad to 1 rad of either sign (one in three: any orientation at all); then the tile is
//!   pushed out along the face's normal into contact and, in half of the cases, farther by a gap
//!   drawn log-uniformly from 10 µm to 0.1 m.
//!
//! Scales are log-uniform because the energy of magnets is a power law: every decade of gap and
//! tilt down to contact is equally important. Without faces (analytic landscapes) all proposals are
//! uniform.
//!
//! Each milestone has its own random stream (ChaCha8, stream = index), so the result does not
//! depend on the number of threads.

use std::f64::consts::PI;

use nalgebra::Vector2;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::point::Point;
use tiles::configuration::Configuration;
use tiles::parallel;
use tiles::problem::Problem;
use tiles::tile::face_to_face;

/// The rule for accepting a proposed milestone.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Acceptance {
    /// The linear rule: with probability 1 below `lowest` (J), 0 above `highest` (J), and
    /// `(highest - U) / (highest - lowest)` between. Source: Singh, Latombe and Brutlag, *A motion
    /// planning approach to flexible ligand binding* (ISMB 1999), "Generation of milestones".
    Linear {
        /// All proposals below this energy (J) are accepted.
        lowest: f64,
        /// No proposal above this energy (J) is accepted.
        highest: f64,
    },
    /// With probability `min(1, exp(-U / energy))`, `energy` (J) > 0.
    Boltzmann {
        /// The energy (J) at which the fraction 1/e is accepted.
        energy: f64,
    },
}

impl Acceptance {
    /// Probability of accepting a configuration of energy `u` (J).
    pub fn probability(&self, u: f64) -> f64 {
        match *self {
            Self::Linear { lowest, highest } => {
                ((highest - u) / (highest - lowest)).clamp(0.0, 1.0)
            }
            Self::Boltzmann { energy } => libm::exp(-u / energy).min(1.0),
        }
    }
}

/// How milestones are drawn.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MilestoneSettings {
    /// Number of milestones to draw.
    pub count: usize,
    /// The rule for accepting proposals.
    pub acceptance: Acceptance,
    /// The seed of all random numbers.
    pub seed: u64,
}

/// A milestone is left out after this many rejected proposals.
const MOST_PROPOSALS: usize = 10_000;

/// Draws the milestones, in the order of their random streams.
pub fn milestones(problem: &Problem, settings: &MilestoneSettings) -> Vec<Point> {
    parallel::flat_map(0..settings.count, |i| {
        let mut rng = ChaCha8Rng::seed_from_u64(settings.seed);
        rng.set_stream(i as u64);
        draw(problem, &settings.acceptance, &mut rng)
    })
}

fn draw(problem: &Problem, acceptance: &Acceptance, rng: &mut ChaCha8Rng) -> Option<Point> {
    for _ in 0..MOST_PROPOSALS {
        let q = propose(problem, rng);
        if !problem.is_free(&q) {
            continue;
        }
        let (energy, gradient) = problem.energy_and_gradient(&q);
        if rng.random::<f64>() < acceptance.probability(energy) {
            return Some(Point {
                q,
                energy,
                gradient,
            });
        }
    }
    None
}

fn propose(problem: &Problem, rng: &mut ChaCha8Rng) -> Configuration {
    if problem.faces().iter().any(|faces| faces.is_empty()) || rng.random_bool(0.25) {
        uniform(problem, rng)
    } else {
        around_contact(problem, rng)
    }
}

fn uniform(problem: &Problem, rng: &mut impl Rng) -> Configuration {
    let [x, y] = problem.space.half_size;
    Configuration::new(
        rng.random_range(-x..=x),
        rng.random_range(-y..=y),
        rng.random_range(-PI..=PI),
    )
}

fn around_contact(problem: &Problem, rng: &mut impl Rng) -> Configuration {
    let [fixed, moving] = problem.faces();
    let fixed = &fixed[rng.random_range(0..fixed.len())];
    let moving = &moving[rng.random_range(0..moving.len())];
    let tilt = if rng.random_bool(1.0 / 3.0) {
        rng.random_range(-PI..=PI)
    } else {
        log_uniform(1e-3, 1.0, rng) * if rng.random_bool(0.5) { 1.0 } else { -1.0 }
    };
    let reach = (fixed.length() + moving.length()) / 2.0;
    let slide = rng.random_range(-reach..=reach);
    let gap = if rng.random_bool(0.5) {
        problem.scaled(log_uniform(1e-5, 0.1, rng))
    } else {
        0.0
    };
    let q = face_to_face(fixed, moving, slide, tilt);
    let normal = fixed.normal();
    shifted(&q, normal * (problem.lift(&q, normal) + gap))
}

fn shifted(q: &Configuration, by: Vector2<f64>) -> Configuration {
    Configuration::new(q.x + by.x, q.y + by.y, q.theta)
}

fn log_uniform(low: f64, high: f64, rng: &mut impl Rng) -> f64 {
    libm::exp(rng.random_range(libm::log(low)..libm::log(high)))
}
