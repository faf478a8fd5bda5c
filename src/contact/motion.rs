//! Whether a straight motion is free of overlap, from its start to its end and everywhere between.

use super::{Contact, Placement, TOUCH};
use crate::configuration::Configuration;
use crate::tile::outline::ConvexPart;

/// Motions shorter than this (m) are as good as their ends.
const SHORTEST: f64 = 1e-7;

impl Contact {
    /// Whether the motion from `a` to `b` (straight in x, y and theta, the shorter way round) is
    /// free all along. Both ends are taken to be free.
    ///
    /// Nothing thin can be stepped over: a stretch is accepted where it
    /// [stays separated](Self::stays_separated); otherwise it is halved, and the motion refused at
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
        let clearances = [a, b].map(|end| self.clearance_bound(end));
        self.known_motion_overlaps_at_most([a, b], clearances, allowed)
    }

    /// The same for ends whose clearances are known to be at least `clearances` (m).
    pub fn known_motion_overlaps_at_most(
        &self,
        [a, b]: [&Configuration; 2],
        clearances: [f64; 2],
        allowed: f64,
    ) -> bool {
        let step = a.step_to(b);
        let reach = step.xy().norm() + self.moving().circumradius() * step.z.abs();
        // What is closer to an end than its clearance is free, and a motion that brings no point
        // farther than their sum passes from the one's surroundings into the other's.
        clearances[0].max(0.0) + clearances[1].max(0.0) >= reach
            || self.stretch_overlaps_at_most(a, b, reach, allowed)
    }

    fn stretch_overlaps_at_most(
        &self,
        a: &Configuration,
        b: &Configuration,
        reach: f64,
        allowed: f64,
    ) -> bool {
        if reach <= SHORTEST || self.stays_separated(a, b, allowed) {
            return true;
        }
        let middle = a.interpolate(b, 0.5);
        self.overlaps_at_most(&middle, allowed)
            && self.stretch_overlaps_at_most(a, &middle, reach / 2.0, allowed)
            && self.stretch_overlaps_at_most(&middle, b, reach / 2.0, allowed)
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
        let step = a.step_to(b);
        let motion = Motion {
            ends: [Placement::of(a), Placement::of(b)],
            path: step.xy().norm(),
            turn: step.z.abs(),
            allowed,
        };
        if motion.separates(&self.fixed_hull, &self.moving_hull) {
            return true;
        }
        let reach = motion.path + motion.turn * self.moving.circumradius() - allowed.min(0.0);
        let (rotation, position) = (a.rotation(), a.position());
        self.fixed_tree.near_pairs(
            &self.moving_tree,
            &|p| position + rotation * p,
            reach,
            &mut |i, j| motion.separates(&self.fixed.parts()[i], &self.moving.parts()[j]),
        )
    }
}

/// What of a motion counts for proofs of separation.
struct Motion {
    /// The moving tile at both ends.
    ends: [Placement; 2],
    /// Length of the reference point's way (m).
    path: f64,
    /// Magnitude of the turn (rad).
    turn: f64,
    /// Depth of overlap (m) let pass.
    allowed: f64,
}

impl Motion {
    /// Whether the line of one edge keeps a fixed part and a moving one, given in its own frame,
    /// apart throughout.
    fn separates(&self, fixed: &ConvexPart, moving: &ConvexPart) -> bool {
        let turn_squared = self.turn * self.turn;
        let by_fixed = fixed
            .points
            .iter()
            .zip(&fixed.normals)
            .any(|(point, normal)| {
                let normals = [0, 1].map(|k| self.ends[k].direction(normal));
                let levels = [0, 1].map(|k| normal.dot(&(self.ends[k].position - point)));
                moving.points.iter().all(|v| {
                    let gap = |k: usize| normals[k].dot(v) + levels[k];
                    let least = gap(0).min(gap(1)) + self.allowed;
                    least >= 0.0 && least >= turn_squared * v.norm() / 8.0
                })
            });
        by_fixed
            || moving
                .points
                .iter()
                .zip(&moving.normals)
                .any(|(point, normal)| {
                    let level = normal.dot(point);
                    fixed.points.iter().all(|x| {
                        let seen = [0, 1].map(|k| self.ends[k].point(x));
                        let gap = |k: usize| normal.dot(&seen[k]) - level;
                        let least = gap(0).min(gap(1)) + self.allowed;
                        let sag = || {
                            let lever = seen[0].norm().max(seen[1].norm());
                            (turn_squared * lever + 2.0 * self.turn * self.path) / 8.0
                        };
                        least >= 0.0 && least >= sag()
                    })
                })
    }
}
