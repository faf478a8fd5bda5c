//! Straight ways that sampled milestones are unlikely to find: out of states that the roadmap does
//! not reach, and from state to state.

use std::collections::BTreeSet;

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use super::copies::distinct;
use super::{Exploration, FoundState};
use crate::constrained;
use crate::roadmap::neighbour::NeighbourSearch;
use crate::roadmap::{EdgeCosts, Point, edge};
use tiles::configuration::{Configuration, ConfigurationSpace};
use tiles::parallel;
use tiles::problem::Problem;

/// Number of neighbouring states that a state is joined to by straight motions, and the largest
/// distance (m, metric of the space).
const MOST_OTHERS: usize = 4;
const FARTHEST: f64 = 0.05;
/// Number of milestones that the end of a withdrawal is joined to.
const MOST_MILESTONES: usize = 6;
/// Contacts within this distance (m) count as closed.
const CLOSED: f64 = 1e-6;

impl Exploration<'_> {
    /// Joins the states from `fresh` on to the closest states by straight motions, where these are
    /// free: a passage without play beside a state may lead to a lower one.
    pub(super) fn join_neighbours(&mut self, fresh: usize) {
        let problem = self.problem;
        let at = |state: usize| self.states[state].minimum.point.q;
        let pairs: BTreeSet<[usize; 2]> = self
            .firsts()
            .flat_map(|one| {
                let others = (0..self.states.len())
                    .filter(move |other| *other != one && one.max(*other) >= fresh);
                let far = others.map(|other| {
                    let far = problem.space.distance(&at(one), &at(other));
                    (OrderedFloat(far), other)
                });
                let mut near: Vec<_> = far
                    .filter(|(far, _)| far.0 <= problem.scaled(FARTHEST))
                    .collect();
                near.sort_unstable();
                near.into_iter()
                    .take(MOST_OTHERS)
                    .map(move |(_, other)| [one.min(other), one.max(other)])
            })
            .collect();
        let pairs: Vec<[usize; 2]> = pairs.into_iter().collect();
        let found: Vec<([usize; 2], EdgeCosts)> = parallel::flat_map(&pairs, |&pair| {
            let [from, to] = pair.map(at);
            let ends = [from, to].map(|q| Point::new(problem, q));
            let weighed = || edge::costs(problem, ends.each_ref(), &self.settings.edge);
            let is_free = problem.motion_is_free(&from, &to);
            is_free.then(|| (pair, weighed()))
        });
        for (pair, costs) in found {
            let nodes = pair.map(|state| self.states[state].node);
            self.add_motion_and_images(nodes, costs);
        }
    }

    /// Joins states to `free` by straight motions away from what they touch, where nothing else
    /// does; for very many magnets, where nothing joined them to milestones, all states from
    /// `fresh` on. Shapes that fit without play leave a tile a single direction, which sampled
    /// milestones cannot meet.
    pub(super) fn withdraw(&mut self, fresh: usize) {
        let problem = self.problem;
        let joined = self.network.joined_to(self.free);
        let is_open = |state: &&FoundState| {
            problem.is_expensive() && state.class >= fresh || !joined[state.node]
        };
        let open: BTreeSet<usize> = self
            .states
            .iter()
            .filter(is_open)
            .map(|state| state.class)
            .collect();
        let ways: Vec<(usize, Vec<(Point, EdgeCosts)>)> =
            parallel::map(&Vec::from_iter(open), |&first| {
                (first, self.ways_out(first))
            });
        let known = self.network.nodes.len();
        for (first, ways) in ways {
            let node = self.states[first].node;
            let here = self.states[first].minimum.point.q;
            let copies = distinct(problem, &problem.symmetries, &here);
            for (far, costs) in ways {
                let end = self.network.add_node(Some((far.q, far.energy)));
                let out = self.network.add_motion(node, end, costs);
                let same = self.network.add_same(end, self.free, far.energy);
                let route = vec![(out, true), (same, true)];
                for symmetry in &copies[1..] {
                    let copy = self.image_node(node, symmetry);
                    self.add_image(copy, &route, symmetry);
                }
            }
        }
        self.join_to_milestones(known);
    }

    /// Joins the nodes from `fresh` on to their nearest milestones, so that the end of one
    /// withdrawal connects to other paths.
    fn join_to_milestones(&mut self, fresh: usize) {
        let problem = self.problem;
        let at = |node: usize| self.network.nodes[node].map(|known| known.0);
        let milestones = (0..self.free).filter_map(|other| Some((other, at(other)?)));
        let (numbers, places): (Vec<usize>, Vec<Configuration>) = milestones.unzip();
        let search = NeighbourSearch::new(&places, &problem.space);
        let nearest = |here: Configuration| {
            let near = search.by_distance(here).map(|place| numbers[place]);
            near.filter(move |&other| at(other).is_some_and(|q| problem.motion_is_free(&here, &q)))
                .take(MOST_MILESTONES)
        };
        let joined: Vec<[usize; 2]> = parallel::flat_map(fresh..self.network.nodes.len(), |node| {
            let near = at(node).into_iter().flat_map(nearest);
            near.map(move |other| [node, other])
        });
        for [node, other] in joined {
            self.network.add_untried(node, other);
        }
    }

    /// Straight motions from a state away from what it touches to where the tiles are far apart.
    fn ways_out(&self, state: usize) -> Vec<(Point, EdgeCosts)> {
        let problem = self.problem;
        let here = self.states[state].minimum.point.q;
        let from = Point::new(problem, here);
        let ends = directions(problem, &here)
            .into_iter()
            .filter_map(|direction| farthest(&problem.space, &here, direction));
        let free = ends.filter(|far| problem.motion_is_free(&here, far));
        free.map(|far| {
            let to = Point::new(problem, far);
            let costs = edge::costs(problem, [&from, &to], &self.settings.edge);
            (to, costs)
        })
        .collect()
    }
}

/// Away from each closed contact, and from all of them together.
fn directions(problem: &Problem, q: &Configuration) -> Vec<Vector2<f64>> {
    let mut normals: Vec<Vector2<f64>> = Vec::new();
    for constraint in constrained::constraints(problem, q, problem.scaled(CLOSED)) {
        let normal = constraint.gradient.xy().normalize();
        let is_same = |known: &Vector2<f64>| (known - normal).norm() < 1e-6;
        if !normals.iter().any(is_same) {
            normals.push(normal);
        }
    }
    let sum: Vector2<f64> = normals.iter().sum();
    normals.extend(sum.try_normalize(1e-6));
    normals.retain(|normal| normal.iter().all(|x| x.is_finite()));
    normals
}

/// The first far configuration in a direction; `None` if it is not on the table.
fn farthest(
    space: &ConfigurationSpace,
    q: &Configuration,
    direction: Vector2<f64>,
) -> Option<Configuration> {
    let p = q.position();
    let along = p.dot(&direction);
    let beside = p.norm_squared() - along * along;
    let radius = space.free_distance * (1.0 + 1e-9);
    let length = (radius * radius - beside).sqrt() - along;
    let end = p + direction * length;
    let far = Configuration::new(end.x, end.y, q.theta);
    (length > 0.0 && space.contains(&far) && space.is_far(&far)).then_some(far)
}
