//! How much deeper bonds are between whole tiles than between their two faces alone, updated while
//! words are exchanged between bonds.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::DMatrix;

use super::TileSet;
use super::axis::Met;
use super::matrix::Matrix;
use super::rests::{Rests, eastern, others};
use super::wiring::{TilePair, Wiring};
use physics::words::Word;

/// Larger numbers of words are not considered: the energies of every two faces are stored, by
/// sides.
const MOST_WORDS: usize = 128;

/// Factors by which the weight of wrong contacts may increase if this makes no bond deeper: a small
/// one if tiles need a second bond; a larger one if a single bond holds them, which is so deep that
/// no wrong contact below the gap does.
const PRICES: [f64; 2] = [1.1, 20.0];

/// The data of this computation.
pub struct Depths<'a> {
    /// The allowed factor on the weight of wrong contacts.
    pub price: f64,
    all: &'a Matrix,
    meetings: BTreeSet<TilePair>,
    /// The energies of every two faces, see [`Rests::table`].
    energies: [[DMatrix<f64>; 4]; 4],
}

impl<'a> Depths<'a> {
    /// For the assembly of a set with the words of a matrix; `None` if there are too many words.
    pub fn new(
        all: &'a Matrix,
        rests: &Rests,
        (set, wiring): (&TileSet, &Wiring),
        meetings: &BTreeMap<Met, usize>,
    ) -> Option<Self> {
        if all.words.len() > MOST_WORDS {
            return None;
        }
        let met = meetings.keys();
        let every: Vec<Word> = (0..all.energies.len()).map(|face| all.code(face)).collect();
        let one_holds = wiring.least_strength() >= set.tau();
        Some(Self {
            price: PRICES[usize::from(one_holds)],
            all,
            meetings: met.filter_map(|met| wiring.meeting(set, met)).collect(),
            energies: rests.table(&every),
        })
    }

    /// The sum over all bonds of the additional depth as a share of the depth; `words` are the
    /// bonds' faces on the east and north sides of tiles.
    pub fn excess(&self, words: &[usize]) -> f64 {
        let rest = |TilePair { axis, faces, .. }: &TilePair| -> f64 {
            let energy = |[a, b]: [usize; 2]| {
                let u = self.all.on(a, words[faces[0][a]?]);
                let v = self.all.on(b, words[faces[1][b]?]);
                Some(self.energies[eastern(*axis, a)][eastern(*axis, b)][(u, v)])
            };
            others(*axis).filter_map(energy).sum()
        };
        let deeper = |it: &TilePair| (-rest(it) / self.all.bond(words[it.bond])).max(0.0);
        self.meetings.iter().map(deeper).sum()
    }
}
