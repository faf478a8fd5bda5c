//! The inventory of a surveyed landscape: its states in order, with their escapes, and the barriers
//! and pathways that are reported.

use std::collections::HashSet;

use super::meeting::{magnet_pairs, touching_faces};
use super::network::Cost;
use super::pathway::{self, Lowest};
use super::results::{Barrier, Pathway, PathwayPoint, Place, Proportion, State, StateKind};
use super::survey::Survey;
use super::symmetry::Symmetry;
use crate::analysis::{Alternative, PathwayCost, Settings};
use crate::configuration::Configuration;
use crate::design::Design;
use crate::problem::Problem;

/// Configurations closer than this (m, metric of the space) are taken for the same state.
const SAME: f64 = 1e-4;
/// A state this close (m, metric of the space) to the bound configuration is the bound one: the
/// bond may settle a little beside the configuration in which the faces coincide.
const BOUND: f64 = 5e-3;

/// States, escapes, barriers and pathways, in the order in which they are reported.
#[derive(Clone, Debug)]
pub struct Inventory {
    pub states: Vec<State>,
    pub escapes: Vec<Option<Barrier>>,
    pub barriers: Vec<Barrier>,
    pub alternatives: Vec<Alternative>,
    pub bound_state: Option<usize>,
    pub shallow: usize,
}

/// Takes the inventory of a survey.
pub fn take(
    design: &Design,
    problem: &Problem,
    symmetries: &[Symmetry],
    survey: &Survey,
    settings: &Settings,
) -> Inventory {
    Taker {
        design,
        problem,
        symmetries,
        survey,
        settings,
    }
    .take()
}

struct Taker<'a> {
    design: &'a Design,
    problem: &'a Problem,
    symmetries: &'a [Symmetry],
    survey: &'a Survey,
    settings: &'a Settings,
}

/// States of a survey (by their number in it) that symmetries map onto each other; the first is
/// the one closest to the bound configuration.
type Class = Vec<usize>;

