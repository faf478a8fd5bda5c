//! The inventory of a surveyed landscape: its states in order, with their escapes, and the barriers
//! and pathways that are reported.

mod taker;

use self::taker::Taker;
use super::results::{Barrier, PathwayPoint, Place, Proportion, State, StateKind};
use super::survey::Survey;
use super::symmetry::Symmetry;
use crate::analysis::{Alternative, Claims, Settings};
use crate::configuration::Configuration;
use crate::design::Design;
use crate::problem::Problem;

/// Configurations closer than this (m, metric of the space) are taken for the same state.
const SAME: f64 = 1e-4;
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

impl Inventory {
    /// Gives every state the escape of the first one of its class, mapped onto it by a symmetry.
    pub fn copy_escapes(&mut self, problem: &Problem, symmetries: &[Symmetry]) {
        for id in 0..self.states.len() {
            let class = self.states[id].class;
            if id == class {
                continue;
            }
            let image = |symmetry: &&Symmetry| {
                let image = symmetry.apply(&self.states[class].configuration);
                self.nearest_state(problem, &image) == Some(id)
            };
            let symmetry = symmetries.iter().find(image);
            let escape = self.escapes[class].as_ref().zip(symmetry);
            self.escapes[id] =
                escape.map(|(escape, symmetry)| self.image(problem, escape, id, symmetry));
        }
    }

    /// A barrier as a symmetry maps it, so that it starts from state `from`.
    fn image(
        &self,
        problem: &Problem,
        barrier: &Barrier,
        from: usize,
        symmetry: &Symmetry,
    ) -> Barrier {
        let to = match barrier.to {
            Place::Free => Place::Free,
            Place::State(id) => self
                .nearest_state(problem, &symmetry.apply(&self.states[id].configuration))
                .map_or(barrier.to, Place::State),
        };
        let image = |point: &PathwayPoint| PathwayPoint {
            configuration: symmetry.apply(&point.configuration),
            ..*point
        };
        Barrier {
            from: Place::State(from),
            to,
            saddle: symmetry.apply(&barrier.saddle),
            pathway: barrier.pathway.iter().map(image).collect(),
            ..barrier.clone()
        }
    }

    /// Whether a barrier is among those of which more is claimed than an estimate.
    pub fn is_claimed(&self, barrier: &Barrier, claims: Claims) -> bool {
        match claims {
            Claims::All => true,
            Claims::BondAndDeepestTrap => self.is_main(barrier),
        }
    }

    /// Whether a barrier is the bond's way out to `free` or one of the ways out of the deepest trap.
    fn is_main(&self, barrier: &Barrier) -> bool {
        let is_from = |kind| {
            let first = self.states.iter().find(|state| state.kind == kind);
            first.is_some_and(|state| barrier.from == Place::State(state.id))
        };
        let is_out_of_the_bond = is_from(StateKind::Bound) && barrier.to == Place::Free;
        is_out_of_the_bond || is_from(StateKind::Misbound)
    }

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
