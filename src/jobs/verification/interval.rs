//! Interval arithmetic, rounded outwards, and functions of one variable with their first two
//! derivatives over an interval of it.

use std::ops::{Add, Mul, Neg, Sub};

/// All numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    pub low: f64,
    pub high: f64,
}

impl Interval {
    /// A single number.
    pub const fn of(x: f64) -> Self {
        Self { low: x, high: x }
    }

    pub const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    fn rounded(low: f64, high: f64) -> Self {
        Self {
            low: low.next_down(),
            high: high.next_up(),
        }
    }

    /// The middle.
    pub fn middle(self) -> f64 {
        0.5 * (self.low + self.high)
    }

    /// All numbers within `by` of these.
    fn widened(self, by: f64) -> Self {
        Self::rounded(self.low - by, self.high + by)
    }

    /// The squares, none of which is negative.
    pub fn squared(self) -> Self {
        let [a, b] = [self.low * self.low, self.high * self.high];
        let low = if self.low <= 0.0 && self.high >= 0.0 {
            0.0
        } else {
            a.min(b).next_down().max(0.0)
        };
        Self::new(low, a.max(b).next_up())
    }

    /// One over these positive numbers; up to infinity if 0 may be among them.
    pub fn inverted(self) -> Self {
        let high = match self.low > 0.0 {
            true => (1.0 / self.low).next_up(),
            false => f64::INFINITY,
        };
        Self::new((1.0 / self.high).next_down().max(0.0), high)
    }

    /// The roots of these numbers, none of which is negative.
    pub fn root(self) -> Self {
        let low = self.low.max(0.0).sqrt().next_down().max(0.0);
        Self::new(low, self.high.max(0.0).sqrt().next_up())
    }

    /// Sines and cosines: those of the middle, changed by no more than the angle.
    pub fn sine_and_cosine(self) -> [Self; 2] {
        let middle = self.middle();
        let half = 0.5 * (self.high - self.low) + 4.0 * f64::EPSILON * (1.0 + middle.abs());
        let near = |x: f64| {
            let near = Self::of(x).widened(half);
            Self::new(near.low.max(-1.0), near.high.min(1.0))
        };
        [near(libm::sin(middle)), near(libm::cos(middle))]
    }

    /// 1 / (1 + exp(-x)).
    fn logistic(self) -> Self {
        let of = |x: f64| 1.0 / (1.0 + libm::exp(-x));
        Self::new(of(self.low), of(self.high)).widened(4.0 * f64::EPSILON)
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::rounded(self.low + other.low, self.high + other.high)
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.high, -self.low)
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        // Nothing times what may be infinite is nothing.
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let [a, b, c, d] = [
            product(self.low, other.low),
            product(self.low, other.high),
            product(self.high, other.low),
            product(self.high, other.high),
        ];
        Self::rounded(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }
}

/// A function of one variable over an interval of it: its values and its first two derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    pub value: Interval,
    pub first: Interval,
    pub second: Interval,
}

impl Jet {
    /// A constant.
    pub const fn of(x: f64) -> Self {
        Self::within(Interval::of(x))
    }

    /// A constant that is one of these numbers.
    pub const fn within(value: Interval) -> Self {
        Self {
            value,
            first: Interval::of(0.0),
            second: Interval::of(0.0),
        }
    }

    /// What is `from` at 0 and `to` at 1, and linear.
    pub fn linear(from: f64, to: f64, t: Interval) -> Self {
        let rise = Interval::of(to) - Interval::of(from);
        Self {
            value: Interval::of(from) + t * rise,
            first: rise,
            second: Interval::of(0.0),
        }
    }

    /// A function of this, given with its derivatives at the values of this.
    pub fn composed(self, [f, df, ddf]: [Interval; 3]) -> Self {
        Self {
            value: f,
            first: df * self.first,
            second: ddf * self.first.squared() + df * self.second,
        }
    }

    pub fn sine_and_cosine(self) -> [Self; 2] {
        let [sine, cosine] = self.value.sine_and_cosine();
        [
            self.composed([sine, cosine, -sine]),
            self.composed([cosine, -sine, -cosine]),
        ]
    }

    pub fn squared(self) -> Self {
        let two = Interval::of(2.0);
        self.composed([self.value.squared(), two * self.value, two])
    }

    /// One over an odd power of the root of this: `self^(-k / 2)` for k of 1, 3 or 5.
    pub fn over_root(self, k: u8) -> Self {
        let inverse = self.value.inverted();
        let mut power = inverse.root();
        for _ in 0..k / 2 {
            power = power * inverse;
        }
        let half = f64::from(k) / 2.0;
        let first = Interval::of(-half) * power * inverse;
        let second = Interval::of(half * (half + 1.0)) * power * inverse.squared();
        self.composed([power, first, second])
    }

    /// One over this positive number.
    pub fn inverted(self) -> Self {
        let inverse = self.value.inverted();
        let square = inverse.squared();
        let second = Interval::of(2.0) * square * inverse;
        self.composed([inverse, -square, second])
    }

    /// 1 / (1 + exp(-x)).
    pub fn logistic(self) -> Self {
        let one = Interval::of(1.0);
        let value = self.value.logistic();
        let first = value * (one - value);
        let second = first * (one - (value + value));
        self.composed([value, first, second])
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            first: self.first + other.first,
            second: self.second + other.second,
        }
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + other * Self::of(-1.0)
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let cross = self.first * other.first;
        Self {
            value: self.value * other.value,
            first: self.first * other.value + self.value * other.first,
            second: self.second * other.value + (cross + cross) + self.value * other.second,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_enclose_differences() {
        let f = |t: Interval| {
            let x = Jet::linear(0.3, 1.7, t);
            let [sine, cosine] = x.sine_and_cosine();
            let size = (x.squared() + Jet::of(0.1)).over_root(3);
            sine * size + cosine.logistic() * x.inverted()
        };
        for (low, high) in [(0.0, 0.0), (0.2, 0.3), (0.0, 1.0)] {
            let all = f(Interval::new(low, high));
            for k in 0..=4 {
                let t = low + (high - low) * f64::from(k) / 4.0;
                let at = |t: f64| f(Interval::of(t)).value.middle();
                let h = 1e-4;
                let [a, b, c] = [at(t - h), at(t), at(t + h)];
                let holds = |all: Interval, x: f64, by: f64| {
                    assert!(all.low - by <= x && x <= all.high + by, "{all:?} {x}");
                };
                holds(all.value, b, 0.0);
                holds(all.first, (c - a) / (2.0 * h), 1e-5);
                holds(all.second, (c - 2.0 * b + a) / (h * h), 1e-3);
            }
        }
    }
}
