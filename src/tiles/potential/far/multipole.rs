//! The multipole series of the energy of two magnets, blocks or discs, that both lie flat or both stand.
//!
//! Averaging point dipoles over a block of size L along its axis, W across it and c through the
//! thickness is the operator `S = sinhc(L d_a / 2) sinhc(W d_t / 2) sinhc(c d_z / 2)`, with
//! `sinhc(u) = sinh(u) / u = sum u^(2k) / (2k + 1)!` and `d_a`, `d_t`, `d_z` the derivatives along
//! the three edges. For a disc of radius R the two factors across its axis are
//!
//! ```text
//! 2 I1(R s) / (R s) = sum (R / 2)^(2k) s^(2k) / (k! (k + 1)!),    s^2 = -d_a^2 (Laplace).
//! ```
//!
//! Two magnets with moments m1, m2 hence have the energy
//!
//! ```text
//! U = -mu0 m1 m2 / (4 pi)  S1 d_a1  S2 d_a2  (1 / r)         (J)
//! ```
//!
//! In the plane z = 0, with `w = x + i y`, `P = d/dw` and `Q = d/d(conj w)`, the derivative along
//! the direction alpha is `e^(i alpha) P + e^(-i alpha) Q`, the Laplace equation makes
//! `d_z^2 = -4 P Q` (which takes the place of `d_a1 d_a2` for two magnets that stand), and
//!
//! ```text
//! P^M Q^N (1 / r) = (-1)^(M+N) (1/2)_M (1/2)_N r^(-1-M-N) e^(-i (M-N) phi)
//! ```
//!
//! with rising factorials `(1/2)_M`. Collecting powers, with beta = alpha2 - alpha1 and phi
//! measured from the first magnet's direction:
//!
//! ```text
//! U = -mu0 m1 m2 / (4 pi)  sum_k r^(-3-2k) Re sum_l C_kl(beta) e^(-i l phi),   l = 0, 2 .. 2k+2
//! C_kl(beta) = sum_l' T_kll' e^(i l' beta),                           l' = -2k-1, -2k+1 .. 2k+1
//! ```
//!
//! (l' = -2k-2, -2k .. 2k+2 for magnets that stand.) Term k = 0 is the point dipole; term k falls like
//! `r^(-3-2k)`. The numbers T depend on the two shapes and sizes alone. Their absolute sum over l and l', `A_k`, bounds term k at every angle, so the error
//! of omitting terms is bounded by the A_k of the omitted terms.

use std::ops::Range;

use nalgebra::Complex;

use crate::bisection::bisected;
use crate::potential::simd::lanes::{Lanes, WIDTH};

/// The largest number of terms of a series that are summed, the dipole included.
pub const MOST_TERMS: usize = 12;

/// A homogeneous real polynomial in P and Q; entry m is the coefficient of P^m Q^(degree-m).
pub type Homogeneous = Vec<f64>;

pub fn product(a: &[f64], b: &[f64]) -> Homogeneous {
    let mut out = vec![0.0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] += x * y;
        }
    }
    out
}

/// The squares of the derivatives along a magnet's first direction, across it in the plane, and upwards.
pub fn squares() -> [Homogeneous; 3] {
    [
        vec![1.0, 2.0, 1.0],
        vec![-1.0, 2.0, -1.0],
        vec![0.0, -4.0, 0.0],
    ]
}

/// The powers of a square, each times its coefficient, of which `ratio(k)` is that of power k to the
/// one before.
pub fn powers(square: &Homogeneous, count: usize, ratio: impl Fn(f64) -> f64) -> Vec<Homogeneous> {
    let mut powers: Vec<Homogeneous> = vec![vec![1.0]];
    for k in 1..count {
        let next = product(&powers[k - 1], square);
        powers.push(next.iter().map(|x| x * ratio(k as f64)).collect());
    }
    powers
}

/// `sinhc(L d / 2)` for a length L (m), given the square of d.
pub fn along(square: &Homogeneous, count: usize, length: f64) -> Vec<Homogeneous> {
    let ratio = |k: f64| length * length / (4.0 * (2.0 * k) * (2.0 * k + 1.0));
    powers(square, count, ratio)
}

/// The terms of degree 0, 2, 4 .. of a product of such operators.
pub fn composed(parts: &[Vec<Homogeneous>], count: usize) -> Vec<Homogeneous> {
    let mut forms: Vec<Homogeneous> = (0..count).map(|k| vec![0.0; 2 * k + 1]).collect();
    forms[0][0] = 1.0;
    for powers in parts {
        for k in (0..count).rev() {
            let mut sum = vec![0.0; 2 * k + 1];
            for j in 0..=k {
                for (total, x) in sum.iter_mut().zip(product(&forms[j], &powers[k - j])) {
                    *total += x;
                }
            }
            forms[k] = sum;
        }
    }
    forms
}

/// The rising factorials (1/2)_0 to (1/2)_n.
fn rising_halves(n: usize) -> Vec<f64> {
    let mut all = vec![1.0];
    for i in 0..n {
        all.push(all[i] * (i as f64 + 0.5));
    }
    all
}

