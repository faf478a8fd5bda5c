//! Tiles that really move: knocks, friction, drag, shaking and fans by the laws of mechanics.

mod check;
mod docking;

use nalgebra::{Vector2, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use tilebind::dynamics::{Body, Fan, Motion, MotionSettings, Run, Simulation, Snapshot, Stop};
use tilebind::potential::Potential;
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
fn a_flush_knock_without_restitution_stops_the_tile() {
    let (problem, body) = pushed(Vector3::zeros());
    let start = ([0.5, 0.03, 0.0], [-0.4, 0.1, 0.0]);
    let (run, _) = run(&problem, body, &ideal(), start, 1.0);
    // Without friction it goes on along the face.
    assert!((run.last.motion.velocity - Vector3::new(0.0, 0.1, 0.0)).norm() < 1e-4);
    assert!((run.last.motion.configuration.x - 0.43).abs() < 1e-5);
}

#[test]
fn a_knock_on_a_corner_turns_the_tile_as_impulses_say() {
    // A corner of the moving tile hits the face with the normal (1, 0): with the lever r from the
    // centre of mass to the corner, v_n = v.n the approach, and the impulse
    // j = -(1 + e) v_n / (1/m + (r x n)^2 / I), the velocity changes by j/m n and the turning rate
    // by j (r x n) / I.
    let (problem, body) = pushed(Vector3::zeros());
    let (theta, speed) = (0.3f64, 0.4);
    for restitution in [0.0, 0.5, 1.0] {
        let settings = MotionSettings {
            restitution,
            ..ideal()
        };
        let start = ([0.55, 0.0, theta], [-speed, 0.0, 0.0]);
        let (run, _) = run(&problem, body, &settings, start, 0.3);
        let corner = Configuration::new(0.0, 0.0, theta).transform([-0.215, 0.215].into());
        let other = Configuration::new(0.0, 0.0, theta).transform([-0.215, -0.215].into());
        let lever = if corner.x < other.x { corner } else { other };
        let arm = -lever.y;
        let impulse = (1.0 + restitution) * speed / (1.0 / body.mass + arm * arm / body.inertia);
        let expected = Vector3::new(
            -speed + impulse / body.mass,
            0.0,
            impulse * arm / body.inertia,
        );
        // While the corner stays on the face, the tile goes on turning about it.
        let tolerance = if restitution > 0.0 { 1e-9 } else { 1e-4 };
        assert!((run.last.motion.velocity - expected).norm() < tolerance);
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
