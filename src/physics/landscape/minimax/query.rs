//! One query: the search for a pathway, and for the proof that no pathway is much lower.

use super::certifier::{Certifier, SHARPNESS, from_its_start};
use super::ends::far_end;
use super::flood::watershed;
use super::level::{Seeds, least_level};
use super::proved::Goal;
use super::upper::ProvedPath;
use super::{Bracket, CertifyError, Effort, End};
use crate::configuration::Configuration;
use crate::interruption;
use crate::landscape::results::SaddleBounds;

/// Leaves subdivided in one round: at least this many, and this fraction of those that the query
/// added. A fraction of all leaves would give too much weight to the first guesses, which are the
/// worst, when many queries share a store.
const SPLITS: usize = 256;
const SPLIT_SHARE: usize = 16;

/// Leaves subdivided between two checks of the remaining effort.
const BATCH: usize = 512;

/// Units of work of a flood for each existing leaf, and for each flooded one.
const LEAF: u64 = 2;
const FLOODED: u64 = 50;

/// A new pathway is searched for if the pass lies below the best one by the first fraction of the
/// tolerance, and accepted if it is lower by the second.
const WORTHWHILE: f64 = 0.25;
const GAIN: f64 = 0.1;

impl From<&End> for Goal {
    fn from(end: &End) -> Self {
        let place = end.configuration().copied();
        Self {
            free: place.is_none(),
            places: place.into_iter().collect(),
        }
    }
}

impl Certifier<'_> {
    /// Brackets the minimax energy from `from` to `to`. `known` is a pathway between them, if one
    /// is known; it need not be exactly free, as it is lifted off contact where it touches.
    ///
    /// # Errors
    /// If an end is not free or not on the table.
    pub fn bracket(
        &mut self,
        from: &Configuration,
        to: &End,
        known: &[Configuration],
        effort: &Effort,
    ) -> Result<Bracket, CertifyError> {
        self.run(from, &to.into(), known, effort)
    }

    /// Brackets the minimax energy from `from` to the first of the `goals` or to tiles far apart.
    /// `known` is a pathway to one of them, its end included, if one is known.
    ///
    /// # Errors
    /// If the start or a goal is not free or not on the table.
    pub fn escape(
        &mut self,
        from: &Configuration,
        goals: &[Configuration],
        known: &[Configuration],
        effort: &Effort,
    ) -> Result<Bracket, CertifyError> {
        let places = goals.to_vec();
        self.run(from, &Goal { places, free: true }, known, effort)
    }

    /// The lower bound (J) of paths between two ends implied by everything proved so far.
    pub fn proved(&self, from: &Configuration, to: &End) -> f64 {
        self.proofs.least(from, &to.into())
    }

    fn run(
        &mut self,
        from: &Configuration,
        to: &Goal,
        known: &[Configuration],
        effort: &Effort,
    ) -> Result<Bracket, CertifyError> {
        for end in std::iter::once(from).chain(&to.places) {
            if !self.bounded.space.contains(end) {
                return Err(CertifyError::OffTheTable(*end));
            }
            let contact = self.bounded.contact;
            if contact.is_some_and(|contact| !contact.is_free(end)) {
                return Err(CertifyError::NotFree(*end));
            }
        }
        let bracket = Query::new(self, *from, to, effort, known).run();
        let end = bracket.pathway.last();
        self.proofs.add(from, to, &bracket.bounds, end);
        Ok(bracket)
    }
}

struct Query<'q, 'a> {
    certifier: &'q mut Certifier<'a>,
    from: Configuration,
    to: &'q Goal,
    effort: Effort,
    assessed_before: usize,
    leaves_before: usize,
    /// Energy (J) that every path reaches, because of its ends and of earlier proofs.
    floor: f64,
    best: Option<ProvedPath>,
    improved: bool,
    caged: bool,
    rounds: usize,
    /// Whether earlier proofs suffice.
    is_known: bool,
    /// Whether floods rise from the far end, because it lies higher and its basin is smaller.
    from_behind: bool,
}

impl<'q, 'a> Query<'q, 'a> {
    pub fn new(
        certifier: &'q mut Certifier<'a>,
        from: Configuration,
        to: &'q Goal,
        effort: &Effort,
        known: &[Configuration],
    ) -> Self {
        let value = |q: &Configuration| certifier.bounded.value(q).0;
        let mut floor = value(&from);
        let end = to.only().map_or(f64::NEG_INFINITY, value);
        let from_behind = end > floor;
        floor = floor.max(end);
        let proved = certifier.proofs.least(&from, to);
        floor = floor.max(proved);
        let mut query = Self {
            from,
            to,
            effort: *effort,
            assessed_before: certifier.assessed,
            leaves_before: certifier.store.len(),
            floor,
            best: None,
            improved: false,
            caged: false,
            rounds: 0,
            is_known: false,
            from_behind,
            certifier,
        };
        query.best = query
            .joined_to_the_ends(known)
            .and_then(|path| query.certifier.known_path(&path, effort.tolerance));
        if let Some(best) = &query.best {
            query.certifier.note_way(best);
        }
        query.is_known = query.level() <= proved;
        query
    }

