//! The charged faces of two upright blocks: integrals over the boundaries of flat rectangles.
//!
//! With `Phi(rho) = r - z ln(z + r)`, `r^2 = rho^2 + z^2`, z the distance of the planes of two
//! rectangles, the plane Laplacian of Phi is `1 / r`, so that by the divergence theorem, applied once
//! to either rectangle,
//!
//! ```text
//! int int 1 / r dA1 dA2 = - sum over edges e of one, f of the other of (n_e . n_f) int int Phi dl1 dl2
//! ```
//!
//! with n the outward normals. The inner integral has a closed form ([`beside`]), as has the
//! potential V of a rectangle at the other one's edges, which gives the derivatives: with p relative
//! to the second one's centre, those by that centre and by its angle are `- sum n_e int V dl` and
//! `- sum int n_e . (z x p) V dl` over the edges of the first. The nodes of all edges of the first
//! are evaluated in lanes, in the second one's frame.

use nalgebra::{Complex, Vector2};

use super::Body;
use super::face::Integral;
use super::panels::panels;
use crate::potential::cuboid::sheet::{log, sqrt, subtended};
use crate::potential::simd::Level;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH, fill};

/// The shortest panel, in lengths of an edge: the integrand's singularities are weak.
const SHORTEST: f64 = 1e-5;
/// Added to squared distances, in units of the second rectangle's squared side, so that products
/// like `w^2 ln w` are 0, not NaN, at w = 0.
const TINY: f64 = 1e-26;

/// An edge: its midpoint, its direction, half its length (m), and the outward normal.
struct Edge {
    middle: Vector2<f64>,
    along: Vector2<f64>,
    half: f64,
    normal: Vector2<f64>,
}

/// The edges of a block's outline; its sides lie along x and y turned by a unit vector.
fn edges(middle: Vector2<f64>, along: Vector2<f64>, [a, b]: [f64; 2]) -> [Edge; 4] {
    let [x, y] = [along, Vector2::new(-along.y, along.x)];
    let edge = |normal: Vector2<f64>, reach: f64, along: Vector2<f64>, half: f64| Edge {
        middle: middle + normal * reach,
        along,
        half,
        normal,
    };
    [
        edge(x, a, y, b),
        edge(-x, a, y, b),
        edge(y, b, x, a),
        edge(-y, b, x, a),
    ]
}

/// The integral of `1 / r` over the two upper faces of two upright blocks minus that over an upper and a
/// lower one.
pub fn integral(first: &Body, second: &Body) -> Integral {
    let [halves, others] = [first, second].map(|body| [body.size[0] / 2.0, body.size[1] / 2.0]);
    let [one, other] = [first, second].map(|body| body.size[2] / 2.0);
    let turn = second.direction;
    let into = |v: Vector2<f64>| Vector2::new(turn.dot(&v), turn.perp(&v));
    let (middle, along) = (
        into(first.position - second.position),
        into(first.direction),
    );
    let height = (one - other).abs();
    let nodes = nodes(&edges(middle, along, halves), others, height);
    let mut sum = Level::best().run(Edges {
        nodes: &nodes,
        halves: others,
        heights: [height, one + other],
    });
    let [x, y] = [sum.gradient.x, sum.gradient.y];
    sum.gradient = Vector2::new(turn.x * x - turn.y * y, turn.y * x + turn.x * y);
    sum
}

/// Places (m) on the edges of a rectangle in the frame of the other one, and the edges' normals times
/// the weights (m); graded towards the other one's corners, and towards the intersections of the
/// edges' lines.
#[derive(Default)]
struct Nodes {
    x: Vec<f64>,
    y: Vec<f64>,
    normal_x: Vec<f64>,
    normal_y: Vec<f64>,
}

fn nodes(own: &[Edge; 4], halves: [f64; 2], height: f64) -> Nodes {
    let others = edges(Vector2::zeros(), Vector2::x(), halves);
    let mut nodes = Nodes::default();
    let mut singular = Vec::with_capacity(12);
    for edge in own {
        singular.clear();
        for other in &others {
            // The two ends of two edges are all corners.
            if other.normal.y == 0.0 {
                for end in [-other.half, other.half] {
                    let way = other.middle + other.along * end - edge.middle;
                    let aside = libm::hypot(way.dot(&edge.normal), height);
                    singular.push(Complex::new(way.dot(&edge.along), aside));
                }
            }
            let sin = edge.along.perp(&other.along);
            let way = other.middle - edge.middle;
            let (place, on_other) = (way.perp(&other.along) / sin, way.perp(&edge.along) / sin);
            if place.is_finite() && on_other.abs() < 1.5 * other.half {
                singular.push(Complex::new(place, height / sin.abs()));
            }
        }
        let ends = [-edge.half, edge.half];
        panels(
            ends,
            &singular,
            SHORTEST * edge.half,
            &mut |place, weight| {
                let point = edge.middle + edge.along * place;
                nodes.x.push(point.x);
                nodes.y.push(point.y);
                nodes.normal_x.push(edge.normal.x * weight);
                nodes.normal_y.push(edge.normal.y * weight);
            },
        );
    }
    let last = [nodes.x[0], nodes.y[0]];
    for (list, value) in [
        (&mut nodes.x, last[0]),
        (&mut nodes.y, last[1]),
        (&mut nodes.normal_x, 0.0),
        (&mut nodes.normal_y, 0.0),
    ] {
        fill(list, value);
    }
    nodes
}

