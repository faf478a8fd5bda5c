//! How much deeper bonds are in whole tiles than those of their faces alone, while words move from
//! bond to bond.

use std::collections::BTreeSet;

use nalgebra::DMatrix;

use super::TileSet;
use super::assignment::mate;
use super::growth::Grown;
use super::matrix::Matrix;
use super::rests::{Rests, eastern, others};
use super::wiring::{Axis, Wiring};
use physics::words::Word;

/// More words are not looked at: every face's energy with every other one is kept, by sides.
const MOST_WORDS: usize = 128;

/// Wrong meetings may weigh so many times more where no bond is deeper for it: little where tiles wait
/// for their second bond; more where one holds them, which is so deep that below the gap no wrong one
/// does.
const PRICES: [f64; 2] = [1.1, 20.0];

/// Two tiles that meet, by the bonds of their faces.
type Meeting = (Axis, [Option<usize>; 4], [Option<usize>; 4]);

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
        set: &TileSet,
        wiring: &Wiring,
        grown: &Grown,
    ) -> Option<Self> {
        if all.words.len() > MOST_WORDS {
            return None;
        }
        let faces = 2 * all.words.len();
        let of = |tile: usize| std::array::from_fn(|side| wiring.of(set, tile, side));
        let mut meetings = BTreeSet::new();
        for (first, axis, second) in grown.meetings().into_keys() {
            let bonds = (axis, of(first), of(second));
            let [out, back] = axis.sides();
            if bonds.1[out].is_some() && bonds.1[out] == bonds.2[back] {
                meetings.insert(bonds);
            }
        }
        let every: Vec<Word> = (0..faces).map(|face| all.code(face)).collect();
        let one_holds = wiring.least_strength() >= set.tau();
        Some(Self {
            price: PRICES[usize::from(one_holds)],
            all,
            meetings,
            energies: rests.table(&every),
        })
    }

    /// By how much bonds are deeper, each as a share of its depth, in sum; `words` are the faces of
    /// bonds on their tiles' east and north sides.
    pub fn excess(&self, words: &[usize]) -> f64 {
        let deeper = |meeting: &Meeting| {
            let bond = meeting.1[meeting.0.sides()[0]].map_or(0, |bond| words[bond]);
            let depth = self.all.bond(bond % self.all.words.len());
            (-self.rest(meeting, words) / depth).max(0.0)
        };
        self.meetings.iter().map(deeper).sum()
    }

    fn rest(&self, (axis, first, second): &Meeting, words: &[usize]) -> f64 {
        let there = self.all.words.len();
        let face = |side: usize, bond: usize| match side < 2 {
            true => words[bond],
            false => mate(words[bond], there),
        };
        let energy = |[a, b]: [usize; 2]| {
            let (u, v) = (face(a, first[a]?), face(b, second[b]?));
            Some(self.energies[eastern(*axis, a)][eastern(*axis, b)][(u, v)])
        };
        others(*axis).filter_map(energy).sum()
    }
}
