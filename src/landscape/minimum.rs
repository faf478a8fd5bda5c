//! Local minima over the free configurations, and the overdamped motion that leads into them.

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::constrained::{self, downhill, step_along};
use super::foresight::Past;
use super::known::Stretch;
pub use super::known::{Known, Outcome};
use super::stationary::{self, Stationary};
use crate::roadmap::Point;
use tiles::configuration::Configuration;
use tiles::parallel;
use tiles::problem::{Problem, Symmetry};

/// Longest step of a descent (m, mass metric).
const LONGEST_STEP: f64 = 5e-3;
/// The same if the path matters: its turns are predicted.
const LONGEST_FORESEEN: f64 = 1e-2;
/// If the path of a motion matters, a step may end this far (m, mass metric) beside it, as
/// estimated from the direction at its end. With a tenth of this value capture shares are the same;
/// with ten times as much, a seventh of all far starts pass a tab on the wrong side.
const ASIDE: f64 = 1e-6;
/// Steps up to this length (m) are exempt, because the direction jumps where contact begins or
/// ends.
const SHORT: f64 = TRY_NEWTON;
/// A descent whose steps are shorter than this (m) has arrived.
const SHORTEST_STEP: f64 = 1e-9;
/// Newton's method is tried once steps are shorter than this (m).
const TRY_NEWTON: f64 = 2e-4;
/// Number of motions that are followed before any can merge with an earlier one.
const FIRST: usize = 32;
/// Number of motions after which those done are told.
const BATCH: usize = 1024;
const MOST_STEPS: usize = 20_000;
/// Free configurations tried around a minimum, at distances from 1 µm to 1 mm.
const PROBES: u64 = 48;
/// A configuration is clearly lower than another if its energy is lower by this fraction.
const CLEARLY: f64 = 1e-9;

/// A descent: its path, including start and end, and its outcome.
#[derive(Clone, Debug)]
pub struct Descent {
    /// The path from start to end, or to where it merges with a known motion.
    pub way: Vec<Point>,
    /// Its steps with only one direction allowed by contact; empty for an image.
    pub stretches: Vec<Stretch>,
    /// Where it ended.
    pub outcome: Outcome,
    /// Steps tried, those around its end included; 0 for an image.
    pub steps: usize,
}

impl Descent {
    /// Its image under a symmetry.
    pub fn image(&self, symmetry: &Symmetry) -> Self {
        let outcome = match &self.outcome {
            Outcome::Minimum(found) => Outcome::Minimum(Box::new(found.image(symmetry))),
            Outcome::Free => Outcome::Free,
            Outcome::Stuck(q) => Outcome::Stuck(symmetry.apply(q)),
        };
        Self {
            way: self.way.iter().map(|point| point.image(symmetry)).collect(),
            stretches: Vec::new(),
            outcome,
            steps: 0,
        }
    }
}

/// Descends from `start` roughly by overdamped motion, `v = -M^-1 grad U`, sliding along contact,
/// to a minimum or far apart. Near a watershed it may end on the other side.
pub fn descend(problem: &Problem, start: &Configuration) -> Descent {
    descend_among(problem, start, &Known::default())
}

/// The same, given known ends of motions.
pub fn descend_among(problem: &Problem, start: &Configuration, known: &Known) -> Descent {
    follow(problem, start, known, f64::INFINITY, |q| {
        problem.space.is_far(q)
    })
}

/// Overdamped motion from `start`, far apart or not, to a minimum or over the table's rim, given
/// known ends of motions.
pub fn approach(problem: &Problem, start: &Configuration, known: &Known) -> Descent {
    follow(problem, start, known, problem.scaled(ASIDE), |q| {
        !problem.space.contains(q)
    })
}

/// Where overdamped motions from several starts end; their slides are added to the known ones, and how
/// many are done is told. The same on any number of threads.
pub fn learn(
    problem: &Problem,
    starts: &[Configuration],
    known: &mut Known,
    tell: &dyn Fn(usize),
) -> Vec<Outcome> {
    let mut outcomes: Vec<Outcome> = Vec::with_capacity(starts.len());
    while outcomes.len() < starts.len() {
        // Double the number each time: later motions may merge with the slides of earlier ones.
        let next = (2 * outcomes.len()).max(FIRST).min(starts.len());
        let new = &starts[outcomes.len()..next];
        // The paths themselves are not kept: those of many motions would fill the memory.
        let tell = |done| tell(outcomes.len() + done);
        let found = parallel::map_in_batches(new, BATCH, tell, |start| {
            let Descent {
                stretches, outcome, ..
            } = approach(problem, start, known);
            (stretches, outcome)
        });
        for (stretches, outcome) in found {
            known.add(stretches, &outcome);
            outcomes.push(outcome);
        }
    }
    outcomes
}

