//! Enclosures of shielded dipoles' energy over cells.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::cell::Cell;
use tilebind::contact::Contact;
use tilebind::potential::batch::Level;
use tilebind::potential::bounds::ShieldedBounds;
use tilebind::potential::shielding::{Shield, Shields};
use tilebind::potential::{CellBounds, MagnetModel, Potential, ShieldedPotential};
use tilebind::tile::Tile;

use super::assert_encloses;
use crate::designs;

/// Squares of 8 cm with two magnets on each face.
fn tiles() -> (Tile, Tile) {
    let design = designs::load("shapes/shielded-backs.toml");
    (design.pair.fixed.clone(), design.pair.moving.clone())
}

/// Shields on all faces of the one tile and on all but one of the other's.
fn shields(rng: &mut ChaCha8Rng) -> Shields {
    let mut shield = || Shield {
        attenuation: rng.random_range(0.0..1.0),
        length: 10f64.powf(rng.random_range(-2.5..-0.5)),
        width: 10f64.powf(rng.random_range(-3.0..0.0)),
        front_gain: rng.random_range(0.8..1.3),
    };
    Shields {
        fixed: (0..4).map(|_| Some(shield())).collect(),
        moving: (0..4).map(|k| (k > 0).then(&mut shield)).collect(),
        ..Shields::default()
    }
}

#[test]
fn no_free_configuration_of_a_cell_lies_outside_its_enclosure() {
    let (a, b) = tiles();
    let contact = Contact::new(&a.outline, &b.outline);
    for level in Level::available() {
        let mut rng = ChaCha8Rng::seed_from_u64(21);
        let (mut tested, mut large) = (0, 0);
        for _ in 0..2000 {
            let shields = shields(&mut rng);
            let bounds = ShieldedBounds::with_level(&a, &b, &shields, level);
            let potential = ShieldedPotential::new(MagnetModel::Dipole, &a, &b, &shields);
            let size = 10f64.powf(rng.random_range(-5.0..-1.0));
            let cell = Cell {
                centre: Configuration::new(
                    rng.random_range(0.06..0.12),
                    rng.random_range(-0.08..0.08),
                    rng.random_range(-0.8..0.8),
                ),
                half: [1.0, 1.0, 10.0].map(|scale| scale * size * rng.random_range(0.0..1.0)),
            };
            let enclosure = bounds.enclose(&cell);
            let free = assert_encloses(&enclosure, &potential, &contact, &cell, &mut rng);
            tested += free;
            large += if size > 0.01 { free } else { 0 };
        }
        assert!(tested > 10_000 && large > 2_000, "{tested} {large}");
    }
}

#[test]
fn what_the_form_leaves_out_is_of_third_order() {
    let (a, b) = tiles();
    let shield = Shield {
        attenuation: 0.8,
        length: 0.03,
        width: 0.3,
        front_gain: 1.1,
    };
    let shields = Shields {
        fixed: vec![Some(shield); 4],
        ..Shields::default()
    };
    let bounds = ShieldedBounds::new(&a, &b, &shields);
    let width = |h: f64| {
        let enclosure = bounds.enclose(&Cell {
            centre: Configuration::new(0.09, 0.01, 0.1),
            half: [h, h, 10.0 * h],
        });
        enclosure.high - enclosure.low
    };
    let ratio = width(1e-4) / width(1e-5);
    assert!((ratio - 1000.0).abs() < 200.0, "{ratio}");
}

#[test]
fn a_cell_of_no_size_gives_the_energy_and_its_gradient() {
    let (a, b) = tiles();
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for _ in 0..20 {
        let shields = shields(&mut rng);
        let bounds = ShieldedBounds::new(&a, &b, &shields);
        let potential = ShieldedPotential::new(MagnetModel::Dipole, &a, &b, &shields);
        let q = Configuration::new(0.085, -0.02, 0.03);
        let enclosure = bounds.enclose(&Cell {
            centre: q,
            half: [0.0; 3],
        });
        let (energy, gradient) = potential.energy_and_gradient(&q);
        assert!((enclosure.form.value - energy).abs() < 1e-14);
        for i in 0..3 {
            let slope = enclosure.form.gradient[i];
            assert!((slope - gradient[i]).abs() < 1e-12 * (1.0 + slope.abs()));
        }
        assert!(enclosure.high < 1e-11, "{}", enclosure.high);
    }
}

#[test]
fn magnets_that_may_coincide_are_unknown() {
    // On corners, where no depth keeps them apart.
    let (mut a, mut b) = tiles();
    for tile in [&mut a, &mut b] {
        tile.magnets[0].position = tile.outline.vertices()[0];
    }
    let bounds = ShieldedBounds::new(&a, &b, &Shields::default());
    let enclosure = bounds.enclose(&Cell {
        centre: Configuration::new(0.0, 0.0, 0.0),
        half: [0.1, 0.1, 0.1],
    });
    assert_eq!(enclosure.low, f64::NEG_INFINITY);
}
