//! Neighbours of milestones.

use std::f64::consts::PI;

use nalgebra::Vector3;
use ordered_float::OrderedFloat;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::roadmap::Point;
use tilebind::roadmap::neighbour::{NeighbourSearch, neighbour_pairs, neighbours_per_milestone};
use tilebind::{Configuration, ConfigurationSpace};

#[test]
fn neighbours_agree_with_a_plain_search_also_across_the_seam() {
    let space = ConfigurationSpace {
        half_size: [1.0, 1.0],
        rho: 0.3,
        free_distance: 0.5,
    };
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let milestones: Vec<Point> = (0..500)
        .map(|_| Point {
            q: Configuration::new(
                rng.random_range(-1.0..1.0),
                rng.random_range(-1.0..1.0),
                rng.random_range(-PI..PI),
            ),
            energy: 0.0,
            gradient: Vector3::zeros(),
        })
        .collect();
    let places: Vec<Configuration> = milestones.iter().map(|m| m.q).collect();
    let search = NeighbourSearch::new(&places, &space);
    for q in &places {
        let mut plain: Vec<(f64, u32)> = milestones
            .iter()
            .enumerate()
            .map(|(i, other)| (space.distance(q, &other.q).powi(2), i as u32))
            .collect();
        plain.sort_by_key(|(squared, _)| OrderedFloat(*squared));
        let found = search.nearest(q, 12);
        assert_eq!(found.len(), 12);
        for (f, p) in found.iter().zip(&plain) {
            assert!((f.0 - p.0).abs() < 1e-12 && f.1 == p.1);
        }
        let all: Vec<usize> = search.by_distance(*q).collect();
        let plain: Vec<usize> = plain.iter().map(|it| it.1 as usize).collect();
        assert_eq!(all, plain);
    }
}

#[test]
fn few_milestones_have_few_neighbours() {
    assert_eq!(neighbours_per_milestone(10_000), 34);
    let space = ConfigurationSpace {
        half_size: [1.0, 1.0],
        rho: 0.3,
        free_distance: 0.5,
    };
    let at = |x: f64| Point {
        q: Configuration::new(x, 0.0, 0.0),
        energy: 0.0,
        gradient: Vector3::zeros(),
    };
    assert!(neighbour_pairs(&[at(0.0)], &space, 5).is_empty());
    let pairs = neighbour_pairs(&[at(0.0), at(0.1), at(0.2)], &space, 5);
    assert_eq!(pairs, [(0, 1), (0, 2), (1, 2)]);
}

/// However few there are, the nearer way round counts.
#[test]
fn few_neighbours_across_the_seam_are_as_far_as_the_metric_says() {
    let space = ConfigurationSpace {
        half_size: [1.0, 1.0],
        rho: 0.3,
        free_distance: 0.5,
    };
    let at = |theta: f64| Point {
        q: Configuration::new(0.0, 0.0, theta),
        energy: 0.0,
        gradient: Vector3::zeros(),
    };
    let milestones = [0.1, 3.0, -3.0, -0.2].map(|theta| at(theta).q);
    let search = NeighbourSearch::new(&milestones, &space);
    for q in milestones {
        for k in 0..7 {
            let found = search.nearest(&q, k);
            assert_eq!(found.len(), k.min(milestones.len()));
            assert!(found.windows(2).all(|pair| pair[0].0 <= pair[1].0));
            for (squared, i) in found {
                let other = &milestones[i as usize];
                let distance = space.distance(&q, other);
                assert!((squared.sqrt() - distance).abs() < 1e-12, "{k} {i}");
            }
        }
    }
}
