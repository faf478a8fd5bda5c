//! The grids behind the pictures against energies and contact computed directly.

use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::landscape::approach::{Approach, ApproachSlices, SliceSettings};
use tilebind::landscape::grid::{Grid, Sample};
use tilebind::landscape::map::{EnergyMap, Window};

use super::paper_tile::{BOUND, pair};

fn window() -> Window {
    Window {
        origin: Vector2::zeros(),
        angle: 0.0,
        low: [-0.7, -0.7],
        high: [0.7, 0.7],
        samples: [41, 41],
    }
}

/// The samples with their indices, column by column within a row.
fn samples(grid: &Grid<Sample>) -> impl Iterator<Item = (usize, usize, &Sample)> {
    let columns = grid.x.len();
    let values = grid.values.iter().enumerate();
    values.filter_map(move |(i, value)| value.as_ref().map(|v| (i % columns, i / columns, v)))
}

#[test]
fn samples_are_free_and_have_the_energy_of_their_configuration() {
    let pair = pair();
    let map = EnergyMap::new(&pair.problem, &window(), 48);
    let approach = Approach::new(&pair.design.pair);
    let slices = ApproachSlices::new(&pair.problem, &approach, &slice_settings());
    for grid in [&map.lowest, &slices.gap, &slices.slide] {
        let mut count = 0;
        for (_, _, sample) in samples(grid) {
            let q = sample.configuration;
            assert!(pair.problem.is_clear(&q), "{q:?}");
            let energy = pair.problem.energy(&q);
            assert!((sample.energy - energy).abs() <= 1e-9 * energy.abs() + 1e-15);
            count += 1;
        }
        assert!(count > 600);
    }
}

#[test]
fn no_orientation_lies_far_below_the_lowest() {
    let pair = pair();
    let fine = Window {
        low: [0.1, -0.1],
        high: [0.65, 0.45],
        samples: [61, 61],
        ..window()
    };
    let map = EnergyMap::new(&pair.problem, &fine, 48);
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut blocked = 0;
    for (index, lowest) in map.lowest.values.iter().enumerate() {
        let (x, y) = (map.lowest.x[index % 61], map.lowest.y[index / 61]);
        for _ in 0..20 {
            let theta = random.random_range(-3.1..3.1);
            let q = Configuration::new(x, y, theta);
            if !pair.problem.is_clear(&q) {
                blocked += 1;
                continue;
            }
            let energy = pair.problem.energy(&q);
            let sample = lowest.expect("a free orientation was found at random");
            assert_eq!(sample.configuration.position(), q.position());
            // The search ends a tenth of a degree from a minimum over theta.
            assert!(
                sample.energy <= energy + 0.01 * energy.abs(),
                "{q:?} {energy} {sample:?}"
            );
        }
    }
    assert!(blocked > 10_000);
}

#[test]
fn the_map_is_blocked_where_every_orientation_overlaps() {
    let pair = pair();
    let map = EnergyMap::new(&pair.problem, &window(), 48);
    // Two squares of side a: overlap in any orientation below a, in none from a sqrt(2) on.
    let side = 0.43;
    for (index, value) in map.lowest.values.iter().enumerate() {
        let distance = map.lowest.x[index % 41].hypot(map.lowest.y[index / 41]);
        if distance < side - 1e-9 {
            assert!(value.is_none() && map.border_distance[index] < 0.0);
        }
        if distance > side * 2f64.sqrt() {
            assert!(value.is_some() && map.border_distance[index] > 0.0);
        }
    }
}

#[test]
fn a_map_of_squares_repeats_after_a_quarter_turn() {
    let pair = pair();
    let map = EnergyMap::new(&pair.problem, &window(), 48);
    for row in 0..41 {
        for column in 0..41 {
            let here = map.lowest.value(column, row).map(|s| s.energy);
            let there = map.lowest.value(40 - row, column).map(|s| s.energy);
            match (here, there) {
                // Turned places are rounded apart by 1e-16 m.
                (Some(a), Some(b)) => assert!((a - b).abs() <= 1e-6 * a.abs(), "{a} {b}"),
                (a, b) => assert_eq!(a.is_some(), b.is_some(), "{column} {row}"),
            }
        }
    }
}

#[test]
fn a_turned_window_shows_the_same_place() {
    let pair = pair();
    let turned = Window {
        origin: BOUND.position(),
        angle: std::f64::consts::FRAC_PI_2,
        low: [-0.1, -0.2],
        high: [0.1, 0.0],
        samples: [3, 3],
    };
    let map = EnergyMap::new(&pair.problem, &turned, 48);
    // The grid's x axis points along +y, its y axis along -x.
    let sample = map.lowest.value(2, 0).unwrap();
    let expected = BOUND.position() + Vector2::new(0.2, 0.1);
    assert!((sample.configuration.position() - expected).norm() < 1e-12);
    let back = turned.locate(expected);
    assert!((back - Vector2::new(0.1, -0.2)).norm() < 1e-12);
}

fn slice_settings() -> SliceSettings {
    SliceSettings {
        tilt: 0.6,
        gap: 0.08,
        slide: 0.2,
        samples: 31,
    }
}

#[test]
fn slices_start_from_contact_and_pass_through_the_bound_state() {
    let pair = pair();
    let approach = Approach::new(&pair.design.pair);
    let slices = ApproachSlices::new(&pair.problem, &approach, &slice_settings());
    let bound = pair.problem.energy(&BOUND);
    let at_bound = [slices.gap.value(15, 0), slices.slide.value(15, 15)];
    for sample in at_bound {
        assert!((sample.unwrap().energy - bound).abs() < 1e-9 * bound.abs());
    }
    for (column, row, sample) in samples(&slices.slide) {
        let clearance = pair.problem.clearance(&sample.configuration);
        assert!(clearance.abs() < 1e-8);
        let (tilt, slide) = approach.tilt_and_slide(&sample.configuration);
        assert!((tilt - slices.slide.x[column]).abs() < 1e-12);
        assert!((slide - slices.slide.y[row]).abs() < 1e-12);
    }
    // In front of a straight face the gap along the normal is the clearance.
    for (_, row, sample) in samples(&slices.gap) {
        let clearance = pair.problem.clearance(&sample.configuration);
        assert!((clearance - slices.gap.y[row]).abs() < 1e-8);
    }
}
