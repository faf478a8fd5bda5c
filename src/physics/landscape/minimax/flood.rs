//! Flood fill over the leaves of a subdivision.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::level::{Seeds, ordered};
use super::store::Store;

/// The result of a flood from one end of a query to the other.
pub(super) struct Watershed {
    /// Leaves that separate the two ends: without them, no chain of passable leaves joins the ends.
    /// Empty if no chain does anyway.
    pub divide: Vec<u32>,
    /// The chain of leaves over the lowest pass, from end to end, and its highest estimate (J).
    pub pass: Option<(f64, Vec<u32>)>,
    /// Number of flooded leaves, including those taken back.
    pub flooded: usize,
}

/// Flags of a leaf in a flood: joined to the other end below the divide,
const BEYOND: u8 = 1;
/// in the divide,
const DIVIDE: u8 = 2;
/// holds the other end,
const GOAL: u8 = 4;
/// or cannot be passed below the level.
const BARRED: u8 = 8;

/// Stands for the previous leaf of a start of the flood and of an untouched leaf.
const NONE: u32 = u32::MAX;
const DRY: u32 = u32::MAX - 1;

/// A leaf crossed by a known path counts as passable, whatever its midpoint suggests, if the path
/// lies below the level by more than this factor times the distance of the leaf's lower bound below
/// the path. Larger leaves contain more than the path, and a flood would leak through.
const SETTLED: f64 = 16.0;

/// A leaf's data for a flood. Values used together are stored together, because floods are limited
/// by memory latency.
struct Ground {
    rank: f64,
    /// The leaf from which the flood touched it first.
    before: u32,
    state: u8,
}

/// A leaf to spread to: its rank, its number, and the previous leaf, compared in this order.
type Entry = Reverse<(u64, u32, u32)>;

/// A flood that rises from one end over the passable leaves, those with a lower bound of at most
/// `level`, in the order of their rank.
///
/// After it spills over the lowest remaining pass it runs down the other side. When it reaches the
/// other end there, or the track of an earlier spill, the highest leaf on its path (the last at
/// which it rose) becomes part of the divide, and everything flooded since is taken back: it lies
/// beyond. The divide is the one at which two floods from both ends would meet (Meyer's flooding;
/// Beucher and Meyer 1993), but beyond it only the paths down to the end are examined: there are
/// many states with low passes, and their basins are small.
struct Flood<'a> {
    store: &'a Store,
    ground: Vec<Ground>,
    /// Leaves that hold the other end, and the energy (J) known of it there, by their numbers.
    goals: Vec<(u32, f64)>,
    queue: BinaryHeap<Entry>,
    /// The leaves flooded, one after the other.
    steps: Vec<u32>,
    /// The highest rank so far, and the step in which it was reached.
    top: u64,
    summit: usize,
    found: Watershed,
}

/// The leaves that separate the ends of a query below a level (J), where `known` leaves can be
/// passed at an energy (J). If the divide has more than `most` leaves (at least one), those of the
/// lowest passes are returned.
pub(super) fn watershed(
    store: &Store,
    seeds: &Seeds,
    (level, known): (f64, &[(u32, f64)]),
    most: usize,
) -> Watershed {
    let mut flood = Flood::new(store, seeds, level, known);
    while flood.found.divide.len() < most {
        let Some(Reverse((rank, id, before))) = flood.queue.pop() else {
            break;
        };
        // Leaves that were taken back need no processing.
        if flood.ground[id as usize].before == before {
            flood.step(rank, id);
        }
    }
    flood.found
}

impl<'a> Flood<'a> {
    fn new(store: &'a Store, seeds: &Seeds, level: f64, known: &[(u32, f64)]) -> Self {
        let ranks = if level < f64::INFINITY {
            &store.by_energy
        } else {
            &store.by_overlap
        };
        let ground = |(lower, rank): (&f64, &f64)| Ground {
            rank: *rank,
            before: DRY,
            state: if *lower <= level { 0 } else { BARRED },
        };
        let mut ground: Vec<Ground> = store.lowers.iter().zip(ranks).map(ground).collect();
        for &(id, energy) in known {
            let settled = energy + SETTLED * (energy - store.lower(id));
            if settled < level {
                let rank = &mut ground[id as usize].rank;
                *rank = rank.min(settled);
            }
        }
        let mut flood = Self {
            store,
            ground,
            goals: seeds.to.clone(),
            queue: BinaryHeap::new(),
            steps: Vec::new(),
            top: 0,
            summit: 0,
            found: Watershed {
                divide: Vec::new(),
                pass: None,
                flooded: 0,
            },
        };
        flood
            .goals
            .sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for &(id, _) in &seeds.to {
            flood.ground[id as usize].state |= GOAL;
        }
        for &(id, energy) in &seeds.from {
            let ground = &mut flood.ground[id as usize];
            if ground.state & BARRED == 0 && ground.before == DRY {
                ground.before = NONE;
                flood.queue.push(Reverse((ordered(energy), id, NONE)));
            }
        }
        flood
    }

    fn step(&mut self, rank: u64, id: u32) {
        if rank >= self.top {
            (self.top, self.summit) = (rank, self.steps.len());
        }
        self.steps.push(id);
        self.found.flooded += 1;
        if self.state(id) & GOAL != 0 {
            self.divide(id, None);
        } else if let Some(beyond) = self.beyond(id) {
            self.divide(id, Some(beyond));
        } else {
            self.spread(id);
        }
    }

