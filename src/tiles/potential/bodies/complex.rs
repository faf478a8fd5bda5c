//! Complex numbers in lanes, with the same bits on every machine.

use crate::potential::simd::lanes::Lanes;

/// The smallest height over a face's plane, in metres: a point in the plane is treated as right above
/// it, and complex heights have a side.
pub const LEAST: f64 = 1e-150;

/// A complex number in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Z<F> {
    pub re: F,
    pub im: F,
}

/// Arithmetic on them.
pub trait Complexes: Lanes {
    /// The same value in all lanes.
    #[inline(always)]
    fn z_splat(self, re: f64, im: f64) -> Z<Self::F> {
        Z {
            re: self.splat(re),
            im: self.splat(im),
        }
    }
    /// `a + b`.
    #[inline(always)]
    fn z_add(self, a: Z<Self::F>, b: Z<Self::F>) -> Z<Self::F> {
        Z {
            re: self.add(a.re, b.re),
            im: self.add(a.im, b.im),
        }
    }
    /// `a - b`.
    #[inline(always)]
    fn z_sub(self, a: Z<Self::F>, b: Z<Self::F>) -> Z<Self::F> {
        Z {
            re: self.sub(a.re, b.re),
            im: self.sub(a.im, b.im),
        }
    }
    /// `a b`.
    #[inline(always)]
    fn z_mul(self, a: Z<Self::F>, b: Z<Self::F>) -> Z<Self::F> {
        let [re, im] = self.complex_product([b.re, b.im], [a.re, a.im]);
        Z { re, im }
    }
    /// `a b + c`.
    #[inline(always)]
    fn z_mul_add(self, a: Z<Self::F>, b: Z<Self::F>, c: Z<Self::F>) -> Z<Self::F> {
        self.z_add(self.z_mul(a, b), c)
    }
    /// `a` times a real number.
    #[inline(always)]
    fn z_times(self, a: Z<Self::F>, b: Self::F) -> Z<Self::F> {
        Z {
            re: self.mul(a.re, b),
            im: self.mul(a.im, b),
        }
    }
    /// `|a|^2`.
    #[inline(always)]
    fn z_norm(self, a: Z<Self::F>) -> Self::F {
        self.mul_add(a.im, a.im, self.mul(a.re, a.re))
    }
    /// `1 / a`.
    #[inline(always)]
    fn z_inverse(self, a: Z<Self::F>) -> Z<Self::F> {
        let share = self.div(self.splat(1.0), self.z_norm(a));
        Z {
            re: self.mul(a.re, share),
            im: self.mul(self.sub(self.splat(0.0), a.im), share),
        }
    }
    /// `a / b`.
    #[inline(always)]
    fn z_div(self, a: Z<Self::F>, b: Z<Self::F>) -> Z<Self::F> {
        self.z_mul(a, self.z_inverse(b))
    }
    /// `a` where the sign bit of `condition` is clear, else `b`.
    #[inline(always)]
    fn z_select(self, condition: Self::F, a: Z<Self::F>, b: Z<Self::F>) -> Z<Self::F> {
        Z {
            re: self.select(condition, a.re, b.re),
            im: self.select(condition, a.im, b.im),
        }
    }
    /// 1 with the sign of a number.
    #[inline(always)]
    fn sign(self, a: Self::F) -> Self::F {
        self.select(a, self.splat(1.0), self.splat(-1.0))
    }
    /// The square root with a real part that is not negative.
    #[inline(always)]
    fn z_sqrt(self, a: Z<Self::F>) -> Z<Self::F> {
        let (zero, half) = (self.splat(0.0), self.splat(0.5));
        let length = self.sqrt(self.z_norm(a));
        let large = self.sqrt(self.mul(self.add(length, self.abs(a.re)), half));
        // The root of 0 is 0.
        let twice = self.max(self.add(large, large), self.splat(f64::MIN_POSITIVE));
        let small = self.div(a.im, twice);
        let across = self.select(a.im, large, self.sub(zero, large));
        Z {
            re: self.select(a.re, large, self.abs(small)),
            im: self.select(a.re, small, across),
        }
    }
    /// The logarithm of `a / b`, with an imaginary part from -pi to pi.
    #[inline(always)]
    fn z_ln_ratio(self, a: Z<Self::F>, b: Z<Self::F>) -> Z<Self::F> {
        // a times the conjugate of b has the argument of the ratio.
        let across = self.neg_mul_add(a.re, b.im, self.mul(a.im, b.re));
        let along = self.mul_add(a.im, b.im, self.mul(a.re, b.re));
        let angle = self.angle(along, self.abs(across));
        let ln = self.ln_ratio(self.z_norm(a), self.z_norm(b));
        Z {
            re: self.mul(ln, self.splat(0.5)),
            im: self.mul(angle, self.sign(across)),
        }
    }
}

impl<L: Lanes> Complexes for L {}
