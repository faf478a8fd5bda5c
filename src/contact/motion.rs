//! Whether a straight motion is free of overlap, from its start to its end and everywhere between.

use nalgebra::{Rotation2, Vector2};

use super::halving::{Halves, SHORTEST};
use super::tree::Circle;
use super::{Contact, Placement, TOUCH};
use crate::configuration::{Configuration, wrap_angle};
use crate::tile::outline::ConvexPart;

impl Contact {
    /// Whether the motion from `a` to `b` (straight in x, y and theta, the shorter way round) is
    /// free all along. Both ends are taken to be free.
    ///
    /// Nothing thin can be stepped over: a stretch is accepted where the line of an edge keeps every
    /// two convex parts apart; otherwise it is halved, and the motion refused at the first
    /// configuration that overlaps.
    pub fn motion_is_free(&self, a: &Configuration, b: &Configuration) -> bool {
        self.motion_overlaps_at_most(a, b, TOUCH)
    }

    /// Whether no convex part of a tile gets deeper than `allowed` (m) into one of the other's all
    /// along the motion, which both ends are taken to fulfil.
    pub fn motion_overlaps_at_most(
        &self,
        a: &Configuration,
        b: &Configuration,
        allowed: f64,
    ) -> bool {
        // Of a single motion, clearances would cost more than they save.
        let ends = [a, b].map(|end| Known {
            end: End::of(end),
            clearance: 0.0,
        });
        self.known_motion_overlaps_at_most(ends.each_ref(), allowed, &mut Halves::default())
    }

    /// A configuration with what every motion from or to it asks for.
    pub fn known(&self, q: Configuration) -> Known {
        Known {
            end: End::of(&q),
            clearance: self.clearance_bound(&q),
        }
    }

    /// The same between configurations that are known; `left` is lent.
    pub fn known_motion_overlaps_at_most(
        &self,
        [a, b]: [&Known; 2],
        allowed: f64,
        left: &mut Halves,
    ) -> bool {
        let step = Step::between(&a.end, &b.end);
        let reach = step.reach(self);
        // What is closer to an end than its clearance is free, what is a little farther overlaps by
        // that little, and a motion that brings no point farther than both together passes from the
        // one's surroundings into the other's.
        let around = [a, b].map(|known| known.clearance.max(0.0) + allowed.max(0.0));
        around[0] + around[1] >= reach
            || reach <= SHORTEST
            || self.stretches_overlap_at_most([a.end, b.end], step, allowed, left)
    }

    /// Whether every pair of convex parts is proved to stay separated by the line of one of their
    /// edges all along the motion from `a` to `b` (straight in x, y and theta, the shorter way
    /// round), with overlaps up to `allowed` (m) let pass. A negative `allowed` asks for room.
    ///
    /// A point's distance from the line is a smooth function of the time t from 0 to 1, with a bound
    /// of the magnitude of its second derivative. With s the path of the reference point and w the
    /// turn, that is `w^2 |v|` for a vertex v of the moving part and a line of the fixed one, and
    /// `w^2 |p - x| + 2 w s` for a vertex x of the fixed part, p the reference point, and a line
    /// of the moving one.
    ///
    /// Here the distance is taken for the smaller of its two end values throughout, which proves
    /// less than the [parabola](stays_above) through both does: ways that are bent where this proves
    /// nothing keep off contact there.
    pub fn stays_separated(&self, a: &Configuration, b: &Configuration, allowed: f64) -> bool {
        let ends = [a, b].map(End::of);
        let step = Step::between(&ends[0], &ends[1]);
        let motion = Motion {
            even: true,
            ..Motion::new(&ends, &step, allowed)
        };
        motion.separates((&self.fixed_hull, &self.moving_hull))
            || self.near_pairs(&motion, &motion.middle(), &mut |i, j| {
                motion.separates(self.pair([i, j]))
            })
    }

    /// Calls `found` for the pairs of convex parts that may meet in a motion, until it returns
    /// false; returns whether it never did.
    pub(super) fn near_pairs(
        &self,
        motion: &Motion,
        middle: &End,
        found: &mut impl FnMut(usize, usize) -> bool,
    ) -> bool {
        // From half way no point gets farther than half the motion takes it.
        let Step { path, turn, .. } = *motion.step;
        let lever = |(centre, radius): &Circle| centre.norm() + radius;
        let room = (-motion.allowed).max(0.0);
        self.fixed_tree.near_pairs(
            &self.moving_tree,
            &middle.place(),
            &|circle| (path + turn.abs() * lever(circle)) / 2.0 + room,
            found,
        )
    }
}

/// A configuration: where it places the moving tile, and its angle, of any number of turns.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    pub placement: Placement,
    theta: f64,
}

impl End {
    fn of(q: &Configuration) -> Self {
        Self {
            placement: Placement::of(q),
            theta: q.theta,
        }
    }

    /// Where a point of the moving tile is.
    pub fn place(&self) -> impl Fn(Vector2<f64>) -> Vector2<f64> {
        let Placement { rotation, position } = self.placement;
        move |p| position + rotation * p
    }
}

/// A configuration, where it places the moving tile, and how far (m) that is from the other at least.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    end: End,
    clearance: f64,
}

/// How far a motion goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// Length of the reference point's way (m).
    path: f64,
    /// The turn (rad).
    turn: f64,
}

impl Step {
    fn between(a: &End, b: &End) -> Self {
        Self {
            path: (b.placement.position - a.placement.position).norm(),
            turn: wrap_angle(b.theta - a.theta),
        }
    }

    /// How far (m) any point of the moving tile goes at most.
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

/// A motion or a part of one, and what of it counts for proofs of separation.
pub(super) struct Motion<'a> {
    pub ends: &'a [End; 2],
    step: &'a Step,
    /// Depth of overlap (m) let pass.
    pub allowed: f64,
    /// Whether the smaller of the values at the ends stands for both.
    even: bool,
}

impl<'a> Motion<'a> {
    pub fn new(ends: &'a [End; 2], step: &'a Step, allowed: f64) -> Self {
        Self {
            ends,
            step,
            allowed,
            even: false,
        }
    }

    /// Half way.
    pub fn middle(&self) -> End {
        let [a, b] = self.ends;
        let theta = a.theta + self.step.turn / 2.0;
        End {
            placement: Placement {
                rotation: Rotation2::new(theta),
                position: (a.placement.position + b.placement.position) / 2.0,
            },
            theta,
        }
    }

    /// Whether the line of one edge keeps a fixed part and a moving one, given in its own frame,
    /// apart throughout.
    pub fn separates(&self, (fixed, moving): (&ConvexPart, &ConvexPart)) -> bool {
        let [a, b] = self.ends.each_ref().map(|end| &end.placement);
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
        let [a, b] = self.ends.each_ref().map(|end| &end.placement);
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
        let [a, b] = self.ends.each_ref().map(|end| &end.placement);
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
