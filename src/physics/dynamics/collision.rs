//! Contact impulses with friction on the moving tile.
//!
//! Let v0 be the velocity of a step without contact, and for each contact point let n and t be the
//! normal and the tangent as rows (direction, arm x direction) about the centre of mass. There are
//! impulses p, f with
//!
//! `v = v0 + M^-1 sum (n p + t f)`, `n.v >= l` and `p >= 0`, one of them with equality,
//! `|f| <= mu p`, and `t.v = 0` unless `f = -+ mu p` holds against the sliding
//!
//! (Stewart and Trinkle 1996, Int. J. Numer. Meth. Eng. 39, 2673): the law of impulses with
//! friction for one point, and for many points a law that Anitescu and Potra (1997, Nonlinear
//! Dynamics 14, 231) show never to add energy. The tile moves with `l = -gap / h`, so that it ends
//! at contact and not before; then its velocity into the touched points is removed with `l = 0`. So
//! a collision is complete within one step, wherever in the step it occurs, and no state of earlier
//! steps is needed.
//!
//! Restitution e requires `l = e u`, where u is the approach velocity before the step's
//! acceleration, which is zero for resting contact. Where many points or friction would increase
//! the energy (Kane and Levinson 1985), the restitution is reduced until they do not. Because u
//! excludes the step's acceleration, steady forces take a little energy from every collision.
//! Elastic collisions (e = 1) must not lose it, as the losses add up: there u is the approach
//! velocity at contact, `u^2 = u0^2 - 2 a gap` with the approach velocity u0 at the step's start
//! and the acceleration a along n, and the velocity at the step's end (velocities belong to the
//! middles of steps) must be `n.v = u`. Then energy is conserved, except for bounces shorter than a
//! step.

use nalgebra::{Vector2, Vector3};

use super::body::{Body, Phase};
use super::settings::MotionSettings;
use crate::contact::ContactPoint;
use crate::scale::Scale;
use crate::tile::outline::cross;

/// Error of the computed velocities (m/s), far below the velocities of tiles of any size.
const ERROR: f64 = 1e-10;
/// Points with gaps below this (m) are in contact.
const TOUCHED: f64 = 1e-9;
/// Largest correction (m) of overlaps per step.
const PUSHED_OUT: f64 = 1e-6;
/// Largest number of sweeps over the active points; two suffice for one point.
const SWEEPS: usize = 200;

/// A point of contact as rows of velocities.
#[derive(Clone, Copy, Debug)]
struct Hold {
    normal: Vector3<f64>,
    tangent: Vector3<f64>,
    gap: f64,
    /// Least velocity (m/s) along the normal.
    least: f64,
}

impl Hold {
    fn new(point: &ContactPoint, centre: Vector2<f64>) -> Self {
        let arm = point.on_moving - centre;
        let row = |axis: Vector2<f64>| Vector3::new(axis.x, axis.y, cross(arm, axis));
        let n = point.normal;
        Self {
            normal: row(n),
            tangent: row(Vector2::new(-n.y, n.x)),
            gap: point.gap,
            least: 0.0,
        }
    }

    /// The least velocity (m/s) along the normal in the middle of a step with an elastic collision,
    /// from the velocity in the middle of the previous step: at the step's end it equals the
    /// approach velocity at contact.
    fn thrown_back(&self, stride: &Stride, velocity: &Vector3<f64>) -> f64 {
        let start = self.normal.dot(&stride.at_start(velocity)).min(0.0);
        let pull = -self.normal.dot(&stride.acceleration);
        let square = start * start + 2.0 * pull * self.gap.max(0.0);
        square.max(0.0).sqrt() + 0.5 * pull * stride.h
    }

    /// The impulses along normal and tangent required by a velocity.
    fn impulses(&self, masses: &Vector3<f64>, velocity: &Vector3<f64>, friction: f64) -> [f64; 2] {
        let Self {
            normal, tangent, ..
        } = self;
        let lack = self.least - normal.dot(velocity);
        if lack <= 0.0 {
            return [0.0; 2];
        }
        let change = [normal, tangent].map(|row| row.component_div(masses));
        let nn = normal.dot(&change[0]);
        let nt = normal.dot(&change[1]);
        let tt = tangent.dot(&change[1]);
        let slip = tangent.dot(velocity);
        let whole = nn * tt - nt * nt;
        let (push, rub) = (
            (tt * lack + nt * slip) / whole,
            -(nt * lack + nn * slip) / whole,
        );
        if rub.abs() <= friction * push {
            return [push, rub];
        }
        // It slides: the impulse lies on the side of the friction cone opposite to the sliding.
        let share = friction.copysign(rub);
        let push = lack / (nn + share * nt);
        [push, share * push]
    }
}

/// A step of the leapfrog method.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stride {
    /// The acceleration (m/s^2, m/s^2, rad/s^2).
    pub acceleration: Vector3<f64>,
    /// The duration of the previous step (s), and of this one.
    pub before: f64,
    pub h: f64,
}

impl Stride {
    /// The change of the velocity from the middle of the previous step to the middle of this one.
    pub fn push(&self) -> Vector3<f64> {
        self.acceleration * (0.5 * (self.before + self.h))
    }

    /// The velocity at the step's start, from that in the middle of the previous step.
    fn at_start(&self, velocity: &Vector3<f64>) -> Vector3<f64> {
        velocity + self.acceleration * (0.5 * self.before)
    }

    /// The velocity at the step's end, from that in its middle.
    fn at_end(&self, velocity: &Vector3<f64>) -> Vector3<f64> {
        velocity + self.acceleration * (0.5 * self.h)
    }
}

