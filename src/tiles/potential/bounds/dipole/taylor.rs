//! The far pairs of a cell: the Taylor form of their energy and the bound of its remainder, with
//! the moving dipoles in SIMD lanes.
//!
//! With the sum over the fixed dipoles `psi(z) = mu0 / (4 pi) sum_j m_j . d_j / |d_j|^3` (so that
//! the field is `-grad psi`) a moving dipole `mu` at z has the energy `U = (mu . grad) psi`.
//! Vectors are written as complex numbers; with `d = r e^{i phi}` one fixed dipole m gives
//!
//! ```text
//! S1 = d/dz psi        = -1/4  r^-3 [ m* + 3 m e^{-2 i phi} ]
//! S2 = d2/dz2 psi      =  3/8  r^-4 [ m* e^{-i phi} + 5 m e^{-3 i phi} ]
//! M2 = d2/dz dz* psi   =  3/4  r^-4 Re[ m e^{-i phi} ]
//! S3 = d3/dz3 psi      = -15/16 r^-5 [ m* e^{-2 i phi} + 7 m e^{-4 i phi} ]
//! M3 = d3/dz2 dz* psi  = -3/16 r^-5 [ 3 m* + 5 m e^{-2 i phi} ]
//! ```
//!
//! A motion of the dipole along u changes U at the rate `2 Re(u P)`, `P = mu S2 + mu* M2`, and
//! motions along u and v bend it by `2 Re(u v Q) + 2 Re(u v*) R`, `Q = mu S3 + mu* M3`,
//! `R = 2 Re(mu M3)`. A turn of the tile moves the dipole along `i arm`, accelerates it along
//! `-arm`, and does the same to its moment.
//!
//! **Remainder.** U of a pair is `-K` times a second directional derivative of `1 / r`, K = mu0 m1
//! m2 / (4 pi), and the n-th directional derivative of `1 / r` is at most `n! / r^(n+1)`. On the
//! straight motion from the centre to a configuration of the cell the magnet's speed is at most v =
//! its reach, it turns at most at the rate w = half the cell's angle, and its second and third time
//! derivatives are at most `a w^2` and `a w^3`, with a its lever arm. With `G_n = (n + 2)! /
//! rho^(n+3)`, rho = r - reach,
//!
//! ```text
//! |U'''| / K <= w^3 G0 + 3 w^2 G1 v + 3 w (G2 v^2 + G1 a w^2) + G3 v^3 + 3 G2 v a w^2 + G1 a w^3
//! ```
//!
//! and the remainder is a sixth of this. It is a sum of products of three speeds, of the place and
//! of the turn. A motion by the fraction s of the cell's half sizes has at most the fraction s of
//! these speeds, and the derivative of the remainder is half of the same sum with one factor of
//! each product for the motion: at most 3 s times the remainder.
//!
//! **Blocks** ([`Taylor`] with `BLOCKS`) add the remainder of the difference V between their energy
//! and that of point dipoles, beyond its value and gradient. A block is a uniform distribution of
//! dipoles, so V is the mean over the offsets xi between two of them of `u(x + xi) - u(x)`, in
//! which xi has mean zero and the mean square `s`: a second derivative of u along xi, at a distance
//! of at least `rho_b`, the centres' rho minus the blocks' radii. Two time derivatives fall on the
//! place (speed `V_b`, acceleration `A_b w^2`, lever arms now to the blocks' farthest points) or on
//! one of the three directions that turn, so half of the second time derivative is at most
//!
//! ```text
//! K s / 4 [720 V_b^2 / rho_b^7 + (720 V_b w + 120 A_b w^2) / rho_b^6 + 216 w^2 / rho_b^5]
//! ```

use std::ops::Range;

use super::{DipoleBounds, NEAR};
use crate::cell::{Cell, Quadratic};
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};

/// Larger than any reciprocal of a difference of squared distances that is not zero.
const HUGE: f64 = 1e60;

/// Pairs within a few times this (m) are always near, and left out, so distances may be assumed to
/// be at least this.
const TINY: f64 = 1e-10;

/// Sums up the far pairs of some fixed and some moving dipoles over a cell: their form, and the
/// bound of its remainder. `weights` gets 1 for each far pair and 0 for each near one, which is
/// left out, in the order of the fixed dipoles. The moving ones are whole vectors.
pub(in crate::potential::bounds) struct Taylor<'a, const BLOCKS: bool> {
    pub bounds: &'a DipoleBounds,
    pub cell: &'a Cell,
    pub fixed: Range<usize>,
    pub moving: Range<usize>,
    pub weights: &'a mut Vec<f64>,
}

