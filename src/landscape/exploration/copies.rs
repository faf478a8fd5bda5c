//! Carries results for one state of a symmetry class over to the others.

use std::collections::{HashMap, HashSet};

use super::{Exploration, SAME};
use crate::roadmap::EdgeCosts;
use crate::transition_network::{Merge, Route};
use tiles::configuration::Configuration;
use tiles::problem::{Problem, Symmetry};

/// Relative difference of energies below which paths count as equally low.
const AS_LOW: f64 = 1e-9;

impl Exploration<'_> {
    /// For each class of states the lowest merge with another state of the class, and the lowest
    /// with any other or `free`, in ascending order.
    pub(super) fn lowest_merges(&self) -> Vec<Merge> {
        self.of_each_kind(self.merges(), 1)
    }

    /// The first `most` of each kind of merges, which are ascending.
    pub(super) fn of_each_kind(&self, mut merges: Vec<Merge>, most: usize) -> Vec<Merge> {
        let class_of = self.classes();
        let mut counts: HashMap<_, usize> = HashMap::new();
        merges.retain(|merge| {
            let count = counts.entry(kind(&class_of, merge)).or_default();
            *count += 1;
            *count <= most
        });
        merges
    }

    /// Gives all states of a class an exit as low as that of the state with the lowest known one,
    /// along its images.
    pub(super) fn share(&mut self) {
        let problem = self.problem;
        if problem.symmetries.len() < 2 {
            return;
        }
        let class_of = self.classes();
        let peak = |merge: &Merge| self.network.costs(merge.link).peak;
        let merges = self.merges();
        let own: HashMap<(usize, bool), f64> = merges
            .iter()
            .map(|merge| ((merge.upper, kind(&class_of, merge).1), peak(merge)))
            .collect();
        let lowest: Vec<(Merge, f64, Route)> = self
            .of_each_kind(merges, 1)
            .into_iter()
            .map(|merge| {
                let lower = HashSet::from([merge.lower]);
                let route = self.network.lowest(merge.upper, &lower);
                (
                    merge,
                    peak(&merge),
                    route.map_or_else(Route::new, |way| way.1),
                )
            })
            .collect();
        for (merge, peak, route) in lowest {
            let is_sideways = kind(&class_of, &merge).1;
            for symmetry in &problem.symmetries[1..] {
                let copy = self.image_node(merge.upper, symmetry);
                let is_as_low = |own: &f64| *own <= peak + AS_LOW * peak.abs();
                if !own.get(&(copy, is_sideways)).is_some_and(is_as_low) {
                    self.add_image(copy, &route, symmetry);
                }
            }
        }
        self.network.span();
    }

    /// The indices of the states of which the others are images.
    pub(super) fn firsts(&self) -> impl Iterator<Item = usize> {
        let numbered = self.states.iter().enumerate();
        numbered
            .filter(|(number, state)| state.class == *number)
            .map(|(number, _)| number)
    }

    /// Adds a straight motion between the nodes of two states with its images.
    pub(super) fn add_motion_and_images(&mut self, nodes: [usize; 2], costs: EdgeCosts) {
        let link = self.network.add_motion(nodes[0], nodes[1], costs);
        let mut known = HashSet::from([nodes]);
        for symmetry in &self.problem.symmetries {
            let [from, to] = nodes.map(|node| self.image_node(node, symmetry));
            if !known.contains(&[to, from]) && known.insert([from, to]) {
                self.network.add_image(link, [from, to], symmetry);
            }
        }
    }

    /// The class of each state's node.
    fn classes(&self) -> HashMap<usize, usize> {
        let states = self.states.iter();
        states.map(|state| (state.node, state.class)).collect()
    }

    /// Adds the image of a route, from the image of its first node.
    pub(super) fn add_image(&mut self, mut here: usize, route: &Route, symmetry: &Symmetry) {
        for &(number, forwards) in route {
            let [_, next] = self.network.ends_along((number, forwards));
            let next = self.image_node(next, symmetry);
            let ends = if forwards { [here, next] } else { [next, here] };
            self.network.add_image(number, ends, symmetry);
            here = next;
        }
    }

    /// The image of a node: that of a state is a state's, others are new.
    pub(super) fn image_node(&mut self, node: usize, symmetry: &Symmetry) -> usize {
        let Some((q, energy)) = self.network.nodes[node] else {
            return node;
        };
        let q = symmetry.apply(&q);
        let is_state = self.states.iter().any(|state| state.node == node);
        let state = is_state.then(|| self.state_at(&q, self.problem.scaled(SAME)));
        match state.flatten() {
            Some(state) => self.states[state].node,
            None => self.network.add_node(Some((q, energy))),
        }
    }
}

/// The symmetries that map a configuration to distinct ones.
pub(super) fn distinct<'a>(
    problem: &Problem,
    symmetries: &'a [Symmetry],
    q: &Configuration,
) -> Vec<&'a Symmetry> {
    let mut images: Vec<Configuration> = Vec::new();
    let is_new = |symmetry: &&Symmetry| {
        let image = symmetry.apply(q);
        let is_same =
            |other: &Configuration| problem.space.distance(other, &image) <= problem.scaled(SAME);
        let is_new = !images.iter().any(is_same);
        images.push(image);
        is_new
    };
    symmetries.iter().filter(is_new).collect()
}

/// The class that merges upwards, and whether with itself.
fn kind(class_of: &HashMap<usize, usize>, merge: &Merge) -> (Option<usize>, bool) {
    let [upper, lower] = [merge.upper, merge.lower].map(|node| class_of.get(&node).copied());
    (upper, upper == lower)
}
