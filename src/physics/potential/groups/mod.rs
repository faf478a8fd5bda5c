//! Groups of far dipoles replaced by a few dipoles, so that faces with many magnets cost little
//! more than faces with few.
//!
//! The energy of two dipoles is a smooth function of the place of either, the smoother the farther
//! they are apart. So the dipoles of a group, all near each other, may be moved to the nodes of an
//! interpolation: with the shares `l_k(s)` of the nodes `s_k`, a dipole of moment m at s acts from
//! afar like moments `m l_k(s)` at the nodes, and a group of many like one moment at each node, the
//! sums over its dipoles. What stands for a group are dipoles again, and everything known of
//! dipoles holds of them: one kernel, its gradients, bounds over cells.
//!
//! A tile's dipoles are halved again and again along its outline; each group lies in a box along
//! it, and has stand-ins of several orders, each good from a distance on that follows from the
//! remainder of the interpolation ([`interpolation::lost`]): no pair of groups loses more than
//! [`tree::LOST`] = 1e-11 of `mu0 M1 M2 / (4 pi r^3)`, r their distance and M the sums of the
//! magnitudes of the moments: some 1e-15 of the energies of tiles in contact. A row of magnets needs
//! nodes along it only. Groups that are closer meet in halves, and in the end magnet by magnet
//! ([`walk::Walk`]). So bounds over cells are made; energies are asked of a table of the fixed tile's
//! field ([`super::patches`]), in which the moving tile's groups lie, as far as that reaches.
//!
//! The method is that of Fong and Darve, *The black-box fast multipole method* (Journal of
//! Computational Physics 228 (2009), 8712), without translations between levels: a pair of groups
//! costs as many pairs of nodes, and nodes are worked out once for a tile.

pub mod interpolation;
pub mod tree;
pub mod walk;

/// So many pairs of dipoles are worth being put in groups.
pub const MANY_PAIRS: usize = 1 << 14;

/// Whether so many dipoles of two tiles are worth being put in groups.
pub fn are_many(fixed: usize, moving: usize) -> bool {
    fixed * moving >= MANY_PAIRS
}
