//! The data that pictures are drawn from, and the selection they show.

use ordered_float::OrderedFloat;

use super::marks::Mark;
use jobs::design::Design;
use physics::landscape::{Barrier, Catalogue, Kind, Pathway, Place, State, pathway};
use physics::order::Order;
use physics::potential::Interaction;
use physics::problem::Problem;
use physics::tile::Pair;

/// A pair of tiles with its results.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// Name of the design.
    pub name: &'a str,
    /// The interaction of the tiles.
    pub interaction: &'a Interaction,
    /// Their energy and contact.
    pub problem: &'a Problem,
    /// The tiles themselves.
    pub pair: &'a Pair,
    /// States and barriers; empty before an analysis.
    pub catalogue: &'a Catalogue,
}

impl<'a> Scene<'a> {
    /// The scene of a design.
    pub fn new(design: &'a Design, problem: &'a Problem, catalogue: &'a Catalogue) -> Self {
        Self {
            name: &design.name,
            interaction: &design.interaction,
            problem,
            pair: &design.pair,
            catalogue,
        }
    }

    /// All states.
    pub fn states(&self) -> &'a [State] {
        &self.catalogue.states
    }

    /// The state with an id.
    pub fn state(&self, id: usize) -> Option<&'a State> {
        self.states().iter().find(|state| state.id == id)
    }

    /// The kinds of states, the lowest first.
    pub fn kinds(&self) -> Vec<Kind<'a>> {
        let mut kinds: Vec<_> = self.catalogue.kinds().collect();
        kinds.order_by_key(|kind| OrderedFloat(kind.first().energy));
        kinds
    }

    /// Class of a place; `None` for `Free`.
    pub fn class_of(&self, place: Place) -> Option<usize> {
        match place {
            Place::State(id) => self.state(id).map(|state| state.class),
            Place::Free => None,
        }
    }

    /// The way out of each kind over its lowest barrier, the deepest kind first; only those with
    /// a pathway.
    pub fn main_escapes(&self) -> Vec<&'a Barrier> {
        let catalogue = self.catalogue;
        let escape = |kind: Kind| catalogue.escape_of_kind(self.problem, kind.first().id);
        let escapes = self.kinds().into_iter().filter_map(escape);
        escapes
            .filter(|barrier| barrier.pathway.len() > 1)
            .collect()
    }

    /// The barriers with a known path.
    pub fn barriers(&self) -> impl Iterator<Item = &'a Barrier> {
        self.catalogue
            .barriers
            .iter()
            .filter(|barrier| barrier.has_way())
    }

    /// The path from far away into the bond.
    pub fn docking(&self) -> Option<Pathway> {
        let way_out = self.catalogue.way_out_of_the_bond()?;
        (way_out.pathway.len() > 1).then(|| pathway::reversed(&way_out.pathway))
    }

    /// The marker of a place.
    pub fn mark_of(&self, place: Place) -> Mark {
        match place {
            Place::Free => Mark::Free,
            Place::State(id) => self.state(id).map_or(Mark::Trap, |state| state.kind.into()),
        }
    }

    /// The name of a place on a picture.
    pub fn name_of(&self, place: Place) -> String {
        self.catalogue.name_of(place)
    }

    /// The letters of a kind of states.
    pub fn letters(&self, kind: &Kind) -> String {
        self.catalogue.names()[kind.first().id].clone()
    }
}
