//! Straight motions, and the proof that a motion is free of overlap at every point between its
//! ends.

use nalgebra::{Rotation2, Vector2};

use super::{Contact, Placement};
use crate::configuration::{Configuration, wrap_angle};
use crate::tile::outline::ConvexPart;

impl Contact {
    /// Whether every pair of convex parts is proved to stay separated by the line of one of their
    /// edges all along the motion from `a` to `b` (straight in x, y and theta, the shorter way
    /// round), with overlaps up to `allowed` (m) tolerated. A negative `allowed` requires
    /// clearance.
    ///
    /// A point's distance from the line is a smooth function of the time t from 0 to 1, with a
    /// bound of the magnitude of its second derivative. With s the path of the reference point and
    /// w the rotation, the bound is `w^2 |v|` for a vertex v of the moving part and a line of the
    /// fixed one, and `w^2 |p - x| + 2 w s` for a vertex x of the fixed part, p the reference
    /// point, and a line of the moving one.
    ///
    /// Here the distance is taken as the smaller of its two end values throughout, which proves
    /// less than the parabola through both: pathways that are bent where this proves nothing keep
    /// away from contact there.
    pub fn stays_separated(&self, a: &Configuration, b: &Configuration, allowed: f64) -> bool {
        let [a, b] = [a, b].map(|end| Known::of(end, 0.0));
        let ends = [a.placement, b.placement];
        let step = Step::between(&a, &b);
        let motion = MotionPart {
            even: true,
            ..MotionPart::new(&ends, &step, allowed)
        };
        motion.separates((&self.fixed.hull, &self.moving.hull))
            || self.near_pairs(&motion, &motion.middle(), &mut |i, j| {
                motion.separates(self.pair([i, j]))
            })
    }

    pub(super) fn pair(&self, [i, j]: [usize; 2]) -> (&ConvexPart, &ConvexPart) {
        (&self.fixed().parts()[i], &self.moving().parts()[j])
    }

    /// Calls `found` for the pairs of convex parts that may meet in a motion, until it returns
    /// false; returns whether it never did.
    pub(super) fn near_pairs(
        &self,
        motion: &MotionPart,
        middle: &Placement,
        found: &mut impl FnMut(usize, usize) -> bool,
    ) -> bool {
        // From half way, no point moves farther than in half the motion.
        let Step { path, turn, .. } = *motion.step;
        let room = (-motion.allowed).max(0.0);
        self.fixed.parts.near_pairs(
            &self.moving.parts,
            &middle.place(),
            &|lever| (path + turn.abs() * lever) / 2.0 + room,
            found,
        )
    }
}

/// A configuration with the placement of the moving tile, and a lower bound of its clearance (m).
#[derive(Clone, Copy, Debug)]
pub struct Known {
    pub(super) placement: Placement,
    theta: f64,
    pub(super) clearance: f64,
}

impl Known {
    pub(super) fn of(q: &Configuration, clearance: f64) -> Self {
        Self {
            placement: Placement::of(q),
            theta: q.theta,
            clearance,
        }
    }
}

/// The extent of a motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// Length of the reference point's way (m).
    path: f64,
    /// The turn (rad).
    turn: f64,
}

impl Step {
    pub fn between(a: &Known, b: &Known) -> Self {
        Self {
            path: (b.placement.position - a.placement.position).norm(),
            turn: wrap_angle(b.theta - a.theta),
        }
    }

    /// Largest path (m) of any point of the moving tile.
    pub fn reach(&self, contact: &Contact) -> f64 {
        self.path + contact.moving().circumradius() * self.turn.abs()
    }

    pub fn half(&self) -> Self {
        Self {
            path: self.path / 2.0,
            turn: self.turn / 2.0,
        }
    }
}

/// A motion or a part of one, with the data for proofs of separation.
pub(super) struct MotionPart<'a> {
    pub ends: &'a [Placement; 2],
    step: &'a Step,
    /// Tolerated depth of overlap (m).
    pub allowed: f64,
    /// Whether the smaller of the values at the ends is used for both.
    even: bool,
}

impl<'a> MotionPart<'a> {
    pub fn new(ends: &'a [Placement; 2], step: &'a Step, allowed: f64) -> Self {
        Self {
            ends,
            step,
            allowed,
            even: false,
        }
    }

    /// Half way.
    pub fn middle(&self) -> Placement {
        let [a, b] = self.ends;
        Placement {
            rotation: self.half_turned(),
            position: (a.position + b.position) / 2.0,
        }
    }

    /// The rotation half way, computed without the sum of the rotations at the ends, which is
    /// inaccurate if they are nearly opposite.
    fn half_turned(&self) -> Rotation2<f64> {
        let [a, b] = self.ends.each_ref().map(|at| &at.rotation);
        if self.step.turn.abs() > 3.0 {
            return a * Rotation2::new(self.step.turn / 2.0);
        }
        let sum = a.matrix() + b.matrix();
        Rotation2::from_matrix_unchecked(sum / sum.column(0).norm())
    }

