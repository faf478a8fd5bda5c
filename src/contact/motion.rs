//! Whether a straight motion is free of overlap, from its start to its end and everywhere between.

use super::{Contact, TOUCH, support};
use crate::configuration::Configuration;
use crate::tile::outline::ConvexPart;

/// Motions shorter than this (m) are as good as their ends.
const SHORTEST: f64 = 1e-7;

impl Contact {
    /// Whether the motion from `a` to `b` (straight in x, y and theta, the shorter way round) is
    /// free all along. Both ends are taken to be free.
    ///
    /// Nothing thin can be stepped over. A stretch is accepted only with a separating axis for
    /// every pair of convex parts that holds at both ends and, by the bound of the axis'
    /// second derivative, everywhere between; otherwise it is halved, and the motion refused at
    /// the first configuration that overlaps.
    ///
    /// With `v` the speed of the reference point, `w` the turning rate, and `D` the distance of the
    /// farthest point from the reference point, a point's coordinate along an axis of the fixed
    /// tile has a second derivative of at most `w^2 D`, and along an axis that turns with the
    /// moving tile of at most `w^2 D' + 2 w v`; over a stretch of duration 1 a coordinate then
    /// stays above the smaller of its two end values less an eighth of that.
    pub fn motion_is_free(&self, a: &Configuration, b: &Configuration) -> bool {
        let step = a.step_to(b);
        let reach = step.xy().norm() + self.moving().circumradius() * step.z.abs();
        if self.clearance_bound(a) >= reach || self.clearance_bound(b) >= reach {
            return true;
        }
        self.stretch_is_free(a, b, reach)
    }

    fn stretch_is_free(&self, a: &Configuration, b: &Configuration, reach: f64) -> bool {
        if reach <= SHORTEST || self.separated_throughout(a, b) {
            return true;
        }
        let middle = a.interpolate(b, 0.5);
        self.is_free(&middle)
            && self.stretch_is_free(a, &middle, reach / 2.0)
            && self.stretch_is_free(&middle, b, reach / 2.0)
    }

    fn separated_throughout(&self, a: &Configuration, b: &Configuration) -> bool {
        let step = a.step_to(b);
        let (travel, turn) = (step.xy().norm(), step.z.abs());
        let farthest = a.position().norm().max(b.position().norm()) + self.fixed().circumradius();
        let sag = Sag {
            fixed_axis: turn * turn * self.moving().circumradius() / 8.0,
            moving_axis: (turn * turn * farthest + 2.0 * turn * travel) / 8.0,
        };
        let hulls = (self.moving_hull.placed(a), self.moving_hull.placed(b));
        if sag.separates(&self.fixed_hull, &hulls.0, &hulls.1) {
            return true;
        }
        self.moving().parts().iter().all(|part| {
            // x and y are axes of the fixed tile like any other: boxes apart settle most pairs.
            let bounds = part
                .placed_bounds(a)
                .union(&part.placed_bounds(b))
                .grown(sag.fixed_axis);
            let mut placed = None;
            self.fixed()
                .parts()
                .iter()
                .zip(&self.fixed_bounds)
                .filter(|(_, other_bounds)| !bounds.apart(other_bounds))
                .all(|(other, _)| {
                    let (start, end) =
                        placed.get_or_insert_with(|| (part.placed(a), part.placed(b)));
                    sag.separates(other, start, end)
                })
        })
    }
}

/// How far (m) a coordinate along an axis can fall below the smaller of its end values.
struct Sag {
    fixed_axis: f64,
    moving_axis: f64,
}

impl Sag {
    /// Whether one edge normal keeps `fixed` and the moving part, given at both ends of a motion,
    /// apart throughout.
    fn separates(&self, fixed: &ConvexPart, start: &ConvexPart, end: &ConvexPart) -> bool {
        let by_fixed = fixed
            .points
            .iter()
            .zip(&fixed.normals)
            .any(|(point, normal)| {
                let level = normal.dot(point) + self.fixed_axis - TOUCH;
                support(start, normal) >= level && support(end, normal) >= level
            });
        by_fixed
            || (0..start.points.len()).any(|k| {
                let apart = |part: &ConvexPart| {
                    let normal = &part.normals[k];
                    support(fixed, normal) >= normal.dot(&part.points[k]) + self.moving_axis - TOUCH
                };
                apart(start) && apart(end)
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
        assert!(contact.separated_throughout(&a, &b));
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
}
