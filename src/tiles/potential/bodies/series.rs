//! The multipole series of two magnets of any form.
//!
//! As [blocks](crate::potential::cuboid) have it, averaging point dipoles over a magnet is an operator S
//! made of even powers of derivatives along its three directions: for each length L of a block
//! `sinhc(L d / 2) = sum (L / 2)^(2k) d^(2k) / (2k + 1)!`, and for a disc of radius R
//!
//! ```text
//! 2 I1(R s) / (R s) = sum (R / 2)^(2k) s^(2k) / (k! (k + 1)!),    s^2 = -d^2 along its axis (Laplace).
//! ```
//!
//! With `P = d/dw`, `Q = d/d(conj w)`, `w = x + i y`, see there, two lying magnets have the energy
//! `-mu0 m1 m2 / (4 pi) S1 d_a1 S2 d_a2 (1 / r)`, and two standing ones, of whose vertical derivatives the
//! square is `-4 P Q`, `-mu0 m1 m2 / (4 pi) S1 S2 (-4 P Q) (1 / r)`: either is
//!
//! ```text
//! U = -mu0 m1 m2 / (4 pi)  sum_k r^(-3-2k) Re sum_n C_kn(beta) e^(-2 i n phi),   n = 0 .. k+1
//! ```
//!
//! with beta the angle between the magnets' directions, phi the angle from the first one's
//! direction to the line from the first to the second, and `C_kn = sum T e^(i turn beta)`.

use nalgebra::Complex;

use super::Body;
use super::complex::{Complexes, Z};
use crate::potential::cuboid::multipole::{
    Form, along, composed, index, powers, product, squares, term,
};
use crate::potential::simd::lanes::Lanes;
use crate::tile::magnet::Shape;

/// Terms that are summed, the dipole included.
pub const TERMS: usize = 12;
/// Terms that enter the bound of the error.
const BOUND_TERMS: usize = 22;

type C = Complex<f64>;

/// The part of the series that does not depend on places, angles and moments.
#[derive(Clone, Debug)]
pub struct Series {
    /// The T of each term k: by turns, in steps of 2 from `-last` to `last`, and by n.
    terms: Vec<Vec<f64>>,
    /// Bounds of the terms (m^(2k)).
    magnitudes: Vec<f64>,
}

/// The coefficients C_kn at one angle beta, and their derivatives by it, of the terms so far.
pub struct Coefficients {
    count: usize,
    re: [f64; index(TERMS, 0)],
    im: [f64; index(TERMS, 0)],
    turn_re: [f64; index(TERMS, 0)],
    turn_im: [f64; index(TERMS, 0)],
}

impl Coefficients {
    /// None yet.
    pub const NONE: Self = Self {
        count: 0,
        re: [0.0; index(TERMS, 0)],
        im: [0.0; index(TERMS, 0)],
        turn_re: [0.0; index(TERMS, 0)],
        turn_im: [0.0; index(TERMS, 0)],
    };
}

/// The terms of degree 0, 2, 4 .. of S, in the magnet's own directions.
fn average(body: &Body) -> Vec<Form> {
    let [first, across, up] = &squares();
    let [a, b, c] = body.size;
    let length = |square: &Form, length: f64| along(square, BOUND_TERMS, length);
    let parts = match (body.shape, body.stands) {
        (Shape::Block, _) => vec![length(first, a), length(across, b), length(up, c)],
        (Shape::Disc, stands) => {
            let (axis, height, diameter) = if stands { (up, c, a) } else { (first, a, b) };
            let disc = |k: f64| -diameter * diameter / 16.0 / (k * (k + 1.0));
            vec![length(axis, height), powers(axis, BOUND_TERMS, disc)]
        }
    };
    composed(&parts, BOUND_TERMS)
}

impl Series {
    /// The series of two magnets that both lie flat or both stand upright.
    pub fn new(first: &Body, second: &Body) -> Self {
        let times = |forms: Vec<Form>, by: &[f64]| -> Vec<Form> {
            forms.iter().map(|form| product(form, by)).collect()
        };
        let [a, b] = match first.stands {
            true => [average(first), times(average(second), &[0.0, -4.0, 0.0])],
            false => [first, second].map(|body| times(average(body), &[1.0, 1.0])),
        };
        let terms: Vec<_> = (0..BOUND_TERMS).map(|k| term(&a, &b, k)).collect();
        let magnitude = |all: &Vec<f64>| all.iter().map(|value| value.abs()).sum();
        Self {
            magnitudes: terms.iter().map(magnitude).collect(),
            terms: terms.into_iter().take(TERMS).collect(),
        }
    }

