//! Milestones and edges against their definitions.

use crate::plain::Plain;
use crate::surfaces::DoubleWell;
use nalgebra::Vector3;
use tilebind::configuration::{Configuration, ConfigurationSpace};
use tilebind::design::Design;
use tilebind::potential::Potential;
use tilebind::potential::dipole::dipoles;
use tilebind::problem::Problem;
use tilebind::roadmap::{
    Acceptance, EdgeSettings, MilestoneSettings, Point, ProfileTolerance, edge, milestone,
    profile::Profile,
};

const SPACE: ConfigurationSpace = ConfigurationSpace {
    half_size: [1.0, 0.5],
    rho: 0.1,
    free_distance: 10.0,
};

const SETTINGS: EdgeSettings = EdgeSettings {
    tolerance: ProfileTolerance {
        relative: 1e-4,
        absolute: 1e-8,
    },
    thermal_energy: 1e-4,
    probability_step: 1e-3,
};

fn double_well() -> Problem {
    let well = DoubleWell {
        height: 2e-3,
        half_distance: 0.4,
        stiffness: 0.03,
    };
    Problem::without_contact(SPACE, Box::new(well))
}

fn costs(problem: &Problem, a: Configuration, b: Configuration) -> edge::EdgeCosts {
    let ends = [a, b].map(|q| Point::new(problem, q));
    edge::costs(problem, [&ends[0], &ends[1]], &SETTINGS)
}

#[test]
fn the_costs_of_a_motion_over_a_saddle_are_those_of_its_definition() {
    let problem = double_well();
    let at = |x: f64| Configuration::new(x, 0.0, 0.0);
    // From the left minimum (0) over the saddle (2 mJ) to where U is U(0.2) = 2 mJ (3/4)^2.
    let (a, b) = (at(-0.4), at(0.2));
    let end = 2e-3 * 0.75f64.powi(2);
    let there = costs(&problem, a, b);
    assert!((there.peak - 2e-3).abs() < 2e-7, "{there:?}");
    assert!((there.peak_at - 0.4 / 0.6).abs() < 1e-2);
    assert!((there.work[0] - 2e-3).abs() < 2e-7 && (there.work[1] - (2e-3 - end)).abs() < 2e-7);
    assert!((there.length - 0.6).abs() < 1e-12);
    let back = costs(&problem, b, a);
    assert!((back.peak - there.peak).abs() < 2e-7);
    assert!((back.work[0] - there.work[1]).abs() < 1e-9);
    assert!((back.minus_ln_probability[0] - there.minus_ln_probability[1]).abs() < 1e-2);
    // Twice the climb over kT, about: every step counts the difference of two.
    assert!((there.minus_ln_probability[0] - there.minus_ln_probability[1]).abs() > end / 1e-4);
}

#[test]
fn both_ends_of_a_motion_count_and_negative_energies_are_normal() {
    let design = Design::load("shapes/paper-tile.toml".as_ref()).unwrap();
    let problem = design.problem();
    let bound = Configuration::new(0.43, 0.0, 0.0);
    let off = Configuration::new(0.47, 0.0, 0.0);
    let energies = [bound, off].map(|q| problem.energy(&q));
    assert!(energies[0] < energies[1] && energies[1] < 0.0);
    let costs = costs(&problem, bound, off);
    assert_eq!(costs.peak, energies[1]);
    assert!((costs.work[0] - (energies[1] - energies[0])).abs() < 1e-9 && costs.work[1] == 0.0);
}

/// A narrow ridge across a plain.
struct Ridge;

impl Potential for Ridge {
    fn energy(&self, q: &Configuration) -> f64 {
        1e-3 / (1.0 + (q.x / WIDTH).powi(2))
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let u = self.energy(q);
        let slope = -2.0 * q.x / WIDTH.powi(2) * u * u / 1e-3;
        (u, Vector3::new(slope, 0.0, 0.0))
    }

    fn curvature_bound(&self, _: &Configuration, _: f64) -> f64 {
        // |U''| is largest, 2 U / width^2, on the crest.
        2e-3 / WIDTH.powi(2)
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.x.abs()
    }
}

const WIDTH: f64 = 1e-3;

#[test]
fn no_ridge_is_stepped_over() {
    let problem = Problem::without_contact(SPACE, Box::new(Ridge));
    for k in 0..40 {
        let x = 0.3 + 0.01 * f64::from(k);
        let found = costs(
            &problem,
            Configuration::new(-x, 0.1, 0.0),
            Configuration::new(0.5, -0.2, 1.0),
        );
        assert!((found.peak - 1e-3).abs() < 1e-6, "{x} {found:?}");
    }
}

