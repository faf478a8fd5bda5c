//! Floods over the leaves of a subdivision.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::level::{ordered, unordered};
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

/// What a flood knows of a leaf: which flood it belongs to, if any,
pub(super) const FROM: u8 = 1;
pub(super) const TO: u8 = 2;
/// whether it keeps the two apart,
pub(super) const DIVIDE: u8 = 4;
/// whether no path below the level may pass it,
pub(super) const BARRED: u8 = 8;
/// and, shifted by this, the floods that touch it: they have it in the queue as one to spread to.
pub(super) const TOUCHED: u8 = 4;
/// In place of a leaf, or of the time of a leaf that is dry.
pub(super) const NONE: u32 = u32::MAX >> 1;

/// A leaf to spread to: its rank, its number, the side, and the leaf before it. In this order they
/// decide which comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Entry(u128);

impl Entry {
    pub fn new(rank: f64, id: u32, side: u8, before: u32) -> Self {
        let from = u32::from(side == TO) << 31 | before;
        Self(u128::from(ordered(rank)) << 64 | u128::from(id) << 32 | u128::from(from))
    }

    pub fn rank(self) -> u64 {
        (self.0 >> 64) as u64
    }

    pub fn id(self) -> u32 {
        (self.0 >> 32) as u32
    }

    pub fn side(self) -> u8 {
        if self.0 as u32 >> 31 == 0 { FROM } else { TO }
    }

    pub fn before(self) -> u32 {
        self.0 as u32 & NONE
    }
}

/// What was done with an entry.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Deed {
    Nothing,
    Flooded,
    Divided,
}

/// An entry that was taken from the queue.
pub(super) struct Step {
    pub entry: Entry,
    pub deed: Deed,
    /// The highest rank so far.
    pub top: u64,
    /// The highest estimate (J) so far, or up to the first pass.
    pub highest: f64,
}

/// Two floods that rise from the ends over the passable leaves, those with a lower bound of at
/// most `level`, in the order of their rank. A leaf at which one flood would meet the other stays
/// dry and becomes part of the divide: it lies at the top of the lowest pass that is left between
/// them (Meyer's flooding; Beucher and Meyer 1993).
///
/// All steps are kept, so that the floods can fall again to where a subdivision of leaves makes a
/// difference (see `reflood`).
pub(super) struct Flood {
    pub level: f64,
    pub state: Vec<u8>,
    parent: Vec<u32>,
    /// The number of the step in which a leaf was flooded.
    pub time: Vec<u32>,
    pub queue: BinaryHeap<Reverse<Entry>>,
    pub steps: Vec<Step>,
    /// The steps in which a leaf was found to be in the divide.
    pub divided: Vec<u32>,
    pub pass: Option<(f64, Vec<u32>)>,
    /// Entries of each flood in the queue. When one has none left the floods cannot meet any more.
    pub waiting: [usize; 3],
}

impl Flood {
    /// Floods that have not risen yet.
    pub fn new(store: &Store, seeds: &Seeds, level: f64) -> Self {
        let mut flood = Self {
            level,
            state: Vec::new(),
            parent: Vec::new(),
            time: Vec::new(),
            queue: BinaryHeap::new(),
            steps: Vec::new(),
            divided: Vec::new(),
            pass: None,
            waiting: [0; 3],
        };
        flood.extend(store);
        for (ids, side) in [(&seeds.from, FROM), (&seeds.to, TO)] {
            for &(id, energy) in ids.iter().filter(|seed| store.lower(seed.0) <= level) {
                flood.push(Entry::new(energy, id, side, NONE));
            }
        }
        flood
    }

    /// Takes note of the leaves that were added to the store.
    pub fn extend(&mut self, store: &Store) {
        let fresh = &store.lowers()[self.state.len()..];
        let barred = |lower: &f64| if *lower <= self.level { 0 } else { BARRED };
        self.state.extend(fresh.iter().map(barred));
        self.parent.resize(store.len(), NONE);
        self.time.resize(store.len(), NONE);
    }