/// Follows the motion until it comes to rest or is free; a step may end up to `aside` (m) beside
/// it.
fn follow(
    problem: &Problem,
    start: &Configuration,
    known: &Known,
    aside: f64,
    is_free: impl Fn(&Configuration) -> bool,
) -> Descent {
    let mut way = vec![Point::new(problem, *start)];
    let mut stretches = Vec::new();
    let mut steps = 0;
    let outcome = trace(
        problem,
        (&mut way, &mut stretches, &mut steps),
        (known, aside),
        is_free,
    );
    Descent {
        way,
        stretches,
        outcome,
        steps,
    }
}

fn trace(
    problem: &Problem,
    (way, stretches, steps): (&mut Vec<Point>, &mut Vec<Stretch>, &mut usize),
    (known, aside): (&Known, f64),
    is_free: impl Fn(&Configuration) -> bool,
) -> Outcome {
    let mut size = problem.scaled(LONGEST_STEP);
    let mut newton_below = problem.scaled(TRY_NEWTON);
    let mut motion = None;
    let mut past = Past::default();
    let longest = if aside.is_finite() {
        problem.scaled(LONGEST_FORESEEN)
    } else {
        problem.scaled(LONGEST_STEP)
    };
    for _ in 0..MOST_STEPS {
        *steps += 1;
        let here = *way.last().expect("a way has a start");
        if is_free(&here.q) {
            return Outcome::Free;
        }
        let along = motion.take().or_else(|| downhill(problem, &here));
        if let Some(along) = &along
            && let Some(outcome) = known.lead(problem, &here.q, along)
        {
            return outcome.clone();
        }
        let next = along.as_ref().and_then(|along| {
            let foretold = past.foretell(along, size);
            let next = step_along(problem, &here, &foretold.heading, size)?;
            let after = downhill(problem, &next);
            let strays = |after| foretold.strays(problem, &here.q, after, size);
            let strays = after.as_ref().map_or(0.0, strays);
            let fitting = 0.8 * libm::pow(aside / strays, 1.0 / f64::from(foretold.order));
            Some((next, after, strays, size * fitting.clamp(0.3, 1.5)))
        });
        match next {
            Some((next, after, strays, fitting)) => {
                if strays <= aside || size <= problem.scaled(SHORT) {
                    way.push(next);
                    let ends = [along.as_ref(), after.as_ref()];
                    stretches.extend(Stretch::between([here.q, next.q], ends));
                    motion = after;
                    // In a steep valley, first-order steps are longer.
                    if let Some(along) = along
                        && aside.is_finite()
                    {
                        past.add(along, size);
                    }
                    size = fitting.min(longest);
                } else {
                    motion = along;
                    size = fitting.max(problem.scaled(SHORT));
                }
            }
            None => {
                motion = along;
                size *= 0.5;
            }
        }
        if size < newton_below {
            // Increasingly fine, so that a failing attempt costs little.
            newton_below = size / 64.0;
            *steps += PROBES as usize;
            if let Some(found) = verified_minimum(problem, way, known) {
                return Outcome::Minimum(Box::new(found));
            }
            // The path may continue from elsewhere.
            motion = None;
            past.forget();
        }
        if size < problem.scaled(SHORTEST_STEP) {
            // At rest, but not at a minimum: on a ridge, if a lower configuration is found nearby.
            match lower_neighbour(problem, &here) {
                Some(lower) => way.push(lower),
                None => return Outcome::Stuck(here.q),
            }
            size = problem.scaled(LONGEST_STEP);
            newton_below = problem.scaled(TRY_NEWTON);
            motion = None;
            past.forget();
        }
    }
    Outcome::Stuck(way.last().expect("a way has a start").q)
}

/// The minimum at the end of a path, if Newton's method finds one close by and no free
/// configuration around it lies lower; otherwise the path continues from the lower one.
fn verified_minimum(problem: &Problem, way: &mut Vec<Point>, known: &Known) -> Option<Stationary> {
    let here = *way.last()?;
    let found = stationary::minimum(problem, &here.q)?;
    let noise = problem.potential().noise() * found.point.energy.abs();
    if found.point.energy > here.energy + noise || !problem.is_free(&found.point.q) {
        return None;
    }
    if !known.holds(problem, &found.point.q)
        && let Some(lower) = lower_neighbour(problem, &found.point)
    {
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
        let distance = problem.scaled(libm::pow(10f64, -6.0 + 3.0 * k as f64 / PROBES as f64));
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
