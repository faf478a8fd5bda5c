//! The lowest level at which the ends of a query are connected; energies as ordered numbers.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::store::Store;

/// The leaves that contain either end of a query.
pub(super) struct Seeds<'a> {
    pub from: Vec<u32>,
    /// Those with places where it may end, ascending.
    pub to: Vec<u32>,
    /// If it may also end with the tiles far apart: for each leaf, the energy (J) where they are, NaN
    /// if they are nowhere so.
    pub far: Option<&'a [f64]>,
}

impl Seeds<'_> {
    /// The energy (J) of the other end in a leaf that holds it; minus infinity for a place, from which
    /// a flood may rise as well.
    pub fn goal(&self, id: u32) -> Option<f64> {
        if self.to.binary_search(&id).is_ok() {
            return Some(f64::NEG_INFINITY);
        }
        let far = self.far.map(|far| far[id as usize]);
        far.filter(|energy| !energy.is_nan())
    }
}

/// The lowest level (J) at which a chain of adjacent leaves with lower bounds of at most that level
/// joins the ends: no free path between them stays below it. Infinite if there is no chain. With the
/// number of leaves met.
pub(super) fn least_level(store: &Store, seeds: &Seeds) -> (f64, usize) {
    let mut seen = vec![false; store.len()];
    let mut queue = BinaryHeap::new();
    for &id in &seeds.from {
        seen[id as usize] = true;
        queue.push(Reverse((ordered(store.lower(id)), id)));
    }
    let mut level = f64::NEG_INFINITY;
    let mut met = 0;
    while let Some(Reverse((lower, id))) = queue.pop() {
        met += 1;
        level = level.max(unordered(lower));
        if seeds.goal(id).is_some() {
            return (level, met);
        }
        for &n in store.neighbours(id) {
            if !std::mem::replace(&mut seen[n as usize], true) {
                queue.push(Reverse((ordered(store.lower(n)), n)));
            }
        }
    }
    (f64::INFINITY, met)
}

/// A number ordered like the float.
pub(super) fn ordered(x: f64) -> u64 {
    let bits = x.to_bits();
    if bits >> 63 == 1 {
        !bits
    } else {
        bits | 1 << 63
    }
}

/// The float with that number.
pub(super) fn unordered(number: u64) -> f64 {
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
