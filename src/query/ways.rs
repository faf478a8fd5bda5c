//! Ways between the ends of a query: from a roadmap, or from a certificate's pathway.

use std::collections::HashSet;

use nalgebra::Vector3;

use super::Query;
use crate::configuration::Configuration;
use crate::design::Design;
use crate::landscape::certificate::End;
use crate::landscape::minimum::descend;
use crate::landscape::slide::Point;
use crate::landscape::survey::Survey;
use crate::landscape::symmetry::Symmetry;
use crate::landscape::{Pathway, pathway};
use crate::pipeline::{self, Clock, Observer};
use crate::problem::Problem;
use crate::roadmap::{EdgeSettings, Milestone, Roadmap, edge};

/// Nodes of the network to which an end is joined by straight motions, where these are free.
const JOINED: usize = 40;
/// Energy tolerance of pathways, as a fraction of the bond's depth.
const BEND: f64 = 1e-3;
/// So many peaks of a pathway are looked at for transition states, the highest first.
const PEAKS: usize = 8;
/// The direction in which a peak is passed is that between the points so far (m) from it.
const PASSING: f64 = 2e-3;

/// Looks for ways between the two ends of a query.
pub(super) struct Search<'a> {
    design: &'a Design,
    problem: &'a Problem,
    query: &'a Query,
    /// What energies are measured by (J).
    depth: f64,
    edge: EdgeSettings,
}

impl<'a> Search<'a> {
    pub fn new(design: &'a Design, problem: &'a Problem, query: &'a Query) -> Self {
        let depth = pipeline::energy_scale(design, problem);
        Self {
            design,
            problem,
            query,
            depth,
            edge: pipeline::edge_settings(&query.settings, depth),
        }
    }

    /// What energies are measured by (J).
    pub fn depth(&self) -> f64 {
        self.depth
    }

    /// The minimax pathway that a roadmap holds; empty where it holds none.
    pub fn through_roadmap(&self, observer: &dyn Observer) -> Pathway {
        let Query { from, settings, .. } = self.query;
        let guesses: Vec<Configuration> = [Some(from), self.query.to.configuration()]
            .into_iter()
            .flatten()
            .copied()
            .collect();
        let mut survey = pipeline::survey(
            self.design,
            self.problem,
            &Symmetry::all(self.design),
            settings,
            settings.seed,
            &guesses,
            &mut Clock::new(self.problem, observer),
        )
        .survey;
        let from = self.attach(&mut survey, from);
        let to = match &self.query.to {
            End::At(to) => self.attach(&mut survey, to),
            End::Free => survey.free,
        };
        self.lowest(&survey, from, to)
    }

    /// The minimax pathway near a proved one, which a certificate drew no finer than its bounds:
    /// along the descents from the transition states at its peaks, where these lead from end to
    /// end, and nowhere higher than the proved one.
    pub fn near(&self, proved: &[Configuration]) -> Pathway {
        let proved = pathway::of_configurations(self.problem, proved, BEND * self.depth);
        let points: Vec<Point> = proved
            .iter()
            .map(|p| Point::new(self.problem, p.configuration))
            .collect();
        let Some(last) = points.last().copied() else {
            return proved;
        };
        let peaks = peaks(self.problem, &points);
        let mut survey = Survey::of_roadmap(self.problem, Roadmap::default());
        let from = self.attach(&mut survey, &self.query.from);
        let to = match &self.query.to {
            End::At(to) => self.attach(&mut survey, to),
            End::Free => {
                let node = survey.network.add_node(Some((last.q, last.energy)));
                survey.network.add_same(node, survey.free, last.energy);
                node
            }
        };
        survey
            .network
            .add_way(self.problem, from, to, points, &self.edge);
        survey.add_transition_states_near(self.problem, &peaks, &|q| vec![*q], &self.edge);
        let goal = match self.query.to {
            End::At(_) => to,
            End::Free => survey.free,
        };
        self.lowest(&survey, from, goal)
    }

    fn lowest(&self, survey: &Survey, from: usize, to: usize) -> Pathway {
        let goal = HashSet::from([to]);
        pathway::lowest(
            self.problem,
            &survey.network,
            from,
            [&goal, &goal],
            [self.depth, BEND * self.depth],
        )
        .map_or_else(Pathway::new, |lowest| lowest.pathway)
    }

    /// Adds a configuration to the network, joined by its descent and by the straight motions to
    /// the nearest nodes.
    fn attach(&self, survey: &mut Survey, q: &Configuration) -> usize {
        let problem = self.problem;
        let near = self.nearest(survey, q);
        let node = survey.network.add_node(Some((*q, problem.energy(q))));
        let mut milestones = vec![Milestone::new(problem, *q)];
        milestones.extend(
            near.iter()
                .map(|(_, other)| Milestone::new(problem, *other)),
        );
        let pairs: Vec<(u32, u32)> = (1..milestones.len() as u32).map(|k| (0, k)).collect();
        for found in edge::edges(problem, &milestones, &pairs, &self.edge) {
            let other = near[found.to as usize - 1].0;
            survey.network.add_motion(node, other, found.costs);
        }
        if problem.space.is_far(q) {
            survey
                .network
                .add_same(node, survey.free, problem.energy(q));
            return node;
        }
        let descent = descend(problem, q);
        if let Some(end) = survey.arrive(problem, &descent) {
            survey
                .network
                .add_way(problem, node, end, descent.way, &self.edge);
        }
        node
    }

    /// The nodes nearest to a configuration, with theirs.
    fn nearest(&self, survey: &Survey, q: &Configuration) -> Vec<(usize, Configuration)> {
        let nodes = survey.network.nodes.iter().enumerate();
        let mut near: Vec<(f64, usize, Configuration)> = nodes
            .filter_map(|(number, known)| {
                let other = (*known)?.0;
                Some((self.problem.space.distance(q, &other), number, other))
            })
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        near.truncate(JOINED);
        near.into_iter().map(|(_, number, q)| (number, q)).collect()
    }
}

/// The highest inner peaks of a way, each with the direction in which the way passes it, read off
/// the points some way before and after.
fn peaks(problem: &Problem, points: &[Point]) -> Vec<(Configuration, Vector3<f64>)> {
    let mut peaks: Vec<usize> = (1..points.len().saturating_sub(1))
        .filter(|&i| {
            let energy = |k: usize| points[k].energy;
            energy(i) > energy(i - 1) && energy(i) >= energy(i + 1)
        })
        .collect();
    peaks.sort_by(|&a, &b| points[b].energy.total_cmp(&points[a].energy));
    peaks.truncate(PEAKS);
    let passed = |i: usize| {
        let off = |point: &&Point| problem.space.distance(&point.q, &points[i].q) >= PASSING;
        let before = points[..i].iter().rev().find(off).unwrap_or(&points[0]);
        let after = points[i..].iter().find(off).or(points.last());
        after.map(|after| (points[i].q, before.q.step_to(&after.q)))
    };
    peaks.into_iter().filter_map(passed).collect()
}
