//! Exits of overdamped motion: exact where the energy depends only on the distance, the paper's
//! tile, and properties of all exits.

use std::cell::RefCell;
use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::{Vector2, Vector3};
use tilebind::configuration::{Configuration, ConfigurationSpace};
use tilebind::kinetics::Well;
use tilebind::kinetics::rates::exit::{Exit, ExitError, ExitSettings, exit};
use tilebind::kinetics::rates::{Basin, MeshRates, RateSettings, RatesError, rates, rates_on};
use tilebind::landscape::stationary;
use tilebind::potential::Potential;
use tilebind::problem::{Problem, Symmetry};
use tilebind::roadmap::Point;
use tilebind::tile::{Outline, Pair, Tile};

use crate::designs;

/// An energy (J) of the distance (m).
struct Radial(fn(f64) -> f64);

impl Potential for Radial {
    fn energy(&self, q: &Configuration) -> f64 {
        (self.0)(q.x.hypot(q.y))
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let r = q.x.hypot(q.y);
        let slope = ((self.0)(r + 1e-6) - (self.0)(r - 1e-6)) / 2e-6;
        (self.energy(q), Vector3::new(q.x, q.y, 0.0) * (slope / r))
    }

    fn curvature_bound(&self, _: &Configuration, _: f64) -> f64 {
        f64::INFINITY
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.norm()
    }
}

/// Corners of the round tiles, and turns taken for symmetries.
const ROUND: usize = 180;
const TURNS: usize = 60;
/// Radius of a round tile (m).
const RADIUS: f64 = 0.2;

fn radial(energy: fn(f64) -> f64) -> Problem {
    let space = ConfigurationSpace {
        half_size: [1.0, 1.0],
        rho: 0.1,
        free_distance: 0.6,
    };
    let mut problem = Problem::without_contact(space, Box::new(Radial(energy)));
    let turn = |k: usize| TAU * k as f64 / TURNS as f64;
    for k in 1..TURNS {
        for (fixed, moving) in [(turn(k), 0.0), (0.0, turn(k))] {
            problem.symmetries.push(Symmetry { fixed, moving });
        }
    }
    problem
}

/// Round tiles that must not overlap, with the energy of another problem.
fn round(problem: Problem) -> Problem {
    let corner = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / ROUND as f64).sin_cos();
        Vector2::new(cos, sin) * RADIUS
    };
    let tile = Tile {
        outline: Outline::new((0..ROUND).map(corner).collect()).unwrap(),
        faces: Vec::new(),
        magnets: Vec::new(),
        mass: 0.1,
        thickness: 0.01,
    };
    let pair = Pair {
        fixed: tile.clone(),
        moving: tile,
        target: (0, 0),
        bound: at(2.0 * RADIUS),
        only: false,
    };
    problem.with_tiles(Arc::new(pair))
}

fn at(r: f64) -> Configuration {
    Configuration::new(r, 0.0, 0.0)
}

/// Mean exit time (times D) and committor from r for motion between `low` and `high`, where it ends
/// (at `low` only if it is an end), by Green's function of the radial equation.
fn exact(energy: fn(f64) -> f64, kt: f64, r: f64, [low, high]: [f64; 2], open: bool) -> [f64; 2] {
    const STEPS: usize = 20_000;
    let step = (high - low) / STEPS as f64;
    let middle = |k: usize| low + (k as f64 + 0.5) * step;
    let resistance = |r: f64| (energy(r) / kt).exp() / r * step;
    let total: f64 = (0..STEPS).map(|k| resistance(middle(k))).sum();
    let below = |r: f64| -> f64 {
        let steps = ((r - low) / step).round() as usize;
        (0..steps).map(|k| resistance(middle(k))).sum()
    };
    let here = below(r);
    let mut passed = 0.0;
    let mut time = 0.0;
    for k in 0..STEPS {
        let (x, half) = (middle(k), resistance(middle(k)) / 2.0);
        passed += half;
        let green = match open {
            true => passed.min(here) * (total - passed.max(here)) / total,
            false => total - passed.max(here),
        };
        passed += half;
        time += green * x * (-energy(x) / kt).exp() * step;
    }
    [time, (total - here) / total]
}

