//! How long a survey takes, told beforehand where that is long.

use std::time::Instant;

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::problem::Problem;
use tilebind::roadmap::profile::Profile;
use tilebind::roadmap::{Milestone, MilestoneSettings, RoadmapSettings, milestone};
use tilebind::tile::Tile;
use tilebind::units::si;
use tilebind::{Design, Settings};

use super::tell;

/// Motions that are followed for each milestone and each of its neighbours, and for each state that
/// is joined to the roadmap, about; energies for each far start: so that squares with 64 magnets a
/// face in random order take what they did.
const FOR_A_NEIGHBOUR: f64 = 0.15;
const FOR_A_STATE: f64 = 170.0;
const FOR_A_FAR_START: f64 = 150.0;
/// What comes after, of what these take.
const AFTER: f64 = 1.4;
/// Milestones that are drawn to time them, and how far (m) from each it is to neighbours there and
/// around states.
const SAMPLE: usize = 16;
const AWAY: [f64; 3] = [0.03, 0.01, 1e-3];
/// Pairs of magnets below which no time is worth telling: their energy takes microseconds.
const FEW_PAIRS: usize = 10_000;
/// Surveys that take longer (s) are told of.
const LONG: f64 = 60.0;

/// What is surveyed.
#[derive(Clone, Copy, Debug)]
pub struct Survey {
    pub milestones: usize,
    pub far_starts: usize,
    /// Whether all states are looked for, not only ways between two poses.
    pub states: bool,
}

/// Tells of a design with very many magnets what takes no survey, the energy where the target faces
/// meet, how long the survey takes, about, and what makes it shorter.
pub fn tell_of(design: &Design, survey: Survey, threads: usize) {
    let pair = &design.pair;
    let pairs = pair.fixed.magnets.len() * pair.moving.magnets.len();
    if pairs < FEW_PAIRS {
        return;
    }
    let problem = design.problem();
    let bond = problem.energy(&pair.bound);
    let total = seconds(&problem, survey, [&pair.fixed, &pair.moving]) / threads as f64;
    if total > LONG {
        let bond = si(bond, "J", 4);
        let time = if total < 7200.0 {
            format!("{:.0} min", (total / 60.0).ceil())
        } else {
            format!("{:.0} h", (total / 3600.0).ceil())
        };
        let fewer = match survey.far_starts {
            0 => "fewer --milestones take less",
            _ => "fewer --milestones and --far-starts take less, fewer magnets far less",
        };
        tell(format!(
            "note: {bond} where the target faces meet; {pairs} pairs of magnets: the survey takes \
             about {time} on {threads} threads; {fewer}, and the certificate ends after \
             --certify-seconds"
        ));
    }
}

/// Time (s) of one thread, from how long a few milestones and motions take.
fn seconds(problem: &Problem, survey: Survey, tiles: [&Tile; 2]) -> f64 {
    let settings = Settings {
        milestones: survey.milestones,
        ..Settings::default()
    };
    let roadmap = settings.roadmap(problem);
    let drawn = MilestoneSettings {
        count: SAMPLE,
        ..roadmap.milestones
    };
    let since = Instant::now();
    let some = milestone::milestones(problem, &drawn);
    let [milestone, motion] = if some.is_empty() {
        [0.0; 2]
    } else {
        let each = since.elapsed().as_secs_f64() / some.len() as f64;
        [each, of_a_motion(problem, &roadmap, &some)]
    };
    let since = Instant::now();
    problem.energy_and_gradient(&problem.flush_meetings()[0]);
    let energy = since.elapsed().as_secs_f64();

    let neighbours = roadmap.neighbours as f64;
    let states = if survey.states { states(tiles) } else { 0.0 };
    let milestones = survey.milestones as f64;
    let motions = FOR_A_NEIGHBOUR * milestones * neighbours + FOR_A_STATE * states;
    let far = FOR_A_FAR_START * survey.far_starts as f64;
    AFTER * (milestone * milestones + motion * motions + energy * far)
}

/// Mean time (s) of a free motion from one of some milestones.
fn of_a_motion(problem: &Problem, roadmap: &RoadmapSettings, some: &[Milestone]) -> f64 {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut draw = || rng.random_range(-1.0..1.0);
    let (mut time, mut count) = (0.0, 0);
    for here in some {
        for away in AWAY {
            let step = Vector3::new(draw(), draw(), draw() / problem.space.rho) * away;
            let there = here.configuration.moved(step);
            if !problem.is_free(&there) || !problem.motion_is_free(&here.configuration, &there) {
                continue;
            }
            let there = Milestone::new(problem, there);
            let since = Instant::now();
            Profile::new(problem, here, &there, &roadmap.edges.tolerance);
            time += since.elapsed().as_secs_f64();
            count += 1;
        }
    }
    time / f64::from(count.max(1))
}

/// How many states there are, within a factor of two: 144, 464, 368 and 1440 were found of squares
/// with 4, 16, 32 and 64 magnets a face, 1.3 times the magnets for each two faces.
fn states([fixed, moving]: [&Tile; 2]) -> f64 {
    let counts = |tile: &Tile| -> Vec<f64> {
        (0..tile.faces.len())
            .map(|face| tile.magnets.iter().filter(|m| m.face == face).count() as f64)
            .filter(|count| *count > 0.0)
            .collect()
    };
    let (first, second) = (counts(fixed), counts(moving));
    let sum = |a: &f64| {
        let of_two = second.iter().map(|b| 1.3 * (a * b).sqrt());
        of_two.sum::<f64>()
    };
    first.iter().map(sum).sum()
}
