//! Properties special to shielded tiles.

use std::f64::consts::PI;

use nalgebra::Vector3;
use tilebind::Configuration;
use tilebind::potential::shielding::{ShieldRule, Shields};
use tilebind::potential::simd::Level;
use tilebind::potential::{DipolePotential, MagnetModel, Potential};
use tilebind::tile::{Magnet, Tile};

use super::kinds::{Make, blocks, bodies_of, dipoles, shielded, shielded_bodies};

#[test]
fn without_shields_it_is_the_bare_model() {
    let level = Level::best();
    let smooth = ShieldRule::Smooth;
    let [point, charged] = [MagnetModel::Dipole, MagnetModel::Cuboid];
    for (kind, bare) in [
        (shielded(point, smooth), dipoles as Make<dyn Potential>),
        (shielded(charged, smooth), blocks),
        (shielded_bodies(point, smooth), bodies_of(point)),
        (shielded_bodies(charged, smooth), bodies_of(charged)),
    ] {
        let potential = kind.energy_of(&kind.tiles, &Shields::default(), level);
        let bare = bare(kind.tiles.each_ref(), &kind.shields, level);
        for q in &kind.poses {
            let (energy, gradient) = potential.energy_and_gradient(q);
            let (expected, slope) = bare.energy_and_gradient(q);
            assert!((energy - expected).abs() < 1e-8 * expected.abs());
            assert!((gradient - slope).norm() < 1e-8 * slope.norm());
        }
    }
}

#[test]
fn a_closed_way_costs_nothing() {
    let potential = shielded(MagnetModel::Dipole, ShieldRule::Smooth).energy(Level::best());
    // Round a loop in x, y and theta, by the trapezoidal rule (exponentially accurate here).
    let at =
        |t: f64| Configuration::new(0.25 + 0.02 * t.cos(), 0.03 * t.sin(), 0.2 * (2.0 * t).sin());
    let steps = 400;
    let (mut work, mut travelled) = (0.0, 0.0);
    for i in 0..steps {
        let t = std::f64::consts::TAU * i as f64 / steps as f64;
        let velocity = Vector3::new(-0.02 * t.sin(), 0.03 * t.cos(), 0.4 * (2.0 * t).cos());
        let power = potential.energy_and_gradient(&at(t)).1.dot(&velocity);
        work += power;
        travelled += power.abs();
    }
    assert!(work.abs() < 1e-10 * travelled, "{work} of {travelled}");
}

#[test]
fn the_nearest_face_rule_counts_one_pair_of_faces_and_jumps() {
    let kind = shielded(MagnetModel::Dipole, ShieldRule::NearestFace);
    let potential = kind.energy(Level::best());
    let [fixed, moving] = kind.tiles;
    let on_face = |tile: &Tile, face: usize| -> Vec<Magnet> {
        let mine = tile.magnets.iter().filter(|magnet| magnet.face == face);
        mine.cloned().collect()
    };
    let east_west = DipolePotential::new(&on_face(&fixed, 0), &on_face(&moving, 2));
    let q = Configuration::new(0.22, 0.01, 0.02);
    let energy = potential.energy(&q);
    assert!((energy - east_west.energy(&q)).abs() < 1e-12 * energy.abs());

    // Near an eighth of a turn another face becomes the nearest: the energy steps, by as much
    // however finely the turn is sampled.
    let steepest = |step: f64| {
        let at = |n: i32| {
            let turn = PI / 4.0 + step * (f64::from(n) + 0.5);
            potential.energy(&Configuration::new(0.26, 0.01, turn))
        };
        let count = (0.2 / step) as i32;
        let steps = (-count..count).map(|n| (at(n + 1) - at(n)).abs());
        steps.fold(0.0, f64::max)
    };
    let (coarse, fine) = (steepest(4e-3), steepest(1e-5));
    assert!(fine > 0.5 * coarse && fine > 1e-7, "{coarse} J, {fine} J");
}
