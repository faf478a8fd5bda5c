//! The certifier: one subdivision of the configuration space that serves many queries.

use super::ends::Ends;
use super::proved::Proofs;
use super::store::{CellEntry, Store};
use super::upper::ProvedPath;
use super::ways::Ways;
use crate::bounded::Bounded;
use crate::results::Uncertified;
use tiles::budget::{Allowance, Budget, Ended};
use tiles::configuration::ConfigurationSpace;
use tiles::contact::Contact;
use tiles::parallel;
use tiles::potential::CellBounds;

/// A pathway's energy is bounded to within this fraction of the tolerance.
pub(super) const SHARPNESS: f64 = 0.05;

/// Number of first cells assessed between two checks of the remaining effort. It does not depend on
/// the number of threads, so the results do not either.
const AT_ONCE: usize = 64;

/// Certifies barriers of one landscape. Each query reuses what earlier ones found out about the
/// landscape.
pub struct Certifier<'a> {
    pub(super) bounded: Bounded<'a>,
    pub(super) store: Store,
    pub(super) ends: Ends,
    pub(super) assessed: usize,
    budget: Budget,
    pub(super) proofs: Proofs,
    ways: Ways,
}

impl<'a> Certifier<'a> {
    /// A certifier for the energy `bounds` over the configurations of `space` in which the tiles
    /// of `contact`, if any, do not overlap.
    pub fn new(
        bounds: &'a dyn CellBounds,
        contact: Option<&'a Contact>,
        space: &'a ConfigurationSpace,
    ) -> Self {
        let unlimited = Self::within(bounds, contact, space, Allowance::UNLIMITED);
        unlimited.expect("work without end")
    }

    /// The same with a limit on the effort of all queries together. The bounds over the first,
    /// large cells are always computed, which may take long for very many magnets.
    ///
    /// # Errors
    /// [`Uncertified::Unasked`] and [`Uncertified::Ended`].
    pub fn within(
        bounds: &'a dyn CellBounds,
        contact: Option<&'a Contact>,
        space: &'a ConfigurationSpace,
        allowed: Allowance,
    ) -> Result<Self, Uncertified> {
        if allowed.is_none() {
            return Err(Uncertified::Unasked);
        }
        Self::with(bounds, contact, space, Budget::new(allowed))
    }

    /// The same with what is left of a budget.
    ///
    /// # Errors
    /// [`Uncertified::Ended`].
    pub(crate) fn with(
        bounds: &'a dyn CellBounds,
        contact: Option<&'a Contact>,
        space: &'a ConfigurationSpace,
        budget: Budget,
    ) -> Result<Self, Uncertified> {
        let mut certifier = Self {
            bounded: Bounded::new(bounds, contact, space),
            store: Store::new(space),
            ends: Ends::default(),
            assessed: 0,
            budget,
            proofs: Proofs::default(),
            ways: Ways::default(),
        };
        let mut first = Vec::new();
        for keys in Store::first_keys().chunks(AT_ONCE) {
            let (bounded, store) = (&certifier.bounded, &certifier.store);
            first.extend(parallel::flat_map(keys, |key| {
                Some((*key, bounded.assess(&store.cell(key))?))
            }));
            certifier.assessed += keys.len();
            if let Some(ended) = certifier.ended() {
                return Err(Uncertified::Ended(ended));
            }
        }
        certifier.store.fill(&first);
        Ok(certifier)
    }

    /// Counts work besides that on bounds.
    pub(super) fn spend(&mut self, units: u64) {
        self.budget.spend(units);
    }

    /// Units of work for each of some queries that are served at the same time.
    pub(super) fn part_of(&self, queries: usize) -> u64 {
        self.budget.part_of(queries)
    }

    /// The reason to stop here, if there is one.
    pub fn ended(&mut self) -> Option<Ended> {
        self.bounded.pay(&mut self.budget);
        self.budget.ended()
    }

    /// Core-seconds spent of what was allowed at first.
    pub fn spent_of(&mut self, allowed: Allowance) -> f64 {
        self.bounded.pay(&mut self.budget);
        self.budget.spent_of(allowed)
    }

    /// What is left of the budget.
    pub(crate) fn into_budget(mut self) -> Budget {
        self.bounded.pay(&mut self.budget);
        self.budget
    }

    /// Records a proved pathway, from end to end.
    pub(super) fn note_way(&mut self, proved: &ProvedPath) {
        if self.ways.include(&proved.points) {
            return;
        }
        let way = proved.points.iter().copied();
        let way: Vec<_> = way.zip(proved.energies.iter().copied()).collect();
        let start = self.store.holding(&proved.points[0]);
        self.ways.add(&self.store, start, &way);
    }

    /// The leaves crossed by proved pathways, with the energy (J) there, if their midpoints would
    /// not show that they can be passed.
    pub(super) fn passable(&mut self) -> Vec<(u32, f64)> {
        let store = &self.store;
        let is_misjudged = |id: u32| store.leaf(id).known.is_overlapping();
        let leaves = self.ways.leaves(store);
        leaves.filter(|(id, _)| is_misjudged(*id)).collect()
    }

    /// Cells assessed so far, over all queries.
    pub fn assessed(&self) -> usize {
        self.assessed
    }

    /// Subdivides leaves by so many halvings, one after the other, as long as the parts may be passed
    /// at the leaf's level (J); returns for each how many cells were assessed: 0 if it is too small
    /// to be subdivided.
    pub(super) fn subdivide(&mut self, leaves: &[(u32, f64)], halvings: u32) -> Vec<usize> {
        let mut divided: Vec<(u32, Vec<CellEntry>)> =
            leaves.iter().map(|(id, _)| (*id, Vec::new())).collect();
        let mut assessed = vec![0; leaves.len()];
        let leaf = |id: u32| (self.store.leaf(id).key, self.store.leaf(id).known);
        let mut open: Vec<(usize, CellEntry)> = (0..leaves.len())
            .map(|place| (place, leaf(leaves[place].0)))
            .collect();
        for _ in 0..halvings {
            let mut halves = Vec::new();
            for (place, (key, known)) in open {
                let passable = known.lower <= leaves[place].1;
                let Some(pair) = key.halves(known.axis).filter(|_| passable) else {
                    divided[place].1.push((key, known));
                    continue;
                };
                assessed[place] += pair.len();
                halves.extend(pair.map(|half| (place, half, known)));
            }
            open = parallel::flat_map(&halves, |(place, half, whole)| {
                let part = self.bounded.assess(&self.store.cell(half))?;
                Some((*place, (*half, part.within(whole))))
            });
        }
        for (place, part) in open {
            divided[place].1.push(part);
        }
        let mut counts = assessed.iter();
        divided.retain(|_| counts.next().is_some_and(|assessed| *assessed > 0));
        self.store.replace(&divided);
        self.assessed += assessed.iter().sum::<usize>();
        assessed
    }
}
