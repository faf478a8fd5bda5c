//! Partition functions of wells: known closed forms, and counting.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::designs;
use tilebind::configuration::{Configuration, ConfigurationSpace};
use tilebind::design::Design;
use tilebind::kinetics::{Well, bond::corner};
use tilebind::potential::MagnetModel;
use tilebind::potential::Potential;
use tilebind::problem::Problem;
use tilebind::roadmap::Point;

/// `U = force (x - x0) + (kx (x - x0)^2 + ky y^2 + kt theta^2) / 2 - depth`.
struct Bowl {
    x0: f64,
    depth: f64,
    force: f64,
    stiffness: [f64; 3],
}

impl Potential for Bowl {
    fn energy(&self, q: &Configuration) -> f64 {
        self.energy_and_gradient(q).0
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let d = [q.x - self.x0, q.y, q.theta];
        let squares: f64 = (0..3).map(|k| self.stiffness[k] * d[k] * d[k]).sum();
        let slope = Vector3::from_fn(|k, _| self.stiffness[k] * d[k]);
        let slope = slope + Vector3::new(self.force, 0.0, 0.0);
        (self.force * d[0] + squares / 2.0 - self.depth, slope)
    }

    fn curvature_bound(&self, _: &Configuration, _: f64) -> f64 {
        self.stiffness.into_iter().fold(0.0, f64::max)
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.norm()
    }
}

const SPACE: ConfigurationSpace = ConfigurationSpace {
    half_size: [1.0, 1.0],
    rho: 0.5,
    free_distance: 10.0,
};

#[test]
fn a_gaussian_well() {
    let stiffness = [40.0, 300.0, 0.5];
    let bowl = Bowl {
        x0: 0.02,
        depth: 0.03,
        force: 0.0,
        stiffness,
    };
    let problem = Problem::without_contact(SPACE, Box::new(bowl));
    let minimum = Point::new(&problem, Configuration::new(0.02, 0.0, 0.0));
    let well = Well::new(&problem, &minimum, 0.0, &[]);
    for kt in [3e-4, 1e-3] {
        let found = well.volume(kt, 1e-6);
        let exact: f64 = stiffness.iter().map(|k| (TAU * kt / k).sqrt()).product();
        assert!(
            (found.value / exact - 1.0).abs() < 1e-5,
            "{found:?} {exact:e}"
        );
        let closed = corner::volume(&problem, &minimum.q, kt).expect("a minimum");
        assert!((closed / exact - 1.0).abs() < 1e-5, "{closed:e} {exact:e}");
    }
}

/// A bar with a long east face, and a square of 0.2 m.
fn plain_tiles() -> Design {
    let text = r#"
        name = "plain"
        table = { size = [4.0, 4.0] }
        magnet = { size = [0.01, 0.01, 0.003], remanence = 1.2, pitch = 0.04 }
        [fixed]
        vertices = [[0.5, -0.5], [0.5, 0.5], [0.3, 0.5], [0.3, -0.5]]
        thickness = 0.01
        mass = 1.0
        faces = { all = { code = "N" } }
        [moving]
        side = 0.2
        thickness = 0.01
        mass = 0.1
        faces = { all = { code = "S" } }
        [target]
        fixed = 1
        moving = "west"
        [potential]
        model = "dipole"
    "#;
    Design::parse(text, "plain.toml").unwrap_or_else(|error| panic!("{error}"))
}

/// A small square is pressed flush on the long face of another one, far from its corners: the
/// integral over the gap and over the slide is elementary, and that over the tilt is a sum.
fn pressed(kt: f64) -> (f64, f64, f64) {
    let design = plain_tiles();
    let (half_fixed, half) = (0.5, 0.1);
    let (force, stiffness, depth) = (2.0, 400.0, 0.2);
    let bowl = Bowl {
        x0: half_fixed + half,
        depth,
        force,
        stiffness: [0.0, stiffness, 0.0],
    };
    let problem =
        Problem::without_contact(SPACE, Box::new(bowl)).with_tiles(Arc::clone(&design.pair));
    let minimum = Point::new(&problem, Configuration::new(half_fixed + half, 0.0, 0.0));
    // Turned by more than some 30 degrees it falls on its next side.
    let found = Well::new(&problem, &minimum, -0.15, &[])
        .volume(kt, 1e-5)
        .value;
    let closed = corner::volume(&problem, &minimum.q, kt).expect("a minimum");
    let steps = 200_000;
    let widest = 0.7;
    let tilts = (0..steps).map(|k| widest * (k as f64 + 0.5) / steps as f64);
    let lifted = |tilt: f64| half * (tilt.sin() + tilt.cos() - 1.0);
    let weights = tilts.map(|tilt| 2.0 * (-force * lifted(tilt) / kt).exp());
    let over_tilt = weights.sum::<f64>() * widest / steps as f64;
    let exact = kt / force * (TAU * kt / stiffness).sqrt() * over_tilt;
    (found, closed, exact)
}

