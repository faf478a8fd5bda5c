//! Capture: which states overdamped motion reaches from starts far apart.

use std::f64::consts::PI;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::minimum::{Known, Outcome, learn};
use tiles::configuration::Configuration;
use tiles::problem::Problem;

/// The distribution of far starts: the reference point uniform in area over the ring from the
/// distance at which the tiles are free of each other (a fiftieth more) to half the table's shorter
/// side, any orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FarStarts {
    /// Number of starts.
    pub count: usize,
    /// The seed of their random numbers.
    pub seed: u64,
}

/// Inner and outer radius (m) of the ring of far starts; equal if the table leaves no room.
pub fn ring(problem: &Problem) -> [f64; 2] {
    let [x, y] = problem.space.half_size;
    let inner = 1.02 * problem.space.free_distance;
    [inner, x.min(y).max(inner)]
}

/// The far start of this number.
pub fn start(problem: &Problem, starts: &FarStarts, number: usize) -> Configuration {
    let [inner, outer] = ring(problem);
    let mut rng = ChaCha8Rng::seed_from_u64(starts.seed);
    rng.set_stream((1 << 40) + number as u64);
    let area = rng.random_range(inner * inner..=outer * outer);
    let direction = rng.random_range(-PI..=PI);
    let (y, x) = libm::sincos(direction);
    let radius = area.sqrt();
    let theta = rng.random_range(-PI..=PI);
    Configuration::new(radius * x, radius * y, theta)
}

/// The end of each far start by overdamped motion (mass metric, sliding along contact), `None` if
/// it leaves the table; `tell` gets how many are done. The end need not be a verified minimum: where
/// corners of both tiles meet, the last check may fail a micrometre from one.
pub fn ends(
    problem: &Problem,
    starts: &FarStarts,
    mut known: Known,
    tell: &dyn Fn(usize),
) -> Vec<Option<Configuration>> {
    let all = (0..starts.count).map(|number| start(problem, starts, number));
    let rest = |outcome: Outcome| match outcome {
        Outcome::Minimum(found) => Some(found.point.q),
        Outcome::Stuck(q) => Some(q),
        Outcome::Free => None,
    };
    let outcomes = learn(problem, &all.collect::<Vec<_>>(), &mut known, tell);
    outcomes.into_iter().map(rest).collect()
}

/// The far starts that come to rest, each with where it does.
pub fn arrivals(
    problem: &Problem,
    starts: &FarStarts,
    ends: &[Option<Configuration>],
) -> Vec<(Configuration, Configuration)> {
    let numbered = ends.iter().enumerate();
    numbered
        .filter_map(|(number, end)| Some((start(problem, starts, number), (*end)?)))
        .collect()
}
