//! Vectors of f64 lanes, whatever the instruction set.

/// The most lanes any instruction set has.
pub const MAX_WIDTH: usize = 8;

/// The largest angle (rad) that [`Lanes::sin_cos`] takes.
pub const MAX_ANGLE: f64 = 1e5;

/// Arithmetic on many f64 lanes at once.
///
/// A value of such a type is the proof that the CPU has the instruction set, so that arithmetic
/// with it is safe. Every operation is lane by lane: a lane's result depends on that lane's
/// operands alone.
///
/// All functions are `#[inline(always)]`, and so must be all that uses them, for only what is
/// inlined into [`Task::run`] is compiled for the instruction set. That excludes closures on
/// vectors, and `map` on arrays of them.
pub trait Arithmetic: Copy {
    /// The lanes.
    type F: Copy;
    /// Whether the estimates are as good as f64 is.
    const ESTIMATE_IS_EXACT: bool;

    /// The same value in all lanes.
    fn splat(self, value: f64) -> Self::F;
    /// `a + b`.
    fn add(self, a: Self::F, b: Self::F) -> Self::F;
    /// `a - b`.
    fn sub(self, a: Self::F, b: Self::F) -> Self::F;
    /// `a b`.
    fn mul(self, a: Self::F, b: Self::F) -> Self::F;
    /// `a b + c`; rounded once where the instruction set fuses it.
    fn mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    /// `c - a b`; rounded once where the instruction set fuses it.
    fn neg_mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    /// The smaller of two numbers; `b` where either is NaN.
    fn min(self, a: Self::F, b: Self::F) -> Self::F;
    /// An estimate of `1 / sqrt(a)` for [`Arithmetic::reciprocal_sqrt`] to refine.
    fn reciprocal_sqrt_estimate(self, a: Self::F) -> Self::F;
    /// An estimate of `1 / a` for [`Arithmetic::reciprocal`] to refine.
    fn reciprocal_estimate(self, a: Self::F) -> Self::F;

    /// `1 / sqrt(a)` to a relative error of 1e-13, for `a` from 1e-37 to 1e37; NaN or infinite
    /// at 0.
    ///
    /// From an estimate `y`, with `e = 1 - a y^2`:
    /// `a^(-1/2) = y (1 - e)^(-1/2) = y (1 + e/2 + 3 e^2/8 + 5 e^3/16 + ...)`.
    /// The terms up to `e^3` leave a relative error of `35 e^4 / 128`: 8e-14 for an estimate good
    /// to 1.5 / 2^12 and 6e-17 for one good to 1 / 2^14.
    #[inline(always)]
    fn reciprocal_sqrt(self, a: Self::F) -> Self::F {
        let y = self.reciprocal_sqrt_estimate(a);
        if Self::ESTIMATE_IS_EXACT {
            return y;
        }
        let e = self.neg_mul_add(self.mul(a, y), y, self.splat(1.0));
        let p = self.mul_add(e, self.splat(5.0 / 16.0), self.splat(3.0 / 8.0));
        let p = self.mul_add(e, p, self.splat(0.5));
        self.mul_add(self.mul(y, e), p, y)
    }

    /// `1 / a` to a relative error of 1e-13, for `a` from 1e-37 to 1e37 in magnitude; NaN or
    /// infinite at 0.
    ///
    /// From an estimate `y`, with `e = 1 - a y`: `1 / a = y / (1 - e) = y (1 + e + e^2 + e^3 + ...)`,
    /// whose next term is at most 2e-14 for an estimate good to 1.5 / 2^12.
    #[inline(always)]
    fn reciprocal(self, a: Self::F) -> Self::F {
        let y = self.reciprocal_estimate(a);
        if Self::ESTIMATE_IS_EXACT {
            return y;
        }
        let e = self.neg_mul_add(a, y, self.splat(1.0));
        let p = self.mul_add(e, e, e);
        self.mul_add(y, self.mul_add(e, p, e), y)
    }
}

/// A vector of an instruction set: arithmetic on its `WIDTH` lanes, and their way in and out.
pub trait Lanes: Arithmetic {
    /// How many numbers a vector holds.
    const WIDTH: usize;

    /// The first `WIDTH` values of a slice, which must have that many.
    fn load(self, values: &[f64]) -> Self::F;
    /// Into the first `WIDTH` places of a slice, which must have that many.
    fn store(self, lanes: Self::F, values: &mut [f64]);
    /// The sine and the cosine of angles up to [`MAX_ANGLE`] in magnitude, each to 2e-16.
    fn sin_cos(self, angle: Self::F) -> (Self::F, Self::F);

    /// `a / b`, correctly rounded.
    fn div(self, a: Self::F, b: Self::F) -> Self::F;
    /// The square root, correctly rounded.
    fn sqrt(self, a: Self::F) -> Self::F;
    /// `a` where the sign bit of `condition` is clear, else `b`.
    fn select(self, condition: Self::F, a: Self::F, b: Self::F) -> Self::F;
    /// For a positive normal number `m 2^e` with m in [1, 2): m and e.
    fn mantissa_and_exponent(self, a: Self::F) -> (Self::F, Self::F);

    /// The least of the lanes.
    #[inline(always)]
    fn least(self, lanes: Self::F) -> f64 {
        let mut values = [f64::INFINITY; MAX_WIDTH];
        self.store(lanes, &mut values);
        values.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The first lane.
    #[inline(always)]
    fn first(self, lanes: Self::F) -> f64 {
        let mut values = [0.0; MAX_WIDTH];
        self.store(lanes, &mut values);
        values[0]
    }

    /// The sum of the lanes: the upper half is added to the lower half until one is left.
    #[inline(always)]
    fn sum(self, lanes: Self::F) -> f64 {
        let mut values = [0.0; MAX_WIDTH];
        self.store(lanes, &mut values);
        let mut width = Self::WIDTH / 2;
        while width > 0 {
            for i in 0..width {
                values[i] += values[i + width];
            }
            width /= 2;
        }
        values[0]
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
