//! The exact intervals of a straight translation in which the tiles do not overlap.

use nalgebra::Vector2;

use super::{Contact, Placement, support};
use crate::configuration::Configuration;
use crate::order::Order;
use crate::tile::outline::ConvexPart;

/// A translation along a line.
struct Shift {
    /// A unit vector.
    direction: Vector2<f64>,
    /// Its length (m).
    length: f64,
    /// Overlaps that count as touching (m).
    touch: f64,
}

impl Contact {
    /// The intervals of t from 0 to `length` (m), in ascending order, in which `q` moved by t along
    /// the unit vector `direction` is free in the sense of [`Contact::is_free`].
    ///
    /// Two convex polygons overlap deeper than [`Contact::touch`] if the normals of all their edges
    /// separate them by less than minus that (separating axis theorem). The separation along a
    /// normal is linear in t, so every two parts overlap in one interval of t: neither thin parts
    /// nor narrow spaces are missed.
    pub fn free_stretches(
        &self,
        q: &Configuration,
        direction: Vector2<f64>,
        length: f64,
    ) -> Vec<[f64; 2]> {
        let at = Placement::of(q);
        let shift = Shift {
            direction,
            length,
            touch: self.touch(),
        };
        let mut part = ConvexPart::default();
        part.place(&self.moving.hull, &at.rotation, &at.position);
        if shift.overlap(&self.fixed.hull, &part).is_none() {
            return vec![[0.0, length]];
        }
        part.place(&self.moving.core, &at.rotation, &at.position);
        let mut blocked = Vec::from_iter(shift.overlap(&self.fixed.core, &part));
        if blocked == [[0.0, length]] {
            return Vec::new();
        }
        let middle = at.position + direction * (length / 2.0);
        let mut placed = None;
        self.fixed.parts.near_pairs(
            &self.moving.parts,
            &|p| middle + at.rotation * p,
            &|_| length / 2.0,
            &mut |i, j| {
                if placed.replace(j) != Some(j) {
                    part.place(&self.moving().parts()[j], &at.rotation, &at.position);
                }
                blocked.extend(shift.overlap(&self.fixed().parts()[i], &part));
                true
            },
        );
        shift.without(blocked)
    }
}

impl Shift {
    /// The interval of t in which a placed part that is shifted overlaps with one that is not, deeper
    /// than what counts as touching.
    fn overlap(&self, fixed: &ConvexPart, moving: &ConvexPart) -> Option<[f64; 2]> {
        let mut within = [0.0, self.length];
        // Where `level + slope t < -touch`.
        let mut narrow = |level: f64, slope: f64| {
            let room = -self.touch - level;
            if slope > 0.0 {
                within[1] = within[1].min(room / slope);
            } else if slope < 0.0 {
                within[0] = within[0].max(room / slope);
            } else if room <= 0.0 {
                within[1] = within[0];
            }
            within[0] < within[1]
        };
        let by_fixed = |(point, normal): (&Vector2<f64>, &Vector2<f64>)| {
            let level = support(moving, normal) - normal.dot(point);
            narrow(level, normal.dot(&self.direction))
        };
        let overlaps = fixed.edges().all(by_fixed);
        let by_moving = |(point, normal): (&Vector2<f64>, &Vector2<f64>)| {
            let level = support(fixed, normal) - normal.dot(point);
            narrow(level, -normal.dot(&self.direction))
        };
        (overlaps && moving.edges().all(by_moving)).then_some(within)
    }

    /// The remainder of the line without some intervals, in ascending order.
    fn without(&self, mut blocked: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
        blocked.order_by(|a, b| a[0].total_cmp(&b[0]));
        let mut left = Vec::new();
        let mut since = 0.0;
        for [from, to] in blocked.into_iter().chain([[self.length; 2]]) {
            if from > since {
                left.push([since, from]);
            }
            since = since.max(to);
        }
        left
    }
}
