//! Collisions by the law of impulses.

use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};
use tilebind::Configuration;
use tilebind::dynamics::{Body, MotionSettings, Snapshot};

use super::{ideal, pushed, run};

/// Half a side (m) of the paper's tile.
const HALF: f64 = 0.215;

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

/// A collision of a corner: the tile's pose and velocity at the contact, and the body that it hits.
struct Knock {
    place: Vector3<f64>,
    velocity: Vector3<f64>,
    /// From the centre of mass to the corner (m).
    arm: Vector2<f64>,
    /// The normal away from the body that is hit.
    normal: Vector2<f64>,
    at_rim: bool,
}

/// Collisions with the other tile's face and the rim, off-centre and through the centre of mass,
/// with sliding in either direction.
fn knocks() -> Vec<Knock> {
    let mut knocks = Vec::new();
    let ways = [
        (0.3, 0.0),
        (-0.3, 0.0),
        (0.02, 0.5),
        (0.8, -1.0),
        (-0.2, 1.0),
    ];
    for (along, spin) in ways {
        for turn in [0.2f64, 0.6, -0.4, TAU / 8.0] {
            for at_rim in [false, true] {
                let side = if at_rim { -1.0 } else { 1.0 };
                let rotation = Configuration::new(0.0, 0.0, turn).rotation();
                let corners = [(HALF, HALF), (HALF, -HALF), (-HALF, HALF), (-HALF, -HALF)];
                let corners = corners.map(|(x, y)| rotation * Vector2::new(x, y));
                let first = corners
                    .into_iter()
                    .min_by(|a, b| (a.x * side).total_cmp(&(b.x * side)));
                let arm = first.unwrap();
                let x = if at_rim { 1.0 } else { HALF } - arm.x;
                knocks.push(Knock {
                    place: Vector3::new(x, 0.05 - arm.y, turn),
                    velocity: Vector3::new(-0.6 * side, along, spin),
                    arm,
                    normal: Vector2::new(side, 0.0),
                    at_rim,
                });
            }
        }
    }
    knocks
}

impl Knock {
    /// The velocity 10 ms after the collision, from a start 100 ms before it.
    fn made(&self, friction: f64, restitution: f64, contact_travel: f64) -> Vector3<f64> {
        let (problem, body) = pushed(Vector3::zeros());
        let settings = MotionSettings {
            walls: self.at_rim,
            friction,
            restitution,
            contact_travel,
            ..ideal()
        };
        let before = 0.1;
        let start = self.place - self.velocity * before;
        let start = (start.into(), self.velocity.into());
        let (run, _) = run(&problem, body, &settings, start, before + 0.01);
        run.last.motion.velocity
    }

    /// By impulses: the normal impulse p reverses the approach velocity according to the
    /// restitution. Friction's impulse f ends the sliding if this takes `|f| <= mu p`, and
    /// otherwise is `mu p` against it.
    fn expected(&self, body: &Body, friction: f64, restitution: f64) -> Vector3<f64> {
        let tangent = Vector2::new(-self.normal.y, self.normal.x);
        // The change by a unit impulse along an axis, and the velocity of the corner along it.
        let [n, t] = [self.normal, tangent].map(|axis| self.lever(axis));
        let change = |axis: Vector3<f64>| axis.component_div(&body.masses());
        let [nn, nt, tt] = [n.dot(&change(n)), n.dot(&change(t)), t.dot(&change(t))];
        let closing = (1.0 + restitution) * n.dot(&self.velocity);
        let sliding = t.dot(&self.velocity);
        let determinant = nn * tt - nt * nt;
        let mut push = (nt * sliding - tt * closing) / determinant;
        let mut rub = (nt * closing - nn * sliding) / determinant;
        if rub.abs() > friction * push {
            let share = friction * rub.signum();
            push = -closing / (nn + nt * share);
            rub = share * push;
        }
        self.velocity + change(n) * push + change(t) * rub
    }

    /// An axis through the corner as a row: its scalar product with a velocity is the corner's.
    fn lever(&self, axis: Vector2<f64>) -> Vector3<f64> {
        Vector3::new(axis.x, axis.y, self.arm.perp(&axis))
    }

    /// The sliding speed of the corner.
    fn slip(&self, velocity: &Vector3<f64>) -> f64 {
        let tangent = Vector2::new(-self.normal.y, self.normal.x);
        self.lever(tangent).dot(velocity)
    }
}

/// The speed (m/s) by which two velocities differ.
fn difference(a: Vector3<f64>, b: Vector3<f64>) -> f64 {
    (a - b).xy().norm() + HALF * (a - b).z.abs()
}

#[test]
fn a_knock_with_friction_turns_the_tile_as_impulses_say() {
    let (_, body) = pushed(Vector3::zeros());
    let mut kinds = [0; 3];
    for knock in knocks() {
        for friction in [0.0, 0.1, 0.3, 1.0] {
            for restitution in [0.0, 0.01, 0.5] {
                let expected = knock.expected(&body, friction, restitution);
                assert!(body.kinetic_energy(&expected) < body.kinetic_energy(&knock.velocity));
                let made = knock.made(friction, restitution, 1e-4);
                // The corner is assumed to be at its place at the start of the step.
                let wrong = difference(made, expected);
                assert!(wrong < 3e-4, "{friction} {restitution}: {wrong}");
                let [before, after] = [knock.velocity, expected].map(|v| knock.slip(&v));
                let kind = match before * after {
                    _ if after.abs() < 1e-9 => 0,
                    same if same > 0.0 => 1,
                    _ => 2,
                };
                kinds[kind] += 1;
            }
        }
    }
    // Those that stick, slide on, and slide the other way.
    assert!(kinds.iter().all(|count| *count > 20), "{kinds:?}");
}

