//! Vectors of f64 lanes, independent of the instruction set, and their functions.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, LN_2, PI, SQRT_2};

/// Number of f64 lanes of a vector, the same with every instruction set, so that all sum in one
/// order and give the same bits.
pub const WIDTH: usize = 8;

/// Pads a list to whole vectors.
pub fn fill(list: &mut Vec<f64>, value: f64) {
    list.resize(list.len().next_multiple_of(WIDTH), value);
}

/// The largest angle (rad) that [`Lanes::sin_cos`] takes.
pub const MAX_ANGLE: f64 = 1e5;

/// See [`Arithmetic::reciprocal_sqrt_guess`]; of all constants it gives the smallest error.
pub const GUESS: i64 = 0x5FE6_E8B0_C7B5_37A9;

/// The cubic of [`Arithmetic::reciprocal_sqrt`], lowest power first.
const NEAREST: [f64; 4] = [
    0.9999992609459435,
    0.4999982809931568,
    0.37627304174671145,
    0.31397257596531003,
];

/// Arithmetic on many f64 lanes at once.
///
/// A value of such a type is the proof that the CPU has the instruction set, so that arithmetic
/// with it is safe. Every operation is lane by lane: a lane's result depends on that lane's
/// operands alone. Every operation is rounded as IEEE 754 says, so that its bits are the same with
/// each instruction set and on each maker's processors.
///
/// All functions are `#[inline(always)]`, and everything that uses them must be, too: only code
/// inlined into [`Task::run`] is compiled for the instruction set. That excludes closures on
/// vectors, and `map` on arrays of them.
pub trait Arithmetic: Copy {
    /// The lanes.
    type F: Copy;

    /// The same value in all lanes.
    fn splat(self, value: f64) -> Self::F;
    /// `a + b`.
    fn add(self, a: Self::F, b: Self::F) -> Self::F;
    /// `a - b`.
    fn sub(self, a: Self::F, b: Self::F) -> Self::F;
    /// `a b`.
    fn mul(self, a: Self::F, b: Self::F) -> Self::F;
    /// `a b + c`, rounded once.
    fn mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    /// `c - a b`, rounded once.
    fn neg_mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    /// The smaller of two numbers; `b` where either is NaN.
    fn min(self, a: Self::F, b: Self::F) -> Self::F;
    /// For positive numbers, the number whose bits are [`GUESS`] minus half those of `a`: `1 /
    /// sqrt(a)` to 3.5 %, as halving a number's bits halves its exponent.
    fn reciprocal_sqrt_guess(self, a: Self::F) -> Self::F;
    /// `1 / a` in single precision.
    fn reciprocal_single(self, a: Self::F) -> Self::F;

    /// `1 / sqrt(a)` to a relative error of 4e-16, for positive normal `a`; at 0 a number above 1e150.
    ///
    /// The processors' own estimates differ between makers, so the iteration starts from a guess
    /// `y` with, `e = 1 - a y^2`, `|e| <= 0.0682`, of which `a^(-1/2) = y (1 - e)^(-1/2)`. A first
    /// step takes the cubic in e that is nearest to `(1 - e)^(-1/2)` there (by Remez' algorithm:
    /// 7.4e-7); then e is at most 1.5e-6, and the series `1 + e/2 + 3 e^2/8 + ...` goes on with
    /// 1e-18.
    #[inline(always)]
    fn reciprocal_sqrt(self, a: Self::F) -> Self::F {
        reciprocal_sqrt(self, a)
    }

    /// `1 / a` to a relative error of 3e-16, for `a` from 1e-37 to 1e37 in magnitude; NaN or
    /// infinite at 0.
    ///
    /// From single precision, whose `y` has a relative error of at most 1.2e-7. With `e = 1 - a y`:
    /// `1 / a = y / (1 - e) = y (1 + e + e^2 + ...)`, and the next term is at most 2e-21.
    #[inline(always)]
    fn reciprocal(self, a: Self::F) -> Self::F {
        let y = self.reciprocal_single(a);
        let e = self.neg_mul_add(a, y, self.splat(1.0));
        self.mul_add(y, self.mul_add(e, e, e), y)
    }

    /// The product of two complex numbers.
    #[inline(always)]
    fn complex_product(self, u: [Self::F; 2], v: [Self::F; 2]) -> [Self::F; 2] {
        [
            self.neg_mul_add(u[1], v[1], self.mul(u[0], v[0])),
            self.mul_add(u[0], v[1], self.mul(u[1], v[0])),
        ]
    }
}

/// See [`Arithmetic::reciprocal_sqrt`].
#[inline(always)]
pub(super) fn reciprocal_sqrt<L: Arithmetic>(l: L, a: L::F) -> L::F {
    let y = l.reciprocal_sqrt_guess(a);
    let e = l.neg_mul_add(l.mul(a, y), y, l.splat(1.0));
    let [c0, c1, c2, c3] = NEAREST;
    let p = l.mul_add(e, l.splat(c3), l.splat(c2));
    let p = l.mul_add(e, p, l.splat(c1));
    let y = l.mul(y, l.mul_add(e, p, l.splat(c0)));
    let e = l.neg_mul_add(l.mul(a, y), y, l.splat(1.0));
    let p = l.mul_add(e, l.splat(3.0 / 8.0), l.splat(0.5));
    l.mul_add(l.mul(y, e), p, y)
}

