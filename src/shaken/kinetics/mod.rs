//! Kinetics of shaken tiles on a landscape: how strongly a state holds at kT, how soon a tile
//! leaves it and where it goes, and the yield in the end.
//!
//! One folder a question: [`bond`] how strongly a state holds, [`rates`] how soon tiles leave a state
//! and which one they reach next (on a `mesh`), [`population`] how many tiles of a table are bound in
//! the end.
//!
//! kT (J) is an effective energy of shaking, see [`crate::dynamics`]; this module assumes that a
//! table has one.
//!
//! # The equations
//! With the drag c (kg/s), uniform over the tile's mass, and the effective energy kT (J) of its
//! shaking, the moving tile diffuses with D = kT/c in x and y and D/rho^2 in theta, is driven by
//! the magnets and reflected by contact. Averages follow from two equations over the free
//! configurations (Gardiner, *Handbook of Stochastic Methods*, section 5.4; E and Vanden-Eijnden,
//! doi:10.1007/s10955-005-9003-9):
//!
//! - mean exit time t: `div(D e^(-U/kT) grad t) = -e^(-U/kT)`, t = 0 at the ends;
//! - committor q: `div(D e^(-U/kT) grad q) = 0`, q = 1 on one end and 0 on the others;
//!
//! with no flux through contact. Both are solved by finite elements on an octree. The weight
//! e^(-U/kT) is integrated over the free part of each cell, so the mesh need not follow contact,
//! and a layer of e^(-U/kT) along contact can be thinner than a cell. The energy of the computed
//! committor is an upper bound of the capacity (Dirichlet's principle), up to the quadrature.
//!
//! # Lifetimes and drag
//! How often a state is occupied depends only on kT; how long it lasts also depends on the drag. In
//! overdamped motion (`tilebind rates`, and `tilebind yield --rates overdamped`) every time is
//! proportional to the drag: lifetimes at 100 /s are twice those at 50 /s. With little drag tiles
//! have inertia, cross barriers in flight and return over them: by default `tilebind yield` counts
//! attachments in docking runs at 0.005 /s, and lifetimes of its states are shorter by orders of
//! magnitude than those of overdamped motion at [`OVERDAMPED`]. Neither is wrong; a table has one
//! drag, and both commands accept it (`--drag`). Lifetimes also refer to a *set*: `rates` counts a
//! pair as bound until it is free or in another state, including the region between them (which
//! committors divide); for docking runs, detachment follows by detailed balance from the bond's
//! basin alone. At a depth of 15 kT or more the two sets have the same occupation; below 10 kT the
//! definition of bound matters. `yield --rates overdamped` takes all rates from `rates`, including
//! those from state to state, so that both commands agree.
//!
//! # Errors
//! Errors of rates and of mean exit times are estimated, not bounded: from the difference of the two
//! finest meshes, from the jumps of the committors' gradients, and by Hadamard's formula for basins
//! that consist of whole cells. `tilebind rates --check` compares an exit with rigid bodies that are
//! simulated. Bounds from both sides exist (Dirichlet's and Thomson's principle), but only if the
//! integrals of e^(-U/kT) and e^(U/kT) over cells are exact. By Gauss quadrature they are not: 64 kT
//! below a pass such bounds were 10 % apart and excluded the mean exit time by a factor of 2.4.
//!
//! # What a mesh may miss
//! Corridors between contacts that are narrower than cells. If no path out of a state is found,
//! cells that contact does not prove blocked are divided down to [`NARROW`], until a path is found
//! or excluded; the result states which ([`PathToFree`]). If a path is found, a second, narrower one with
//! a lower barrier may still be missed.
//!
//! # Lengths
//! If all lengths are scaled by s, with magnets of the same remanence, moments scale as s^3,
//! energies as s^3, forces as s^2 and torques as s^3. At kT s^3 a landscape is the same except for
//! its size; wells' integrals and mean exit times times D scale as s^2, and docking costs at the
//! same coverage do not change (exact, and tested). That the force between two given magnets
//! decreases with the fourth power of their distance is a different statement, for unchanged
//! magnets.

pub mod bond;
mod mesh;
pub mod population;
pub mod rates;

pub use bond::volume::Estimate;
pub use bond::well::Well;
pub use bond::{BondError, Hold};
pub use rates::corridor::{NARROW, PathToFree};

/// Drag rate (1/s) above which the inertia of tiles has no effect on mean times.
pub const OVERDAMPED: f64 = 50.0;
