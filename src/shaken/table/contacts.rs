//! Bonds, traps, other contacts and clusters at one instant.

use std::collections::{BTreeMap, BTreeSet};

use petgraph::unionfind::UnionFind;

use super::crowd::Crowd;
use crate::rigid::{Mover, Pose, Two};
use tiles::tile::outline::cross;

/// Tiles with a clearance below this (m, for the paper's tile) count as touching.
pub const HELD_WITHIN: f64 = 2e-3;

/// The kind of a stable contact.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
pub enum Tie {
    /// The intended contact.
    Bond,
    /// Any other stable contact of its own.
    Trap,
    /// A stable contact that follows from bonds to a common neighbour, as that of the corners in a
    /// sheet, or that is weaker than [`WEAK`] of the shallowest bond.
    Contact,
}

/// A contact with less than this share of the shallowest bond's energy is no trap.
pub const WEAK: f64 = 0.005;

impl Tie {
    /// Its name in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bond => "bond",
            Self::Trap => "trap",
            Self::Contact => "contact",
        }
    }
}

/// A stable contact of two tiles.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Held {
    /// Their numbers, the lesser first.
    pub tiles: [usize; 2],
    /// The kind of contact.
    pub tie: Tie,
    /// Their energy (J).
    pub energy: f64,
}

/// All stable contacts, in order. Bonds are recognised by the tiles' pose. Any other pair in contact
/// is held if its energy, including the kinetic energy of their relative motion, is below 0: as a
/// trap, unless it follows from bonds or is weak.
pub fn held(crowd: &Crowd, movers: &[Mover], near: impl Iterator<Item = Two>) -> Vec<Held> {
    let mut found: Vec<Held> = near.filter_map(|two| tie(crowd, movers, two)).collect();
    found.sort_by_key(|held| held.tiles);
    let mut partners: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for [a, b] in found
        .iter()
        .filter(|it| it.tie == Tie::Bond)
        .map(|it| it.tiles)
    {
        partners.entry(a).or_default().insert(b);
        partners.entry(b).or_default().insert(a);
    }
    let have_a_neighbour = |[a, b]: [usize; 2]| {
        let both = partners.get(&a).zip(partners.get(&b));
        both.is_some_and(|(a, b)| !a.is_disjoint(b))
    };
    for held in found.iter_mut().filter(|it| it.tie == Tie::Trap) {
        let is_weak = held.energy > WEAK * crowd.shallowest_bond();
        if is_weak || have_a_neighbour(held.tiles) {
            held.tie = Tie::Contact;
        }
    }
    found
}

fn tie(crowd: &Crowd, movers: &[Mover], two: Two) -> Option<Held> {
    let tiles = [two.first, two.second].map(|k| &movers[k]);
    let [first, second] = tiles;
    let couple = crowd.couple(first.kind, second.kind).0;
    let q = Pose::of(crowd, first).to(&second.motion(crowd).configuration);
    let pair = [two.first.min(two.second), two.first.max(two.second)];
    if couple.bonds.iter().any(|rule| rule.holds(&q)) {
        let energy = couple.pull(&q).0;
        return Some(Held {
            tiles: pair,
            tie: Tie::Bond,
            energy,
        });
    }
    let within = couple.contact.scaled(HELD_WITHIN);
    if couple.contact.clearance_bound(&q) > within {
        return None;
    }
    let energy = couple.pull(&q).0;
    let is_held = || energy + inner(crowd, tiles) < 0.0 && couple.contact.clearance(&q) <= within;
    is_held().then_some(Held {
        tiles: pair,
        tie: Tie::Trap,
        energy,
    })
}

/// Kinetic energy (J) of two tiles about their common centre of mass, without that of their common
/// rotation: `m v^2 / 2 + (I w^2 + J z^2) / 2 - L^2 / (2 (m r^2 + I + J))`, m the reduced mass, r
/// and v the distance of the centres and its change, w and z the turning rates and L the angular
/// momentum.
fn inner(crowd: &Crowd, tiles: [&Mover; 2]) -> f64 {
    let [first, second] = tiles;
    let [a, b] = tiles.map(|it| crowd.kinds[it.kind].body);
    let mass = a.mass * b.mass / (a.mass + b.mass);
    let r = (second.place - first.place).xy();
    let v = (second.velocity - first.velocity).xy();
    let [w, z] = tiles.map(|it| it.velocity.z);
    let whole = 0.5 * (mass * v.norm_squared() + a.inertia * w * w + b.inertia * z * z);
    let turn = mass * cross(r, v) + a.inertia * w + b.inertia * z;
    let together = mass * r.norm_squared() + a.inertia + b.inertia;
    (whole - 0.5 * turn * turn / together).max(0.0)
}

/// The cluster of connected tiles that each tile belongs to, named by the first of its tiles.
pub fn cluster_of_each(tiles: usize, held: &[Held]) -> Vec<usize> {
    let mut sets = UnionFind::<usize>::new(tiles);
    for held in held {
        sets.union(held.tiles[0], held.tiles[1]);
    }
    let mut first = vec![None; tiles];
    let labels = sets.into_labeling().into_iter().enumerate();
    labels
        .map(|(tile, label)| *first[label].get_or_insert(tile))
        .collect()
}

/// The sizes of all clusters of connected tiles, including single tiles, in descending order.
pub fn clusters(tiles: usize, held: &[Held]) -> Vec<usize> {
    let mut sizes = vec![0; tiles];
    for cluster in cluster_of_each(tiles, held) {
        sizes[cluster] += 1;
    }
    sizes.retain(|size| *size > 0);
    sizes.sort_unstable_by(|a, b| b.cmp(a));
    sizes
}
