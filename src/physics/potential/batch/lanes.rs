//! Vectors of f64 lanes, whatever the instruction set.

use super::elementary::{angle, ln_ratio};
use super::sin_cos::sin_cos;

/// How many f64 lanes a vector has, with every instruction set: so all sum in one order and give the
/// same bits.
pub const WIDTH: usize = 8;

/// The largest angle (rad) that [`Lanes::sin_cos`] takes.
pub const MAX_ANGLE: f64 = 1e5;

/// See [`Arithmetic::reciprocal_sqrt_guess`]; of all it leaves the least error.
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
/// All functions are `#[inline(always)]`, and so must be all that uses them, for only what is
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
    /// For positive numbers, the number whose bits are [`GUESS`] less half those of `a`: `1 / sqrt(a)`
    /// to 3.5 %, as halving a number's bits halves its exponent.
    fn reciprocal_sqrt_guess(self, a: Self::F) -> Self::F;
    /// `1 / a` in single precision.
    fn reciprocal_single(self, a: Self::F) -> Self::F;

    /// `1 / sqrt(a)` to a relative error of 4e-16, for positive normal `a`; at 0 a number above 1e150.
    ///
    /// The processors' own estimates of it differ between makers, so it starts from a guess `y` with,
    /// `e = 1 - a y^2`, `|e| <= 0.0682`, of which `a^(-1/2) = y (1 - e)^(-1/2)`. A first step takes
    /// the cubic in e that is nearest to `(1 - e)^(-1/2)` there (by Remez' algorithm: 7.4e-7); then
    /// e is at most 1.5e-6, and the series `1 + e/2 + 3 e^2/8 + ...` goes on with 1e-18.
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

/// A vector of an instruction set: arithmetic on its [`WIDTH`] lanes, and their way in and out.
pub trait Lanes: Arithmetic {
    /// How many vectors' operations the registers have room to interleave: 1 or 2. Results do not
    /// depend on it.
    const AT_ONCE: usize;

    /// The first [`WIDTH`] values of a slice, which must have that many.
    fn load(self, values: &[f64]) -> Self::F;
    /// Into the first [`WIDTH`] places of a slice, which must have that many.
    fn store(self, lanes: Self::F, values: &mut [f64]);
    /// `a / b`.
    fn div(self, a: Self::F, b: Self::F) -> Self::F;
    /// The square root.
    fn sqrt(self, a: Self::F) -> Self::F;
    /// `a` where the sign bit of `condition` is clear, else `b`.
    fn select(self, condition: Self::F, a: Self::F, b: Self::F) -> Self::F;
    /// For a positive normal number `m 2^e` with m in [1, 2): m and e.
    fn mantissa_and_exponent(self, a: Self::F) -> (Self::F, Self::F);
    /// The sine and cosine of an angle, given those of the angle less a number of quarter turns.
    /// That number, an integer, is `quarters` less 1.5 * 2^52, so that it can be read from the low
    /// bits.
    fn turn(self, quarters: Self::F, sin: Self::F, cos: Self::F) -> (Self::F, Self::F);
    /// The least of the lanes, each of the upper half against its fellow in the lower half until
    /// one is left; none may be NaN.
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

/// Something to be computed with whichever instruction set there is. See [`Lanes`] for what must
/// be inlined.
pub trait Task {
    /// What comes of it.
    type Output;
    /// Does it, with the vectors of `lanes`.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}
