//! Local minima over the free configurations, and the overdamped motion that leads into them.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use nalgebra::Vector3;

use super::constrained::{self, Point, step_downhill};
use super::stationary::{self, Stationary};
use crate::configuration::Configuration;
use crate::problem::Problem;

/// Longest step of a descent (m, mass metric).
const LONGEST_STEP: f64 = 5e-3;
/// A descent whose steps are shorter than this (m) has arrived.
const SHORTEST_STEP: f64 = 1e-9;
/// Newton's method is tried once steps are shorter than this (m).
const TRY_NEWTON: f64 = 2e-4;
const MOST_STEPS: usize = 20_000;
/// Free configurations tried around a minimum, at distances from 1 µm to 1 mm.
const PROBES: u64 = 48;
/// A configuration is clearly lower than another if its energy is by this fraction.
const CLEARLY: f64 = 1e-9;

/// Where a descent ended.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// At a minimum.
    Minimum(Box<Stationary>),
    /// The tiles are far apart.
    Free,
    /// No step goes down, but no minimum is near: the accuracy of the energy is exhausted.
    Stuck,
}

/// A descent: its way, start and end included, and where it ended.
#[derive(Clone, Debug)]
pub struct Descent {
    /// Where it went, from start to end.
    pub way: Vec<Point>,
    /// Where it ended.
    pub outcome: Outcome,
}

/// Overdamped motion from `start`: `v = -M^-1 grad U`, sliding along contact, until a minimum or
/// far apart.
pub fn descend(problem: &Problem, start: &Configuration) -> Descent {
    let mut way = vec![Point::new(problem, *start)];
    let outcome = follow(problem, &mut way, |q| problem.space.is_far(q));
    Descent { way, outcome }
}

/// Overdamped motion from `start`, until a minimum or over the table's rim.
pub fn drift(problem: &Problem, start: &Configuration) -> Outcome {
    let mut way = vec![Point::new(problem, *start)];
    follow(problem, &mut way, |q| !problem.space.contains(q))
}

fn follow(
    problem: &Problem,
    way: &mut Vec<Point>,
    is_free: impl Fn(&Configuration) -> bool,
) -> Outcome {
    let mut size = LONGEST_STEP;
    let mut newton_below = TRY_NEWTON;
    for _ in 0..MOST_STEPS {
        let here = *way.last().expect("a way has a start");
        if is_free(&here.q) {
            return Outcome::Free;
        }
        match step_downhill(problem, &here, size) {
            Some(next) => {
                way.push(next);
                size = (1.5 * size).min(LONGEST_STEP);
            }
            None => size *= 0.5,
        }
        if size < newton_below {
            // Ever finer, so that a failing attempt costs little.
            newton_below = size / 8.0;
            if let Some(found) = verified_minimum(problem, way) {
                return Outcome::Minimum(Box::new(found));
            }
        }
        if size < SHORTEST_STEP {
            // At rest, but on no minimum: on a ridge, if anywhere lower is to be found near by.
            match lower_neighbour(problem, &here) {
                Some(lower) => way.push(lower),
                None => return Outcome::Stuck,
            }
            size = LONGEST_STEP;
            newton_below = TRY_NEWTON;
        }
    }
    Outcome::Stuck
}

/// The minimum at the end of a way, if Newton's method finds one close by and no free
/// configuration around it lies lower. Where one does, the way goes on from there.
fn verified_minimum(problem: &Problem, way: &mut Vec<Point>) -> Option<Stationary> {
    let here = *way.last()?;
    let found = stationary::minimum(problem, &here.q)?;
    let noise = problem.potential().noise() * found.point.energy.abs();
    let near = problem.space.distance(&here.q, &found.point.q) < 0.02;
    if !near || found.point.energy > here.energy + noise || !problem.is_free(&found.point.q) {
        return None;
    }
    if let Some(lower) = lower_neighbour(problem, &found.point) {
        way.push(lower);
        return None;
    }
    way.push(found.point);
    Some(found)
}

/// A free configuration near `point` with a clearly lower energy, if probing finds one.
fn lower_neighbour(problem: &Problem, point: &Point) -> Option<Point> {
    let clearly = problem.potential().noise().max(CLEARLY);
    let mut rng = ChaCha8Rng::seed_from_u64(0);
    for k in 0..PROBES {
        let distance = 10f64.powf(-6.0 + 3.0 * k as f64 / PROBES as f64);
        let mut draw = || rng.random_range(-1.0..1.0);
        let direction = Vector3::new(draw(), draw(), draw() / problem.space.rho);
        let aim = point.q.moved(direction * distance);
        let Some(q) = constrained::settle(problem, &aim, 4.0 * distance) else {
            continue;
        };
        let energy = problem.energy(&q);
        if energy < point.energy - clearly * point.energy.abs() {
            return Some(Point::new(problem, q));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Design, MagnetModel};

    #[test]
    fn a_shallow_minimum_is_not_jumped_out_of() {
        // 2 mm beside this one a ridge of 16 µJ hides a slope that falls by 16 mJ.
        let design = Design::load("shapes/arrowhead.toml".as_ref()).unwrap();
        let problem = design.problem();
        let minimum = Configuration::new(0.347_926_5, -0.052_362_2, 0.0);
        for [x, y, theta] in [
            [0.347_843_4, -0.052_206_4, -1.298e-6],
            [0.347_833_9, -0.052_187_7, 1.312e-6],
            [0.348_1, -0.052_3, 0.0],
        ] {
            let start = Configuration::new(x, y, theta);
            assert!(problem.is_free(&start), "{start:?}");
            let Outcome::Minimum(end) = descend(&problem, &start).outcome else {
                panic!("no minimum from {start:?}");
            };
            let distance = problem.space.distance(&end.point.q, &minimum);
            assert!(distance < 1e-6, "from {start:?}: {:?}", end.point.q);
        }
    }

    #[test]
    fn blocks_come_to_rest_beside_the_bond_as_dipoles_do() {
        // Slid by one magnet, blocks of both tiles touch edge to edge, where the second derivative
        // of their energy has no bound and the energy itself is least certain.
        let mut design = Design::load("shapes/one-face.toml".as_ref()).unwrap();
        for model in [MagnetModel::Dipole, MagnetModel::Cuboid] {
            design.interaction.model = model;
            let problem = design.problem();
            for y in [0.041, 0.039, -0.039, -0.041] {
                let start = Configuration::new(0.43, y, 0.0);
                let Outcome::Minimum(end) = drift(&problem, &start) else {
                    panic!("{model:?} from {y}: no minimum");
                };
                let aside = end.point.q.y.abs() - 0.04;
                assert!(aside.abs() < 5e-5, "{model:?} from {y}: {:?}", end.point.q);
            }
        }
    }
}
