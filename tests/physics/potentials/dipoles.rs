//! Point dipoles, tested by principle.

use nalgebra::{Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::potential::dipole::{Dipole, pair};
use tilebind::potential::simd::Level;
use tilebind::potential::{DipolePotential, Potential};
use tilebind::units::MU0_OVER_4PI;

use crate::plain::Plain;

const X: Vector2<f64> = Vector2::new(1.0, 0.0);
const Y: Vector2<f64> = Vector2::new(0.0, 1.0);

fn random_vector(rng: &mut ChaCha8Rng, size: f64) -> Vector2<f64> {
    Vector2::new(rng.random_range(-size..size), rng.random_range(-size..size))
}

#[test]
fn dipoles_in_line_side_by_side_and_at_right_angles() {
    // K / r^3, K = 1e-7 m1 m2, with moments of 2 and 3 A m^2 at 0.1 m.
    let unit = 1e-7 * 6.0 / 1e-3;
    let energy = |a: Vector2<f64>, b: Vector2<f64>| pair(a * 2.0, b * 3.0, X * 0.1).0;
    for (a, b, expected) in [
        (X, X, -2.0),
        (X, -X, 2.0),
        (Y, Y, 1.0),
        (Y, -Y, -1.0),
        (X, Y, 0.0),
    ] {
        assert!((energy(a, b) - expected * unit).abs() < 1e-15 * unit);
    }
}

#[test]
fn action_equals_reaction_and_energy_falls_as_the_cube() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for _ in 0..100 {
        let (m1, m2) = (random_vector(&mut rng, 1.0), random_vector(&mut rng, 1.0));
        let r = random_vector(&mut rng, 1.0);
        let (energy, force, slope) = pair(m1, m2, r);
        let (other, reaction, counter_slope) = pair(m2, m1, -r);
        let size = MU0_OVER_4PI * m1.norm() * m2.norm() / r.norm().powi(3);
        assert!((energy - other).abs() < 1e-14 * size);
        assert!((force + reaction).norm() < 1e-14 * size / r.norm());
        // No net torque on the two together.
        let orbital = r.x * force.y - r.y * force.x;
        assert!((orbital - slope - counter_slope).abs() < 1e-13 * size);
        let (farther, weaker, _) = pair(m1, m2, r * 2.0);
        assert!((farther * 8.0 - energy).abs() < 1e-14 * size);
        assert!((weaker * 16.0 - force).norm() < 1e-13 * size / r.norm());
    }
}

#[test]
fn a_single_pair_pulled_straight_apart_attains_the_bounds() {
    let dipole = Dipole {
        position: X * 0.25,
        moment: X,
    };
    let potential = Plain::new(&[dipole], &[dipole]);
    // In line, U = -2 K / r^3 at r = x: derivatives of 24 K / r^5 and 720 K / r^7, to which
    // turns, which the bounds allow for, add what they may.
    let (r, k, turn) = (0.02, MU0_OVER_4PI, 4.0);
    let q = Configuration::new(r, 0.0, 0.0);
    let second = k * (24.0 / r + 18.0 * turn + 2.0 * turn * turn * r) / r.powi(4);
    assert!((potential.curvature_bound(&q, 0.0) / second - 1.0).abs() < 1e-12);
    let fourth = potential.fourth_derivative_bound(&q, 0.0);
    assert!((fourth * r.powi(7) / (720.0 * k) - 1.0).abs() < 0.2);
}

#[test]
fn nothing_is_known_where_dipoles_may_meet() {
    let dipole = Dipole {
        position: X * 0.25,
        moment: Y,
    };
    for level in Level::available() {
        let potential = DipolePotential::with_level(&[dipole], &[dipole], level);
        let q = Configuration::new(0.5, 0.0, 0.0);
        assert_eq!(potential.curvature_bound(&q, 0.5), f64::INFINITY);
        assert!(potential.curvature_bound(&q, 0.49).is_finite());
        let met = Configuration::new(0.0, 0.0, 0.0);
        let infinite = (f64::INFINITY, Vector3::zeros());
        assert_eq!(potential.energy_and_gradient(&met), infinite);
        assert_eq!(potential.curvature_bound(&met, 0.0), f64::INFINITY);
        let mut energies = [0.0; 2];
        potential.energies(&[met, q], &mut energies);
        assert!(energies[0] == f64::INFINITY && energies[1].is_finite());
    }
}
