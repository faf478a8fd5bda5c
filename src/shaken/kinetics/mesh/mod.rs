//! Finite elements on the configurations folded by symmetry: an octree over (s, phi, theta),
//! continuous functions that are linear in each coordinate within each cell, integrals of e^(-U/kT)
//! over the free part of each cell, and the resulting linear systems.

mod chart;
mod element;
mod equations;
mod nodes;
mod octree;
mod quadrature;
mod system;

pub(super) use chart::{Chart, UNITS};
pub(super) use element::{Element, slope, value};
pub use equations::Unsolved;
pub(super) use nodes::Nodes;
pub(super) use octree::{Leaf, Octree};
pub(super) use quadrature::Integrator;
pub(super) use system::{System, loads};