/// Properties of blocks for bounding them by the dipoles at their centres.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::potential::bounds) struct Spread {
    /// Pairs closer than this (m) are near.
    pub near: f64,
    /// Sum of the blocks' radii in the plane (m).
    pub radii: f64,
    /// Mean square of the offset between two dipoles (m^2).
    pub square: f64,
    /// Error of the value and of the gradient's effect, as a fraction of K / r^3.
    pub error: f64,
}

/// A vector of complex numbers.
type Complex<F> = [F; 2];

/// `u* v`.
#[inline(always)]
fn conjugate_product<L: Lanes>(l: L, u: Complex<L::F>, v: Complex<L::F>) -> Complex<L::F> {
    [
        l.mul_add(u[1], v[1], l.mul(u[0], v[0])),
        l.neg_mul_add(u[1], v[0], l.mul(u[0], v[1])),
    ]
}

/// `u* v` for a real v.
#[inline(always)]
fn conjugate_times<L: Lanes>(l: L, u: Complex<L::F>, v: L::F) -> Complex<L::F> {
    [l.mul(u[0], v), l.neg_mul_add(u[1], v, l.splat(0.0))]
}

#[inline(always)]
fn sum<L: Lanes>(l: L, u: Complex<L::F>, v: Complex<L::F>) -> Complex<L::F> {
    [l.add(u[0], v[0]), l.add(u[1], v[1])]
}

#[inline(always)]
fn difference<L: Lanes>(l: L, u: Complex<L::F>, v: Complex<L::F>) -> Complex<L::F> {
    [l.sub(u[0], v[0]), l.sub(u[1], v[1])]
}

/// A vector of moving dipoles, as the cell places them.
#[derive(Clone, Copy)]
struct Dipoles<F> {
    place: Complex<F>,
    arm: Complex<F>,
    moment: Complex<F>,
    reach: F,
    /// Square of the distance below which a pair is near.
    near: F,
    /// Coefficients of rho^-3 to rho^-6 in the remainder.
    remainder: [F; 4],
    /// The same for rho_b, from rho_b^-5 to rho_b^-7, if the dipoles represent blocks.
    spread: [F; 3],
}

/// Derivatives of psi, and the sum of the remainders.
#[derive(Clone, Copy)]
struct Sums<F> {
    s1: Complex<F>,
    s2: Complex<F>,
    m2: F,
    s3: Complex<F>,
    m3: Complex<F>,
    remainder: F,
}

impl<const BLOCKS: bool> Task for Taylor<'_, BLOCKS> {
    type Output = (Quadratic, f64);

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let stride = self.moving.len();
        self.weights.resize(stride * self.fixed.len(), 0.0);
        let mut totals = [0.0; 11];
        let mut first = self.moving.start;
        while first < self.moving.end {
            let dipoles = self.dipoles(l, first);
            let mut sums = Sums {
                s1: [l.splat(0.0); 2],
                s2: [l.splat(0.0); 2],
                m2: l.splat(0.0),
                s3: [l.splat(0.0); 2],
                m3: [l.splat(0.0); 2],
                remainder: l.splat(0.0),
            };
            for (row, j) in self.fixed.clone().enumerate() {
                let weight = self.add_pair(l, j, &dipoles, &mut sums);
                let place = row * stride + first - self.moving.start;
                l.store(weight, &mut self.weights[place..]);
            }
            let shares = shares(l, &dipoles, &sums);
            let magnitude = l.load(&self.bounds.moving.magnitude[first..]);
            for (total, share) in totals.iter_mut().zip(shares) {
                *total += l.sum(share);
            }
            totals[10] += l.sum(l.mul(magnitude, sums.remainder));
            first += WIDTH;
        }
        let [value, x, y, turn, xx, yy, tt, xy, xt, yt, remainder] = totals;
        let form = Quadratic {
            value,
            gradient: [x, y, turn],
            hessian: [xx, yy, tt, xy, xt, yt],
        };
        (form, remainder)
    }
}

