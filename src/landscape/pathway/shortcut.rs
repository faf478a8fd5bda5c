//! Shortens pathways by cutting off detours.

use super::legs::OVERLAP;
use crate::constrained;
use crate::roadmap::profile::Profile;
use crate::roadmap::{Point, ProfileTolerance};
use tiles::configuration::Configuration;
use tiles::order::Order;
use tiles::parallel;
use tiles::problem::Problem;

/// Longest step (m, metric of the space) between two points from which a detour may be cut short.
const STEP: f64 = 0.02;
/// Number of passes over the points. A remaining kink is not the end of a shortcut.
const PASSES: usize = 2;
/// How often each point is pulled towards the midpoint of its neighbours.
const PULLS: usize = 2;
/// A point closer (m, metric of the space) to that midpoint is not moved.
const KINK: f64 = 1e-3;

/// Cost of a metre of path, as a fraction of the depth by which energies are measured: among paths
/// with equal work the shortest is taken.
const PER_METRE: f64 = 1e-3;
/// How closely energies along shortcuts are known, as a fraction of the depth.
const CLOSELY: f64 = 1e-5;

/// Maximum number of bypasses on one path, of its points that are considered for one, and of pairs
/// that are tried.
const BYPASSES: usize = 4;
const LOOKED_AT: usize = 32;
const TRIED: usize = 200;
/// A bypass is searched for if it may save the cost of this length of path (m).
const WORTHWHILE: f64 = 0.1;

/// Number of places of a motion that are evaluated, in this order, before it is followed.
const GLANCES: usize = 7;
const COARSE_FIRST: [usize; GLANCES] = [4, 2, 6, 1, 3, 5, 7];

/// Conditions for a shortcut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathLimits {
    /// Its highest energy (J).
    pub highest: f64,
    /// Cost of a metre of path (J).
    pub per_metre: f64,
    /// Accuracy of the energies along it (J).
    pub tolerance: f64,
}

impl PathLimits {
    /// Limits for paths of these tiles that stay at or below `highest` (J).
    pub fn below(highest: f64, problem: &Problem) -> Self {
        let depth = problem.depth();
        Self {
            highest,
            per_metre: PER_METRE * depth / problem.scaled(1.0),
            tolerance: CLOSELY * depth,
        }
    }
}

/// A polyline with the detours cut out that a direct motion can replace: one that is free, keeps
/// below the highest energy, and takes no more work, each metre counted as work too. The result is
/// pulled tight.
pub fn shortened(
    problem: &Problem,
    points: &[Configuration],
    limits: &PathLimits,
) -> Vec<Configuration> {
    let mut points = points.to_vec();
    if points.len() <= 2 {
        return points;
    }
    for _ in 0..PASSES {
        points = cut_short(problem, &subdivided(problem, &points), limits);
    }
    tighten(problem, &mut points, limits);
    points
}

/// Pulls a polyline tight like a rubber band: point by point towards the middle between its two
/// neighbours, out of overlap if needed, as long as that costs less.
fn tighten(problem: &Problem, points: &mut [Configuration], limits: &PathLimits) {
    let price = |way: [&Configuration; 3]| {
        let milestones = way.map(|q| Point::new(problem, *q));
        let [a, b, c] = &milestones;
        let halves = [[a, b], [b, c]].map(|ends| motion(problem, ends, limits));
        let peak = halves[0].0.max(halves[1].0);
        (peak <= limits.highest).then_some(halves[0].1 + halves[1].1)
    };
    for _ in 0..PULLS {
        for k in 1..points.len().saturating_sub(1) {
            let [before, here, after] = [points[k - 1], points[k], points[k + 1]];
            let middle = before.interpolate(&after, 0.5);
            let aside = problem.space.distance(&middle, &here);
            if aside < problem.scaled(KINK) {
                continue;
            }
            let Some(pulled) = constrained::settle(problem, &middle, aside) else {
                continue;
            };
            let is_free = is_free(problem, &before, &pulled) && is_free(problem, &pulled, &after);
            let cost = |q: &Configuration| price([&before, q, &after]);
            let (Some(new), Some(old)) = (is_free.then(|| cost(&pulled)).flatten(), cost(&here))
            else {
                continue;
            };
            if new < old - limits.tolerance {
                points[k] = pulled;
            }
        }
    }
}

/// Whether a straight motion overlaps no more than the legs of a pathway do.
fn is_free(problem: &Problem, from: &Configuration, to: &Configuration) -> bool {
    problem.motion_overlaps_at_most(from, to, problem.scaled(OVERLAP))
}

fn subdivided(problem: &Problem, points: &[Configuration]) -> Vec<Configuration> {
    let mut fine: Vec<Configuration> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let count = (problem.space.distance(&pair[0], &pair[1]) / problem.scaled(STEP)).ceil();
        let between = (1..count as usize).map(|k| pair[0].interpolate(&pair[1], k as f64 / count));
        fine.extend(between.chain([pair[1]]));
    }
    fine
}

