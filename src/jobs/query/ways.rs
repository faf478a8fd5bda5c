//! Pathways between the ends of a query: from a roadmap, or from a certificate.

use ordered_float::OrderedFloat;
use std::cell::OnceCell;
use std::cmp::Reverse;
use std::collections::HashSet;

use nalgebra::Vector3;

use super::Request;
use crate::pipeline::{self, Clock};
use physics::configuration::Configuration;
use physics::landscape::capture::FarStarts;
use physics::landscape::exploration::Exploration;
use physics::landscape::minimax::End;
use physics::landscape::minimum::descend;
use physics::landscape::pathway::{self, PathLimits};
use physics::landscape::{Pathway, capture, highest_point};
use physics::observer::{Observer, Silent};
use physics::order::Order;
use physics::problem::{Problem, Symmetry};
use physics::roadmap::{Point, Roadmap, RoadmapSettings, edge};

/// Number of nodes of the network to which an end is joined by straight motions, if these are free.
const JOINED: usize = 40;
/// Energy tolerance of pathways, as a fraction of the bond's depth.
const BEND: f64 = 1e-3;
/// Number of peaks of a pathway searched for transition states, highest first.
const PEAKS: usize = 8;
/// The direction of a pathway at a peak is taken between the points at this distance (m) from it.
const PASSING: f64 = 2e-3;

/// Number of far starts; those that end where the path to `free` starts are followed.
const FAR_STARTS: usize = 100;

/// Searches paths between the two ends of a query.
pub(super) struct PathSearch<'a> {
    problem: &'a Problem,
    query: &'a Request,
    analysis: &'a pipeline::Request,
    roadmap: RoadmapSettings,
    /// Far starts, each with its end; computed on first use.
    arrivals: OnceCell<Vec<(Configuration, Configuration)>>,
}

impl<'a> PathSearch<'a> {
    pub fn new(problem: &'a Problem, query: &'a Request, analysis: &'a pipeline::Request) -> Self {
        Self {
            problem,
            query,
            analysis,
            roadmap: analysis.roadmap(problem),
            arrivals: OnceCell::new(),
        }
    }

    /// Adds the motions of far starts to their ends, if the requested path leads to `free`.
    fn add_arrivals(&self, survey: &mut Exploration) {
        if self.query.to != End::Free {
            return;
        }
        let arrivals = self.arrivals.get_or_init(|| {
            let far_starts = FarStarts {
                count: FAR_STARTS,
                seed: self.query.seed,
            };
            let known = survey.known();
            let ends = capture::ends(self.problem, &far_starts, known, &|_| ());
            capture::arrivals(self.problem, &far_starts, &ends)
        });
        survey.add_arrivals(arrivals);
    }

    /// The minimax pathway of a roadmap; empty if there is none.
    pub fn through_roadmap(&self, observer: &dyn Observer) -> Pathway {
        let from = &self.query.from;
        let guesses: Vec<Configuration> = [Some(from), self.query.to.configuration()]
            .into_iter()
            .flatten()
            .copied()
            .collect();
        let mut clock = Clock::new(self.problem, observer);
        let (mut survey, _) = pipeline::survey(
            self.problem,
            self.analysis,
            &self.roadmap,
            &guesses,
            &mut clock,
        );
        let from = self.attach(&mut survey, from);
        let to = match &self.query.to {
            End::At(to) => self.attach(&mut survey, to),
            End::Free => survey.free,
        };
        self.add_arrivals(&mut survey);
        self.lowest(&survey, from, to)
    }

