//! Plain interval arithmetic: every bound is rounded outwards by one unit in the last place, which
//! is more than the rounding of IEEE 754 operations.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// All numbers from the first to the second.
#[derive(Clone, Copy, Debug)]
pub struct Interval(f64, f64);

impl Interval {
    pub fn of(number: f64) -> Self {
        Self(number, number)
    }

    /// From `-x` to `x`.
    pub fn around_zero(x: f64) -> Self {
        Self(-x, x)
    }

    pub fn least(self) -> f64 {
        self.0
    }

    pub fn most(self) -> f64 {
        self.1
    }

    /// The roots of those numbers that have one.
    pub fn sqrt(self) -> Self {
        Self::outwards([self.0.max(0.0).sqrt(), self.1.max(0.0).sqrt()])
    }

    /// Around all these numbers; everything if one of them is none.
    fn outwards<const N: usize>(all: [f64; N]) -> Self {
        if all.iter().any(|x| x.is_nan()) {
            return Self::around_zero(f64::INFINITY);
        }
        let least = all.into_iter().fold(f64::INFINITY, f64::min);
        let most = all.into_iter().fold(f64::NEG_INFINITY, f64::max);
        Self(least.next_down(), most.next_up())
    }
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::outwards([self.0 + other.0, self.1 + other.1])
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::outwards([self.0 - other.1, self.1 - other.0])
    }
}

impl Neg for Interval {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.1, -self.0)
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (a, b) = ([self.0, self.1], [other.0, other.1]);
        Self::outwards([a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]])
    }
}

impl Div for Interval {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        if other.0 <= 0.0 && 0.0 <= other.1 {
            return Self::around_zero(f64::INFINITY);
        }
        let (a, b) = ([self.0, self.1], [other.0, other.1]);
        Self::outwards([a[0] / b[0], a[0] / b[1], a[1] / b[0], a[1] / b[1]])
    }
}