    /// The distance (m) beyond which the sum of the terms from number `terms` on is below
    /// `tolerance` times `mu0 m1 m2 / (4 pi r^3)`.
    pub fn radius(&self, terms: usize, tolerance: f64) -> f64 {
        let error = |r: f64| -> f64 {
            let left = terms..BOUND_TERMS;
            left.map(|k| self.magnitudes[k] * r.powi(-2 * k as i32))
                .sum()
        };
        // For a single term it is where that term equals the tolerance; for all of them at most
        // this factor times as far.
        let of = |k: usize| libm::pow(self.magnitudes[k] / tolerance, 0.5 / k as f64);
        let mut low = (terms..BOUND_TERMS).map(of).fold(0.0, f64::max);
        let mut high = 4.0 * low;
        for _ in 0..50 {
            let middle = (low + high) / 2.0;
            match error(middle) > tolerance {
                true => low = middle,
                false => high = middle,
            }
        }
        high
    }

    /// Computes the missing coefficients of the first `terms` terms for `beta` = e^(i beta).
    pub fn complete<const SLOPE: bool>(&self, known: &mut Coefficients, beta: C, terms: usize) {
        for k in known.count..terms {
            let values = &self.terms[k];
            let last = values.len() / (k + 2) - 1;
            let range = index(k, 0)..index(k + 1, 0);
            let (re, im) = (&mut known.re[range.clone()], &mut known.im[range.clone()]);
            let (turn_re, turn_im) = (&mut known.turn_re[range.clone()], &mut known.turn_im[range]);
            let mut phase = beta.conj().powu(last as u32);
            for (i, row) in values.chunks(k + 2).enumerate() {
                for (n, value) in row.iter().enumerate() {
                    re[n] += value * phase.re;
                    im[n] += value * phase.im;
                }
                if SLOPE {
                    let turn = 2.0 * i as f64 - last as f64;
                    for (n, value) in row.iter().enumerate() {
                        turn_re[n] -= value * turn * phase.im;
                        turn_im[n] += value * turn * phase.re;
                    }
                }
                phase *= beta * beta;
            }
        }
        known.count = known.count.max(terms);
    }
}

/// The sums over pairs of moments of 1 A m^2, of the energy, of its derivatives along and across the way
/// from the first to the second magnet times its length, and by the second one's turn.
pub struct Sums<F> {
    pub energy: F,
    pub radial: F,
    pub angular: F,
    pub turn: F,
}

impl Coefficients {
    /// The first `terms` terms for the second magnet `way` (m) from the first one, along and across
    /// the first one's direction, without the factor `-mu0 / (4 pi)`. `square` is the squared length
    /// of the way. Derivatives are zero unless requested.
    #[inline(always)]
    pub fn sum<L: Lanes, const SLOPE: bool>(
        &self,
        l: L,
        terms: usize,
        way: Z<L::F>,
        square: L::F,
    ) -> Sums<L::F> {
        let zero = l.splat(0.0);
        let inverse = l.div(l.splat(1.0), square);
        // e^(-2 i phi).
        let back = Z {
            re: way.re,
            im: l.sub(zero, way.im),
        };
        let v = l.z_times(l.z_mul(back, back), inverse);
        let mut scale = l.mul(inverse, l.sqrt(inverse));
        let mut sums = Sums {
            energy: zero,
            radial: zero,
            angular: zero,
            turn: zero,
        };
        for k in 0..terms {
            let from = index(k, 0);
            let mut value = l.z_splat(0.0, 0.0);
            let (mut slope, mut turn) = (value, value);
            for n in (from..index(k + 1, 0)).rev() {
                if SLOPE {
                    slope = l.z_mul_add(slope, v, value);
                    turn = l.z_mul_add(turn, v, l.z_splat(self.turn_re[n], self.turn_im[n]));
                }
                value = l.z_mul_add(value, v, l.z_splat(self.re[n], self.im[n]));
            }
            sums.energy = l.mul_add(scale, value.re, sums.energy);
            if SLOPE {
                let power = l.mul(scale, l.splat(-((3 + 2 * k) as f64)));
                sums.radial = l.mul_add(power, value.re, sums.radial);
                // The derivative of e^(-2 i n phi) by phi: of v by it is -2 i v.
                let angular = l.mul(l.splat(2.0), l.z_mul(slope, v).im);
                sums.angular = l.mul_add(scale, angular, sums.angular);
                sums.turn = l.mul_add(scale, turn.re, sums.turn);
            }
            scale = l.mul(scale, inverse);
        }
        sums
    }
}
