//! The interaction energy U(x, y, theta) of two tiles, its gradient, and bounds of its curvature.
//!
//! # The models
//! | model | what a magnet is | energy of a pair | good for |
//! |---|---|---|---|
//! | [`dipole`] ([`DipolePotential`]) | a point with a moment m (A m^2) | `mu0 / (4 pi r^3) [m1.m2 - 3 (m1.d)(m2.d)]` (J) | ranking codes and shapes, surveys; far apart |
//! | [`cuboid`] ([`CuboidPotential`]) | a block of size a x b x c (m), uniformly magnetised along a | Coulomb energy of its pole faces, of charge density m / (a b c) (A/m) | real depths of bonds and forces near contact |
//! | [`bodies`] ([`BodyPotential`]) | a block or a disc, lying or standing on a pole; uniformly magnetised | the same; of standing point dipoles, too | discs, and magnets across the table |
//! | [`shielding`] ([`ShieldedPotential`]) | either, with soft iron behind it | the pair's energy times a factor of distance and direction | magnets with shields, after calibration |
//!
//! Moment, remanence Br (T) and volume V (m^3) belong together by `m = Br V / mu0`, with
//! `mu0 = 4 pi 1e-7 T m / A`. Energies scale with the cube of the length and the square of the
//! remanence. Both models assume magnets of fixed magnetisation (no demagnetisation; a good
//! assumption for neodymium, whose relative permeability is 1.05) in vacuum.
//!
//! The block tends to the dipole far away, with an error that falls like `r^-2`. Near contact the
//! dipole is wrong by much: for blocks of 10 x 10 x 3 mm magnetised along a long side, face to
//! face, its energy is 35 % too weak at a gap of 1 mm and 18 % at 5 mm, and for the same block
//! magnetised through its 3 mm side it is 6.7 times too strong at 1 mm and 2.4 times at 5 mm.
//! Every analysis draws both energies over the gap (its picture `models`; that of the paper's tile
//! is `results/paper-tile/models.svg`), and with dipoles its table of states has the blocks' energy
//! and the dipoles' error in each.
//!
//! Of two tiles with very many magnets (128 each) far groups of point dipoles are replaced by fewer dipoles at
//! the nodes of an interpolation, with a proved error of 1e-11 of the pairs' `mu0 m1 m2 / (4 pi
//! r^3)`, r the distance of the groups; and the field of the fixed tile is tabulated (`patches`)
//! with the same error, so that an energy costs what the moving tile's magnets are in number, not
//! what the pairs are.
//!
//! Over whole cells of configurations the energy of either model has guaranteed bounds
//! ([`bounds`]), of which barriers are certified, with shields that act smoothly, too. The
//! nearest-face rule, discs and magnets that stand have none.
//!
//! Sources: Jackson, *Classical Electrodynamics* (3rd ed.), chapter 5, for the dipole; Akoun and
//! Yonnet, doi:10.1109/TMAG.1984.1063554, for blocks with parallel edges, of whose integrals
//! [`cuboid`] uses those that stay closed at an angle.

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

    /// The same, and that of the third derivative, per cube of the displacement. Infinite where nothing
    /// is known.
    fn bend_bounds(&self, q: &Configuration, reach: f64) -> [f64; 2] {
        [self.curvature_bound(q, reach), f64::INFINITY]
    }

    /// The same of the fourth derivative, per fourth power of the displacement. Infinite where
    /// nothing is known.
    fn fourth_derivative_bound(&self, _q: &Configuration, _reach: f64) -> f64 {
        f64::INFINITY
    }

    /// How far (m) the motion `step` = (dx, dy, dtheta) moves the point of the moving tile that
    /// matters to the potential and moves farthest, at most.
    fn displacement(&self, step: Vector3<f64>) -> f64;

    /// The length (m) of a motion over which the energy is smooth enough that a cubic which is
    /// right in its middle may be taken to be right all along; 0 where only bounds count.
    fn feature_length(&self) -> f64 {
        0.0
    }

    /// Whether an energy takes so long, of very many magnets, that as few as possible are to be asked.
    fn is_dear(&self) -> bool {
        false
    }

    /// How much lower, as a fraction of |U|, an energy must be than that of a configuration close
    /// by to be so for certain: what is lost to rounding and, where there is any, to approximation.
    fn noise(&self) -> f64 {
        1e-12
    }
}

/// Infinity in place of what is not a finite energy, and no gradient in place of what is not one.
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