    fn state(&self, id: u32) -> u8 {
        self.ground[id as usize].state
    }

    /// The known energy (J) of the other end in a leaf that holds it.
    fn goal(&self, id: u32) -> f64 {
        self.goals[self.goals.partition_point(|goal| goal.0 < id)].1
    }

    /// A leaf beside this one that is joined to the other end no higher than the flood is.
    fn beyond(&self, id: u32) -> Option<u32> {
        let around = self.store.neighbours(id).iter().copied();
        around
            .filter(|&n| self.state(n) & (BEYOND | GOAL) != 0)
            .find(|&n| match self.state(n) & (BEYOND | DIVIDE | BARRED) {
                0 => ordered(self.goal(n)) <= self.top,
                joined => joined == BEYOND,
            })
    }

    fn spread(&mut self, id: u32) {
        let store = self.store;
        for &n in store.neighbours(id) {
            let ground = &mut self.ground[n as usize];
            if ground.before != DRY || ground.state & (DIVIDE | BARRED) != 0 {
                continue;
            }
            ground.before = id;
            let rank = if ground.state & GOAL != 0 {
                self.goal(n)
            } else {
                ground.rank
            };
            self.queue.push(Reverse((ordered(rank), n, id)));
        }
    }

    /// Takes back everything flooded since the summit when the flood reaches this leaf, which holds
    /// the other end or touches the leaf `beyond`.
    fn divide(&mut self, id: u32, beyond: Option<u32>) {
        if self.found.pass.is_none() {
            self.found.pass = Some(self.chain(id, beyond));
        }
        let store = self.store;
        let summit = self.steps[self.summit];
        for &gone in &self.steps[self.summit..] {
            self.ground[gone as usize].state |= BEYOND;
            for &n in store.neighbours(gone) {
                let before = &mut self.ground[n as usize].before;
                if *before == gone {
                    *before = DRY;
                }
            }
        }
        let state = &mut self.ground[summit as usize].state;
        *state = *state & !BEYOND | DIVIDE;
        self.steps.truncate(self.summit);
        self.found.divide.push(summit);
    }

    /// The chain of leaves from end to end, and its highest estimate (J). It reaches the other end
    /// itself only while nothing else is beyond.
    fn chain(&self, id: u32, beyond: Option<u32>) -> (f64, Vec<u32>) {
        let parents = std::iter::successors(Some(id), |&id| {
            Some(self.ground[id as usize].before).filter(|before| *before != NONE)
        });
        let mut chain: Vec<u32> = parents.collect();
        chain.reverse();
        chain.extend(beyond);
        let end = chain[chain.len() - 1];
        let inner = chain.iter().skip(1).filter(|id| **id != end);
        let highest = inner
            .map(|&id| self.store.leaf(id).known.estimate)
            .fold(self.goal(end), f64::max);
        (highest, chain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::ConfigurationSpace;
    use crate::landscape::minimax::lower::Assessment;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// The minimax rank over chains of passable leaves from end to end that avoid some leaves, by
    /// Dijkstra's algorithm; the ends count with their energies.
    fn minimax(store: &Store, seeds: &Seeds, level: f64, off: &[u32]) -> Option<f64> {
        let passable = |id: u32| store.lower(id) <= level && !off.contains(&id);
        let goal = |id: u32| seeds.to.iter().find(|seed| seed.0 == id).map(|seed| seed.1);
        let rank = |id: u32| goal(id).unwrap_or(store.by_energy[id as usize]);
        let mut best = vec![f64::INFINITY; store.len()];
        let mut queue = BinaryHeap::new();
        for &(id, energy) in seeds.from.iter().filter(|seed| passable(seed.0)) {
            best[id as usize] = energy;
            queue.push((Reverse(ordered(energy)), id));
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
        let (mut joined, mut single) = (0, 0);
        for seed in 0..6 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut known = |least: f64| {
                let lower = rng.random_range(least..1.0);
                Assessment {
                    lower,
                    estimate: rng.random_range(lower..1.5),
                    overlap: 0.0,
                    axis: rng.random_range(0..3),
                }
            };
            let mut store = Store::new(&space);
            let keys = Store::first_keys().into_iter();
            store.fill(&keys.map(|key| (key, known(0.0))).collect::<Vec<_>>());
            let seeds = Seeds {
                from: vec![(3, f64::NEG_INFINITY)],
                to: vec![(900, 0.1), (500, 0.2)],
            };
            let mut level = 0.8;
            for round in 0..40 {
                let all = watershed(&store, &seeds, (level, &[]), usize::MAX);
                let lowest = minimax(&store, &seeds, level, &[]);
                assert_eq!(all.pass.is_some(), lowest.is_some());
                assert_eq!(minimax(&store, &seeds, level, &all.divide), None);
                let few = watershed(&store, &seeds, (level, &[]), 12);
                assert_eq!(few.divide, all.divide[..few.divide.len()]);
                let Some((_, chain)) = all.pass else {
                    continue;
                };
                joined += 1;
                let (end, inner) = (chain[chain.len() - 1], &chain[1..chain.len() - 1]);
                assert!(chain[0] == 3 && [500, 900].contains(&end));
                for pair in chain.windows(2) {
                    assert!(store.neighbours(pair[0]).contains(&pair[1]));
                }
                let rank = |id: &u32| store.by_energy[*id as usize];
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
        assert!(joined > 60 && single > 0, "{joined} {single}");
    }
}
