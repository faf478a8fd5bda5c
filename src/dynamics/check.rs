//! A check of barriers from outside the roadmap: moving tiles must not contradict them.

use nalgebra::Vector3;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::docking::{minimum_below, stream};
use super::simulation::normal;
use super::{Body, Motion, MotionSettings, Sample, SettingsError, Simulation};
use crate::configuration::Configuration;
use crate::landscape::{Barrier, Place, State};
use crate::problem::Problem;

/// A tile this close (m, metric of the space) to a state is in it.
const ARRIVED: f64 = 2e-3;
/// Starts below a barrier have at most this share of it to go.
const CLOSE_BELOW: f64 = 0.05;
/// Energies of kicks that are tried, in barriers.
const KICKS: [f64; 16] = [
    0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0, 1.02, 1.05, 1.1, 1.2, 1.5, 2.0, 3.0, 5.0, 8.0,
];

/// What the check does.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckSettings {
    pub seed: u64,
    /// Trajectories below each barrier.
    pub runs: usize,
    /// How long they last (s).
    pub duration: f64,
    /// Restitution of their knocks; they have neither drag nor friction.
    pub restitution: f64,
    /// Drag (1/s) of the trajectories from either side of the saddle, and their duration (s).
    pub light_drag: f64,
    pub settling: f64,
}

impl Default for CheckSettings {
    fn default() -> Self {
        Self {
            seed: 1,
            runs: 1000,
            duration: 0.5,
            restitution: 0.9,
            light_drag: 2.0,
            settling: 10.0,
        }
    }
}

/// What moving tiles say of one barrier.
#[derive(Clone, Debug, PartialEq)]
pub struct BarrierCheck {
    pub from: Place,
    pub to: Place,
    /// The energy (J) that trajectories stayed below: the barrier's certified lower bound, or its
    /// saddle energy where there is none.
    pub ceiling: f64,
    pub certified: bool,
    /// Trajectories with less total energy than the ceiling, and how many of them crossed.
    pub below: usize,
    pub crossed: usize,
    /// How many more gained energy past the ceiling by the integration's error; they prove nothing.
    pub spoilt: usize,
    /// The start of one that crossed.
    pub example: Option<Motion>,
    /// Where trajectories from either side of the saddle ended: from the start's side, and from
    /// the end's side. `None` where they ended in no reported state.
    pub sides: Option<[Option<Place>; 2]>,
    /// Least kinetic energy (J) among those tried that kicked the tile out along the pathway.
    pub kick: Option<f64>,
    /// The barrier (J), seen from the start.
    pub barrier: f64,
}

impl BarrierCheck {
    /// Whether the trajectories contradict the barrier: one crossed it from below, or a kick of
    /// less energy threw the tile out.
    pub fn is_contradicted(&self) -> bool {
        self.crossed > 0
            || self
                .kick
                .is_some_and(|kick| kick < (1.0 - 1e-6) * self.barrier)
    }

    /// Whether the trajectories from either side of the saddle ended at the pathway's ends; those
    /// of a pathway that leads through other states end in the ones next to its highest saddle.
    pub fn joins_its_ends(&self) -> Option<bool> {
        self.sides
            .map(|sides| sides == [Some(self.from), Some(self.to)])
    }
}

/// Checks those barriers that lead out of a state.
///
/// # Errors
/// Where a setting makes no sense.
pub fn check(
    problem: &Problem,
    body: Body,
    states: &[State],
    barriers: &[Barrier],
    settings: &CheckSettings,
) -> Result<Vec<BarrierCheck>, SettingsError> {
    let lossless = MotionSettings {
        drag: 0.0,
        friction: 0.0,
        restitution: settings.restitution,
        walls: false,
        contact_travel: 2e-4,
        ..MotionSettings::default()
    };
    let settling = MotionSettings {
        drag: settings.light_drag,
        restitution: 0.01,
        ..lossless.clone()
    };
    let checker = Checker {
        problem,
        states,
        settings,
        lossless: Simulation::new(problem, body, &lossless)?,
        settling: Simulation::new(problem, body, &settling)?,
    };
    Ok(barriers
        .iter()
        .enumerate()
        .filter_map(|(number, barrier)| checker.check(number, barrier))
        .collect())
}