/// The sum over nodes on one rectangle, with half the other one's sides (m) and the distances of the
/// faces of like and of unlike poles (m).
struct Edges<'a> {
    nodes: &'a Nodes,
    halves: [f64; 2],
    heights: [f64; 2],
}

impl Task for Edges<'_> {
    type Output = Integral;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Integral {
        let [a, b] = self.halves;
        let zero = l.splat(0.0);
        let [mut value, mut gx, mut gy, mut slope] = [zero; 4];
        for at in (0..self.nodes.x.len()).step_by(WIDTH) {
            let x = l.load(&self.nodes.x[at..]);
            let y = l.load(&self.nodes.y[at..]);
            let nx = l.load(&self.nodes.normal_x[at..]);
            let ny = l.load(&self.nodes.normal_y[at..]);
            let along_x = [l.sub(l.splat(-a), x), l.sub(l.splat(a), x)];
            let along_y = [l.sub(l.splat(-b), y), l.sub(l.splat(b), y)];
            // Beyond the edges towards x, -x, y and -y.
            let right = beside(l, along_y, l.sub(x, l.splat(a)), &self.heights, a);
            let left = beside(l, along_y, along_x[0], &self.heights, a);
            let up = beside(l, along_x, l.sub(y, l.splat(b)), &self.heights, a);
            let down = beside(l, along_x, along_y[0], &self.heights, a);
            value = l.neg_mul_add(nx, l.sub(right[0], left[0]), value);
            value = l.neg_mul_add(ny, l.sub(up[0], down[0]), value);
            let potential = l.add(l.add(right[1], left[1]), l.add(up[1], down[1]));
            gx = l.mul_add(nx, potential, gx);
            gy = l.mul_add(ny, potential, gy);
            let turned = l.neg_mul_add(nx, y, l.mul(ny, x));
            slope = l.mul_add(turned, potential, slope);
        }
        Integral {
            value: l.sum(value),
            gradient: Vector2::new(l.sum(gx), l.sum(gy)),
            slope: l.sum(slope),
        }
    }
}

/// The integral of Phi along an edge, where u runs from `u[0]` to `u[1]`, at the distance w beyond
/// its line (m^2), and the edge's part of minus the rectangle's potential (m); each at the first
/// height z minus that at the second. With
///
/// ```text
/// m^2 = w^2 + z^2,   r^2 = u^2 + m^2,   s = asinh(u / m),   t = atan(u / |w|) - atan(z u / (|w| r))
/// int Phi du = (u r + m^2 s) / 2 - z [u ln(z + r) + z s + |w| t] + z u
/// V = - sum over edges of  w s - z sign(w) t
/// ```
///
/// The term `z u`, and the unit of the logarithm, drop out of the sum over the edges of a rectangle.
#[inline(always)]
fn beside<L: Lanes>(l: L, u: [L::F; 2], w: L::F, heights: &[f64; 2], unit: f64) -> [L::F; 2] {
    let ww = l.mul_add(w, w, l.splat(TINY * unit * unit));
    let turn = subtended(l, u, w);
    let low = if heights[0] > 0.0 {
        raised(l, u, [w, ww, turn], heights[0], unit)
    } else {
        let p = distances(l, u, ww);
        let s = log(l, u, p, ww);
        let twice = l.neg_mul_add(u[0], p[0], l.mul_add(ww, s, l.mul(u[1], p[1])));
        [l.mul(twice, l.splat(0.5)), l.mul(w, s)]
    };
    let high = raised(l, u, [w, ww, turn], heights[1], unit);
    [l.sub(low[0], high[0]), l.sub(low[1], high[1])]
}

/// The same at a height above 0.
#[inline(always)]
fn raised<L: Lanes>(
    l: L,
    u: [L::F; 2],
    [w, ww, turn]: [L::F; 3],
    height: f64,
    unit: f64,
) -> [L::F; 2] {
    let (z, zz) = (l.splat(height), l.splat(height * height));
    let mm = l.add(ww, zz);
    let r = distances(l, u, mm);
    let s = log(l, u, r, mm);
    let [start, end] = [
        l.ln_ratio(l.add(z, r[0]), l.splat(unit)),
        l.ln_ratio(l.add(z, r[1]), l.splat(unit)),
    ];
    let rise = l.neg_mul_add(u[0], start, l.mul(u[1], end));
    let aside = l.abs(w);
    // The difference of two angles, by the product of (|w| r2, z u2) and (|w| r1, -z u1).
    let along = l.mul_add(l.mul(ww, r[0]), r[1], l.mul(zz, l.mul(u[0], u[1])));
    let across = l.neg_mul_add(u[0], r[1], l.mul(u[1], r[0]));
    let angle = l.angle(along, l.mul(l.mul(z, aside), across));
    let t = l.sub(turn, angle);
    let twice = l.neg_mul_add(u[0], r[0], l.mul_add(mm, s, l.mul(u[1], r[1])));
    let inner = l.mul_add(aside, t, l.mul_add(z, s, rise));
    let lift = l.mul(z, t);
    let zero = l.splat(0.0);
    [
        l.neg_mul_add(z, inner, l.mul(twice, l.splat(0.5))),
        l.mul_add(w, s, l.select(w, l.sub(zero, lift), lift)),
    ]
}

/// The distances of both ends, given the square of that of the line.
#[inline(always)]
fn distances<L: Lanes>(l: L, u: [L::F; 2], square: L::F) -> [L::F; 2] {
    [
        sqrt(l, l.mul_add(u[0], u[0], square)),
        sqrt(l, l.mul_add(u[1], u[1], square)),
    ]
}
