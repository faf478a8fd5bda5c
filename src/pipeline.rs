//! The main job in one readable page: from a design to its states, barriers and pathways.

use std::time::Instant;

use crate::analysis::{Analysis, Counts, Settings, Stage};
use crate::certification;
use crate::configuration::Configuration;
use crate::design::Design;
use crate::dynamics::Body;
use crate::dynamics::check::{self, BarrierCheck, CheckSettings};
use crate::landscape::Barrier;
use crate::landscape::capture::{self, FarStarts};
use crate::landscape::inventory::{self, Inventory};
use crate::landscape::survey::{Survey, SurveySettings};
use crate::landscape::symmetry::Symmetry;
use crate::potential::{self, MagnetModel};
use crate::problem::Problem;
use crate::roadmap::{
    Acceptance, EdgeSettings, MilestoneSettings, ProfileTolerance, Roadmap, edge, milestone,
    neighbour,
};

/// Is told what the main job is doing.
pub trait Observer: Sync {
    /// A stage begins; `share` of the whole time (0 to 1) is behind.
    fn stage(&self, name: &'static str, share: f64);

    /// Of a stage that has `count` parts, `done` are done.
    fn part(&self, _name: &'static str, _done: usize, _count: usize) {}
}

/// An observer that looks away.
pub struct Silent;

impl Observer for Silent {
    fn stage(&self, _: &'static str, _: f64) {}
}

/// The problem that a design poses.
pub fn problem(design: &Design) -> Problem {
    let (fixed, moving) = (&design.fixed, &design.moving);
    let potential = potential::of_tiles(design.model, fixed, moving, &design.shields);
    Problem::of_tiles(design.space(), fixed, moving, potential)
}

/// The main job. The same design and settings give the same result on any number of threads, as
/// long as the certificate keeps within its time.
pub fn analyse(design: &Design, settings: &Settings, observer: &dyn Observer) -> Analysis {
    let problem = problem(design);
    let symmetries = Symmetry::all(design);
    let mut clock = Clock::new(&problem, observer);

    let first = survey(
        design,
        &problem,
        &symmetries,
        settings,
        settings.seed,
        &[],
        &mut clock,
    );
    clock.start("states and barriers", 0.6);
    let mut inventory = inventory::take(design, &problem, &symmetries, &first.survey, settings);
    clock.start("capture shares", 0.7);
    let starts = FarStarts {
        count: settings.far_starts,
        seed: settings.seed,
    };
    let ends = capture::ends(&problem, &starts);
    let uncaptured = inventory.count_captures(&problem, &ends);
    for repeat in 1..settings.repeats as u64 {
        let again = survey(
            design,
            &problem,
            &symmetries,
            settings,
            settings.seed + repeat,
            &[],
            &mut clock,
        );
        let other = inventory::take(design, &problem, &symmetries, &again.survey, settings);
        inventory.widen_spread(&problem, &other);
    }
    weigh_blocks(design, &mut inventory);
    clock.start("certificate", 0.75);
    let certified = certification::certify(
        design,
        &problem,
        &symmetries,
        &mut inventory,
        settings,
        observer,
    );
    let dynamics = check_barriers(design, &problem, &inventory, settings, &mut clock);
    let stages = clock.stop();
    let Inventory {
        states,
        escapes,
        barriers,
        alternatives,
        bound_state,
        shallow,
    } = inventory;
    Analysis {
        settings: settings.clone(),
        bound: (design.bound, problem.energy(&design.bound)),
        bound_state,
        states,
        escapes,
        barriers,
        alternatives,
        shallow,
        uncaptured,
        ring: capture::ring(&problem),
        uncertified: certified.err(),
        dynamics,
        counts: Counts {
            energy_evaluations: problem.evaluations(),
            cells: certified.unwrap_or(0),
            ..first.counts
        },
        stages,
    }
}

/// Where the magnets are modelled as point dipoles, gives each state the energy of the real blocks
/// there (behind the same shields), so that nobody takes the dipoles' depth for the real one.
fn weigh_blocks(design: &Design, inventory: &mut Inventory) {
    if design.model == MagnetModel::Cuboid {
        return;
    }
    let (fixed, moving) = (&design.fixed, &design.moving);
    let blocks = potential::of_tiles(MagnetModel::Cuboid, fixed, moving, &design.shields);
    for state in &mut inventory.states {
        state.block_energy = Some(blocks.energy(&state.configuration));
    }
}

/// What moving tiles say of the barriers that are claimed, if they are asked.
fn check_barriers(
    design: &Design,
    problem: &Problem,
    inventory: &Inventory,
    settings: &Settings,
    clock: &mut Clock,
) -> Option<Vec<BarrierCheck>> {
    if settings.dynamics_runs == 0 {
        return None;
    }
    clock.start("dynamics", 0.8);
    let check = CheckSettings {
        seed: settings.seed,
        runs: settings.dynamics_runs,
        settled: settings.settled,
        ..CheckSettings::default()
    };
    let observer = clock.observer;
    let is_claimed = |barrier: &&Barrier| inventory.is_claimed(barrier, settings.claims);
    let claimed: Vec<&Barrier> = inventory.barriers.iter().filter(is_claimed).collect();
    Some(check::check(
        problem,
        Body::of_tile(&design.moving),
        &inventory.states,
        &claimed,
        &check,
        &|done, count| observer.part("dynamics", done, count),
    ))
}

/// A survey, and how much was done for it.
pub(crate) struct Surveyed {
    pub survey: Survey,
    pub counts: Counts,
}

/// One roadmap and what is found from it; `guesses` are configurations that may lie near minima,
/// besides those that the faces suggest.
pub(crate) fn survey(
    design: &Design,
    problem: &Problem,
    symmetries: &[Symmetry],
    settings: &Settings,
    seed: u64,
    guesses: &[Configuration],
    clock: &mut Clock,
) -> Surveyed {
    let depth = energy_scale(design, problem);
    let edge_settings = edge_settings(settings, depth);
    clock.start("milestones", 0.0);
    let milestones = milestone::milestones(problem, &milestone_settings(settings, seed, depth));
    clock.start("neighbours", 0.05);
    let k = settings
        .neighbours
        .unwrap_or_else(|| neighbour::neighbours_per_milestone(milestones.len()));
    let pairs = neighbour::neighbour_pairs(&milestones, &problem.space, k);
    clock.start("edges", 0.06);
    let edges = edge::edges(problem, &milestones, &pairs, &edge_settings);
    drop(pairs);
    let mut counts = Counts {
        milestones: milestones.len(),
        edges: edges.len(),
        ..Counts::default()
    };
    clock.start("states and transition states", 0.4);
    let survey = Survey::new(
        problem,
        Roadmap { milestones, edges },
        &[&flush_meetings(design, problem), guesses].concat(),
        &|q| symmetries.iter().map(|s| s.apply(q)).collect(),
        &SurveySettings {
            edge: edge_settings,
            settled: settings.settled,
            added_milestones: 100,
            most_rounds: 8,
            seed,
        },
    );
    counts.transition_states = survey.transition_states.len();
    Surveyed { survey, counts }
}

/// The roadmap of an analysis with these settings, built anew.
pub fn roadmap(design: &Design, problem: &Problem, settings: &Settings) -> Roadmap {
    let depth = energy_scale(design, problem);
    Roadmap::build(
        problem,
        &milestone_settings(settings, settings.seed, depth),
        settings.neighbours,
        &edge_settings(settings, depth),
    )
}

fn milestone_settings(settings: &Settings, seed: u64, depth: f64) -> MilestoneSettings {
    let acceptance = match settings.boltzmann {
        Some(energy) => Acceptance::Boltzmann { energy },
        None => Acceptance::Linear {
            lowest: -depth,
            highest: 0.1 * depth,
        },
    };
    MilestoneSettings {
        count: settings.milestones,
        acceptance,
        seed,
    }
}

/// Depth (J) that energies are measured by: that of the bound configuration, or of the deepest
/// of the flush meetings of two faces where the bound one does not attract.
pub fn energy_scale(design: &Design, problem: &Problem) -> f64 {
    flush_meetings(design, problem)
        .iter()
        .map(|q| problem.energy(q).abs())
        .fold(f64::MIN_POSITIVE, f64::max)
}

pub(crate) fn edge_settings(settings: &Settings, depth: f64) -> EdgeSettings {
    EdgeSettings {
        tolerance: ProfileTolerance {
            relative: 0.01,
            absolute: 1e-5 * depth,
        },
        thermal_energy: settings.thermal_energy.unwrap_or(0.01 * depth),
        probability_step: 5e-3,
    }
}

/// Where minima may be expected: the bound configuration, and every pair of faces set flush
/// against each other, pushed out into contact where their shapes overlap.
fn flush_meetings(design: &Design, problem: &Problem) -> Vec<Configuration> {
    let mut all = vec![design.bound];
    for fixed in &design.fixed.faces {
        for moving in &design.moving.faces {
            let flush = milestone::face_to_face(fixed, moving, 0.0, 0.0);
            let lift = problem
                .contact
                .as_ref()
                .map_or(0.0, |contact| contact.lift(&flush, fixed.normal()));
            let position = flush.position() + fixed.normal() * lift;
            let q = Configuration::new(position.x, position.y, flush.theta);
            if problem.is_free(&q) {
                all.push(q);
            }
        }
    }
    all
}

/// Measures the stages.
pub(crate) struct Clock<'a> {
    problem: &'a Problem,
    observer: &'a dyn Observer,
    stages: Vec<Stage>,
    running: Option<(&'static str, Instant, u64)>,
}

impl<'a> Clock<'a> {
    pub fn new(problem: &'a Problem, observer: &'a dyn Observer) -> Self {
        Self {
            problem,
            observer,
            stages: Vec::new(),
            running: None,
        }
    }

    fn start(&mut self, name: &'static str, share: f64) {
        self.finish();
        self.observer.stage(name, share);
        self.running = Some((name, Instant::now(), self.problem.evaluations()));
    }

    fn finish(&mut self) {
        let Some((name, since, evaluations)) = self.running.take() else {
            return;
        };
        let wall_s = since.elapsed().as_secs_f64();
        let energy_evaluations = self.problem.evaluations() - evaluations;
        match self.stages.iter_mut().find(|stage| stage.name == name) {
            Some(stage) => {
                stage.wall_s += wall_s;
                stage.energy_evaluations += energy_evaluations;
            }
            None => self.stages.push(Stage {
                name,
                wall_s,
                energy_evaluations,
            }),
        }
    }

    fn stop(mut self) -> Vec<Stage> {
        self.finish();
        self.stages
    }
}
