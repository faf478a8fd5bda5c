//! The interaction energy U(x, y, theta) of two tiles, its gradient, and bounds of its curvature.

pub mod analytic;
pub mod batch;
pub mod bounds;
pub mod cuboid;
pub mod dipole;
pub mod shielding;

use crate::configuration::Configuration;
use nalgebra::Vector3;

pub use batch::DipolePotential;
pub use bounds::CellBounds;
pub use cuboid::CuboidPotential;
pub use shielding::ShieldedPotential;

/// A potential energy over configurations.
///
/// Energies are in J; gradients are (dU/dx, dU/dy, dU/dtheta) in J/m, J/m and J/rad, so that the
/// force and the torque on the moving tile (about its reference point) are their negatives.
/// A potential need not know of contact: it may be asked where tiles overlap, and must then give
/// a number or infinity, never NaN.
pub trait Potential: Sync {
    /// U (J).
    fn energy(&self, q: &Configuration) -> f64;

    /// U (J) and its gradient.
    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>);

    /// U (J) of many configurations; `out` has the length of `qs`.
    fn energies(&self, qs: &[Configuration], out: &mut [f64]) {
        for (q, u) in qs.iter().zip(out) {
            *u = self.energy(q);
        }
    }

    /// U (J) and its gradient of many configurations; `out` has the length of `qs`.
    fn energies_and_gradients(&self, qs: &[Configuration], out: &mut [(f64, Vector3<f64>)]) {
        for (q, result) in qs.iter().zip(out) {
            *result = self.energy_and_gradient(q);
        }
    }

    /// An upper bound of the magnitude of the second derivative of U along every straight motion
    /// through `q` that moves no point of either tile's magnets by more than `reach` (m), per
    /// square metre of the displacement of the magnet that moves farthest. Infinite where nothing
    /// is known.
    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64;

    /// How far (m) the motion `step` = (dx, dy, dtheta) moves the point of the moving tile that
    /// matters to the potential and moves farthest, at most.
    fn displacement(&self, step: Vector3<f64>) -> f64;

    /// How much lower, as a fraction of |U|, an energy must be than that of a configuration close
    /// by to be so for certain: what is lost to rounding and, where there is any, to approximation.
    fn noise(&self) -> f64 {
        1e-12
    }
}
