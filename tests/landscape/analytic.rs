//! Surveys of landscapes whose minima and saddles are known.

use std::collections::HashSet;

use crate::surfaces::{DoubleWell, MuellerBrown};
use crate::surveys;
use nalgebra::Vector3;
use tilebind::configuration::{Configuration, ConfigurationSpace};
use tilebind::landscape::exploration::{Exploration, ExplorationSettings};
use tilebind::potential::Potential;
use tilebind::problem::Problem;
use tilebind::roadmap::{
    Acceptance, EdgeSettings, MilestoneSettings, ProfileTolerance, RoadmapSettings, neighbour,
};

/// A landscape in x and y with a well in theta, around 0, so that minima are points.
struct Upright<P> {
    plane: P,
    /// Energy (J) that it costs to lie on the side.
    stiffness: f64,
}

impl<P: Potential> Potential for Upright<P> {
    fn energy(&self, q: &Configuration) -> f64 {
        self.plane.energy(q) + self.stiffness * (1.0 - q.theta.cos())
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let (energy, gradient) = self.plane.energy_and_gradient(q);
        let upright = self.stiffness * (1.0 - q.theta.cos());
        let turning = Vector3::new(0.0, 0.0, self.stiffness * q.theta.sin());
        (energy + upright, gradient + turning)
    }

    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64 {
        self.plane.curvature_bound(q, reach) + self.stiffness / LEVER.powi(2)
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        self.plane.displacement(step).hypot(LEVER * step.z)
    }
}

const LEVER: f64 = 0.1;

const SPACE: ConfigurationSpace = ConfigurationSpace {
    half_size: [1.0, 1.0],
    rho: LEVER,
    free_distance: 10.0,
};

/// A barrier counts as settled when it moves by less than this fraction.
pub const SETTLED: f64 = 0.005;

pub fn survey(problem: &Problem, scale: f64, highest: f64, seed: u64) -> Exploration<'_> {
    let edge = EdgeSettings {
        tolerance: ProfileTolerance {
            relative: 0.01,
            absolute: 1e-4 * scale,
        },
        thermal_energy: 0.01 * scale,
        probability_step: 5e-3,
    };
    let milestones = MilestoneSettings {
        count: 1500,
        acceptance: Acceptance::Linear {
            lowest: highest - scale,
            highest,
        },
        seed,
    };
    let roadmap = RoadmapSettings {
        milestones,
        neighbours: neighbour::neighbours_per_milestone(milestones.count),
        edges: edge,
    };
    let roadmap = surveys::weighed(problem, &roadmap);
    let settings = ExplorationSettings {
        edge,
        settled: SETTLED,
        most_kinds: None,
        added_milestones: 100,
        most_rounds: 8,
        seed,
    };
    surveys::survey(problem, roadmap, &settings)
}

/// The saddle energy (J) between the states at two configurations.
fn barrier(survey: &Exploration, a: &Configuration, b: &Configuration) -> f64 {
    let node = |q: &Configuration| {
        let state = survey.state_at(q, 1e-3).expect("a state is here");
        survey.states[state].node
    };
    let goals = HashSet::from([node(b)]);
    survey.network.minimax(node(a), &goals).expect("a way")
}

#[test]
fn the_double_well_has_two_minima_and_its_saddle_for_every_seed() {
    for seed in 1..=5 {
        let plane = DoubleWell {
            height: 2e-3,
            half_distance: 0.4,
            stiffness: 0.03,
        };
        let stiffness = 1e-3;
        let problem = Problem::without_contact(SPACE, Box::new(Upright { plane, stiffness }));
        let survey = survey(&problem, 6e-3, 6e-3, seed);
        assert_eq!(survey.states.len(), 2);
        let ends = [-0.4, 0.4].map(|x| Configuration::new(x, 0.0, 0.0));
        let saddle = barrier(&survey, &ends[0], &ends[1]);
        assert!((saddle - 2e-3).abs() < 1e-9, "{saddle}");
        let reverse = barrier(&survey, &ends[1], &ends[0]);
        assert_eq!(saddle, reverse);
        for state in &survey.states {
            assert!(state.minimum.point.energy.abs() < 1e-12);
            assert_eq!(state.minimum.index(), 0);
        }
    }
}

#[test]
fn mueller_and_brown_s_surface_has_its_three_minima_and_two_saddles() {
    let plane = MuellerBrown {
        scale: 1e-3,
        length: 0.4,
        origin: [0.05, -0.35],
    };
    let at = |x: f64, y: f64| plane.configuration(x, y);
    let minima = [
        (at(-0.55822, 1.44173), -146.69952e-3),
        (at(-0.05001, 0.46669), -80.76782e-3),
        (at(0.62350, 0.02804), -108.16672e-3),
    ];
    let stiffness = 20e-3;
    let problem = Problem::without_contact(SPACE, Box::new(Upright { plane, stiffness }));
    let survey = survey(&problem, 150e-3, 0.0, 1);
    for (q, energy) in &minima {
        let state = survey.state_at(q, 1e-3).expect("a minimum");
        let found = survey.states[state].minimum.point.energy;
        assert!((found - energy).abs() < 1e-8, "{found} {energy}");
    }
    // Beyond the square's rim the surface rises again nowhere near; three minima are all.
    assert_eq!(survey.states.len(), 3);
    let [(deep, _), (middle, _), (right, _)] = &minima;
    for (a, b, saddle) in [
        (deep, middle, -40.66484e-3),
        (middle, right, -72.24894e-3),
        (deep, right, -40.66484e-3),
    ] {
        let found = barrier(&survey, a, b);
        assert!((found - saddle).abs() < 1e-8, "{found} {saddle}");
    }
    assert_eq!(survey.transition_states.len(), 2);
    for (saddle, _) in &survey.transition_states {
        assert_eq!(saddle.index(), 1);
    }
}
