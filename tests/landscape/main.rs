//! Roadmaps, surveys, certificates and what is made of them, tested on landscapes whose answers are
//! known, on real tiles, and by symmetries that every answer must have.

#![allow(clippy::disallowed_methods)]

mod analytic;
mod barriers;
mod certificate;
mod completeness;
mod counts;
#[path = "../shared/designs.rs"]
mod designs;
mod inventory;
mod many_magnets;
mod meetings;
mod minimum;
mod neighbours;
mod network;
mod pathways;
mod queries;
mod ranking;
mod roadmap;
mod seam;
mod surfaces;
mod symmetry;
mod volume;
mod walls;
