//! The contribution of the other faces of two tiles to the bond of the two faces that meet.
//!
//! The matrix describes two faces, as glues do. But a row of magnets ends half a pitch from the
//! corner, and the neighbour's row begins just as far beyond it: with all four faces of both tiles
//! a bond is deeper or shallower by about one per cent.

use nalgebra::{DMatrix, DVector, Rotation2};

use super::axis::MeetingAxis;
use crate::design::WordSet;
use physics::matrix::product;
use physics::tile::{Magnet, Tile};
use physics::words::Word;

/// The words or mates that a tile carries, in the order of [`super::SIDES`].
pub type Faces = [Option<Word>; 4];

/// The energies (J) of single magnets of two tiles, the second tile east of the first, by side: of
/// the magnet at place k of the first tile's face and j of the second's, with north poles out.
pub struct Rests {
    magnets: [[DMatrix<f64>; 4]; 4],
}

impl Rests {
    /// Computes them for tiles with the magnets of these words.
    pub fn new(set: &WordSet) -> Self {
        let pair = &set.stage.pair;
        // The fixed tile of the stage has its magnets in the east.
        let east = &pair.fixed;
        let on = |side: usize| turned(east, 1.0 - side as f64);
        let sides: [Vec<Tile>; 4] = std::array::from_fn(on);
        let between = |a: usize, b: usize| {
            DMatrix::from_fn(sides[a].len(), sides[b].len(), |k, j| {
                let energy = set.stage.interaction.between(&sides[a][k], &sides[b][j]);
                energy.potential.energy(&pair.bound)
            })
        };
        Self {
            magnets: std::array::from_fn(|a| std::array::from_fn(|b| between(a, b))),
        }
    }

    /// The energy (J) that all faces except the two in contact add to a bond along an axis, with
    /// the first tile in the west or south.
    pub fn of(&self, axis: MeetingAxis, first: &Faces, second: &Faces) -> f64 {
        let poles = |word: Word| DVector::from_fn(word.places(), |k, _| f64::from(word.at(k)));
        let energy = |[a, b]: [usize; 2]| {
            let (u, v) = (poles(first[a]?), poles(second[b]?));
            let [a, b] = [a, b].map(|side| eastern(axis, side));
            Some(u.dot(&(&self.magnets[a][b] * v)))
        };
        others(axis).filter_map(energy).sum()
    }

    /// The same for every two of some faces, by sides, for two tiles of which the second lies east
    /// of the first: rows are faces of the first.
    pub(super) fn table(&self, faces: &[Word]) -> [[DMatrix<f64>; 4]; 4] {
        let places = faces.first().map_or(0, |face| face.places());
        let poles = DMatrix::from_fn(faces.len(), places, |i, k| f64::from(faces[i].at(k)));
        let across = poles.transpose();
        let of = |magnets: &DMatrix<f64>| product(&product(&poles, magnets), &across);
        self.magnets.each_ref().map(|row| row.each_ref().map(of))
    }
}

/// The sides of two tiles along an axis, except the two in contact.
pub(super) fn others(axis: MeetingAxis) -> impl Iterator<Item = [usize; 2]> {
    let pairs = (0..4).flat_map(|a| (0..4).map(move |b| [a, b]));
    pairs.filter(move |sides| *sides != axis.sides())
}

/// The side that a side becomes when two tiles along an axis are rotated so that the second lies in
/// the east.
pub(super) fn eastern(axis: MeetingAxis, side: usize) -> usize {
    match axis {
        MeetingAxis::Horizontal => side,
        MeetingAxis::Vertical => (side + 1) % 4,
    }
}

/// One tile for each magnet of a tile, with only that magnet, rotated by a number of quarter turns.
fn turned(tile: &Tile, quarters: f64) -> Vec<Tile> {
    let angle = quarters * std::f64::consts::FRAC_PI_2;
    let alone = |magnet: &Magnet| Tile {
        magnets: vec![Magnet {
            position: Rotation2::new(angle) * magnet.position,
            angle: magnet.angle + angle,
            ..magnet.clone()
        }],
        ..tile.clone()
    };
    tile.magnets.iter().map(alone).collect()
}
