//! Plain Rust, for every machine.

use super::lanes::{Arithmetic, Lanes};

/// Four lanes in plain Rust, without fused operations (which are slow where the CPU lacks them).
#[derive(Clone, Copy, Debug)]
pub struct Portable;

impl Portable {
    #[inline(always)]
    fn zip(a: [f64; 4], b: [f64; 4], f: impl Fn(f64, f64) -> f64) -> [f64; 4] {
        [f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2]), f(a[3], b[3])]
    }
}

impl Arithmetic for Portable {
    type F = [f64; 4];
    const ESTIMATE_IS_EXACT: bool = true;

    #[inline(always)]
    fn splat(self, value: f64) -> [f64; 4] {
        [value; 4]
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
    fn min(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        Self::zip(a, b, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn reciprocal_sqrt_estimate(self, a: [f64; 4]) -> [f64; 4] {
        a.map(|a| 1.0 / a.sqrt())
    }

    #[inline(always)]
    fn reciprocal_estimate(self, a: [f64; 4]) -> [f64; 4] {
        a.map(|a| 1.0 / a)
    }
}

impl Lanes for Portable {
    const WIDTH: usize = 4;

    #[inline(always)]
    fn load(self, values: &[f64]) -> [f64; 4] {
        [values[0], values[1], values[2], values[3]]
    }

    #[inline(always)]
    fn store(self, lanes: [f64; 4], values: &mut [f64]) {
        values[..4].copy_from_slice(&lanes);
    }

    #[inline(always)]
    fn sin_cos(self, angle: [f64; 4]) -> ([f64; 4], [f64; 4]) {
        (angle.map(f64::sin), angle.map(f64::cos))
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
}
