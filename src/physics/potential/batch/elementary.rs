//! Logarithm and arctangent on vectors.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, LN_2, PI, SQRT_2};

use super::lanes::Lanes;

/// The polynomial that interpolates `ln((1 + s) / (1 - s)) / s` in s^2 at the Chebyshev nodes of
/// [0, 1/9]; its error is below 5e-18.
const LOG: [f64; 11] = [
    2.0,
    0.6666666666666615,
    0.4000000000018575,
    0.28571428545454114,
    0.22222224080747674,
    0.18181740832504806,
    0.1538661404230401,
    0.13300374032674625,
    0.12110168728069218,
    0.0832450651186082,
    0.17044163562781398,
];

/// The same for `atan(x) / x` in x^2 over [0, (sqrt(2) - 1)^2], with an error below 4e-18.
const ATAN: [f64; 12] = [
    1.0,
    -0.3333333333333312,
    0.19999999999940893,
    -0.14285714279250245,
    0.11111110744919658,
    -0.09090896809064027,
    0.07692045330902225,
    -0.06662951813629191,
    0.05846878297330872,
    -0.05035102456601552,
    0.03796525745386593,
    -0.017805397205419446,
];

/// Keeps the angle of the zero vector from being 0 / 0.
const SMALLEST: f64 = 1e-300;

/// `c[0] + c[1] x + ...`, even and odd powers apart: two chains half as long.
#[inline(always)]
fn polynomial<L: Lanes, const N: usize>(l: L, x: L::F, c: &[f64; N]) -> L::F {
    let x2 = l.mul(x, x);
    let mut sums = [l.splat(0.0); 2];
    for i in (0..N).rev() {
        sums[i % 2] = l.mul_add(sums[i % 2], x2, l.splat(c[i]));
    }
    l.mul_add(sums[1], x, sums[0])
}

/// `ln(a / b)` of positive normal numbers, to 3e-16 or a relative 3e-16, whichever is more.
///
/// With `a = m 2^e`, `b = n 2^f` and m, n in [1, 2): `(e - f) ln 2 + ln(m / n)`, and
/// `ln(m / n) = ln((1 + s) / (1 - s))` for `s = (m - n) / (m + n)`, `|s| < 1/3`.
#[inline(always)]
pub fn ln_ratio<L: Lanes>(l: L, a: L::F, b: L::F) -> L::F {
    let (m, e) = l.mantissa_and_exponent(a);
    let (n, f) = l.mantissa_and_exponent(b);
    let s = l.div(l.sub(m, n), l.add(m, n));
    let small = l.mul(s, polynomial(l, l.mul(s, s), &LOG));
    l.mul_add(l.sub(e, f), l.splat(LN_2), small)
}

/// The angle in [0, pi] of the vector (x, y), y >= 0, to 4e-16; 0 for the zero vector.
///
/// The smaller of |x| and y over the larger is t, and where t exceeds tan(pi/8),
/// `atan t = pi/4 + atan((t - 1) / (t + 1))`.
#[inline(always)]
pub fn angle<L: Lanes>(l: L, x: L::F, y: L::F) -> L::F {
    let zero = l.splat(0.0);
    let size = l.select(x, x, l.sub(zero, x));
    let steep = l.sub(size, y);
    let small = l.select(steep, y, size);
    let large = l.add(l.select(steep, size, y), l.splat(SMALLEST));
    let low = l.sub(l.mul(large, l.splat(SQRT_2 - 1.0)), small);
    let t = l.div(
        l.select(low, small, l.sub(small, large)),
        l.select(low, large, l.add(small, large)),
    );
    let base = l.select(low, zero, l.splat(FRAC_PI_4));
    let first = l.mul_add(t, polynomial(l, l.mul(t, t), &ATAN), base);
    let acute = l.select(steep, first, l.sub(l.splat(FRAC_PI_2), first));
    l.select(x, acute, l.sub(l.splat(PI), acute))
}
