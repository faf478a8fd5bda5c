//! Functions on a mesh of the folded configurations: an octree over (r, phi, theta), functions that
//! are linear in each coordinate in each cell and continuous, integrals of e^(-U/kT) over what is
//! free of each cell, and the linear systems that come of them.

mod chart;
mod element;
mod nodes;
mod octree;
mod system;

pub(super) use chart::{Chart, UNITS};
pub(super) use element::{Element, Integrator, gradients, shapes};
pub(super) use nodes::Nodes;
pub(super) use octree::{Leaf, Octree};
pub use system::Unsolved;
pub(super) use system::{System, loads};
