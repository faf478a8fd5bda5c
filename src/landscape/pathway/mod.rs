//! Pathways: sequences of configurations through the network, joined by straight motions that are
//! proved free.

mod legs;
mod shortcut;

use std::collections::HashSet;

use super::results::{Pathway, PathwayPoint, highest_point};
use super::transition_network::{Cost, Network, Route};
use crate::roadmap::Point;
use tiles::configuration::{Configuration, ConfigurationSpace};

pub use legs::of_configurations;
use legs::of_milestones;
use shortcut::bypassed;
pub use shortcut::{PathLimits, shortened};

/// Descents into one minimum end this close to each other (metric of the space, in radii of
/// gyration).
const SAME: f64 = 5e-7;

/// How much higher a path to `free` may rise than the lowest one, as a fraction of the barrier and
/// not above 0: far configurations are all free, but their energies differ a little.
pub(super) const AMONG_FAR: f64 = 0.01;

/// A pathway with shortcuts that rises higher by this fraction of the depth than the network holds
/// is not accepted without a check.
const HIGHER: f64 = 1e-7;

/// The minimax pathway from a node to the nearest of the `goals`: among those with the lowest
/// maximum energy the one with the least work to one of the `ends`, and among those the shortest.
/// Steps are halved until the energy between two points is linear to within `bend` (J); energies
/// are measured by `depth` (J). Returns the node that it reaches and the pathway, which is never
/// empty; if detours could be cut short, it may lie below the paths of the network.
pub fn lowest(
    network: &Network,
    from: usize,
    [goals, ends]: [&HashSet<usize>; 2],
    [depth, bend]: [f64; 2],
) -> Option<(usize, Pathway)> {
    let limits = PathLimits::below(highest(network, from, goals, depth)?, network.problem);
    let cost = Cost::Below {
        highest: limits.highest,
        per_metre: limits.per_metre,
    };
    let (end, _, route) = network.cheapest(from, ends, cost)?;
    let peak = |way: &Pathway| highest_point(way).map_or(f64::INFINITY, |point| point.energy);
    let mut pathway = along(network, &route, Some(&limits), bend);
    if peak(&pathway) > limits.highest + HIGHER * depth {
        let plain = along(network, &route, None, bend);
        pathway = [pathway, plain]
            .into_iter()
            .min_by(|a, b| peak(a).total_cmp(&peak(b)))?;
    }
    (!pathway.is_empty()).then_some((end, pathway))
}

/// The highest energy (J) allowed on a path from a node to the nearest of the `goals`: the minimax
/// energy, apart from rounding.
fn highest(network: &Network, from: usize, goals: &HashSet<usize>, depth: f64) -> Option<f64> {
    let least = network.minimax(from, goals)?;
    let rounding = 1e-12 * depth;
    let is_free = |node: &usize| network.nodes[*node].is_none();
    if !goals.iter().all(is_free) || least >= 0.0 {
        return Some(least + rounding);
    }
    let start = network.nodes[from].map_or(0.0, |node| node.1);
    Some((least + rounding.max(AMONG_FAR * (least - start))).min(0.0))
}

/// A pathway in reverse.
pub fn reversed(pathway: &Pathway) -> Pathway {
    let length = pathway.last().map_or(0.0, |last| last.s);
    let back = |point: &PathwayPoint| PathwayPoint {
        s: length - point.s,
        ..*point
    };
    pathway.iter().rev().map(back).collect()
}

/// Two pathways, one after the other; `None` if the second does not begin where the first one ends.
/// An empty first one may end anywhere.
pub fn joined(space: &ConfigurationSpace, mut first: Pathway, second: Pathway) -> Option<Pathway> {
    let (Some(end), Some(start)) = (first.last().copied(), second.first()) else {
        return Some(if first.is_empty() { second } else { first });
    };
    if space.distance(&end.configuration, &start.configuration) > SAME * space.rho {
        return None;
    }
    let rest = second.into_iter().skip(1);
    first.extend(rest.map(|point| PathwayPoint {
        s: end.s + point.s,
        ..point
    }));
    Some(first)
}

/// The pathway along a route. Stretches of straight motions are cut short within the limits; steps
/// are halved until the energy between two points is linear to within `bend` (J).
pub fn along(network: &Network, route: &Route, limits: Option<&PathLimits>, bend: f64) -> Pathway {
    let problem = network.problem;
    let mut all: Vec<Point> = Vec::new();
    for stretch in stretches(network, route) {
        let points = match stretch {
            Stretch::Way(points) => points,
            Stretch::Straight(points) => {
                let shorter = limits.map(|limits| shortened(problem, &points, limits));
                let points = shorter.unwrap_or(points).into_iter();
                points.map(|q| Point::new(problem, q)).collect()
            }
        };
        let ends = [all.last(), points.first()].map(|end| end.map(|it| it.q));
        let repeated = usize::from(!all.is_empty() && ends[0] == ends[1]);
        all.extend(points.into_iter().skip(repeated));
    }
    extend_to_ends(network, route, &mut all);
    if let Some(limits) = limits {
        all = bypassed(problem, all, limits);
    }
    of_milestones(problem, &all, bend)
}

/// Adds the nodes at a route's ends where ways end beside them: descents into a minimum end somewhere
/// near it if it is flat.
fn extend_to_ends(network: &Network, route: &Route, all: &mut Vec<Point>) {
    let problem = network.problem;
    let [Some(first), Some(last)] = [route.first(), route.last()] else {
        return;
    };
    let [[start, _], [_, end]] = [first, last].map(|link| network.ends_along(*link));
    let beside = |node: usize, point: Option<&Point>| {
        let (q, _) = network.nodes[node]?;
        let far = SAME * problem.space.rho;
        let is_apart = problem.space.distance(&q, &point?.q) > far;
        is_apart.then(|| Point::new(problem, q))
    };
    if let Some(start) = beside(start, all.first()) {
        all.insert(0, start);
    }
    all.extend(beside(end, all.last()));
}

enum Stretch {
    Straight(Vec<Configuration>),
    /// A path along which the energy is known.
    Way(Vec<Point>),
}

/// A route's links, neighbouring straight motions taken together.
fn stretches(network: &Network, route: &Route) -> Vec<Stretch> {
    let mut all: Vec<Stretch> = Vec::new();
    for &(number, forwards) in route {
        match network.way(number) {
            Some(points) => {
                let mut way = points.to_vec();
                if !forwards {
                    way.reverse();
                }
                all.push(Stretch::Way(way));
            }
            None => {
                let ends = network
                    .ends_along((number, forwards))
                    .map(|node| network.nodes[node].map(|n| n.0));
                let [Some(a), Some(b)] = ends else { continue };
                match all.last_mut() {
                    Some(Stretch::Straight(points)) => points.push(b),
                    _ => all.push(Stretch::Straight(vec![a, b])),
                }
            }
        }
    }
    all
}
