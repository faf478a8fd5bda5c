//! The energy as a function of configurations.

use nalgebra::Vector3;

use crate::configuration::Configuration;

/// A potential energy over configurations.
///
/// Energies are in J; gradients are (dU/dx, dU/dy, dU/dtheta) in J/m, J/m and J/rad, so that the
/// force and the torque on the moving tile (about its reference point) are their negatives. A
/// potential need not handle contact: it may be evaluated where tiles overlap, and must then return
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
    /// square metre of the displacement of the magnet that moves farthest. Infinite if no bound is
    /// known.
    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64;

    /// The same, and the bound of the third derivative, per cube of the displacement. Infinite if
    /// no bound is known.
    fn bend_bounds(&self, q: &Configuration, reach: f64) -> [f64; 2] {
        [self.curvature_bound(q, reach), f64::INFINITY]
    }

    /// The bound of the fourth derivative, per fourth power of the displacement. Infinite if no
    /// bound is known.
    fn fourth_derivative_bound(&self, _q: &Configuration, _reach: f64) -> f64 {
        f64::INFINITY
    }

    /// A bound of how far (m) the motion `step` = (dx, dy, dtheta) moves any point of the moving
    /// tile that the potential depends on.
    fn displacement(&self, step: Vector3<f64>) -> f64;

    /// The length (m) of a motion over which the energy is smooth enough that a cubic that is
    /// correct in its middle may be assumed correct throughout; 0 if only bounds count.
    fn feature_length(&self) -> f64 {
        0.0
    }

    /// Whether an energy takes so long, because of very many magnets, that as few as possible are
    /// to be computed.
    fn is_expensive(&self) -> bool {
        false
    }

    /// The fraction of |U| by which energies of nearby configurations must differ to be certainly
    /// different: the errors of rounding and, if there is any, of approximation.
    fn noise(&self) -> f64 {
        1e-12
    }
}

/// Replaces an energy that is not finite by infinity, and a gradient that is not finite by zero.
pub fn finite(energy: f64, gradient: Vector3<f64>) -> (f64, Vector3<f64>) {
    if !energy.is_finite() {
        return (f64::INFINITY, Vector3::zeros());
    }
    if gradient.iter().all(|slope| slope.is_finite()) {
        (energy, gradient)
    } else {
        (energy, Vector3::zeros())
    }
}
