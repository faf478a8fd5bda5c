//! Fans, the table's own motion, and dry friction on it.

use super::*;
use tilebind::dynamics::Fan;
use tilebind::many_bodies::GRAVITY;

const MU: f64 = 0.2;

/// The tile of a run, sample by sample, and the run.
fn alone(crowd: &Crowd, settings: &TableSettings, tile: Mover) -> (Vec<Mover>, Run) {
    let found = run(crowd, settings, (1, 0), &Start::Given(vec![tile]), true).unwrap();
    let of = |it: &Sample| it.movers.as_ref().unwrap()[0];
    (found.samples.iter().map(of).collect(), found)
}

#[test]
fn a_steady_fan_gives_back_what_it_took() {
    let crowd = inert(0.1, [2.0; 2]);
    for (energy, width, speed) in [(1000.0, 1e-3, 2.0), (1000.0, 1e-2, 0.5), (0.3, 0.2, 1.0)] {
        for aside in [0.0, 0.5 * width, 2.0 * width] {
            let settings = TableSettings {
                fans: vec![Fan::steady([0.0, aside], energy, width)],
                ..ideal(0.7 / speed)
            };
            let tile = mover(0, [-0.3 - 3.0 * width, 0.0, 0.0], [speed, 0.0, 0.0]);
            let (tiles, found) = alone(&crowd, &settings, tile);
            let all = totals(&found);
            for total in &all {
                assert!(
                    (total / all[0] - 1.0).abs() < 1e-3,
                    "{width} {aside} {total}"
                );
            }
            // It comes back, or is deflected.
            let last = tiles.last().unwrap();
            assert!(last.velocity.x < 0.9 * speed, "{last:?}");
            assert!(found.samples.iter().all(|it| it.account.work == 0.0));
        }
    }
}

#[test]
fn a_fan_that_oscillates_does_the_work_that_the_tile_gains() {
    let crowd = inert(0.1, [2.0; 2]);
    let fan = Fan {
        amplitude: 0.5,
        frequency: 3.0,
        ..Fan::steady([0.0; 2], 0.5, 0.02)
    };
    let settings = TableSettings {
        fans: vec![fan],
        ..ideal(1.0)
    };
    let (_, found) = alone(
        &crowd,
        &settings,
        mover(0, [-0.5, 0.004, 0.0], [1.0, 0.0, 0.0]),
    );
    let worked = found.samples.last().unwrap().account.work;
    assert!(worked.abs() > 1e-4, "{worked}");
    assert!(found.energy_error < 1e-3, "{}", found.energy_error);
}

#[test]
fn drag_stops_a_tile_where_it_should() {
    let crowd = inert(0.1, [2.0; 2]);
    for drag in [0.7, 20.0, 200.0] {
        let settings = TableSettings {
            drag,
            ..ideal(30.0 / drag)
        };
        let (tiles, _) = alone(&crowd, &settings, mover(0, [0.0; 3], [0.2, 0.0, 1.0]));
        let last = tiles.last().unwrap().place;
        assert!((last.x - 0.2 / drag).abs() < 1e-9, "{drag} {last:?}");
        assert!((last.z - 1.0 / drag).abs() < 1e-9, "{drag} {last:?}");
    }
}

/// On a table with dry friction.
fn rough(duration: f64) -> TableSettings {
    TableSettings {
        table_friction: MU,
        ..ideal(duration)
    }
}

#[test]
fn a_sliding_tile_stops_after_its_distance_and_a_spinning_one_after_its_angle() {
    let crowd = inert(0.1, [2.0; 2]);
    let speed = 0.6;
    let (tiles, found) = alone(&crowd, &rough(1.0), mover(0, [0.0; 3], [speed, 0.0, 0.0]));
    let last = tiles.last().unwrap();
    let expected = speed * speed / (2.0 * MU * GRAVITY);
    assert!(
        (last.place.x - expected).abs() < 1e-4 * expected,
        "{last:?} {expected}"
    );
    assert!(
        last.velocity.norm() < 1e-6 && last.place.z.abs() < 1e-6,
        "{last:?}"
    );
    assert!(found.energy_error < 1e-3, "{}", found.energy_error);
    // The mean distance of a square's points from its middle is (sqrt 2 + asinh 1) / 6 sides.
    let body = &crowd.kinds[0].body;
    let spin: f64 = 20.0;
    let (tiles, _) = alone(&crowd, &rough(1.0), mover(0, [0.0; 3], [0.0, 0.0, spin]));
    let arm = 0.1 * (libm::sqrt(2.0) + libm::asinh(1.0)) / 6.0;
    let slowing = MU * body.mass * GRAVITY * arm / body.inertia;
    let expected = spin * spin / (2.0 * slowing);
    let last = tiles.last().unwrap();
    assert!(
        (last.place.z / expected - 1.0).abs() < 2e-3,
        "{last:?} {expected}"
    );
    assert!(
        last.place.xy().norm() < 1e-6 && last.velocity.norm() < 1e-6,
        "{last:?}"
    );
}

