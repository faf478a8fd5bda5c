//! Exits into a basin much smaller than the cells that a mesh begins with, against motion that is
//! exact: in flat space a step to anywhere on a sphere about where the tile is, as large as fits
//! between the ends, takes its radius squared over 6 D on average (Muller 1956,
//! doi:10.1214/aoms/1177728169).

use std::f64::consts::TAU;

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::configuration::{Configuration, ConfigurationSpace};
use tilebind::kinetics::exit::{ExitSettings, exit};
use tilebind::potential::Potential;
use tilebind::problem::{Problem, Symmetry};

/// Turns of either tile that change nothing.
const TURNS: usize = 12;
/// Radius of gyration (m), radius of the basin and where tiles are free.
const RHO: f64 = 0.1;
const SMALL: f64 = 1.5e-3;
const FREE: f64 = 0.6;

fn middle() -> Configuration {
    Configuration::new(0.31, 0.05, 0.11)
}

fn start() -> Configuration {
    Configuration::new(0.34, 0.04, 0.2)
}

/// A dent about a configuration and its copies: -1/2 J at its rim.
struct Dent;

/// The distance (m) from the nearest copy of the dent's middle.
fn aside(q: &Configuration) -> f64 {
    let turn = TAU / TURNS as f64;
    let wrapped = |angle: f64| angle - (angle / turn).round() * turn;
    let m = middle();
    let [r, phi] = [q.x.hypot(q.y), wrapped(q.y.atan2(q.x) - m.y.atan2(m.x))];
    let of_middle = m.x.hypot(m.y);
    let [x, y] = [r * phi.cos() - of_middle, r * phi.sin()];
    Vector3::new(x, y, RHO * wrapped(q.theta - m.theta)).norm()
}

impl Potential for Dent {
    fn energy(&self, q: &Configuration) -> f64 {
        -1.0 / (1.0 + (aside(q) / SMALL).powi(2))
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let by = |axis: usize| {
            let beside = |step: f64| {
                let mut at = [q.x, q.y, q.theta];
                at[axis] += step;
                self.energy(&Configuration::from(at))
            };
            (beside(1e-6) - beside(-1e-6)) / 2e-6
        };
        (self.energy(q), Vector3::new(by(0), by(1), by(2)))
    }

    fn curvature_bound(&self, _: &Configuration, _: f64) -> f64 {
        f64::INFINITY
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.norm()
    }
}

/// Mean exit time times D (m^2) and share of the bound, each with its standard error.
fn walks(count: usize) -> [[f64; 2]; 2] {
    const CLOSE: f64 = 1e-6;
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut sums = [[0.0; 2]; 2];
    for _ in 0..count {
        let (mut q, mut time) = (start(), 0.0);
        let bound = loop {
            let [to_basin, to_free] = [aside(&q) - SMALL, FREE - q.x.hypot(q.y)];
            if to_basin.min(to_free) < CLOSE {
                break if to_basin < to_free { 1.0 } else { 0.0 };
            }
            let radius = to_basin.min(to_free);
            time += radius * radius / 6.0;
            let (cos, phi) = (rng.random_range(-1.0..1.0), rng.random_range(0.0..TAU));
            let sin = f64::sqrt(1.0 - cos * cos);
            let [x, y, z] =
                [sin * f64::cos(phi), sin * f64::sin(phi), cos].map(|part| radius * part);
            q = Configuration::new(q.x + x, q.y + y, q.theta + z / RHO);
        };
        for (sum, value) in sums.iter_mut().zip([time, bound]) {
            *sum = [sum[0] + value, sum[1] + value * value];
        }
    }
    let n = count as f64;
    sums.map(|[sum, squares]| {
        let mean = sum / n;
        [mean, ((squares / n - mean * mean) / n).sqrt()]
    })
}

#[test]
fn a_basin_far_smaller_than_first_cells_is_found_as_often_as_it_should_be() {
    let space = ConfigurationSpace {
        half_size: [1.0, 1.0],
        rho: RHO,
        free_distance: FREE,
    };
    let mut problem = Problem::without_contact(space, Box::new(Dent));
    for k in 1..TURNS {
        let turn = TAU * k as f64 / TURNS as f64;
        for (fixed, moving) in [(turn, 0.0), (0.0, turn)] {
            problem.symmetries.push(Symmetry { fixed, moving });
        }
    }
    // The dent is next to nothing against kT.
    let asked = ExitSettings {
        certify: None,
        ..ExitSettings::new(1e3, start(), -0.5, FREE)
    };
    let found = exit(&problem, &middle(), &asked).unwrap();
    let [time, bound] = walks(40_000);
    for mesh in &found.meshes {
        println!("{mesh:?}");
    }
    println!("walks {time:?} {bound:?}");
    let finest = found.finest();
    for (value, [mean, error]) in [(finest.time, time), (finest.bound, bound)] {
        assert!(
            (value - mean).abs() < 3.0 * error + 0.03 * mean,
            "{finest:?}: {mean} +- {error}"
        );
    }
}
