//! kT from the distances of pairs, where their distribution is known: for an energy that depends
//! only on the distance, the density is `r e^(-U/kT)`.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use tilebind::calibration::distances::PairDistances;
use tilebind::configuration::{Configuration, ConfigurationSpace};
use tilebind::kinetics::rates::distance::Distances;
use tilebind::potential::Potential;
use tilebind::problem::{Problem, Symmetry};

const END: f64 = 0.6;
const TURNS: usize = 60;

/// A well of 4 J at 0.3 m.
struct Well;

fn energy(r: f64) -> f64 {
    -4.0 * (-((r - 0.3) / 0.03).powi(2)).exp()
}

impl Potential for Well {
    fn energy(&self, q: &Configuration) -> f64 {
        energy(q.x.hypot(q.y))
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let r = q.x.hypot(q.y);
        let slope = (energy(r + 1e-6) - energy(r - 1e-6)) / 2e-6;
        (energy(r), Vector3::new(q.x, q.y, 0.0) * (slope / r))
    }

    fn curvature_bound(&self, _: &Configuration, _: f64) -> f64 {
        f64::INFINITY
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.norm()
    }
}

fn problem() -> Problem {
    let space = ConfigurationSpace {
        half_size: [1.0, 1.0],
        rho: 0.1,
        free_distance: END,
    };
    let mut problem = Problem::without_contact(space, Box::new(Well));
    for k in 1..TURNS {
        let turn = TAU * k as f64 / TURNS as f64;
        for (fixed, moving) in [(turn, 0.0), (0.0, turn)] {
            problem.symmetries.push(Symmetry { fixed, moving });
        }
    }
    problem
}

fn bond() -> Configuration {
    Configuration::new(0.3, 0.0, 0.0)
}

/// The integral of the density up to each of many distances.
fn below(kt: f64) -> Vec<f64> {
    const STEPS: usize = 60_000;
    let density = |k: usize| {
        let r = (k as f64 + 0.5) * END / STEPS as f64;
        r * (-energy(r) / kt).exp()
    };
    let mut sum = 0.0;
    let mut sums = vec![0.0];
    sums.extend((0..STEPS).map(|k| {
        sum += density(k);
        sum
    }));
    sums.iter().map(|part| part / sum).collect()
}

#[test]
fn shares_of_distances_are_the_integrals() {
    for kt in [2.0, 0.4] {
        let found = Distances::new(&problem(), &bond(), kt, END);
        let below = below(kt);
        let at = |r: f64| below[(r / END * (below.len() - 1) as f64).round() as usize];
        assert!((found.shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        for (ends, share) in found.edges.windows(2).zip(&found.shares) {
            let exact = at(ends[1]) - at(ends[0]);
            assert!(
                (share - exact).abs() < 2e-3,
                "{kt} {ends:?} {share} {exact}"
            );
        }
    }
}

/// Quantiles of the distribution at kT.
fn table(kt: f64, count: usize) -> String {
    let below = below(kt);
    let quantile = |k: usize| {
        let part = (k as f64 + 0.5) / count as f64;
        let place = below.partition_point(|sum| *sum < part);
        place as f64 * END / (below.len() - 1) as f64
    };
    let rows: String = (0..count).map(|k| format!("{}\n", quantile(k))).collect();
    format!("# looked at\ndistance_m\n{rows}0.7\n")
}

#[test]
fn distances_tell_kt_and_the_more_the_better() {
    let fit = |count: usize| {
        let text = table(1.3, count);
        assert!(PairDistances::is_named_in(&text));
        let read = PairDistances::read(&text).unwrap();
        read.fit(&problem(), &bond(), END).unwrap()
    };
    let [few, many] = [40, 4000].map(fit);
    let widths = [&few, &many].map(|found| {
        let [low, high] = found.interval.map(Option::unwrap);
        assert!(low < 1.3 && 1.3 < high, "{found:?}");
        high - low
    });
    assert!((many.kt.unwrap() / 1.3 - 1.0).abs() < 0.02, "{many:?}");
    // As the root of their number.
    let ratio = widths[0] / widths[1];
    assert!((6.0..18.0).contains(&ratio), "{widths:?}");
    assert_eq!((many.count, many.beyond), (4000, 1));
    assert!(many.pearson.unwrap().0 < 20.0);
}

#[test]
fn tables_that_make_no_sense_are_refused() {
    assert!(!PairDistances::is_named_in("bound_s,apart_s\n1,2\n"));
    let wrong = PairDistances::read("distance_m\n0.3\n-1\n").unwrap_err();
    assert!(wrong.to_string().contains("line 3"), "{wrong}");
    let few = PairDistances::read("distance_m\n0.3\n0.4\n").unwrap();
    let wrong = few.fit(&problem(), &bond(), END).unwrap_err();
    assert!(
        wrong.starts_with("2 distances up to") && wrong.contains("too few"),
        "{wrong}"
    );
}
