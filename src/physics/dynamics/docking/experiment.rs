//! One docking experiment: a trajectory at a time, and what their ends are counted as.

use super::{Docking, DockingError, DockingRun, DockingSettings, End, MatchRule, Trap, stream};
use crate::configuration::Configuration;
use crate::dynamics::{Body, Simulation, Snapshot, Stop};
use crate::landscape::Proportion;
use crate::landscape::minimum::{Known, Outcome, approach};
use crate::order::Order;
use crate::problem::Problem;
use crate::tile::Pair;

/// Two resting places closer than this (m, metric of the space) lie in the same trap.
const SAME_TRAP: f64 = 5e-3;
/// Tiles that overlap a little are set apart by this much more than that (m).
const CLEAR: f64 = 1e-6;
/// Steps in contact between two looks at whether the tiles are matched.
pub(super) const STEPS_BETWEEN_LOOKS: usize = 5;

/// What all trajectories of a docking experiment share.
pub(super) struct Experiment<'a> {
    problem: &'a Problem,
    pub pair: &'a Pair,
    settings: &'a DockingSettings,
    pub simulation: Simulation<'a>,
    rule: MatchRule,
}

/// A trajectory and, where it ended in no match but caught, the minimum below its end.
pub(super) type Ended = (DockingRun, Option<(Configuration, f64)>);

impl<'a> Experiment<'a> {
    pub fn new(problem: &'a Problem, settings: &'a DockingSettings) -> Result<Self, DockingError> {
        let pair = problem.pair.as_deref().ok_or(DockingError::NoMagnets)?;
        let body = Body::of_tile(&pair.moving);
        Ok(Self {
            problem,
            pair,
            settings,
            simulation: Simulation::new(problem, body, &settings.motion)?,
            rule: MatchRule::new(problem, settings.threshold)?,
        })
    }

    pub fn run(&self, index: usize) -> Ended {
        let mut rng = stream(self.settings.seed, index);
        let start = self.settings.starts.draw(self.pair, &mut rng);
        let mut since = None;
        let mut steps = 0;
        let mut look = |snapshot: &Snapshot| {
            let matched = self.rule.holds(&snapshot.motion.configuration);
            since = if matched {
                since.or(Some(snapshot.time))
            } else {
                None
            };
        };
        let run = self.simulation.run(
            &start.motion,
            self.settings.duration,
            &mut rng,
            &mut |snapshot| {
                steps += 1;
                if !snapshot.in_contact_range || steps % STEPS_BETWEEN_LOOKS == 0 {
                    look(snapshot);
                }
                false
            },
        );
        look(&run.last);
        let caught = run.stop == Stop::Rest || run.last.total() < 0.0;
        let mut trap = None;
        let end = match since {
            Some(since) => End::Bound { since },
            None if run.last.in_contact_range && caught => {
                trap = minimum_below(
                    self.problem,
                    &run.last.motion.configuration,
                    &Known::default(),
                )
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

    /// Counts the ends, telling traps apart.
    pub fn docking(&self, ended: Vec<Ended>, wall_s: f64) -> Docking {
        let n = ended.len();
        let mut places: Vec<(Configuration, f64, usize)> = Vec::new();
        let mut runs = Vec::with_capacity(n);
        for (mut run, minimum) in ended {
            if let Some((q, energy)) = minimum {
                let known = places
                    .iter()
                    .position(|(p, ..)| self.rule.distance(&self.problem.space, &q, p) < SAME_TRAP);
                let number = known.unwrap_or_else(|| {
                    places.push((q, energy, 0));
                    places.len() - 1
                });
                places[number].2 += 1;
                run.end = End::Trapped { trap: Some(number) };
            }
            runs.push(run);
        }
        let mut order: Vec<usize> = (0..places.len()).collect();
        order.order_by_key(|&k| std::cmp::Reverse(places[k].2));
        for run in &mut runs {
            if let End::Trapped { trap: Some(number) } = &mut run.end {
                *number = order.iter().position(|k| k == number).unwrap_or(*number);
            }
        }
        let count = |is: &dyn Fn(&End) -> bool| {
            Proportion::new(runs.iter().filter(|run| is(&run.end)).count(), n)
        };
        Docking {
            settings: self.settings.clone(),
            threshold: self.rule.threshold,
            bound: count(&|end| matches!(end, End::Bound { .. })),
            trapped: count(&|end| matches!(end, End::Trapped { .. })),
            free: count(&|end| matches!(end, End::Free)),
            traps: order
                .iter()
                .map(|&k| Trap {
                    configuration: places[k].0,
                    energy: places[k].1,
                    caught: Proportion::new(places[k].2, n),
                })
                .collect(),
            runs,
            wall_s,
            threads: rayon::current_num_threads(),
        }
    }
}

/// Where slow motion leads from `q`.
pub fn minimum_below(problem: &Problem, q: &Configuration, known: &Known) -> Option<Configuration> {
    match approach(problem, &out_of_contact(problem, q), known).outcome {
        Outcome::Minimum(found) => Some(found.point.q),
        Outcome::Free | Outcome::Stuck(_) => None,
    }
}

/// A configuration, lifted out of contact where the tiles overlap by the little that turning within a
/// step lets them.
pub fn out_of_contact(problem: &Problem, q: &Configuration) -> Configuration {
    let Some(contact) = problem.contact.as_ref().filter(|c| !c.is_free(q)) else {
        return *q;
    };
    let away = q.position().normalize();
    let position = q.position() + away * (contact.lift(q, away) + CLEAR);
    Configuration::new(position.x, position.y, q.theta)
}
