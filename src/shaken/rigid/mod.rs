//! The engine of rigid bodies in contact, for two tiles or many.
//!
//! [`Island`] moves tiles that are near each other, step by step; the tiles, their forces and their
//! outlines are those of a [`World`]. Tiles may stand still: one tile that moves against another that
//! does not is the smallest case (`dynamics`), many tiles on a table are the largest (`table`).
//! Collisions and resting contact are impulses that obey Coulomb's law (`solve`).

mod account;
mod body;
mod clusters;
mod fan;
mod hold;
mod island;
mod knock;
mod limits;
mod margins;
mod motion;
mod mover;
mod near;
mod pair;
mod pivot;
mod point;
mod rest;
mod rim;
mod short;
mod solve;
mod step;
mod sweeps;
mod together;
mod turns;
mod way;

pub use account::Account;
pub use body::{Body, Motion, Phase, normal, thermal_velocity};
pub use fan::{Fan, Winds, longest_step};
pub use island::{Island, Laws, Masses, SHORTEST_TRIED};
pub use margins::{Margins, USUAL_STEP};
pub use motion::{State, fastest, relative};
pub use mover::{Mover, Rider};
pub use near::{NearPair, rim_room};
pub use pair::{Pose, Two, Within, on_the_table};
pub use rest::{GRAVITY, supports};
pub use rim::Rim;
pub use solve::Solver;

use nalgebra::Vector2;

use tiles::configuration::Configuration;
use tiles::contact::Contact;

/// The tiles that an engine moves: kinds with numbers, and what acts between two of them.
pub trait World: Sync {
    /// Mass and inertia of a kind.
    fn body(&self, kind: usize) -> &Body;
    /// The largest distance (m) of a point of a tile from its centre of mass.
    fn reach(&self, kind: usize) -> f64;
    /// The corners of a tile (m), in its frame.
    fn corners(&self, kind: usize) -> &[Vector2<f64>];
    /// The points at which a tile lies on the table (m), about its centre of mass.
    fn supports(&self, kind: usize) -> &[Vector2<f64>];
    /// The outlines of two kinds, in the order of a [`Two`].
    fn contact(&self, kinds: [usize; 2]) -> &Contact;
    /// U (J) of the second tile at a pose in the first one's frame, the force (N) on it in that frame and
    /// the torque (N m) about its reference point.
    fn pull(&self, kinds: [usize; 2], q: &Configuration) -> (f64, Vector2<f64>, f64);
    /// The rim of the table.
    fn rim(&self) -> Rim;
}
