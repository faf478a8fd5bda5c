//! A disc and any other face, by the other face's potential along the disc's axis at imaginary
//! heights.
//!
//! Outside, a charged disc of radius R is a line of charge along its axis at imaginary heights: the
//! integral of `1 / r` over it is, with c its centre and n its normal,
//!
//! ```text
//! V(x) = 2 int_-R^R sqrt(R^2 - t^2) / |x - c - i t n| dt,      |z| = sqrt(z.z), its real part positive
//! ```
//!
//! (on the axis both sides are `2 pi (sqrt(R^2 + h^2) - h)`, and a harmonic function that is symmetric
//! about an axis is known from its values there). So the integral over the disc and a face with the
//! potential V2 is `2 int sqrt(R^2 - t^2) V2(c + i t n) dt`.
//!
//! The square root has no branch point on the way: for two upright discs `d + i v`, `d = c2 - c1` and
//! `v = t2 n2 - t1 n1`, has `z.z` real and not positive only if v is normal to d and no shorter; v
//! turned by a right angle, `t2 tau2 - t1 tau1`, is then d or longer, and the discs, whose traces in the
//! plane run along tau1 and tau2, meet. With other faces in place of the second, too, the complex distance
//! of any of their points from the line vanishes only at the disc.
//!
//! V2 is singular where `c + i t n` meets a point of the other face's rim, at `t = l + i y`, `l - i y` and
//! their negatives, l that point's distance from the axis and y its height. In `t = R cos phi` the
//! integrand is smooth and periodic, and equal steps of phi find the integral with an error that
//! falls like `rho^(-2 n)`, rho the sum of the half axes of the ellipse about [-1, 1] through the
//! singular place. Where rho is near 1 phi is cut into panels that shrink towards that place.

use std::f64::consts::PI;

use arrayvec::ArrayVec;
use nalgebra::{Complex, Vector2, Vector3};

use super::complex::{Complexes, Z};
use super::face::{ChargedFace, Integral};
use super::panels::panels;
use crate::potential::simd::Level;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};

/// Approximate relative error of the integral.
const LOST: f64 = 1e-13;
/// The smallest and the largest number of equal steps; above the latter, panels take fewer nodes.
const STEPS: [f64; 2] = [4.0, 36.0];

/// A place of the two faces, of a sum over several.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// Their centres (m), the one that stands still first.
    pub centres: [Vector3<f64>; 2],
    /// The share of the sum.
    pub share: f64,
    /// The second face's centre from the point about which it turns (m).
    pub offset: Vector2<f64>,
}

/// The sum of the integrals of a disc and another face at several places, with the derivatives of the disc's
/// motion or the other's.
pub fn integral(
    disc: &ChargedFace,
    radius: f64,
    other: &ChargedFace,
    disc_moves: bool,
    all: &[Placed],
) -> Integral {
    let mut nodes = Vec::with_capacity(USUAL);
    for &Placed {
        centres: [first, second],
        share,
        offset,
    } in all
    {
        let [own, others] = match disc_moves {
            true => [second, first],
            false => [first, second],
        };
        let at = |face: &ChargedFace, centre| ChargedFace { centre, ..*face };
        let from = own - others;
        let lever = if disc_moves { offset } else { -offset };
        angles(
            LOST,
            &at(disc, own),
            radius,
            &at(other, others),
            |phi, weight| {
                let ([x, y, z], [right, up]) = (from.into(), lever.into());
                nodes.push([phi, share * weight, x, y, z, right, up]);
            },
        );
    }
    Level::best().run(Line {
        axis: disc.frame[2],
        radius,
        other,
        disc_moves,
        nodes: &nodes,
    })
}

/// An angle phi (rad) and its weight; the way (m) to the disc's centre from the other one's, x, y and z; and that, x and
/// y, to the second face's centre from the point about which it turns, or its opposite if the disc is the first.
type Node = [f64; 7];

/// As many nodes as faces that do not nearly touch need.
pub const USUAL: usize = 40;

/// A disc's axis and the other face.
struct Line<'a> {
    axis: Vector3<f64>,
    radius: f64,
    other: &'a ChargedFace,
    disc_moves: bool,
    nodes: &'a [Node],
}