/// Wells at 0.3 m, the bond, and at 0.5 m; barriers at 0.4 m and 0.6 m.
fn double_well(r: f64) -> f64 {
    -4.0 * (TAU * (r - 0.3) / 0.2).cos() + 5.0 * (r - 0.3)
}

const BASIN: f64 = -3.3;

/// Where the double well's first well reaches up to its basin's limit, from outside (m).
fn rim_of_the_bond() -> f64 {
    let steps = (0..100_000).map(|k| 0.4 - 1e-6 * f64::from(k));
    steps.into_iter().find(|&r| double_well(r) < BASIN).unwrap()
}

fn double_well_exit(kt: f64, tolerance: f64) -> Exit {
    let settings = ExitSettings {
        tolerance,
        ..ExitSettings::new(kt, at(0.5), BASIN, 0.6)
    };
    exit(&radial(double_well), &at(0.3), &settings).unwrap()
}

#[test]
fn a_double_well_is_left_as_the_integrals_say() {
    // The barrier is 7.5 kT, then 19 kT, where the start's well is taken to be in equilibrium.
    for kt in [1.0, 0.4] {
        let found = double_well_exit(kt, 0.01).finest();
        let ends = [rim_of_the_bond(), 0.6];
        let [time, bound] = exact(double_well, kt, 0.5, ends, true);
        assert!((found.time / time - 1.0).abs() < 0.02, "{found:?}, {time}");
        assert!((found.bound - bound).abs() < 0.01, "{found:?}, {bound}");
    }
}

#[test]
fn finer_meshes_come_closer_to_the_integrals() {
    let found = double_well_exit(1.0, 0.01);
    let [time, _] = exact(double_well, 1.0, 0.5, [rim_of_the_bond(), 0.6], true);
    let errors: Vec<f64> = found
        .meshes
        .iter()
        .map(|mesh| (mesh.time / time - 1.0).abs())
        .collect();
    assert!(
        errors.len() >= 3 && errors[errors.len() - 1] < 0.3 * errors[0],
        "{errors:?}"
    );
}

/// 64 kT deep. Exits and rates agree, wells hold what their integrals say, and over kT the time
/// follows Arrhenius' law with the well's integral in front, which the quadrature of one cell for
/// all of the well misses by a factor.
#[test]
fn a_well_far_below_its_passes_is_left_as_arrhenius_says() {
    let design = designs::load("shapes/paper-tile.toml");
    let (problem, bond) = (design.problem(), design.pair.bound);
    let slid = stationary::minimum(&problem, &Configuration::new(0.43, -0.04, 0.0)).unwrap();
    let slid = slid.point.q;
    let [of_bond, of_slid] = [bond, slid].map(|q| problem.energy(&q));
    let content = |q: Configuration, kt: f64| {
        let minimum = Point::new(&problem, q);
        Well::new(&problem, &minimum, 0.5 * minimum.energy, &[])
            .volume(kt, 1e-3)
            .value
    };
    let left = |kt: f64| {
        let settings = ExitSettings {
            tolerance: 0.03,
            ..ExitSettings::new(kt, slid, 0.5 * of_bond, 0.61)
        };
        let found = exit(&problem, &bond, &settings).unwrap();
        found.finest().time
    };
    let [warm, mild, cold] = [0.5e-3, 0.35e-3, 0.25e-3];
    // ln(t D / Z) = E / kT + c.
    let height = |kt: f64| libm::log(left(kt) / content(slid, kt));
    let (first, second) = (height(warm), height(mild));
    let slope = (second - first) / (1.0 / mild - 1.0 / warm);
    let expected = second + slope * (1.0 / cold - 1.0 / mild);
    let found = height(cold);
    assert!((found - expected).abs() < 0.1, "{found} {expected}");

    let basin = |at: Configuration, energy: f64| Basin {
        at,
        below: 0.5 * energy,
    };
    let settings = RateSettings {
        tolerance: 0.03,
        ..RateSettings::new(cold, vec![basin(bond, of_bond), basin(slid, of_slid)], 0.61)
    };
    let found = rates(&problem, &settings).unwrap();
    let out: f64 = found.finest().rates[1].iter().sum();
    assert!(
        (out * left(cold) - 1.0).abs() < 0.03,
        "{}",
        out * left(cold)
    );
    let occupied =
        libm::exp((of_bond - of_slid) / cold) * content(slid, cold) / content(bond, cold);
    let ratio = found.inside[1] / found.inside[0] / occupied;
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
}

