//! Rigorous bounds of the energy of a pair of blocks and of its derivatives, by distance.
//!
//! # Apart
//! A uniformly magnetised block is a uniform distribution of point dipoles over its volume. If the
//! blocks are at least the distance d apart, so is each pair of dipoles. The energy of two dipoles
//! is a second directional derivative of `K / r`, `K = mu0 m1 m2 / (4 pi)`, and the n-th
//! directional derivatives of `1 / r` are at most `n! / r^(n+1)` in magnitude. So the n-th
//! derivative of U along a shift of one block is at most
//!
//! ```text
//! (n + 2)! K / d^(n+3)                                            (J/m^n)
//! ```
//!
//! # In contact
//! These grow without limit as d tends to 0. The bounds of the pole faces do not, or much more
//! slowly. With k the product of the charge densities times `mu0 / (4 pi)`:
//!
//! * **Energy.** The Coulomb kernel is positive definite, so `|U|^2 <= U11 U22` with Uii the
//!   energy of block i's charges with a copy of themselves (Cauchy and Schwarz).
//! * **Gradient.** The normal field of a uniform sheet of charge is at most 2 pi per unit of
//!   density (half a full solid angle). Its field along itself is the difference of the potentials
//!   of its two upright edges; integrated over a face of width w and height c', an edge of height c
//!   gives at most `T = 4 c' [w/2 asinh(c / w) + c/2 asinh(w / c)]`, the value for an edge in the
//!   middle of that face. So, for any directions in which the points of that face move, each pair
//!   of faces gives at most `k (2 pi w c' + 2 T)` per metre of the farthest.
//! * **Second derivatives.** Differentiating along a face turns its charge into charges on its
//!   upright edges, and differentiating along the vertical into charges on its level edges; the
//!   derivative along the normal follows from the Laplace equation. The field of a line of charge
//!   is at most 2 / a at the distance a. Hence, if the points of the other face move at a speed of
//!   at most v, `|V^T H V| <= v^2 (sum of 2 / a over the four edges)`, which integrated over that
//!   face, at least D away, is at most `8 [c' asinh(w / (2 D)) + w asinh(c' / (2 D))]`.
//!   An acceleration of at most b adds b times the bound of the gradient.
//!
//! The second derivative is infinite (logarithmically) where edges of pole faces meet.

use nalgebra::Vector2;

use super::block::{Block, BlockPair};
use super::panel::exact;
use crate::potential::motion;
use crate::units::MU0_OVER_4PI;

/// Room for the quadrature's and rounding errors in the energies of blocks with themselves.
const ROOM: f64 = 1.0 + 1e-4;

/// A pair of blocks by their strength and sizes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockLimits {
    /// `mu0 m1 m2 / (4 pi)` (J m^3), positive.
    dipole: f64,
    /// `mu0 / (4 pi)` times the product of the charge densities (J/m^3), positive.
    strength: f64,
    /// Width and height of the second block's pole faces (m).
    face: [f64; 2],
    /// Greatest energy (J) and gradient (J/m) of all.
    energy: f64,
    gradient: f64,
}

impl BlockLimits {
    /// For blocks of these moments and sizes, at any places.
    pub fn new(first: &Block, second: &Block) -> Self {
        let at_origin = |block: &Block| Block::new(block.moment.abs(), block.size);
        let (a, b) = (at_origin(first), at_origin(second));
        let pair = BlockPair::new(&a, &b, Vector2::zeros());
        let own = |block: &Block| exact(block, block).energy;
        let [width, height] = [b.size[1], b.size[2]];
        let edge = a.size[2];
        let tangential = 4.0
            * height
            * (width / 2.0 * libm::asinh(edge / width) + edge / 2.0 * libm::asinh(width / edge));
        let normal = std::f64::consts::TAU * width * height;
        Self {
            dipole: MU0_OVER_4PI * a.moment * b.moment,
            strength: pair.strength,
            face: [width, height],
            energy: (own(&a) * own(&b)).sqrt() * ROOM,
            gradient: 4.0 * pair.strength * (normal + 2.0 * tangential),
        }
    }

    /// Bound of |U| (J) if the blocks are at least `distance` (m) apart.
    pub fn energy(&self, distance: f64) -> f64 {
        self.energy.min(self.derivative(0, distance))
    }

    /// Bound of the derivative of U (J/m) along a motion in which no point of the second block is
    /// faster than 1, and it turns at most at the rate `turn` (1/m), if the blocks are at least
    /// `distance` (m) apart. With `turn` 0 it is a bound of the force (N).
    pub fn gradient(&self, turn: f64, distance: f64) -> f64 {
        let apart = self.derivative(1, distance) + turn * self.derivative(0, distance);
        self.gradient.min(apart)
    }

