//! The legs of a pathway: straight motions between its points (linear in x, y and theta, theta the
//! shorter way round). The pathway *is* these motions, not a curve sampled at its points: each leg
//! is proved free, and its highest point is one of the pathway's points.

use crate::constrained;
use crate::results::{Pathway, PathwayPoint};
use crate::roadmap::knot::Knot;
use crate::roadmap::profile::Profile;
use crate::roadmap::{Point, ProfileTolerance};
use tiles::configuration::Configuration;
use tiles::parallel;
use tiles::problem::Problem;

/// Overlap (m) allowed between two points that touch, because a straight motion between them cuts
/// into a surface that the tiles turn on. The overlap between two such points exceeds this by at
/// most a tenth of a micrometre.
pub(super) const OVERLAP: f64 = 4e-7;
/// Longest leg (m, metric of the space).
const LONGEST: f64 = 5e-3;
/// Shortest leg that is halved because the energy bends (m).
const SHORTEST: f64 = 2e-4;
/// A midpoint that settled farther than this from either end, as a fraction of the leg, is
/// rejected, because halving would not end.
const LONGEST_HALF: f64 = 0.8;
/// A leg is halved at most this often until it is free.
const DEEPEST: u32 = 16;
/// A leg is divided at most this often at summits that have to be pushed out of overlap.
const PUSHED: u32 = 5;
/// How closely the energy is followed along a leg, as a fraction of `bend`.
const CLOSELY: f64 = 1e-3;
/// The same for very many magnets, as a fraction of the bond's depth.
const DEARLY: f64 = 1e-5;
/// A dip that is less deep than this fraction of `bend` is left out: where tiles turn in contact
/// each leg has one, as it cuts into the surface.
const SHALLOW: f64 = 0.05;
/// Steps towards a summit.
const CLIMBS: usize = 12;

/// The pathway through a sequence of configurations; steps are halved until the energy between two
/// points is linear to within `bend` (J). Empty where a motion between two of them cannot be made
/// free by bending it round the tiles.
pub fn of_configurations(problem: &Problem, all: &[Configuration], bend: f64) -> Pathway {
    let all: Vec<Point> = all.iter().map(|q| Point::new(problem, *q)).collect();
    of_milestones(problem, &all, bend)
}

/// The same where the energies are known.
pub(super) fn of_milestones(problem: &Problem, all: &[Point], bend: f64) -> Pathway {
    let corners = free_polyline(problem, all).unwrap_or_default();
    let first = corners.first().map(|first| (first.q, first.energy));
    let ends: Vec<&[Point]> = corners.windows(2).collect();
    let legs = parallel::flat_map(&ends, |ends| {
        let mut leg = Vec::new();
        add_leg(problem, &mut leg, [&ends[0], &ends[1]], bend, PUSHED);
        leg
    });
    let mut pathway = Pathway::new();
    for (configuration, energy) in first.into_iter().chain(legs) {
        let s = pathway.last().map_or(0.0, |last| {
            last.s + problem.space.distance(&last.configuration, &configuration)
        });
        pathway.push(PathwayPoint {
            s,
            configuration,
            energy,
            clearance: problem.clearance(&configuration),
        });
    }
    pathway
}

/// A polyline through the configurations, with more points where needed for each straight motion to
/// be free; `None` if halving does not achieve this.
fn free_polyline(problem: &Problem, all: &[Point]) -> Option<Vec<Point>> {
    let mut corners: Vec<Point> = all.first().copied().into_iter().collect();
    for next in all.iter().skip(1) {
        join(problem, &mut corners, next, DEEPEST)?;
    }
    Some(corners)
}

/// Appends a free path from the last corner to `to`, with its midpoint pushed out of overlap if
/// needed.
fn join(problem: &Problem, corners: &mut Vec<Point>, to: &Point, depth: u32) -> Option<()> {
    let ends = [&corners.last()?.q, &to.q];
    if problem.motion_overlaps_at_most(ends[0], ends[1], problem.scaled(OVERLAP)) {
        corners.push(*to);
        return Some(());
    }
    let middle = middle(problem, ends[0], ends[1]).filter(|_| depth > 0)?;
    let middle = Point::new(problem, middle);
    join(problem, corners, &middle, depth - 1)?;
    join(problem, corners, to, depth - 1)
}

/// The approximate midpoint of a motion, pushed out of overlap. The allowed distance starts at the
/// depth of the overlap and grows step by step: with a larger distance, edges farther away count,
/// and a corner pushed back over one of its edges is pushed over the other as well.
fn middle(problem: &Problem, from: &Configuration, to: &Configuration) -> Option<Configuration> {
    let length = problem.space.distance(from, to);
    let settled = |share: f64| {
        let straight = from.interpolate(to, share);
        let overlap = (-problem.clearance(&straight)).max(problem.scaled(OVERLAP));
        let sizes = [2.0, 8.0, 64.0].map(|times| times * overlap);
        let sizes = sizes.into_iter().filter(|size| *size < length);
        sizes.chain([length]).find_map(|size| {
            let middle = constrained::settle(problem, &straight, size)?;
            let parts = [from, to].map(|end| problem.space.distance(end, &middle));
            let is_between = parts.iter().all(|part| *part <= LONGEST_HALF * length);
            is_between.then_some(middle)
        })
    };
    [0.5, 0.4, 0.6, 0.3, 0.7].into_iter().find_map(settled)
}

