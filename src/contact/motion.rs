//! Whether a straight motion is free of overlap, from its start to its end and everywhere between.

use std::ops::Range;

use nalgebra::Vector2;

use super::tree::Circle;
use super::{Contact, Placement, TOUCH, separated};
use crate::configuration::Configuration;
use crate::tile::outline::ConvexPart;

/// Motions shorter than this (m) are as good as their ends.
const SHORTEST: f64 = 1e-7;

impl Contact {
    /// Whether the motion from `a` to `b` (straight in x, y and theta, the shorter way round) is
    /// free all along. Both ends are taken to be free.
    ///
    /// Nothing thin can be stepped over: a stretch is accepted where all convex parts
    /// [stay separated](Self::stays_separated); otherwise it is halved, and the motion refused at
    /// the first configuration that overlaps.
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
            end: End::of(*end),
            clearance: 0.0,
        });
        self.known_motion_overlaps_at_most(ends.each_ref(), allowed)
    }

    /// A configuration with what every motion from or to it asks for.
    pub fn known(&self, q: Configuration) -> Known {
        Known {
            end: End::of(q),
            clearance: self.clearance_bound(&q),
        }
    }

    /// The same between configurations that are known.
    pub fn known_motion_overlaps_at_most(&self, [a, b]: [&Known; 2], allowed: f64) -> bool {
        let step = a.end.q.step_to(&b.end.q);
        let reach = step.xy().norm() + self.moving().circumradius() * step.z.abs();
        // What is closer to an end than its clearance is free, what is a little farther overlaps by
        // that little, and a motion that brings no point farther than both together passes from the
        // one's surroundings into the other's.
        let around = [a, b].map(|known| known.clearance.max(0.0) + allowed.max(0.0));
        around[0] + around[1] >= reach
            || reach <= SHORTEST
            || self.stretches_overlap_at_most([a.end, b.end], reach, allowed)
    }

    /// Halves the motion where pairs of convex parts are not proved to stay separated, again and
    /// again, with an eye on these pairs only. All stretches of one length are looked at before any
    /// shorter one: what blocks a motion is found soon.
    fn stretches_overlap_at_most(&self, ends: [End; 2], reach: f64, allowed: f64) -> bool {
        let whole = Motion::new(&ends, allowed);
        if whole.separates((&self.fixed_hull, &self.moving_hull)) {
            return true;
        }
        let middle = whole.middle();
        let is_separated = |middle: &End, (fixed, moving): (&ConvexPart, &ConvexPart)| {
            separated(fixed, moving, &middle.placement, -allowed)
        };
        if !is_separated(&middle, (&self.fixed_core, &self.moving_core)) {
            return false;
        }
        let parts = |[i, j]: [usize; 2]| (&self.fixed.parts()[i], &self.moving.parts()[j]);
        let mut open: Vec<[usize; 2]> = Vec::new();
        let blocked = !self.near_pairs(&whole, &middle, &mut |i, j| {
            whole.separates(parts([i, j])) || {
                open.push([i, j]);
                is_separated(&middle, parts([i, j]))
            }
        });
        if blocked || open.is_empty() {
            return !blocked;
        }
        let mut reach = reach / 2.0;
        let mut level: Vec<([End; 2], Range<usize>)> = Vec::new();
        level.extend(halves(ends, middle).map(|half| (half, 0..open.len())));
        while !level.is_empty() && reach > SHORTEST {
            let mut kept = Vec::new();
            let mut finer = Vec::new();
            for (ends, pairs) in &level {
                let stretch = Motion::new(ends, allowed);
                let middle = stretch.middle();
                let first = kept.len();
                for &pair in &open[pairs.clone()] {
                    if stretch.separates(parts(pair)) {
                        continue;
                    }
                    if !is_separated(&middle, parts(pair)) {
                        return false;
                    }
                    kept.push(pair);
                }
                let pairs = first..kept.len();
                if !pairs.is_empty() {
                    finer.extend(halves(*ends, middle).map(|half| (half, pairs.clone())));
                }
            }
            (open, level) = (kept, finer);
            reach /= 2.0;
        }
        true
    }

    /// Whether every pair of convex parts is proved to stay separated by the line of one of their
    /// edges all along the motion from `a` to `b` (straight in x, y and theta, the shorter way
    /// round), with overlaps up to `allowed` (m) let pass. A negative `allowed` asks for room.
    ///
    /// A point's distance from the line is a smooth function of the time t from 0 to 1; it stays
    /// above the smaller of its two end values less an eighth of the largest magnitude of its
    /// second derivative. With s the path of the reference point and w the turn, that is
    /// `w^2 |v|` for a vertex v of the moving part and a line of the fixed one, and
    /// `w^2 |p - x| + 2 w s` for a vertex x of the fixed part, p the reference point, and a line
    /// of the moving one.
    pub fn stays_separated(&self, a: &Configuration, b: &Configuration, allowed: f64) -> bool {
        let ends = [*a, *b].map(End::of);
        let motion = Motion::new(&ends, allowed);
        motion.separates((&self.fixed_hull, &self.moving_hull))
            || self.near_pairs(&motion, &motion.middle(), &mut |i, j| {
                motion.separates((&self.fixed.parts()[i], &self.moving.parts()[j]))
            })
    }

    /// Calls `found` for the pairs of convex parts that may meet in a motion, until it returns
    /// false; returns whether it never did.
    fn near_pairs(
        &self,
        motion: &Motion,
        middle: &End,
        found: &mut impl FnMut(usize, usize) -> bool,
    ) -> bool {
        // From half way no point gets farther than half the motion takes it.
        let Placement { rotation, position } = middle.placement;
        let lever = |(centre, radius): &Circle| centre.norm() + radius;
        let room = (-motion.allowed).max(0.0);
        self.fixed_tree.near_pairs(
            &self.moving_tree,
            &|p| position + rotation * p,
            &|circle| (motion.path + motion.turn * lever(circle)) / 2.0 + room,
            found,
        )
    }
}

