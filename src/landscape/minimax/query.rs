//! One query: the search for a pathway, and for the proof that no pathway is much lower.

use ordered_float::OrderedFloat;

use super::certifier::{Certifier, SHARPNESS};
use super::ends::{Held, far_end};
use super::flood::{FLOODED, Flood};
use super::level::{Seeds, least_level};
use super::proved::Proofs;
use super::upper::{ProvedPath, Sharpening};
use super::{Bracket, Question};
use crate::bounded::Bounded;
use crate::results::SaddleBounds;
use tiles::configuration::Configuration;
use tiles::interruption;
use tiles::order::Order;

/// Leaves subdivided in one round: at least this many, and this fraction of the cells that the query
/// gained. A fraction of all leaves would give too much weight to the first guesses, which are the
/// worst, when many queries share a store.
const SPLITS: usize = 256;
const SPLIT_SHARE: usize = 32;

/// A new pathway is searched for if the pass lies below the best one by the first fraction of the
/// tolerance, and accepted if it is lower by the second.
const WORTHWHILE: f64 = 0.25;
const GAIN: f64 = 0.1;

/// Without a known pathway, straight motions to so many of the nearest places are tried.
const NEAREST: usize = 4;

/// A query in progress.
pub(super) struct Query<'q> {
    question: &'q Question,
    /// Energy (J) that every path reaches, because of its ends and of earlier proofs.
    floor: f64,
    best: Option<ProvedPath>,
    improved: bool,
    caged: bool,
    /// Rounds of subdivision.
    pub rounds: usize,
    /// Cells assessed at the expense of this query,
    pub cells: usize,
    /// and those assessed because it asked for them, among others.
    pub gained: usize,
    /// Energy (J) that every path reaches because of this number of earlier proofs.
    proved: (usize, f64),
    held: Held,
    /// Whether nothing more can be done.
    is_over: bool,
    /// Whether floods rise from the far end, because it lies higher and its basin is smaller.
    from_behind: bool,
}

/// What a flood found.
pub(super) enum Found {
    /// No chain of leaves leads to the goal.
    NoWay,
    /// A lower pathway.
    Lower(ProvedPath),
    /// Leaves to subdivide.
    Divide(Vec<u32>),
}

impl<'q> Query<'q> {
    /// Begins a query: proves its known pathway, or a straight one, with at most these units of work.
    pub fn new(bounded: &Bounded, question: &'q Question, work: u64) -> Self {
        let value = |q: &Configuration| bounded.value(q).0;
        let start = value(&question.from);
        let end = question.to.only().map_or(f64::NEG_INFINITY, value);
        let mut query = Self {
            question,
            floor: start.max(end),
            best: None,
            improved: false,
            caged: false,
            rounds: 0,
            cells: 0,
            gained: 0,
            proved: (0, f64::NEG_INFINITY),
            held: Held::default(),
            is_over: false,
            from_behind: end > start,
        };
        let mut sharpening = Sharpening {
            tolerance: SHARPNESS * question.effort.tolerance,
            give_up: f64::INFINITY,
            work,
        };
        let mut proved = |path: &[Configuration]| bounded.prove(path, &mut sharpening).ok();
        let known = query.joined_to_the_ends(bounded);
        query.best = known.and_then(|path| proved(&path));
        if query.best.is_none() {
            let straight = query.straight(bounded);
            query.best = straight.iter().find_map(|path| proved(path));
            query.improved = query.best.is_some();
        }
        query
    }

    /// The best pathway, if one is proved.
    pub fn best(&self) -> Option<&ProvedPath> {
        self.best.as_ref()
    }