#[test]
fn a_linear_well_against_a_wall() {
    let mut errors = Vec::new();
    for kt in [5e-4, 1e-3, 2e-3] {
        let (found, closed, exact) = pressed(kt);
        assert!(
            (found / exact - 1.0).abs() < 1e-4,
            "kT = {kt}: {found:e} {exact:e}"
        );
        errors.push((closed / exact - 1.0).abs());
        // (kT)^2 / F [1 / (F l) + 1 / (F l)] sqrt(2 pi kT / K)
        let by_hand = kt * kt / 2.0 * (2.0 / (2.0 * 0.1)) * (TAU * kt / 400.0).sqrt();
        assert!(
            (closed / by_hand - 1.0).abs() < 1e-4,
            "{closed:e} {by_hand:e}"
        );
    }
    // Right to lowest order: the error falls with kT.
    assert!(
        errors[0] < 0.6 * errors[1] && errors[1] < 0.6 * errors[2],
        "{errors:?}"
    );
}

#[test]
fn the_corner_formula_is_the_cold_limit_of_either_model() {
    for model in MagnetModel::NAMES {
        let mut design = designs::load("shapes/paper-tile.toml");
        design.interaction.model = model.1;
        let problem = design.problem();
        let minimum = Point::new(&problem, design.pair.bound);
        let pass = 0.01 * minimum.energy;
        let well = Well::new(&problem, &minimum, pass, &[]);
        let off = |depth: f64| {
            let kt = -minimum.energy / depth;
            let closed = corner::volume(&problem, &minimum.q, kt).expect("a corner");
            (closed / well.volume(kt, 1e-4).value - 1.0).abs()
        };
        let [warm, cold] = [off(50.0), off(200.0)];
        // The first correction is proportional to kT for dipoles; the force between blocks that touch
        // changes with the logarithm of the gap, so theirs falls more slowly.
        let most = match model.1 {
            MagnetModel::Dipole => [0.04, 0.3],
            MagnetModel::Cuboid => [0.25, 0.6],
        };
        assert!(
            cold < most[0] && cold < most[1] * warm,
            "{}: {warm} {cold}",
            model.0
        );
    }
}

/// Counting free configurations in a box: a tab in its slot, where contact is no half-space.
#[test]
fn a_shaped_bond_agrees_with_counting() {
    let design = designs::load("shapes/tab-20mm.toml");
    let problem = design.problem();
    let minimum = Point::new(&problem, design.pair.bound);
    let level = 0.5 * minimum.energy;
    let kt = -minimum.energy / 6.0;
    let well = Well::new(&problem, &minimum, 0.01 * minimum.energy, &[]);
    let found = well.volume_below(kt, level, 1e-4);
    let half = [0.004, 0.006, 0.03];
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let count = 300_000;
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..count {
        let step = Vector3::from_fn(|k, _| half[k] * rng.random_range(-1.0..1.0));
        let step = step + Vector3::new(half[0], 0.0, 0.0);
        let q = minimum.q.moved(step);
        if !problem.is_clear(&q) {
            continue;
        }
        let energy = problem.energy(&q);
        if energy < level {
            assert!(
                step.x < 1.95 * half[0] && step.y.abs() < 0.95 * half[1],
                "the box is too small: {step}"
            );
            let weight = (-(energy - minimum.energy) / kt).exp();
            sum += weight;
            squares += weight * weight;
        }
    }
    let volume: f64 = half.iter().map(|h| 2.0 * h).product();
    let mean = sum / f64::from(count);
    let spread = ((squares / f64::from(count) - mean * mean) / f64::from(count)).sqrt();
    let (counted, error) = (mean * volume, spread * volume);
    assert!(
        (found.value - counted).abs() < 4.0 * error + found.error,
        "{found:?} {counted:e} +- {error:e}"
    );
}

/// Lengths times s at fixed remanence: energies grow by s^3, so at kT s^3 the basin is the same
/// but for its size, and the integral grows by s^2.
#[test]
fn larger_tiles_have_larger_wells() {
    let volume = |scale: f64| {
        let length = |base: f64| base * scale;
        let tile = |code: &str| {
            format!(
                "{{ side = {}, thickness = 0.013, mass = 0.1, faces = {{ all = {{ code = \"{code}\" \
                 }} }} }}",
                length(0.43)
            )
        };
        let text = format!(
            "name = \"scaled\"\ntable = {{ size = [4.0, 4.0] }}\nmagnet = {{ size = [{0}, {0}, {1}], \
             remanence = 1.2, pitch = {2} }}\nfixed = {3}\nmoving = {4}\ntarget = {{ fixed = \
             \"east\", moving = \"west\" }}\npotential = {{ model = \"dipole\" }}\n",
            length(0.01),
            length(0.003),
            length(0.04),
            tile("NNNS"),
            tile("NSSS"),
        );
        let design = Design::parse(&text, "scaled.toml").unwrap_or_else(|error| panic!("{error}"));
        let kt = 4e-3 * scale.powi(3);
        let problem = design.problem();
        let minimum = Point::new(&problem, design.pair.bound);
        let well = Well::new(&problem, &minimum, 0.01 * minimum.energy, &[]);
        (minimum.energy, well.volume(kt, 1e-4).value)
    };
    let (energy, small) = volume(1.0);
    let (larger, large) = volume(2.0);
    assert!((larger / energy / 8.0 - 1.0).abs() < 1e-9);
    assert!(
        (large / small / 4.0 - 1.0).abs() < 1e-6,
        "{large:e} {small:e}"
    );
}
