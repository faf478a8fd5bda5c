//! Kinds of states: groups of states that symmetries map onto each other.

use ordered_float::OrderedFloat;

use crate::results::{Proportion, SAME_ENERGY, State, StateKind};
use tiles::order::Order;

/// The letters of the kinds of states, in the given order: `A` is the bond, then come the traps,
/// deepest first, `B`, `C`, ... `Z`, `AA`, ... Kinds of equal depth (such as the mirror twins of a
/// slid bond) share a letter: `B`, `B'`, `B''`, as do all contacts that count as the bond.
pub(super) fn names(kinds: &[Kind]) -> Vec<String> {
    let mut names = vec![String::new(); kinds.len()];
    let mut traps: Vec<usize> = (0..kinds.len()).filter(|&k| !kinds[k].is_bond()).collect();
    let energy = |k: usize| kinds[k].first().energy;
    traps.order_by_key(|&k| OrderedFloat(energy(k)));
    let as_deep = |&a: &usize, &b: &usize| energy(b) - energy(a) <= SAME_ENERGY * energy(a).abs();
    for (twins, rank) in traps.chunk_by(as_deep).zip(1..) {
        // Among them the order of the states counts, independent of rounding of their energies.
        let mut twins = twins.to_vec();
        twins.sort_unstable();
        for (primes, k) in twins.into_iter().enumerate() {
            names[k] = letters(rank) + &"'".repeat(primes);
        }
    }
    let bonds = (0..kinds.len()).filter(|&k| kinds[k].is_bond());
    for (primes, bond) in bonds.enumerate() {
        names[bond] = letters(0) + &"'".repeat(primes);
    }
    names
}

/// `A` to `Z`, `AA`, `AB` and so on.
fn letters(rank: usize) -> String {
    let last = char::from(b'A' + (rank % 26) as u8);
    match rank / 26 {
        0 => last.to_string(),
        before => letters(before - 1) + &last.to_string(),
    }
}

/// States that the symmetries of the two tiles and the exchange of equal tiles map onto each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind<'a> {
    /// The one closest to the bound configuration first; never empty.
    pub states: &'a [State],
}

impl<'a> Kind<'a> {
    /// The representative state: the one closest to the bound configuration.
    pub fn first(&self) -> &'a State {
        &self.states[0]
    }

    /// Whether it is the bond.
    pub fn is_bond(&self) -> bool {
        self.first().kind == StateKind::Bond
    }

    /// How many states it has.
    pub fn copies(&self) -> usize {
        self.states.len()
    }

    /// Share of the far starts that end in any of them; of zero starts if they were not counted.
    pub fn captured(&self) -> Proportion {
        let counted = || self.states.iter().filter_map(|state| state.capture);
        let of = counted().map(|capture| capture.of).next().unwrap_or(0);
        Proportion::new(counted().map(|capture| capture.count).sum(), of)
    }
}
