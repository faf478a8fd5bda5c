//! The energy landscape of two tiles: its minima, barriers and pathways. [`roadmap`] uses nothing else of it.

pub mod approach;
pub mod barrier_bounds;
mod bounded;
pub mod capture;
pub mod catalogue;
pub mod constrained;
pub mod exploration;
mod foresight;
pub mod grid;
mod known;
pub mod map;
pub mod meeting;
pub mod minimax;
pub mod minimum;
pub mod missing_states;
mod orientation;
pub mod pathway;
pub mod results;
pub mod roadmap;
pub mod stationary;
pub mod transition_network;
pub mod volume;

pub use barrier_bounds::Claims;
pub use catalogue::{Catalogue, Kind};
pub use exploration::LeftOut;
pub use missing_states::{Completeness, CompletenessSettings};
pub use results::{
    Alternative, Barrier, Pathway, PathwayCost, PathwayPoint, Place, Proportion, SaddleBounds,
    State, StateKind, Uncaptured, Uncertified, highest_point, work,
};
