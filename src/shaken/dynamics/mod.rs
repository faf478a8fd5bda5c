//! Rigid-body dynamics of the moving tile on the air table.
//!
//! With q the centre of mass and the orientation, M = diag(m, m, I) about the centre of mass and
//! C = c M for a drag rate c (1/s),
//!
//! `M q'' = -C q' + Q(q, t)`,
//!
//! where Q contains the magnetic force and torque (minus the gradient of the
//! [potential](tiles::potential)), the forces of fans and those of contact. (Equation (5.1.3) of
//! the paper adds a force per mass to a torque per inertia in one line; this is what it means.)
//! Drag is stated as a rate, since removing a share of the velocity in each step would make results
//! depend on the step.
//!
//! Between contacts the equation is integrated by an explicit Runge-Kutta pair of order 5 with step
//! control, with steps limited by the clearance. Within the range of contact the engine of
//! [many tiles](crate::table) takes over, of which a tile and a fixed one are the smallest case.
//!
//! Measured with the paper's tile: without drag and contact, past the other tile's corner, the
//! energy is constant within 1e-5 of the bond's depth over 5 s; the bound equilibrium agrees with
//! the landscape's minimum within 10 um for steps in contact of 50 um to 200 um; and of 8000 starts
//! with a drag of 0.5 per second and no rim, 9.1 % (8.4 to 9.7) bind.

pub mod check;
pub mod docking;
mod encounter;
pub mod exits;
mod flight;
mod force;
mod settings;
mod simulation;
mod trajectory;

pub use crate::rigid::{Body, Fan, Motion, Phase, normal, thermal_velocity};
pub use settings::{MotionSettings, SettingsError};
pub use simulation::{Run, Simulation, Snapshot, Stop};
