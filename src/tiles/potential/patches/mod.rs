//! The field of one tile's many dipoles, tabulated, so that the cost of a dipole of the other tile
//! does not depend on their number.
//!
//! With moments scaled by `sqrt(mu0 / 4 pi)`, a dipole of moment m at p has the energy `U = m .
//! grad phi(p)` in the potential `phi(p) = sum_j m_j . d / r^3`, `d = p - p_j`, `r = |d|`, of the
//! dipoles `m_j` at `p_j` of the fixed tile. The plane is cut into squares ([`table`]), and in each
//! phi is split: up to [`square::NEAR`] near dipoles are evaluated individually, and all others,
//! whose potential is smooth in the square, as one polynomial ([`polynomial`], with a proved bound of
//! the error). Squares are halved until no more dipoles are near. So the cost of an energy is
//! proportional to the number of the moving tile's dipoles, not to the number of pairs.
//!
//! Bounds of derivatives along motions ([`super::motion`]) are split in the same way: near dipoles
//! individually, and for all others sums that hold in the whole square and around it
//! ([`dipoles::Spread`]), in a square at least as large as the motion is long to either side.
//!
//! Squares are divided and polynomials computed on first use; each is the same whenever this is,
//! and on whichever thread.
//!
//! Blocks have such tables too ([`CuboidPotential`](super::CuboidPotential)).

pub mod dipoles;
pub mod polynomial;
pub mod square;
pub mod table;
