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
/// most `level`, in the order of their estimated energies. A leaf at which one flood would meet
/// the other stays dry and becomes part of the divide: it lies at the top of the lowest pass that
/// is left between them (Meyer's flooding; Beucher and Meyer 1993).
pub(super) fn watershed(store: &Store, seeds: &Seeds, level: f64) -> Watershed {
    let mut label = vec![DRY; store.len()];
    let mut parent = vec![NONE; store.len()];
    let mut goal = vec![f64::NEG_INFINITY; store.len()];
    let mut queue = BinaryHeap::new();
    let passable = |id: u32| store.leaf(id).known.lower <= level;
    for (ids, side) in [(&seeds.from, FROM), (&seeds.to, TO)] {
        for &(id, energy) in ids.iter().filter(|seed| passable(seed.0)) {
            queue.push(Reverse((ordered(energy), id, side, NONE)));
            if side == TO {
                goal[id as usize] = energy;
            }
        }
    }
    let mut divide = Vec::new();
    let mut pass = None;
    let mut highest = f64::NEG_INFINITY;
    while let Some(Reverse((_, id, side, before))) = queue.pop() {
        if label[id as usize] == side || label[id as usize] == DIVIDE {
            continue;
        }
        let leaf = store.leaf(id);
        highest = highest.max(if before == NONE {
            goal[id as usize]
        } else {
            leaf.known.estimate
        });
        let other = if side == FROM { TO } else { FROM };
        let meeting = if label[id as usize] == other {
            // Only a leaf that holds both ends is reached from both sides.
            Some(id)
        } else {
            leaf.neighbours
                .iter()
                .copied()
                .find(|&n| label[n as usize] == other)
        };
        if let Some(meeting) = meeting {
            label[id as usize] = DIVIDE;
            divide.push(id);
            if pass.is_none() {
                let mut chain = trace(&parent, before);
                chain.reverse();
                chain.push(id);
                if meeting != id {
                    chain.extend(trace(&parent, meeting));
                }
                if side == TO {
                    chain.reverse();
                }
                pass = Some((highest, chain));
            }
            continue;
        }
        label[id as usize] = side;
        parent[id as usize] = before;
        for &n in &leaf.neighbours {
            if label[n as usize] == DRY && passable(n) {
                queue.push(Reverse((
                    ordered(if level == f64::INFINITY {
                        store.leaf(n).known.overlap
                    } else {
                        key(&store.leaf(n).known)
                    }),
                    n,
                    side,
                    id,
                )));
            }
        }
    }
    Watershed { divide, pass }
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
        queue.push(Reverse((ordered(store.leaf(id).known.lower), id)));
    }
    let mut level = f64::NEG_INFINITY;
    while let Some(Reverse((_, id))) = queue.pop() {
        let leaf = store.leaf(id);
        level = level.max(leaf.known.lower);
        if goal[id as usize] {
            return level;
        }
        for &n in &leaf.neighbours {
            if !std::mem::replace(&mut seen[n as usize], true) {
                queue.push(Reverse((ordered(store.leaf(n).known.lower), n)));
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

fn key(known: &super::lower::Assessment) -> f64 {
    static A: std::sync::OnceLock<f64> = std::sync::OnceLock::new();
    let alpha = *A.get_or_init(|| std::env::var("ALPHA").map_or(0.3, |a| a.parse().unwrap()));
    known.estimate + alpha * (known.estimate - known.lower)
}
