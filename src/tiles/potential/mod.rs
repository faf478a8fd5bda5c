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
//! For two tiles with very many magnets (128 each), far groups of equal dipoles are replaced by fewer
//! of them at the nodes of an interpolation, with a proved error of 1e-11 of the pairs' `mu0 m1 m2 / (4
//! pi r^3)`, r the distance of the groups, and the field of the fixed tile is tabulated (`patches`) with
//! the same error, so that the cost of an energy is proportional to the number of the moving tile's
//! magnets, not to the number of pairs. Blocks have such a table, too, with an error measured at 2e-8 of
//! the strongest pair. Bounds over cells use groups of dipoles only; of blocks they are sums over all
//! pairs.
//!
//! Over whole cells of configurations the energy of either model has guaranteed bounds
//! ([`bounds`]), which certify barriers; so has the energy with smooth shields and that of discs and
//! upright magnets within their tiles. The nearest-face rule has none.
//!
//! Sources: Jackson, *Classical Electrodynamics* (3rd ed.), chapter 5, for the dipole; Akoun and
//! Yonnet, doi:10.1109/TMAG.1984.1063554, for blocks with parallel edges, whose integrals
//! [`cuboid`] uses as far as they have closed forms at an angle.

pub mod batch;
pub mod bodies;
pub mod bounds;
mod classes;
pub mod cuboid;
pub mod dipole;
pub(crate) mod far;
mod flux_density;
mod function;
pub(crate) mod groups;
pub mod interaction;
mod kinds;
mod lever;
mod model;
pub mod motion;
mod patches;
pub mod shielding;
pub mod simd;

pub use batch::DipolePotential;
pub use bodies::BodyPotential;
pub use bounds::{BoxedBounds, CellBounds};
pub use cuboid::CuboidPotential;
pub use flux_density::flux_density;
pub use function::Potential;
use function::finite;
pub use groups::MANY_PAIRS;
pub use interaction::{Energy, Interaction, LazyBounds, Unbounded};
pub use model::MagnetModel;
pub use shielding::ShieldedPotential;
