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

#[cfg(test)]
mod tests {
    use super::super::tests::{saw, square};
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn a_corner_clipped_between_free_ends_is_found() {
        let contact = Contact::new(&square(0.4), &square(0.4));
        // Two free configurations on either side of the fixed tile's corner.
        let a = Configuration::new(0.4001, 0.35, 0.0);
        let b = Configuration::new(0.35, 0.4001, 0.0);
        assert!(contact.is_free(&a) && contact.is_free(&b));
        assert!(!contact.motion_is_free(&a, &b));
        let sliver = Configuration::new(0.40005, 0.39995, 0.0);
        let past = Configuration::new(0.39995, 0.40005, 0.0);
        assert!(contact.motion_is_free(&sliver, &past));
        let sliver = Configuration::new(0.40005, 0.39994, 0.0);
        let past = Configuration::new(0.39994, 0.40005, 0.0);
        assert!(!contact.motion_is_free(&sliver, &past));
    }

    #[test]
    fn flush_sliding_is_free_and_cheap_to_prove() {
        let contact = Contact::new(&square(0.4), &square(0.4));
        let a = Configuration::new(0.4, -0.3, 0.0);
        let b = Configuration::new(0.4, 0.3, 0.0);
        assert!(contact.stays_separated(&a, &b, TOUCH));
        assert!(contact.motion_is_free(&a, &b));
    }

    #[test]
    fn verdicts_agree_with_fine_sampling() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let contact = Contact::new(&saw(false), &saw(true));
        let mut counts = [0, 0];
        for _ in 0..400 {
            let mut near = || {
                Configuration::new(
                    rng.random_range(0.39..0.46),
                    rng.random_range(-0.1..0.1),
                    rng.random_range(-0.15..0.15),
                )
            };
            let (a, b) = (near(), near());
            if !contact.is_free(&a) || !contact.is_free(&b) {
                continue;
            }
            let sampled =
                (0..=2000).all(|i| contact.is_free(&a.interpolate(&b, i as f64 / 2000.0)));
            let verdict = contact.motion_is_free(&a, &b);
            // Sampling can miss a graze; a free verdict it must never contradict.
            assert!(!verdict || sampled);
            counts[usize::from(verdict)] += 1;
            if sampled != verdict {
                let least = (0..=20000)
                    .map(|i| contact.clearance(&a.interpolate(&b, i as f64 / 20000.0)))
                    .fold(f64::INFINITY, f64::min);
                assert!(least < 1e-6, "refused a motion with clearance {least}");
            }
        }
        assert!(counts[0] > 20 && counts[1] > 20, "{counts:?}");
    }

    #[test]
    fn a_proved_motion_is_free_wherever_it_is_looked_at() {
        let mut rng = ChaCha8Rng::seed_from_u64(9);
        for (a, b) in [(square(0.4), square(0.4)), (saw(false), saw(true))] {
            let contact = Contact::new(&a, &b);
            let mut counts = [0, 0];
            for _ in 0..4000 {
                let mut near = |size: f64| {
                    Configuration::new(
                        rng.random_range(0.39..0.39 + size),
                        rng.random_range(-0.1..0.1),
                        rng.random_range(-0.15..0.15),
                    )
                };
                let p = near(0.08);
                let q = p.interpolate(&near(0.08), 0.2);
                let proved = contact.stays_separated(&p, &q, 0.0);
                counts[usize::from(proved)] += 1;
                let free = (0..=50).all(|k| contact.is_free(&p.interpolate(&q, k as f64 / 50.0)));
                assert!(free || !proved, "{p:?} {q:?}");
            }
            assert!(counts[0] > 500 && counts[1] > 500, "{counts:?}");
        }
    }

    #[test]
    fn flush_sliding_is_proved_with_touch_and_refused_where_room_is_asked_for() {
        let contact = Contact::new(&square(0.4), &square(0.4));
        let at = |x: f64, y: f64| Configuration::new(x, y, 0.0);
        assert!(contact.stays_separated(&at(0.4, -0.3), &at(0.4, 0.3), TOUCH));
        assert!(!contact.stays_separated(&at(0.4, -0.3), &at(0.4, 0.3), -1e-12));
        assert!(contact.stays_separated(&at(0.401, -0.3), &at(0.401, 0.3), -0.0009));
        assert!(!contact.stays_separated(&at(0.401, -0.3), &at(0.401, 0.3), -0.0011));
    }
}