#[test]
fn milestones_follow_their_rule_of_acceptance() {
    let problem = double_well();
    let count = 20_000;
    let (lowest, highest) = (0.5e-3, 4e-3);
    let linear = |u: f64| ((highest - u) / (highest - lowest)).clamp(0.0, 1.0);
    let boltzmann = |u: f64| (-u / 1e-3).exp().min(1.0);
    let rules: [(Acceptance, &dyn Fn(f64) -> f64); 2] = [
        (Acceptance::Linear { lowest, highest }, &linear),
        (Acceptance::Boltzmann { energy: 1e-3 }, &boltzmann),
    ];
    for (acceptance, probability) in rules {
        let settings = MilestoneSettings {
            count,
            acceptance,
            seed: 3,
        };
        let found = milestone::milestones(&problem, &settings);
        assert_eq!(found.len(), count);
        // Proposals are uniform here, so the density of milestones over x and y is the rule's
        // probability: compared in bins of x, against sums over a grid.
        let bins = 20;
        let bin = |x: f64| (((x + 1.0) / 2.0 * bins as f64) as usize).min(bins - 1);
        let mut expected = vec![0.0; bins];
        for i in 0..400 {
            for j in 0..200 {
                let x = -1.0 + (f64::from(i) + 0.5) / 200.0;
                let y = -0.5 + (f64::from(j) + 0.5) / 200.0;
                expected[bin(x)] += probability(problem.energy(&Configuration::new(x, y, 0.0)));
            }
        }
        let total: f64 = expected.iter().sum();
        let mut counted = vec![0usize; bins];
        for m in &found {
            counted[bin(m.q.x)] += 1;
        }
        for (seen, share) in counted.iter().zip(&expected) {
            let mean = share / total * count as f64;
            // Five standard deviations of a Poisson count.
            assert!(
                (*seen as f64 - mean).abs() <= 5.0 * mean.sqrt() + 1.0,
                "{seen} {mean}"
            );
        }
    }
}

/// A path that waits at its start costs the same as without the wait.
#[test]
fn waiting_costs_nothing() {
    let energies = [1e-3, 2e-3, 5e-4, 1.5e-3];
    let lengths = [0.1, 0.2, 0.05];
    let plain = edge::costs_of_energies(&energies, &lengths, &SETTINGS);
    assert_eq!(plain.peak, 2e-3);
    assert!((plain.peak_at - 0.1 / 0.35).abs() < 1e-12 && (plain.length - 0.35).abs() < 1e-12);
    assert!((plain.work[0] - 2e-3).abs() < 1e-15 && (plain.work[1] - 1.5e-3).abs() < 1e-15);
    assert!(plain.minus_ln_probability.iter().all(|p| p.is_finite()));
    for k in 0..energies.len() {
        let (mut waiting, mut steps) = (energies.to_vec(), lengths.to_vec());
        waiting.insert(k, energies[k]);
        steps.insert(k, 0.0);
        let waited = edge::costs_of_energies(&waiting, &steps, &SETTINGS);
        assert_eq!(waited, plain, "{k}");
    }
    let nowhere = edge::costs_of_energies(&[3e-3], &[], &SETTINGS);
    assert_eq!((nowhere.peak, nowhere.length), (3e-3, 0.0));
}

/// Squares with forty magnets per face, which are grouped; the energy along motions near and far
/// compared with all pairs of magnets: between the knots the error is within the tolerance.
#[test]
fn the_energy_of_many_magnets_is_followed_within_the_tolerance() {
    let word = |k: usize| if (k * k + k / 3) % 5 < 2 { 'N' } else { 'S' };
    let code: String = (0..40).map(word).collect();
    let text = format!(
        "name = \"many\"\n[table]\nsize = [2.0, 2.0]\n[magnet]\nsize = [0.008, 0.008, 0.0024]\n\
         remanence = 1.2\npitch = 0.01\ninset = 0.0\n\
         [fixed]\nside = 0.43\nthickness = 0.013\nmass = 0.1\n[fixed.faces]\nall = {{ code = \"{code}\" }}\n\
         [moving]\nside = 0.43\nthickness = 0.013\nmass = 0.1\n[moving.faces]\nall = {{ code = \"{code}\" }}\n\
         [target]\nfixed = \"east\"\nmoving = \"west\"\n[potential]\nmodel = \"dipole\"\n"
    );
    let design = Design::parse(&text, "many.toml").unwrap_or_else(|error| panic!("{error}"));
    let problem = design.problem();
    let pair = problem.pair.clone().expect("two tiles");
    let [fixed, moving] = [&pair.fixed, &pair.moving].map(|tile| dipoles(&tile.magnets));
    let scalar = Plain::new(&fixed, &moving);
    let depth = problem.depth();
    let tolerance = ProfileTolerance {
        relative: 0.0,
        absolute: 1e-4 * depth,
    };
    let mut most = 0f64;
    let mut asked = 0;
    for (from, to) in [
        ([0.430, 0.0, 0.0], [0.430, 0.03, 0.0]),
        ([0.431, -0.02, 0.0], [0.450, 0.02, 0.1]),
        ([0.435, 0.1, 0.01], [0.44, 0.2, 0.0]),
        ([0.50, 0.1, 0.3], [0.7, 0.2, 1.0]),
    ] {
        let [a, b] = [from, to].map(|[x, y, t]| Configuration::new(x, y, t));
        let ends = [a, b].map(|q| Point::new(&problem, q));
        let before = problem.evaluations();
        let profile = Profile::new(&problem, &ends[0], &ends[1], &tolerance);
        asked += problem.evaluations() - before;
        let step = a.step_to(&b);
        let count = 400;
        for (k, energy) in profile.energies(count).enumerate() {
            let t = k as f64 / count as f64;
            let off = (energy - scalar.energy(&a.moved(step * t))).abs();
            assert!(off <= tolerance.absolute, "{from:?} {t}: {off}");
            most = most.max(off / tolerance.absolute);
        }
    }
    println!("{most} of the tolerance, {asked} energies");
    assert!(most > 1e-4, "far finer than it need be: {most}");
}
