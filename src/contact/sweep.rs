//! Proof that a straight motion is free throughout, not only at its ends.

use nalgebra::Vector2;

use super::Contact;
use super::tree::CircleTree;
use crate::configuration::Configuration;
use crate::tile::Outline;
use crate::tile::outline::ConvexPart;

/// The convex parts of two outlines, ready to be proved apart along a motion.
#[derive(Clone, Debug)]
pub(crate) struct Sweep {
    fixed: Vec<ConvexPart>,
    moving: Vec<ConvexPart>,
    fixed_tree: CircleTree,
    moving_tree: CircleTree,
    circumradius: f64,
}

impl Sweep {
    pub fn new(contact: &Contact) -> Self {
        Self {
            fixed: contact.fixed().parts().to_vec(),
            moving: contact.moving().parts().to_vec(),
            fixed_tree: tree(contact.fixed()),
            moving_tree: tree(contact.moving()),
            circumradius: contact.moving().circumradius(),
        }
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
    pub fn is_free(&self, a: &Configuration, b: &Configuration, allowed: f64) -> bool {
        let step = a.step_to(b);
        let (path, turn) = (step.xy().norm(), step.z.abs());
        let reach = path + turn * self.circumradius - allowed.min(0.0);
        let rotation = a.rotation();
        let mut placed: Option<(usize, [ConvexPart; 2])> = None;
        self.fixed_tree.near_pairs(
            &self.moving_tree,
            &|p| a.position() + rotation * p,
            reach,
            &mut |i, j| {
                if placed.as_ref().is_none_or(|(part, _)| *part != j) {
                    placed = Some((j, [self.moving[j].placed(a), self.moving[j].placed(b)]));
                }
                let Some((_, ends)) = &placed else {
                    return false;
                };
                separated(
                    &self.fixed[i],
                    ends,
                    [a.position(), b.position()],
                    path,
                    turn,
                    allowed,
                )
            },
        )
    }
}

/// The tree of an outline's convex parts.
pub(super) fn tree(outline: &Outline) -> CircleTree {
    let circles: Vec<_> = outline
        .parts()
        .iter()
        .map(|part| {
            let middle = part.points.iter().sum::<Vector2<f64>>() / part.points.len() as f64;
            let radius = part
                .points
                .iter()
                .map(|p| (p - middle).norm())
                .fold(0.0, f64::max);
            (middle, radius)
        })
        .collect();
    CircleTree::new(&circles)
}

/// Whether the line of one edge keeps a fixed part and a moving one, given at both `ends` of its
/// motion, apart throughout. `positions` are those of the moving reference point.
fn separated(
    fixed: &ConvexPart,
    ends: &[ConvexPart; 2],
    positions: [Vector2<f64>; 2],
    path: f64,
    turn: f64,
    allowed: f64,
) -> bool {
    let edges = |part: &ConvexPart| 0..part.points.len();
    let by_fixed = edges(fixed).any(|e| {
        let (n, level) = (fixed.normals[e], fixed.normals[e].dot(&fixed.points[e]));
        (0..ends[0].points.len()).all(|v| {
            let gap = |k: usize| n.dot(&ends[k].points[v]) - level;
            let sag = turn * turn * (ends[0].points[v] - positions[0]).norm() / 8.0;
            gap(0).min(gap(1)) - sag >= -allowed
        })
    });
    by_fixed
        || edges(&ends[0]).any(|e| {
            fixed.points.iter().all(|x| {
                let gap = |k: usize| ends[k].normals[e].dot(&(x - ends[k].points[e]));
                let farthest = (x - positions[0]).norm().max((x - positions[1]).norm());
                let sag = (turn * turn * farthest + 2.0 * turn * path) / 8.0;
                gap(0).min(gap(1)) - sag >= -allowed
            })
        })
}

#[cfg(test)]
mod tests {
    use super::super::TOUCH;
    use super::super::tests::{saw, square};
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn a_proved_motion_is_free_wherever_it_is_looked_at() {
        let mut rng = ChaCha8Rng::seed_from_u64(9);
        for (a, b) in [(square(0.4), square(0.4)), (saw(false), saw(true))] {
            let contact = Contact::new(&a, &b);
            let sweep = Sweep::new(&contact);
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
                let proved = sweep.is_free(&p, &q, 0.0);
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
        let sweep = Sweep::new(&contact);
        let at = |x: f64, y: f64| Configuration::new(x, y, 0.0);
        assert!(sweep.is_free(&at(0.4, -0.3), &at(0.4, 0.3), TOUCH));
        assert!(!sweep.is_free(&at(0.4, -0.3), &at(0.4, 0.3), -1e-12));
        assert!(sweep.is_free(&at(0.401, -0.3), &at(0.401, 0.3), -0.0009));
        assert!(!sweep.is_free(&at(0.401, -0.3), &at(0.401, 0.3), -0.0011));
    }
}
