//! Exits against overdamped motion simulated step by step: Metropolis' rule with steps of one size.
//! It preserves e^(-U/kT) at any step size, reflects at contact by rejection, and its times are
//! extrapolated to small steps. (Rejection of steps of varying size does not preserve e^(-U/kT),
//! and a step beyond the end is too late by a share of its size: hence the extrapolation over
//! several fixed sizes.)

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use tilebind::kinetics::rates::exit::{ExitSettings, exit};
use tilebind::{Configuration, Design, Problem};

use crate::designs;

/// Squares with a magnet behind each face: every face binds every face.
const SMALL: &str = r#"
name = "small"
[table]
size = [1.0, 1.0]
[magnet]
size = [0.010, 0.010, 0.003]
remanence = 1.2
pitch = 0.04
inset = 0.02
[fixed]
side = 0.1
thickness = 0.013
mass = 0.1
[fixed.faces]
all = { code = "N" }
[moving]
side = 0.1
thickness = 0.013
mass = 0.1
[moving.faces]
all = { code = "S" }
[target]
fixed = "east"
moving = "west"
[potential]
model = "dipole"
"#;

/// kT (J): the bond is 3.2 kT deep.
const KT: f64 = 0.02e-3;

fn asked() -> ExitSettings {
    let start = Configuration::new(0.13, 0.05, 0.5);
    ExitSettings {
        tolerance: 0.01,
        ..ExitSettings::new(KT, start, -0.03e-3, 0.2)
    }
}

/// The landscape of the walks, with the copies of the bond.
struct Scene {
    problem: Problem,
    bonds: Vec<Configuration>,
    asked: ExitSettings,
}

impl Scene {
    fn new(design: &Design, asked: ExitSettings) -> Self {
        let problem = design.problem();
        let copies = problem.symmetries.iter();
        let bonds = copies.map(|copy| copy.apply(&design.pair.bound)).collect();
        Self {
            problem,
            bonds,
            asked,
        }
    }

    /// Whether a tile with this energy (J) is bound: other wells of this depth are farther away.
    fn is_bound(&self, q: &Configuration, energy: f64) -> bool {
        const NEAR: f64 = 0.02;
        let is_near = |bond: &Configuration| self.problem.space.distance(bond, q) < NEAR;
        energy < self.asked.basin_energy && self.bonds.iter().any(is_near)
    }
}

/// Steps until a tile is bound or free, and whether it is bound.
fn walk(scene: &Scene, step: f64, seed: u64) -> (f64, f64) {
    let Scene { problem, asked, .. } = scene;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    // Even steps of the variance step^2.
    let reach = 3f64.sqrt() * step;
    let mut q = asked.start;
    let mut energy = problem.energy(&q);
    for count in 0.. {
        let is_bound = scene.is_bound(&q, energy);
        if is_bound || q.x.hypot(q.y) >= asked.free_at {
            return (f64::from(count), if is_bound { 1.0 } else { 0.0 });
        }
        let mut by = || rng.random_range(-reach..reach);
        let next = Configuration::new(q.x + by(), q.y + by(), q.theta + by() / problem.space.rho);
        if !problem.is_clear(&next) {
            continue;
        }
        let there = problem.energy(&next);
        if there <= energy || rng.random::<f64>() < ((energy - there) / asked.kt).exp() {
            (q, energy) = (next, there);
        }
    }
    unreachable!("the walk ends")
}

/// Mean exit time times D (m^2) and share of the bound, each with its standard error.
fn walks(scene: &Scene, step: f64, runs: u64) -> [[f64; 2]; 2] {
    let all: Vec<(f64, f64)> = (0..runs)
        .into_par_iter()
        .map(|seed| walk(scene, step, seed))
        .collect();
    let of = |values: Vec<f64>| {
        let mean = values.iter().sum::<f64>() / runs as f64;
        let spread = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / runs as f64;
        [mean, (spread / runs as f64).sqrt()]
    };
    let times = all.iter().map(|(steps, _)| steps * step * step / 2.0);
    [of(times.collect()), of(all.iter().map(|it| it.1).collect())]
}

