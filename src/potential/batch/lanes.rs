//! Vectors of f64 lanes for the instruction sets the kernels run on.
//!
//! A [`Lanes`] value is a proof that the CPU has the instruction set, so that arithmetic with it
//! is safe to call. The kernels are written once, generic over it, and compiled once for each
//! instruction set by [`Level::run`].

use std::fmt;

/// Arithmetic on `WIDTH` f64 lanes at once.
///
/// Every operation is lane by lane: a lane's result depends on that lane's operands alone.
pub trait Lanes: Copy {
    /// A vector of `WIDTH` lanes.
    type F: Copy;
    const WIDTH: usize;

    fn splat(self, value: f64) -> Self::F;
    /// The first `WIDTH` values of a slice, which must have that many.
    fn load(self, values: &[f64]) -> Self::F;
    /// Into the first `WIDTH` places of a slice, which must have that many.
    fn store(self, lanes: Self::F, values: &mut [f64]);
    fn add(self, a: Self::F, b: Self::F) -> Self::F;
    fn sub(self, a: Self::F, b: Self::F) -> Self::F;
    fn mul(self, a: Self::F, b: Self::F) -> Self::F;
    /// `a b + c`; rounded once where the instruction set fuses it.
    fn mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    /// `c - a b`; rounded once where the instruction set fuses it.
    fn neg_mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    fn div(self, a: Self::F, b: Self::F) -> Self::F;
    fn sqrt(self, a: Self::F) -> Self::F;
    /// `a` where the sign bit of `condition` is clear, else `b`.
    fn select(self, condition: Self::F, a: Self::F, b: Self::F) -> Self::F;
    /// For a positive normal number `m 2^e` with m in [1, 2): m and e.
    fn mantissa_and_exponent(self, a: Self::F) -> (Self::F, Self::F);
    /// The smaller of two numbers; `b` where either is NaN.
    fn min(self, a: Self::F, b: Self::F) -> Self::F;
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
    /// The least of the lanes.
    #[inline(always)]
    fn least(self, lanes: Self::F) -> f64 {
        let mut values = [f64::INFINITY; MAX_WIDTH];
        self.store(lanes, &mut values);
        values.into_iter().fold(f64::INFINITY, f64::min)
    }
    /// `1 / sqrt(a)` to a relative error of 1e-13, for `a` from 1e-37 to 1e37; NaN or infinite
    /// at 0.
    fn reciprocal_sqrt(self, a: Self::F) -> Self::F;
    /// The sine and the cosine of angles up to [`MAX_ANGLE`] in magnitude, each to 2e-16.
    fn sin_cos(self, angle: Self::F) -> (Self::F, Self::F);
}

/// The most lanes any instruction set has.
pub const MAX_WIDTH: usize = 8;

/// The largest angle (rad) that [`Lanes::sin_cos`] takes.
pub const MAX_ANGLE: f64 = 1e5;

/// Something to be computed with whichever instruction set there is.
///
/// `run` and all it calls that has to do with vectors must be `#[inline(always)]`, or the
/// instruction set does not reach it. That excludes closures on vectors, and `map` on arrays of
/// them.
pub trait Task {
    type Output;
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// An instruction set this machine has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level(Kind);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2(super::x86::Avx2),
    #[cfg(target_arch = "x86_64")]
    Avx512(super::x86::Avx512),
}

impl Level {
    /// Plain Rust, four lanes, on every machine.
    pub const PORTABLE: Self = Self(Kind::Portable);

    /// What this machine has, slowest first.
    pub fn available() -> Vec<Self> {
        let mut levels = vec![Self::PORTABLE];
        #[cfg(target_arch = "x86_64")]
        {
            levels.extend(super::x86::Avx2::detect().map(|lanes| Self(Kind::Avx2(lanes))));
            levels.extend(super::x86::Avx512::detect().map(|lanes| Self(Kind::Avx512(lanes))));
        }
        levels
    }

    /// The fastest this machine has.
    pub fn best() -> Self {
        Self::available().pop().unwrap_or(Self::PORTABLE)
    }

    /// How many f64 lanes a vector has.
    pub fn width(self) -> usize {
        match self.0 {
            Kind::Portable => Portable::WIDTH,
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2(_) => super::x86::Avx2::WIDTH,
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512(_) => super::x86::Avx512::WIDTH,
        }
    }

    /// Runs a task compiled for this instruction set.
    #[inline]
    pub fn run<T: Task>(self, task: T) -> T::Output {
        match self.0 {
            Kind::Portable => task.run(Portable),
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2(lanes) => lanes.run(task),
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512(lanes) => lanes.run(task),
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.0 {
            Kind::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2(_) => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512(_) => "AVX-512",
        })
    }
}

/// Four lanes in plain Rust, without fused operations (which are slow where the CPU lacks them).
#[derive(Clone, Copy, Debug)]
pub struct Portable;

impl Portable {
    #[inline(always)]
    fn zip(a: [f64; 4], b: [f64; 4], f: impl Fn(f64, f64) -> f64) -> [f64; 4] {
        [f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2]), f(a[3], b[3])]
    }
}

impl Lanes for Portable {
    type F = [f64; 4];
    const WIDTH: usize = 4;

    #[inline(always)]
    fn splat(self, value: f64) -> [f64; 4] {
        [value; 4]
    }

    #[inline(always)]
    fn load(self, values: &[f64]) -> [f64; 4] {
        [values[0], values[1], values[2], values[3]]
    }

    #[inline(always)]
    fn store(self, lanes: [f64; 4], values: &mut [f64]) {
        values[..4].copy_from_slice(&lanes);
    }

    #[inline(always)]
    fn add(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        Self::zip(a, b, |a, b| a + b)
    }

    #[inline(always)]
    fn sub(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        Self::zip(a, b, |a, b| a - b)
    }

    #[inline(always)]
    fn mul(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        Self::zip(a, b, |a, b| a * b)
    }

    #[inline(always)]
    fn mul_add(self, a: [f64; 4], b: [f64; 4], c: [f64; 4]) -> [f64; 4] {
        self.add(self.mul(a, b), c)
    }

    #[inline(always)]
    fn neg_mul_add(self, a: [f64; 4], b: [f64; 4], c: [f64; 4]) -> [f64; 4] {
        self.sub(c, self.mul(a, b))
    }

    #[inline(always)]
    fn div(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        Self::zip(a, b, |a, b| a / b)
    }

    #[inline(always)]
    fn sqrt(self, a: [f64; 4]) -> [f64; 4] {
        a.map(f64::sqrt)
    }

    #[inline(always)]
    fn select(self, condition: [f64; 4], a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        std::array::from_fn(|i| {
            if condition[i].is_sign_positive() {
                a[i]
            } else {
                b[i]
            }
        })
    }

    #[inline(always)]
    fn mantissa_and_exponent(self, a: [f64; 4]) -> ([f64; 4], [f64; 4]) {
        const MANTISSA: u64 = (1 << 52) - 1;
        (
            a.map(|a| f64::from_bits(a.to_bits() & MANTISSA | 1.0f64.to_bits())),
            a.map(|a| (a.to_bits() >> 52) as f64 - 1023.0),
        )
    }

    #[inline(always)]
    fn min(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        Self::zip(a, b, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn reciprocal_sqrt(self, a: [f64; 4]) -> [f64; 4] {
        a.map(|a| 1.0 / a.sqrt())
    }

    #[inline(always)]
    fn sin_cos(self, angle: [f64; 4]) -> ([f64; 4], [f64; 4]) {
        (angle.map(f64::sin), angle.map(f64::cos))
    }
}
