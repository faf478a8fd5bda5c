//! A bar magnet of a tile.

use nalgebra::Vector2;

use crate::units::MU0;

/// A bar magnet fixed in a tile, in the tile's frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Magnet {
    /// Centre of the block (m).
    pub position: Vector2<f64>,
    /// Direction of the magnetic moment (rad, counter-clockwise from the tile's x axis).
    pub angle: f64,
    /// Magnitude of the magnetic moment (A m^2), positive.
    pub moment: f64,
    /// Size of the block (m): along its magnetic axis, across it in the tile's plane, and through
    /// the tile's thickness.
    pub size: [f64; 3],
    /// The face that carries it.
    pub face: usize,
}

impl Magnet {
    /// The moment as a vector (A m^2).
    pub fn moment_vector(&self) -> Vector2<f64> {
        Vector2::new(libm::cos(self.angle), libm::sin(self.angle)) * self.moment
    }

    /// Remanence (T) of the uniformly magnetised block with this moment: `Br = mu0 m / V`.
    pub fn remanence(&self) -> f64 {
        MU0 * self.moment / self.size.iter().product::<f64>()
    }

    /// The block's four corners in the tile's plane (m), counter-clockwise.
    pub fn corners(&self) -> [Vector2<f64>; 4] {
        let axis =
            Vector2::new(libm::cos(self.angle), libm::sin(self.angle)) * (self.size[0] / 2.0);
        let across =
            Vector2::new(-libm::sin(self.angle), libm::cos(self.angle)) * (self.size[1] / 2.0);
        let c = self.position;
        [
            c + axis - across,
            c + axis + across,
            c - axis + across,
            c - axis - across,
        ]
    }
}