struct Checker<'a> {
    problem: &'a Problem,
    states: &'a [State],
    settings: &'a CheckSettings,
    lossless: Simulation<'a>,
    settling: Simulation<'a>,
}

impl Checker<'_> {
    fn check(&self, number: usize, barrier: &Barrier) -> Option<BarrierCheck> {
        let Place::State(_) = barrier.from else {
            return None;
        };
        let ceiling = barrier.lower.unwrap_or(barrier.saddle_energy);
        let depth = ceiling - barrier.from_energy;
        if barrier.pathway.len() < 2 || depth <= 0.0 {
            return None;
        }
        let outcomes: Vec<(Motion, Fate)> = (0..self.settings.runs)
            .into_par_iter()
            .map(|index| {
                let mut rng = stream(self.settings.seed + number as u64, index);
                let start = self.start_below(barrier, ceiling, depth, &mut rng);
                (start, self.fate(barrier, &start, ceiling, &mut rng))
            })
            .collect();
        let count = |fate| outcomes.iter().filter(|o| o.1 == fate).count();
        Some(BarrierCheck {
            from: barrier.from,
            to: barrier.to,
            ceiling,
            certified: barrier.lower.is_some(),
            below: self.settings.runs - count(Fate::Spoilt),
            crossed: count(Fate::Crossed),
            spoilt: count(Fate::Spoilt),
            example: outcomes.iter().find(|o| o.1 == Fate::Crossed).map(|o| o.0),
            sides: self.sides(barrier),
            kick: self.kick(barrier, depth),
            barrier: depth,
        })
    }

    /// A start on the pathway's first stretch, with a total energy little below the ceiling and a
    /// velocity in a random direction.
    fn start_below(
        &self,
        barrier: &Barrier,
        ceiling: f64,
        depth: f64,
        rng: &mut ChaCha8Rng,
    ) -> Motion {
        let total = ceiling - CLOSE_BELOW * depth * (1.0 - rng.random::<f64>());
        let path = &barrier.pathway;
        let reach = path.iter().take_while(|p| p.energy < total).count().max(1);
        let point = &path[rng.random_range(0..reach)];
        let q = point.configuration;
        let kinetic = (total - point.energy).max(0.0);
        let direction = self.direction(&q, rng);
        self.moving(q, direction, kinetic)
    }

    /// A direction that is uniform over kinetic energies and, if one is found, leads into no
    /// contact.
    fn direction(&self, q: &Configuration, rng: &mut ChaCha8Rng) -> Vector3<f64> {
        let masses = self.lossless.body().masses();
        let mut direction = Vector3::zeros();
        for _ in 0..20 {
            direction = Vector3::from_fn(|i, _| normal(rng) / masses[i].sqrt());
            let step = direction * (1e-5 / self.problem.space.length(direction).max(1e-300));
            if self.problem.is_clear(&q.moved(step)) {
                break;
            }
        }
        direction
    }

    fn moving(
        &self,
        configuration: Configuration,
        direction: Vector3<f64>,
        kinetic: f64,
    ) -> Motion {
        let unit = self.lossless.body().kinetic_energy(&direction);
        let factor = if unit > 0.0 {
            (kinetic / unit).sqrt()
        } else {
            0.0
        };
        Motion {
            configuration,
            velocity: direction * factor,
        }
    }

    fn fate(&self, barrier: &Barrier, start: &Motion, ceiling: f64, rng: &mut ChaCha8Rng) -> Fate {
        let mut spoilt = false;
        let mut arrived = false;
        let run = self
            .lossless
            .run(start, self.settings.duration, rng, &mut |sample| {
                spoilt |= sample.total() >= ceiling;
                arrived |= self.is_at(barrier.to, sample);
                spoilt || arrived
            });
        if spoilt {
            Fate::Spoilt
        } else if arrived || self.place_below(&run.last) == Some(barrier.to) {
            Fate::Crossed
        } else {
            Fate::Stayed
        }
    }

    fn is_at(&self, place: Place, sample: &Sample) -> bool {
        let q = &sample.motion.configuration;
        match place {
            Place::Free => self.problem.space.is_far(q),
            Place::State(id) => self
                .states
                .iter()
                .find(|state| state.id == id)
                .is_some_and(|s| self.problem.space.distance(&s.configuration, q) < ARRIVED),
        }
    }

    /// The place that slow motion leads to.
    fn place_below(&self, sample: &Sample) -> Option<Place> {
        let q = &sample.motion.configuration;
        if self.problem.space.is_far(q) {
            return Some(Place::Free);
        }
        let found = minimum_below(self.problem, q)?;
        self.states
            .iter()
            .find(|state| self.problem.space.distance(&state.configuration, &found) < ARRIVED)
            .map(|state| Place::State(state.id))
    }

    /// Released at rest a little to either side of the saddle.
    fn sides(&self, barrier: &Barrier) -> Option<[Option<Place>; 2]> {
        let path = &barrier.pathway;
        let top = (0..path.len()).max_by(|&a, &b| path[a].energy.total_cmp(&path[b].energy))?;
        let drop = 0.01 * (barrier.forward().min(barrier.reverse()));
        let low = |k: &usize| path[*k].energy <= path[top].energy - drop;
        let before = (0..top).rev().find(low)?;
        let after = (top + 1..path.len()).find(low)?;
        Some([before, after].map(|k| {
            let start = self.moving(path[k].configuration, Vector3::zeros(), 0.0);
            let mut rng = stream(self.settings.seed, 0);
            let mut far = false;
            let run = self
                .settling
                .run(&start, self.settings.settling, &mut rng, &mut |sample| {
                    far = self.problem.space.is_far(&sample.motion.configuration);
                    far
                });
            if far {
                Some(Place::Free)
            } else {
                self.place_below(&run.last)
            }
        }))
    }

    /// The least kick along the pathway's beginning that leads to its end.
    fn kick(&self, barrier: &Barrier, depth: f64) -> Option<f64> {
        let path = &barrier.pathway;
        let first = path[0].configuration;
        let ahead = path
            .iter()
            .find(|p| p.energy > path[0].energy + 0.05 * depth)?;
        let step = first.step_to(&ahead.configuration);
        // The centre of mass moves along with the turn.
        let lever = self.lossless.body().lever(first.theta);
        let direction = step + Vector3::new(-lever.y, lever.x, 0.0) * step.z;
        let thrown = |factor: &&f64| {
            let start = self.moving(first, direction, **factor * depth);
            let mut rng = stream(self.settings.seed, 0);
            let mut arrived = false;
            let run = self.lossless.run(
                &start,
                4.0 * self.settings.duration,
                &mut rng,
                &mut |sample| {
                    arrived = self.is_at(barrier.to, sample);
                    arrived
                },
            );
            arrived || self.place_below(&run.last) == Some(barrier.to)
        };
        KICKS.iter().find(thrown).map(|factor| factor * depth)
    }
}

