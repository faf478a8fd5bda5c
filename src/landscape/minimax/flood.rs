//! Flood fill over the leaves of a subdivision.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::level::{Seeds, ordered};
use super::store::Store;

/// Flags of a leaf in a flood: touched by a flooded leaf, or flooded,
const TOUCHED: u8 = 1;
/// joined to the other end below the divide,
const BEYOND: u8 = 2;
/// in the divide,
const DIVIDE: u8 = 4;
/// holds the other end,
const GOAL: u8 = 8;
/// or is known to be passable, whatever its midpoint suggests.
const KNOWN: u8 = 16;

/// A leaf crossed by a known path seems passable, whatever its midpoint suggests, if the path lies
/// below the level by more than this factor times the distance of the leaf's lower bound below the
/// path. Larger leaves contain more than the path, and a flood would leak through.
const MARGIN: f64 = 16.0;

/// Units of work for each flooded leaf.
pub(super) const FLOODED: u64 = 50;

/// Stands for the previous leaf of a start of the flood.
const NONE: u32 = u32::MAX;

/// A leaf to spread to: its rank, its number, and the previous leaf, compared in this order. One
/// number is compared without branches, which nothing could predict.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry(u128);

impl Entry {
    fn new(rank: f64, id: u32, before: u32) -> Self {
        Self(u128::from(ordered(rank)) << 64 | u128::from(id) << 32 | u128::from(before))
    }

    fn parts(self) -> (u64, u32, u32) {
        ((self.0 >> 64) as u64, (self.0 >> 32) as u32, self.0 as u32)
    }
}

/// A flood that rises from one end of a query over the passable leaves, those with a lower bound of
/// at most `level`, in the order of their rank.
///
/// After it spills over the lowest remaining pass it runs down the other side. When it reaches the
/// other end there, or the track of an earlier spill, the highest leaf on its path (the last at
/// which it rose) becomes part of the divide, and everything flooded since is taken back: it lies
/// beyond. The divide is the one at which two floods from both ends would meet (Meyer's flooding;
/// Beucher and Meyer 1993), but beyond it only the paths down to the end are examined: there are
/// many states with low passes, and their basins are small.
///
/// If it reaches the other end without rising above the level, the leaves on its path seem passable
/// at their midpoints as well, and none of them would keep the ends apart at any size; then the
/// largest of them are to be subdivided.
pub(super) struct Flood<'a> {
    store: &'a Store,
    level: f64,
    // What floods use most is stored side by side: they are limited by memory latency.
    state: Vec<u8>,
    /// The leaf from which the flood touched each leaf first, if it did.
    before: Vec<u32>,
    seeds: &'a Seeds<'a>,
    queue: BinaryHeap<Reverse<Entry>>,
    /// The leaves flooded, one after the other.
    steps: Vec<u32>,
    /// The highest rank so far, and the step in which it was reached.
    top: u64,
    summit: usize,
    /// Leaves that separate the two ends: without them, no chain of passable leaves joins the ends.
    /// Empty if no chain does anyway. The largest leaves of a chain that seems passable, if there is
    /// one.
    pub divide: Vec<u32>,
    /// The chain of leaves over the lowest pass, from end to end, and its highest estimate (J).
    pub pass: Option<(f64, Vec<u32>)>,
    /// Number of flooded leaves, including those taken back.
    pub flooded: usize,
}

impl<'a> Flood<'a> {
    /// A flood between the ends of a query below a level (J), where `known` leaves can be passed at
    /// an energy (J).
    pub fn new(store: &'a Store, seeds: &'a Seeds<'a>, level: f64, known: &[(u32, f64)]) -> Self {
        let mut flood = Self {
            store,
            level,
            state: seeds.far.map_or_else(|| vec![0; store.len()], goals),
            before: vec![0; store.len()],
            seeds,
            queue: BinaryHeap::new(),
            steps: Vec::new(),
            top: 0,
            summit: 0,
            divide: Vec::new(),
            pass: None,
            flooded: 0,
        };
        for &id in &seeds.to {
            flood.state[id as usize] |= GOAL;
        }
        for &(id, energy) in known {
            if energy + MARGIN * (energy - store.lower(id)) <= level {
                flood.state[id as usize] |= KNOWN;
            }
        }
        for &id in &seeds.from {
            if flood.is_dry(id) {
                flood.touch(id, NONE, f64::NEG_INFINITY);
            }
        }
        flood
    }

    /// Lets the flood rise until the ends are separated, or the divide has `most` leaves (at least
    /// one), those of the lowest passes. After these units of work it stops at the first pass.
    pub fn rise(&mut self, most: usize, work: u64) {
        let is_late = |flood: &Self| flood.pass.is_some() && flood.flooded as u64 * FLOODED > work;
        while self.divide.len() < most && !is_late(self) {
            let Some(Reverse(next)) = self.queue.pop() else {
                break;
            };
            let (rank, id, before) = next.parts();
            // Leaves that were taken back need no processing.
            if self.is(id, TOUCHED) && self.before[id as usize] == before {
                self.step(rank, id);
            }
        }
    }

