//! The certifier: one subdivision of the configuration space that serves many queries.

use super::ends::Ends;
use super::lower::Assessment;
use super::proved::Proofs;
use super::store::{Key, Store};
use super::upper::ProvedPath;
use super::ways::Ways;
use crate::budget::{Allowance, Budget, Ended};
use crate::configuration::{Configuration, ConfigurationSpace};
use crate::contact::Contact;
use crate::landscape::bounded::Bounded;
use crate::landscape::results::Uncertified;
use crate::parallel;
use crate::potential::CellBounds;

/// A pathway's energy is bounded to within this fraction of the tolerance.
pub(super) const SHARPNESS: f64 = 0.05;

/// Halvings of a leaf, one after the other, in one round.
const HALVINGS: usize = 3;

/// Number of first cells and known pathways processed between two checks of the remaining effort.
/// It does not depend on the number of threads, so the results do not either.
const AT_ONCE: usize = 64;

/// Certifies barriers of one landscape. Each query reuses what earlier ones found out about the
/// landscape.
pub struct Certifier<'a> {
    pub(super) bounded: Bounded<'a>,
    pub(super) store: Store,
    pub(super) ends: Ends,
    pub(super) assessed: usize,
    budget: Budget,
    /// Pathways that were proved in advance, or are known not to be provable.
    foreseen: Vec<Foreseen>,
    pub(super) proofs: Proofs,
    ways: Ways,
}

/// A pathway, the tolerance (J) of its proof, and the outcome.
struct Foreseen {
    path: Vec<Configuration>,
    tolerance: f64,
    proved: Option<ProvedPath>,
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
        let mut certifier = Self {
            bounded: Bounded::new(bounds, contact, space),
            store: Store::new(space),
            ends: Ends::default(),
            assessed: 0,
            budget: Budget::new(allowed),
            foreseen: Vec::new(),
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

    /// The reason to stop here, if there is one.
    pub fn ended(&mut self) -> Option<Ended> {
        self.bounded.pay(&mut self.budget);
        self.budget.ended()
    }

    /// Proves known pathways in parallel, which sequential queries cannot; each to the tolerance
    /// (J) of its later query. Results of an earlier call are discarded; pathways left when the
    /// effort is spent are proved by the queries.
    pub fn foresee(&mut self, paths: &[(Configuration, Vec<Configuration>, f64)]) {
        self.foreseen.clear();
        for paths in paths.chunks(AT_ONCE) {
            if self.ended().is_some() {
                return;
            }
            let bounded = &self.bounded;
            let foreseen = parallel::map(paths, |(from, known, tolerance)| {
                let path = from_its_start(*from, known);
                Foreseen {
                    proved: known_path(bounded, &path, *tolerance),
                    path,
                    tolerance: *tolerance,
                }
            });
            self.foreseen.extend(foreseen);
        }
    }

    /// The result of proving a known pathway for a query with a tolerance (J).
    pub(super) fn known_path(&self, path: &[Configuration], tolerance: f64) -> Option<ProvedPath> {
        let is_it = |known: &&Foreseen| known.tolerance == tolerance && known.path == path;
        match self.foreseen.iter().find(is_it) {
            Some(known) => known.proved.clone(),
            None => known_path(&self.bounded, path, tolerance),
        }
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

    /// Subdivides leaves, and their parts as long as these may be passed at `level` (J); returns
    /// how many leaves could be subdivided.
    pub(super) fn subdivide(&mut self, ids: &[u32], level: f64) -> usize {
        let divided: Vec<_> = parallel::map(ids, |&id| {
            let leaf = self.store.leaf(id);
            self.parts(&leaf.key, &leaf.known, level)
        });
        let mut count = 0;
        for (&id, (parts, assessed)) in ids.iter().zip(&divided) {
            if *assessed > 0 {
                self.store.replace(id, parts);
                self.assessed += assessed;
                count += 1;
            }
        }
        count
    }

    /// The parts of a leaf that are not blocked, and how many cells were assessed to find them: 0
    /// if the leaf is too small to be halved.
    fn parts(&self, key: &Key, known: &Assessment, level: f64) -> (Vec<(Key, Assessment)>, usize) {
        let mut parts = vec![(*key, *known)];
        let mut assessed = 0;
        for _ in 0..HALVINGS {
            let mut smaller = Vec::new();
            for (key, known) in parts {
                let halves = key.halves(known.axis).filter(|_| known.lower <= level);
                let Some(halves) = halves else {
                    smaller.push((key, known));
                    continue;
                };
                assessed += 2;
                smaller.extend(halves.into_iter().filter_map(|half| {
                    let part = self.bounded.assess(&self.store.cell(&half))?;
                    Some((half, part.within(&known)))
                }));
            }
            parts = smaller;
        }
        (parts, assessed)
    }
}

/// A known pathway, its start included.
pub(super) fn from_its_start(from: Configuration, known: &[Configuration]) -> Vec<Configuration> {
    let others = known.iter().filter(|q| **q != from);
    std::iter::once(&from).chain(others).copied().collect()
}

fn known_path(bounded: &Bounded, path: &[Configuration], tolerance: f64) -> Option<ProvedPath> {
    let proved = bounded.prove(path, SHARPNESS * tolerance, f64::INFINITY);
    proved.ok()
}
