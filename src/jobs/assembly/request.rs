//! The request of an assembly.

use clap::Args;

use super::lattice;
use crate::design::MagnetModel;
use crate::request;
use crate::word_sets;
use physics::words::{FaceShape, Rules};

/// The least gap if none is requested.
const GAP: f64 = 0.5;

/// The options for building a tile set from magnets.
#[derive(Clone, Debug, Args)]
pub struct Request {
    /// Effective energy kT of shaking (J): also simulate growth
    ///
    /// Without it the tiles are laid by hand: the result is words, sheet and designs for one of each
    /// tile, or for the shares that the file states if these are whole numbers.
    #[arg(long, value_name = "E", value_parser = request::shaking)]
    pub kt: Option<f64>,

    /// Fraction of the table covered by loose tiles of all kinds
    #[arg(long, value_name = "F", default_value_t = 0.3, value_parser = request::fraction)]
    pub coverage: f64,

    /// Rows and columns of a lattice
    #[arg(long, value_name = "MxN", value_parser = lattice::size)]
    pub lattice: Option<[usize; 2]>,

    /// Side of a counted square (tiles)
    #[arg(long, value_name = "N", value_parser = request::count)]
    pub side: Option<usize>,

    /// Replace each tile by a block of K x K tiles, to reduce errors
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = request::whole(1, 6))]
    pub proofread: u16,

    /// Magnet positions per face [default: the fewest that carry the words]
    #[arg(long, value_name = "L", value_parser = request::count)]
    pub length: Option<usize>,

    /// Magnets per word of the strongest bonds [default: one per position]
    ///
    /// With fewer magnets than positions, spacing is part of the code.
    #[arg(long, value_name = "K", value_parser = request::count)]
    pub magnets: Option<usize>,

    /// Smallest gap of the words, 0 to 1 [default: 0.5; with --length the widest]
    #[arg(long, value_name = "G", value_parser = word_sets::gap)]
    pub gap: Option<f64>,

    /// Complementary shapes of the faces: none, shared or polar
    ///
    /// shared: all faces have one shape, which prevents slides. polar: words have knobs and mates have
    /// slots. The designs are written with flat faces in any case.
    #[arg(long, value_name = "KIND", default_value = "none", value_parser = word_sets::shape(),
          hide_possible_values = true)]
    pub shape: FaceShape,

    /// Distance between magnet positions (m) [default: the design's, or 0.04]
    #[arg(long, value_name = "M", value_parser = request::length)]
    pub pitch: Option<f64>,

    /// Magnet model, dipole or cuboid [default: the design's]
    #[arg(long, value_name = "MODEL", value_parser = request::model(), hide_possible_values = true)]
    pub model: Option<MagnetModel>,

    /// Effort of the word search in core-seconds for each length of face, counted in steps
    ///
    /// Without --length, longer and longer faces are tried with a twentieth of this effort, until
    /// one carries the words, and then shorter ones with the full effort.
    ///
    /// Steps are counted, not timed, so the same effort gives the same words on any machine.
    #[arg(long, value_name = "S", default_value_t = 20.0, value_parser = request::time)]
    pub seconds: f64,

    /// Random seed; the same seed gives the same results
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = request::seed)]
    pub seed: u64,
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
