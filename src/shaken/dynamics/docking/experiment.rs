//! A docking experiment: runs its trajectories and counts how they end.

use std::cmp::Reverse;

use rand_chacha::ChaCha8Rng;

use super::{
    Docking, DockingError, DockingRun, DockingSettings, End, MatchRule, NoMagnets, Start, Trap,
    stream,
};
use crate::dynamics::{Body, Motion, Run, Simulation, Snapshot, Stop};
use landscape::Proportion;
use landscape::minimum::{Known, Outcome, approach};
use tiles::configuration::Configuration;
use tiles::order::Order;
use tiles::parallel;
use tiles::problem::Problem;
use tiles::tile::Pair;

/// Two positions of rest closer than this (m, metric of the space) are the same trap.
const SAME_TRAP: f64 = 5e-3;
/// Slightly overlapping tiles are separated by this much more than the overlap (m).
const CLEAR: f64 = 1e-6;
/// Number of steps in contact between two tests for a match.
const STEPS_BETWEEN_LOOKS: usize = 2;

/// The data shared by all trajectories of a docking experiment.
pub(super) struct Experiment<'a> {
    pub problem: &'a Problem,
    pub pair: &'a Pair,
    pub settings: &'a DockingSettings,
    pub simulation: Simulation<'a>,
    pub rule: MatchRule,
}

/// A trajectory and, if it ended trapped, the minimum below its end.
pub(super) type Ended = (DockingRun, Option<(Configuration, f64)>);

impl<'a> Experiment<'a> {
    pub fn new(problem: &'a Problem, settings: &'a DockingSettings) -> Result<Self, DockingError> {
        Self::of_body(problem, settings, |pair| Body::of_tile(&pair.moving))
    }

    /// The same for another body than that of the moving tile.
    pub fn of_body(
        problem: &'a Problem,
        settings: &'a DockingSettings,
        body: impl Fn(&Pair) -> Body,
    ) -> Result<Self, DockingError> {
        let pair = problem.pair.as_deref().ok_or(NoMagnets)?;
        let body = body(pair);
        let simulation = Simulation::new(problem, body, &settings.motion)?;
        let scaled = &simulation.settings;
        scaled.check_steps(problem.scale(), settings.duration)?;
        Ok(Self {
            problem,
            pair,
            settings,
            simulation,
            rule: MatchRule::new(problem, settings.threshold)?,
        })
    }

    /// The start of a trajectory, and its random numbers.
    pub fn start(&self, index: usize) -> (Start, ChaCha8Rng) {
        let mut rng = stream(self.settings.seed, index);
        (self.settings.starts.draw(self.pair, &mut rng), rng)
    }

    /// Simulates a trajectory to its end. `look` is called regularly, and at the end, with whether
    /// the tiles are matched.
    pub fn watched(
        &self,
        start: &Motion,
        rng: &mut ChaCha8Rng,
        look: &mut dyn FnMut(&Snapshot, bool),
        is_over: &dyn Fn(&Configuration) -> bool,
    ) -> Run {
        let mut look = |now: &Snapshot| look(now, self.rule.holds(&now.motion.configuration));
        let mut steps = 0;
        let duration = self.settings.duration;
        let run = self.simulation.run(start, duration, rng, &mut |now| {
            steps += 1;
            if !now.in_contact_range || steps % STEPS_BETWEEN_LOOKS == 0 {
                look(now);
            }
            is_over(&now.motion.configuration)
        });
        look(&run.last);
        run
    }

    /// Simulates a trajectory.
    pub fn run(&self, index: usize) -> Ended {
        let (start, mut rng) = self.start(index);
        let mut since = None;
        let mut look = |now: &Snapshot, is_matched: bool| {
            since = is_matched.then(|| since.unwrap_or(now.time));
        };
        let run = self.watched(&start.motion, &mut rng, &mut look, &|_| false);
        let caught = run.stop == Stop::Rest || run.last.total() < 0.0;
        let mut trap = None;
        let end = match since {
            _ if run.stop == Stop::Failed => End::Unsolved,
            Some(since) => End::Bound { since },
            None if run.last.in_contact_range && caught => {
                let last = &run.last.motion.configuration;
                trap = minimum_below(self.problem, last, &Known::default())
                    .map(|q| (q, self.problem.energy(&q)));
                End::Trapped { trap: None }
            }
            None => End::Free,
        };
        let run = DockingRun {
            index,
            start,
            last: run.last,
            end,
            free_steps: run.free_steps,
            contact_steps: run.contact_steps,
        };
        (run, trap)
    }

    /// Counts the ends by trap.
    pub fn docking(&self, ended: Vec<Ended>, wall_s: f64) -> Docking {
        let n = ended.len();
        // Minima with the indices of the runs that ended there.
        let mut places: Vec<(Configuration, f64, Vec<usize>)> = Vec::new();
        let mut runs = Vec::with_capacity(n);
        for (number, (run, minimum)) in ended.into_iter().enumerate() {
            runs.push(run);
            let Some((q, energy)) = minimum else { continue };
            let is_same = |p: &Configuration| {
                self.rule.distance(&self.problem.space, &q, p) < self.problem.scaled(SAME_TRAP)
            };
            match places.iter_mut().find(|(p, ..)| is_same(p)) {
                Some((.., caught)) => caught.push(number),
                None => places.push((q, energy, vec![number])),
            }
        }
        places.order_by_key(|(.., caught)| Reverse(caught.len()));
        for (trap, (.., caught)) in places.iter().enumerate() {
            for &run in caught {
                runs[run].end = End::Trapped { trap: Some(trap) };
            }
        }
        let number = |is: &dyn Fn(&End) -> bool| runs.iter().filter(|run| is(&run.end)).count();
        let unsolved = number(&|end| matches!(end, End::Unsolved));
        let count = |is: &dyn Fn(&End) -> bool| Proportion::at_least(number(is), unsolved, n);
        Docking {
            settings: self.settings.clone(),
            threshold: self.rule.threshold,
            bound: count(&|end| matches!(end, End::Bound { .. })),
            trapped: count(&|end| matches!(end, End::Trapped { .. })),
            free: count(&|end| matches!(end, End::Free)),
            unsolved,
            traps: places
                .into_iter()
                .map(|(configuration, energy, caught)| Trap {
                    configuration,
                    energy,
                    caught: Proportion::at_least(caught.len(), unsolved, n),
                })
                .collect(),
            runs,
            wall_s,
            threads: parallel::threads(),
        }
    }
}

/// The minimum that overdamped motion reaches from `q`.
pub fn minimum_below(problem: &Problem, q: &Configuration, known: &Known) -> Option<Configuration> {
    match approach(problem, &out_of_contact(problem, q), known).outcome {
        Outcome::Minimum(found) => Some(found.point.q),
        Outcome::Free | Outcome::Stuck(_) => None,
    }
}

/// A configuration, lifted out of contact if the tiles overlap slightly, as rotation within a step
/// permits.
pub fn out_of_contact(problem: &Problem, q: &Configuration) -> Configuration {
    let Some(contact) = problem.contact.as_ref().filter(|c| !c.is_free(q)) else {
        return *q;
    };
    let away = q.position().normalize();
    let position = q.position() + away * (contact.lift(q, away) + contact.scaled(CLEAR));
    Configuration::new(position.x, position.y, q.theta)
}
