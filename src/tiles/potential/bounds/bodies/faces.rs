//! What the charged faces of two magnets say about the derivatives of their energy.
//!
//! Let V be the potential of a face P1 of charge density 1 at the points x of a face P2 that moves, all of
//! them at least D away; A1, A2 the areas, l the length of the rim of P1. Over P2, the integrals of the
//! largest n-th directional derivatives of V in the tiles' plane are at most K1, K2, K3 and K4:
//!
//! * The n-th directional derivative of `1 / r` is at most `n! / r^(n+1)`. The points of a flat face
//!   that are within R of any point, and no closer than D, cover at most the area `pi (R^2 - D^2)`. So
//!   the integral over P1 is at most that from D to `F^2 = D^2 + A1 / pi`: `2 pi ln(F / D)` and `2 pi n!
//!   (D^(1-n) - F^(1-n)) / (n - 1)`; and the same with P1 and P2 exchanged.
//! * Derivatives of V along the face are integrals along its rim, with its outward normal nu: `V_t = -
//!   int nu_t dl / r`. Across it, -V_n is the solid angle, at most `2 pi`. Second derivatives in the tiles'
//!   plane are at most `int dl / r^2`, as [`rims`](super::rims) has it, and the next ones at most `2 int dl /
//!   r^3` and `6 int dl / r^4`. The integrals over P2 as above.
//!
//! The first kind is the least far away, the second one where faces are close. If faces may meet, only K1
//! is finite. Close discs have those of [`rims`](super::rims), which need X and Y, the integral `int |nu_t| dl`
//! along the rim of P1 times those of `1 / r^2` and `2 / r^3` over P2.

use std::f64::consts::PI;

use nalgebra::Vector2;

use crate::potential::bodies::Body;
use crate::potential::cuboid::limits::{Segment, pole_faces, segment_distance};
use crate::tile::magnet::Shape;

/// A charged face of a magnet; both are alike.
#[derive(Clone, Copy, Debug)]
pub(super) struct PoleFace {
    /// Its area (m^2).
    area: f64,
    /// The length (m) of its rim, and the integral along it of `|nu_t|` for the worst direction t in the
    /// tiles' plane along the face.
    rim: f64,
    across: f64,
}

impl PoleFace {
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
        Self { area, rim, across }
    }

    /// A bound of the energy of unit charges on it and on a copy of itself (m^3), wherever that is: the
    /// potential is at most that in the middle of a disc of the same area.
    pub fn own(&self) -> f64 {
        2.0 * self.area * (PI * self.area).sqrt()
    }

    /// The limits of this face and another one at least `distance` (m) away.
    pub fn limits(&self, other: &Self, distance: f64) -> FaceLimits {
        let touching = 2.0 * PI * other.area + self.across * 2.0 * (PI * other.area).sqrt();
        if distance <= 0.0 {
            return FaceLimits {
                first: touching,
                ..FaceLimits::NONE
            };
        }
        let near = 1.0 / distance;
        let far = |area: f64| 1.0 / (distance * distance + area / PI).sqrt();
        // Of 1 / r^(n+1) over a face.
        let over = |n: i32, area: f64| match n {
            1 => PI * 2.0 * libm::log(near / far(area)),
            _ => 2.0 * PI / f64::from(n - 1) * (near.powi(n - 1) - far(area).powi(n - 1)),
        };
        let either = |n: i32| {
            let [own, others] = [self.area, other.area];
            (others * over(n, own)).min(own * over(n, others))
        };
        let [rising, steep] = [1, 2].map(|n| over(n, other.area));
        FaceLimits {
            first: touching.min(either(1)),
            second: (2.0 * either(2)).min(self.rim * rising),
            third: (6.0 * either(3)).min(self.rim * 2.0 * steep),
            fourth: (24.0 * either(4)).min(self.rim * 6.0 * over(3, other.area)),
            x: self.across * rising,
            y: self.across * 2.0 * steep,
        }
    }
}

/// K1, K2, K3 and K4 (m^2, m, 1, 1/m), X and Y (m, 1).
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceLimits {
    pub first: f64,
    pub second: f64,
    pub third: f64,
    pub fourth: f64,
    pub x: f64,
    pub y: f64,
}

impl FaceLimits {
    const NONE: Self = Self {
        first: f64::INFINITY,
        second: f64::INFINITY,
        third: f64::INFINITY,
        fourth: f64::INFINITY,
        x: f64::INFINITY,
        y: f64::INFINITY,
    };
}

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