    /// The energy (J) that is to be proved a lower bound of the barrier.
    pub fn level(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |path| {
            path.upper - self.question.effort.tolerance
        })
    }

    /// Takes account of what is proved by now.
    pub fn learn(&mut self, proofs: &Proofs) {
        if self.proved.0 < proofs.count() {
            let proved = proofs.least(&self.question.from, &self.question.to);
            self.proved = (proofs.count(), proved);
            self.floor = self.floor.max(proved);
        }
    }

    /// Whether earlier proofs suffice.
    fn is_known(&self) -> bool {
        self.level() <= self.proved.1
    }

    /// Whether the bracket is narrow enough, or nothing more can be done.
    pub fn is_answered(&self) -> bool {
        self.is_over || self.level() <= self.floor
    }

    /// Whether its effort is spent.
    pub fn is_spent(&self) -> bool {
        self.cells >= self.question.effort.cells
    }

    /// Ends the query with the bounds known.
    pub fn give_up(&mut self) {
        self.is_over = true;
    }

    /// Ends the query because no free path leads to the goal: if none is known, the start is caged.
    pub fn has_no_way(&mut self) {
        self.caged = self.best.is_none();
        self.is_over = true;
    }

    /// Takes over a lower pathway.
    pub fn improve(&mut self, way: ProvedPath) {
        self.best = Some(way);
        self.improved = true;
    }

    /// Lets a flood rise over the leaves, of which those `known` can be passed at an energy (J);
    /// returns the number of leaves flooded and what was found. At most these units of work are
    /// spent on a pathway, and no more on leaves to subdivide.
    pub fn search(
        &mut self,
        certifier: &Certifier,
        known: &[(u32, f64)],
        work: u64,
    ) -> (usize, Found) {
        interruption::check();
        let store = &certifier.store;
        let level = self.level();
        let seeds = self.seeds(certifier);
        let mut flood = Flood::new(store, &seeds, level, known);
        flood.rise(SPLITS.max(self.gained / SPLIT_SHARE), work);
        let Some((pass, mut chain)) = flood.pass.take() else {
            return (flood.flooded, Found::NoWay);
        };
        if self.from_behind {
            chain.reverse();
        }
        let mut to_divide = flood.divide;
        if pass < level + (1.0 - WORTHWHILE) * self.question.effort.tolerance {
            match self.lower_way(certifier, &chain, work) {
                Ok(way) => return (flood.flooded, Found::Lower(way)),
                Err(blamed) => to_divide.extend(blamed),
            }
        }
        to_divide.sort_unstable();
        to_divide.dedup();
        (flood.flooded, Found::Divide(to_divide))
    }

    /// Tries to prove a lower pathway along a chain of leaves; otherwise returns the leaves that
    /// prevent it.
    fn lower_way(
        &self,
        certifier: &Certifier,
        chain: &[u32],
        work: u64,
    ) -> Result<ProvedPath, Vec<u32>> {
        let (path, owners) = self.path_along(certifier, chain);
        let tolerance = self.question.effort.tolerance;
        let ceiling = self.level() + (1.0 - GAIN) * tolerance;
        let bounded = &certifier.bounded;
        let mut sharpening = Sharpening {
            tolerance: SHARPNESS * tolerance,
            give_up: ceiling,
            work,
        };
        match bounded.prove(&path, &mut sharpening) {
            Ok(proved) if proved.upper <= ceiling || self.best.is_none() => Ok(proved),
            Ok(_) => Err(Vec::new()),
            Err(point) => {
                let stretch = point.saturating_sub(1)..(point + 1).min(owners.len());
                Err(owners[stretch].to_vec())
            }
        }
    }

    /// A polyline along a chain of leaves: from end to end through the leaves' centres and the
    /// midpoints of the intersections of consecutive ones. Each point comes with its leaf.
    fn path_along(&self, certifier: &Certifier, chain: &[u32]) -> (Vec<Configuration>, Vec<u32>) {
        let store = &certifier.store;
        let Question { from, to, .. } = self.question;
        let cell = |id: u32| store.cell(&store.leaf(id).key);
        let mut path = vec![(*from, chain[0])];
        for pair in chain.windows(2) {
            path.push((store.between(pair[0], pair[1]), pair[1]));
            path.push((cell(pair[1]).centre, pair[1]));
        }
        let last = chain[chain.len() - 1];
        if chain.len() > 1 {
            path.pop();
        }
        let cell = cell(last);
        let inside = to.places.iter().find(|q| cell.contains(q)).copied();
        let space = certifier.bounded.space;
        let end = inside.or_else(|| far_end(space, &cell).filter(|_| to.free));
        path.extend(end.map(|end| (end, last)));
        path.into_iter().unzip()
    }

    /// The known pathway, from end to end; `None` if it does not lead to the end.
    fn joined_to_the_ends(&self, bounded: &Bounded) -> Option<Vec<Configuration>> {
        let Question {
            from, to, known, ..
        } = self.question;
        let last = known.last()?;
        let others = known.iter().filter(|q| *q != from);
        let mut path: Vec<Configuration> = std::iter::once(from).chain(others).copied().collect();
        let is_end = to.places.contains(last) || to.free && bounded.space.is_far(last);
        if !is_end {
            path.push(*to.only()?);
        }
        Some(path)
    }

    /// Straight motions to the nearest places.
    fn straight(&self, bounded: &Bounded) -> Vec<[Configuration; 2]> {
        let Question { from, to, .. } = self.question;
        let mut places = to.places.clone();
        places.order_by_key(|q| OrderedFloat(bounded.space.distance(from, q)));
        places.truncate(NEAREST);
        places.into_iter().map(|place| [*from, place]).collect()
    }

    /// The leaves that hold either end, first that from which floods rise.
    fn seeds<'c>(&mut self, certifier: &'c Certifier) -> Seeds<'c> {
        let Question { from, to, .. } = self.question;
        let Certifier { ends, store, .. } = certifier;
        let mut seeds = ends.seeds(store, (from, to), &mut self.held);
        if self.from_behind {
            std::mem::swap(&mut seeds.from, &mut seeds.to);
        }
        seeds
    }

    /// The bracket as it is known.
    pub fn conclude(&mut self, certifier: &Certifier) -> Bracket {
        let lower = if self.is_known() {
            self.floor
        } else {
            let seeds = self.seeds(certifier);
            let (least, met) = least_level(&certifier.store, &seeds);
            certifier.bounded.count(FLOODED * met as u64);
            least.max(self.floor)
        };
        let best = self.best.take();
        let saddle = best.as_ref().map(|path| path.peak);
        Bracket {
            bounds: SaddleBounds {
                lower: lower.is_finite().then_some(lower),
                upper: best.as_ref().map(|path| path.upper),
                caged: self.caged,
            },
            pathway: best.map_or_else(Vec::new, |path| path.points),
            saddle,
            improved: self.improved,
            cells: self.cells,
            rounds: self.rounds,
        }
    }
}
