//! Roadmaps, surveys, certificates and what follows from them, tested on landscapes with known
//! answers, on real tiles, and by symmetries that every answer must have.

#![allow(clippy::disallowed_methods)]

mod analytic;
mod barriers;
mod budgets;
mod catalogue;
mod counts;
#[path = "../shared/designs.rs"]
mod designs;
mod many_magnets;
mod meetings;
mod minimax;
mod minimum;
mod missing_states;
mod neighbours;
mod pathways;
#[allow(dead_code)]
#[path = "../shared/plain.rs"]
mod plain;
mod queries;
mod ranking;
mod roadmap;
mod scales;
mod seam;
#[path = "../shared/shields.rs"]
mod shields;
mod surfaces;
mod surveys;
mod symmetry;
mod transition_network;
mod volume;
mod walls;
