//! What the pictures are drawn from, and which of it they show.

use std::collections::BTreeMap;

use super::marks::Mark;
use crate::analysis::Analysis;
use crate::configuration::{Configuration, ConfigurationSpace};
use crate::design::Design;
use crate::landscape::map::Pair;
use crate::landscape::{Barrier, Pathway, PathwayPoint, Place, State, StateKind};
use crate::potential::shielding::Shields;
use crate::problem::Problem;

/// An analysed pair of tiles.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// Name of the design.
    pub name: &'a str,
    pub pair: Pair<'a>,
    pub shields: &'a Shields,
    pub space: &'a ConfigurationSpace,
    /// The configuration in which the two target faces coincide.
    pub bound: Configuration,
    /// The target faces of the fixed and of the moving tile.
    pub target: (usize, usize),
    pub states: &'a [State],
    /// The lowest way out of each state.
    pub escapes: &'a [Option<Barrier>],
    pub barriers: &'a [Barrier],
}

/// States that a symmetry maps onto each other, seen through one of them.
#[derive(Clone, Copy, Debug)]
pub struct Class<'a> {
    /// The copy nearest to the bound configuration.
    pub state: &'a State,
    pub copies: usize,
}

impl<'a> Scene<'a> {
    /// What an analysis found; `None` for a problem without contact, which is no pair of tiles.
    pub fn new(design: &'a Design, problem: &'a Problem, analysis: &'a Analysis) -> Option<Self> {
        Some(Self {
            states: &analysis.states,
            escapes: &analysis.escapes,
            barriers: &analysis.barriers,
            ..Self::before_analysis(design, problem)?
        })
    }

    /// The tiles alone, without states; `None` for a problem without contact.
    pub fn before_analysis(design: &'a Design, problem: &'a Problem) -> Option<Self> {
        Some(Self {
            name: &design.name,
            pair: Pair {
                fixed: &design.fixed,
                moving: &design.moving,
                potential: problem.potential(),
                contact: problem.contact.as_ref()?,
            },
            shields: &design.shields,
            space: &problem.space,
            bound: design.bound,
            target: design.target,
            states: &[],
            escapes: &[],
            barriers: &[],
        })
    }

    /// Half the size (m) of the map along x and y: a fifth of the tiles' size beyond where they can
    /// touch, or to the table's edge.
    pub fn reach(&self) -> [f64; 2] {
        let circles = [self.pair.fixed, self.pair.moving].map(|tile| tile.outline.circumradius());
        let reach = 1.2 * (circles[0] + circles[1]);
        self.space.half_size.map(|half| half.min(reach))
    }

    pub fn state(&self, id: usize) -> Option<&'a State> {
        self.states.iter().find(|state| state.id == id)
    }

    /// The classes of states, the lowest first.
    pub fn classes(&self) -> Vec<Class<'a>> {
        let mut classes: BTreeMap<usize, Class> = BTreeMap::new();
        for state in self.states {
            let entry = classes
                .entry(state.class)
                .or_insert(Class { state, copies: 0 });
            entry.copies += 1;
            if self.distance_from_bound(state) < self.distance_from_bound(entry.state) - 1e-9 {
                entry.state = state;
            }
        }
        let mut classes: Vec<_> = classes.into_values().collect();
        classes.sort_by(|a, b| a.state.energy.total_cmp(&b.state.energy));
        classes
    }

    /// Distance of a state from the bound configuration (m).
    fn distance_from_bound(&self, state: &State) -> f64 {
        self.space.distance(&state.configuration, &self.bound)
    }

    /// Class of a place; `None` for `Free`.
    pub fn class_of(&self, place: Place) -> Option<usize> {
        match place {
            Place::State(id) => self.state(id).map(|state| state.class),
            Place::Free => None,
        }
    }

    /// The way out of each class over its lowest barrier, the deepest class first; only those with
    /// a pathway.
    pub fn main_escapes(&self) -> Vec<&'a Barrier> {
        self.classes()
            .into_iter()
            .filter_map(|class| {
                let from = Place::State(class.state.id);
                self.escapes.iter().flatten().find(|b| b.from == from)
            })
            .filter(|barrier| barrier.pathway.len() > 1)
            .collect()
    }

    /// All barriers, the escapes among them.
    pub fn all_barriers(&self) -> impl Iterator<Item = &'a Barrier> {
        self.escapes.iter().flatten().chain(self.barriers)
    }

    /// The way from far away into the bound state nearest to the bound configuration.
    pub fn docking(&self) -> Option<Pathway> {
        self.docked().map(|(_, pathway)| pathway)
    }

    /// The bound state nearest to the bound configuration and the way from far away into it.
    pub fn docked(&self) -> Option<(&'a State, Pathway)> {
        let bound = |place: Place| match place {
            Place::State(id) => self
                .state(id)
                .filter(|state| state.kind == StateKind::Bound),
            Place::Free => None,
        };
        let ways = self.all_barriers().filter_map(|barrier| {
            if barrier.pathway.len() < 2 {
                return None;
            }
            match (barrier.from, barrier.to) {
                (Place::Free, to) => Some((bound(to)?, barrier.pathway.clone())),
                (from, Place::Free) => Some((bound(from)?, reversed(&barrier.pathway))),
                _ => None,
            }
        });
        ways.min_by(|(a, _), (b, _)| {
            self.distance_from_bound(a)
                .total_cmp(&self.distance_from_bound(b))
        })
    }

    /// The marker of a place.
    pub fn mark_of(&self, place: Place) -> Mark {
        match place {
            Place::Free => Mark::Free,
            Place::State(id) => self
                .state(id)
                .map_or(Mark::Misbound, |state| state.kind.into()),
        }
    }

    /// What a place is called on a picture.
    pub fn name_of(&self, place: Place) -> String {
        match place {
            Place::Free => "free".into(),
            Place::State(id) => match self.state(id).map(|state| state.kind) {
                Some(StateKind::Bound) => format!("bound {id}"),
                _ => format!("misbound {id}"),
            },
        }
    }
}

/// A pathway walked the other way, its length counted from the new start.
fn reversed(pathway: &Pathway) -> Pathway {
    let length = pathway.last().map_or(0.0, |point| point.s);
    let turned = pathway.iter().rev();
    turned
        .map(|point| PathwayPoint {
            s: length - point.s,
            ..*point
        })
        .collect()
}
