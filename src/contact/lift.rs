//! Moving the tile along a straight line until it is clear of the other.

use nalgebra::Vector2;

use super::{Contact, TOUCH, support};
use crate::configuration::Configuration;
use crate::tile::outline::ConvexPart;

impl Contact {
    /// The smallest translation t >= 0 (m) along the unit vector `direction` that makes `q` free:
    /// 0 where it is free already.
    ///
    /// Each pair of convex parts overlaps on one open interval of t, found exactly from its
    /// separating axes; the answer is the first point outside their union.
    pub fn lift(&self, q: &Configuration, direction: Vector2<f64>) -> f64 {
        let across = Vector2::new(-direction.y, direction.x);
        let lanes: Vec<(f64, f64)> = self
            .fixed()
            .parts()
            .iter()
            .map(|part| extent(part, &across))
            .collect();
        let mut blocked: Vec<(f64, f64)> = Vec::new();
        for part in self.moving().parts() {
            let placed = part.placed(q);
            let (low, high) = extent(&placed, &across);
            for (other, lane) in self.fixed().parts().iter().zip(&lanes) {
                if low < lane.1 && lane.0 < high {
                    blocked.extend(overlap_interval(other, &placed, direction));
                }
            }
        }
        blocked.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut lifted = 0.0;
        for (start, end) in blocked {
            if start <= lifted + TOUCH && end > lifted + TOUCH {
                lifted = end;
            }
        }
        lifted
    }
}

/// Least and largest coordinate of a polygon along a direction.
fn extent(part: &ConvexPart, direction: &Vector2<f64>) -> (f64, f64) {
    (support(part, direction), -support(part, &-direction))
}

/// The open interval of translations of `moving` along `direction` at which it overlaps `fixed`.
fn overlap_interval(
    fixed: &ConvexPart,
    moving: &ConvexPart,
    direction: Vector2<f64>,
) -> Option<(f64, f64)> {
    let (mut start, mut end) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut clip = |separation: f64, rate: f64| {
        // Overlap needs separation + rate * t < 0.
        if rate.abs() < 1e-15 {
            if separation >= 0.0 {
                end = f64::NEG_INFINITY;
            }
        } else if rate > 0.0 {
            end = end.min(-separation / rate);
        } else {
            start = start.max(-separation / rate);
        }
    };
    for (point, normal) in fixed.points.iter().zip(&fixed.normals) {
        clip(
            support(moving, normal) - normal.dot(point),
            normal.dot(&direction),
        );
    }
    for (point, normal) in moving.points.iter().zip(&moving.normals) {
        clip(
            support(fixed, normal) - normal.dot(point),
            -normal.dot(&direction),
        );
    }
    (start < end - TOUCH).then_some((start, end))
}

#[cfg(test)]
mod tests {
    use super::super::tests::{saw, square};
    use super::*;

    #[test]
    fn a_lift_ends_in_contact() {
        for contact in [
            Contact::new(&square(0.4), &square(0.3)),
            Contact::new(&saw(false), &saw(true)),
        ] {
            for i in 0..200 {
                let angle = 0.1 * i as f64;
                let q = Configuration::new(0.01 * angle.cos(), 0.02, 0.37 * i as f64 % 3.0);
                let direction = Vector2::new(angle.cos(), angle.sin());
                let t = contact.lift(&q, direction);
                let at = |t: f64| {
                    Configuration::new(q.x + direction.x * t, q.y + direction.y * t, q.theta)
                };
                assert!(t > 0.0 && contact.is_free(&at(t)));
                assert!(contact.clearance(&at(t)).abs() < 1e-9);
                assert!(!contact.is_free(&at(t - 1e-5)));
            }
        }
    }
}