/// A configuration and where it places the moving tile.
#[derive(Clone, Copy, Debug)]
struct End {
    q: Configuration,
    placement: Placement,
}

impl End {
    fn of(q: Configuration) -> Self {
        Self {
            placement: Placement::of(&q),
            q,
        }
    }
}

/// A configuration, where it places the moving tile, and how far (m) that is from the other at least.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    end: End,
    clearance: f64,
}

/// The ends of the two halves of a motion.
fn halves([a, b]: [End; 2], middle: End) -> [[End; 2]; 2] {
    [[a, middle], [middle, b]]
}

/// A motion or a part of one, and what of it counts for proofs of separation.
struct Motion<'a> {
    ends: &'a [End; 2],
    /// Length of the reference point's way (m).
    path: f64,
    /// Magnitude of the turn (rad).
    turn: f64,
    /// Depth of overlap (m) let pass.
    allowed: f64,
}

impl<'a> Motion<'a> {
    fn new(ends: &'a [End; 2], allowed: f64) -> Self {
        let [a, b] = ends;
        let step = a.q.step_to(&b.q);
        Self {
            path: step.xy().norm(),
            turn: step.z.abs(),
            allowed,
            ends,
        }
    }

    /// Half way.
    fn middle(&self) -> End {
        let [a, b] = self.ends;
        End::of(a.q.interpolate(&b.q, 0.5))
    }

    /// Whether the line of one edge keeps a fixed part and a moving one, given in its own frame,
    /// apart throughout.
    fn separates(&self, (fixed, moving): (&ConvexPart, &ConvexPart)) -> bool {
        let places = self.ends.each_ref().map(|end| &end.placement);
        let [(inside_moving, moving_radius), (inside_fixed, fixed_radius)] =
            [moving.disc, fixed.disc];
        let inside_moving = places.map(|at| at.position + at.rotation * inside_moving);
        let inside_fixed = places.map(|at| at.direction(&(inside_fixed - at.position)));
        fixed
            .edges_off(inside_moving, moving_radius, -self.allowed)
            .any(|(point, normal)| self.stays_outside_fixed(point, normal, moving))
            || moving
                .edges_off(inside_fixed, fixed_radius, -self.allowed)
                .any(|(point, normal)| self.stays_outside_moving(point, normal, fixed))
    }

    /// Whether a moving part stays beyond the line of a fixed edge.
    fn stays_outside_fixed(
        &self,
        point: &Vector2<f64>,
        normal: &Vector2<f64>,
        moving: &ConvexPart,
    ) -> bool {
        let turn = self.turn * self.turn;
        let normals = [0, 1].map(|k| self.ends[k].placement.direction(normal));
        let levels =
            [0, 1].map(|k| normal.dot(&(self.ends[k].placement.position - point)) + self.allowed);
        moving.points.iter().all(|v| {
            let gap = |k: usize| normals[k].dot(v) + levels[k];
            let least = gap(0).min(gap(1));
            // 8 least >= turn^2 |v|, without the root.
            least >= 0.0 && 64.0 * least * least >= turn * turn * v.norm_squared()
        })
    }

    /// Whether a fixed part stays beyond the line of a moving edge.
    fn stays_outside_moving(
        &self,
        point: &Vector2<f64>,
        normal: &Vector2<f64>,
        fixed: &ConvexPart,
    ) -> bool {
        let turn = self.turn * self.turn;
        let both = 2.0 * self.turn * self.path;
        let normals = [0, 1].map(|k| self.ends[k].placement.rotation * normal);
        let level = normal.dot(point) - self.allowed;
        let levels = [0, 1].map(|k| -normals[k].dot(&self.ends[k].placement.position) - level);
        fixed.points.iter().all(|x| {
            let gap = |k: usize| normals[k].dot(x) + levels[k];
            let rest = 8.0 * gap(0).min(gap(1)) - both;
            if rest < 0.0 {
                return false;
            }
            let lever = |k: usize| (x - self.ends[k].placement.position).norm_squared();
            rest * rest >= turn * turn * lever(0).max(lever(1))
        })
    }
}
