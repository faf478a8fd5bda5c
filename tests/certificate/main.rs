//! Certified barriers, attacked from all sides.

mod analytic;
mod caged;
#[path = "../shared/designs.rs"]
mod designs;
mod grid;
mod paper_tile;
mod random_designs;
mod scene;
#[path = "../landscape/surfaces.rs"]
mod surfaces;
