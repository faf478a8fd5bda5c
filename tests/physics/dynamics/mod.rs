//! Rigid-body motion: friction, drag, shaking and fans by the laws of mechanics.

mod bound;
mod check;
mod docking;
mod knocks;

use std::sync::Arc;

use nalgebra::{Vector2, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use tilebind::dynamics::{Body, Fan, Motion, MotionSettings, Run, Simulation, Snapshot, Stop};
use tilebind::potential::Potential;
use tilebind::tile::Outline;
use tilebind::{Configuration, Design, Problem};

use crate::designs;

/// A steady force (N, N) and torque (N m): U = -F.q.
struct Steady(Vector3<f64>);

impl Potential for Steady {
    fn energy(&self, q: &Configuration) -> f64 {
        -self.0.dot(&Vector3::new(q.x, q.y, q.theta))
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        (self.energy(q), -self.0)
    }

    fn curvature_bound(&self, _: &Configuration, _: f64) -> f64 {
        0.0
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.xy().norm()
    }
}

fn paper_tile() -> Design {
    designs::load("shapes/paper-tile.toml")
}

/// The paper's tiles under a steady force in place of their magnets.
fn pushed(force: Vector3<f64>) -> (Problem, Body) {
    let design = paper_tile();
    let problem = Problem::without_contact(design.space(), Box::new(Steady(force)));
    let body = Body::of_tile(&design.pair.moving);
    (problem.with_tiles(design.pair), body)
}

/// No drag, no friction, no rim.
fn ideal() -> MotionSettings {
    MotionSettings {
        drag: 0.0,
        friction: 0.0,
        restitution: 0.0,
        walls: false,
        ..MotionSettings::default()
    }
}

fn run(
    problem: &Problem,
    body: Body,
    settings: &MotionSettings,
    start: ([f64; 3], [f64; 3]),
    duration: f64,
) -> (Run, Vec<Snapshot>) {
    let mut snapshots = Vec::new();
    let start = Motion {
        configuration: start.0.into(),
        velocity: start.1.into(),
    };
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let run = Simulation::new(problem, body, settings).unwrap().run(
        &start,
        duration,
        &mut rng,
        &mut |snapshot| {
            snapshots.push(*snapshot);
            false
        },
    );
    (run, snapshots)
}

#[test]
fn free_flight_keeps_momentum_and_drag_takes_it_at_its_rate() {
    let (problem, body) = pushed(Vector3::zeros());
    for drag in [0.0, 0.5] {
        let settings = MotionSettings { drag, ..ideal() };
        let start = ([0.7, 0.0, 1.0], [0.2, -0.1, 3.0]);
        let (run, _) = run(&problem, body, &settings, start, 4.0);
        let (left, way) = if drag > 0.0 {
            let left = (-drag * 4.0f64).exp();
            (left, (1.0 - left) / drag)
        } else {
            (1.0, 4.0)
        };
        let motion = run.last.motion;
        let expected = Vector3::new(0.2, -0.1, 3.0);
        assert!((motion.velocity - expected * left).norm() < 1e-7);
        assert!((motion.configuration.x - (0.7 + 0.2 * way)).abs() < 1e-6);
        assert!((motion.configuration.y + 0.1 * way).abs() < 1e-6);
    }
}

/// Where nothing else acts, shaken tiles diffuse with kT over the drag, however strong that is.
#[test]
fn strong_drag_leaves_the_diffusion_that_it_is_to_be() {
    let (problem, body) = pushed(Vector3::zeros());
    let kt = 3e-3;
    for drag in [50.0, 1000.0] {
        let settings = MotionSettings {
            drag,
            shaking: Some(kt),
            longest_step: 1.0,
            ..ideal()
        };
        let simulation = Simulation::new(&problem, body, &settings).unwrap();
        let (time, count) = (100.0 / drag, 2000);
        let start = Motion::from([5.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let squares = (0..count).map(|seed| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let end = simulation.run(&start, time, &mut rng, &mut |_| false).last;
            let q = end.motion.configuration;
            (q.x - 5.0).powi(2) + q.y * q.y
        });
        let mean = squares.sum::<f64>() / count as f64;
        // At rest first, it starts late: t - 3/(2c) for t (Ornstein and Uhlenbeck).
        let expected = 4.0 * kt / (drag * body.mass) * (time - 1.5 / drag);
        // Of so many squares of two normal numbers each the mean is known to 1 / sqrt(count).
        let error = 3.5 / (count as f64).sqrt();
        assert!(
            (mean / expected - 1.0).abs() < error,
            "{drag}: {}",
            mean / expected
        );
    }
}

#[test]
fn energy_is_kept_past_strong_magnets() {
    let design = paper_tile();
    let problem = design.problem();
    let body = Body::of_tile(&design.pair.moving);
    // Past the corner of the fixed tile, in and out of the field, without touching it.
    for start in [
        ([0.53, -0.9, 0.3], [0.0, 0.5, 0.5]),
        ([0.50, -0.9, 0.0], [0.0, 0.6, 0.0]),
        ([0.47, -0.9, 0.02], [0.0, 0.8, 0.0]),
    ] {
        let (run, snapshots) = run(&problem, body, &ideal(), start, 5.0);
        let first = snapshots[0].total();
        let drift = snapshots
            .iter()
            .map(|s| (s.total() - first).abs())
            .fold(0.0, f64::max);
        assert_eq!(run.contact_steps, 0, "meant not to touch");
        assert!(drift < 1e-5 * 65.47e-3);
    }
}

#[test]
fn a_tile_slides_to_rest_by_coulombs_law() {
    // Pressed against the face by F, the tile slows down by mu F / m.
    let force = 0.2;
    let (problem, body) = pushed(Vector3::new(-force, 0.0, 0.0));
    let settings = MotionSettings {
        friction: 0.3,
        ..ideal()
    };
    let (run, _) = run(
        &problem,
        body,
        &settings,
        ([0.43, -0.1, 0.0], [0.0, 0.3, 0.0]),
        3.0,
    );
    let way = 0.3f64.powi(2) / (2.0 * 0.3 * force / body.mass);
    assert_eq!(run.stop, Stop::Rest);
    assert!((run.last.motion.configuration.y + 0.1 - way).abs() < 1e-3 * way);
}

#[test]
fn a_tile_slides_along_a_chain_of_chords_without_a_snag() {
    // The fixed tile's face is cut into chords that go in and out by a micrometre. Pressed on and
    // without friction, a tile that slides along them keeps its speed, and does not sink in.
    let mut design = paper_tile();
    let half = 0.215;
    let chords = 43;
    let wavy = (0..=chords).map(|k| {
        let y = -half + 2.0 * half * f64::from(k) / f64::from(chords);
        Vector2::new(half + if k % 2 == 0 { 0.0 } else { 1e-6 }, y)
    });
    let back = [[-half, half], [-half, -half]].map(Vector2::from);
    let outline = Outline::new(wavy.chain(back).collect()).unwrap();
    let pair = Arc::make_mut(&mut design.pair);
    pair.fixed.outline = outline;
    let body = Body::of_tile(&pair.moving);
    let steady = Steady(Vector3::new(-0.2, 0.0, 0.0));
    let problem = Problem::without_contact(design.space(), Box::new(steady));
    let problem = problem.with_tiles(design.pair);
    for restitution in [0.0, 0.9] {
        let settings = MotionSettings {
            restitution,
            ..ideal()
        };
        let start = ([0.43001, -0.2, 0.0], [0.0, 0.3, 0.0]);
        let (run, snapshots) = run(&problem, body, &settings, start, 1.2);
        let motion = run.last.motion;
        assert!((motion.velocity.y - 0.3).abs() < 1e-3, "{run:?}");
        assert!(motion.configuration.y > 0.15, "{run:?}");
        let contact = problem.contact.as_ref().unwrap();
        for snapshot in snapshots.iter().step_by(20) {
            let clearance = contact.clearance(&snapshot.motion.configuration);
            assert!(clearance > -1e-6, "{clearance}");
        }
    }
}

#[test]
fn mated_teeth_rest_where_they_fit() {
    // Sine teeth pushed together from a little beside their mates slide down the flanks.
    let design = designs::load("shapes/sine-teeth-20mm.toml");
    let body = Body::of_tile(&design.pair.moving);
    let steady = Steady(Vector3::new(-0.2, 0.0, 0.0));
    let problem = Problem::without_contact(design.space(), Box::new(steady));
    let bound = design.pair.bound;
    let problem = problem.with_tiles(design.pair);
    let settings = MotionSettings {
        drag: 5.0,
        ..ideal()
    };
    let start = ([bound.x + 0.01, bound.y + 0.004, 0.0], [0.0, 0.0, 0.0]);
    let (run, _) = run(&problem, body, &settings, start, 20.0);
    let q = run.last.motion.configuration;
    assert!(problem.space.distance(&q, &bound) < 1e-5, "{run:?}");
    assert_eq!(run.stop, Stop::Rest);
}

#[test]
fn the_bond_at_rest_is_the_minimum_of_the_energy_at_any_step() {
    let design = paper_tile();
    let problem = design.problem();
    let body = Body::of_tile(&design.pair.moving);
    for (contact_step, contact_travel) in [(1e-3, 2e-4), (1e-3, 1e-4), (1e-4, 5e-5)] {
        let settings = MotionSettings {
            drag: 5.0,
            friction: 0.0,
            contact_step,
            contact_travel,
            ..MotionSettings::default()
        };
        let start = ([0.5, 0.01, 0.02], [0.0, 0.0, 0.0]);
        let (run, _) = run(&problem, body, &settings, start, 20.0);
        let q = run.last.motion.configuration;
        assert!(
            problem.space.distance(&q, &design.pair.bound) < 1e-5,
            "{run:?}"
        );
        let energy = problem.energy(&design.pair.bound);
        assert!((run.last.potential - energy).abs() < 1e-3 * energy.abs());
    }
}

#[test]
fn shaking_keeps_half_of_kt_in_each_degree_of_freedom() {
    let (problem, body) = pushed(Vector3::zeros());
    let energy = 1e-4;
    let settings = MotionSettings {
        drag: 2.0,
        shaking: Some(energy),
        ..ideal()
    };
    let (_, snapshots) = run(
        &problem,
        body,
        &settings,
        ([50.0, 0.0, 0.0], [0.0; 3]),
        400.0,
    );
    let masses = body.masses();
    for axis in 0..3 {
        let mean = snapshots
            .iter()
            .map(|s| 0.5 * masses[axis] * s.motion.velocity[axis].powi(2))
            .sum::<f64>()
            / snapshots.len() as f64;
        // 400 s hold 400 independent values of the energy's (correlation time 1 / 2c, both
        // sides), each with a standard deviation of sqrt(2) of its mean.
        let deviation = (mean / (0.5 * energy) - 1.0).abs();
        assert!(
            deviation < 4.0 * (2.0f64 / 400.0).sqrt(),
            "{axis}: {deviation}"
        );
    }
}

#[test]
fn a_fan_pushes_down_its_energy_and_a_steady_one_keeps_the_total() {
    let fan = Fan {
        amplitude: 0.5,
        frequency: 2.0,
        ..Fan::steady([0.8, 0.1], 2e-3, 0.15)
    };
    let (r, t, step) = (Vector2::new(0.7, 0.25), 0.3, 1e-6);
    let energy = |r: Vector2<f64>| fan.energy_and_force(r, t).0;
    let force = fan.energy_and_force(r, t).1;
    for axis in [Vector2::x(), Vector2::y()] {
        let slope = (energy(r + axis * step) - energy(r - axis * step)) / (2.0 * step);
        assert!((force.dot(&axis) + slope).abs() < 1e-8);
    }
    // Its top is at its place, half as high again a quarter of a swing after the start.
    let top = fan.energy_and_force(fan.place.into(), 0.125).0;
    assert!((top - 1.5 * fan.energy).abs() < 1e-15);

    let (problem, body) = pushed(Vector3::zeros());
    let settings = MotionSettings {
        fans: vec![Fan::steady([0.9, 0.0], 2e-3, 0.1)],
        ..ideal()
    };
    // Slowed down, turned aside and sped up again.
    let start = ([1.4, 0.05, 0.0], [-0.15, 0.0, 0.2]);
    let (run, snapshots) = run(&problem, body, &settings, start, 5.0);
    let total = snapshots[0].total();
    assert_eq!(run.contact_steps, 0, "meant not to touch");
    assert!(snapshots.iter().any(|s| s.potential > 0.3 * total));
    assert!(
        snapshots
            .iter()
            .all(|s| (s.total() - total).abs() < 1e-6 * total)
    );
    assert!(run.last.motion.velocity.y > 0.05, "{run:?}");
}
