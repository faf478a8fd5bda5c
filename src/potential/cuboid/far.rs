//! The far form of one moving block with several fixed ones at once, in vectors.

use nalgebra::{Complex, Vector2};

use super::multipole::{Coefficients, index};
use crate::potential::batch::lanes::Lanes;

/// Sums over pairs of blocks, in units of `-mu0 / (4 pi)`.
#[derive(Clone, Copy)]
pub struct Sums<F> {
    pub energy: F,
    /// dU/dx, dU/dy and dU/dtheta.
    pub gradient: [F; 3],
}

impl<F: Copy> Sums<F> {
    #[inline(always)]
    pub fn zero<L: Lanes<F = F>>(l: L) -> Self {
        let zero = l.splat(0.0);
        Self {
            energy: zero,
            gradient: [zero; 3],
        }
    }
}

/// Adds the first `terms` terms of the series to the sums, for several fixed blocks and a moving
/// one, given the products of their moments.
///
/// `r` is the way (m) from each fixed block to the moving one, `rr` its square, `axis` the square
/// of the fixed blocks' axis as a complex number, and `arm` the way (m) from the moving tile's
/// reference point to the block. With `v = e^(-2 i phi)`, phi from the
/// axis, the terms are polynomials `P_k(v) = sum_l C_kl v^(l/2)` over powers of r.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub fn add<L: Lanes, const SLOPE: bool>(
    l: L,
    coefficients: &Coefficients,
    terms: usize,
    axis: Complex<f64>,
    moment: L::F,
    r: [L::F; 2],
    rr: L::F,
    arm: Complex<f64>,
    sums: &mut Sums<L::F>,
) {
    let inverse = l.reciprocal_sqrt(rr);
    let q = l.mul(inverse, inverse);
    // v = conj(r)^2 axis / r^2.
    let xx = l.neg_mul_add(r[1], r[1], l.mul(r[0], r[0]));
    let xy = l.mul(l.mul(l.splat(-2.0), r[0]), r[1]);
    let (re, im) = (l.splat(axis.re), l.splat(axis.im));
    let v = [
        l.mul(q, l.neg_mul_add(xy, im, l.mul(xx, re))),
        l.mul(q, l.mul_add(xy, re, l.mul(xx, im))),
    ];
    let zero = l.splat(0.0);
    let (mut energy, mut radial, mut angular, mut turning) = (zero, zero, zero, zero);
    let mut k = terms;
    while k > 0 {
        k -= 1;
        let range = index(k, 0)..index(k + 1, 0);
        let c = coefficients;
        let p = polynomial(l, &c.re[range.clone()], &c.im[range.clone()], v);
        energy = l.mul_add(energy, q, p.value);
        if SLOPE {
            radial = l.mul_add(p.value, l.splat(-((3 + 2 * k) as f64)), l.mul(radial, q));
            angular = l.mul_add(p.angular, l.splat(2.0), l.mul(angular, q));
            let turn = polynomial(l, &c.turn_re[range.clone()], &c.turn_im[range], v);
            turning = l.mul_add(turning, q, turn.value);
        }
    }
    let scale = l.mul(moment, l.mul(q, inverse));
    sums.energy = l.mul_add(scale, energy, sums.energy);
    if SLOPE {
        let turn = l.mul(scale, turning);
        let scale = l.mul(scale, q);
        let (radial, angular) = (l.mul(scale, radial), l.mul(scale, angular));
        let gx = l.neg_mul_add(angular, r[1], l.mul(radial, r[0]));
        let gy = l.mul_add(angular, r[0], l.mul(radial, r[1]));
        let turn = l.mul_add(l.splat(arm.re), gy, turn);
        let turn = l.neg_mul_add(l.splat(arm.im), gx, turn);
        for (sum, share) in sums.gradient.iter_mut().zip([gx, gy, turn]) {
            *sum = l.add(*sum, share);
        }
    }
}

/// The real part of a polynomial in v, and the imaginary part of v times its derivative.
struct Polynomial<F> {
    value: F,
    angular: F,
}

#[inline(always)]
fn polynomial<L: Lanes>(l: L, c_re: &[f64], c_im: &[f64], v: [L::F; 2]) -> Polynomial<L::F> {
    let zero = l.splat(0.0);
    let (mut re, mut im) = (zero, zero);
    let (mut slope_re, mut slope_im) = (zero, zero);
    for (c_re, c_im) in c_re.iter().zip(c_im).rev() {
        (slope_re, slope_im) = (
            l.neg_mul_add(slope_im, v[1], l.mul_add(slope_re, v[0], re)),
            l.mul_add(slope_im, v[0], l.mul_add(slope_re, v[1], im)),
        );
        (re, im) = (
            l.neg_mul_add(im, v[1], l.mul_add(re, v[0], l.splat(*c_re))),
            l.mul_add(im, v[0], l.mul_add(re, v[1], l.splat(*c_im))),
        );
    }
    Polynomial {
        value: re,
        angular: l.mul_add(slope_im, v[0], l.mul(slope_re, v[1])),
    }
}

/// Fixed blocks of one size and one axis (up to its sign), as a structure of arrays filled up to
/// a multiple of the number of lanes with blocks of no moment.
#[derive(Clone, Debug)]
pub struct Group {
    /// The number of the size.
    pub size: usize,
    /// The axis of all of them.
    pub axis: Complex<f64>,
    /// Which of the tile's blocks they are.
    pub members: Vec<usize>,
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    /// Moments (A m^2), negative where a block points against the axis.
    pub moment: Vec<f64>,
}

impl Group {
    /// A group of no blocks.
    pub fn new(size: usize, axis: Vector2<f64>) -> Self {
        Self {
            size,
            axis: Complex::new(axis.x, axis.y),
            members: Vec::new(),
            x: Vec::new(),
            y: Vec::new(),
            moment: Vec::new(),
        }
    }

    /// Adds a block, pointing along the axis (sign 1) or against it (-1).
    pub fn push(&mut self, member: usize, position: Vector2<f64>, moment: f64) {
        self.members.push(member);
        self.x.push(position.x);
        self.y.push(position.y);
        self.moment.push(moment);
    }

    /// Fills up to a multiple of `width`.
    pub fn fill(&mut self, width: usize) {
        let length = self.members.len().next_multiple_of(width);
        // Far from everything, so that the filling is never taken for near.
        self.x.resize(length, 1e6);
        self.y.resize(length, 0.0);
        self.moment.resize(length, 0.0);
    }
}