impl<const BLOCKS: bool> Taylor<'_, BLOCKS> {
    #[inline(always)]
    fn dipoles<L: Lanes>(&self, l: L, first: usize) -> Dipoles<L::F> {
        let moving = &self.bounds.moving;
        let q = &self.cell.centre;
        let (sin, cos) = libm::sincos(q.theta);
        let turn = [l.splat(cos), l.splat(sin)];
        let arm = l.complex_product(
            turn,
            [l.load(&moving.x[first..]), l.load(&moving.y[first..])],
        );
        let moment = [
            l.load(&moving.moment_x[first..]),
            l.load(&moving.moment_y[first..]),
        ];
        let lever = l.load(&moving.lever[first..]);
        let w = self.cell.half[2];
        let reach = l.mul_add(lever, l.splat(w), l.splat(self.cell.travel()));
        let mut near = l.mul(l.splat(NEAR), reach);
        if BLOCKS {
            near = l.add(near, l.splat(self.bounds.spread.near));
        }
        Dipoles {
            place: sum(l, [l.splat(q.x), l.splat(q.y)], arm),
            arm,
            moment: l.complex_product(turn, moment),
            reach,
            near: l.mul_add(near, near, l.splat(NEAR * NEAR * TINY * TINY)),
            remainder: self.remainder(l, w, reach, lever),
            spread: self.spread(l, w, reach, lever),
        }
    }

    #[inline(always)]
    fn spread<L: Lanes>(&self, l: L, w: f64, v: L::F, lever: L::F) -> [L::F; 3] {
        let Spread { radii, square, .. } = self.bounds.spread;
        let share = square / 4.0;
        let v = l.add(v, l.splat(radii * w));
        let lever = l.add(lever, l.splat(radii));
        let turning = l.mul_add(l.splat(720.0 * w), v, l.mul(l.splat(120.0 * w * w), lever));
        [
            l.splat(share * 216.0 * w * w),
            l.mul(l.splat(share), turning),
            l.mul(l.splat(share * 720.0), l.mul(v, v)),
        ]
    }

    #[inline(always)]
    fn remainder<L: Lanes>(&self, l: L, w: f64, v: L::F, lever: L::F) -> [L::F; 4] {
        let q = &self.cell.centre;
        let mut rounding = self.bounds.rounding;
        if BLOCKS {
            rounding += self.bounds.spread.error;
        }
        let size = self.bounds.extent + q.x.abs() + q.y.abs() + 1.0;
        let second = l.mul(lever, l.splat(w * w));
        let v2 = l.mul(v, v);
        // 3 w^2 v + 3 w (a w^2) + a w^3 + E S, with S = size + a
        let fourth = l.mul_add(l.splat(3.0 * w * w), v, l.mul(l.splat(4.0 * w), second));
        let slack = l.mul_add(lever, l.splat(rounding), l.splat(rounding * size));
        let fifth = l.mul_add(l.splat(w), v2, l.mul(v, second));
        [
            l.splat(w * w * w / 3.0 + rounding),
            l.add(fourth, slack),
            l.mul(l.splat(12.0), fifth),
            l.mul(l.splat(20.0), l.mul(v2, v)),
        ]
    }

    /// Adds the pairs with a fixed dipole; returns their weights.
    #[inline(always)]
    fn add_pair<L: Lanes>(
        &self,
        l: L,
        j: usize,
        dipoles: &Dipoles<L::F>,
        sums: &mut Sums<L::F>,
    ) -> L::F {
        let fixed = &self.bounds.fixed[j];
        let m = [l.splat(fixed.moment[0]), l.splat(fixed.moment[1])];
        let position = [l.splat(fixed.position[0]), l.splat(fixed.position[1])];
        let d = difference(l, dipoles.place, position);
        let r2 = l.mul_add(d[0], d[0], l.mul(d[1], d[1]));
        // 1 where r2 > near, otherwise 0.
        let nearness = l.min(l.mul(l.sub(dipoles.near, r2), l.splat(HUGE)), l.splat(0.0));
        let weight = l.min(l.sub(l.splat(0.0), nearness), l.splat(1.0));
        let r2 = at_least(l, r2, TINY * TINY);
        let i1 = l.reciprocal_sqrt(r2);
        let distance = l.sub(l.mul(r2, i1), dipoles.reach);
        let rho = l.reciprocal(at_least(l, distance, TINY));
        let i2 = l.mul(i1, i1);
        let i4 = l.mul(l.mul(i2, i2), weight);
        let i3 = l.mul(l.mul(i2, i1), weight);
        let i5 = l.mul(i3, i2);

        // e = e^{-i phi}
        let e = [l.mul(d[0], i1), l.neg_mul_add(d[1], i1, l.splat(0.0))];
        let e2 = l.complex_product(e, e);
        let m1 = l.complex_product(m, e);
        let m2 = l.complex_product(m, e2);
        let m3 = l.complex_product(m1, e2);
        let m4 = l.complex_product(m2, e2);
        let n1 = conjugate_product(l, m, e);
        let n2 = conjugate_product(l, m, e2);
        let [three, five, seven] = [l.splat(3.0), l.splat(5.0), l.splat(7.0)];
        sums.s1[0] = l.mul_add(i3, l.mul_add(three, m2[0], m[0]), sums.s1[0]);
        sums.s1[1] = l.mul_add(i3, l.sub(l.mul(three, m2[1]), m[1]), sums.s1[1]);
        sums.s2[0] = l.mul_add(i4, l.mul_add(five, m3[0], n1[0]), sums.s2[0]);
        sums.s2[1] = l.mul_add(i4, l.mul_add(five, m3[1], n1[1]), sums.s2[1]);
        sums.m2 = l.mul_add(i4, m1[0], sums.m2);
        sums.s3[0] = l.mul_add(i5, l.mul_add(seven, m4[0], n2[0]), sums.s3[0]);
        sums.s3[1] = l.mul_add(i5, l.mul_add(seven, m4[1], n2[1]), sums.s3[1]);
        let (m5x, m5y) = (l.mul(five, m2[0]), l.mul(five, m2[1]));
        sums.m3[0] = l.mul_add(i5, l.mul_add(three, m[0], m5x), sums.m3[0]);
        sums.m3[1] = l.mul_add(i5, l.neg_mul_add(three, m[1], m5y), sums.m3[1]);

        let [c3, c4, c5, c6] = dipoles.remainder;
        let series = l.mul_add(rho, l.mul_add(rho, l.mul_add(rho, c6, c5), c4), c3);
        let rho3 = l.mul(l.mul(rho, rho), l.mul(rho, weight));
        let magnitude = l.splat(fixed.magnitude);
        sums.remainder = l.mul_add(l.mul(magnitude, rho3), series, sums.remainder);
        if BLOCKS {
            let distance = l.sub(distance, l.splat(self.bounds.spread.radii));
            let rho = l.reciprocal(at_least(l, distance, TINY));
            let rho2 = l.mul(rho, rho);
            let rho5 = l.mul(l.mul(rho2, rho2), l.mul(rho, weight));
            let [c5, c6, c7] = dipoles.spread;
            let series = l.mul_add(rho, l.mul_add(rho, c7, c6), c5);
            sums.remainder = l.mul_add(l.mul(magnitude, rho5), series, sums.remainder);
        }
        weight
    }
}

