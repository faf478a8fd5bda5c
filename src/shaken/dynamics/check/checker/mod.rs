//! The trajectories that check one barrier.

mod kick;
mod sides;

use nalgebra::Vector3;
use ordered_float::OrderedFloat;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{BarrierCheck, Below, CheckSettings};
use crate::dynamics::docking::{minimum_below, out_of_contact, stream};
use crate::dynamics::{Body, Motion, MotionSettings, Simulation, Snapshot, Stop};
use crate::rigid::USUAL_STEP;
use crate::rigid::normal;
use landscape::minimum::{Known, Outcome, descend_among};
use landscape::{Barrier, Place, State};
use tiles::configuration::Configuration;
use tiles::parallel;
use tiles::problem::Problem;

/// A tile this close (m, metric of the space) to a state may be in it.
const ARRIVED: f64 = 2e-3;
/// The descent from there reaches the state if it ends this close (m) to it: descents are more
/// precise, and shallow minima may be close together.
const SAME: f64 = 1e-4;
/// Distance (m) covered by a trajectory at the speed of a tile with the barrier's energy, and
/// largest duration (s).
const TRAVEL: f64 = 0.15;
const LONGEST: f64 = 10.0;
/// Coefficient of restitution of the trajectories.
const RESTITUTION: f64 = 0.9;
/// Drag (1/s, of the paper's tile) of the trajectories from either side of the saddle.
const LIGHT_DRAG: f64 = 0.5;
/// Longest way (m) of a point of the tile in one step in contact.
const STEP: f64 = 5e-4;
/// Distance (m) for testing whether a direction leads into contact.
const ASIDE: f64 = 1e-5;
/// Range of starting energies below the barrier, in units of the barrier.
const BELOW: [f64; 2] = [0.001, 0.05];
/// The same above it, for trajectories that should cross.
const ABOVE: [f64; 2] = [0.1, 2.0];
/// Number of starts tried in place of invalid ones.
const TRIES: usize = 10;

pub(super) struct Checker<'a> {
    problem: &'a Problem,
    states: &'a [State],
    known: &'a Known,
    barrier: &'a Barrier,
    settings: &'a CheckSettings,
    /// Energy (J) that trajectories stay below.
    ceiling: f64,
    climb: f64,
    /// Duration (s) of a trajectory.
    duration: f64,
    /// Tiles that keep their energy, and tiles that come to rest.
    lossless: Simulation<'a>,
    settling: Simulation<'a>,
}

/// The outcome of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    Stayed,
    Crossed,
    /// The integration error raised it above the ceiling, or contact was not solved.
    Spoilt,
}

/// A trajectory's outcome and number of steps.
type Fated = (Fate, usize);

impl<'a> Checker<'a> {
    pub fn new(
        problem: &'a Problem,
        body: Body,
        (states, known): (&'a [State], &'a Known),
        barrier: &'a Barrier,
        settings: &'a CheckSettings,
    ) -> Self {
        let ceiling = match barrier.bounds.lower {
            _ if barrier.bounds.caged => f64::INFINITY,
            Some(lower) => lower,
            None => barrier.saddle_energy - settings.settled * barrier.forward(),
        };
        let climb = if barrier.bounds.caged {
            barrier.from_energy.abs()
        } else {
            ceiling - barrier.from_energy
        };
        let speed = (2.0 * climb.max(f64::MIN_POSITIVE) / body.mass).sqrt();
        let scale = problem.scale();
        let duration = (scale.length(TRAVEL) / speed).min(scale.time(LONGEST));
        let lossless = MotionSettings {
            drag: 0.0,
            friction: 0.0,
            restitution: RESTITUTION,
            walls: true,
            contact_travel: STEP,
            // Slow tiles need no shorter steps than fast ones.
            contact_step: (STEP / speed).clamp(USUAL_STEP, 1e-2),
            ..MotionSettings::default()
        };
        let settling = MotionSettings {
            drag: LIGHT_DRAG / scale.factor(),
            restitution: 0.01,
            ..lossless.clone()
        };
        Self {
            problem,
            states,
            known,
            barrier,
            settings,
            ceiling,
            climb,
            duration,
            lossless: Simulation::of_sound_settings(problem, body, lossless),
            settling: Simulation::of_sound_settings(problem, body, settling),
        }
    }

