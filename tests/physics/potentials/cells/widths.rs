//! Exact widths of enclosures over fixed cells: if one of them grows, certificates have become
//! slower; if one shrinks, a term may be missing. If a change is meant to alter them, enter the new
//! numbers here. They have the same bits on every machine.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::cell::Cell;
use tilebind::potential::bounds::{CuboidBounds, DipoleBounds, ShieldedBounds};
use tilebind::potential::shielding::{Shield, Shields};
use tilebind::potential::simd::Level;
use tilebind::potential::{CellBounds, MagnetModel};

use super::super::kinds::{mixed_bounds, paper_tile};
use super::{LYING_DISC, tile_of};
use crate::designs;

/// Mean of the logarithm of the widths (J) over cells about contact that have bounds, and how many
/// these are.
fn mean_width(bounds: &dyn CellBounds, half_side: f64, smallest: f64) -> (f64, usize) {
    let mut rng = ChaCha8Rng::seed_from_u64(31);
    let (mut sum, mut count) = (0.0, 0);
    for _ in 0..400 {
        let size = 10f64.powf(rng.random_range(smallest..-1.5));
        let theta: f64 = [1e-3, 0.02, 0.4][rng.random_range(0..3)] * rng.random_range(-1.0..1.0);
        let contact = half_side * (1.0 + theta.cos() + theta.sin().abs());
        let apart = [0.1, 2e-3, 2e-5][rng.random_range(0..3)] * rng.random_range(-0.1..1.0);
        let cell = Cell {
            centre: Configuration::new(contact + apart, rng.random_range(-0.1..0.1), theta),
            half: [1.0, 1.0, 5.0].map(|shape| size * shape * rng.random_range(0.05..1.0)),
        };
        let enclosure = bounds.enclose(&cell);
        let width = enclosure.high - enclosure.low;
        if width.is_finite() {
            sum += width.ln();
            count += 1;
        }
    }
    (sum / f64::from(count), count as usize)
}

#[test]
fn enclosures_are_as_wide_as_they_were() {
    let [a, b] = ["NNNS", "NSSS"].map(paper_tile);
    let shield = Shield {
        attenuation: 0.4,
        length: 0.03,
        width: 0.1,
        front_gain: 1.1,
    };
    let small = designs::load("shapes/shielded-backs.toml").pair;
    let shields = Shields {
        fixed: vec![Some(shield); 4],
        moving: vec![Some(shield), None, Some(shield), Some(shield)],
        ..Shields::default()
    };
    let level = Level::best();
    let dipoles = DipoleBounds::with_level(&a, &b, level);
    let blocks = CuboidBounds::with_level(&a, &b, level);
    let shielded = ShieldedBounds::with_level(&small.fixed, &small.moving, &shields, level);
    let [c, d] = ["NNNS", "NSSS"].map(|code| tile_of(code, 0.0005, &[LYING_DISC]));
    let discs = mixed_bounds(MagnetModel::Cuboid)([&c, &d], &Shields::default(), level);
    for (name, bounds, half_side, smallest, expected) in [
        (
            "dipoles",
            &dipoles as &dyn CellBounds,
            0.215,
            -5.0,
            (-14.198282429, 400),
        ),
        ("blocks", &blocks, 0.215, -6.0, (-12.327661205, 400)),
        ("shielded", &shielded, 0.04, -5.0, (-15.650531646, 400)),
        ("discs", &*discs, 0.215, -6.0, (-15.524554453, 400)),
    ] {
        let (mean, count) = mean_width(bounds, half_side, smallest);
        assert!(
            (mean - expected.0).abs() < 1e-7 && count == expected.1,
            "{name}: ({mean:.9}, {count})"
        );
    }
}
