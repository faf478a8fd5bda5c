//! Kinetics of shaken tiles on a landscape: how strongly a state holds at kT, how soon a tile
//! leaves it and where it goes, and the yield in the end.
//!
//! kT (J) is an effective energy of shaking, see [`crate::dynamics`]; nothing here says that a
//! table has one.
//!
//! # The equations
//! With the drag c (kg/s) on the tile's mass, spread evenly, and the effective energy kT (J) of its
//! shaking, the moving tile diffuses with D = kT/c in x and y and D/rho^2 in theta, is pushed by
//! the magnets and reflected by contact. What it does on average follows from two equations over
//! the free configurations (Gardiner, *Handbook of Stochastic Methods*, section 5.4; E and
//! Vanden-Eijnden, doi:10.1007/s10955-005-9003-9):
//!
//! - mean exit time t: `div(D e^(-U/kT) grad t) = -e^(-U/kT)`, t = 0 where it ends;
//! - committor q: `div(D e^(-U/kT) grad q) = 0`, q = 1 on one end and 0 on the others;
//!
//! with no flux through contact. Both are solved by finite elements on an own octree, in which the
//! weight e^(-U/kT) is integrated over what is free of each cell: contact needs no mesh of its own,
//! and a layer of e^(-U/kT) along it may be thinner than a cell. The energy of the computed
//! committor is an upper bound of the capacity (Dirichlet's principle), but for the quadrature. Lower
//! bounds come of fluxes without sources (Thomson's principle), on a second mesh whose cells begin at
//! contact: through those that contact cuts no such flux would go. From both follow bounds of rates
//! and of mean exit times.
//!
//! # Lifetimes and drag
//! How often a state holds depends on kT alone, how long it holds depends on the drag as well. In
//! overdamped motion (`tilebind rates`, and `tilebind yield --rates overdamped`) every time is
//! proportional to the drag: 100 /s makes every lifetime twice that of 50 /s. With little drag tiles have
//! inertia, cross barriers in flight and come back over them: `tilebind yield` counts attachments in docking
//! runs at 0.005 /s unless told otherwise, and lifetimes of its states are shorter by orders of magnitude
//! than those of overdamped motion at [`OVERDAMPED`]. Neither is wrong; a table has one drag, and both
//! commands take it (`--drag`). Lifetimes are also those of a *set*: `rates` counts a pair as bound until it
//! is free or in another state, wherever between them it is (committors share that out); docking runs have
//! detachment by detailed balance from the bond's basin alone. At a depth of 15 kT or more the two sets
//! hold the same; below 10 kT what is called bound decides. `yield --rates overdamped` takes all rates
//! as `rates` solves them, those from state to state included, so that the same question has one answer.
//!
//! # What is proved
//! Two kinds of bounds. Those of mean exit times and of rates between places hold *on the mesh*: that
//! a trial function bounds a capacity from above and a flux from below is a theorem, and what the
//! flux loses on its way to rounding and to the solver's last step is subtracted. Two things are not
//! in them. The integrals of e^(-U/kT) and e^(U/kT) over cells come of Gauss' rule; within cells e^(-U/kT) is
//! taken to fall along s as between its ends and to be tilted along phi and theta, where the flux of
//! the mean exit time has it for its source. And a basin is
//! made of the cells whose mean of U lies below its limit; by Hadamard's formula, what that shifts
//! capacities by is estimated, stated with each mesh, and makes the mesh be refined there.
//! The capacity of the well about an exit's start against its ends, or of each basin against the
//! others and free tiles, and how often tiles set out from it for them, are *proved* where that is
//! asked for: `proof` has integrals and sets enclosed by the energies' bounds over cells
//! ([`crate::potential::CellBounds`]), see [`Capacity`]. That takes convex outlines of few corners
//! about their centres of mass. The mean exit time counts what lies between well and ends as well,
//! by the probability to come back from there, of which no more is proved than that it is at most 1:
//! its proved bounds ([`Capacity::mean_exit`]) are near each other only where next to nothing lies
//! there.
//! A mesh begins at contact where every ray from the centre leaves that once and for good
//! ([`crate::contact::Contact::least_lever`]): convex outlines, tabs and slots whose sides lean, sine
//! and triangle teeth, arcs. Dovetails hook in and square teeth have walls along the way out: there
//! bounds come from one side only, Dirichlet's.
//!
//! # What a mesh may miss
//! Corridors between contacts that are narrower than cells. Where no way out of a state shows, cells
//! that contact does not prove blocked are divided down to [`NARROW`], until a way shows or is
//! excluded; which of the two stands beside the result ([`Way`]). Where a way shows, a second and
//! narrower one of a lower barrier may still be missed.
//!
//! # Lengths
//! Lengths times s, with magnets of the same remanence: moments grow by s^3, energies by s^3, forces
//! by s^2, torques by s^3. At kT s^3 a landscape is the same but for its size, wells' integrals and
//! mean exit times times D grow by s^2, and docking costs at the same coverage not at all (exact, and
//! tested). That the force between two given magnets falls with the fourth power of their distance is
//! another statement: there the magnets stay what they are.

pub mod bond;
mod bracket;
mod certify;
pub mod chain;
pub mod corner;
mod corridor;
mod crowd;
pub mod distance;
mod errors;
pub mod exit;
mod field;
mod frame;
mod line;
mod links;
pub mod map;
mod mesh;
pub mod mixture;
mod narrow;
pub mod numbers;
mod places;
pub mod population;
mod proof;
pub mod rates;
mod results;
mod rim;
mod root;
mod sets;
pub mod stiff;
pub mod volume;
pub mod well;

pub use bond::{BondError, Hold};
pub use certify::why_unprovable;
pub use corridor::{NARROW, Way};
pub use proof::Capacity;
pub use results::Certify;
pub use volume::Estimate;
pub use well::Well;

/// Drag rate (1/s) from which on tiles move as if they had no inertia, as far as means over times tell.
pub const OVERDAMPED: f64 = 50.0;