impl Taker<'_> {
    fn take(&self) -> Inventory {
        let (classes, shallow) = self.deep_classes();
        let order: Vec<usize> = classes.iter().flatten().copied().collect();
        let bound_state = order
            .first()
            .filter(|&&state| self.distance_to_bound(state) < BOUND)
            .map(|_| 0);
        let mut states = Vec::new();
        for class in &classes {
            let lowest_id = states.len();
            for &found in class {
                let is_bound = bound_state.is_some() && lowest_id == 0;
                states.push(self.state(found, states.len(), lowest_id, is_bound));
            }
        }
        let mut escapes = Vec::new();
        for class in &classes {
            escapes.extend(self.escapes(class, &states, &order));
        }
        let barriers = self.barriers(&classes, &states, &order, &escapes, bound_state);
        let alternatives = self.alternatives(&states, &order, bound_state);
        Inventory {
            states,
            escapes,
            barriers,
            alternatives,
            bound_state,
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
        self.problem
            .space
            .distance(&self.configuration(found), &self.design.bound)
    }

    /// Classes of states deep enough to be reported: the bound one first, then by energy. And the
    /// number of states left out.
    fn deep_classes(&self) -> (Vec<Class>, usize) {
        let mut class_of: Vec<Option<usize>> = vec![None; self.survey.states.len()];
        let mut classes: Vec<Class> = Vec::new();
        for found in 0..self.survey.states.len() {
            if class_of[found].is_some() {
                continue;
            }
            let mut class: Class = self
                .symmetries
                .iter()
                .filter_map(|s| {
                    let image = s.apply(&self.configuration(found));
                    self.survey.state_at(self.problem, &image, SAME)
                })
                .filter(|&member| class_of[member].is_none())
                .collect();
            class.sort_unstable();
            class.dedup();
            for &member in &class {
                class_of[member] = Some(classes.len());
            }
            class.sort_by(|&a, &b| {
                let distance = |m: usize| self.distance_to_bound(m);
                distance(a).total_cmp(&distance(b)).then(a.cmp(&b))
            });
            classes.push(class);
        }
        let deepest = (0..self.survey.states.len())
            .map(|found| self.energy(found).abs())
            .fold(0.0, f64::max);
        let least = self.settings.least_depth * deepest;
        let count = self.survey.states.len();
        classes.retain(|class| self.depth(class[0]) >= least);
        let kept: usize = classes.iter().map(Vec::len).sum();
        classes.sort_by(|a, b| {
            let bound = |class: &Class| self.distance_to_bound(class[0]) < BOUND;
            bound(b)
                .cmp(&bound(a))
                .then(self.energy(a[0]).total_cmp(&self.energy(b[0])))
                .then(
                    self.distance_to_bound(a[0])
                        .total_cmp(&self.distance_to_bound(b[0])),
                )
        });
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
        let energy = self.energy(found);
        let mut nodes: HashSet<usize> = self
            .survey
            .states
            .iter()
            .filter(|s| s.minimum.point.energy < energy - 1e-6 * energy.abs())
            .map(|s| s.node)
            .collect();
        nodes.insert(self.survey.free);
        nodes
    }

    fn state(&self, found: usize, id: usize, class: usize, is_bound: bool) -> State {
        let configuration = self.configuration(found);
        let (fixed, moving) = (&self.design.fixed, &self.design.moving);
        let (attracting, repelling) = magnet_pairs(fixed, moving, &configuration);
        State {
            id,
            kind: if is_bound {
                StateKind::Bound
            } else {
                StateKind::Misbound
            },
            configuration,
            energy: self.energy(found),
            class,
            faces: self
                .problem
                .contact
                .as_ref()
                .map_or_else(Vec::new, |contact| {
                    touching_faces(contact, fixed, moving, &configuration)
                }),
            attracting,
            repelling,
            block_energy: None,
            capture: None,
        }
    }

    /// The escapes of a class: found for its first state, mapped onto the others.
    fn escapes(&self, class: &Class, states: &[State], order: &[usize]) -> Vec<Option<Barrier>> {
        let first = self.barrier_to(class[0], &self.lower_nodes(class[0]), order);
        class
            .iter()
            .map(|&member| {
                let first = first.as_ref()?;
                if member == class[0] {
                    return Some(first.clone());
                }
                let symmetry = self.symmetries.iter().find(|s| {
                    let image = s.apply(&self.configuration(class[0]));
                    self.problem
                        .space
                        .distance(&image, &self.configuration(member))
                        < SAME
                })?;
                Some(self.image(first, member, symmetry, states, order))
            })
            .collect()
    }

    fn image(
        &self,
        barrier: &Barrier,
        from: usize,
        symmetry: &Symmetry,
        states: &[State],
        order: &[usize],
    ) -> Barrier {
        let to = match barrier.to {
            Place::Free => Place::Free,
            Place::State(id) => {
                let image = symmetry.apply(&states[id].configuration);
                states
                    .iter()
                    .find(|s| self.problem.space.distance(&s.configuration, &image) < SAME)
                    .map_or(barrier.to, |s| Place::State(s.id))
            }
        };
        Barrier {
            from: self.place(self.survey.states[from].node, order),
            to,
            saddle: symmetry.apply(&barrier.saddle),
            pathway: barrier
                .pathway
                .iter()
                .map(|point| PathwayPoint {
                    configuration: symmetry.apply(&point.configuration),
                    ..*point
                })
                .collect(),
            ..barrier.clone()
        }
    }

    /// What is reported of a node.
    fn place(&self, node: usize, order: &[usize]) -> Place {
        order
            .iter()
            .position(|&found| self.survey.states[found].node == node)
            .map_or(Place::Free, Place::State)
    }

    /// The barrier from a state to the nearest of some nodes.
    fn barrier_to(&self, found: usize, goals: &HashSet<usize>, order: &[usize]) -> Option<Barrier> {
        let node = self.survey.states[found].node;
        let depth = self.energy(found).abs();
        let reported: HashSet<usize> = goals
            .iter()
            .copied()
            .filter(|&goal| {
                goal == self.survey.free
                    || order.iter().any(|&o| self.survey.states[o].node == goal)
            })
            .collect();
        let Lowest {
            saddle,
            end,
            pathway,
        } = pathway::lowest(
            self.problem,
            &self.survey.network,
            node,
            [goals, &reported],
            [depth, 2e-3 * depth],
        )?;
        let to = self.place(end, order);
        let to_energy = match to {
            Place::Free => 0.0,
            Place::State(id) => self.energy(order[id]),
        };
        Some(Barrier {
            from: self.place(node, order),
            to,
            saddle_energy: saddle.energy,
            saddle: saddle.configuration,
            lower: None,
            upper: None,
            caged: false,
            from_energy: self.energy(found),
            to_energy,
            spread: None,
            pathway,
        })
    }

    /// From the first state of each class: its escape, the way to the bound state, and to `free`.
    fn barriers(
        &self,
        classes: &[Class],
        states: &[State],
        order: &[usize],
        escapes: &[Option<Barrier>],
        bound_state: Option<usize>,
    ) -> Vec<Barrier> {
        let mut barriers: Vec<Barrier> = Vec::new();
        for class in classes {
            let id = states
                .iter()
                .position(|s| order[s.id] == class[0])
                .unwrap_or(0);
            let mut goals = Vec::new();
            if let Some(bound) = bound_state.filter(|&bound| bound != id) {
                goals.push(self.survey.states[order[bound]].node);
            }
            goals.push(self.survey.free);
            let mut found: Vec<Barrier> = escapes[id].iter().cloned().collect();
            for goal in goals {
                let place = self.place(goal, order);
                if found.iter().all(|barrier| barrier.to != place) {
                    found.extend(self.barrier_to(class[0], &HashSet::from([goal]), order));
                }
            }
            barriers.extend(found);
        }
        barriers
    }

    /// The least-work and the most probable pathways between the bound state, the deepest trap and
    /// `free`, in both directions.
    fn alternatives(
        &self,
        states: &[State],
        order: &[usize],
        bound_state: Option<usize>,
    ) -> Vec<Alternative> {
        let trap = states
            .iter()
            .find(|s| s.kind == StateKind::Misbound)
            .map(|s| s.id);
        let mut ends: Vec<(Place, usize)> = bound_state
            .into_iter()
            .chain(trap)
            .map(|id| (Place::State(id), self.survey.states[order[id]].node))
            .collect();
        ends.push((Place::Free, self.survey.free));
        let mut all = Vec::new();
        for from in &ends {
            for to in ends.iter().filter(|to| to.0 != from.0) {
                for by in [PathwayCost::Work, PathwayCost::Improbability] {
                    all.extend(self.alternative(*from, *to, by));
                }
            }
        }
        all
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
            PathwayCost::Improbability => Cost::Improbability,
        };
        let (_, cost, route) = network.cheapest(from.1, &HashSet::from([to.1]), cost)?;
        let depth = self.energy(0).abs();
        let pathway: Pathway = pathway::along(
            self.problem,
            network,
            &route,
            f64::NEG_INFINITY,
            2e-3 * depth,
        );
        Some(Alternative {
            from: from.0,
            to: to.0,
            by,
            cost,
            pathway,
        })
    }
}

