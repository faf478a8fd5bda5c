//! What is asked of an energy landscape: its minima, barriers and pathways.

pub mod approach;
pub mod capture;
pub mod certificate;
pub mod certification;
pub mod completeness;
pub mod constrained;
mod foresight;
pub mod inventory;
pub mod map;
pub mod meeting;
mod metered;
pub mod minimum;
pub mod network;
mod orientation;
pub mod pathway;
pub mod results;
pub mod slides;
pub mod stationary;
pub mod survey;
pub mod volume;

pub use certification::{Claims, Uncertified};
pub use completeness::{Completeness, CompletenessSettings};
pub use inventory::{Inventory, Kind};
pub use results::{
    Alternative, Barrier, Pathway, PathwayCost, PathwayPoint, Place, Proportion, SaddleBounds,
    State, StateKind, Uncaptured, highest_point, work,
};
pub use survey::LeftOut;
