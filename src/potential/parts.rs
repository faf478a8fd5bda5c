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

    /// U (J) of some parts together, and its gradient.
    fn energy_and_gradient_of(&self, parts: &[Part], q: &Configuration) -> (f64, Vector3<f64>);

    /// What [`fourth_derivative_bound`](super::Potential::fourth_derivative_bound) is of the whole,
    /// of some parts together.
    fn fourth_derivative_bound_of(&self, parts: &[Part], q: &Configuration, reach: f64) -> f64;

    /// Takes some parts to pieces, and tells those that motions through `q` of at most `reach` (m)
    /// change slowly from those that they may change fast: the fourth derivatives (J/m^4) of all
    /// the slow ones that ever come of the whole add up to `limit` at most, however often what is
    /// fast is sifted again.
    fn sift(&self, parts: &[Part], q: &Configuration, reach: f64, limit: f64) -> Sifted;
}

/// Parts that together are what was sifted.
#[derive(Clone, Debug, Default)]
pub struct Sifted {
    /// With proved small derivatives.
    pub slow: Vec<Part>,
    /// All others.
    pub fast: Vec<Part>,
}
