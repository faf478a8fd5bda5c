//! Far groups of dipoles that fewer stand for, against the sum over all pairs.

use std::f64::consts::PI;

use nalgebra::{Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::potential::batch::Level;
use tilebind::potential::dipole::{Dipole, ScalarDipoles};
use tilebind::potential::parts::Part;
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
        assert!(second.abs() <= bounds[0], "{q:?}: {second} {bounds:?}");
        assert!(fourth.abs() <= bounds[1], "{q:?}: {fourth} {bounds:?}");
    }
}

/// Motions from some poses, one as long as `length` (m) for each.
fn motions(rng: &mut ChaCha8Rng, grouped: &DipolePotential, length: f64) -> [Vector3<f64>; 2] {
    let mut direction = || rng.random_range(-1.0..1.0);
    let step = Vector3::new(direction(), direction(), direction());
    let slide = Vector3::new(0.0, 1.0, 0.0);
    [step, slide].map(|step| step * (length / grouped.displacement(step)))
}

/// The cubic through values and slopes at 0 and 1.
fn cubic([a, b]: [(f64, f64); 2], t: f64) -> f64 {
    let (t2, t3) = (t * t, t * t * t);
    a.0 * (2.0 * t3 - 3.0 * t2 + 1.0)
        + a.1 * (t3 - 2.0 * t2 + t)
        + b.0 * (3.0 * t2 - 2.0 * t3)
        + b.1 * (t3 - t2)
}

/// Slow and fast parts, of motions ever shorter as in halving a stretch, add up to all pairs; the
/// slow ones' cubic is off by no more than is said and allowed, and the fast ones' fourth
/// derivative is within its bound.
#[test]
fn slow_parts_are_slow_and_nothing_is_left_out() {
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let mut most = 0f64;
    for (faces, each, wave, alike) in SHAPES {
        let [fixed, moving] = [0; 2].map(|_| {
            let mut dipoles = tile(&mut rng, faces_of(faces), each, wave, alike);
            dipoles.truncate(faces * each);
            dipoles
        });
        let scalar = ScalarDipoles::new(&fixed, &moving);
        let grouped = DipolePotential::with_level(&fixed, &moving, Level::best());
        // (Around a polygon of very many sides none stand for others.)
        let Some(parts) = grouped.parts() else {
            assert!(faces > 4, "{faces} x {each}: rows are put in groups");
            continue;
        };
        for q in poses(&mut rng, faces_of(faces), 12) {
            for length in [0.1, 0.01, 1e-3] {
                for step in motions(&mut rng, &grouped, length) {
                    let (size, _) = magnitudes(&fixed, &moving, &q);
                    let allowed = 1e-6 * size;
                    let mut open: Vec<Part> = vec![parts.whole()];
                    let mut slow: Vec<Part> = Vec::new();
                    // First as on longer stretches around.
                    for longer in [4.0, 1.0] {
                        let reach = longer * length / 2.0;
                        let sifted = parts.sift(&open, &q, reach, allowed);
                        assert!(sifted.off <= allowed, "{sifted:?}");
                        slow.extend(&sifted.slow);
                        open = sifted.fast.clone();
                        if longer > 1.0 {
                            continue;
                        }
                        let end = |t: f64| {
                            let at = q.moved(step * (t - 0.5));
                            let known = parts.energy_and_gradient_of(&sifted.slow, &at, true);
                            (known.0, known.1.dot(&step))
                        };
                        let ends = [end(0.0), end(1.0)];
                        for k in 0..=10 {
                            let t = f64::from(k) / 10.0;
                            let at = q.moved(step * (t - 0.5));
                            let (slow, _) = parts.energy_and_gradient_of(&sifted.slow, &at, false);
                            let off = (cubic(ends, t) - slow).abs();
                            assert!(off <= sifted.off + 1e-11 * size, "{off} {}", sifted.off);
                            most = most.max(off / sifted.off.max(f64::MIN_POSITIVE));
                        }
                    }
                    let all = [slow, open.clone()].concat();
                    let (energy, _) = parts.energy_and_gradient_of(&all, &q, false);
                    assert!((energy - scalar.energy(&q)).abs() <= 2e-11 * size);
                    let h = 1e-3;
                    let unit = step / grouped.displacement(step);
                    let at = |k: f64| {
                        let at = q.moved(unit * (k * h));
                        parts.energy_and_gradient_of(&open, &at, false).0
                    };
                    let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(at);
                    let fourth = (a - 4.0 * b + 6.0 * c - 4.0 * d + e) / h.powi(4);
                    let bound = parts.fourth_derivative_bound_of(&open, &q, 2.0 * h);
                    assert!(fourth.abs() <= bound + 1e-9 * size / h.powi(4));
                }
            }
        }
    }
    assert!(most > 1e-3, "far too wide, {most}");
}