/// Appends a free leg: its end, its summits and dips, and points between them where it is long or its
/// energy bends.
fn add_leg(problem: &Problem, pathway: &mut Vec<At>, [a, b]: [&Point; 2], bend: f64, depth: u32) {
    let leg = Leg {
        problem,
        from: a.q,
        to: b.q,
        bend,
    };
    let tolerance = ProfileTolerance {
        relative: 0.0,
        absolute: closeness(problem, bend),
    };
    let knots = Profile::new(problem, a, b, &tolerance).knots;
    let mut last = (a.q, a.energy);
    for three in knots.windows(3) {
        let Some((t, energy)) = leg.extreme([&three[0], &three[1], &three[2]]) else {
            continue;
        };
        let straight = leg.at(t);
        if problem.is_clear(&straight) {
            leg.refine(pathway, last, (straight, energy));
            last = (straight, energy);
        } else if let Some(pushed) = leg.pushed_out(&last.0, &straight).filter(|_| depth > 0) {
            let from = Point::new(problem, last.0);
            let pushed = Point::new(problem, pushed);
            add_leg(problem, pathway, [&from, &pushed], bend, depth - 1);
            add_leg(problem, pathway, [&pushed, b], bend, depth - 1);
            return;
        }
    }
    leg.refine(pathway, last, (b.q, b.energy));
}

/// How closely (J) the energy is followed along a leg; for very many magnets as closely as along
/// the motions of a roadmap.
fn closeness(problem: &Problem, bend: f64) -> f64 {
    let closely = CLOSELY * bend;
    if problem.is_expensive() {
        closely.max(DEARLY * problem.depth())
    } else {
        closely
    }
}

/// A straight motion that is free.
struct Leg<'a> {
    problem: &'a Problem,
    from: Configuration,
    to: Configuration,
    bend: f64,
}

/// A point of a path, with its energy (J).
type At = (Configuration, f64);

impl Leg<'_> {
    fn at(&self, t: f64) -> Configuration {
        self.from.interpolate(&self.to, t)
    }

    /// A configuration of the leg pushed out of overlap, where the motions to it from `before` and on
    /// to the end are proved free.
    fn pushed_out(&self, before: &Configuration, q: &Configuration) -> Option<Configuration> {
        let pushed = constrained::settle(self.problem, q, 4.0 * self.problem.scaled(OVERLAP))?;
        let is_free = |end| {
            self.problem
                .motion_overlaps_at_most(end, &pushed, self.problem.scaled(OVERLAP))
        };
        [before, &self.to]
            .into_iter()
            .all(is_free)
            .then_some(pushed)
    }

    /// The middle one of three knots if it is a summit, or a dip that counts: the share of the leg
    /// behind it, and the energy (J).
    fn extreme(&self, [before, here, after]: [&Knot; 3]) -> Option<(f64, f64)> {
        let rises = [here.energy - before.energy, here.energy - after.energy];
        if rises.iter().all(|rise| *rise > 0.0) {
            return Some(self.summit([before.t, here.t, after.t]));
        }
        let is_dip = rises.iter().all(|rise| *rise < -SHALLOW * self.bend);
        is_dip.then(|| (here.t, self.problem.energy(&self.at(here.t))))
    }

    /// The highest point between the outer two of three shares of the leg, the middle one being
    /// higher than both: by halving the stretch in which the energy ceases to rise.
    fn summit(&self, [mut low, mut t, mut high]: [f64; 3]) -> (f64, f64) {
        let step = self.from.step_to(&self.to);
        let mut best = (t, f64::NEG_INFINITY);
        for _ in 0..CLIMBS {
            let (energy, gradient) = self.problem.energy_and_gradient(&self.at(t));
            if energy > best.1 {
                best = (t, energy);
            }
            let slope = gradient.dot(&step);
            *(if slope > 0.0 { &mut low } else { &mut high }) = t;
            t = (low + high) / 2.0;
        }
        best
    }

    /// Appends the points after `a` up to `b`, both on the leg, close enough for the energy to be
    /// nearly linear between them.
    fn refine(&self, pathway: &mut Vec<At>, a: At, b: At) {
        let length = self.problem.space.distance(&a.0, &b.0);
        if length > self.problem.scaled(SHORTEST) {
            let middle = a.0.interpolate(&b.0, 0.5);
            let energy = self.problem.energy(&middle);
            let is_bent = (energy - (a.1 + b.1) / 2.0).abs() > self.bend;
            if (is_bent || length > self.problem.scaled(LONGEST)) && self.problem.is_clear(&middle)
            {
                self.refine(pathway, a, (middle, energy));
                self.refine(pathway, (middle, energy), b);
                return;
            }
        }
        pathway.push(b);
    }
}
