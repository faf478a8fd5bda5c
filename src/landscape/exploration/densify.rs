//! Adds milestones where a survey needs more detail.

use std::collections::HashMap;

use nalgebra::Vector3;
use ordered_float::OrderedFloat;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{Exploration, ExplorationSettings};
use crate::constrained;
use crate::roadmap::{Point, edge};
use crate::transition_network::Merge;
use tiles::configuration::Configuration;
use tiles::observer::Observer;
use tiles::parallel;
use tiles::problem::Problem;

/// Smallest and largest distance (m, metric of the space) of added milestones from the pass.
const RADII: [f64; 2] = [2e-3, 0.03];
/// The same around states, each (m).
const AROUND_STATES: [f64; 3] = [1e-3, 1e-2, 3e-2];

impl Exploration<'_> {
    /// Connects a state's node to the network by milestones around it, if none of its copies is
    /// connected. With very many magnets, for which energies are expensive, only straight motions
    /// to other states and to `free` are used.
    pub(super) fn join(&mut self, node: usize) {
        let settings = self.settings;
        let Some((centre, energy)) = self.network.nodes[node] else {
            return;
        };
        let class = self.states.iter().find(|state| state.node == node);
        let class = class.map(|state| state.class);
        let mut copies = self.states.iter().filter(|copy| Some(copy.class) == class);
        if self.problem.is_expensive() || copies.any(|copy| !self.network.is_isolated(copy.node)) {
            return;
        }
        for radius in AROUND_STATES.map(|radius| self.problem.scaled(radius)) {
            let place = Place {
                centre,
                radius,
                highest: energy.abs() + settings.edge.tolerance.absolute,
                number: node as u64,
            };
            self.densify_at(&place);
        }
    }

    /// Adds milestones around passes that are not yet transition states, and records the change of
    /// their energies.
    pub(super) fn densify(&mut self, open: &[Merge], round: u64, observer: &dyn Observer) {
        let before: HashMap<usize, Merge> =
            self.merges().into_iter().map(|m| (m.upper, m)).collect();
        let still: Vec<Merge> = open
            .iter()
            .filter_map(|merge| before.get(&merge.upper).copied())
            .filter(|merge| !self.is_settled(merge))
            .collect();
        for (number, merge) in still.iter().enumerate() {
            observer.part("milestones at passes", number, still.len());
            self.densify_around(merge, round);
        }
        let after: HashMap<usize, Merge> =
            self.merges().into_iter().map(|m| (m.upper, m)).collect();
        for merge in &still {
            if let Some(now) = after.get(&merge.upper) {
                let peak = |m: &Merge| self.network.costs(m.link).peak;
                self.unpolished.insert(now.link, peak(merge) - peak(now));
            }
        }
    }

    fn densify_around(&mut self, merge: &Merge, round: u64) {
        let Some((centre, along)) = self.meeting_place(merge.link) else {
            return;
        };
        let place = Place {
            centre,
            radius: self
                .problem
                .space
                .length(along)
                .clamp(self.problem.scaled(RADII[0]), self.problem.scaled(RADII[1])),
            highest: self.network.costs(merge.link).peak,
            number: (round << 32) + merge.link as u64,
        };
        self.densify_at(&place);
    }

    fn densify_at(&mut self, place: &Place) {
        let settings = self.settings;
        let problem = self.problem;
        let added = added_milestones(problem, place, &self.settings);
        let (centre, radius) = (place.centre, place.radius);
        // Old nodes around the place, then the new ones; links among them all that involve a new
        // one.
        let mut around: Vec<(usize, Point)> = self
            .network
            .nodes
            .iter()
            .enumerate()
            .filter_map(|(i, node)| {
                let (q, _) = (*node)?;
                (problem.space.distance(&q, &centre) <= 2.0 * radius)
                    .then(|| (i, Point::new(problem, q)))
            })
            .collect();
        let old = around.len();
        for milestone in added {
            let node = self.network.add_node(Some((milestone.q, milestone.energy)));
            around.push((node, milestone));
        }
        let pairs = pairs_with_new(problem, &around, old, 12);
        let milestones: Vec<Point> = around.iter().map(|a| a.1).collect();
        for found in edge::edges(problem, &milestones, &pairs, &settings.edge) {
            let [from, to] = [found.from, found.to].map(|end| around[end as usize].0);
            self.network.add_motion(from, to, found.costs);
        }
    }
}

/// A place around which milestones are added.
struct Place {
    centre: Configuration,
    /// How far around (m, metric of the space).
    radius: f64,
    /// New milestones lie below this energy (J).
    highest: f64,
    /// Distinguishes the random streams of places.
    number: u64,
}

/// Free configurations around a place, those that would overlap pushed out into contact.
fn added_milestones(
    problem: &Problem,
    place: &Place,
    settings: &ExplorationSettings,
) -> Vec<Point> {
    parallel::flat_map(0..settings.added_milestones, |i| {
        let mut rng = ChaCha8Rng::seed_from_u64(settings.seed ^ place.number.rotate_left(16));
        rng.set_stream((1 << 32) + i as u64);
        let mut draw = || rng.random_range(-1.0..1.0);
        let step = Vector3::new(draw(), draw(), draw() / problem.space.rho) * place.radius;
        let aim = place.centre.moved(step);
        let q = constrained::settle(problem, &aim, place.radius)?;
        let milestone = Point::new(problem, q);
        (milestone.energy < place.highest).then_some(milestone)
    })
}

/// For each new configuration (from `old` on) its `k` nearest among all.
fn pairs_with_new(
    problem: &Problem,
    around: &[(usize, Point)],
    old: usize,
    k: usize,
) -> Vec<(u32, u32)> {
    let nearest = |i: usize| {
        let here = &around[i].1.q;
        let others = (0..around.len()).filter(|&j| j != i);
        let distance = |j: usize| problem.space.distance(here, &around[j].1.q);
        let mut near: Vec<(OrderedFloat<f64>, usize)> =
            others.map(|j| (OrderedFloat(distance(j)), j)).collect();
        if k < near.len() {
            near.select_nth_unstable(k);
            near.truncate(k);
        }
        near.into_iter()
            .map(move |(_, j)| (i.min(j) as u32, i.max(j) as u32))
    };
    let mut pairs: Vec<(u32, u32)> = parallel::flat_map(old..around.len(), nearest);
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}
