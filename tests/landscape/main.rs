//! Roadmaps and surveys, tested on landscapes whose answers are known and by symmetries that every
//! answer must have.

mod analytic;
mod roadmap;
mod surfaces;
mod symmetry;
mod walls;