/// A polyline with those dips and detours bypassed that cost more than a straight motion between
/// two points of it, the worst first: a route follows whole links of a network, down to a state and
/// up again, even if it could have changed from one to the other half-way.
pub fn bypassed(problem: &Problem, mut milestones: Vec<Point>, limits: &PathLimits) -> Vec<Point> {
    for _ in 0..BYPASSES {
        let Some((from, to)) = worst_detour(problem, &milestones, limits) else {
            break;
        };
        milestones.drain(from + 1..to);
    }
    milestones
}

/// The two points of a polyline between which a straight motion saves most, among those examined.
fn worst_detour(
    problem: &Problem,
    milestones: &[Point],
    limits: &PathLimits,
) -> Option<(usize, usize)> {
    let price = |from: usize, to: usize| {
        let [from, to] = [from, to].map(|k| &milestones[k]);
        let ends = [from, to].map(|end| &end.q);
        let length = problem.space.distance(ends[0], ends[1]);
        (to.energy - from.energy).max(0.0) + limits.per_metre * length
    };
    let mut prices = vec![0.0];
    for k in 1..milestones.len() {
        prices.push(prices[k - 1] + price(k - 1, k));
    }
    let stride = milestones.len().div_ceil(LOOKED_AT).max(1);
    let looked_at: Vec<usize> = (0..milestones.len()).step_by(stride).collect();
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (k, &from) in looked_at.iter().enumerate() {
        for &to in &looked_at[k + 1..] {
            // At best.
            let saved = prices[to] - prices[from] - price(from, to);
            if saved > problem.scaled(WORTHWHILE) * limits.per_metre {
                pairs.push((saved, from, to));
            }
        }
    }
    pairs.order_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let is_bypass = |&&(saved, from, to): &&(f64, usize, usize)| {
        let ends = [&milestones[from], &milestones[to]];
        let most = prices[to] - prices[from] - 0.5 * saved;
        is_motion_within(problem, ends, limits, most)
    };
    let found = pairs.iter().take(TRIED).find(is_bypass)?;
    Some((found.1, found.2))
}

/// From each point the farthest is tried first, then the one half as far along, and so on.
fn cut_short(
    problem: &Problem,
    points: &[Configuration],
    limits: &PathLimits,
) -> Vec<Configuration> {
    let milestones = parallel::map(points, |q| Point::new(problem, *q));
    let pairs: Vec<&[Point]> = milestones.windows(2).collect();
    let steps = parallel::map(&pairs, |pair| {
        motion(problem, [&pair[0], &pair[1]], limits).1
    });
    let mut prices = vec![0.0];
    for (k, step) in steps.into_iter().enumerate() {
        prices.push(prices[k] + step);
    }
    let is_better = |from: usize, to: usize| {
        let ends = [&milestones[from], &milestones[to]];
        let most = prices[to] - prices[from] + limits.tolerance;
        is_motion_within(problem, ends, limits, most)
    };
    let mut kept: Vec<Configuration> = points.first().copied().into_iter().collect();
    let mut here = 0;
    while here + 1 < points.len() {
        let mut ahead = points.len() - 1 - here;
        while ahead > 1 && !is_better(here, here + ahead) {
            ahead /= 2;
        }
        here += ahead;
        kept.push(points[here]);
    }
    kept
}

/// Whether a straight motion is free, keeps to the limits and costs no more than `most` (J). A few
/// places of it are checked first: on a rough landscape most motions fail there.
fn is_motion_within(problem: &Problem, ends: [&Point; 2], limits: &PathLimits, most: f64) -> bool {
    let [a, b] = ends.map(|end| &end.q);
    let mut energies = [0.0; GLANCES];
    for k in COARSE_FIRST {
        let q = a.interpolate(b, k as f64 / (GLANCES + 1) as f64);
        energies[k - 1] = problem.energy(&q);
        if energies[k - 1] > limits.highest {
            return false;
        }
    }
    let mut at_least = limits.per_metre * problem.space.distance(a, b);
    let mut last = ends[0].energy;
    for energy in energies.into_iter().chain([ends[1].energy]) {
        at_least += (energy - last).max(0.0);
        last = energy;
    }
    at_least <= most && is_free(problem, a, b) && {
        let (peak, price) = motion(problem, ends, limits);
        peak <= limits.highest && price <= most
    }
}

/// The highest energy (J) on a straight motion, and what it costs (J).
fn motion(problem: &Problem, [a, b]: [&Point; 2], limits: &PathLimits) -> (f64, f64) {
    let tolerance = ProfileTolerance {
        relative: 0.0,
        absolute: limits.tolerance,
    };
    let profile = Profile::new(problem, a, b, &tolerance);
    let length = problem.space.distance(&a.q, &b.q);
    (
        profile.peak().energy,
        profile.work()[0] + limits.per_metre * length,
    )
}
