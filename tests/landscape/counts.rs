//! Exact numbers of energy evaluations and of certified cells for fixed seeds: if one of them
//! grows, the program has become slower on every machine. If a change is meant to alter them, enter
//! the new numbers here.

use crate::designs;
use tilebind::Configuration;
use tilebind::design::Design;
use tilebind::landscape::minimax::{Certifier, Effort, End};
use tilebind::landscape::minimum::descend;
use tilebind::potential::DipolePotential;
use tilebind::potential::bounds::DipoleBounds;
use tilebind::problem::Problem;
use tilebind::roadmap::{
    Acceptance, EdgeSettings, MilestoneSettings, ProfileTolerance, edge, milestone, neighbour,
};

fn paper_tile() -> Design {
    designs::load("shapes/paper-tile.toml")
}

fn without_contact(design: &Design) -> Problem {
    let potential = DipolePotential::new(&design.pair.fixed.magnets, &design.pair.moving.magnets);
    Problem::without_contact(design.space(), Box::new(potential)).with_tiles(design.pair.clone())
}

#[test]
fn energies_of_a_roadmap() {
    let design = paper_tile();
    let problem = without_contact(&design);
    let depth = problem.depth();
    let settings = MilestoneSettings {
        count: 1000,
        acceptance: Acceptance::Linear {
            lowest: -depth,
            highest: 0.1 * depth,
        },
        seed: 1,
    };
    let since = problem.evaluations();
    let milestones = milestone::milestones(&problem, &settings);
    let for_milestones = problem.evaluations() - since;
    let pairs = neighbour::neighbour_pairs(&milestones, &problem.space, 12);
    let settings = EdgeSettings {
        tolerance: ProfileTolerance {
            relative: 0.01,
            absolute: 1e-5 * depth,
        },
        thermal_energy: 0.01 * depth,
        probability_step: 5e-3,
    };
    let edges = edge::edges(&problem, &milestones, &pairs, &settings);
    let for_edges = problem.evaluations() - since - for_milestones;
    assert_eq!(
        [
            for_milestones,
            pairs.len() as u64,
            edges.len() as u64,
            for_edges
        ],
        [10311, 7329, 4978, 46210],
        "energies of milestones, pairs, edges, energies of edges"
    );
}

#[test]
fn energies_of_a_descent() {
    let design = paper_tile();
    let problem = without_contact(&design);
    let since = problem.evaluations();
    descend(&problem, &Configuration::new(0.5, 0.05, 0.2));
    assert_eq!(problem.evaluations() - since, 83);
}

#[test]
fn cells_of_a_certificate() {
    let design = paper_tile();
    let problem = without_contact(&design);
    let bounds = DipoleBounds::new(&design.pair.fixed, &design.pair.moving);
    let mut certifier = Certifier::new(&bounds, problem.contact.as_ref(), &problem.space);
    let effort = Effort {
        tolerance: 0.65e-3,
        cells: usize::MAX,
    };
    let slid = Configuration::new(0.43, 0.04, 0.0);
    let found = certifier
        .bracket(&slid, &End::At(design.pair.bound), &[], &effort)
        .expect("both ends are free");
    assert_eq!([found.cells, found.rounds], [1592, 21], "cells, rounds");
}
