//! What is asked of an energy landscape: its minima, barriers and pathways.

pub mod minimum;
pub mod network;
pub mod results;
pub mod slide;
pub mod stationary;
pub mod survey;

pub use results::{Barrier, Pathway, PathwayPoint, Place, Proportion, State, StateKind};
