//! The closed-form part of two blocks' gradient, which needs no quadrature.
//!
//! Each term belongs to an edge of the first block's pole faces or, for steep faces, to an end of
//! the second one's, relative to the other face: eight of each, one per lane.

use std::f64::consts::PI;

use nalgebra::Vector2;

use super::block::{BlockPair, Faces};
use super::sheet::{angle_moments, first_moment, potential};
use crate::potential::simd::lanes::{Lanes, WIDTH};

/// Distances from a sheet below this fraction of its width count as touching.
const TOUCHING: f64 = 1e-10;

/// Edges or ends of pole faces, those of the pair of faces i being number 2i and 2i + 1.
struct Points {
    /// The centre of the second face relative to the first one's edge (m), along that face and off
    /// it; or the second face's end relative to the first one's centre.
    x: [f64; WIDTH],
    h: [f64; WIDTH],
    /// Twice the product of the charge densities (J/m^3), with the sign of the pair of poles and,
    /// for edges, of the edge's side.
    weight: [f64; WIDTH],
    /// The levers about the turning point of forces along x and h at the second face's centre (m).
    levers: [[f64; WIDTH]; 2],
    /// On which side of the first face's line the second face's ends lie.
    sides: [[f64; WIDTH]; 2],
    /// The addition to the angle's moments if the second face passes through that line.
    crossings: [[f64; WIDTH]; 2],
}

impl BlockPair {
    /// Adds the part of the gradient, by the second block's place and by its angle about the
    /// turning point, that needs no quadrature: the forces along x and, of those along h, the
    /// singular part or, for steep faces, everything minus `by_energy` times the energy.
    #[inline(always)]
    pub fn add_closed_gradient<L: Lanes>(
        &self,
        l: L,
        faces: &[Faces; 4],
        gradient: &mut [L::F; 3],
    ) {
        let edges = self.edges(faces);
        let steep = l.splat(self.by_energy());
        let [zeroth, first] = self.moments_along(l, &edges);
        let h = if self.is_steep() {
            // Phi_h follows from the derivative along the second face.
            [l.mul(steep, zeroth), l.mul(steep, first)]
        } else {
            self.singular_moments(l, &edges)
        };
        self.add_forces(l, &edges, [zeroth, first], h, gradient);
        if self.is_steep() {
            self.add_ends(l, faces, gradient);
        }
    }

    /// The edges of the first block's faces.
    #[inline(always)]
    fn edges(&self, faces: &[Faces; 4]) -> Points {
        let mut points = Points::NONE;
        let half = self.widths[0] / 2.0;
        for (i, face) in faces.iter().enumerate() {
            let sides = self.sides(face);
            for (at, sign) in [(2 * i, 1.0), (2 * i + 1, -1.0)] {
                points.put(at, self, face, sign);
                points.x[at] = face.x + sign * half;
                points.h[at] = face.h;
                points.sides[0][at] = sides[0];
                points.sides[1][at] = sides[1];
                if sides[0] != sides[1] {
                    let [zeroth, first] = self.crossing(points.x[at], face.h, sides[1]);
                    points.crossings[0][at] = zeroth;
                    points.crossings[1][at] = first;
                }
            }
        }
        points
    }

    /// Half the moments 0 and 1 of Phi_x: the second face's potential at the first one's edges and
    /// the first moment of g, minus the moment 0 times the foot.
    #[inline(always)]
    fn moments_along<L: Lanes>(&self, l: L, edges: &Points) -> [L::F; 2] {
        let half = l.splat(self.widths[1] / 2.0);
        let (x, h) = (l.load(&edges.x), l.load(&edges.h));
        let [foot, d] = self.foot(l, [x, h]);
        let s = [l.sub(foot, half), l.add(foot, half)];
        let (zeroth, _) = potential(l, s, d, self.heights);
        let dd = l.mul(d, d);
        let start = first_moment(l, l.mul_add(s[1], s[1], dd), self.heights);
        let end = first_moment(l, l.mul_add(s[0], s[0], dd), self.heights);
        [zeroth, l.mul_add(foot, zeroth, l.sub(end, start))]
    }

    /// Half the moments of the singular part of Phi_h: the angle in which the first face is seen.
    #[inline(always)]
    fn singular_moments<L: Lanes>(&self, l: L, edges: &Points) -> [L::F; 2] {
        let half = self.widths[1] / 2.0;
        let (x, h) = (l.load(&edges.x), l.load(&edges.h));
        let [foot, d] = self.foot(l, [x, h]);
        let mut zeroth = l.load(&edges.crossings[0]);
        let mut first = l.load(&edges.crossings[1]);
        for (t, sign, side) in [(-half, -1.0, &edges.sides[0]), (half, 1.0, &edges.sides[1])] {
            let u = l.sub(l.splat(t), foot);
            let s = l.add(x, l.splat(t * self.cos));
            let h = l.add(h, l.splat(t * self.sin));
            let [at0, at1] = angle_moments(l, [u, d], [s, h], l.load(side));
            zeroth = l.mul_add(at0, l.splat(sign), zeroth);
            first = l.mul_add(at1, l.splat(sign), first);
        }
        let high = l.splat(self.heights[0] - self.heights[1]);
        [
            l.mul(high, zeroth),
            l.mul(high, l.mul_add(foot, zeroth, first)),
        ]
    }