#[test]
fn a_knock_is_the_same_wherever_in_a_step_it_falls() {
    let (_, body) = pushed(Vector3::zeros());
    for knock in knocks().iter().step_by(3) {
        let expected = knock.expected(&body, 0.3, 0.01);
        let wrong = |travel| difference(knock.made(0.3, 0.01, travel), expected);
        for k in 1..8 {
            let travel = 1e-5 * (1.0 + 0.13 * f64::from(k));
            assert!(wrong(travel) < 3.0 * travel, "{travel}: {}", wrong(travel));
        }
    }
}

#[test]
fn a_knock_keeps_the_turning_about_the_corner_and_never_gives_energy() {
    let (_, body) = pushed(Vector3::zeros());
    let mut held_back = 0;
    for knock in knocks() {
        for friction in [0.0, 0.3, 3.0] {
            let after = knock.made(friction, 1.0, 1e-4);
            let turning =
                |v: &Vector3<f64>| body.inertia * v.z - body.mass * knock.arm.perp(&v.xy());
            // The corner moves by the way of a step at most while it is hit.
            let lost = turning(&after) - turning(&knock.velocity);
            let most = 1e-4 * body.mass * (after - knock.velocity).xy().norm();
            assert!(lost.abs() <= most, "{friction}: {lost} {most}");
            let [energy, whole] = [after, knock.velocity].map(|v| body.kinetic_energy(&v));
            assert!(
                energy < whole * (1.0 + 1e-9),
                "{friction}: {energy} {whole}"
            );
            if friction == 0.0 {
                assert!(energy > whole * (1.0 - 1e-9), "{energy} {whole}");
            }
            let full = knock.expected(&body, friction, 1.0);
            if body.kinetic_energy(&full) > whole * (1.0 + 1e-3) {
                // Newton's restitution would add energy; the actual restitution is lower.
                assert!((energy / whole - 1.0).abs() < 1e-9, "{energy} {whole}");
                held_back += 1;
            }
        }
    }
    assert!(held_back > 5, "{held_back}");
}

#[test]
fn thrown_about_a_table_a_tile_never_gains_energy() {
    // Collisions at corners, at faces, in the corners of the rim, and between rim and tile.
    let (problem, body) = pushed(Vector3::zeros());
    for (friction, restitution) in [(0.0, 1.0), (0.3, 1.0), (1.0, 0.7)] {
        let settings = MotionSettings {
            walls: true,
            friction,
            restitution,
            ..ideal()
        };
        for start in [
            ([0.7, 0.0, 0.0], [0.9, 0.2, 0.0]),
            ([0.6, 0.6, 0.3], [0.7, 0.71, -3.0]),
            ([0.0, -0.7, 1.0], [0.4, 0.9, 2.0]),
        ] {
            let (run, snapshots) = run(&problem, body, &settings, start, 6.0);
            assert!(run.contact_steps > 20);
            for pair in snapshots.windows(2) {
                let [before, after] = [&pair[0], &pair[1]].map(Snapshot::total);
                assert!(after < before + 1e-9 * snapshots[0].total(), "{friction}");
            }
            let left = run.last.total() / snapshots[0].total();
            assert!(friction > 0.0 || (left - 1.0).abs() < 1e-6, "{left}");
            let contact = problem.contact.as_ref().unwrap();
            let deepest = snapshots
                .iter()
                .map(|s| contact.clearance(&s.motion.configuration))
                .fold(0.0, f64::min);
            assert!(deepest > -1e-6, "{deepest}");
        }
    }
}

/// Pushed against the other tile and thrown back repeatedly: on one corner, on both together and in
/// turn. An elastic collision loses no energy although the push continues during its steps.
#[test]
fn elastic_knocks_keep_energy_under_a_steady_push() {
    let (problem, body) = pushed(Vector3::new(-2.0, 0.0, 0.0));
    let settings = MotionSettings {
        restitution: 1.0,
        ..ideal()
    };
    for start in [
        ([0.44, 0.0, 0.0], [0.0, 0.0, 0.0]),
        ([0.45, 0.02, 0.02], [-0.1, 0.0, 0.3]),
        ([0.46, 0.0, -0.01], [0.2, 0.0, -0.2]),
    ] {
        let (run, snapshots) = run(&problem, body, &settings, start, 2.0);
        // Above its energy at rest on the face.
        let energy = |snapshot: &Snapshot| snapshot.total() - 2.0 * 0.43;
        let bounces = snapshots
            .windows(2)
            .filter(|pair| {
                let [before, after] = [&pair[0], &pair[1]].map(|s| s.motion.velocity.x);
                after - before > 0.02
            })
            .count();
        assert!(bounces > 10, "{bounces}");
        let left = energy(&run.last) / energy(&snapshots[0]);
        assert!((left - 1.0).abs() < 1e-6, "{left} after {bounces}");
    }
}