/// One step from a phase, with impulses at contact points.
pub(super) fn step(
    body: &Body,
    (settings, scale): (&MotionSettings, Scale),
    phase: &Phase,
    stride: &Stride,
    points: &[ContactPoint],
) -> Phase {
    let masses = body.masses();
    let h = stride.h;
    let free = phase.velocity + stride.push();
    let hold = |point: &ContactPoint| Hold {
        least: (-point.gap / h).min(scale.length(PUSHED_OUT) / h),
        ..Hold::new(point, phase.place.xy())
    };
    let mut holds: Vec<Hold> = points.iter().map(hold).collect();
    let way = held(&masses, &free, &holds, settings.friction);
    holds.retain_mut(|hold| {
        let touched = hold.gap + hold.normal.dot(&way) * h <= scale.length(TOUCHED);
        hold.least = 0.0;
        touched
    });
    let stopped = held(&masses, &free, &holds, settings.friction);
    let mut velocity = stopped;
    let approach = |hold: &Hold| -hold.normal.dot(&phase.velocity);
    if settings.restitution > 0.0 && holds.iter().any(|hold| approach(hold) > ERROR) {
        let is_elastic = settings.restitution == 1.0;
        for hold in &mut holds {
            hold.least = match is_elastic {
                true => hold.thrown_back(stride, &phase.velocity),
                false => settings.restitution * approach(hold).max(0.0),
            };
        }
        let bounced = held(&masses, &free, &holds, settings.friction) - stopped;
        velocity += bounced
            * match is_elastic {
                true => {
                    let start = body.kinetic_energy(&stride.at_start(&phase.velocity));
                    let work = masses.component_mul(&stride.acceleration).dot(&way) * h;
                    share_within(body, &stride.at_end(&stopped), &bounced, start + work)
                }
                false => share_within(body, &stopped, &bounced, body.kinetic_energy(&free)),
            };
    }
    Phase {
        place: phase.place + way * h,
        velocity,
    }
}

/// The largest share of a change, at most 1, that keeps the kinetic energy of a velocity below a
/// limit (J), given that it is below the limit without the change.
fn share_within(body: &Body, velocity: &Vector3<f64>, change: &Vector3<f64>, energy: f64) -> f64 {
    let left = (energy - body.kinetic_energy(velocity)).max(0.0);
    let square = body.kinetic_energy(change);
    let linear = body.masses().component_mul(velocity).dot(change);
    if square + linear <= left {
        return 1.0;
    }
    let root = (linear * linear + 4.0 * square * left).sqrt();
    if linear > 0.0 {
        2.0 * left / (linear + root)
    } else {
        (root - linear) / (2.0 * square)
    }
}

/// The velocity allowed by all points that is closest, by impulses, to a free velocity. Only points
/// not implied by others get impulses: one at a time, the one with the fastest approach first.
fn held(masses: &Vector3<f64>, free: &Vector3<f64>, holds: &[Hold], friction: f64) -> Vector3<f64> {
    let mut velocity = *free;
    let mut holding: Vec<(usize, [f64; 2])> = Vec::new();
    loop {
        let lack = |k: usize| holds[k].least - holds[k].normal.dot(&velocity);
        let worst = (0..holds.len()).max_by(|&a, &b| lack(a).total_cmp(&lack(b)));
        let Some(worst) = worst.filter(|&k| lack(k) > ERROR) else {
            return velocity;
        };
        if holding.iter().any(|(k, _)| *k == worst) {
            return velocity;
        }
        holding.push((worst, [0.0; 2]));
        for _ in 0..SWEEPS {
            let before = velocity;
            for (k, impulses) in &mut holding {
                let hold = &holds[*k];
                let change = |[push, rub]: [f64; 2]| {
                    (hold.normal * push + hold.tangent * rub).component_div(masses)
                };
                let without = velocity - change(*impulses);
                *impulses = hold.impulses(masses, &without, friction);
                velocity = without + change(*impulses);
            }
            let moved = velocity - before;
            let lever = (masses.z / masses.x).sqrt();
            if moved.xy().norm() + lever * moved.z.abs() < 0.1 * ERROR {
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_of_a_change_ends_at_the_energy() {
        let body = Body {
            mass: 2.0,
            inertia: 0.5,
            centre: Vector2::zeros(),
        };
        let velocity = Vector3::new(1.0, 0.0, 0.0);
        for change in [[1.0, 0.0, 0.0], [-3.0, 0.0, 0.0], [0.0, 0.0, 4.0]] {
            let change = Vector3::from(change);
            for energy in [1.0, 2.0] {
                let share = share_within(&body, &velocity, &change, energy);
                let reached = body.kinetic_energy(&(velocity + change * share));
                assert!((reached - energy).abs() < 1e-12, "{change:?} {energy}");
            }
            assert_eq!(share_within(&body, &velocity, &change, 100.0), 1.0);
        }
        // There is no kinetic energy.
        assert_eq!(share_within(&body, &Vector3::zeros(), &velocity, 0.0), 0.0);
    }

    #[test]
    fn points_that_contradict_each_other_leave_a_finite_velocity() {
        let hold = |x: f64| Hold {
            normal: Vector3::new(x, 0.0, 0.0),
            tangent: Vector3::new(0.0, x, 0.0),
            gap: 0.0,
            least: 1e-3,
        };
        let masses = Vector3::new(0.1, 0.1, 0.003);
        let free = Vector3::new(0.2, 0.1, 0.0);
        let velocity = held(&masses, &free, &[hold(1.0), hold(-1.0)], 0.3);
        assert!(velocity.norm() < 1.0, "{velocity:?}");
    }
}