/// The index of the coefficient C_kl among those of all terms, given `l / 2`.
#[inline(always)]
pub const fn index(k: usize, half: usize) -> usize {
    k * (k + 3) / 2 + half
}

/// Room for all C_kl, in whole vectors.
pub const ROOM: usize = index(MOST_TERMS, 0).next_multiple_of(WIDTH);

/// C_kl at one angle beta.
#[derive(Clone, Copy, Debug)]
pub struct Coefficients {
    pub re: [f64; ROOM],
    pub im: [f64; ROOM],
    /// The derivatives by beta.
    pub turn_re: [f64; ROOM],
    pub turn_im: [f64; ROOM],
    /// The derivatives by phi, which are again coefficients: `-i l C_kl`.
    pub slope_re: [f64; ROOM],
    pub slope_im: [f64; ROOM],
}

impl Coefficients {
    pub const NONE: Self = Self {
        re: [0.0; ROOM],
        im: [0.0; ROOM],
        turn_re: [0.0; ROOM],
        turn_im: [0.0; ROOM],
        slope_re: [0.0; ROOM],
        slope_im: [0.0; ROOM],
    };
}

/// l of each coefficient.
const ORDERS: [f64; ROOM] = {
    let mut orders = [0.0; ROOM];
    let mut k = 0;
    while k < MOST_TERMS {
        let mut half = 0;
        while half < k + 2 {
            orders[index(k, half)] = (2 * half) as f64;
            half += 1;
        }
        k += 1;
    }
    orders
};

/// The series of two magnets.
#[derive(Clone, Debug)]
pub struct Multipole {
    /// How many terms can be summed.
    pub terms: usize,
    /// The least l' that is not negative: 1, or 0 if both stand.
    least: usize,
    /// For l' = 1, 3 .. or 0, 2 .. the sums and the differences of T_kll' and T_kl-l', of all C_kl.
    sums: Vec<[f64; ROOM]>,
    differences: Vec<[f64; ROOM]>,
    /// A_k (m^(2k)), longer than the coefficients.
    magnitudes: Vec<f64>,
}

impl Multipole {
    /// The series with up to `terms` terms, of operators given by their parts of ascending degrees; all parts
    /// enter the bound of the error.
    pub fn new([first, second]: [&[Homogeneous]; 2], terms: usize) -> Self {
        let all: Vec<_> = (0..first.len()).map(|k| term(first, second, k)).collect();
        // The values of l' of term k.
        let turns = |k: usize| second[k].len();
        let numbered = all.iter().enumerate();
        let magnitudes = numbered.map(|(k, all)| magnitude(all, k)).collect();
        let orders = turns(terms - 1).div_ceil(2);
        let (mut sums, mut differences) = (vec![[0.0; ROOM]; orders], vec![[0.0; ROOM]; orders]);
        for (k, all) in all.iter().take(terms).enumerate() {
            let turns = turns(k);
            for turn in 0..turns {
                // l' and its magnitude's place.
                let order = 2 * turn as isize + 1 - turns as isize;
                let at = order.unsigned_abs() / 2;
                let sign = if order < 0 { -1.0 } else { 1.0 };
                for n in 0..k + 2 {
                    let value = all[turn * (k + 2) + n];
                    sums[at][index(k, n)] += value;
                    differences[at][index(k, n)] += sign * value;
                }
            }
        }
        Self {
            terms,
            least: (turns(0) + 1) % 2,
            sums,
            differences,
            magnitudes,
        }
    }

    /// The distance (m) beyond which the sum of the terms from number `terms` on is below
    /// `tolerance` times `mu0 m1 m2 / (4 pi r^3)`.
    pub fn radius(&self, terms: usize, tolerance: f64) -> f64 {
        self.least(terms, |error, _| error > tolerance)
    }

    /// The same for an error of `tolerance` (m^-3) times `mu0 m1 m2 / (4 pi)`.
    pub fn radius_among(&self, terms: usize, tolerance: f64) -> f64 {
        self.least(terms, |error, r| error > tolerance * r.powi(3))
    }

    /// The smallest distance r (m) beyond which the terms from number `terms` on, in units of the
    /// dipole term, are not too large.
    fn least(&self, terms: usize, is_much: impl Fn(f64, f64) -> bool) -> f64 {
        let is_much = |r: f64| {
            let q = 1.0 / (r * r);
            let tail = self.magnitudes[terms..].iter().rev();
            let tail = tail.fold(0.0, |sum, magnitude| sum * q + magnitude);
            is_much(tail * q.powi(terms as i32), r)
        };
        let (mut low, mut high) = (1e-9, 1e-9);
        while is_much(high) {
            (low, high) = (high, 2.0 * high);
        }
        bisected(low, high, 40, is_much)[1]
    }

