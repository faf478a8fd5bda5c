//! Tests of certified barriers.

mod analytic;
mod caged;
mod grid;
mod paper_tile;
mod quadratic;
mod random_designs;
mod scene;
mod slots;