/// The value of a straight line through points at zero, and its standard error.
fn at_zero(points: &[(f64, [f64; 2])]) -> [f64; 2] {
    let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
        let terms = points
            .iter()
            .map(|(x, [y, error])| of(*x, *y) / (error * error));
        terms.sum()
    };
    let (w, x, xx) = (sum(&|_, _| 1.0), sum(&|x, _| x), sum(&|x, _| x * x));
    let (y, xy) = (sum(&|_, y| y), sum(&|x, y| x * y));
    let size = w * xx - x * x;
    [(xx * y - x * xy) / size, (xx / size).sqrt()]
}

fn compare(design: &Design, asked: ExitSettings, steps: &[f64], runs: u64) {
    let scene = Scene::new(design, asked);
    let found = exit(&scene.problem, &design.pair.bound, &asked).unwrap();
    for mesh in &found.meshes {
        println!("{mesh:?}");
    }
    let found = found.finest();
    let walked: Vec<_> = steps
        .iter()
        .map(|&step| (step, walks(&scene, step, runs)))
        .collect();
    for (which, value) in [found.time, found.bound].into_iter().enumerate() {
        let points: Vec<_> = walked
            .iter()
            .map(|(step, all)| (*step, all[which]))
            .collect();
        let [limit, error] = at_zero(&points);
        println!("mesh {value:.6}, walks {limit:.6} +- {error:.6}: {points:?}");
        // The mesh's own error: as its two finest differ.
        let off = (value - limit).abs();
        assert!(
            off < 3.0 * error + 0.01 * value,
            "{value} {limit} +- {error}"
        );
    }
}

fn small() -> Design {
    Design::parse(SMALL, "small.toml").unwrap()
}

#[test]
fn exits_are_those_of_overdamped_motion_step_by_step() {
    compare(&small(), asked(), &[2e-3, 3e-3, 4e-3], 2000);
}

/// Half a minute; `cargo test --release -- --ignored --nocapture step_by_step` prints the figures.
#[test]
#[ignore = "slow"]
fn exits_are_those_of_many_finer_steps_step_by_step() {
    compare(&small(), asked(), &[0.7e-3, 1e-3, 1.4e-3, 2e-3], 20_000);
}

/// Exits from next to the bond, slid along it, of a shipped design.
fn compare_shipped(file: &str, start: [f64; 3], [kt, basin]: [f64; 2], steps: &[f64]) {
    let design = designs::load(file);
    let free_at = design.space().free_distance;
    let asked = ExitSettings {
        ..ExitSettings::new(kt, Configuration::from(start), basin, free_at)
    };
    compare(&design, asked, steps, 4000);
}

/// A minute each.
#[test]
#[ignore = "slow"]
fn the_hexagons_exits_step_by_step() {
    let file = "shapes/hexagon.toml";
    compare_shipped(
        file,
        [0.445, -0.04, 0.05],
        [4e-3, -0.02],
        &[1.5e-3, 2e-3, 3e-3],
    );
}

#[test]
#[ignore = "slow"]
fn the_tabs_exits_step_by_step() {
    let file = "shapes/tab-20mm.toml";
    compare_shipped(
        file,
        [0.46, -0.02, 0.0],
        [5e-3, -0.03],
        &[1e-3, 1.4e-3, 2e-3],
    );
}

#[test]
#[ignore = "slow"]
fn the_teeths_exits_step_by_step() {
    let file = "shapes/triangle-teeth-10mm.toml";
    compare_shipped(
        file,
        [0.45, -0.04, 0.0],
        [1.5e-3, -0.008],
        &[1e-3, 1.4e-3, 2e-3],
    );
}

#[test]
#[ignore = "slow"]
fn the_paper_tiles_exits_at_another_temperature_step_by_step() {
    let file = "shapes/paper-tile.toml";
    compare_shipped(
        file,
        [0.43, -0.04, 0.0],
        [6e-3, -0.03],
        &[1.5e-3, 2e-3, 3e-3],
    );
}