impl Task for Line<'_> {
    type Output = Integral;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Integral {
        let axis = self.axis;
        let zero = l.splat(0.0);
        let [mut value, mut x, mut y, mut slope] = [zero; 4];
        for nodes in self.nodes.chunks(WIDTH) {
            let [phi, weight, from_x, from_y, from_z, right, up] = columns(nodes);
            let (right, up) = (l.load(&right), l.load(&up));
            let (sin, cos) = l.sin_cos(l.load(&phi));
            let t = l.mul(cos, l.splat(self.radius));
            let half = l.mul(sin, l.splat(self.radius));
            let weight = l.mul(l.mul(half, half), l.mul(l.load(&weight), l.splat(2.0)));
            let place = [
                Z {
                    re: l.load(&from_x),
                    im: l.mul(t, l.splat(axis.x)),
                },
                Z {
                    re: l.load(&from_y),
                    im: l.mul(t, l.splat(axis.y)),
                },
                Z {
                    re: l.load(&from_z),
                    im: l.mul(t, l.splat(axis.z)),
                },
            ];
            let (v, [gx, gy, _]) = self.other.potential(l, place);
            value = l.mul_add(weight, v.re, value);
            x = l.mul_add(weight, gx.re, x);
            y = l.mul_add(weight, gy.re, y);
            // A turn of the other face is the opposite turn of the place about it; a turn of the
            // disc turns its axis: the real part of `i t n x grad`.
            let turned = if self.disc_moves {
                let across = l.neg_mul_add(l.splat(axis.x), gy.im, l.mul(l.splat(axis.y), gx.im));
                l.mul(t, across)
            } else {
                let turned = l.z_sub(l.z_mul(gx, place[1]), l.z_mul(gy, place[0]));
                turned.re
            };
            let lever = l.neg_mul_add(up, gx.re, l.mul(right, gy.re));
            slope = l.mul_add(weight, l.add(turned, lever), slope);
        }
        let sign = if self.disc_moves { 1.0 } else { -1.0 };
        Integral {
            value: l.sum(value),
            gradient: Vector2::new(l.sum(x), l.sum(y)) * sign,
            slope: l.sum(slope),
        }
    }
}

/// Nodes in lanes, value by value. Lanes that are left over repeat the last node without its weight, its second value.
#[inline(always)]
pub fn columns<const N: usize>(nodes: &[[f64; N]]) -> [[f64; WIDTH]; N] {
    let mut columns = [[0.0; WIDTH]; N];
    for lane in 0..WIDTH {
        let node = nodes[lane.min(nodes.len() - 1)];
        for (column, value) in columns.iter_mut().zip(node) {
            column[lane] = value;
        }
        if lane >= nodes.len() {
            columns[1][lane] = 0.0;
        }
    }
    columns
}

/// Calls `each` with angles phi (rad) in [0, pi / 2] and their weights, for about this relative error: the value
/// at `pi - phi` is the complex conjugate.
pub fn angles(
    lost: f64,
    disc: &ChargedFace,
    radius: f64,
    other: &ChargedFace,
    mut each: impl FnMut(f64, f64),
) {
    let normal = disc.frame[2];
    let corners = other.corners(disc.centre);
    let singular: ArrayVec<Complex<f64>, 12> = corners
        .iter()
        .map(|point| {
            let way = point - disc.centre;
            let height = way.dot(&normal);
            let aside = (way - normal * height).norm();
            Complex::new(aside, height.abs()) / radius
        })
        .collect();
    let nearest = singular.iter().map(|place| half_axis(*place));
    let cosh = nearest.fold(f64::INFINITY, f64::min);
    let ln_rho = libm::log(cosh + half_axis_across(cosh));
    let steps = (-libm::log(lost) / (2.0 * ln_rho)).ceil().max(STEPS[0]);
    if steps <= STEPS[1] {
        // Equal steps from 0 to pi; the one in the middle is its own image.
        let step = PI / steps;
        for k in 1..=steps as usize / 2 {
            let own = 2 * k == steps as usize;
            each(k as f64 * step, if own { step } else { 2.0 * step });
        }
    } else {
        let singular: ArrayVec<Complex<f64>, 12> = singular.into_iter().map(arccosine).collect();
        panels([0.0, PI / 2.0], &singular, 1e-5, &mut |phi, weight| {
            each(phi, 2.0 * weight);
        });
    }
}

/// The longer half axis of the ellipse about [-1, 1] through a place.
fn half_axis(z: Complex<f64>) -> f64 {
    let [near, far] = [z - 1.0, z + 1.0].map(|d| d.norm_sqr().sqrt());
    ((near + far) / 2.0).max(1.0)
}

/// The shorter one, given the longer one.
fn half_axis_across(cosh: f64) -> f64 {
    ((cosh - 1.0) * (cosh + 1.0)).sqrt()
}

/// The angle whose cosine a place in the first quadrant is, with its imaginary part positive:
/// `cos(a + i b) = cos a cosh b - i sin a sinh b`.
fn arccosine(z: Complex<f64>) -> Complex<f64> {
    let cosh = half_axis(z);
    let sinh = half_axis_across(cosh);
    Complex::new(libm::acos((z.re / cosh).min(1.0)), libm::log(cosh + sinh))
}
