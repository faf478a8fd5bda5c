//! What the charged faces of two magnets say about the derivatives of their energy.
//!
//! Let V be the potential of a face P1 of charge density 1 at the points x of a face P2 that moves, all of
//! them at least D away; A1, A2 the areas, l the length of the rim of P1. Over P2, the integrals of the
//! largest n-th directional derivatives of V in the tiles' plane are at most K1, K2 and K3:
//!
//! * The n-th directional derivative of `1 / r` is at most `n! / r^(n+1)`. The points of a flat face
//!   that are within R of any point, and no closer than D, cover at most the area `pi (R^2 - D^2)`. So
//!   the integral over P1 is at most that from D to `F^2 = D^2 + A1 / pi`: `pi ln(F^2 / D^2)`, `4 pi
//!   (1 / D - 1 / F)` and `6 pi (1 / D^2 - 1 / F^2)`; and the same with P1 and P2 exchanged.
//! * Derivatives of V along the face are integrals along its rim, with its outward normal nu: `V_t = -
//!   int nu_t dl / r`. Across it, -V_n is the solid angle, at most `2 pi`, and the slope of V_n is `int dl
//!   x r / r^3`. Second derivatives hence are at most `q = int dl / r^2` in the entry along the face,
//!   and so is the length of the row `(V_tn, V_nn)`; in any direction of the plane they are at most
//!   `(1 + sqrt 5) / 2` times q, and their slopes as many times `2 int dl / r^3`. Flat faces
//!   move along themselves: once q. The integrals over P2 as above.
//!
//! The first kind is the least far away, the second one where faces are close. If faces may meet, only K1
//! is finite.

use std::f64::consts::PI;

use nalgebra::Vector2;

use crate::potential::bodies::Body;
use crate::potential::cuboid::limits::{Segment, pole_faces, segment_distance};
use crate::tile::magnet::Shape;

/// A charged face of a magnet; both are alike.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Its area (m^2).
    area: f64,
    /// The length (m) of its rim, and the integral along it of `|nu_t|` for the worst direction t in the
    /// tiles' plane along the face.
    rim: f64,
    across: f64,
    /// The largest second derivative in units of q.
    share: f64,
}

impl Face {
    pub fn new(body: &Body) -> Self {
        let [a, b, c] = body.size;
        let [along, up] = if body.stands { [a, b] } else { [b, c] };
        let (area, rim, across) = match body.shape {
            Shape::Disc => (PI / 4.0 * along * along, PI * along, 2.0 * along),
            Shape::Block => {
                let across = match body.stands {
                    true => 2.0 * libm::hypot(along, up),
                    false => 2.0 * up,
                };
                (along * up, 2.0 * (along + up), across)
            }
        };
        Self {
            area,
            rim,
            across,
            share: if body.stands { 1.0 } else { GOLDEN },
        }
    }

    /// A bound of the energy of unit charges on it and on a copy of itself (m^3), wherever that is: the
    /// potential is at most that in the middle of a disc of the same area.
    pub fn own(&self) -> f64 {
        2.0 * self.area * (PI * self.area).sqrt()
    }

    /// K1, K2 and K3 (m^2, m, 1) of this face and another one at least `distance` (m) away.
    pub fn limits(&self, other: &Self, distance: f64) -> [f64; 3] {
        let touching = 2.0 * PI * other.area + self.across * 2.0 * (PI * other.area).sqrt();
        if distance <= 0.0 {
            return [touching, f64::INFINITY, f64::INFINITY];
        }
        let d = distance;
        let far = |area: f64| (d * d + area / PI).sqrt();
        let rising = |area: f64| PI * 2.0 * libm::log(far(area) / d);
        let second = |area: f64| 4.0 * PI * (1.0 / d - 1.0 / far(area));
        let third = |area: f64| 6.0 * PI * (1.0 / (d * d) - 1.0 / far(area).powi(2));
        let either =
            |of: &dyn Fn(f64) -> f64| (other.area * of(self.area)).min(self.area * of(other.area));
        let by_rim = self.share * self.rim;
        [
            touching.min(either(&rising)),
            either(&second).min(by_rim * rising(other.area)),
            either(&third).min(by_rim * second(other.area)),
        ]
    }
}

/// `(1 + sqrt 5) / 2`, the largest eigenvalue of a symmetric matrix of rows (1, 1) and (1, 0).
const GOLDEN: f64 = 1.618_033_988_749_895;

/// The distances (m) in the tiles' plane of the two faces of one magnet from those of the other, and
/// those of their planes, if they are flat.
pub(super) fn distances(first: &Body, second: &Body) -> [[f64; 2]; 4] {
    if first.stands {
        let aside = footprints(first, second);
        let [one, other] = [first, second].map(|body| body.size[2] / 2.0);
        let [like, unlike] = [(one - other).abs(), one + other];
        return [like, like, unlike, unlike].map(|height| [aside, height]);
    }
    let (own, others) = (segments(first), segments(second));
    [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| [segment_distance(own[i], others[j]), 0.0])
}

/// The faces of a magnet that lies, seen from above.
fn segments(body: &Body) -> [Segment; 2] {
    pole_faces(body.position, body.direction, [body.size[0], body.size[1]])
}

/// The distance (m) of two magnets that stand, seen from above.
fn footprints(first: &Body, second: &Body) -> f64 {
    let way = second.position - first.position;
    match (first.shape, second.shape) {
        (Shape::Disc, Shape::Disc) => way.norm() - (first.size[0] + second.size[0]) / 2.0,
        (Shape::Block, Shape::Disc) => outside(first, second.position) - second.size[0] / 2.0,
        (Shape::Disc, Shape::Block) => outside(second, first.position) - first.size[0] / 2.0,
        (Shape::Block, Shape::Block) => {
            let corners = [(first, second), (second, first)].map(|(of, from)| {
                let all = segments(of).into_iter().flatten();
                all.map(|p| outside(from, p)).fold(f64::INFINITY, f64::min)
            });
            let cross = sides(first).iter().any(|a| {
                sides(second)
                    .iter()
                    .any(|b| segment_distance(*a, *b) == 0.0)
            });
            match cross {
                true => 0.0,
                false => corners[0].min(corners[1]),
            }
        }
    }
    .max(0.0)
}

/// The four sides of a block, seen from above.
pub(super) fn sides(body: &Body) -> [Segment; 4] {
    let [[a, b], [d, c]] = segments(body);
    [[a, b], [b, c], [c, d], [d, a]]
}

/// The distance (m) of a point from a block, seen from above.
fn outside(block: &Body, p: Vector2<f64>) -> f64 {
    let way = p - block.position;
    let along = [block.direction.dot(&way), block.direction.perp(&way)];
    let [x, y] = [0, 1].map(|k| (along[k].abs() - block.size[k] / 2.0).max(0.0));
    libm::hypot(x, y)
}
