//! Kinetics: what overdamped motion makes of a landscape.
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

pub mod exit;
mod field;
mod mesh;
mod sets;