    /// The minimax pathway near a proved one, which is only as precise as the certificate's bounds.
    /// It follows the descents from the transition states at the peaks, if these connect the ends
    /// and are nowhere higher than the proved pathway.
    pub fn near(&self, proved: &[Configuration]) -> Pathway {
        let depth = self.problem.depth();
        let proved = pathway::of_configurations(self.problem, proved, BEND * depth);
        let highest = highest_point(&proved).map_or(f64::INFINITY, |point| point.energy);
        let proved: Vec<Configuration> = proved.iter().map(|p| p.configuration).collect();
        let limits = PathLimits::below(highest + 1e-9 * depth, self.problem);
        let proved = pathway::shortened(self.problem, &proved, &limits);
        let proved = pathway::of_configurations(self.problem, &proved, BEND * depth);
        let points: Vec<Point> = proved
            .iter()
            .map(|p| Point::new(self.problem, p.configuration))
            .collect();
        let Some(last) = points.last().copied() else {
            return Pathway::new();
        };
        let peaks = peaks(self.problem, &points);
        let settings = self.analysis.exploration(&self.roadmap);
        let mut survey = Exploration::of_roadmap(self.problem, Roadmap::default(), &settings);
        let from = self.attach(&mut survey, &self.query.from);
        let to = match &self.query.to {
            End::At(to) => self.attach(&mut survey, to),
            End::Free => {
                let node = survey.network.add_node(Some((last.q, last.energy)));
                survey.network.add_same(node, survey.free, last.energy);
                node
            }
        };
        survey.network.add_way(from, to, points);
        survey.add_transition_states_near(&peaks, &[Symmetry::IDENTITY], &Silent);
        self.add_arrivals(&mut survey);
        let goal = match self.query.to {
            End::At(_) => to,
            End::Free => survey.free,
        };
        self.lowest(&survey, from, goal)
    }

    fn lowest(&self, survey: &Exploration, from: usize, to: usize) -> Pathway {
        let goal = HashSet::from([to]);
        pathway::lowest(
            &survey.network,
            from,
            [&goal, &goal],
            [self.problem.depth(), BEND * self.problem.depth()],
        )
        .map_or_else(Pathway::new, |(_, pathway)| pathway)
    }

    /// Adds a configuration to the network, with its descent and straight motions to the nearest
    /// nodes.
    fn attach(&self, survey: &mut Exploration, q: &Configuration) -> usize {
        let problem = self.problem;
        let near = self.nearest(survey, q);
        let node = survey.network.add_node(Some((*q, problem.energy(q))));
        let mut milestones = vec![Point::new(problem, *q)];
        milestones.extend(near.iter().map(|(_, other)| Point::new(problem, *other)));
        let pairs: Vec<(u32, u32)> = (1..milestones.len() as u32).map(|k| (0, k)).collect();
        for found in edge::edges(problem, &milestones, &pairs, &self.roadmap.edges) {
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
        if let Some(end) = survey.arrive(&descent) {
            survey.network.add_way(node, end, descent.way);
        }
        node
    }

    /// The nodes nearest to a configuration, with their configurations.
    fn nearest(&self, survey: &Exploration, q: &Configuration) -> Vec<(usize, Configuration)> {
        let nodes = survey.network.nodes.iter().enumerate();
        let mut near: Vec<(f64, usize, Configuration)> = nodes
            .filter_map(|(number, known)| {
                let other = (*known)?.0;
                Some((self.problem.space.distance(q, &other), number, other))
            })
            .collect();
        near.order_by_key(|near| (OrderedFloat(near.0), near.1));
        near.truncate(JOINED);
        near.into_iter().map(|(_, number, q)| (number, q)).collect()
    }
}

/// The highest inner peaks of a path, each with the direction of the path there, from points some
/// distance before and after.
fn peaks(problem: &Problem, points: &[Point]) -> Vec<(Configuration, Vector3<f64>)> {
    let mut peaks: Vec<usize> = (1..points.len().saturating_sub(1))
        .filter(|&i| {
            let energy = |k: usize| points[k].energy;
            energy(i) > energy(i - 1) && energy(i) >= energy(i + 1)
        })
        .collect();
    peaks.order_by_key(|&peak| Reverse(OrderedFloat(points[peak].energy)));
    peaks.truncate(PEAKS);
    let passed = |i: usize| {
        let off = |point: &&Point| {
            problem.space.distance(&point.q, &points[i].q) >= problem.scaled(PASSING)
        };
        let before = points[..i].iter().rev().find(off).unwrap_or(&points[0]);
        let after = points[i..].iter().find(off).or(points.last());
        after.map(|after| (points[i].q, before.q.step_to(&after.q)))
    };
    peaks.into_iter().filter_map(passed).collect()
}