    /// Searches until the bracket is narrow enough or the effort is spent.
    pub fn run(mut self) -> Bracket {
        while self.level() > self.floor {
            let level = self.level();
            let seeds = self.seeds();
            let known = self.certifier.passable();
            let store = &self.certifier.store;
            let most = SPLITS.max((store.len() - self.leaves_before) / SPLIT_SHARE);
            let found = watershed(store, &seeds, (level, &known), most);
            let (leaves, flooded) = (store.len() as u64, found.flooded as u64);
            self.certifier.spend(leaves * LEAF + flooded * FLOODED);
            let Some((pass, mut chain)) = found.pass else {
                self.caged = self.best.is_none();
                break;
            };
            if self.from_behind {
                chain.reverse();
            }
            let mut to_divide = found.divide;
            if pass < level + (1.0 - WORTHWHILE) * self.effort.tolerance {
                match self.improve(&chain) {
                    Ok(()) => continue,
                    Err(blamed) => {
                        to_divide.extend(blamed);
                        to_divide.sort_unstable();
                        to_divide.dedup();
                    }
                }
            }
            if self.spent() || self.subdivide(&to_divide, level) == 0 {
                break;
            }
            self.rounds += 1;
        }
        self.conclude()
    }

    /// The energy (J) that is to be proved a lower bound of the barrier.
    fn level(&self) -> f64 {
        self.best
            .as_ref()
            .map_or(f64::INFINITY, |path| path.upper - self.effort.tolerance)
    }

    fn cells(&self) -> usize {
        self.certifier.assessed - self.assessed_before
    }

    fn spent(&mut self) -> bool {
        interruption::check();
        self.cells() >= self.effort.cells || self.certifier.ended().is_some()
    }

    fn subdivide(&mut self, ids: &[u32], level: f64) -> usize {
        let mut count = 0;
        for batch in ids.chunks(BATCH) {
            count += self.certifier.subdivide(batch, level);
            if self.spent() {
                break;
            }
        }
        count
    }

    /// Tries to prove a lower pathway along a chain of leaves; otherwise returns the leaves that
    /// prevent it.
    fn improve(&mut self, chain: &[u32]) -> Result<(), Vec<u32>> {
        let (path, owners) = self.path_along(chain);
        let ceiling = self.level() + (1.0 - GAIN) * self.effort.tolerance;
        let sharpness = SHARPNESS * self.effort.tolerance;
        match self.certifier.bounded.prove(&path, sharpness, ceiling) {
            Ok(proved) if proved.upper <= ceiling || self.best.is_none() => {
                self.certifier.note_way(&proved);
                self.best = Some(proved);
                self.improved = true;
                Ok(())
            }
            Ok(_) => Err(Vec::new()),
            Err(point) => {
                let stretch = point.saturating_sub(1)..(point + 1).min(owners.len());
                Err(owners[stretch].to_vec())
            }
        }
    }

    /// A polyline along a chain of leaves: from end to end through the leaves' centres and the
    /// midpoints of the intersections of consecutive ones. Each point comes with its leaf.
    fn path_along(&self, chain: &[u32]) -> (Vec<Configuration>, Vec<u32>) {
        let store = &self.certifier.store;
        let cell = |id: u32| store.cell(&store.leaf(id).key);
        let mut path = vec![(self.from, chain[0])];
        for pair in chain.windows(2) {
            path.push((store.between(pair[0], pair[1]), pair[1]));
            path.push((cell(pair[1]).centre, pair[1]));
        }
        let last = chain[chain.len() - 1];
        if chain.len() > 1 {
            path.pop();
        }
        let cell = cell(last);
        let inside = self.to.places.iter().find(|q| cell.contains(q)).copied();
        let space = self.certifier.bounded.space;
        let end = inside.or_else(|| far_end(space, &cell).filter(|_| self.to.free));
        path.extend(end.map(|end| (end, last)));
        path.into_iter().unzip()
    }

    /// A known pathway, from end to end; `None` if it does not lead to the end.
    fn joined_to_the_ends(&self, known: &[Configuration]) -> Option<Vec<Configuration>> {
        let last = known.last()?;
        let mut path = from_its_start(self.from, known);
        if !self.is_end(last) {
            path.push(*self.to.only()?);
        }
        Some(path)
    }

    /// Whether a pathway may end here.
    fn is_end(&self, q: &Configuration) -> bool {
        self.to.places.contains(q) || self.to.free && self.certifier.bounded.space.is_far(q)
    }

    /// The leaves that hold either end, first that from which floods rise.
    fn seeds(&mut self) -> Seeds {
        let Certifier {
            store,
            bounded,
            ends,
            ..
        } = &mut *self.certifier;
        let Seeds { from, to } = ends.seeds(store, bounded, &self.from, self.to);
        if self.from_behind {
            Seeds { from: to, to: from }
        } else {
            Seeds { from, to }
        }
    }

    fn conclude(mut self) -> Bracket {
        let lower = if self.is_known {
            self.floor
        } else {
            let seeds = self.seeds();
            least_level(&self.certifier.store, &seeds).max(self.floor)
        };
        let (cells, rounds) = (self.cells(), self.rounds);
        let (upper, saddle, pathway) = match self.best {
            Some(path) => (Some(path.upper), Some(path.peak), path.points),
            None => (None, None, Vec::new()),
        };
        Bracket {
            bounds: SaddleBounds {
                lower: lower.is_finite().then_some(lower),
                upper,
                caged: self.caged,
            },
            pathway,
            saddle,
            improved: self.improved,
            cells,
            rounds,
        }
    }
}