/// A vector of an instruction set: arithmetic, loads and stores of its [`WIDTH`] lanes.
pub trait Lanes: Arithmetic {
    /// Number of vectors whose operations can be interleaved in the registers: 1 or 2. Results do
    /// not depend on it.
    const AT_ONCE: usize;

    /// The first [`WIDTH`] values of a slice, which must have that many.
    fn load(self, values: &[f64]) -> Self::F;
    /// Stores into the first [`WIDTH`] places of a slice, which must have that many.
    fn store(self, lanes: Self::F, values: &mut [f64]);
    /// `a / b`.
    fn div(self, a: Self::F, b: Self::F) -> Self::F;
    /// The square root.
    fn sqrt(self, a: Self::F) -> Self::F;
    /// `a` where the sign bit of `condition` is clear, else `b`.
    fn select(self, condition: Self::F, a: Self::F, b: Self::F) -> Self::F;
    /// The larger of two numbers.
    #[inline(always)]
    fn max(self, a: Self::F, b: Self::F) -> Self::F {
        self.select(self.sub(a, b), a, b)
    }
    /// The magnitude.
    #[inline(always)]
    fn abs(self, a: Self::F) -> Self::F {
        self.select(a, a, self.sub(self.splat(0.0), a))
    }
    /// For a positive normal number `m 2^e` with m in [1, 2): m and e.
    fn mantissa_and_exponent(self, a: Self::F) -> (Self::F, Self::F);
    /// The sine and cosine of an angle, given those of the angle minus a number of quarter turns.
    /// That number, an integer, is `quarters` minus 1.5 * 2^52, so that it can be read from the low
    /// bits.
    fn turn(self, quarters: Self::F, sin: Self::F, cos: Self::F) -> (Self::F, Self::F);
    /// The minimum of the lanes: the upper half is compared with the lower half until one is left;
    /// none may be NaN.
    fn least(self, lanes: Self::F) -> f64;
    /// The sum of the lanes: the upper half is added to the lower half until one is left.
    fn sum(self, lanes: Self::F) -> f64;
    /// The first lane.
    fn first(self, lanes: Self::F) -> f64;

    /// The sine and the cosine of angles up to [`MAX_ANGLE`] in magnitude, each to 2e-16.
    #[inline(always)]
    fn sin_cos(self, angle: Self::F) -> (Self::F, Self::F) {
        sin_cos(self, angle)
    }

    /// `ln(a / b)` of positive normal numbers, to 3e-16 or a relative 3e-16, whichever is more.
    #[inline(always)]
    fn ln_ratio(self, a: Self::F, b: Self::F) -> Self::F {
        ln_ratio(self, a, b)
    }

    /// The angle in [0, pi] of the vector (x, y), y >= 0, to 4e-16; 0 for the zero vector.
    #[inline(always)]
    fn angle(self, x: Self::F, y: Self::F) -> Self::F {
        angle(self, x, y)
    }
}

/// A computation that runs with any instruction set. See [`Lanes`] for what must be inlined.
pub trait Task {
    /// Its result.
    type Output;
    /// Runs it with the vectors of `lanes`.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// Sine and cosine: the angle is brought within an eighth turn of 0 by subtracting quarter turns
/// (in two parts, the first of which is exact), then come the Taylor series, cut where the next
/// term is below 2^-56.
#[inline(always)]
pub fn sin_cos<L: Lanes>(lanes: L, angle: L::F) -> (L::F, L::F) {
    // 1.5 * 2^52: adding it rounds to an integer and leaves that integer in the low bits.
    const SHIFT: f64 = 6755399441055744.0;
    // pi/2 to twice the precision of f64.
    const QUARTER: [f64; 2] = [FRAC_PI_2, 6.123233995736766e-17];
    const SIN: [f64; 7] = taylor(3);
    const COS: [f64; 7] = taylor(4);

    let shift = lanes.splat(SHIFT);
    let shifted = lanes.mul_add(angle, lanes.splat(FRAC_2_PI), shift);
    let quarters = lanes.sub(shifted, shift);
    let x = lanes.neg_mul_add(quarters, lanes.splat(QUARTER[0]), angle);
    let x = lanes.neg_mul_add(quarters, lanes.splat(QUARTER[1]), x);
    let x2 = lanes.mul(x, x);

    let sin = lanes.mul_add(lanes.mul(x, x2), polynomial_of_seven(lanes, x2, &SIN), x);
    let tail = lanes.mul(x2, polynomial_of_seven(lanes, x2, &COS));
    let cos = lanes.mul_add(x2, lanes.sub(tail, lanes.splat(0.5)), lanes.splat(1.0));
    lanes.turn(shifted, sin, cos)
}

/// `c[0] + c[1] x + ... + c[6] x^6`, in a form with a short chain of dependent operations.
#[inline(always)]
fn polynomial_of_seven<L: Arithmetic>(l: L, x: L::F, c: &[f64; 7]) -> L::F {
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

/// `c[0] + c[1] x + ...`, even and odd powers separately: two chains of half the length.
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
    let size = l.abs(x);
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
