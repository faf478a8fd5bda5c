//! The request of an assembly.

use super::lattice;
use crate::design::MagnetModel;
use crate::request::{self, options};
use crate::word_sets;
use physics::words::{FaceShape, Rules};

/// The least gap if none is requested.
const GAP: f64 = 0.5;

options! {
    /// The options for building a tile set from magnets.
    #[derive(Clone, Debug)]
    pub struct Request {
        /// Effective energy kT of shaking (J): also simulate growth
        ///
        /// Without it the tiles are laid by hand: the result is words, sheet and designs for one of each
        /// tile, or for the shares that the file states if these are whole numbers.
        pub kt: Option<f64> = value("E", request::shaking),

        /// Fraction of the table covered by loose tiles of all kinds
        pub coverage: f64 = value("F", request::fraction).or(0.3),

        /// Rows and columns of a lattice
        pub lattice: Option<[usize; 2]> = value("MxN", lattice::size),

        /// Side of a counted square (tiles)
        pub side: Option<usize> = value("N", request::count),

        /// Replace each tile by a block of K x K tiles, to reduce errors
        pub proofread: u16 = value("K", request::whole(1, 6)).or(1),

        /// Magnet positions per face [default: the fewest that carry the words]
        pub length: Option<usize> = value("L", request::count),

        /// Magnets per word of the strongest bonds [default: one per position]
        ///
        /// With fewer magnets than positions, spacing is part of the code.
        pub magnets: Option<usize> = value("K", request::count),

        /// Smallest gap of the words, 0 to 1 [default: 0.5; with --length the widest]
        pub gap: Option<f64> = value("G", word_sets::gap),

        /// Complementary shapes of the faces: none, shared or polar
        ///
        /// shared: all faces have one shape, which prevents slides. polar: words have knobs and mates have
        /// slots. The designs are written with flat faces in any case.
        pub shape: FaceShape = value("KIND", word_sets::shape()).or("none"),

        /// Distance between magnet positions (m) [default: the design's, or 0.04]
        pub pitch: Option<f64> = value("M", request::length),

        /// Magnet model, dipole or cuboid [default: the design's]
        pub model: Option<MagnetModel> = value("MODEL", request::model()),

        /// Effort of the word search in core-seconds for each length of face, counted in steps
        ///
        /// Without --length, longer and longer faces are tried with a twentieth of this effort, until
        /// one carries the words, and then shorter ones with the full effort.
        ///
        /// Steps are counted, not timed, so the same effort gives the same words on any machine.
        pub seconds: f64 = value("S", request::time).or(20.0),

        /// Random seed; the same seed gives the same results
        pub seed: u64 = value("N", request::seed).or(1),
    }
}

impl Request {
    /// The rules that say which contacts are wrong.
    pub fn rules(&self) -> Rules {
        Rules {
            shape: self.shape,
            ..Rules::default()
        }
    }

    /// The least gap of words; `None` for the widest possible.
    pub(super) fn least_gap(&self) -> Option<f64> {
        self.gap.or(self.length.is_none().then_some(GAP))
    }
}
