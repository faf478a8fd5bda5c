//! Pathways: a route through the network as a fine sequence of configurations.

use std::collections::HashSet;

use super::constrained;
use super::network::{Cost, Network, Route, Way};
use super::results::{Pathway, PathwayPoint};
use crate::configuration::{Configuration, ConfigurationSpace};
use crate::problem::Problem;
use crate::roadmap::profile::Profile;
use crate::roadmap::{Milestone, ProfileTolerance};

/// Longest step of a pathway (m, metric of the space).
const LONGEST_STEP: f64 = 5e-3;
/// Shortest step that is halved because the energy bends (m).
const SHORTEST_STEP: f64 = 2e-4;
/// A middle that had to settle farther than this from either end, as a share of the step, is no
/// middle: halving would not end.
const LONGEST_HALF: f64 = 0.8;
/// Descents into one minimum end this close to each other (m, metric of the space).
const SAME: f64 = 1e-7;

/// The best way between two nodes.
#[derive(Clone, Debug)]
pub struct Lowest {
    /// The node that it reaches.
    pub end: usize,
    /// From the first node to the one it reaches; never empty. Where detours could be cut short, it
    /// may lie below what the network holds.
    pub pathway: Pathway,
}

/// The minimax pathway from a node to the nearest of the `goals`: of those with the least possible
/// highest energy the one with the least work to one of the `ends`, each metre counted as a
/// hundredth of `depth` (J). Steps are halved until the energy between two points is linear to
/// within `bend` (J).
pub fn lowest(
    problem: &Problem,
    network: &Network,
    from: usize,
    [goals, ends]: [&HashSet<usize>; 2],
    [depth, bend]: [f64; 2],
) -> Option<Lowest> {
    let highest = network.minimax(from, goals)? + 1e-12 * depth;
    let cost = Cost::Below {
        highest,
        per_metre: 0.01 * depth,
    };
    let (end, _, route) = network.cheapest(from, ends, cost)?;
    let pathway = along(problem, network, &route, highest, bend);
    (!pathway.is_empty()).then_some(Lowest { end, pathway })
}

/// A pathway gone backwards.
pub fn reversed(pathway: &Pathway) -> Pathway {
    let length = pathway.last().map_or(0.0, |last| last.s);
    let back = |point: &PathwayPoint| PathwayPoint {
        s: length - point.s,
        ..*point
    };
    pathway.iter().rev().map(back).collect()
}

/// Two pathways, one after the other; `None` where the second does not begin where the first one
/// ends. An empty first one may end anywhere.
pub fn joined(space: &ConfigurationSpace, mut first: Pathway, second: Pathway) -> Option<Pathway> {
    let (Some(end), Some(start)) = (first.last().copied(), second.first()) else {
        return Some(if first.is_empty() { second } else { first });
    };
    if space.distance(&end.configuration, &start.configuration) > SAME {
        return None;
    }
    let rest = second.into_iter().skip(1);
    first.extend(rest.map(|point| PathwayPoint {
        s: end.s + point.s,
        ..point
    }));
    Some(first)
}

/// The pathway along a route. Stretches of straight motions are cut short where the direct motion
/// is free and stays below `highest` (J); steps are halved until the energy between two points is
/// linear to within `bend` (J).
pub fn along(
    problem: &Problem,
    network: &Network,
    route: &Route,
    highest: f64,
    bend: f64,
) -> Pathway {
    let mut all: Vec<Configuration> = Vec::new();
    for stretch in stretches(network, route) {
        let points = match stretch {
            Stretch::Straight(points) => shortened(problem, &points, highest, 1e-3 * highest.abs()),
            Stretch::Way(points) => points,
        };
        let repeated = usize::from(!all.is_empty() && all.last() == points.first());
        all.extend(points.into_iter().skip(repeated));
    }
    of_configurations(problem, &all, bend)
}

/// The pathway through a sequence of configurations.
pub fn of_configurations(problem: &Problem, all: &[Configuration], bend: f64) -> Pathway {
    let mut pathway: Pathway = Vec::new();
    let Some(first) = all.first() else {
        return pathway;
    };
    let mut energy = problem.energy(first);
    push(problem, &mut pathway, *first, energy);
    for pair in all.windows(2) {
        let next = problem.energy(&pair[1]);
        refine(
            problem,
            &mut pathway,
            (pair[0], energy),
            (pair[1], next),
            bend,
        );
        energy = next;
    }
    pathway
}

fn refine(
    problem: &Problem,
    pathway: &mut Pathway,
    a: (Configuration, f64),
    b: (Configuration, f64),
    bend: f64,
) {
    let length = problem.space.distance(&a.0, &b.0);
    if length > SHORTEST_STEP {
        let straight = a.0.interpolate(&b.0, 0.5);
        let settled = constrained::settle(problem, &straight, length).filter(|middle| {
            let halves = [&a.0, &b.0].map(|end| problem.space.distance(end, middle));
            halves.iter().all(|half| *half <= LONGEST_HALF * length)
        });
        if let Some(middle) = settled {
            let energy = problem.energy(&middle);
            let bent = (energy - (a.1 + b.1) / 2.0).abs() > bend;
            if bent || length > LONGEST_STEP {
                refine(problem, pathway, a, (middle, energy), bend);
                refine(problem, pathway, (middle, energy), b, bend);
                return;
            }
        }
    }
    push(problem, pathway, b.0, b.1);
}

fn push(problem: &Problem, pathway: &mut Pathway, configuration: Configuration, energy: f64) {
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

enum Stretch {
    Straight(Vec<Configuration>),
    Way(Vec<Configuration>),
}

/// A route's links, neighbouring straight motions taken together.
fn stretches(network: &Network, route: &Route) -> Vec<Stretch> {
    let mut all: Vec<Stretch> = Vec::new();
    for &(number, forwards) in route {
        let link = &network.links[number];
        let mut ends = [link.from, link.to];
        if !forwards {
            ends.reverse();
        }
        match network.way(number) {
            Way::Same => {}
            Way::Points(points) => {
                let mut way: Vec<Configuration> = points.iter().map(|p| p.q).collect();
                if !forwards {
                    way.reverse();
                }
                all.push(Stretch::Way(way));
            }
            Way::Straight => {
                let ends = ends.map(|node| network.nodes[node as usize].map(|n| n.0));
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

/// A polyline with the detours cut out that a direct motion below `highest` (J) can replace, as its
/// profile tells to within `tolerance` (J): from each point the farthest of those is tried first,
/// then those half as far along, and so on.
pub fn shortened(
    problem: &Problem,
    points: &[Configuration],
    highest: f64,
    tolerance: f64,
) -> Vec<Configuration> {
    let milestones: Vec<Milestone> = points.iter().map(|q| Milestone::new(problem, *q)).collect();
    let tolerance = ProfileTolerance {
        relative: 0.0,
        absolute: tolerance,
    };
    let direct = |a: &Milestone, b: &Milestone| {
        problem.motion_is_free(&a.configuration, &b.configuration)
            && Profile::new(problem, a, b, &tolerance).peak().energy <= highest
    };
    let mut kept: Vec<Configuration> = points.first().copied().into_iter().collect();
    let mut here = 0;
    while here + 1 < points.len() {
        let mut ahead = points.len() - 1 - here;
        while ahead > 1 && !direct(&milestones[here], &milestones[here + ahead]) {
            ahead /= 2;
        }
        here += ahead;
        kept.push(points[here]);
    }
    kept
}