/// What became of a trajectory below a barrier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    Stayed,
    Crossed,
    /// The integration's error lifted it over the ceiling.
    Spoilt,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Settings;
    use crate::dynamics::tests::paper_tile;
    use crate::pipeline;

    #[test]
    fn the_slid_bond_keeps_its_barrier_and_leads_where_its_pathway_says() {
        let design = paper_tile();
        let problem = pipeline::problem(&design);
        let analysis = pipeline::analyse(&design, &Settings::default(), &pipeline::Silent);
        let body = Body::of_tile(&design.moving);
        let settings = CheckSettings {
            runs: 60,
            ..CheckSettings::default()
        };
        let is_slid = |b: &&Barrier| {
            (b.from_energy + 16.026e-3).abs() < 1e-5 && matches!(b.to, Place::State(_))
        };
        let slid: Vec<_> = analysis.barriers.iter().filter(is_slid).cloned().collect();
        assert!(!slid.is_empty());
        for one in check(&problem, body, &analysis.states, &slid, &settings).unwrap() {
            assert!(!one.is_contradicted(), "{one:?}");
            assert!(one.below >= 50, "{one:?}");
            assert_eq!(one.joins_its_ends(), Some(true), "{one:?}");
        }
        // A barrier that is said to be higher than it is does not stand the check.
        let mut wrong = slid[0].clone();
        wrong.saddle_energy += 10e-3;
        let found = check(&problem, body, &analysis.states, &[wrong], &settings).unwrap();
        assert!(found[0].crossed > 0 && found[0].is_contradicted());
        assert!(found[0].example.is_some());
    }
}
