//! The interaction energy U(x, y, theta) of two tiles, its gradient, and bounds of its curvature.
//!
//! # The models
//! | model | what a magnet is | energy of a pair | good for |
//! |---|---|---|---|
//! | [`dipole`] ([`DipolePotential`]) | a point with a moment m (A m^2) | `mu0 / (4 pi r^3) [m1.m2 - 3 (m1.d)(m2.d)]` (J) | ranking codes and shapes, surveys; far apart |
//! | [`cuboid`] ([`CuboidPotential`]) | a block of size a x b x c (m), uniformly magnetised along a | Coulomb energy of its pole faces, of charge density m / (a b c) (A/m) | real depths of bonds and forces near contact |
//! | [`bodies`] ([`BodyPotential`]) | a block or a disc, lying flat or upright; uniformly magnetised | the same; also upright point dipoles | discs, and magnets across the table |
//! | [`shielding`] ([`ShieldedPotential`]) | any of these, with soft iron behind it | the pair's energy times a factor of distance and direction | magnets with shields, after calibration |
//!
//! Moment, remanence Br (T) and volume V (m^3) are related by `m = Br V / mu0`, with `mu0 = 4 pi
//! 1e-7 T m / A`. Energies scale with the cube of the length and the square of the remanence. Both
//! models assume magnets of fixed magnetisation (no demagnetisation; a good assumption for
//! neodymium, whose relative permeability is 1.05) in vacuum.
//!
//! Far away, the block tends to the dipole, with an error that decreases like `r^-2`. Near contact
//! the error of the dipole is large: for blocks of 10 x 10 x 3 mm magnetised along a long side,
//! face to face, its energy is 35 % too weak at a gap of 1 mm and 18 % at 5 mm, and for the same
//! block magnetised through its 3 mm side it is 6.7 times too strong at 1 mm and 2.4 times at 5 mm.
//! Every analysis draws both energies over the gap (its picture `models`; for the paper's tile it
//! is `results/paper-tile/models.svg`), and with dipoles its table of states has the energy of
//! blocks and the dipoles' error for each state.
//!
//! For two tiles with very many magnets (128 each), far groups of equal magnets are replaced by fewer
//! of them at the nodes of an interpolation, with a proved error as a fraction of the pairs' `mu0 m1 m2
//! / (4 pi r^3)`, r the distance of the groups: 1e-11 for point dipoles, 1e-9 for blocks. Of dipoles,
//! the field of the fixed tile is also tabulated (`patches`) with the same error, so that the cost of
//! an energy is proportional to the number of the moving tile's magnets, not to the number of pairs.
//! Bounds over cells use groups of dipoles only; of blocks they are sums over all pairs.
//!
//! Over whole cells of configurations the energy of either model has guaranteed bounds
//! ([`bounds`]), which certify barriers; so has the energy with smooth shields. The nearest-face
//! rule, discs and upright magnets have none.
//!
//! Sources: Jackson, *Classical Electrodynamics* (3rd ed.), chapter 5, for the dipole; Akoun and
//! Yonnet, doi:10.1109/TMAG.1984.1063554, for blocks with parallel edges, whose integrals
//! [`cuboid`] uses as far as they have closed forms at an angle.

pub mod batch;
pub mod bodies;
pub mod bounds;
pub mod cuboid;
pub mod dipole;
pub(crate) mod groups;
pub mod interaction;
mod lever;
mod model;
pub mod motion;
mod patches;
pub mod shielding;
pub mod simd;

use crate::configuration::Configuration;
use nalgebra::Vector3;

pub use batch::DipolePotential;
pub use bodies::BodyPotential;
pub use bounds::CellBounds;
pub use cuboid::CuboidPotential;
pub use groups::MANY_PAIRS;
pub use interaction::{BoxedBounds, Energy, Interaction, LazyBounds, Unbounded};
pub use model::MagnetModel;
pub use shielding::ShieldedPotential;

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
    fn is_dear(&self) -> bool {
        false
    }

    /// The fraction of |U| by which energies of nearby configurations must differ to be certainly
    /// different: the errors of rounding and, if there is any, of approximation.
    fn noise(&self) -> f64 {
        1e-12
    }
}

/// Replaces an energy that is not finite by infinity, and a gradient that is not finite by zero.
fn finite(energy: f64, gradient: Vector3<f64>) -> (f64, Vector3<f64>) {
    if !energy.is_finite() {
        return (f64::INFINITY, Vector3::zeros());
    }
    if gradient.iter().all(|slope| slope.is_finite()) {
        (energy, gradient)
    } else {
        (energy, Vector3::zeros())
    }
}