    pub fn check(&self, seed: u64) -> BarrierCheck {
        let mut result = BarrierCheck {
            from: self.barrier.from,
            to: self.barrier.to,
            ceiling: self.ceiling,
            certified: self.barrier.bounds.caged || self.barrier.bounds.lower.is_some(),
            below: Below::default(),
            above: (0, 0),
            sides: [None; 2],
            kick: None,
            climb: self.climb,
            steps: 0,
        };
        // A lower bound below the state's energy cannot be contradicted by a trajectory.
        if self.climb <= 0.0 {
            return result;
        }
        self.run_below(seed, &mut result);
        if !self.barrier.bounds.caged {
            self.run_above(seed, &mut result);
            result.sides = self.sides(&mut result.steps);
            result.kick = self.kick(&mut result.steps);
        }
        result
    }

    fn run_below(&self, seed: u64, result: &mut BarrierCheck) {
        let one = |index| {
            let mut rng = stream(seed, index);
            let mut steps = 0;
            for spoilt in 0..TRIES {
                let share = between(BELOW, &mut rng);
                let top = self.ceiling.min(self.barrier.from_energy + self.climb);
                let start = self.start(top - share * self.climb, &mut rng);
                let (fate, more) = self.fate(&start, self.duration, self.ceiling, &mut rng);
                steps += more;
                if fate != Fate::Spoilt {
                    return (Some((fate, start)), spoilt, steps);
                }
            }
            (None, TRIES, steps)
        };
        let runs: Vec<_> = parallel::map(0..self.settings.runs, one);
        for (ended, spoilt, steps) in runs {
            result.steps += steps;
            result.below.spoilt += spoilt;
            let Some((fate, start)) = ended else {
                continue;
            };
            result.below.runs += 1;
            if fate == Fate::Crossed {
                result.below.crossed += 1;
                result.below.example.get_or_insert(start);
            }
        }
    }

    fn run_above(&self, seed: u64, result: &mut BarrierCheck) {
        let one = |index| {
            let mut rng = stream(seed, self.settings.runs + index);
            let more = between(ABOVE, &mut rng) * self.barrier.forward();
            let start = self.start(self.barrier.saddle_energy + more, &mut rng);
            self.fate(&start, self.duration, f64::INFINITY, &mut rng)
        };
        let runs: Vec<Fated> = parallel::map(0..self.settings.controls, one);
        let crossed = runs.iter().filter(|run| run.0 == Fate::Crossed).count();
        result.above = (crossed, runs.len());
        result.steps += runs.iter().map(|run| run.1).sum::<usize>();
    }

    /// A start with a total energy, before the pathway first reaches it, with a velocity in a
    /// random direction.
    fn start(&self, total: f64, rng: &mut ChaCha8Rng) -> Motion {
        let path = &self.barrier.pathway;
        let reach = path.iter().take_while(|p| p.energy < total).count();
        let before_the_end = reach.min(path.len() / 2).max(1);
        let (q, energy) = match path.get(rng.random_range(0..before_the_end)) {
            Some(point) => (point.configuration, point.energy),
            None => (self.first(), self.barrier.from_energy),
        };
        let direction = self.direction(&q, rng);
        self.moving(q, direction, total - energy)
    }

    /// The configuration of the barrier's first state.
    fn first(&self) -> Configuration {
        let Place::State(id) = self.barrier.from else {
            return self.barrier.saddle;
        };
        self.configuration(id).unwrap_or(self.barrier.saddle)
    }

