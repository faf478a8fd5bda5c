//! Where along a straight line, without turning, the tiles are free: exactly.

use nalgebra::Vector2;

use super::{Contact, Placement, TOUCH, support};
use crate::configuration::Configuration;
use crate::order::Order;
use crate::tile::outline::ConvexPart;

/// A translation along a line.
struct Shift {
    /// A unit vector.
    direction: Vector2<f64>,
    /// How far it goes (m).
    length: f64,
}

impl Contact {
    /// The intervals of t from 0 to `length` (m) in which `q` moved by t along the unit vector
    /// `direction` is free as [`Contact::is_free`] has it, ascending.
    ///
    /// Two convex polygons overlap deeper than [`TOUCH`] where the normals of all their edges
    /// separate them by less than -[`TOUCH`] (separating axis theorem). What a normal separates them
    /// by is linear in t, so that every two parts overlap in one interval of t: no thin part is
    /// stepped over, and no narrow room between two.
    pub(crate) fn free_stretches(
        &self,
        q: &Configuration,
        direction: Vector2<f64>,
        length: f64,
    ) -> Vec<[f64; 2]> {
        let at = Placement::of(q);
        let shift = Shift { direction, length };
        let mut part = ConvexPart::default();
        part.place(&self.moving_hull, &at.rotation, &at.position);
        if shift.overlap(&self.fixed_hull, &part).is_none() {
            return vec![[0.0, length]];
        }
        part.place(&self.moving_core, &at.rotation, &at.position);
        let mut blocked = Vec::from_iter(shift.overlap(&self.fixed_core, &part));
        if blocked == [[0.0, length]] {
            return Vec::new();
        }
        let middle = at.position + direction * (length / 2.0);
        let mut placed = None;
        self.fixed_tree.near_pairs(
            &self.moving_tree,
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
    /// than [`TOUCH`].
    fn overlap(&self, fixed: &ConvexPart, moving: &ConvexPart) -> Option<[f64; 2]> {
        let mut within = [0.0, self.length];
        // Where `level + slope t < -TOUCH`.
        let mut narrow = |level: f64, slope: f64| {
            let room = -TOUCH - level;
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

    /// What is left of the line without some intervals, ascending.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Inside of every stretch tiles are free, inside of what is left out they are not, and what the
    /// line enters and leaves within a millimetre is met too.
    #[test]
    fn stretches_are_where_tiles_are_free() {
        let mut rng = ChaCha8Rng::seed_from_u64(9);
        let mut narrow = 0;
        for design in ["sine-teeth-20mm", "dovetail", "hexagon", "drawn-wave"] {
            let design = Design::load(format!("shapes/{design}.toml").as_ref()).expect("a design");
            let problem = design.problem();
            let contact = problem.contact.as_ref().expect("tiles have outlines");
            let reach = 1.05 * (contact.fixed().circumradius() + contact.moving().circumradius());
            for _ in 0..1000 {
                let mut random = |most: f64| rng.random_range(-most..most);
                let q = Configuration::new(random(reach), random(reach), random(3.2));
                let towards = random(3.2);
                let direction = Vector2::new(libm::cos(towards), libm::sin(towards));
                let length = 0.5 * reach;
                let at = |t: f64| {
                    Configuration::new(q.x + t * direction.x, q.y + t * direction.y, q.theta)
                };
                let free = contact.free_stretches(&q, direction, length);
                let ends: Vec<f64> = free.iter().flatten().copied().collect();
                assert!(ends.is_sorted());
                for (k, gap) in [&[0.0], &ends[..], &[length]]
                    .concat()
                    .windows(2)
                    .enumerate()
                {
                    narrow += usize::from(gap[1] - gap[0] < 1e-3 && gap[1] > gap[0]);
                    for part in [0.01, 0.3, 0.5, 0.9, 0.99] {
                        let t = gap[0] + part * (gap[1] - gap[0]);
                        // Rounding is all that may differ within a hair of an end.
                        let hair = (t - gap[0]).min(gap[1] - t) < 1e-12;
                        let is_free = contact.is_free(&at(t));
                        assert!(
                            hair || is_free == (k % 2 == 1),
                            "{q:?} {towards} {t} {ends:?}"
                        );
                    }
                }
            }
        }
        assert!(narrow > 0);
    }
}
