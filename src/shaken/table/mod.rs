//! Many rigid tiles on one table: magnets, contact with friction, air drag, shaking and fans.
//!
//! With q the centre of mass and the orientation of a tile and M = diag(m, m, I) about that centre,
//!
//! `M q'' = Q(q, t) - c M q' + R(t)`,
//!
//! where Q contains the forces of the magnets of all other tiles, of fans, of the table's own
//! motion and of contact, c is the drag rate (1/s), and R the shaking.
//!
//! # Steps
//! Two tiles are tied in a step of the table (`stepper`) if they may touch within it, or if the
//! force between them changes too fast for it. Tied tiles form islands, which the engine of contact
//! (`rigid`) moves. Each divides the step into as many shorter ones as its forces and contacts need:
//! velocity Verlet with contact as in RATTLE, whose steps end when a corner meets an edge. Collisions
//! are impulses that obey Coulomb's law. The energy lost in contact is the sum of all impulses times
//! the mean of the velocities before and after, so that the energy balance checks the motion. The
//! forces of the other pairs, of fans and of shaking are constant over a step, with their values in
//! its middle; those of pairs far apart over as many steps as they change little in. Each force acts
//! on both tiles of a pair, so that momentum is conserved up to rounding.
//!
//! # Shaking
//! Random kicks at fixed times. Each kick, together with the drag since the last one, is an exact
//! Ornstein-Uhlenbeck step of the velocities. Between kicks tiles move by mechanics alone, so
//! elastic contact without friction has the temperature kT for any time between kicks and any step.
//! If kicks came with every step, they would overcome friction more easily the shorter the step is
//! (the sum of kicks over a time grows like its square root, the effect of friction like the time
//! itself). Therefore the time between kicks is a setting of its own. (Noise with a memory, and
//! drag with the same memory, also has the temperature kT, but hardly reaches tiles that bounce
//! within a bond, which is much faster: after 400 s they had a third of it.)
//!
//! # Cut-off
//! A pair's energy is multiplied by a factor that falls smoothly from 1 to 0 between two distances
//! of the reference points, so that energy is conserved; the energy cut off is reported
//! ([`crowd::Cutoff`]).
//!
//! # Why contact is not left to a game engine
//! Measured with rapier2d-f64 0.36.1: a square tile of 0.43 m and 0.1 kg is pressed onto a fixed
//! edge by 30 N, as in a bond, and released 0.1 mm above it with 3 mJ, elastic and without
//! friction. At steps of 0.5 ms to 20 us and contact frequencies of 1 and 4 kHz (damping ratio 1)
//! it has lost all 3 mJ after 0.1 s and lies 9.5 um or 0.6 um inside the edge. Its restitution is
//! right for single collisions, but bound tiles bounce some hundred times a second. So bound tiles
//! on an elastic table would freeze. Here elastic tiles in a bond keep their energy.

pub mod contacts;
pub mod crowd;
mod drive;
pub mod goal;
mod islands;
mod mover;
mod neighbours;
mod pairs;
pub mod run;
mod scratch;
pub mod settings;
pub mod settle;
pub mod start;
mod stepper;
pub mod structures;

pub use crate::rigid::{GRAVITY, Mover, Rim};
pub use crowd::usual_step;
pub use crowd::{Crowd, CrowdError, Kind};
pub use run::{Run, Sample};
pub use settings::{Linear, Orbital, TableSettings};
pub use start::StartError;
pub use stepper::{BlowUp, StepError, Stepper};