/// A tile that spins fast is hardly slowed along its way (a pressed disc that turns slides as in a fluid).
#[test]
fn a_spinning_tile_slides_farther() {
    let crowd = inert(0.1, [4.0; 2]);
    let way = |spin: f64| {
        let (tiles, _) = alone(&crowd, &rough(3.0), mover(0, [0.0; 3], [0.6, 0.0, spin]));
        tiles.last().unwrap().place.x
    };
    let [still, spun] = [way(0.0), way(60.0)];
    assert!(spun > 1.3 * still, "{still} {spun}");
}

#[test]
fn a_tile_rests_on_an_orbiting_table_until_friction_gives_way() {
    let crowd = inert(0.1, [2.0; 2]);
    let frequency = 3.0;
    let rate = TAU * frequency;
    let on = |share: f64| {
        // The table's acceleration as a share of what friction can give.
        let settings = TableSettings {
            orbital: Some(Orbital {
                amplitude: share * MU * GRAVITY / (rate * rate),
                frequency,
            }),
            ..rough(2.0)
        };
        alone(&crowd, &settings, mover(0, [0.0; 3], [0.0; 3])).0
    };
    assert!(on(0.99).iter().all(|it| it.place.norm() < 1e-6));
    assert!(on(1.01).iter().any(|it| it.velocity.norm() > 1e-4));
    // It then goes round in a steady circle of radius sqrt(A^2 - (mu g / w^2)^2), in the table's frame.
    let share = 1.5;
    let tiles = on(share);
    let unit = MU * GRAVITY / (rate * rate);
    let expected = unit * libm::sqrt(share * share - 1.0);
    for tile in &tiles[tiles.len() / 2..] {
        let radius = tile.velocity.xy().norm() / rate;
        assert!(
            (radius / expected - 1.0).abs() < 0.01,
            "{radius} {expected}"
        );
    }
}

#[test]
fn linear_shaking_moves_a_tile_from_the_phase_at_which_friction_gives_way() {
    let crowd = inert(0.1, [2.0; 2]);
    let frequency = 2.0;
    let rate = TAU * frequency;
    let angle = 0.5;
    let settings = TableSettings {
        linear: Some(Linear {
            amplitude: 2.0 * MU * GRAVITY / (rate * rate),
            frequency,
            angle,
        }),
        step: 5e-4,
        sampling: 5e-4,
        ..rough(0.1)
    };
    let (tiles, found) = alone(&crowd, &settings, mover(0, [0.0; 3], [0.0; 3]));
    let moves = tiles
        .iter()
        .position(|it| it.velocity.norm() > 1e-4)
        .unwrap();
    let phase = rate * found.samples[moves].time;
    // It takes 2.2 ms to come to 1e-4 m/s.
    let late = phase - TAU / 12.0;
    assert!((0.0..rate * 3.3e-3).contains(&late), "{late}");
    let last = tiles.last().unwrap().place;
    assert!(
        (libm::atan2(last.y, last.x) - angle).abs() < 1e-6,
        "{last:?}"
    );
}

/// Two tiles in a bond, which press on each other with far more than their weight, slide as one does.
#[test]
fn a_bound_pair_slides_on_an_orbiting_table_as_one_tile() {
    let (problem, crowd) = one_face(MagnetModel::Dipole);
    let bound = problem.pair.as_ref().unwrap().bound;
    let frequency = 2.0;
    let rate = TAU * frequency;
    let unit = MU * GRAVITY / (rate * rate);
    let settings = TableSettings {
        orbital: Some(Orbital {
            amplitude: 1.5 * unit,
            frequency,
        }),
        friction: 0.3,
        restitution: 0.0,
        ..rough(3.0)
    };
    let movers = vec![
        mover(0, [0.0; 3], [0.0; 3]),
        mover(1, [bound.x, bound.y, bound.theta], [0.0; 3]),
    ];
    let found = run(&crowd, &settings, (1, 0), &Start::Given(movers), true).unwrap();
    let expected = unit * libm::sqrt(1.25);
    for sample in &found.samples[found.samples.len() / 2..] {
        let tiles = sample.movers.as_ref().unwrap();
        let mean = (tiles[0].velocity + tiles[1].velocity) * 0.5;
        let radius = mean.xy().norm() / rate;
        assert!(
            (radius / expected - 1.0).abs() < 0.03,
            "{radius} {expected}"
        );
    }
    assert_eq!(found.samples.last().unwrap().count(Tie::Bond), 1);
    assert!(found.energy_error < 0.01, "{}", found.energy_error);
}

/// An elastic tile in a round table keeps its energy and stays inside.
#[test]
fn a_round_rim_reflects() {
    let mut crowd = inert(0.1, [1.0; 2]);
    crowd.rim = Rim::Disc(0.3);
    let settings = TableSettings {
        walls: true,
        ..ideal(10.0)
    };
    let (tiles, found) = alone(
        &crowd,
        &settings,
        mover(0, [0.1, 0.0, 0.3], [0.5, 0.2, 1.0]),
    );
    for tile in &tiles {
        let q = tile.motion(&crowd).configuration;
        for corner in crowd.kinds[0].tile.outline.vertices() {
            assert!(q.transform(*corner).norm() < 0.3 + 1e-6);
        }
    }
    let all = totals(&found);
    assert!(
        all.iter().all(|it| (it / all[0] - 1.0).abs() < 1e-6),
        "{all:?}"
    );
    assert!((tiles.last().unwrap().velocity.xy() - tiles[0].velocity.xy()).norm() > 0.1);
}
