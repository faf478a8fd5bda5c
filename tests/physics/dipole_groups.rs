//! Very many dipoles, in a tabulated field and in groups that fewer stand for, against the sum over
//! all pairs.

use std::f64::consts::PI;

use nalgebra::{Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::potential::batch::Level;
use tilebind::potential::dipole::{Dipole, ScalarDipoles};
use tilebind::potential::{DipolePotential, Potential};
use tilebind::units::MU0_OVER_4PI;

/// Tiles of 0.4 m with many dipoles: along the faces of a regular polygon, `wave` (m) up and down
/// from them, north and south at random or all alike.
fn tile(rng: &mut ChaCha8Rng, faces: usize, each: usize, wave: f64, alike: bool) -> Vec<Dipole> {
    let apothem = 0.2;
    let side = 2.0 * apothem * (PI / faces as f64).tan();
    let mut dipoles = Vec::new();
    for face in 0..faces {
        let angle = 2.0 * PI * face as f64 / faces as f64;
        let normal = Vector2::new(angle.cos(), angle.sin());
        let along = Vector2::new(-angle.sin(), angle.cos());
        for k in 0..each {
            let s = side * ((k as f64 + 0.5) / each as f64 - 0.5);
            let h = wave * (40.0 * s / side).sin() - 0.002;
            let pole = if alike || rng.random() { 0.01 } else { -0.01 };
            dipoles.push(Dipole {
                position: normal * (apothem + h) + along * s,
                moment: normal * pole,
            });
        }
    }
    dipoles
}

/// Face to face, slid along, at corners, tilted, near and far.
fn poses(rng: &mut ChaCha8Rng, faces: usize, count: usize) -> Vec<Configuration> {
    let turn = 2.0 * PI / faces as f64;
    let poses = (0..count).map(|i| {
        let quarter = turn * rng.random_range(0..faces) as f64;
        let (away, theta) = match i % 4 {
            0 => (0.4, PI + quarter),
            1 => (0.4 + 0.1 * rng.random::<f64>(), rng.random_range(-PI..PI)),
            2 => (rng.random_range(0.45..1.0), PI + quarter),
            _ => (rng.random_range(0.6..3.0), rng.random_range(-PI..PI)),
        };
        Configuration::new(away, rng.random_range(-0.5..0.5), theta)
    });
    poses.collect()
}

/// Sums over all pairs of `K / r^3`, `3 K / r^4` and their moments: what errors are a share of.
fn magnitudes(fixed: &[Dipole], moving: &[Dipole], q: &Configuration) -> (f64, Vector3<f64>) {
    let (mut energy, mut gradient) = (0.0, Vector3::zeros());
    for second in moving {
        for first in fixed {
            let r = (q.transform(second.position) - first.position).norm();
            let u = MU0_OVER_4PI * first.moment.norm() * second.moment.norm() / r.powi(3);
            let force = 3.0 * u / r;
            energy += u;
            gradient += Vector3::new(force, force, u + second.position.norm() * force);
        }
    }
    (energy, gradient)
}

const SHAPES: [(usize, usize, f64, bool); 5] = [
    (4, 64, 0.0, false),
    (4, 64, 0.0, true),
    (4, 200, 0.004, false),
    (64, 4, 0.0, false),
    (1, 300, 0.0, true),
];

/// (One face: a row.)
fn faces_of(faces: usize) -> usize {
    faces.max(4)
}

#[test]
fn energies_and_gradients_are_those_of_all_pairs() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for (faces, each, wave, alike) in SHAPES {
        let tiles = [0; 2].map(|_| {
            let mut dipoles = tile(&mut rng, faces_of(faces), each, wave, alike);
            dipoles.truncate(faces * each);
            dipoles
        });
        let [fixed, moving] = &tiles;
        let scalar = ScalarDipoles::new(fixed, moving);
        let level = Level::best();
        let grouped = DipolePotential::with_level(fixed, moving, level);
        let mut worst = [0f64; 2];
        for q in poses(&mut rng, faces_of(faces), 60) {
            let (energy, gradient) = grouped.energy_and_gradient(&q);
            let (expected, slope) = scalar.energy_and_gradient(&q);
            let (size, sizes) = magnitudes(fixed, moving, &q);
            let off = (gradient - slope).abs().component_div(&sizes).max();
            worst[0] = worst[0].max((energy - expected).abs() / size);
            worst[1] = worst[1].max(off);
        }
        println!("{faces} x {each}: {worst:?}");
        // What is lost, and what is rounded.
        assert!(worst[0] <= 1.1e-11, "{faces} x {each}: {worst:?}");
        assert!(worst[1] <= 1e-10, "{faces} x {each}: {worst:?}");
    }
}

#[test]
fn one_or_many_give_the_same_bits() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let [fixed, moving] = [0; 2].map(|_| tile(&mut rng, 4, 40, 0.001, false));
    let qs = poses(&mut rng, 4, 40);
    for level in Level::available() {
        let kernel = DipolePotential::with_level(&fixed, &moving, level);
        let mut energies = vec![0.0; qs.len()];
        kernel.energies(&qs, &mut energies);
        for (q, energy) in qs.iter().zip(&energies) {
            let (same, _) = kernel.energy_and_gradient(q);
            assert_eq!(same.to_bits(), energy.to_bits());
            assert_eq!(same.to_bits(), kernel.energy(q).to_bits());
        }
    }
}

/// The bounds of derivatives hold for the sum over all pairs along random motions, by differences
/// that are far larger than what is lost.
#[test]
fn bounds_of_derivatives_hold() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let [fixed, moving] = [0; 2].map(|_| tile(&mut rng, 4, 64, 0.0, true));
    let scalar = ScalarDipoles::new(&fixed, &moving);
    let grouped = DipolePotential::with_level(&fixed, &moving, Level::best());
    for q in poses(&mut rng, 4, 40) {
        let mut direction = || rng.random_range(-1.0..1.0);
        let step = Vector3::new(direction(), direction(), direction());
        let step = step / grouped.displacement(step);
        let h = 1e-3;
        let at = |k: f64| scalar.energy(&q.moved(step * (k * h)));
        let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(at);
        let second = (b - 2.0 * c + d) / (h * h);
        let fourth = (a - 4.0 * b + 6.0 * c - 4.0 * d + e) / h.powi(4);
        let (size, _) = magnitudes(&fixed, &moving, &q);
        let reach = 2.0 * h;
        let bounds = [
            grouped.curvature_bound(&q, reach) + 1e-12 * size / (h * h),
            grouped.fourth_derivative_bound(&q, reach) + 1e-12 * size / h.powi(4),
        ];
        // Beyond the table the tiles are bounded as wholes.
        let narrow = scalar.fourth_derivative_bound(&q, reach);
        let is_narrow = bounds[1] <= 2.0 * narrow + 1e-12 * size / h.powi(4);
        assert!(is_narrow || q.x > 1.9, "{q:?}: {bounds:?}, {narrow}");
        assert!(second.abs() <= bounds[0], "{q:?}: {second} {bounds:?}");
        assert!(fourth.abs() <= bounds[1], "{q:?}: {fourth} {bounds:?}");
    }
}
