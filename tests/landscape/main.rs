//! Roadmaps, surveys and certificates, tested on landscapes whose answers are known and by
//! symmetries that every answer must have.

mod analytic;
mod certificate;
mod counts;
#[path = "../shared/designs.rs"]
mod designs;
mod roadmap;
mod seam;
mod surfaces;
mod symmetry;
mod walls;