    fn is(&self, id: u32, flags: u8) -> bool {
        self.state[id as usize] & flags != 0
    }

    /// Whether a leaf can be passed and is not touched.
    fn is_dry(&self, id: u32) -> bool {
        !self.is(id, TOUCHED | DIVIDE) && self.store.lower(id) <= self.level
    }

    fn touch(&mut self, id: u32, before: u32, rank: f64) {
        self.state[id as usize] |= TOUCHED;
        self.before[id as usize] = before;
        self.queue.push(Reverse(Entry::new(rank, id, before)));
    }

    fn rank(&self, id: u32) -> f64 {
        if self.is(id, KNOWN) {
            return f64::NEG_INFINITY;
        }
        let goal = self.is(id, GOAL).then(|| self.seeds.goal(id)).flatten();
        goal.unwrap_or_else(|| match self.level < f64::INFINITY {
            true => self.store.estimates[id as usize],
            false => self.store.by_overlap[id as usize],
        })
    }

    /// The highest rank of leaves that seem passable.
    fn passable(&self) -> u64 {
        ordered(match self.level < f64::INFINITY {
            true => self.level,
            false => f64::NEG_INFINITY,
        })
    }

    fn step(&mut self, rank: u64, id: u32) {
        if rank >= self.top {
            (self.top, self.summit) = (rank, self.steps.len());
        }
        self.steps.push(id);
        self.flooded += 1;
        if self.is(id, GOAL) {
            self.divide(id, None);
        } else if let Some(beyond) = self.beyond(id) {
            self.divide(id, Some(beyond));
        } else {
            let store = self.store;
            for &n in store.neighbours(id) {
                if self.is_dry(n) {
                    self.touch(n, id, self.rank(n));
                }
            }
        }
    }

    /// A leaf beside this one that is joined to the other end no higher than the flood is.
    fn beyond(&self, id: u32) -> Option<u32> {
        let is_joined = |n: &u32| match self.state[*n as usize] & (BEYOND | GOAL | DIVIDE) {
            GOAL => self.store.lower(*n) <= self.level && ordered(self.rank(*n)) <= self.top,
            joined => joined & (BEYOND | DIVIDE) == BEYOND,
        };
        self.store.neighbours(id).iter().copied().find(is_joined)
    }

    /// Takes back everything flooded since the summit when the flood reaches this leaf, which holds
    /// the other end or is beside the leaf `beyond`.
    fn divide(&mut self, id: u32, beyond: Option<u32>) {
        if self.pass.is_none() {
            self.pass = Some(self.chain(id, beyond));
        }
        if self.top <= self.passable() {
            self.divide_largest();
            return;
        }
        let store = self.store;
        let summit = self.steps[self.summit];
        for &gone in &self.steps[self.summit..] {
            self.state[gone as usize] |= BEYOND;
            for &n in store.neighbours(gone) {
                if self.before[n as usize] == gone {
                    self.state[n as usize] &= !TOUCHED;
                }
            }
        }
        let state = &mut self.state[summit as usize];
        *state = *state & !BEYOND | DIVIDE;
        self.steps.truncate(self.summit);
        self.divide.push(summit);
    }

    /// Makes the largest leaves of the chain all of the divide: none of them seems to keep the ends
    /// apart, and through these the flood most likely leaks.
    fn divide_largest(&mut self) {
        let chain = self.pass.iter().flat_map(|(_, chain)| chain).copied();
        let size = |id: u32| self.store.leaf(id).key.volume();
        let largest = chain.clone().map(size).fold(0.0, f64::max);
        self.divide.extend(chain.filter(|id| size(*id) >= largest));
        self.queue.clear();
    }

    /// The chain of leaves from end to end, and its highest estimate (J), without the leaves that are
    /// known to be passable. It reaches the other end itself only while nothing else is beyond.
    fn chain(&self, id: u32, beyond: Option<u32>) -> (f64, Vec<u32>) {
        let parents = std::iter::successors(Some(id), |&id| {
            Some(self.before[id as usize]).filter(|before| *before != NONE)
        });
        let mut chain: Vec<u32> = parents.collect();
        chain.reverse();
        chain.extend(beyond);
        let end = chain[chain.len() - 1];
        let is_open = |id: &&u32| **id != end && !self.is(**id, KNOWN);
        let inner = chain.iter().skip(1).filter(is_open);
        let highest = inner
            .map(|&id| self.store.leaf(id).known.estimate)
            .fold(self.rank(end), f64::max);
        (highest, chain)
    }
}

