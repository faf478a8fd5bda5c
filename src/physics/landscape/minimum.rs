//! Local minima over the free configurations, and the overdamped motion that leads into them.

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::constrained::{self, downhill, step_along};
use super::foresight::Past;
use super::known::Stretch;
pub use super::known::{Known, Outcome};
use super::stationary::{self, Stationary};
use crate::configuration::Configuration;
use crate::parallel;
use crate::problem::{Problem, Symmetry};
use crate::roadmap::Point;

/// Longest step of a descent (m, mass metric).
const LONGEST_STEP: f64 = 5e-3;
/// The same where it matters which way it goes: how it will turn is foreseen.
const LONGEST_FORESEEN: f64 = 1e-2;
/// Where it matters which way a motion goes, a step may end this far (m, mass metric) beside it, as the
/// direction at its end tells. With a tenth of it shares of captures are the same; with a tenfold, a
/// seventh of all far starts goes the wrong way around a tab.
const ASIDE: f64 = 1e-6;
/// But steps no longer than this (m) may: where contact begins or ends the direction jumps.
const SHORT: f64 = TRY_NEWTON;
/// A descent whose steps are shorter than this (m) has arrived.
const SHORTEST_STEP: f64 = 1e-9;
/// Newton's method is tried once steps are shorter than this (m).
const TRY_NEWTON: f64 = 2e-4;
/// Motions that are followed before any is known to come on another's way.
const FIRST: usize = 32;
const MOST_STEPS: usize = 20_000;
/// Free configurations tried around a minimum, at distances from 1 µm to 1 mm.
const PROBES: u64 = 48;
/// A configuration is clearly lower than another if its energy is by this fraction.
const CLEARLY: f64 = 1e-9;

/// A descent: its way, start and end included, and where it ended.
#[derive(Clone, Debug)]
pub struct Descent {
    /// Where it went, from start to end, or to where it is known where motions go on to.
    pub way: Vec<Point>,
    /// The steps of it on which contact left no choice; an image is given none.
    pub stretches: Vec<Stretch>,
    /// Where it ended.
    pub outcome: Outcome,
}

impl Descent {
    /// What a symmetry makes of it.
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
        }
    }
}

/// Down from `start` roughly by overdamped motion, `v = -M^-1 grad U`, sliding along contact, until a
/// minimum or far apart: where ways part, it may take the other one.
pub fn descend(problem: &Problem, start: &Configuration) -> Descent {
    descend_among(problem, start, &Known::default())
}

/// The same where something is known.
pub fn descend_among(problem: &Problem, start: &Configuration, known: &Known) -> Descent {
    follow(problem, start, known, f64::INFINITY, |q| {
        problem.space.is_far(q)
    })
}

/// Overdamped motion from `start`, far apart or not, until a minimum or over the table's rim, where
/// something is known.
pub fn approach(problem: &Problem, start: &Configuration, known: &Known) -> Descent {
    follow(problem, start, known, problem.scaled(ASIDE), |q| {
        !problem.space.contains(q)
    })
}

/// Where overdamped motions from several starts lead; how they slid there is known from now on. The same
/// on any number of threads.
pub fn learn(problem: &Problem, starts: &[Configuration], known: &mut Known) -> Vec<Outcome> {
    let mut outcomes: Vec<Outcome> = Vec::with_capacity(starts.len());
    while outcomes.len() < starts.len() {
        // As many again as there were, which may come on the slides of those.
        let next = (2 * outcomes.len()).max(FIRST).min(starts.len());
        let new = &starts[outcomes.len()..next];
        let descents = parallel::map(new, |q| approach(problem, q, known));
        for descent in descents {
            known.add(descent.stretches, &descent.outcome);
            outcomes.push(descent.outcome);
        }
    }
    outcomes
}

/// Follows the motion to where it comes to rest or is free; a step may end so far `aside` of it (m).
fn follow(
    problem: &Problem,
    start: &Configuration,
    known: &Known,
    aside: f64,
    is_free: impl Fn(&Configuration) -> bool,
) -> Descent {
    let mut way = vec![Point::new(problem, *start)];
    let mut stretches = Vec::new();
    let outcome = trace(problem, &mut way, &mut stretches, (known, aside), is_free);
    Descent {
        way,
        stretches,
        outcome,
    }
}

fn trace(
    problem: &Problem,
    way: &mut Vec<Point>,
    stretches: &mut Vec<Stretch>,
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
                    // Steps of first order are the longer ones in a steep valley.
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
            // Ever finer, so that a failing attempt costs little.
            newton_below = size / 64.0;
            if let Some(found) = verified_minimum(problem, way, known) {
                return Outcome::Minimum(Box::new(found));
            }
            // The way may go on from elsewhere.
            motion = None;
            past.forget();
        }
        if size < problem.scaled(SHORTEST_STEP) {
            // At rest, but on no minimum: on a ridge, if anywhere lower is to be found near by.
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

/// The minimum at the end of a way, if Newton's method finds one close by and no free
/// configuration around it lies lower. Where one does, the way goes on from there.
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
