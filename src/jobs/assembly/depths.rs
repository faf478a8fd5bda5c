//! How much deeper bonds are between whole tiles than between their two faces alone, updated while
//! words are exchanged between bonds.

use std::collections::BTreeSet;

use nalgebra::DMatrix;

use super::TileSet;
use super::growth::Grown;
use super::matrix::Matrix;
use super::rests::{Rests, eastern, others};
use super::wiring::{Meeting, Wiring};
use physics::words::Word;

/// More words are not looked at: every face's energy with every other one is kept, by sides.
const MOST_WORDS: usize = 128;

/// Wrong meetings may weigh so many times more where no bond is deeper for it: little where tiles wait
/// for their second bond; more where one holds them, which is so deep that below the gap no wrong one
/// does.
const PRICES: [f64; 2] = [1.1, 20.0];

/// What is needed for it.
pub struct Depths<'a> {
    /// How many times more wrong meetings may weigh for it.
    pub price: f64,
    all: &'a Matrix,
    meetings: BTreeSet<Meeting>,
    /// Of every two faces, see [`Rests::table`].
    energies: [[DMatrix<f64>; 4]; 4],
}

impl<'a> Depths<'a> {
    /// Of what grows of a set, with words of a matrix; `None` where there are too many.
    pub fn new(
        all: &'a Matrix,
        rests: &Rests,
        (set, wiring): (&TileSet, &Wiring),
        grown: &Grown,
    ) -> Option<Self> {
        if all.words.len() > MOST_WORDS {
            return None;
        }
        let met = grown.meetings().into_keys();
        let every: Vec<Word> = (0..all.energies.len()).map(|face| all.code(face)).collect();
        let one_holds = wiring.least_strength() >= set.tau();
        Some(Self {
            price: PRICES[usize::from(one_holds)],
            all,
            meetings: met.filter_map(|met| wiring.meeting(set, &met)).collect(),
            energies: rests.table(&every),
        })
    }

    /// By how much bonds are deeper, each as a share of its depth, in sum; `words` are the faces of
    /// bonds on their tiles' east and north sides.
    pub fn excess(&self, words: &[usize]) -> f64 {
        let rest = |Meeting { axis, faces, .. }: &Meeting| -> f64 {
            let energy = |[a, b]: [usize; 2]| {
                let u = self.all.on(a, words[faces[0][a]?]);
                let v = self.all.on(b, words[faces[1][b]?]);
                Some(self.energies[eastern(*axis, a)][eastern(*axis, b)][(u, v)])
            };
            others(*axis).filter_map(energy).sum()
        };
        let deeper = |it: &Meeting| (-rest(it) / self.all.bond(words[it.bond])).max(0.0);
        self.meetings.iter().map(deeper).sum()
    }
}