impl Inventory {
    /// Counts in which states far starts ended and fills in the capture shares; returns the share
    /// that ended in none.
    pub fn count_captures(
        &mut self,
        problem: &Problem,
        ends: &[Option<Configuration>],
    ) -> Proportion {
        let mut counts = vec![0; self.states.len()];
        let mut none = 0;
        for end in ends {
            match end.and_then(|q| self.nearest_state(problem, &q)) {
                Some(id) => counts[id] += 1,
                None => none += 1,
            }
        }
        for (state, count) in self.states.iter_mut().zip(counts) {
            state.capture = Some(Proportion::new(count, ends.len()));
        }
        Proportion::new(none, ends.len())
    }

    fn nearest_state(&self, problem: &Problem, q: &Configuration) -> Option<usize> {
        self.states
            .iter()
            .map(|s| (problem.space.distance(&s.configuration, q), s.id))
            .filter(|(distance, _)| *distance < SAME)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, id)| id)
    }

    /// Widens the spread of each barrier by what another run found for it.
    pub fn widen_spread(&mut self, problem: &Problem, other: &Self) {
        let same_place = |a: Place, b: Place| match (a, b) {
            (Place::Free, Place::Free) => true,
            (Place::State(a), Place::State(b)) => {
                let (a, b) = (
                    &self.states[a].configuration,
                    &other.states[b].configuration,
                );
                problem.space.distance(a, b) < SAME
            }
            _ => false,
        };
        for barrier in &mut self.barriers {
            let found = other
                .barriers
                .iter()
                .find(|b| same_place(barrier.from, b.from) && same_place(barrier.to, b.to));
            if let Some(found) = found {
                let (low, high) = barrier
                    .spread
                    .unwrap_or((barrier.saddle_energy, barrier.saddle_energy));
                barrier.spread =
                    Some((low.min(found.saddle_energy), high.max(found.saddle_energy)));
            }
        }
    }
}