    fn configuration(&self, id: usize) -> Option<Configuration> {
        let state = self.states.iter().find(|state| state.id == id)?;
        Some(state.configuration)
    }

    /// A direction that is uniform in the metric of the kinetic energy and, if one is found, does
    /// not lead into contact.
    fn direction(&self, q: &Configuration, rng: &mut ChaCha8Rng) -> Vector3<f64> {
        let masses = self.lossless.body.masses();
        let mut direction = Vector3::zeros();
        for _ in 0..20 {
            direction = Vector3::from_fn(|i, _| normal(rng) / masses[i].sqrt());
            let step = direction
                * (self.problem.scaled(ASIDE) / self.problem.space.length(direction).max(1e-300));
            if self.problem.is_clear(&q.moved(step)) {
                break;
            }
        }
        direction
    }

    fn fate(&self, start: &Motion, duration: f64, ceiling: f64, rng: &mut ChaCha8Rng) -> Fated {
        let target = match self.barrier.to {
            Place::State(id) => self.configuration(id),
            Place::Free => None,
        };
        let space = &self.problem.space;
        let mut spoilt = false;
        let run = self.lossless.run(start, duration, rng, &mut |snapshot| {
            let q = &snapshot.motion.configuration;
            spoilt |= snapshot.total() >= ceiling;
            spoilt
                || target.map_or_else(
                    || space.is_far(q),
                    |target| space.distance(&target, q) < self.problem.scaled(ARRIVED),
                )
        });
        spoilt |= run.stop == Stop::Failed;
        let last = &run.last;
        let has_crossed = || match self.barrier.to {
            Place::Free => space.is_far(&last.motion.configuration),
            to => self.seems_to_enter(last) && self.place_below(last) == Some(to),
        };
        let fate = match () {
            () if spoilt => Fate::Spoilt,
            () if has_crossed() => Fate::Crossed,
            () => Fate::Stayed,
        };
        (fate, run.free_steps + run.contact_steps)
    }

    /// A motion with a kinetic energy (J) in a direction.
    fn moving(
        &self,
        configuration: Configuration,
        direction: Vector3<f64>,
        kinetic: f64,
    ) -> Motion {
        let unit = self.lossless.body.kinetic_energy(&direction);
        let factor = if unit > 0.0 {
            (kinetic.max(0.0) / unit).sqrt()
        } else {
            0.0
        };
        Motion {
            configuration,
            velocity: direction * factor,
        }
    }

    /// Whether a rough descent leads to the barrier's end. Most tiles remain in their state, and
    /// need no further test.
    fn seems_to_enter(&self, snapshot: &Snapshot) -> bool {
        let start = out_of_contact(self.problem, &snapshot.motion.configuration);
        match descend_among(self.problem, &start, self.known).outcome {
            Outcome::Minimum(found) => self.place_of(&found.point.q) == Some(self.barrier.to),
            Outcome::Free | Outcome::Stuck(_) => false,
        }
    }

    /// The place that overdamped motion leads to.
    fn place_below(&self, snapshot: &Snapshot) -> Option<Place> {
        let q = &snapshot.motion.configuration;
        if self.problem.space.is_far(q) {
            return Some(Place::Free);
        }
        self.place_of(&minimum_below(self.problem, q, self.known)?)
    }

    /// The reported state at a minimum, if any.
    fn place_of(&self, minimum: &Configuration) -> Option<Place> {
        let distance = |s: &State| self.problem.space.distance(&s.configuration, minimum);
        let nearest = self.states.iter().min_by_key(|s| OrderedFloat(distance(s)));
        let nearest = nearest.filter(|state| distance(state) < self.problem.scaled(SAME))?;
        Some(Place::State(nearest.id))
    }
}

/// A number drawn uniformly from a range.
fn between([low, high]: [f64; 2], rng: &mut ChaCha8Rng) -> f64 {
    low + (high - low) * rng.random::<f64>()
}