    /// Bound of the n-th derivative of U (J/m^n) along a shift of one block, if the blocks are at
    /// least `distance` (m) apart: `(n + 2)! K / d^(n+3)`.
    pub fn derivative(&self, n: i32, distance: f64) -> f64 {
        if distance <= 0.0 {
            return f64::INFINITY;
        }
        let factorial: f64 = (1..=n + 2).map(f64::from).product();
        factorial * self.dipole / distance.powi(n + 3)
    }

    /// Bound of the second derivative of U (J/m^2) along a motion in which no point of the second
    /// block is faster than 1, and it turns at most at the rate `turn` (1/m), if the blocks are at
    /// least `distance` (m) apart, as [`motion`] derives it for dipoles.
    pub fn curvature(&self, turn: f64, distance: f64) -> f64 {
        motion::bound(&motion::second_derivative(turn), self.dipole, distance)
    }

    /// The same by the pole faces, given the smallest distance of each pair of them (m).
    pub fn curvature_of_faces(&self, turn: f64, distances: [f64; 4]) -> f64 {
        let [width, height] = self.face;
        let share = |distance: f64| {
            let (a, b) = (width / (2.0 * distance), height / (2.0 * distance));
            height * libm::asinh(a) + width * libm::asinh(b)
        };
        let edges: f64 = distances.iter().map(|distance| share(*distance)).sum();
        8.0 * self.strength * edges + turn * self.gradient
    }
}

/// The distance (m) of two pole faces in the plane, for each of the four pairs.
pub fn face_distances(first: &Block, second: &Block) -> [f64; 4] {
    let [a, b] =
        [first, second].map(|it| pole_faces(it.position, it.axis, [it.size[0], it.size[1]]));
    [
        segment_distance(a[0], b[0]),
        segment_distance(a[0], b[1]),
        segment_distance(a[1], b[0]),
        segment_distance(a[1], b[1]),
    ]
}

/// The ends of a straight line (m).
pub type Segment = [Vector2<f64>; 2];

/// The pole faces of a magnet, seen from above: by its centre, its axis, and its length and width (m).
pub fn pole_faces(
    position: Vector2<f64>,
    axis: Vector2<f64>,
    [length, width]: [f64; 2],
) -> [Segment; 2] {
    let across = Vector2::new(-axis.y, axis.x) * (width / 2.0);
    [1.0, -1.0].map(|sign| {
        let middle = position + axis * (sign * length / 2.0);
        [middle - across, middle + across]
    })
}

/// The distance (m) of two segments, 0 where they cross.
pub fn segment_distance(a: Segment, b: Segment) -> f64 {
    let (along_a, along_b) = (a[1] - a[0], b[1] - b[0]);
    let (across, back) = (b[0] - a[0], b[1] - a[0]);
    // The sides of each on which the other's ends lie.
    let ends_of_b = [along_a.perp(&across), along_a.perp(&back)];
    let ends_of_a = [-along_b.perp(&across), along_b.perp(&(a[1] - b[0]))];
    if ends_of_b[0] * ends_of_b[1] < 0.0 && ends_of_a[0] * ends_of_a[1] < 0.0 {
        return 0.0;
    }
    // Squared distance of a point to a segment that starts at `way` from it.
    let square = |way: Vector2<f64>, along: Vector2<f64>, share: f64| {
        let t = (-way.dot(&along) * share).clamp(0.0, 1.0);
        (way + along * t).norm_squared()
    };
    let (share_a, share_b) = (1.0 / along_a.norm_squared(), 1.0 / along_b.norm_squared());
    square(across, along_b, share_b)
        .min(square(b[0] - a[1], along_b, share_b))
        .min(square(-across, along_a, share_a))
        .min(square(-back, along_a, share_a))
        .sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the closest of many points; 0 where they cross.
    #[test]
    fn segments_are_as_far_apart_as_their_closest_points() {
        let segment = |a: [f64; 2], b: [f64; 2]| [a, b].map(Vector2::from);
        let level = segment([-1.0, 0.0], [1.0, 0.0]);
        for (other, distance) in [
            (segment([0.2, -0.5], [0.4, 0.7]), 0.0),
            (segment([0.2, 0.5], [0.4, 0.7]), 0.5),
            (segment([3.0, -1.0], [3.0, 2.0]), 2.0),
            (segment([1.3, 0.4], [4.0, 5.0]), 0.5),
            (segment([-0.5, -0.25], [0.5, -0.25]), 0.25),
            (segment([-4.0, -3.0], [-4.0, -4.0]), 18f64.sqrt()),
            (segment([0.0, 2.0], [0.0, 0.1]), 0.1),
        ] {
            for (a, b) in [(level, other), (other, level)] {
                for (a, b) in [(a, b), ([a[1], a[0]], b)] {
                    assert!(
                        (segment_distance(a, b) - distance).abs() < 1e-12,
                        "{other:?}"
                    );
                }
            }
        }
    }
}
