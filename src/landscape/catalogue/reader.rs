//! Reads states, escapes, barriers and pathways from a surveyed network.

use std::collections::{BTreeMap, HashMap, HashSet};

use ordered_float::OrderedFloat;

use super::{Catalogue, SAME};
use crate::exploration::Exploration;
use crate::meeting::{magnet_pairs, touching_faces};
use crate::pathway;
use crate::results::{Alternative, Barrier, PathwayCost, Place, SAME_ENERGY, State, StateKind};
use crate::transition_network::Cost;
use tiles::configuration::Configuration;
use tiles::observer::Observer;
use tiles::order::Order;
use tiles::parallel;

/// A state this close (m, metric of the space) to a contact that counts as the bond is a bond: the
/// minimum may be slightly beside the configuration in which the faces coincide.
const BOUND: f64 = 5e-3;

/// Configurations this far apart (m, and rad) are distinguishable.
const TELLABLE: f64 = 1e-6;

/// Number of kinds of states read in parallel.
const BATCH: usize = 64;

pub(super) struct Reader<'a> {
    pub survey: &'a Exploration<'a>,
    pub observer: &'a dyn Observer,
    /// Least escape barrier of reported states, as a fraction of the deepest energy.
    pub least_depth: f64,
}

/// States of a survey (by their number in it) that symmetries map onto each other; the first is
/// the one closest to the bound configuration.
type Class = Vec<usize>;

/// The reported ids of state nodes.
type Ids = HashMap<usize, usize>;