    /// The powers of `turn` = e^(i beta) that the first terms have, in the order of l'. Others are finite.
    #[inline(always)]
    pub fn turns(&self, turn: Complex<f64>, terms: usize) -> [Complex<f64>; MOST_TERMS + 1] {
        let step = turn * turn;
        // Coefficients of later terms in the last vector remain to be computed.
        let mut turns = [turn; MOST_TERMS + 1];
        if self.least == 0 {
            turns[0] = Complex::new(1.0, 0.0);
        }
        // Term k has the orders up to k, or up to k + 1 if the least is 0.
        for j in 1..terms + 1 - self.least {
            turns[j] = turns[j - 1] * step;
        }
        turns
    }

    /// The j-th l' that is not negative.
    #[inline(always)]
    pub fn order(&self, j: usize) -> f64 {
        (2 * j + self.least) as f64
    }

    /// The sums and the differences of T_kll' and T_kl-l' for the j-th l', of all C_kl.
    #[inline(always)]
    pub fn with_order(&self, j: usize) -> (&[f64; ROOM], &[f64; ROOM]) {
        (&self.sums[j], &self.differences[j])
    }

    /// The vectors of coefficients of some terms: where each begins, and how many l' these coefficients have.
    #[inline(always)]
    pub fn vectors(&self, terms: Range<usize>) -> impl Iterator<Item = (usize, usize)> {
        let (most, more) = (self.terms, 1 - self.least);
        let first = index(terms.start, 0) / WIDTH * WIDTH;
        let mut last = 1;
        (first..index(terms.end, 0))
            .step_by(WIDTH)
            .map(move |begin| {
                while last < most && index(last, 0) < begin + WIDTH {
                    last += 1;
                }
                (begin, last + more)
            })
    }

    /// Computes the coefficients of some terms for `turn` = e^(i beta), those for derivatives only
    /// if requested.
    #[inline(always)]
    pub fn evaluate<L: Lanes, const SLOPE: bool>(
        &self,
        l: L,
        turn: Complex<f64>,
        terms: Range<usize>,
        known: &mut Coefficients,
    ) {
        let turns = self.turns(turn, terms.end);
        for (i, orders) in self.vectors(terms) {
            let zero = l.splat(0.0);
            let (mut re, mut im) = (zero, zero);
            let (mut turn_re, mut turn_im) = (zero, zero);
            for (j, phase) in turns[..orders].iter().enumerate() {
                let (cos, sin) = (l.splat(phase.re), l.splat(phase.im));
                let sum = l.load(&self.sums[j][i..]);
                let difference = l.load(&self.differences[j][i..]);
                re = l.mul_add(sum, cos, re);
                im = l.mul_add(difference, sin, im);
                if SLOPE {
                    let order = l.splat(self.order(j));
                    turn_re = l.neg_mul_add(l.mul(sum, order), sin, turn_re);
                    turn_im = l.mul_add(l.mul(difference, order), cos, turn_im);
                }
            }
            l.store(re, &mut known.re[i..]);
            l.store(im, &mut known.im[i..]);
            if SLOPE {
                l.store(turn_re, &mut known.turn_re[i..]);
                l.store(turn_im, &mut known.turn_im[i..]);
                let order = l.load(&ORDERS[i..]);
                l.store(l.mul(order, im), &mut known.slope_re[i..]);
                l.store(l.neg_mul_add(order, re, zero), &mut known.slope_im[i..]);
            }
        }
    }
}

/// A_k, given the coefficients T of term `k`.
fn magnitude(all: &[f64], k: usize) -> f64 {
    let by_order = (0..k + 2).flat_map(|n| all[n..].iter().step_by(k + 2));
    by_order.map(|it| it.abs()).sum()
}

/// The A_k (m^(2k)) of operators given by their parts.
pub fn magnitudes([first, second]: [&[Homogeneous]; 2]) -> Vec<f64> {
    let terms = 0..first.len();
    terms
        .map(|k| magnitude(&term(first, second, k), k))
        .collect()
}

/// The coefficients T of term `k`, folded onto n >= 0 (l = 2 n): by turns, in steps of 2, and by n.
pub fn term(first: &[Homogeneous], second: &[Homogeneous], k: usize) -> Vec<f64> {
    let last = second[k].len() - 1;
    let mut values = vec![0.0; (last + 1) * (k + 2)];
    let rising = rising_halves(2 * k + 2);
    for j in 0..=k {
        let (a, b) = (&first[j], &second[k - j]);
        for (m1, x) in a.iter().enumerate() {
            for (m2, y) in b.iter().enumerate() {
                let (p, q) = (m1 + m2, a.len() + b.len() - 2 - m1 - m2);
                if p < q || x * y == 0.0 {
                    continue;
                }
                let fold = if p == q { 1.0 } else { 2.0 };
                // The turn is m2 - n2, with m2 + n2 = b.len() - 1.
                let (n, turn) = ((p - q) / 2, (last + 2 * m2 + 1 - b.len()) / 2);
                values[turn * (k + 2) + n] += fold * x * y * rising[p] * rising[q];
            }
        }
    }
    values
}
