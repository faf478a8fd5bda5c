//! Descents towards walls thinner than their steps.

use std::sync::Arc;

use nalgebra::{Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::configuration::{Configuration, ConfigurationSpace};
use tilebind::landscape::minimum::descend;
use tilebind::potential::Potential;
use tilebind::problem::Problem;
use tilebind::tile::{Outline, Pair, Tile};

/// A pull towards -y, to x = 0 and to theta = 0.
struct Pull;

impl Potential for Pull {
    fn energy(&self, q: &Configuration) -> f64 {
        q.y + q.x * q.x + 0.01 * (1.0 - q.theta.cos())
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let gradient = Vector3::new(2.0 * q.x, 1.0, 0.01 * q.theta.sin());
        (self.energy(q), gradient)
    }

    fn curvature_bound(&self, _: &Configuration, _: f64) -> f64 {
        f64::INFINITY
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.norm()
    }
}

/// A plate without magnets.
fn plate(length: f64, thickness: f64) -> Tile {
    let (l, t) = (length / 2.0, thickness / 2.0);
    let corners = [[-l, -t], [l, -t], [l, t], [-l, t]];
    let vertices = corners.map(|[x, y]| Vector2::new(x, y)).to_vec();
    Tile {
        outline: Outline::new(vertices).unwrap(),
        faces: Vec::new(),
        magnets: Vec::new(),
        mass: 0.1,
        thickness: 0.01,
    }
}

#[test]
fn a_plate_never_falls_through_another() {
    let (fixed, moving) = (plate(0.4, 0.0006), plate(0.02, 0.0006));
    let space = ConfigurationSpace {
        half_size: [1.0, 1.0],
        rho: moving.radius_of_gyration(),
        free_distance: 0.9,
    };
    let pair = Pair {
        fixed,
        moving,
        target: (0, 0),
        bound: Configuration::new(0.0, 0.0, 0.0),
        only: false,
    };
    let problem = Problem::without_contact(space, Box::new(Pull)).with_tiles(Arc::new(pair));
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for _ in 0..60 {
        let start = Configuration::new(
            rng.random_range(-0.15..0.15),
            rng.random_range(0.011..0.05),
            rng.random_range(-1.5..1.5),
        );
        let descent = descend(&problem, &start);
        let lowest = descent
            .way
            .iter()
            .map(|p| p.q.y)
            .fold(f64::INFINITY, f64::min);
        assert!(lowest > 0.0006 - 1e-8, "from {start:?} down to {lowest}");
        let end = descent.way.last().unwrap().q;
        assert!(
            (end.y - 0.0006).abs() < 1e-6 && end.theta.abs() < 1e-3,
            "{end:?}"
        );
    }
}
