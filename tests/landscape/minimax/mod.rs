//! Certified barriers, attacked from all sides.

mod analytic;
mod caged;
mod grid;
mod paper_tile;
mod quadratic;
mod random_designs;
mod scene;
mod slots;
