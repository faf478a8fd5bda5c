//! The kernel of point dipoles against the scalar formula, for every instruction set.

use std::f64::consts::PI;

use nalgebra::{Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::potential::batch::Level;
use tilebind::potential::batch::lanes::{Lanes, Task, WIDTH};
use tilebind::potential::dipole::{Dipole, ScalarDipoles};
use tilebind::potential::{DipolePotential, Potential};
use tilebind::units::MU0_OVER_4PI;

/// Dipoles in a disc of radius 0.3 m, at any angle, of moments from 0.1 to 1 A m^2.
fn random_dipoles(rng: &mut ChaCha8Rng, count: usize) -> Vec<Dipole> {
    let polar = |radius: f64, angle: f64| Vector2::new(angle.cos(), angle.sin()) * radius;
    (0..count)
        .map(|_| Dipole {
            position: polar(0.3 * rng.random::<f64>().sqrt(), rng.random_range(-PI..PI)),
            moment: polar(rng.random_range(0.1..1.0), rng.random_range(-PI..PI)),
        })
        .collect()
}

/// Sums over all pairs of their magnitudes: `K / r^3` for the energy, `3 K / r^4` for the force.
/// (The terms of one pair may cancel, so a pair's own energy is no measure of its error.)
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

/// Configurations far away, near, and with a random pair of dipoles 1 cm apart.
fn random_configurations(
    rng: &mut ChaCha8Rng,
    fixed: &[Dipole],
    moving: &[Dipole],
    count: usize,
) -> Vec<Configuration> {
    (0..count)
        .map(|i| {
            let theta = rng.random_range(-PI..PI);
            let angle: f64 = rng.random_range(-PI..PI);
            let away = Vector2::new(angle.cos(), angle.sin());
            let position = match i % 3 {
                0 => away * 10f64.powf(rng.random_range(0.0..3.0)),
                1 => away * rng.random_range(0.0..1.0),
                _ => {
                    let at = Configuration::new(0.0, 0.0, theta);
                    let second = &moving[rng.random_range(0..moving.len())];
                    let first = &fixed[rng.random_range(0..fixed.len())];
                    first.position + away * 0.01 - at.transform(second.position)
                }
            };
            Configuration::new(position.x, position.y, theta)
        })
        .collect()
}

#[test]
fn every_level_equals_the_scalar_formula() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for (n, m) in [
        (1, 1),
        (1, 3),
        (5, 2),
        (4, 9),
        (16, 16),
        (12, 17),
        (100, 90),
    ] {
        let (fixed, moving) = (random_dipoles(&mut rng, n), random_dipoles(&mut rng, m));
        let qs = random_configurations(&mut rng, &fixed, &moving, 300);
        let scalar = ScalarDipoles::new(&fixed, &moving);
        for level in Level::available() {
            let kernel = DipolePotential::with_level(&fixed, &moving, level);
            let mut worst = 0f64;
            for q in &qs {
                let (energy, gradient) = kernel.energy_and_gradient(q);
                let (expected, slope) = scalar.energy_and_gradient(q);
                let (size, sizes) = magnitudes(&fixed, &moving, q);
                worst = worst.max((energy - expected).abs() / size);
                let off = (gradient - slope).abs().component_div(&sizes).max();
                worst = worst.max(off);
            }
            println!("{level} {n} x {m}: {worst:.1e}");
            assert!(
                worst <= 1e-12,
                "{level}, {n} x {m} dipoles: off by {worst:e}"
            );
        }
    }
}

#[test]
fn one_or_many_give_the_same_bits() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for (n, m) in [(3, 1), (2, 5), (16, 16), (7, 19)] {
        let (fixed, moving) = (random_dipoles(&mut rng, n), random_dipoles(&mut rng, m));
        let qs = random_configurations(&mut rng, &fixed, &moving, 37);
        for level in Level::available() {
            let kernel = DipolePotential::with_level(&fixed, &moving, level);
            for start in 0..10 {
                let qs = &qs[start..];
                let mut energies = vec![0.0; qs.len()];
                kernel.energies(qs, &mut energies);
                let mut both = vec![(0.0, Vector3::zeros()); qs.len()];
                kernel.energies_and_gradients(qs, &mut both);
                for (i, q) in qs.iter().enumerate() {
                    assert_eq!(both[i], kernel.energy_and_gradient(q), "{level} {n} x {m}");
                    assert_eq!(both[i].0.to_bits(), energies[i].to_bits());
                    assert_eq!(both[i].0.to_bits(), kernel.energy(q).to_bits());
                }
            }
        }
    }
}

