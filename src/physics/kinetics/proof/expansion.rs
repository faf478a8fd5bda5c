//! First-order expansions with proved remainders.

use std::ops::{Add, Mul, Sub};

/// Relative rounding of an operation on expansions: a few roundings of numbers each, and sines,
/// cosines and exponentials that are right to 8 units in the last place.
const ROUNDING: f64 = 4e-15;

/// A function of d in [-1, 1]^3 that is within `rest` of `value + slopes . d`, including rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Expansion {
    pub value: f64,
    pub slopes: [f64; 3],
    pub rest: f64,
}

impl Expansion {
    /// A number known to its rounding.
    pub fn constant(value: f64) -> Self {
        Self {
            value,
            ..Self::default()
        }
        .rounded(value.abs())
    }

    /// `value + step d_i`.
    pub fn along(value: f64, axis: usize, step: f64) -> Self {
        let mut out = Self::constant(value);
        out.slopes[axis] = step;
        out
    }

    /// Largest deviation of the linear part from `value`.
    fn sway(&self) -> f64 {
        self.slopes.iter().map(|slope| slope.abs()).sum()
    }

    /// Upper bound of its deviation from `value`.
    pub fn spread(&self) -> f64 {
        (self.sway() + self.rest) * (1.0 + ROUNDING)
    }

    /// Bounds of its values.
    pub fn range(&self) -> [f64; 2] {
        let spread = self.spread() + ROUNDING * self.value.abs();
        [self.value - spread, self.value + spread]
    }

    /// Increases its remainder.
    pub fn widened(mut self, by: f64) -> Self {
        self.rest += by;
        self
    }

    fn rounded(self, size: f64) -> Self {
        self.widened(ROUNDING * size)
    }

    /// Times a number.
    pub fn times(mut self, factor: f64) -> Self {
        self.value *= factor;
        self.slopes = self.slopes.map(|slope| slope * factor);
        self.rest *= factor.abs();
        let size = self.value.abs() + self.spread();
        self.rounded(size)
    }

    /// A function of it, by its value and slope at `self.value` and the greatest size of its second
    /// derivative over [`Self::range`]: Taylor's theorem.
    pub fn through(self, value: f64, slope: f64, curvature: f64) -> Self {
        let spread = self.spread();
        Self {
            value,
            slopes: self.slopes.map(|own| own * slope),
            rest: self.rest * slope.abs() + 0.5 * curvature * spread * spread,
        }
        .rounded(value.abs() + slope.abs() * (spread + self.value.abs()))
    }

    /// Its cosine.
    pub fn cos(self) -> Self {
        let (sin, cos) = libm::sincos(self.value);
        self.through(cos, -sin, 1.0)
    }

    /// Its sine.
    pub fn sin(self) -> Self {
        let (sin, cos) = libm::sincos(self.value);
        self.through(sin, cos, 1.0)
    }

    /// One over it; `None` if it is not proved positive.
    pub fn inverse(self) -> Option<Self> {
        let least = self.range()[0];
        (least > 0.0).then(|| {
            let one = 1.0 / self.value;
            self.through(one, -one * one, 2.0 / (least * least * least))
        })
    }

    /// Its root; `None` if it is not proved positive.
    pub fn root(self) -> Option<Self> {
        let least = self.range()[0];
        (least > 0.0).then(|| {
            let root = self.value.sqrt();
            self.through(root, 0.5 / root, 0.25 / (least * least.sqrt()))
        })
    }

    /// The exponential of -rate times it, rate >= 0.
    pub fn decay(self, rate: f64) -> Self {
        let here = libm::exp(-rate * self.value);
        let most = libm::exp(-rate * self.range()[0]);
        self.through(here, -rate * here, rate * rate * most)
    }
}

impl Add for Expansion {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slopes: std::array::from_fn(|i| self.slopes[i] + other.slopes[i]),
            rest: self.rest + other.rest,
        }
        .rounded(self.value.abs() + other.value.abs() + self.sway() + other.sway())
    }
}

impl Sub for Expansion {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self {
            value: -other.value,
            slopes: other.slopes.map(|slope| -slope),
            rest: other.rest,
        }
    }
}

impl Mul for Expansion {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.value.abs(), other.value.abs());
        let (own, its) = (self.spread(), other.spread());
        Self {
            value: self.value * other.value,
            slopes: std::array::from_fn(|i| {
                self.value * other.slopes[i] + self.slopes[i] * other.value
            }),
            rest: a * other.rest + b * self.rest + own * its,
        }
        .rounded((a + own) * (b + its))
    }
}
