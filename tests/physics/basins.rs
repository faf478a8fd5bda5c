//! The contents of the basins of rates, and equalities that follow from symmetry.

use tilebind::kinetics::rates::{Basin, RateSettings, Rates, rates};
use tilebind::observer::Silent;
use tilebind::pipeline::{Request, analyse};
use tilebind::rates::RatedState;
use tilebind::{Configuration, Problem};

use crate::designs;

/// The rates of a design between its bond and its traps slid by `slide` (m) either way.
fn of_twins(file: &str, slide: f64, kt: f64, part: f64) -> Rates {
    let design = designs::load(file);
    let problem = design.problem();
    let bond = design.pair.bound;
    let beside = |dy: f64| {
        let at = Configuration::new(bond.x, bond.y + dy, bond.theta);
        let below = part * problem.energy(&at);
        Basin { at, below }
    };
    let basins = [0.0, -slide, slide].map(beside).to_vec();
    let settings = RateSettings {
        tolerance: 0.05,
        ..RateSettings::new(kt, basins, design.space().free_distance)
    };
    rates(&problem, &settings).unwrap()
}

/// Mirrored and its poles exchanged, the alternating tile is itself, and its motion as well.
#[test]
fn twins_by_a_mirror_have_equal_rates_and_occupations() {
    let found = of_twins("shapes/alternating.toml", 0.08, 4e-3, 0.5);
    let finest = found.finest();
    let alike = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-3;
    assert!(
        alike(finest.occupation[1], finest.occupation[2]),
        "{finest:?}"
    );
    assert!(alike(found.inside[1], found.inside[2]), "{found:?}");
    for other in [0, 3] {
        let [one, twin] = [1, 2].map(|trap| finest.rates[trap][other]);
        assert!(alike(one, twin), "{one} {twin}");
    }
    assert!(alike(finest.rates[1][2], finest.rates[2][1]), "{finest:?}");
}

/// A mirror and the exchange of the tiles preserve energies, and so the contents of basins, but not
/// the metric of motion, which refers to the moving tile's centre: committors and rates differ.
#[test]
fn twins_by_exchange_hold_the_same() {
    for (file, slide) in [
        ("shapes/hexagon.toml", 0.04),
        ("shapes/paper-tile.toml", 0.04),
    ] {
        let found = of_twins(file, slide, 2e-3, 0.5);
        let [one, twin] = [found.inside[1], found.inside[2]];
        assert!((one / twin - 1.0).abs() < 0.01, "{file}: {one} {twin}");
        let share = |place: usize| found.inside[place] / found.finest().occupation[place];
        assert!(
            (0.0..=1.0).contains(&share(1)) && share(0) > 0.97,
            "{file}: {found:?}"
        );
    }
}

/// The content of a basin is its integral, even if it is narrower than the mesh's first cells.
#[test]
fn basins_hold_what_their_integrals_say() {
    for file in ["shapes/paper-tile.toml", "shapes/snug-tab.toml"] {
        let design = designs::load(file);
        let problem = design.problem();
        let (bond, kt) = (design.pair.bound, 3e-3);
        let basin = Basin {
            at: bond,
            below: 0.5 * problem.energy(&bond),
        };
        let settings = RateSettings {
            tolerance: 0.3,
            ..RateSettings::new(kt, vec![basin], design.space().free_distance)
        };
        let found = rates(&problem, &settings).unwrap();
        let volumes = &found.finest().volumes;
        let held = found.inside[0] * volumes.iter().sum::<f64>();
        let copies = problem.symmetries.len() as f64;
        let direct = copies * integral(&problem, &basin, kt);
        assert!(
            (held / direct - 1.0).abs() < 0.03,
            "{file}: {held} {direct}"
        );
    }
}

/// The integral of `exp(-(U - U0) / kT)` over a basin of a bond that faces +x, point by point: the
/// gap from contact on, evenly in its exponential.
fn integral(problem: &Problem, basin: &Basin, kt: f64) -> f64 {
    const STEPS: i32 = 50;
    let middle = |k: i32| (f64::from(k) + 0.5) / f64::from(STEPS);
    let (wide, tilt, deep) = (0.012, 0.02, 0.0025);
    let lowest = problem.energy(&basin.at);
    let mut sum = 0.0;
    for (i, j) in (-STEPS..STEPS).flat_map(|i| (-STEPS..STEPS).map(move |j| (i, j))) {
        let turn = tilt * middle(j).powi(3);
        let theta = basin.at.theta + turn;
        // The face's midpoint slides, not the tile's.
        let y = basin.at.y + wide * middle(i).powi(3) + 0.215 * turn;
        let stretch = 9.0 * (middle(i) * middle(j)).powi(2);
        for k in -STEPS / 3..STEPS {
            let q = Configuration::new(basin.at.x + deep * middle(k), y, theta);
            let energy = problem.energy(&q);
            if energy < basin.below && problem.is_clear(&q) {
                sum += stretch * ((lowest - energy) / kt).exp();
            }
        }
    }
    let steps = f64::from(STEPS);
    sum * (wide / steps) * (tilt / steps) * (deep / steps)
}

/// The dovetail's deepest traps are twins with a pass between them far below that to free tiles.
#[test]
fn twins_have_basins_of_their_own_where_they_hold_apart_and_one_where_they_do_not() {
    let design = designs::load("shapes/dovetail.toml");
    let settings = Request::without_proofs(1).surveyed(3000, 10);
    let analysis = analyse(&design, &settings, &Silent);
    let held = |kt| {
        let all = RatedState::held(&analysis, kt, 3, None);
        let told = |place: &RatedState| (place.name.clone(), place.below * 1e3);
        all.iter().map(told).collect::<Vec<_>>()
    };
    // mJ: -1.951 in the wells, -1.132 on the pass.
    for (name, below) in &held(0.2e-3)[1..] {
        assert!(["trap B", "trap B'"].contains(&name.as_str()), "{name}");
        assert!((-1.6..-1.4).contains(below), "{below}");
    }
    assert_eq!(held(0.2e-3).len(), 3);
    let shaken = held(0.6e-3);
    assert_eq!(shaken.len(), 2, "{shaken:?}");
    assert!((-1.0..-0.9).contains(&shaken[1].1), "{shaken:?}");
}
