//! The analysis on one page: from a design to its states, barriers and pathways.

mod analysis;
mod clock;
mod request;
mod stages;

pub use analysis::{Analysis, Counts, Stage};
pub use request::{Certify, Check, MILESTONES, Request, Survey};

pub(crate) use clock::Clock;

use std::sync::Arc;
use std::time::Instant;

use crate::design::Design;
use physics::configuration::Configuration;
use physics::dynamics::Body;
use physics::dynamics::check::{self, BarrierCheck};
use physics::landscape::barrier_bounds::Certified;
use physics::landscape::exploration::Exploration;
use physics::landscape::missing_states::StateSearch;
use physics::landscape::{Barrier, Catalogue, Claims, Uncertified, barrier_bounds, capture};
use physics::observer::{Observer, Silent};
use physics::parallel;
use physics::potential::{Interaction, MagnetModel};
use physics::problem::Problem;
use physics::roadmap::{Roadmap, RoadmapSettings};

/// Analyses a design. The same design and request give the same result on any number of threads,
/// unless a time limit ends a proof.
pub fn analyse(design: &Design, request: &Request, observer: &dyn Observer) -> Analysis {
    analyse_showing(design, design.problem(), request, observer, None)
}

/// The same for the given problem of a design. `show` gets what the survey found before the proofs begin, which take most of the time.
pub fn analyse_showing(
    design: &Design,
    problem: Problem,
    request: &Request,
    observer: &dyn Observer,
    show: Option<&dyn Fn(&Analysis)>,
) -> Analysis {
    let problem = Arc::new(problem);
    let roadmap = request.roadmap(&problem);
    let mut clock = Clock::new(&problem, observer);

    let (mut survey, counts) = survey(&problem, request, &roadmap, &[], &mut clock);
    let mut unlisted = 0;
    if let Some(show) = show {
        clock.start("first answer", 0.45);
        let before = problem.evaluations();
        show(&unproved(design, &problem, request, &roadmap, &survey));
        unlisted = problem.evaluations() - before;
    }
    clock.start("states that may be missing", 0.5);
    let search = StateSearch::run(&problem, &survey, &request.completeness(), observer);
    let missed = search
        .as_ref()
        .map_or_else(|_| Vec::new(), StateSearch::missed);
    if !missed.is_empty() {
        survey.add(&missed);
    }
    clock.start("capture shares", 0.6);
    let far_starts = request.far_starts();
    let tell = |done| observer.part("far starts (fewer: --far-starts)", done, far_starts.count);
    let ends = capture::ends(&problem, &far_starts, survey.known(), &tell);
    let shallow = -request.least_depth * problem.depth();
    survey.add_rests(&ends, shallow);
    let arrivals = capture::arrivals(&problem, &far_starts, &ends);
    survey.add_arrivals(&arrivals);
    clock.start("states and barriers", 0.7);
    let mut catalogue = Catalogue::of_survey(&survey, request.least_depth, observer);
    for repeat in 1..request.repeats as u64 {
        let mut again = roadmap;
        again.milestones.seed += repeat;
        let (survey, _) = self::survey(&problem, request, &again, &[], &mut clock);
        let other = Catalogue::of_survey(&survey, request.least_depth, observer);
        catalogue.widen_spread(&problem, &other);
    }
    weigh_blocks(design, &mut catalogue);
    // States that capture most are certified first.
    catalogue.count_captures(&problem, &ends);
    clock.start("certificate", 0.75);
    let certified = certify(&problem, &mut catalogue, request, observer);
    catalogue.leave_out_shallow(&problem, request.least_depth);
    let completeness = search.map(|search| search.conclude(&survey, &catalogue));
    let uncaptured = catalogue.count_captures(&problem, &ends);
    let dynamics = check_barriers(&problem, &catalogue, request, observer, &mut clock);
    let stages = clock.stop();
    Analysis {
        request: request.clone(),
        roadmap,
        bound: (design.pair.bound, problem.energy(&design.pair.bound)),
        catalogue,
        completeness,
        uncaptured,
        ring: capture::ring(&problem),
        uncertified: certified.err(),
        certificate_ended: certified.ok().and_then(|certified| certified.ended),
        dynamics,
        counts: Counts {
            // The same whether or not a first answer is shown.
            energy_evaluations: problem.evaluations() - unlisted,
            cells: certified.map_or(0, |certified| certified.cells),
            ..counts
        },
        stages,
        problem,
    }
}

