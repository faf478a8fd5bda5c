//! The magnets of a tile that are alike, in vectors.

use nalgebra::{Complex, Vector2};

use crate::potential::simd::lanes::fill;

/// The weakness of padding.
const NO_MOMENT: f64 = 1e60;

/// The distance (m) of padding.
const AWAY: f64 = 1e6;

/// Magnets of a tile that are alike but for their places and moments, as a structure of arrays; those of
/// fixed tiles are padded to a multiple of the number of lanes with magnets without moment.
#[derive(Clone, Debug)]
pub struct Group {
    /// The number of their shape and size.
    pub size: usize,
    /// The direction of all of them, up to its sign.
    pub axis: Complex<f64>,
    /// Which of the tile's magnets they are.
    pub members: Vec<usize>,
    /// Their number, without the padding.
    pub count: usize,
    /// Places (m) in the frame whose x axis is the direction.
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    /// Moments (A m^2), negative where a magnet points against the direction.
    pub moment: Vec<f64>,
    /// Their magnitudes to the power -2/3; multiplied by the squared distance, this is smaller for
    /// stronger pairs.
    pub weakness: Vec<f64>,
    /// The largest magnitude.
    pub strongest: f64,
}

impl Group {
    /// A group without magnets.
    pub fn new(size: usize, axis: Vector2<f64>) -> Self {
        Self {
            size,
            axis: Complex::new(axis.x, axis.y),
            members: Vec::new(),
            count: 0,
            x: Vec::new(),
            y: Vec::new(),
            moment: Vec::new(),
            weakness: Vec::new(),
            strongest: 0.0,
        }
    }

    /// Adds a magnet at a place (m) in the tile.
    pub fn push(&mut self, member: usize, position: Vector2<f64>, moment: f64) {
        self.members.push(member);
        let place = Complex::new(position.x, position.y) * self.axis.conj();
        self.count += 1;
        self.x.push(place.re);
        self.y.push(place.im);
        self.moment.push(moment);
        // Without a moment, large enough to be far from all others.
        let weakness = libm::pow(moment.abs(), -2.0 / 3.0);
        self.weakness.push(weakness.min(NO_MOMENT));
        self.strongest = self.strongest.max(moment.abs());
    }

    /// Pads to whole vectors.
    pub fn fill(&mut self) {
        // Far from everything, so that padding never counts as near.
        fill(&mut self.x, AWAY);
        fill(&mut self.y, 0.0);
        fill(&mut self.moment, 0.0);
        fill(&mut self.weakness, NO_MOMENT);
    }
}