impl Reader<'_> {
    pub fn catalogue(&self) -> Catalogue {
        let (classes, shallow) = self.deep_classes();
        let order: Vec<usize> = classes.iter().flatten().copied().collect();
        let numbered = order.iter().enumerate();
        let ids: Ids = numbered
            .map(|(id, &found)| (self.node(found), id))
            .collect();
        let bound = order.first().copied();
        let bound = bound
            .filter(|&state| self.distance_to_bound(state) < self.survey.problem.scaled(BOUND));
        let of_class = |class: &Class| self.states(class, &ids, self.is_bond(class));
        let states: Vec<State> = parallel::flat_map(&classes, of_class);
        Catalogue {
            barriers: self.barriers(&classes, &ids, bound),
            alternatives: self.alternatives(&states, &order, bound),
            states,
            bound_state: bound.map(|_| 0),
            shallow,
        }
    }

    fn energy(&self, found: usize) -> f64 {
        self.survey.states[found].minimum.point.energy
    }

    fn configuration(&self, found: usize) -> Configuration {
        self.survey.states[found].minimum.point.q
    }

    fn distance_to_bound(&self, found: usize) -> f64 {
        let distance = |bound| {
            self.survey
                .problem
                .space
                .distance(&self.configuration(found), bound)
        };
        let pair = self.survey.problem.pair.as_ref();
        pair.map_or(f64::INFINITY, |pair| distance(&pair.bound))
    }

    /// Whether a class is one of the contacts that count as the bond.
    fn is_bond(&self, class: &Class) -> bool {
        let problem = self.survey.problem;
        let is_one = |&found: &usize| {
            problem.distance_to_bond(&self.configuration(found)) < problem.scaled(BOUND)
        };
        class.iter().any(is_one)
    }

    /// The classes of states as symmetries make them, joined where the exchange of equal tiles maps
    /// the states of one onto those of another.
    fn classes(&self) -> Vec<Class> {
        let mut of_class: BTreeMap<usize, Class> = BTreeMap::new();
        for (found, state) in self.survey.states.iter().enumerate() {
            of_class.entry(state.class).or_default().push(found);
        }
        let problem = self.survey.problem;
        let Some(exchange) = problem.exchange else {
            return of_class.into_values().collect();
        };
        let partner = |class: &Class| {
            let image = exchange.apply(&self.configuration(class[0]));
            let is_there = |found: &usize| {
                problem.space.distance(&self.configuration(*found), &image) < problem.scaled(SAME)
            };
            let found = (0..self.survey.states.len()).find(is_there)?;
            Some(self.survey.states[found].class)
        };
        let numbers: Vec<usize> = of_class.keys().copied().collect();
        for number in numbers {
            let Some(class) = of_class.get(&number) else {
                continue;
            };
            let other = partner(class).filter(|other| *other != number);
            let Some(joined) = other.and_then(|other| of_class.remove(&other)) else {
                continue;
            };
            of_class.entry(number).or_default().extend(joined);
        }
        of_class.into_values().collect()
    }

    /// Classes of states deep enough to be reported, the bound one first, then by energy; and the
    /// number of omitted states.
    fn deep_classes(&self) -> (Vec<Class>, usize) {
        let mut classes = self.classes();
        for class in &mut classes {
            class.order_by_key(|&member| (OrderedFloat(self.distance_to_bound(member)), member));
        }
        let deepest = (0..self.survey.states.len())
            .map(|found| self.energy(found).abs())
            .fold(0.0, f64::max);
        let least = self.least_depth * deepest;
        let count = self.survey.states.len();
        let is_deep = parallel::map(&classes, |class| self.depth(class[0]) >= least);
        let with_depth = classes.into_iter().zip(is_deep);
        let mut classes: Vec<Class> = with_depth
            .filter_map(|(class, is_deep)| is_deep.then_some(class))
            .collect();
        let kept: usize = classes.iter().map(Vec::len).sum();
        classes.order_by_key(|class| {
            let distance = self.distance_to_bound(class[0]);
            let energy = OrderedFloat(self.energy(class[0]));
            (
                distance >= self.survey.problem.scaled(BOUND),
                !self.is_bond(class),
                energy,
                OrderedFloat(distance),
            )
        });
        // Rounding of the energies of twins must not determine their order.
        let as_deep = |a: &Class, b: &Class| {
            let [a, b] = [a, b].map(|class| self.energy(class[0]));
            (a - b).abs() <= SAME_ENERGY * a.abs()
        };
        for twins in classes.chunk_by_mut(as_deep) {
            twins.order_by_key(|class| {
                let Configuration { x, y, theta } = self.configuration(class[0]);
                let unit = self.survey.problem.scaled(1.0);
                let far = self.distance_to_bound(class[0]);
                let place = [far / unit, y / unit, x / unit, theta];
                place.map(|part| (part / TELLABLE).round() as i64)
            });
        }
        (classes, count - kept)
    }

    /// Escape barrier (J) of a state.
    fn depth(&self, found: usize) -> f64 {
        let goals = self.lower_nodes(found);
        self.survey
            .network
            .minimax(self.survey.states[found].node, &goals)
            .map_or(f64::INFINITY, |peak| peak - self.energy(found))
    }

    /// The nodes of `free` and of all states clearly lower than this one.
    fn lower_nodes(&self, found: usize) -> HashSet<usize> {
        let mut nodes = self.nodes(|by| by < -SAME_ENERGY, found);
        nodes.insert(self.survey.free);
        nodes
    }

    /// The nodes of other states selected by their energy difference, relative to this state's
    /// energy.
    fn nodes(&self, is_wanted: impl Fn(f64) -> bool, found: usize) -> HashSet<usize> {
        let energy = self.energy(found);
        let states = self.survey.states.iter().enumerate();
        let others = states.filter(|(number, state)| {
            *number != found && is_wanted((state.minimum.point.energy - energy) / energy.abs())
        });
        others.map(|(_, state)| state.node).collect()
    }

    /// See [`State::sideways`].
    fn sideways(&self, found: usize) -> Option<f64> {
        let equals = self.nodes(|by| by.abs() <= SAME_ENERGY, found);
        let pass = |goals| self.survey.network.minimax(self.node(found), goals);
        let sideways = pass(&equals)?;
        pass(&self.lower_nodes(found))
            .is_none_or(|down| sideways < down)
            .then_some(sideways)
    }

    /// The states of a class. Properties invariant under symmetry are taken from the first one.
    fn states(&self, class: &Class, ids: &Ids, is_bound: bool) -> Vec<State> {
        let first = class[0];
        let pair = self.survey.problem.pair.as_deref();
        let (attracting, repelling) = pair.map_or((0, 0), |pair| {
            magnet_pairs(&pair.fixed, &pair.moving, &self.configuration(first))
        });
        let state = |&found: &usize| State {
            id: ids[&self.node(found)],
            kind: if is_bound {
                StateKind::Bond
            } else {
                StateKind::Trap
            },
            configuration: self.configuration(found),
            energy: self.energy(found),
            class: ids[&self.node(first)],
            faces: self.faces(found),
            attracting,
            repelling,
            block_energy: None,
            capture: None,
            sideways: (found == first).then(|| self.sideways(found)).flatten(),
        };
        class.iter().map(state).collect()
    }

    /// The pairs of faces that touch.
    fn faces(&self, found: usize) -> Vec<(usize, usize)> {
        let q = self.configuration(found);
        let pair = self.survey.problem.pair.as_deref();
        let pair = pair.zip(self.survey.problem.contact.as_ref());
        pair.map(|(pair, contact)| touching_faces(contact, &pair.fixed, &pair.moving, &q))
            .unwrap_or_default()
    }

    /// The barrier from a state to the nearest of some nodes.
    fn barrier_to(&self, found: usize, goals: &HashSet<usize>, ids: &Ids) -> Option<Barrier> {
        let node = self.node(found);
        let own = self.energy(found).abs();
        let depth = if self.survey.problem.is_expensive() {
            own.max(self.survey.problem.depth())
        } else {
            own
        };
        let is_reported = |goal: &usize| *goal == self.survey.free || ids.contains_key(goal);
        let reported: HashSet<usize> = goals.iter().copied().filter(is_reported).collect();
        let (end, pathway) = pathway::lowest(
            &self.survey.network,
            node,
            [goals, &reported],
            [depth, 2e-3 * own],
        )?;
        let to = place(end, ids);
        let to_energy = match to {
            Place::Free => 0.0,
            Place::State(_) => self.survey.network.nodes[end]?.1,
        };
        let from = (place(node, ids), self.energy(found));
        let mut barrier = Barrier::without_a_way(from, self.configuration(found), (to, to_energy));
        barrier.lead_along(pathway);
        Some(barrier)
    }

    /// Barriers from the first state of each class: its escape, to the bound state, and to `free`;
    /// also if no path is known for the bond, or no exit at all.
    fn barriers(&self, classes: &[Class], ids: &Ids, bound: Option<usize>) -> Vec<Barrier> {
        let of_class = |class: &Class| self.barriers_from(class[0], ids, bound);
        let count = classes.len();
        let tell = |done| self.observer.part("ways out of states", done, count);
        let found = parallel::map_in_batches(classes, BATCH, tell, of_class);
        found.into_iter().flatten().collect()
    }

    fn barriers_from(&self, first: usize, ids: &Ids, bound: Option<usize>) -> Vec<Barrier> {
        let lower = self.lower_nodes(first);
        let mut found: Vec<Barrier> = self.barrier_to(first, &lower, ids).into_iter().collect();
        let is_bond = bound == Some(first);
        let goals = bound.filter(|_| !is_bond).map(|bound| self.node(bound));
        for goal in goals.into_iter().chain([self.survey.free]) {
            let place = place(goal, ids);
            if found.iter().all(|barrier| barrier.to != place) {
                found.extend(self.barrier_to(first, &HashSet::from([goal]), ids));
            }
        }
        let is_way_out = |barrier: &Barrier| !is_bond || barrier.to == Place::Free;
        if !found.iter().any(is_way_out) {
            let from = (place(self.node(first), ids), self.energy(first));
            let start = self.configuration(first);
            found.push(Barrier::without_a_way(from, start, (Place::Free, 0.0)));
        }
        found
    }

    fn node(&self, found: usize) -> usize {
        self.survey.states[found].node
    }

    /// The least-work and the most probable pathways between the bound state, the deepest trap and
    /// `free`, in both directions.
    fn alternatives(
        &self,
        states: &[State],
        order: &[usize],
        bound: Option<usize>,
    ) -> Vec<Alternative> {
        let trap = states
            .iter()
            .find(|s| s.kind == StateKind::Trap)
            .map(|s| s.id);
        let mut ends: Vec<(Place, usize)> = bound
            .map(|_| 0)
            .into_iter()
            .chain(trap)
            .map(|id| (Place::State(id), self.survey.states[order[id]].node))
            .collect();
        ends.push((Place::Free, self.survey.free));
        let mut asked = Vec::new();
        for from in &ends {
            for to in ends.iter().filter(|to| to.0 != from.0) {
                asked.extend(
                    [PathwayCost::Work, PathwayCost::Probability].map(|by| (*from, *to, by)),
                );
            }
        }
        parallel::flat_map(&asked, |&(from, to, by)| self.alternative(from, to, by))
    }

    fn alternative(
        &self,
        from: (Place, usize),
        to: (Place, usize),
        by: PathwayCost,
    ) -> Option<Alternative> {
        let network = &self.survey.network;
        let cost = match by {
            PathwayCost::Work => Cost::Work,
            PathwayCost::Probability => Cost::Probability,
        };
        // From where less is around.
        let (cost, route) = if from.0 == Place::Free {
            network.cheapest_into(from.1, to.1, cost)?
        } else {
            let goals = HashSet::from([to.1]);
            let (_, total, route) = network.cheapest(from.1, &goals, cost)?;
            (total, route)
        };
        let depth = self.energy(0).abs();
        let pathway = pathway::along(network, &route, None, 2e-3 * depth);
        (!pathway.is_empty()).then_some(Alternative {
            from: from.0,
            to: to.0,
            by,
            cost,
            pathway,
        })
    }
}

/// The place of a node in reports.
fn place(node: usize, ids: &Ids) -> Place {
    ids.get(&node).copied().map_or(Place::Free, Place::State)
}
