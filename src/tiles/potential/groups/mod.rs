//! Groups of far dipoles replaced by a few dipoles, so that faces with many magnets cost little
//! more than faces with few.
//!
//! The energy of two dipoles is a smooth function of the place of either, and smoother for larger
//! distances. So the dipoles of a group, all near each other, may be moved to the nodes of an
//! interpolation: with the weights `l_k(s)` of the nodes `s_k`, a dipole of moment m at s acts from
//! afar like moments `m l_k(s)` at the nodes, and a group of many like one moment at each node, the
//! sum over its dipoles. A group is replaced by dipoles, so everything for dipoles applies to it:
//! the kernel, its gradients, bounds over cells.
//!
//! A tile's dipoles are halved recursively along its outline; each group lies in a box along it,
//! and has replacements of several orders, each valid beyond a distance that follows from the
//! remainder of the interpolation ([`interpolation::lost`]): the error of a pair of groups is at
//! most [`tree::LOST`] = 1e-11 of `mu0 M1 M2 / (4 pi r^3)`, r their distance and M the sums of the
//! magnitudes of the moments: about 1e-15 of the energies of tiles in contact. A row of magnets
//! needs nodes only along it. Groups that are closer are split into halves, and finally into single
//! magnets ([`walk::Walk`]). Bounds over cells are computed in this way. Energies are computed from
//! a table of the fixed tile's field ([`super::patches`]) for the moving tile's groups within its
//! range.
//!
//! Blocks are grouped in the same way for their bounds ([`CuboidPotential`](super::CuboidPotential)).
//!
//! The method is that of Fong and Darve, *The black-box fast multipole method* (Journal of
//! Computational Physics 228 (2009), 8712), without translations between levels: a pair of groups
//! costs one pair of dipoles per pair of nodes, and nodes are computed once for a tile.

pub mod interpolation;
pub mod tree;
pub mod walk;

/// Groups are used from this many pairs of dipoles on.
pub const MANY_PAIRS: usize = 1 << 14;

/// Whether groups are used for this many dipoles of two tiles.
pub fn are_many(fixed: usize, moving: usize) -> bool {
    fixed * moving >= MANY_PAIRS
}