    /// Whether the line of one edge keeps a fixed part and a moving one, given in its own frame,
    /// apart throughout.
    pub fn separates(&self, (fixed, moving): (&ConvexPart, &ConvexPart)) -> bool {
        let [a, b] = self.ends;
        let [(inside_moving, moving_radius), (inside_fixed, fixed_radius)] =
            [moving.disc, fixed.disc];
        let seen = |at: &Placement| at.position + at.rotation * inside_moving;
        let seeing = |at: &Placement| at.direction(&(inside_fixed - at.position));
        fixed
            .edges_off([seen(a), seen(b)], moving_radius, -self.allowed)
            .any(|(point, normal)| self.stays_outside_fixed(point, normal, moving))
            || moving
                .edges_off([seeing(a), seeing(b)], fixed_radius, -self.allowed)
                .any(|(point, normal)| self.stays_outside_moving(point, normal, fixed))
    }

    /// Whether a moving part stays beyond the line of a fixed edge.
    fn stays_outside_fixed(
        &self,
        point: &Vector2<f64>,
        normal: &Vector2<f64>,
        moving: &ConvexPart,
    ) -> bool {
        let [a, b] = self.ends;
        let turn = self.step.turn * self.step.turn;
        let (normal_a, normal_b) = (a.direction(normal), b.direction(normal));
        let level = |at: &Placement| normal.dot(&(at.position - point)) + self.allowed;
        let (level_a, level_b) = (level(a), level(b));
        moving.points.iter().all(|v| {
            let gaps = [normal_a.dot(v) + level_a, normal_b.dot(v) + level_b];
            self.stays_above(gaps, || turn * v.norm())
        })
    }

    /// Whether a fixed part stays beyond the line of a moving edge.
    fn stays_outside_moving(
        &self,
        point: &Vector2<f64>,
        normal: &Vector2<f64>,
        fixed: &ConvexPart,
    ) -> bool {
        let [a, b] = self.ends;
        let turn = self.step.turn * self.step.turn;
        let both = 2.0 * self.step.turn.abs() * self.step.path;
        let (normal_a, normal_b) = (a.rotation * normal, b.rotation * normal);
        let offset = normal.dot(point) - self.allowed;
        let level_a = -normal_a.dot(&a.position) - offset;
        let level_b = -normal_b.dot(&b.position) - offset;
        fixed.points.iter().all(|x| {
            let gaps = [normal_a.dot(x) + level_a, normal_b.dot(x) + level_b];
            self.stays_above(gaps, || {
                let [p, q] = [a, b].map(|at| (x - at.position).norm_squared());
                turn * p.max(q).sqrt() + both
            })
        })
    }

    fn stays_above(&self, [p, q]: [f64; 2], bend: impl Fn() -> f64) -> bool {
        if self.even {
            stays_above([p.min(q); 2], bend)
        } else {
            stays_above([p, q], bend)
        }
    }
}

/// Whether a function of the time t from 0 to 1 stays at 0 or above, given its values p and q at the
/// ends and a bound b of its second derivative.
///
/// It stays above the parabola through its ends whose second derivative is b,
/// `(1 - t) p + t q - b t (1 - t) / 2`, and that stays above 0 where `sqrt(p) + sqrt(q) >= sqrt(b / 2)`.
#[inline]
fn stays_above([p, q]: [f64; 2], bend: impl Fn() -> f64) -> bool {
    if p < 0.0 || q < 0.0 {
        return false;
    }
    let rest = bend() / 2.0 - p - q;
    rest <= 0.0 || rest * rest <= 4.0 * p * q
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of the parabolas with a second derivative within the bound, the steepest touches 0 where the
    /// bound does.
    #[test]
    fn what_stays_above_is_told_from_what_bends_below() {
        for (p, q) in [(0.0, 2.0), (0.5, 0.5), (0.1, 3.0), (2.0, 1e-6), (0.0, 0.0)] {
            let most = 2.0 * (f64::sqrt(p) + f64::sqrt(q)).powi(2);
            let lowest = |bend: f64| {
                let at = |t: f64| (1.0 - t) * p + t * q - bend * t * (1.0 - t) / 2.0;
                (0..=1000)
                    .map(|k| at(f64::from(k) / 1000.0))
                    .fold(f64::INFINITY, f64::min)
            };
            assert!(stays_above([p, q], || most * (1.0 - 1e-9)));
            assert!(lowest(most) >= -1e-12);
            assert!(!stays_above([p, q], || most * 1.02 + 1e-3));
            assert!(lowest(most * 1.02 + 1e-3) < 0.0);
        }
        assert!(!stays_above([-1e-12, 1.0], || 0.0));
        assert!(!stays_above([1.0, -1e-12], || 0.0));
    }
}
