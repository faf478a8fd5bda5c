//! Many tiles on the table at once: magnets, contact with friction, air drag, shaking and fans.
//!
//! With q the centre of mass and the orientation of a tile and M = diag(m, m, I) about that centre,
//!
//! `M q'' = Q(q, t) - c M q' + R(t)`,
//!
//! where Q are the forces of the magnets of all other tiles, of fans, of the table's own motion and of
//! contact, c the drag rate (1/s), and R the shaking.
//!
//! # Steps
//! A step of the table (`stepper`) sorts the pairs of tiles into those whose outlines are near each
//! other and the rest. Near pairs tie tiles together to islands (`island`), of which each goes through the step in as
//! many shorter ones as its forces and contacts need: velocity Verlet, whose steps end where a corner meets an
//! edge. Knocks are impulses that obey Coulomb's law (`hold`). The forces of the other pairs, of fans
//! and of shaking are held for one step, as they are in its middle. Each force acts on both tiles of a
//! pair, so that momentum is kept to rounding.
//!
//! # Shaking
//! Random kicks at fixed times, each of which with the drag since the last is an exact
//! Ornstein-Uhlenbeck step of the velocities. Between them tiles move by mechanics alone, so that
//! elastic contact without friction has the temperature kT whatever the time between kicks and the step
//! are. Kicks that came with every step would overcome friction the sooner the shorter the step is
//! (their sum over a time grows like its root, what friction takes like the time itself): it is the time
//! between kicks that decides, and it is stated. (Noise with a memory, and drag with the same memory, has
//! the temperature, too, but hardly reaches tiles that bounce within a bond, which is much faster: after
//! 400 s they had a third of it.)
//!
//! # Cut-off
//! A pair's energy is multiplied by a factor that falls smoothly from 1 to 0 between two distances of the
//! reference points, so that energy is conserved; what is left out so is stated
//! ([`crowd::Cutoff`]).
//!
//! # Why contact is not left to a game engine
//! Measured with rapier2d-f64 0.36.1: a square tile of 0.43 m and 0.1 kg, pressed onto a fixed edge by
//! 30 N, as a bond does, and let go 0.1 mm above it with 3 mJ, elastic and without friction. At steps of
//! 0.5 ms to 20 us and contact frequencies of 1 and 4 kHz (damping ratio 1) it has lost all 3 mJ after
//! 0.1 s and lies 9.5 um or 0.6 um within the edge. Its restitution is
//! that of single knocks, while bound tiles bounce some hundred times a second. So bound
//! tiles of an elastic table would freeze. Here the same tiles lose some 2 to 6 % of 3 mJ in
//! 5 s at the usual step.

pub mod contacts;
pub mod crowd;
mod drive;
mod hold;
mod island;
mod mover;
mod neighbours;
mod pair;
pub mod run;
pub mod settings;
pub mod start;
mod stepper;
mod union;

pub use crowd::{Crowd, CrowdError, Kind};
pub use mover::Mover;
pub use run::{Run, Sample};
pub use settings::{Orbital, TableSettings};
pub use start::StartError;
pub use stepper::Stepper;
