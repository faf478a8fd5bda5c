//! The cost of certified barriers: widths, cells, times, and cells per second.
//!
//! The paper's tile with point dipoles, dipoles behind shields and blocks; without a known pathway,
//! each bracket by a new certifier, including the time to set it up.
//!
//! `cargo bench --bench certificate`

#![allow(clippy::disallowed_methods)]

#[path = "../shared/designs.rs"]
mod designs;
mod ratio;
#[path = "../shared/shields.rs"]
mod shields;

use std::time::Instant;

use tilebind::Configuration;
use tilebind::contact::Contact;
use tilebind::design::Design;
use tilebind::landscape::minimax::{Certifier, Effort, End};
use tilebind::potential::bounds::{CellBounds, CuboidBounds, DipoleBounds, ShieldedBounds};

use ratio::ratio;

/// Rounds of the ratios: in each the three kinds of magnets take turns.
const ROUNDS: usize = 9;

fn main() {
    let design = designs::load("shapes/paper-tile.toml");
    let (fixed, moving) = (&design.pair.fixed, &design.pair.moving);
    println!("point dipoles");
    let dipoles = DipoleBounds::new(fixed, moving);
    measure(&design, &dipoles, 65.47e-3);
    println!("\npoint dipoles behind shields");
    let shielded = ShieldedBounds::new(fixed, moving, &shields::behind_all_faces());
    measure(&design, &shielded, 65.47e-3);
    println!("\nblocks");
    let blocks = CuboidBounds::new(fixed, moving);
    measure(&design, &blocks, 118.64e-3);
    println!();
    let rounds: Vec<[f64; 3]> = (0..ROUNDS)
        .map(|_| {
            [
                seconds_per_cell(&design, &dipoles, 65.47e-3),
                seconds_per_cell(&design, &shielded, 65.47e-3),
                seconds_per_cell(&design, &blocks, 118.64e-3),
            ]
        })
        .collect();
    for (i, name) in [
        (1, "shielded-cell-over-dipoles"),
        (2, "block-cell-over-dipoles"),
    ] {
        ratio(name, rounds.iter().map(|round| round[i] / round[0]));
    }
}

/// Time (s) of a cell of the barrier from the slid state to the bond, to 0.1 % of the bond's depth
/// (J).
fn seconds_per_cell(design: &Design, bounds: &dyn CellBounds, depth: f64) -> f64 {
    let contact = Contact::new(&design.pair.fixed.outline, &design.pair.moving.outline);
    let space = design.space();
    let start = Instant::now();
    let mut certifier = Certifier::new(bounds, Some(&contact), &space);
    let effort = Effort {
        tolerance: 1e-3 * depth,
        cells: 5_000_000,
    };
    let from = Configuration::new(0.43, 0.04, 0.0);
    match certifier.bracket(&from, &End::At(design.pair.bound), &[], &effort) {
        Ok(_) => start.elapsed().as_secs_f64() / certifier.assessed() as f64,
        Err(_) => f64::NAN,
    }
}

/// Brackets several barriers to shares of the bond's depth (J).
fn measure(design: &Design, bounds: &dyn CellBounds, depth: f64) {
    let contact = Contact::new(&design.pair.fixed.outline, &design.pair.moving.outline);
    let space = design.space();
    let queries = [
        (
            "slid by +40 mm, to bound",
            [0.43, 0.04, 0.0],
            End::At(design.pair.bound),
        ),
        ("slid by +40 mm, to free", [0.43, 0.04, 0.0], End::Free),
        (
            "slid by -40 mm, to bound",
            [0.43, -0.04, 0.0],
            End::At(design.pair.bound),
        ),
        ("slid by -40 mm, to free", [0.43, -0.04, 0.0], End::Free),
        ("flush at +140 mm, to free", [0.43, 0.14, 0.0], End::Free),
        (
            "flush at +100 mm, to bound",
            [0.43, 0.1003, 0.0],
            End::At(design.pair.bound),
        ),
    ];
    println!(
        "{:28} {:>9} {:>22} {:>9} {:>9} {:>7} {:>9}",
        "", "asked", "bounds / mJ", "width", "cells", "s", "cells/s"
    );
    for (name, from, to) in queries {
        for share in [1e-2, 1e-3, 1e-4] {
            let start = Instant::now();
            let mut certifier = Certifier::new(bounds, Some(&contact), &space);
            let effort = Effort {
                tolerance: share * depth,
                cells: 5_000_000,
            };
            let found = certifier.bracket(&Configuration::from(from), &to, &[], &effort);
            let time = start.elapsed().as_secs_f64();
            match found {
                Ok(found) => println!(
                    "{name:28} {:8.2}% [{:9.5}, {:9.5}] {:8.4}% {:9} {time:7.3} {:9.0}",
                    share * 100.0,
                    found.bounds.least() * 1e3,
                    found.bounds.upper.unwrap_or(f64::NAN) * 1e3,
                    found.bounds.width() / depth * 100.0,
                    certifier.assessed(),
                    certifier.assessed() as f64 / time
                ),
                Err(error) => println!("{name}: {error}"),
            }
        }
    }
}
