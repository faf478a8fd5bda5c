//! Floods over the leaves of a subdivision.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::store::Store;

/// The leaves that contain either end of a query, with the lowest energy (J) known of the end in
/// them.
pub(super) struct Seeds {
    pub from: Vec<(u32, f64)>,
    pub to: Vec<(u32, f64)>,
}

/// What two floods that rise from the ends of a query find.
pub(super) struct Watershed {
    /// Leaves that keep the two floods apart: without them no chain of passable leaves joins the
    /// ends. Empty if none does anyway.
    pub divide: Vec<u32>,
    /// The chain of leaves over the lowest pass, from end to end, and its highest estimate (J).
    pub pass: Option<(f64, Vec<u32>)>,
}

const DRY: u8 = 0;
const FROM: u8 = 1;
const TO: u8 = 2;
const DIVIDE: u8 = 3;
const NONE: u32 = u32::MAX;

/// Lets two floods rise from the ends over the passable leaves, those with a lower bound of at
/// most `level`, in the order of their rank. A leaf at which one flood would meet the other stays
/// dry and becomes part of the divide: it lies at the top of the lowest pass that is left between
/// them (Meyer's flooding; Beucher and Meyer 1993).
pub(super) fn watershed(store: &Store, seeds: &Seeds, level: f64) -> Watershed {
    let ranks = if level < f64::INFINITY {
        store.by_energy()
    } else {
        store.by_overlap()
    };
    let mut flood = Flood {
        store,
        ranks,
        level,
        label: vec![DRY; store.len()],
        parent: vec![NONE; store.len()],
        queued: vec![0; store.len()],
        queue: BinaryHeap::new(),
        waiting: [0; 3],
        highest: f64::NEG_INFINITY,
    };
    for (ids, side) in [(&seeds.from, FROM), (&seeds.to, TO)] {
        for &(id, energy) in ids.iter().filter(|seed| store.lower(seed.0) <= level) {
            flood.push(energy, id, side, NONE);
        }
    }
    flood.rise()
}

struct Flood<'a> {
    store: &'a Store,
    ranks: &'a [f64],
    level: f64,
    label: Vec<u8>,
    parent: Vec<u32>,
    /// The sides of the floods that have a leaf in the queue as one to spread to: once is enough,
    /// as its rank is the same from everywhere.
    queued: Vec<u8>,
    queue: BinaryHeap<Reverse<(u64, u32, u8, u32)>>,
    /// Entries of each flood in the queue. When one has none left the floods cannot meet any more.
    waiting: [usize; 3],
    /// Highest estimate (J) on the way so far.
    highest: f64,
}

impl Flood<'_> {
    fn push(&mut self, rank: f64, id: u32, side: u8, before: u32) {
        self.queue.push(Reverse((ordered(rank), id, side, before)));
        self.waiting[usize::from(side)] += 1;
    }

    fn rise(mut self) -> Watershed {
        let mut divide = Vec::new();
        let mut pass = None;
        while self.waiting[usize::from(FROM)] > 0 && self.waiting[usize::from(TO)] > 0 {
            let Some(Reverse((rank, id, side, before))) = self.queue.pop() else {
                break;
            };
            self.waiting[usize::from(side)] -= 1;
            let label = self.label[id as usize];
            if label == side || label == DIVIDE {
                continue;
            }
            self.highest = self.highest.max(if before == NONE {
                unordered(rank)
            } else {
                self.store.leaf(id).known.estimate
            });
            let Some(meeting) = self.meeting(id, side) else {
                self.label[id as usize] = side;
                self.parent[id as usize] = before;
                self.spread(id, side);
                continue;
            };
            self.label[id as usize] = DIVIDE;
            divide.push(id);
            if pass.is_none() {
                pass = Some((self.highest, self.chain(before, id, meeting, side)));
            }
        }
        Watershed { divide, pass }
    }

    /// A leaf of the other flood that this one touches, or itself, if it belongs to both.
    fn meeting(&self, id: u32, side: u8) -> Option<u32> {
        let other = FROM + TO - side;
        let belongs = |n: u32| self.label[n as usize] == other;
        if belongs(id) {
            return Some(id);
        }
        let around = &self.store.leaf(id).neighbours;
        around.iter().copied().find(|&n| belongs(n))
    }

    fn spread(&mut self, id: u32, side: u8) {
        let store = self.store;
        for &n in &store.leaf(id).neighbours {
            if self.label[n as usize] == DRY
                && self.queued[n as usize] & side == 0
                && store.lower(n) <= self.level
            {
                self.queued[n as usize] |= side;
                self.push(self.ranks[n as usize], n, side, id);
            }
        }
    }

    /// The chain of leaves from end to end over the leaf `id`, which one flood reaches from
    /// `before` and the other one from `meeting`.
    fn chain(&self, before: u32, id: u32, meeting: u32, side: u8) -> Vec<u32> {
        let mut chain = trace(&self.parent, before);
        chain.reverse();
        chain.push(id);
        let rest = if meeting == id {
            self.parent[id as usize]
        } else {
            meeting
        };
        chain.extend(trace(&self.parent, rest));
        if side == TO {
            chain.reverse();
        }
        chain
    }
}

fn trace(parent: &[u32], mut id: u32) -> Vec<u32> {
    let mut chain = Vec::new();
    while id != NONE {
        chain.push(id);
        id = parent[id as usize];
    }
    chain
}

/// The least level (J) at which a chain of touching leaves with lower bounds of at most that level
/// joins the ends: no free path between them stays below it. Infinite where no chain does.
pub(super) fn least_level(store: &Store, seeds: &Seeds) -> f64 {
    let mut seen = vec![false; store.len()];
    let mut goal = vec![false; store.len()];
    for &(id, _) in &seeds.to {
        goal[id as usize] = true;
    }
    let mut queue = BinaryHeap::new();
    for &(id, _) in &seeds.from {
        seen[id as usize] = true;
        queue.push(Reverse((ordered(store.lower(id)), id)));
    }
    let mut level = f64::NEG_INFINITY;
    while let Some(Reverse((lower, id))) = queue.pop() {
        level = level.max(unordered(lower));
        if goal[id as usize] {
            return level;
        }
        for &n in &store.leaf(id).neighbours {
            if !std::mem::replace(&mut seen[n as usize], true) {
                queue.push(Reverse((ordered(store.lower(n)), n)));
            }
        }
    }
    f64::INFINITY
}

/// A number ordered like the float.
fn ordered(x: f64) -> u64 {
    let bits = x.to_bits();
    if bits >> 63 == 1 {
        !bits
    } else {
        bits | 1 << 63
    }
}

/// The float with that number.
fn unordered(number: u64) -> f64 {
    f64::from_bits(if number >> 63 == 1 {
        number ^ 1 << 63
    } else {
        !number
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_keep_their_order_as_numbers() {
        let floats = [
            f64::NEG_INFINITY,
            -3.5,
            -1e-300,
            0.0,
            2e-8,
            7.0,
            f64::INFINITY,
        ];
        assert!(floats.map(ordered).is_sorted());
        assert_eq!(floats.map(|x| unordered(ordered(x))), floats);
    }
}
