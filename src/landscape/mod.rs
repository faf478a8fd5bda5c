//! What is asked of an energy landscape: its minima, barriers and pathways.

pub mod certificate;
pub mod results;

pub use results::{Barrier, Pathway, PathwayPoint, Place, Proportion, State, StateKind};
