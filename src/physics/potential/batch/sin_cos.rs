//! Sine and cosine on vectors.

use super::lanes::{Arithmetic, Lanes};

/// Sine and cosine: the angle is brought within an eighth turn of 0 by subtracting quarter turns
/// (in two parts, the first of which is exact), then come the Taylor series, cut where the next
/// term is below 2^-56.
#[inline(always)]
pub fn sin_cos<L: Lanes>(lanes: L, angle: L::F) -> (L::F, L::F) {
    // 1.5 * 2^52: adding it rounds to an integer and leaves that integer in the low bits.
    const SHIFT: f64 = 6755399441055744.0;
    // pi/2 to twice the precision of f64.
    const QUARTER: [f64; 2] = [std::f64::consts::FRAC_PI_2, 6.123233995736766e-17];
    const SIN: [f64; 7] = taylor(3);
    const COS: [f64; 7] = taylor(4);

    let shift = lanes.splat(SHIFT);
    let shifted = lanes.mul_add(angle, lanes.splat(std::f64::consts::FRAC_2_PI), shift);
    let quarters = lanes.sub(shifted, shift);
    let x = lanes.neg_mul_add(quarters, lanes.splat(QUARTER[0]), angle);
    let x = lanes.neg_mul_add(quarters, lanes.splat(QUARTER[1]), x);
    let x2 = lanes.mul(x, x);

    let sin = lanes.mul_add(lanes.mul(x, x2), polynomial(lanes, x2, &SIN), x);
    let tail = lanes.mul(x2, polynomial(lanes, x2, &COS));
    let cos = lanes.mul_add(x2, lanes.sub(tail, lanes.splat(0.5)), lanes.splat(1.0));
    lanes.turn(shifted, sin, cos)
}

/// `c[0] + c[1] x + ... + c[6] x^6`, in a form that needs few operations one after the other.
#[inline(always)]
fn polynomial<L: Arithmetic>(l: L, x: L::F, c: &[f64; 7]) -> L::F {
    let x2 = l.mul(x, x);
    let low = l.mul_add(x, l.splat(c[1]), l.splat(c[0]));
    let middle = l.mul_add(x, l.splat(c[3]), l.splat(c[2]));
    let high = l.mul_add(x, l.splat(c[5]), l.splat(c[4]));
    let high = l.mul_add(x2, l.splat(c[6]), high);
    l.mul_add(x2, l.mul_add(x2, high, middle), low)
}

/// The coefficients `+-1/n!` for n = `first`, `first + 2`, ... of the Taylor series of the sine
/// (from n = 3) and the cosine (from n = 4).
const fn taylor(first: usize) -> [f64; 7] {
    let mut coefficients = [0.0; 7];
    let mut factorial = 1.0;
    let mut n = 1;
    while n < first + 14 {
        factorial *= n as f64;
        if n >= first && (n - first).is_multiple_of(2) {
            let sign = if (n / 2).is_multiple_of(2) { 1.0 } else { -1.0 };
            coefficients[(n - first) / 2] = sign / factorial;
        }
        n += 1;
    }
    coefficients
}