    /// The projection of an edge onto the second face's line, and that line's distance from it,
    /// with the second face's centre at (x, h) relative to the edge.
    #[inline(always)]
    pub fn foot<L: Lanes>(&self, l: L, [x, h]: [L::F; 2]) -> [L::F; 2] {
        let (cos, sin) = (l.splat(self.cos), l.splat(self.sin));
        let zero = l.splat(0.0);
        [
            l.neg_mul_add(x, cos, l.neg_mul_add(h, sin, zero)),
            l.neg_mul_add(x, sin, l.mul(h, cos)),
        ]
    }

    /// On which side of the first face's line the second face's ends lie: if one touches the line,
    /// on the side of the other; if both do, on the side of the second block's body.
    #[inline(always)]
    fn sides(&self, face: &Faces) -> [f64; 2] {
        let touching = TOUCHING * self.widths[0];
        let reach = self.widths[1] / 2.0 * self.sin;
        let (start, end) = (face.h - reach, face.h + reach);
        let or = |h: f64, other: f64| {
            if h.abs() > touching {
                h.signum()
            } else {
                other
            }
        };
        let side = or(start, or(end, face.side));
        [side, or(end, side)]
    }

    /// The correction of the moments of the angle, without their constants, if the second face
    /// crosses the first one's line to the side `side`: none past the edge; where the angle jumps
    /// from pi to -pi, or back, 2 pi times the integrals of 1 and u from there on, of which the
    /// moments at the end include all except the part of the place of crossing.
    #[inline(always)]
    fn crossing(&self, x: f64, h: f64, side: f64) -> [f64; 2] {
        let t = -h * self.inverse_sin;
        let s = x + t * self.cos;
        if s >= 0.0 {
            return [0.0; 2];
        }
        let foot = -(x * self.cos + h * self.sin);
        [-2.0 * PI * side * (t - foot), -PI * side * s * s]
    }

    /// For steep faces, adds the boundary terms of the integral of `d Phi / dt = cos Phi_x + sin
    /// Phi_h`: the first face's potential at the ends.
    #[inline(always)]
    fn add_ends<L: Lanes>(&self, l: L, faces: &[Faces; 4], gradient: &mut [L::F; 3]) {
        let half = self.widths[1] / 2.0;
        let mut ends = Points::NONE;
        for (i, face) in faces.iter().enumerate() {
            for (at, side) in [(2 * i, -1.0), (2 * i + 1, 1.0)] {
                ends.put(at, self, face, 1.0);
                ends.x[at] = face.x + side * half * self.cos;
                ends.h[at] = face.h + side * half * self.sin;
                ends.sides[0][at] = side;
            }
        }
        let zero = l.splat(0.0);
        let width = l.splat(self.widths[0] / 2.0);
        let (x, h) = (l.load(&ends.x), l.load(&ends.h));
        let s = [l.sub(x, width), l.add(x, width)];
        let (phi, _) = potential(l, s, h, self.heights);
        let phi = l.mul(phi, l.splat(self.inverse_sin));
        let moments = [
            l.mul(phi, l.load(&ends.sides[0])),
            l.mul(phi, l.splat(half)),
        ];
        self.add_forces(l, &ends, [zero, zero], moments, gradient);
    }

    /// Adds the gradient of the forces along x and along h, given their moments 0 and 1 along the
    /// second face.
    #[inline(always)]
    fn add_forces<L: Lanes>(
        &self,
        l: L,
        points: &Points,
        x: [L::F; 2],
        h: [L::F; 2],
        gradient: &mut [L::F; 3],
    ) {
        let weight = l.load(&points.weight);
        let force = [l.mul(weight, x[0]), l.mul(weight, h[0])];
        let spread = l.neg_mul_add(l.splat(self.sin), x[1], l.mul(l.splat(self.cos), h[1]));
        let [gx, gy, turn] = *gradient;
        let (ax, ay) = (l.splat(self.axis.x), l.splat(self.axis.y));
        // x runs along (-ay, ax) and h along (-ax, -ay).
        let turn = l.mul_add(weight, spread, turn);
        let turn = l.mul_add(l.load(&points.levers[0]), force[0], turn);
        *gradient = [
            l.neg_mul_add(ay, force[0], l.neg_mul_add(ax, force[1], gx)),
            l.mul_add(ax, force[0], l.neg_mul_add(ay, force[1], gy)),
            l.mul_add(l.load(&points.levers[1]), force[1], turn),
        ];
    }
}

impl Points {
    const NONE: Self = Self {
        x: [0.0; WIDTH],
        h: [0.0; WIDTH],
        weight: [0.0; WIDTH],
        levers: [[0.0; WIDTH]; 2],
        sides: [[0.0; WIDTH]; 2],
        crossings: [[0.0; WIDTH]; 2],
    };

    /// Weight and levers of a point of a pair of faces.
    #[inline(always)]
    fn put(&mut self, at: usize, pair: &BlockPair, face: &Faces, sign: f64) {
        let arm = pair.arm + face.offset;
        self.weight[at] = 2.0 * sign * face.sign * pair.strength;
        self.levers[0][at] = arm.perp(&Vector2::new(-pair.axis.y, pair.axis.x));
        self.levers[1][at] = arm.perp(&-pair.axis);
    }
}
