//! Point dipoles, tested by principle.

use std::f64::consts::PI;

use nalgebra::{Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::potential::Potential;
use tilebind::potential::dipole::{Dipole, ScalarDipoles, pair};
use tilebind::units::MU0_OVER_4PI;

const X: Vector2<f64> = Vector2::new(1.0, 0.0);
const Y: Vector2<f64> = Vector2::new(0.0, 1.0);

fn random_vector(rng: &mut ChaCha8Rng, size: f64) -> Vector2<f64> {
    Vector2::new(rng.random_range(-size..size), rng.random_range(-size..size))
}

fn random_tile(rng: &mut ChaCha8Rng, count: usize) -> Vec<Dipole> {
    (0..count)
        .map(|_| Dipole {
            position: random_vector(rng, 0.2),
            moment: random_vector(rng, 1.0),
        })
        .collect()
}

/// Two tiles whose dipoles come no closer than some 5 cm, and where the moving one is.
fn random_tiles(rng: &mut ChaCha8Rng) -> ([Vec<Dipole>; 2], Configuration) {
    let tiles = [random_tile(rng, 4), random_tile(rng, 3)];
    let theta = rng.random_range(-PI..PI);
    let q = Configuration::new(
        rng.random_range(0.6..0.8),
        rng.random_range(-0.3..0.3),
        theta,
    );
    (tiles, q)
}

/// The potential of such tiles.
fn random_case(rng: &mut ChaCha8Rng) -> (ScalarDipoles, Configuration) {
    let ([fixed, moving], q) = random_tiles(rng);
    (ScalarDipoles::new(&fixed, &moving), q)
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
fn the_gradient_is_that_of_the_energy() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for _ in 0..100 {
        let (potential, q) = random_case(&mut rng);
        let gradient = potential.energy_and_gradient(&q).1;
        let h = 1e-5;
        let difference = Vector3::from_fn(|i, _| {
            let step = Vector3::from_fn(|j, _| if i == j { h } else { 0.0 });
            let ahead = potential.energy(&q.moved(step));
            (ahead - potential.energy(&q.moved(-step))) / (2.0 * h)
        });
        assert!((difference - gradient).norm() < 1e-5 * gradient.norm());
    }
}

#[test]
fn the_tiles_may_be_seen_from_either_one() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for _ in 0..100 {
        let ([fixed, moving], q) = random_tiles(&mut rng);
        let potential = ScalarDipoles::new(&fixed, &moving);
        let exchanged = ScalarDipoles::new(&moving, &fixed);
        let (energy, other) = (potential.energy(&q), exchanged.energy(&q.inverse()));
        assert!((energy - other).abs() < 1e-12 * energy.abs().max(1e-9));
    }
}

/// The largest share of a derivative's bound that finite differences along random motions
/// reach; `weights` are those of the differences.
fn largest_share_of_bound(
    weights: &[f64],
    bound: impl Fn(&ScalarDipoles, &Configuration, f64) -> f64,
) -> f64 {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let mut closest = 0f64;
    for _ in 0..300 {
        let (potential, q) = random_case(&mut rng);
        let away = random_vector(&mut rng, 1.0);
        let direction = Vector3::new(away.x, away.y, rng.random_range(-5.0..5.0));
        let step = direction / potential.displacement(direction);
        let (reach, h) = (0.01, 1e-3);
        let order = weights.len() - 1;
        let half = h * order as f64 / 2.0;
        for middle in [-reach + half, 0.0, reach - half] {
            let u = |k: usize| potential.energy(&q.moved(step * (middle - half + h * k as f64)));
            let sum: f64 = weights.iter().enumerate().map(|(k, w)| w * u(k)).sum();
            let derivative = sum / h.powi(order as i32);
            closest = closest.max(derivative.abs() / bound(&potential, &q, reach));
        }
    }
    closest
}

#[test]
fn derivatives_are_bounded_within_reach() {
    let second =
        largest_share_of_bound(&[1.0, -2.0, 1.0], |p, q, reach| p.curvature_bound(q, reach));
    let fourth = largest_share_of_bound(&[1.0, -4.0, 6.0, -4.0, 1.0], |p, q, reach| {
        p.fourth_derivative_bound(q, reach)
    });
    // A bound that is never approached would be of little use.
    for share in [second, fourth] {
        assert!(
            (0.01..=1.0).contains(&share),
            "at most {share} of the bound"
        );
    }
}

#[test]
fn a_single_pair_pulled_straight_apart_attains_the_bounds() {
    let dipole = Dipole {
        position: X * 0.25,
        moment: X,
    };
    let potential = ScalarDipoles::new(&[dipole], &[dipole]);
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
    let potential = ScalarDipoles::new(&[dipole], &[dipole]);
    let q = Configuration::new(0.5, 0.0, 0.0);
    assert_eq!(potential.curvature_bound(&q, 0.5), f64::INFINITY);
    assert!(potential.curvature_bound(&q, 0.49).is_finite());
    let met = Configuration::new(0.0, 0.0, 0.0);
    assert_eq!(
        potential.energy_and_gradient(&met),
        (f64::INFINITY, Vector3::zeros())
    );
}
