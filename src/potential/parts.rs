//! An energy as a sum of parts, of which a motion changes some fast and most slowly.
//!
//! Along a motion the energy of two groups of magnets varies over lengths of the size of their
//! distance. So the many pairs of groups that are far apart need to be asked at few places of a
//! motion, and only the few close ones at many.

use nalgebra::Vector3;

use crate::configuration::Configuration;

/// A pair of groups of magnets, by their numbers: one of the fixed and one of the moving tile.
pub type Part = [usize; 2];

/// An energy that can be asked part by part.
pub trait Parts: Sync {
    /// The part that is the whole energy.
    fn whole(&self) -> Part;

    /// U (J) of some parts together, and its gradient; `roughly` of slow parts.
    fn energy_and_gradient_of(
        &self,
        parts: &[Part],
        q: &Configuration,
        roughly: bool,
    ) -> (f64, Vector3<f64>);

    /// What [`fourth_derivative_bound`](super::Potential::fourth_derivative_bound) is of the whole,
    /// of some parts together.
    fn fourth_derivative_bound_of(&self, parts: &[Part], q: &Configuration, reach: f64) -> f64;

    /// Takes some parts to pieces, and tells those that motions through `q` of at most `reach` (m)
    /// to either side change slowly from those that they may change fast. Cubics through the rough
    /// values and slopes of the slow ones at both ends of such a motion are off by `allowed` (J) at
    /// most, all together.
    fn sift(&self, parts: &[Part], q: &Configuration, reach: f64, allowed: f64) -> Sifted;
}

/// Parts that together are what was sifted.
#[derive(Clone, Debug, Default)]
pub struct Sifted {
    /// Those that change slowly.
    pub slow: Vec<Part>,
    /// All others.
    pub fast: Vec<Part>,
    /// What the slow ones' cubics are off by, at most (J).
    pub off: f64,
}