/// The larger of a number and a constant.
#[inline(always)]
fn at_least<L: Lanes>(l: L, a: L::F, least: f64) -> L::F {
    let zero = l.splat(0.0);
    l.sub(zero, l.min(l.sub(zero, a), l.splat(-least)))
}

/// Value, gradient and Hessian of the dipoles' energies with respect to (x, y, theta).
#[inline(always)]
fn shares<L: Lanes>(l: L, dipoles: &Dipoles<L::F>, sums: &Sums<L::F>) -> [L::F; 10] {
    let mu = dipoles.moment;
    let s1 = scale(l, -0.25, sums.s1);
    let s2 = scale(l, 0.375, sums.s2);
    let m2 = l.mul(l.splat(0.75), sums.m2);
    let s3 = scale(l, -0.9375, sums.s3);
    let m3 = scale(l, -0.1875, sums.m3);

    let v = l.complex_product(mu, s1);
    let mu_s2 = l.complex_product(mu, s2);
    let mu_m2 = conjugate_times(l, mu, m2);
    let p = sum(l, mu_s2, mu_m2);
    // How P changes as the moment turns: i N.
    let n = difference(l, mu_s2, mu_m2);
    let q = sum(l, l.complex_product(mu, s3), conjugate_product(l, mu, m3));
    let two = l.splat(2.0);
    let r = l.mul(two, l.complex_product(mu, m3)[0]);

    let zero = l.splat(0.0);
    let arm = dipoles.arm;
    let turn = [l.sub(zero, arm[1]), arm[0]];
    let turn_p = l.complex_product(turn, p);
    let turn_n = l.complex_product(turn, n);
    let turn_q = l.complex_product(turn, q);
    let turn_turn_q = l.complex_product(turn, turn_q);
    let turn2 = l.mul_add(turn[0], turn[0], l.mul(turn[1], turn[1]));
    let arm_p = l.complex_product(arm, p);
    // 2 [turn turn Q + |turn|^2 R - arm P + 2 i turn N - mu S1]
    let bend = l.mul_add(turn2, r, turn_turn_q[0]);
    let bend = l.sub(bend, arm_p[0]);
    let bend = l.neg_mul_add(two, turn_n[1], bend);
    let tt = l.sub(bend, v[0]);
    let halves = [
        v[0],
        p[0],
        l.sub(zero, p[1]),
        l.sub(turn_p[0], v[1]),
        l.add(q[0], r),
        l.sub(r, q[0]),
        tt,
        l.sub(zero, q[1]),
        l.sub(l.mul_add(turn[0], r, turn_q[0]), n[1]),
        l.sub(l.sub(l.mul(turn[1], r), turn_q[1]), n[0]),
    ];
    let mut shares = halves;
    for share in &mut shares {
        *share = l.mul(two, *share);
    }
    shares
}

#[inline(always)]
fn scale<L: Lanes>(l: L, factor: f64, z: Complex<L::F>) -> Complex<L::F> {
    let factor = l.splat(factor);
    [l.mul(factor, z[0]), l.mul(factor, z[1])]
}
