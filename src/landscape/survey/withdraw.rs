//! Straight ways that sampled milestones cannot meet: out of states that the roadmap does not reach,
//! and from state to state.

use std::collections::BTreeSet;

use nalgebra::Vector2;
use ordered_float::OrderedFloat;
use rayon::prelude::*;

use super::{FoundState, Survey, SurveySettings};
use crate::configuration::{Configuration, ConfigurationSpace};
use crate::landscape::constrained;
use crate::problem::Problem;
use crate::roadmap::{EdgeCosts, Milestone, edge};

/// Straight ways lead from a state to so many others no farther away than this (m, metric of the
/// space).
const MOST_OTHERS: usize = 4;
const FARTHEST: f64 = 0.05;
/// Contacts within this distance (m) count as closed.
const CLOSED: f64 = 1e-6;

impl Survey {
    /// Joins states, those from `fresh` on and others, to those closest to them where a straight motion is free: a passage without play
    /// beside a state may lead on to a lower one.
    pub(super) fn join_neighbours(
        &mut self,
        problem: &Problem,
        fresh: usize,
        settings: &SurveySettings,
    ) {
        let at = |state: &FoundState| state.minimum.point.q;
        let pairs: Vec<[usize; 2]> = (0..self.states.len())
            .flat_map(|one| {
                let here = at(&self.states[one]);
                let others = (0..self.states.len())
                    .filter(move |other| *other != one && one.max(*other) >= fresh);
                let far = others.map(|other| {
                    let there = at(&self.states[other]);
                    (OrderedFloat(problem.space.distance(&here, &there)), other)
                });
                let mut near: Vec<_> = far.filter(|(far, _)| far.0 <= FARTHEST).collect();
                near.sort_unstable();
                near.into_iter()
                    .take(MOST_OTHERS)
                    .map(move |(_, other)| [one.min(other), one.max(other)])
            })
            .collect::<BTreeSet<_>>()
            .into_iter()
            .collect();
        let found: Vec<Option<EdgeCosts>> = pairs
            .par_iter()
            .map(|pair| {
                let [from, to] = pair.map(|state| at(&self.states[state]));
                let ends = [from, to].map(|q| Milestone::new(problem, q));
                problem
                    .motion_is_free(&from, &to)
                    .then(|| edge::costs(problem, [&ends[0], &ends[1]], &settings.edge))
            })
            .collect();
        for (pair, costs) in pairs.into_iter().zip(found) {
            if let Some(costs) = costs {
                let [from, to] = pair.map(|state| self.states[state].node);
                self.network.add_motion(from, to, costs);
            }
        }
    }

    /// Joins states to `free` by straight motions away from what they touch, where nothing else
    /// does. Shapes that fit without play leave a tile a single direction, which sampled milestones
    /// cannot meet.
    pub(super) fn withdraw(&mut self, problem: &Problem, settings: &SurveySettings) {
        let joined = self.network.joined_to(self.free);
        for state in 0..self.states.len() {
            let node = self.states[state].node;
            if joined[node] {
                continue;
            }
            let here = self.states[state].minimum.point.q;
            let from = Milestone::new(problem, here);
            for direction in directions(problem, &here) {
                let Some(far) = farthest(&problem.space, &here, direction) else {
                    continue;
                };
                if !problem.motion_is_free(&here, &far) {
                    continue;
                }
                let to = Milestone::new(problem, far);
                let costs = edge::costs(problem, [&from, &to], &settings.edge);
                let end = self.network.add_node(Some((far, to.energy)));
                self.network.add_motion(node, end, costs);
                self.network.add_same(end, self.free, to.energy);
            }
        }
    }
}

/// Away from each closed contact, and from all of them together.
fn directions(problem: &Problem, q: &Configuration) -> Vec<Vector2<f64>> {
    let mut normals: Vec<Vector2<f64>> = Vec::new();
    for constraint in constrained::constraints(problem, q, CLOSED) {
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

/// The first far configuration in a direction; `None` where it is not on the table.
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
