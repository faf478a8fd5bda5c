//! What is asked of an energy landscape: its minima, barriers and pathways.

pub mod minimum;
pub mod results;
pub mod slide;
pub mod stationary;

pub use results::{Barrier, Pathway, PathwayPoint, Place, Proportion, State, StateKind};
