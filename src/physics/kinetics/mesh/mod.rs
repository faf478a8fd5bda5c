//! Functions on a mesh of the folded configurations: an octree over (s, phi, theta), functions that
//! are linear in each coordinate in each cell and continuous, integrals of e^(-U/kT) over what is
//! free of each cell, and the linear systems that come of them.

mod chart;
mod element;
mod equations;
mod flux;
mod nodes;
mod octree;
mod profile;
mod quadrature;
mod sides;
mod system;
mod wall;

pub(super) use chart::{Chart, UNITS};
pub(super) use element::{Element, slope, value};
pub use equations::Unsolved;
pub(super) use flux::{Gap, Network};
pub(super) use nodes::Nodes;
pub(super) use octree::{Leaf, Octree};
pub(super) use profile::{Profile, Resistance, Spread};
pub(super) use quadrature::Integrator;
pub(super) use sides::spreads;
pub(super) use system::{System, loads};
