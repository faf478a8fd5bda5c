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
use super::face::{Face, Integral};
use super::panels::panels;
use crate::potential::simd::Level;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};

/// Approximate relative error of the integral.
const LOST: f64 = 1e-13;
/// The smallest and the largest number of equal steps; above the latter, panels take fewer nodes.
const STEPS: [f64; 2] = [4.0, 36.0];

/// The integral of a disc and another face, with the derivatives of the disc's motion or the other's.
pub fn integral(disc: &Face, radius: f64, other: &Face, disc_moves: bool) -> Integral {
    Level::best().run(Line {
        axis: disc.frame[2],
        from: disc.centre - other.centre,
        radius,
        other,
        disc_moves,
        angles: &angles(disc, radius, other),
    })
}

/// A disc's axis and the other face.
struct Line<'a> {
    axis: Vector3<f64>,
    /// The disc's centre from the other one's (m).
    from: Vector3<f64>,
    radius: f64,
    other: &'a Face,
    disc_moves: bool,
    angles: &'a [(f64, f64)],
}

impl Task for Line<'_> {
    type Output = Integral;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Integral {
        let (from, axis) = (self.from, self.axis);
        let zero = l.splat(0.0);
        let [mut value, mut x, mut y, mut slope] = [zero; 4];
        for angles in self.angles.chunks(WIDTH) {
            // What is left over has no weight.
            let (mut phi, mut weight) = ([1.0; WIDTH], [0.0; WIDTH]);
            for (k, angle) in angles.iter().enumerate() {
                (phi[k], weight[k]) = *angle;
            }
            let (sin, cos) = l.sin_cos(l.load(&phi));
            let t = l.mul(cos, l.splat(self.radius));
            let half = l.mul(sin, l.splat(self.radius));
            let weight = l.mul(l.mul(half, half), l.mul(l.load(&weight), l.splat(2.0)));
            let place = [
                Z {
                    re: l.splat(from.x),
                    im: l.mul(t, l.splat(axis.x)),
                },
                Z {
                    re: l.splat(from.y),
                    im: l.mul(t, l.splat(axis.y)),
                },
                Z {
                    re: l.splat(from.z),
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
            slope = l.mul_add(weight, turned, slope);
        }
        let sign = if self.disc_moves { 1.0 } else { -1.0 };
        Integral {
            value: l.sum(value),
            gradient: Vector2::new(l.sum(x), l.sum(y)) * sign,
            slope: l.sum(slope),
        }
    }
}

/// Angles phi (rad) in [0, pi / 2] and their weights: the value at `pi - phi` is the complex
/// conjugate.
fn angles(disc: &Face, radius: f64, other: &Face) -> Vec<(f64, f64)> {
    let normal = disc.frame[2];
    let corners = other.corners(disc.centre);
    let singular: ArrayVec<Complex<f64>, 12> = corners
        .iter()
        .map(|point| {
            let way = point - disc.centre;
            let height = way.dot(&normal);
            let aside = (way - normal * height).norm();
            arccosine(Complex::new(aside, height.abs()) / radius)
        })
        .collect();
    // ln rho is the imaginary part of the angle of the singular place.
    let ln_rho = singular
        .iter()
        .map(|place| place.im)
        .fold(f64::INFINITY, f64::min);
    let steps = (-libm::log(LOST) / (2.0 * ln_rho)).ceil().max(STEPS[0]);
    let mut found = Vec::new();
    if steps <= STEPS[1] {
        // Equal steps from 0 to pi; the one in the middle is its own image.
        let step = PI / steps;
        for k in 1..=steps as usize / 2 {
            let own = 2 * k == steps as usize;
            found.push((k as f64 * step, if own { step } else { 2.0 * step }));
        }
    } else {
        panels([0.0, PI / 2.0], &singular, 1e-5, &mut |phi, weight| {
            found.push((phi, 2.0 * weight))
        });
    }
    found
}

/// The angle whose cosine a place in the first quadrant is, with its imaginary part positive:
/// `cos(a + i b) = cos a cosh b - i sin a sinh b`.
fn arccosine(z: Complex<f64>) -> Complex<f64> {
    let [near, far] = [z - 1.0, z + 1.0].map(|d| d.norm_sqr().sqrt());
    let cosh = ((near + far) / 2.0).max(1.0);
    let sinh = ((cosh - 1.0) * (cosh + 1.0)).sqrt();
    Complex::new(libm::acos((z.re / cosh).min(1.0)), libm::log(cosh + sinh))
}
