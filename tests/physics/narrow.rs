//! Exits into a basin much smaller than the initial cells of a mesh, against exact motion: in flat
//! space a step to a uniformly chosen point of the largest sphere around the tile that fits between
//! the ends takes its radius squared over 6 D on average (Muller 1956,
//! doi:10.1214/aoms/1177728169).

use std::f64::consts::TAU;

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Design;
use tilebind::configuration::{Configuration, ConfigurationSpace};
use tilebind::kinetics::PathToFree;
use tilebind::kinetics::rates::exit::{ExitSettings, exit};
use tilebind::kinetics::rates::{Basin, RateSettings, rates};
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
    // The dent is negligible compared with kT.
    let asked = ExitSettings {
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

/// A straight tab of 60 mm in a slot with play.
const CORRIDOR: &str = r#"
name = "corridor"
[table]
size = [2.0, 2.0]
[magnet]
size = [0.010, 0.010, 0.003]
remanence = 1.2
pitch = 0.04
inset = 0.0
[fixed]
side = 0.43
thickness = 0.013
mass = 0.1
[fixed.faces]
east = { code = "NNNS", profile = { shape = "tab", width = 0.20, depth = 0.06, draft = 0.0 } }
[moving]
side = 0.43
thickness = 0.013
mass = 0.1
[moving.faces]
west = { mates = "east", fit = 0.0004 }
[target]
fixed = "east"
moving = "west"
[potential]
model = "dipole"
"#;
const DEPTH: f64 = 0.06;
const PLAY: f64 = 0.0004;

/// The free area (m rad) with the tab drawn out by this distance (m): for each theta the interval
/// of y about where the tab's middle would be.
fn cross_section(problem: &Problem, bond: &Configuration, out: f64) -> f64 {
    const STEPS: i32 = 80;
    let width = |range: f64| range / f64::from(STEPS);
    let (tilt, aside) = ((3.0 * PLAY / (DEPTH - out)).min(0.3), 2.0 * PLAY);
    let lever = 0.185 + out / 2.0;
    let is_free = |i: i32, j: i32| {
        let theta = tilt * (f64::from(i) + 0.5) / f64::from(STEPS);
        let y = lever * theta + aside * (f64::from(j) + 0.5) / f64::from(STEPS);
        problem.is_clear(&Configuration::new(bond.x + out, y, theta))
    };
    let all = (-STEPS..STEPS).flat_map(|i| (-STEPS..STEPS).map(move |j| (i, j)));
    let free = all.filter(|&(i, j)| is_free(i, j)).count();
    free as f64 * width(tilt) * width(aside)
}

/// A corridor missed by all cells of a first mesh is found, and no blocked region is opened.
#[test]
fn a_corridor_narrower_than_first_cells_is_open_and_a_dovetail_is_not() {
    for (shape, way) in [
        ("draft = 0.0", PathToFree::Open),
        ("draft = -0.3", PathToFree::Blocked),
    ] {
        let text = CORRIDOR
            .replace("draft = 0.0", shape)
            .replace("0.06,", "0.02,");
        let design = Design::parse(&text, "corridor.toml").unwrap();
        let (problem, bond) = (design.problem(), design.pair.bound);
        let below = 0.9 * problem.energy(&bond);
        let settings = RateSettings {
            tolerance: 10.0,
            ..RateSettings::new(10.0, vec![Basin { at: bond, below }], 0.7)
        };
        let found = rates(&problem, &settings).unwrap();
        assert_eq!(found.ways, [way], "{shape}");
        let out = found.finest().rates[0][1];
        assert!((out > 0.0) == (way == PathToFree::Open), "{shape}: {out}");
    }
}

/// The flux through a corridor much narrower than long is the reciprocal of the integral of 1 /
/// cross-section; no initial cell of the mesh meets it.
#[test]
#[ignore = "slow"]
fn a_corridor_far_narrower_than_first_cells_carries_what_its_cross_section_says() {
    let design = Design::parse(CORRIDOR, "corridor.toml").unwrap();
    let (problem, bond) = (design.problem(), design.pair.bound);
    let below = 0.5 * problem.energy(&bond);
    // The magnets are negligible compared with kT.
    let settings = RateSettings {
        tolerance: 0.05,
        ..RateSettings::new(10.0, vec![Basin { at: bond, below }], 0.7)
    };
    let found = rates(&problem, &settings).unwrap();
    assert_eq!(found.ways, [PathToFree::Open]);
    for mesh in &found.meshes {
        println!("{mesh:?}");
    }
    let finest = found.finest();
    let capacity = finest.volumes[0] * finest.rates[0][1];
    let energy = |out: f64| problem.energy(&Configuration::new(bond.x + out, 0.0, 0.0));
    let steps = (0..1000).map(|k| 1e-5 * f64::from(k));
    let rim = steps.into_iter().find(|&out| energy(out) > below).unwrap();
    const PARTS: u32 = 16;
    let part = (DEPTH - rim) / f64::from(PARTS);
    let middles = (0..PARTS).map(|k| rim + (f64::from(k) + 0.5) * part);
    let resistance: f64 = middles
        .map(|out| part / cross_section(&problem, &bond, out))
        .sum();
    assert!(
        (capacity * resistance - 1.0).abs() < finest.error + 0.03 && finest.error < 0.2,
        "{capacity} {} {}",
        1.0 / resistance,
        finest.error
    );
}