/// The analysis without proofs, as far as the survey alone leads: states in which only far starts or
/// proofs end are missing.
fn unproved(
    design: &Design,
    problem: &Arc<Problem>,
    request: &Request,
    roadmap: &RoadmapSettings,
    survey: &Exploration,
) -> Analysis {
    let ends = capture::ends(problem, &request.far_starts(), survey.known(), &|_| ());
    let mut catalogue = Catalogue::of_survey(survey, request.least_depth, &Silent);
    catalogue.leave_out_shallow(problem, request.least_depth);
    weigh_blocks(design, &mut catalogue);
    Analysis {
        request: request.clone(),
        roadmap: *roadmap,
        bound: (design.pair.bound, problem.energy(&design.pair.bound)),
        uncaptured: catalogue.count_captures(problem, &ends),
        catalogue,
        completeness: Err(Uncertified::Unasked),
        ring: capture::ring(problem),
        uncertified: Some(Uncertified::Unasked),
        certificate_ended: None,
        dynamics: None,
        counts: Counts::default(),
        stages: Vec::new(),
        problem: problem.clone(),
    }
}

/// Certifies the claimed barriers, and removes states that prove not to be traps. Another trap may
/// then be the deepest, and its barriers are claimed.
fn certify(
    problem: &Problem,
    catalogue: &mut Catalogue,
    request: &Request,
    observer: &dyn Observer,
) -> Result<Certified, Uncertified> {
    let mut asked = request.certification();
    let begun = Instant::now();
    let mut all = Certified::default();
    loop {
        let certified = barrier_bounds::certify(problem, catalogue, &asked, observer)?;
        all.cells += certified.cells;
        all.work += certified.work;
        all.ended = all.ended.or(certified.ended);
        let count = catalogue.states.len();
        catalogue.leave_out_shallow(problem, request.least_depth);
        if request.claims == Claims::All || catalogue.states.len() == count {
            return Ok(all);
        }
        asked.allowed = request.certify.allowed().after(all.work, begun.elapsed());
        if asked.allowed.is_none() {
            return Ok(all);
        }
    }
}

/// Builds one roadmap and surveys the landscape from it; `guesses` are configurations that may lie
/// near minima, besides those suggested by the faces.
pub(crate) fn survey<'a>(
    problem: &'a Problem,
    request: &Request,
    roadmap: &RoadmapSettings,
    guesses: &[Configuration],
    clock: &mut Clock,
) -> (Exploration<'a>, Counts) {
    let shares = |name| match name {
        "milestones" => 0.0,
        "neighbours" => 0.05,
        _ => 0.06,
    };
    let built = Roadmap::untried(problem, roadmap, &mut |name| {
        clock.start(name, shares(name))
    });
    let milestones = built.milestones.len();
    let mut survey = Exploration::of_roadmap(problem, built, &request.exploration(roadmap));
    clock.start("states and transition states", 0.4);
    survey.explore(guesses, clock.observer);
    let counts = Counts {
        milestones,
        edges: survey.network.motions(),
        transition_states: survey.transition_states.len(),
        left_out: survey.left_out,
        ..Counts::default()
    };
    (survey, counts)
}

/// For point dipoles, adds to each state the energy of the real blocks there (behind the same
/// shields), so that nobody mistakes the dipoles' depth for the real one.
fn weigh_blocks(design: &Design, catalogue: &mut Catalogue) {
    let blocks = Interaction {
        model: MagnetModel::Cuboid,
        ..design.interaction.clone()
    };
    if blocks == design.interaction {
        return;
    }
    let blocks = blocks
        .between(&design.pair.fixed, &design.pair.moving)
        .potential;
    let kinds = catalogue.states.chunk_by_mut(|a, b| a.class == b.class);
    parallel::for_each(&mut Vec::from_iter(kinds), |copies| {
        let energy = blocks.energy(&copies[0].configuration);
        for state in copies.iter_mut() {
            state.block_energy = Some(energy);
        }
    });
}

/// Checks the claimed barriers by moving tiles, if requested.
fn check_barriers(
    problem: &Problem,
    catalogue: &Catalogue,
    request: &Request,
    observer: &dyn Observer,
    clock: &mut Clock,
) -> Option<Vec<BarrierCheck>> {
    let pair = problem.pair.as_deref()?;
    if request.check.dynamics_runs == 0 {
        return None;
    }
    clock.start("dynamics", 0.8);
    let is_claimed = |barrier: &&Barrier| request.claims.include(barrier, catalogue);
    let claimed: Vec<&Barrier> = catalogue.barriers.iter().filter(is_claimed).collect();
    Some(check::check(
        problem,
        Body::of_tile(&pair.moving),
        &catalogue.states,
        &claimed,
        &request.dynamics(),
        &|done, count| observer.part("dynamics", done, count),
    ))
}
