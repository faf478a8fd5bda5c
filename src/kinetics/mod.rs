//! Kinetics: what shaken tiles do with a landscape: how strongly a state holds at kT, how soon and
//! whereto it is left, and what comes out in the end.
//!
//! kT (J) is an effective energy of shaking, see [`crate::dynamics`]; nothing here says that a
//! table has one.
//!
//! # The equations
//! With the drag c (kg/s) on the tile's mass, spread evenly, and the effective energy kT (J) of its
//! shaking, the moving tile diffuses with D = kT/c in x and y and D/rho^2 in theta, is pushed by
//! the magnets and reflected by contact. What it does on average follows from two equations over
//! the free configurations (Gardiner, *Handbook of Stochastic Methods*, section 5.4; E and
//! Vanden-Eijnden, doi:10.1007/s10955-005-9003-9):
//!
//! - mean exit time t: `div(D e^(-U/kT) grad t) = -e^(-U/kT)`, t = 0 where it ends;
//! - committor q: `div(D e^(-U/kT) grad q) = 0`, q = 1 on one end and 0 on the others;
//!
//! with no flux through contact. Both are solved by finite elements on an own octree, in which the
//! weight e^(-U/kT) is integrated over what is free of each cell: contact needs no mesh of its own,
//! and a layer of e^(-U/kT) along it may be thinner than a cell. The energy of the computed
//! committor is an upper bound of the capacity (Dirichlet's principle), but for the quadrature.

pub mod basin;
pub mod bond;
pub mod chain;
pub mod corner;
pub mod exit;
mod field;
mod frame;
mod line;
mod mesh;
pub mod mixture;
pub mod population;
pub mod rates;
mod sets;
pub mod well;

pub use bond::{Bond, BondError, Hold, Trap};
pub use well::{Estimate, Well};
