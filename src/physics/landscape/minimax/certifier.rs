//! The certifier: one subdivision of the configuration space that serves many queries.

use super::ends::Ends;
use super::landscape::Landscape;
use super::lower::Assessment;
use super::proved::Proofs;
use super::query::{Goal, Query, SHARPNESS};
use super::store::{Key, Store};
use super::upper::ProvedPath;
use super::ways::Ways;
use super::{Bracket, CertifyError, Effort, End, Progress};
use crate::budget::{Allowance, Budget, Ended};
use crate::configuration::{Configuration, ConfigurationSpace};
use crate::contact::Contact;
use crate::interruption;
use crate::landscape::Uncertified;
use crate::parallel;
use crate::potential::bounds::CellBounds;

/// Halvings of a leaf, one after the other, in one round.
const HALVINGS: usize = 3;

/// First cells and known pathways that are dealt with between two looks at what is left of the work: not
/// by how many threads, so that these decide nothing.
const AT_ONCE: usize = 64;

/// Certifies barriers of one landscape. What one query finds out about the landscape serves the
/// next ones.
pub struct Certifier<'a> {
    pub(super) landscape: Landscape<'a>,
    pub(super) store: Store,
    pub(super) ends: Ends,
    pub(super) assessed: usize,
    budget: Budget,
    /// Pathways that were proved ahead, or that it is known cannot be.
    foreseen: Vec<Foreseen>,
    pub(super) proofs: Proofs,
    ways: Ways,
}