/// The flags of leaves of which some are far.
fn goals(far: &[f64]) -> Vec<u8> {
    let flag = |energy: &f64| if energy.is_nan() { 0 } else { GOAL };
    far.iter().map(flag).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use tiles::assessment::Assessment;
    use tiles::configuration::ConfigurationSpace;

    /// The minimax rank over chains of passable leaves from end to end that avoid some leaves, by
    /// Dijkstra's algorithm; the ends count with their energies.
    fn minimax(store: &Store, seeds: &Seeds, level: f64, off: &[u32]) -> Option<f64> {
        let passable = |id: u32| store.lower(id) <= level && !off.contains(&id);
        let goals = seeds.far.unwrap_or_default();
        let goal = |id: u32| Some(goals[id as usize]).filter(|energy| !energy.is_nan());
        let rank = |id: u32| goal(id).unwrap_or(store.estimates[id as usize]);
        let mut best = vec![f64::INFINITY; store.len()];
        let mut queue = BinaryHeap::new();
        for &id in seeds.from.iter().filter(|id| passable(**id)) {
            best[id as usize] = f64::NEG_INFINITY;
            queue.push((Reverse(ordered(f64::NEG_INFINITY)), id));
        }
        while let Some((_, id)) = queue.pop() {
            if goal(id).is_some() {
                return Some(best[id as usize]);
            }
            for &n in store.neighbours(id).iter().filter(|n| passable(**n)) {
                let over = best[id as usize].max(rank(n));
                if over < best[n as usize] {
                    best[n as usize] = over;
                    queue.push((Reverse(ordered(over)), n));
                }
            }
        }
        None
    }

    #[test]
    fn the_divide_keeps_the_ends_apart_and_the_pass_is_the_lowest() {
        let space = ConfigurationSpace {
            half_size: [1.0, 1.0],
            rho: 0.2,
            free_distance: 0.9,
        };
        let (mut joined, mut single, mut passable) = (0, 0, 0);
        for (seed, most) in (0..10).zip([1.5, 1.0].into_iter().cycle()) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut known = |least: f64| {
                let lower = rng.random_range(least..1.0);
                Assessment {
                    lower,
                    estimate: rng.random_range(lower..most),
                    overlap: 0.0,
                    axis: rng.random_range(0..3),
                }
            };
            let mut store = Store::new(&space);
            let keys = Store::first_keys().into_iter();
            store.fill(&keys.map(|key| (key, known(0.0))).collect::<Vec<_>>());
            let mut level = 0.8;
            for round in 0..40 {
                let mut far = vec![f64::NAN; store.len()];
                (far[500], far[900]) = (0.2, 0.1);
                let seeds = Seeds {
                    from: vec![3],
                    to: Vec::new(),
                    far: Some(&far),
                };
                let mut all = Flood::new(&store, &seeds, level, &[]);
                all.rise(usize::MAX, u64::MAX);
                let lowest = minimax(&store, &seeds, level, &[]);
                assert_eq!(all.pass.is_some(), lowest.is_some());
                if lowest.is_some_and(|lowest| lowest <= level) {
                    let size = |id: &u32| store.leaf(*id).key.volume();
                    let chain = &all.pass.as_ref().unwrap().1;
                    let is_largest = |id: &u32| chain.iter().all(|other| size(other) <= size(id));
                    assert!(!all.divide.is_empty() && all.divide.iter().all(is_largest));
                    passable += 1;
                } else {
                    assert_eq!(minimax(&store, &seeds, level, &all.divide), None);
                }
                let mut few = Flood::new(&store, &seeds, level, &[]);
                few.rise(12, u64::MAX);
                assert!(all.divide.starts_with(&few.divide));
                let Some((_, chain)) = all.pass else {
                    continue;
                };
                joined += 1;
                let (end, inner) = (chain[chain.len() - 1], &chain[1..chain.len() - 1]);
                assert!(chain[0] == 3 && [500, 900].contains(&end));
                for pair in chain.windows(2) {
                    assert!(store.neighbours(pair[0]).contains(&pair[1]));
                }
                let rank = |id: &u32| store.estimates[*id as usize];
                let energy = if end == 900 { 0.1 } else { 0.2 };
                let over = inner.iter().map(rank).fold(energy, f64::max);
                assert_eq!(Some(over), lowest);
                single += usize::from(few.divide.len() < 12);
                for id in few
                    .divide
                    .into_iter()
                    .filter(|id| ![3, 500, 900].contains(id))
                {
                    let whole = store.leaf(id).clone();
                    if let Some(halves) = whole.key.halves(whole.known.axis) {
                        let parts = halves.map(|key| (key, known(whole.known.lower)));
                        store.replace(&[(id, parts.to_vec())]);
                    }
                }
                level -= if round % 5 == 0 { 0.01 } else { 0.0 };
            }
        }
        assert!(
            joined > 60 && single > 0 && passable > 0,
            "{joined} {single} {passable}"
        );
    }
}