    pub fn push(&mut self, entry: Entry) {
        self.queue.push(Reverse(entry));
        self.waiting[usize::from(entry.side())] += 1;
    }

    /// The rank of each leaf.
    pub fn ranks<'s>(&self, store: &'s Store) -> &'s [f64] {
        if self.level < f64::INFINITY {
            store.by_energy()
        } else {
            store.by_overlap()
        }
    }

    /// Lets the floods rise. Of a divide of more than `most` leaves (at least one) those of the
    /// lowest passes are found.
    pub fn rise(&mut self, store: &Store, most: usize) -> Watershed {
        while self.waiting[usize::from(FROM)] > 0
            && self.waiting[usize::from(TO)] > 0
            && self.divided.len() < most
        {
            let Some(Reverse(entry)) = self.queue.pop() else {
                break;
            };
            self.waiting[usize::from(entry.side())] -= 1;
            self.step(store, entry);
        }
        let divide = self.divided.iter();
        Watershed {
            divide: divide
                .map(|&step| self.steps[step as usize].entry.id())
                .collect(),
            pass: self.pass.clone(),
        }
    }

    fn step(&mut self, store: &Store, entry: Entry) {
        let (id, side) = (entry.id(), entry.side());
        let number = self.steps.len() as u32;
        let mut step = match self.steps.last() {
            Some(last) => Step { ..*last },
            None => Step {
                entry,
                deed: Deed::Nothing,
                top: 0,
                highest: f64::NEG_INFINITY,
            },
        };
        step.entry = entry;
        step.deed = Deed::Nothing;
        step.top = step.top.max(entry.rank());
        if self.state[id as usize] & (side | DIVIDE) == 0 {
            if self.pass.is_none() {
                step.highest = step.highest.max(if entry.before() == NONE {
                    unordered(entry.rank())
                } else {
                    store.leaf(id).known.estimate
                });
            }
            if let Some(meeting) = self.meeting(store, id, side) {
                step.deed = Deed::Divided;
                self.state[id as usize] |= DIVIDE;
                self.divided.push(number);
                if self.pass.is_none() {
                    self.pass = Some((step.highest, self.chain(entry, meeting)));
                }
            } else {
                step.deed = Deed::Flooded;
                self.state[id as usize] |= side;
                self.parent[id as usize] = entry.before();
                self.time[id as usize] = number;
                self.spread(store, id, side);
            }
        }
        self.steps.push(step);
    }

    /// A leaf of the other flood that this one touches, or itself, if it belongs to both.
    fn meeting(&self, store: &Store, id: u32, side: u8) -> Option<u32> {
        let other = FROM + TO - side;
        let belongs = |n: u32| self.state[n as usize] & (other | DIVIDE) == other;
        if belongs(id) {
            return Some(id);
        }
        if self.state[id as usize] & other << TOUCHED == 0 {
            return None;
        }
        let around = &store.leaf(id).neighbours;
        around.iter().copied().find(|&n| belongs(n))
    }

    fn spread(&mut self, store: &Store, id: u32, side: u8) {
        let ranks = self.ranks(store);
        let not = FROM | TO | DIVIDE | BARRED | side << TOUCHED;
        for &n in &store.leaf(id).neighbours {
            if self.state[n as usize] & not == 0 {
                self.state[n as usize] |= side << TOUCHED;
                self.push(Entry::new(ranks[n as usize], n, side, id));
            }
        }
    }

    /// The chain of leaves from end to end over the leaf of an entry, which the other flood reaches
    /// from `meeting`.
    fn chain(&self, entry: Entry, meeting: u32) -> Vec<u32> {
        let id = entry.id();
        let mut chain = trace(&self.parent, entry.before());
        chain.reverse();
        chain.push(id);
        let rest = if meeting == id {
            self.parent[id as usize]
        } else {
            meeting
        };
        chain.extend(trace(&self.parent, rest));
        if entry.side() == TO {
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