/// A pathway, the tolerance (J) of its proof, and what came of that.
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
        let mut certifier = Self::untried(bounds, contact, space, Allowance::UNLIMITED);
        certifier.assess_first(usize::MAX);
        certifier
    }

    /// The same, for all of whose queries together so much may be spent: no less than the bounds over
    /// the first, large cells take, which of very many magnets may be much.
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
        let mut certifier = Self::untried(bounds, contact, space, allowed);
        certifier.assess_first(AT_ONCE);
        match certifier.ended() {
            Some(ended) => Err(Uncertified::Ended(ended)),
            None => Ok(certifier),
        }
    }

    fn untried(
        bounds: &'a dyn CellBounds,
        contact: Option<&'a Contact>,
        space: &'a ConfigurationSpace,
        allowed: Allowance,
    ) -> Self {
        Self {
            landscape: Landscape::new(bounds, contact, space),
            store: Store::new(space),
            ends: Ends::default(),
            assessed: 0,
            budget: Budget::new(allowed),
            foreseen: Vec::new(),
            proofs: Proofs::default(),
            ways: Ways::default(),
        }
    }

    /// Assesses the first cells, so many at once, unless the work ends before: then it is good for
    /// nothing.
    fn assess_first(&mut self, at_once: usize) {
        let keys = Store::first_keys();
        let mut first = Vec::new();
        for keys in keys.chunks(at_once.min(keys.len())) {
            let (landscape, store) = (&self.landscape, &self.store);
            first.extend(parallel::flat_map(keys, |key| {
                interruption::check();
                Some((*key, landscape.assess(&store.cell(key))?))
            }));
            self.assessed += keys.len();
            if self.ended().is_some() {
                return;
            }
        }
        self.store.fill(&first);
    }

    /// Counts work besides that on bounds.
    pub(super) fn spend(&mut self, units: u64) {
        self.budget.spend(units);
    }

    /// What ends the work here, if anything does.
    pub fn ended(&mut self) -> Option<Ended> {
        self.landscape.bounds.pay(&mut self.budget);
        self.budget.ended()
    }

    /// Proves known pathways from their starts on, each to the tolerance (J) with which it is going to
    /// be asked for: side by side, which queries one after the other cannot. What was proved so
    /// before is forgotten; what comes after the work has ended is left to the queries.
    pub fn foresee(&mut self, paths: &[(Configuration, Vec<Configuration>, f64)]) {
        self.foreseen.clear();
        for paths in paths.chunks(AT_ONCE) {
            if self.ended().is_some() {
                return;
            }
            let landscape = &self.landscape;
            let foreseen = parallel::map(paths, |(from, known, tolerance)| {
                let path = from_its_start(*from, known);
                Foreseen {
                    proved: known_path(landscape, &path, *tolerance),
                    path,
                    tolerance: *tolerance,
                }
            });
            self.foreseen.extend(foreseen);
        }
    }

    /// What comes of proving a known pathway for a query with a tolerance (J).
    pub(super) fn known_path(&self, path: &[Configuration], tolerance: f64) -> Option<ProvedPath> {
        let is_it = |known: &&Foreseen| known.tolerance == tolerance && known.path == path;
        match self.foreseen.iter().find(is_it) {
            Some(known) => known.proved.clone(),
            None => known_path(&self.landscape, path, tolerance),
        }
    }

    /// Brackets the minimax energy from `from` to `to`. `known` is a pathway between them, if one
    /// is known; it need not be exactly free, as it is lifted off contact where it touches.
    ///
    /// # Errors
    /// Where an end is not free or not on the table.
    pub fn bracket(
        &mut self,
        from: &Configuration,
        to: &End,
        known: &[Configuration],
        effort: &Effort,
    ) -> Result<Bracket, CertifyError> {
        self.bracket_watched(from, to, known, effort, &mut |_| true)
    }

    /// The same, telling `watch` of every round; where it returns false the query stops with what
    /// is known.
    ///
    /// # Errors
    /// Where an end is not free or not on the table.
    pub fn bracket_watched(
        &mut self,
        from: &Configuration,
        to: &End,
        known: &[Configuration],
        effort: &Effort,
        watch: &mut dyn FnMut(&Progress) -> bool,
    ) -> Result<Bracket, CertifyError> {
        self.landscape.check(from)?;
        if let Some(to) = to.configuration() {
            self.landscape.check(to)?;
        }
        Ok(self.run(from, &(*to).into(), known, effort, watch))
    }

    /// Brackets the minimax energy from `from` to the first of the `goals` or to tiles far apart.
    /// `known` is a pathway to one of them, its end included, if one is known.
    ///
    /// # Errors
    /// Where the start or a goal is not free or not on the table.
    pub fn escape(
        &mut self,
        from: &Configuration,
        goals: &[Configuration],
        known: &[Configuration],
        effort: &Effort,
    ) -> Result<Bracket, CertifyError> {
        for end in std::iter::once(from).chain(goals) {
            self.landscape.check(end)?;
        }
        Ok(self.run(from, &Goal::Any(goals), known, effort, &mut |_| true))
    }

    /// What follows from all that was proved so far (J): no path between two ends is lower.
    pub fn proved(&self, from: &Configuration, to: &End) -> f64 {
        self.proofs.least(from, &(*to).into())
    }

    fn run(
        &mut self,
        from: &Configuration,
        to: &Goal,
        known: &[Configuration],
        effort: &Effort,
        watch: &mut dyn FnMut(&Progress) -> bool,
    ) -> Bracket {
        let bracket = Query::new(self, *from, to, effort, known).run(watch);
        let end = bracket.pathway.last();
        self.proofs.add(from, to, &bracket.bounds, end);
        bracket
    }

    /// Takes note of a proved pathway, from end to end.
    pub(super) fn note_way(&mut self, points: &[Configuration]) {
        if self.ways.include(points) {
            return;
        }
        let proof = self.landscape.proof();
        let way: Vec<_> = points.iter().map(|q| (*q, proof.value(q).0)).collect();
        let start = self.ends.holding(&self.store, &points[0]);
        self.ways.add(&self.store, start, &way);
    }

    /// The leaves that proved pathways run through and at which energy (J) they do, where their
    /// middles would not tell that they can be passed.
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

    /// Subdivides leaves, going on where a part may still be passed at `level` (J); returns how
    /// many of them could be subdivided.
    pub(super) fn subdivide(&mut self, ids: &[u32], level: f64) -> usize {
        let divided: Vec<_> = parallel::map(ids, |&id| {
            interruption::check();
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
                    let part = self.landscape.assess(&self.store.cell(&half))?;
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

fn known_path(landscape: &Landscape, path: &[Configuration], tolerance: f64) -> Option<ProvedPath> {
    interruption::check();
    let proof = landscape.proof();
    proof.prove(path, SHARPNESS * tolerance, f64::INFINITY).ok()
}