fn double_well_basins() -> Vec<Basin> {
    let basin = |r: f64, below: f64| Basin { at: at(r), below };
    vec![basin(0.3, BASIN), basin(0.5, 0.0)]
}

#[test]
fn rates_balance_in_detail_and_are_those_of_the_integrals() {
    let kt = 0.4;
    let settings = RateSettings {
        tolerance: 0.01,
        ..RateSettings::new(kt, double_well_basins(), 0.6)
    };
    // Each mesh is told as soon as it is known.
    let told = RefCell::new(Vec::new());
    let tell = |mesh: &MeshRates| told.borrow_mut().push(mesh.clone());
    let found = rates_on(&radial(double_well), &settings, tell).unwrap();
    assert_eq!(told.into_inner(), found.meshes);
    let finest = found.finest();
    assert!((finest.occupation.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    for i in 0..3 {
        for j in 0..i {
            let [forth, back] =
                [(i, j), (j, i)].map(|(i, j)| finest.occupation[i] * finest.rates[i][j]);
            assert!(
                (forth - back).abs() <= 1e-9 * forth.max(back),
                "{i} {j}: {forth} {back}"
            );
        }
    }
    // Out of the second well, as from its middle.
    let [time, bound] = exact(double_well, kt, 0.5, [rim_of_the_bond(), 0.6], true);
    let out: f64 = finest.rates[1].iter().sum();
    assert!((out * time - 1.0).abs() < 0.03, "{out} {time}");
    assert!(
        (finest.rates[1][0] / out - bound).abs() < 0.01,
        "{:?} {bound}",
        finest.rates[1]
    );
    // The second well lies between the first one and `free`.
    assert!(finest.rates[0][2] < 1e-6 * finest.rates[0][1]);
}

/// Two equal round tiles that both move approach each other twice as fast as one tile a fixed one.
#[test]
fn rates_double_where_both_tiles_move() {
    let problem = round(radial(|r| -6.0 * libm::exp(-((r - 0.42) / 0.03).powi(2))));
    let basin = Basin {
        at: at(0.42),
        below: -3.0,
    };
    let settings = |both_move| RateSettings {
        both_move,
        ..RateSettings::new(1.0, vec![basin], 0.6)
    };
    let [one, both] = [false, true].map(|both| {
        let found = rates(&problem, &settings(both)).unwrap();
        (found.finest().rates.clone(), found.inside)
    });
    for (from, to) in [(0, 1), (1, 0)] {
        let ratio = both.0[from][to] / one.0[from][to];
        assert!((ratio - 2.0).abs() < 0.02, "{ratio}");
    }
    // Equilibrium is the same.
    assert!((both.1[0] / one.1[0] - 1.0).abs() < 1e-3);
}

/// The diffusion of a configuration is the sum over the independent small motions of both tiles about
/// their centres of mass.
#[test]
fn both_tiles_move_about_their_centres_of_mass() {
    let design = tilebind::design::Design::parse(
        "[table]\nsize = [1.0, 1.0]\n[magnet]\nsize = [0.004, 0.004, 0.003]\nremanence = 1.0\n\
         [fixed]\nvertices = [[0.01, 0.02], [0.09, 0.01], [0.05, 0.07]]\nthickness = 0.005\nmass = 0.01\n\
         [fixed.faces]\n1 = { code = \"N\" }\n\
         [moving]\nvertices = [[-0.02, 0.0], [0.06, 0.0], [0.06, 0.04], [-0.02, 0.0721110255]]\nthickness = 0.005\n\
         mass = 0.03\n[moving.faces]\n3 = { code = \"S\" }\n[target]\nfixed = \"1\"\nmoving = \"3\"\n",
        "two.toml",
    )
    .unwrap();
    let problem = design.problem();
    let q = Configuration::new(0.12, 0.03, 0.7);
    let Pair { fixed, moving, .. } = &*design.pair;
    let step = 1e-5;
    let mut expected = nalgebra::Matrix3::zeros();
    for (tile, is_moving) in [(fixed, false), (moving, true)] {
        let c = tile.outline.centroid();
        let about = Configuration::new(c.x, c.y, 0.0);
        let gyration = (tile.inertia() / tile.mass).sqrt();
        for k in 0..3 {
            let mut motion = [0.0; 3];
            motion[k] = step / if k == 2 { gyration } else { 1.0 };
            let moved = about
                .compose(&Configuration::from(motion))
                .compose(&about.inverse());
            let there = match is_moving {
                true => q.compose(&moved),
                false => moved.inverse().compose(&q),
            };
            let by = q.step_to(&there) / step;
            expected += by * by.transpose() * (moving.mass / tile.mass);
        }
    }
    let found = problem.mobility(&q, true);
    assert!(
        (found - expected).norm() < 1e-3 * expected.norm(),
        "{found} {expected}"
    );
    let inverse = problem.mass_metric(q.theta).try_inverse().unwrap();
    assert!((problem.mobility(&q, false) - inverse).norm() < 1e-9 * inverse.norm());
}

#[test]
fn a_map_shows_committors_between_none_and_all_and_flux_into_the_bond() {
    // 15 kT deep, and far below its barrier.
    for kt in [1.0, 0.2] {
        let settings = RateSettings {
            tolerance: 0.05,
            map: Some(40),
            ..RateSettings::new(kt, double_well_basins(), 0.6)
        };
        let map = rates(&radial(double_well), &settings).unwrap().map.unwrap();
        let shown = map.committor.iter().filter(|q| q.is_finite());
        assert!(shown.clone().count() > 1000);
        assert!(shown.clone().all(|q| (0.0..=1.0).contains(q)), "{kt}");
        // All flux enters through a circle.
        let (mut inwards, mut squares) = (0.0, 0);
        for (square, [x, y]) in map.flux.iter().enumerate() {
            let [a, b] = map.middle(square);
            let r = a.hypot(b);
            if (0.42..0.47).contains(&r) {
                inwards -= (x * a + y * b) / r * TAU * r;
                squares += 1;
            }
        }
        let through = inwards / f64::from(squares);
        assert!((through - 1.0).abs() < 0.1, "{through}");
    }
}

#[test]
fn basins_that_are_one_have_no_rates() {
    let mut basins = double_well_basins();
    basins[1].below = 4.6;
    let joined = rates(&radial(double_well), &RateSettings::new(0.4, basins, 0.6));
    assert!(matches!(joined, Err(RatesError::Joined(_))), "{joined:?}");
    let near = rates(
        &radial(double_well),
        &RateSettings::new(0.4, double_well_basins(), 0.45),
    );
    assert!(matches!(near, Err(RatesError::NoFree(_))), "{near:?}");
}

/// A slope that presses the tiles together up to 0.55 m, and one down into the bond at 0.7 m.
fn slope(r: f64) -> f64 {
    let peak = 0.55;
    if r < peak {
        40.0 * (r - 2.0 * RADIUS)
    } else {
        6.0 - 100.0 * (r - peak)
    }
}

#[test]
fn a_linear_well_against_a_wall_is_left_as_the_integrals_say() {
    let problem = round(radial(slope));
    // U is below -6 beyond 0.67 m.
    let settings = ExitSettings {
        tolerance: 0.01,
        ..ExitSettings::new(1.0, at(2.0 * RADIUS + 1e-6), -6.0, 0.75)
    };
    let bond = at(0.69);
    let open = exit(&problem, &bond, &settings);
    assert!(matches!(open, Err(ExitError::Open(_))), "{open:?}");
    // Where the basin is all that there is outside, `free` is never reached.
    let rising = |r: f64| {
        if r < 0.69 {
            slope(r)
        } else {
            slope(0.69) + 400.0 * (r - 0.69)
        }
    };
    let found = exit(&round(radial(rising)), &bond, &settings)
        .unwrap()
        .finest();
    let [time, _] = exact(slope, 1.0, 2.0 * RADIUS, [2.0 * RADIUS, 0.67], false);
    assert!((found.time / time - 1.0).abs() < 0.04, "{found:?}, {time}");
    assert!(found.bound > 0.999, "{found:?}");
}

fn paper_tile(start: [f64; 3], kt: f64, tolerance: f64) -> Exit {
    let design = designs::load("shapes/paper-tile.toml");
    let settings = ExitSettings {
        tolerance,
        ..ExitSettings::new(kt, Configuration::from(start), -0.030, 0.75)
    };
    exit(&design.problem(), &design.pair.bound, &settings).unwrap()
}

#[test]
fn the_slid_paper_tile_leaves_as_brute_force_motion_does() {
    let found = paper_tile([0.43, -0.04, 0.0], 3.037e-3, 0.03).finest();
    assert!((found.time - 0.0176).abs() < 0.0004, "{found:?}");
    assert!((found.bound - 0.405).abs() < 0.01, "{found:?}");
}

#[test]
fn copies_of_a_start_are_one() {
    let [one, other] = [[0.43, -0.04, 0.0], [0.04, 0.43, std::f64::consts::PI]]
        .map(|start| paper_tile(start, 3.037e-3, 0.2).finest());
    assert!(
        (one.time / other.time - 1.0).abs() < 1e-6,
        "{one:?}, {other:?}"
    );
    assert!((one.bound - other.bound).abs() < 1e-6);
}

#[test]
fn probabilities_are_probabilities_far_below_the_barriers() {
    // 15 mJ against kT = 0.15 mJ.
    let found = paper_tile([0.43, -0.04, 0.0], 0.15e-3, 1.0);
    for mesh in &found.meshes {
        assert!(
            (0.0..=1.0).contains(&mesh.bound) && mesh.time > 0.0,
            "{mesh:?}"
        );
    }
    // Arrhenius' factor e^100 leaves its mark.
    assert!(found.finest().time > 1e30, "{found:?}");
}

#[test]
fn the_same_numbers_on_any_number_of_threads() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| double_well_exit(1.0, 0.1))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn questions_without_sense_are_refused() {
    let design = designs::load("shapes/paper-tile.toml");
    let ask = |start: [f64; 3], basin: f64, free_at: f64| {
        let settings = ExitSettings::new(3e-3, Configuration::from(start), basin, free_at);
        exit(&design.problem(), &design.pair.bound, &settings).unwrap_err()
    };
    let slid = [0.43, -0.04, 0.0];
    assert!(matches!(
        ask([0.40, 0.0, 0.0], -0.03, 0.75),
        ExitError::Overlap(..)
    ));
    assert!(matches!(ask(slid, -0.03, 0.4), ExitError::Free(..)));
    assert!(matches!(ask(slid, -0.07, 0.75), ExitError::NoBasin(..)));
    assert!(matches!(
        ask([0.4301, 0.0, 0.0], -0.03, 0.75),
        ExitError::Bound(_)
    ));
}