#[test]
fn bounds_of_derivatives_equal_the_scalar_formula() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for (n, m) in [(1, 1), (16, 16), (7, 19)] {
        let (fixed, moving) = (random_dipoles(&mut rng, n), random_dipoles(&mut rng, m));
        let scalar = ScalarDipoles::new(&fixed, &moving);
        for q in random_configurations(&mut rng, &fixed, &moving, 300) {
            for level in Level::available() {
                let kernel = DipolePotential::with_level(&fixed, &moving, level);
                for reach in [0.0, 0.002, 0.02] {
                    let bounds = |potential: &dyn Potential| {
                        [
                            potential.curvature_bound(&q, reach),
                            potential.fourth_derivative_bound(&q, reach),
                        ]
                    };
                    for (bound, expected) in bounds(&kernel).iter().zip(bounds(&scalar)) {
                        assert!(
                            *bound == expected || (bound / expected - 1.0).abs() < 1e-11,
                            "{level}: {bound:e} and not {expected:e}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn coincident_dipoles_are_infinitely_high() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let (fixed, moving) = (random_dipoles(&mut rng, 5), random_dipoles(&mut rng, 3));
    let mut moving = moving;
    moving[1].position = fixed[2].position;
    let q = Configuration::new(0.0, 0.0, 0.0);
    for level in Level::available() {
        let kernel = DipolePotential::with_level(&fixed, &moving, level);
        assert_eq!(
            kernel.energy_and_gradient(&q),
            (f64::INFINITY, Vector3::zeros())
        );
        let mut energies = [0.0; 2];
        kernel.energies(&[q, Configuration::new(9.0, 0.0, 0.0)], &mut energies);
        assert_eq!(energies[0], f64::INFINITY);
        assert!(energies[1].is_finite());
        assert_eq!(kernel.curvature_bound(&q, 0.0), f64::INFINITY);
    }
}

#[test]
fn no_dipoles_no_energy() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let some = random_dipoles(&mut rng, 3);
    let q = Configuration::new(0.5, 0.0, 0.0);
    for level in Level::available() {
        for (fixed, moving) in [(&some[..], &[][..]), (&[][..], &some[..])] {
            let kernel = DipolePotential::with_level(fixed, moving, level);
            assert_eq!(kernel.energy_and_gradient(&q), (0.0, Vector3::zeros()));
            assert_eq!(kernel.curvature_bound(&q, 0.1), 0.0);
        }
    }
}

#[test]
fn many_turns_change_little() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let (fixed, moving) = (random_dipoles(&mut rng, 5), random_dipoles(&mut rng, 3));
    let scalar = ScalarDipoles::new(&fixed, &moving);
    for level in Level::available() {
        let kernel = DipolePotential::with_level(&fixed, &moving, level);
        for theta in [10.0, -100.0, 9.9e4, -1.1e5, 1e9] {
            let q = Configuration::new(0.8, 0.3, theta);
            let size = magnitudes(&fixed, &moving, &q).0;
            assert!((kernel.energy(&q) - scalar.energy(&q)).abs() <= 1e-12 * size);
        }
    }
}

/// The vector functions at one argument.
struct Functions(f64);

impl Task for Functions {
    type Output = [f64; 4];

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> [f64; 4] {
        let x = l.splat(self.0);
        let (sin, cos) = l.sin_cos(x);
        let mut results = [0.0; 4];
        for (result, lanes) in
            results
                .iter_mut()
                .zip([sin, cos, l.reciprocal_sqrt(l.mul(x, x)), l.reciprocal(x)])
        {
            let mut values = [0.0; WIDTH];
            l.store(lanes, &mut values);
            assert!(values.iter().all(|v| v.to_bits() == values[0].to_bits()));
            *result = values[0];
        }
        results
    }
}

#[test]
fn vector_functions() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    for level in Level::available() {
        for i in 0..20_000 {
            let x = match i % 3 {
                0 => rng.random_range(-PI..PI),
                1 => rng.random_range(-1e5..1e5),
                // Close to a multiple of pi / 4, where quarter turns are told apart.
                _ => {
                    let eighths =
                        f64::from(rng.random_range(-40..40)) + 1e-12 * rng.random::<f64>();
                    eighths * PI / 4.0
                }
            };
            let [sin, cos, root, reciprocal] = level.run(Functions(x));
            assert!((sin - x.sin()).abs() < 3e-16, "{level}: sin {x}");
            assert!((cos - x.cos()).abs() < 3e-16, "{level}: cos {x}");
            if x != 0.0 {
                assert!(
                    (root * x.abs() - 1.0).abs() < 1e-13,
                    "{level}: 1 / sqrt {x}"
                );
                assert!((reciprocal * x - 1.0).abs() < 1e-13, "{level}: 1 / {x}");
            }
        }
        assert_eq!(level.run(Functions(0.0))[..2], [0.0, 1.0]);
    }
}

/// The logarithm of a ratio, and the angle of a vector, of each lane.
struct OfTwo([f64; WIDTH], [f64; WIDTH]);

impl Task for OfTwo {
    type Output = [[f64; WIDTH]; 2];

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let mut out = [[f64::NAN; WIDTH]; 2];
        let (a, b) = (l.load(&self.0), l.load(&self.1));
        let x = l.sub(a, l.splat(1.0));
        l.store(l.ln_ratio(a, b), &mut out[0]);
        l.store(l.angle(x, b), &mut out[1]);
        out
    }
}

#[test]
fn logarithm_and_angle_agree_with_the_standard_library() {
    for level in Level::available() {
        for i in 0..2000 {
            let at = |k: usize, f: f64| (f * (8 * i + k) as f64).sin();
            let a = std::array::from_fn(|k| (6.0 * at(k, 0.731)).exp());
            let b = std::array::from_fn(|k| (9.0 * at(k, 1.377)).exp());
            let [ln, angle] = level.run(OfTwo(a, b));
            for k in 0..WIDTH {
                let exact = (a[k] / b[k]).ln();
                assert!(
                    (ln[k] - exact).abs() < 3e-16 * exact.abs().max(1.0),
                    "{level}"
                );
                let exact = b[k].atan2(a[k] - 1.0);
                assert!(
                    (angle[k] - exact).abs() < 9e-16,
                    "{level} {} {exact}",
                    angle[k]
                );
            }
        }
        let zero = level.run(OfTwo([1.0; WIDTH], [1e-300; WIDTH]));
        assert!(zero[1].iter().all(|a| (0.0..1.58).contains(a)), "{level}");
    }
}
