//! Integrals of e^(a . d) times polynomials over the box [-1, 1]^3.

/// Largest exponent for power series; closed forms lose digits there.
const SERIES: f64 = 2.0;
/// Terms of the series.
const TERMS: usize = 16;
/// Bound of the rounding error of a moment, relative to the moments without cancellation.
const ROUNDING: f64 = 1e-12;

/// Means over the box of e^(a . d) times 1, d_i and d_i d_j, all over e^(|a|), |a| the sum of the
/// components' sizes.
pub(super) struct Moments {
    /// |a|.
    pub scale: f64,
    /// For each axis the means of e^(a t - |a|) times 1, t and t^2 over [-1, 1].
    of: [[f64; 3]; 3],
}

impl Moments {
    pub fn new(exponents: [f64; 3]) -> Self {
        Self {
            scale: exponents.iter().map(|a| a.abs()).sum(),
            of: exponents.map(line),
        }
    }

    /// The integral of 1, rounded up.
    pub fn whole(&self) -> f64 {
        self.product([0; 3]) * (1.0 + ROUNDING)
    }

    fn product(&self, powers: [usize; 3]) -> f64 {
        (0..3).map(|i| self.of[i][powers[i]]).product()
    }

    /// Lower and upper bounds of the integral of the square of `value + slopes . d`.
    pub fn square(&self, value: f64, slopes: [f64; 3]) -> [f64; 2] {
        let mut sum = value * value * self.product([0; 3]);
        for i in 0..3 {
            let mut powers = [0; 3];
            powers[i] = 1;
            sum += 2.0 * value * slopes[i] * self.product(powers);
            powers[i] = 2;
            sum += slopes[i] * slopes[i] * self.product(powers);
            for j in 0..i {
                let mut powers = [0; 3];
                powers[i] = 1;
                powers[j] = 1;
                sum += 2.0 * slopes[i] * slopes[j] * self.product(powers);
            }
        }
        let size = value.abs() + slopes.iter().map(|slope| slope.abs()).sum::<f64>();
        let margin = ROUNDING * size * size * self.product([0; 3]);
        [(sum - margin).max(0.0), sum.max(0.0) + margin]
    }
}

/// Means over [-1, 1] of e^(a t - |a|) times 1, t and t^2.
fn line(a: f64) -> [f64; 3] {
    let size = a.abs();
    if size <= SERIES {
        let mut means = [0.0; 3];
        let mut term = 1.0;
        for k in 0..2 * TERMS {
            // a^k / k!, whose mean with t^p is that of t^(k + p).
            for (power, mean) in means.iter_mut().enumerate() {
                if (k + power).is_multiple_of(2) {
                    *mean += term / (k + power + 1) as f64;
                }
            }
            term *= a / (k + 1) as f64;
        }
        return means.map(|mean| mean * libm::exp(-size));
    }
    let far = libm::exp(-2.0 * size);
    let (sinh, cosh) = (0.5 * (1.0 - far), 0.5 * (1.0 + far));
    let zeroth = sinh / size;
    let first = (cosh - zeroth) / size;
    let second = (sinh - 2.0 * first) / size;
    [zeroth, first * a.signum(), second]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The means by Simpson's rule.
    fn summed(a: f64, power: i32) -> f64 {
        let n = 4000;
        let at = |k: i32| -1.0 + 2.0 * f64::from(k) / f64::from(n);
        let value = |k: i32| libm::exp(a * at(k) - a.abs()) * at(k).powi(power);
        let weight = |k: i32| match k {
            0 => 1.0,
            _ if k == n => 1.0,
            _ if k % 2 == 1 => 4.0,
            _ => 2.0,
        };
        (0..=n).map(|k| weight(k) * value(k)).sum::<f64>() / (3.0 * f64::from(n))
    }

    #[test]
    fn means_along_a_line_are_integrals() {
        for a in [-30.0, -2.1, -1.9, -1e-9, 0.0, 0.3, 1.999, 2.001, 11.0] {
            for (power, mean) in line(a).into_iter().enumerate() {
                let other = summed(a, power as i32);
                assert!((mean - other).abs() < 1e-9, "{a} {power}: {mean} {other}");
            }
        }
    }

    #[test]
    fn squares_are_those_of_their_parts() {
        let a = [0.7, -3.0, 0.0];
        let moments = Moments::new(a);
        let [low, high] = moments.square(0.4, [1.0, -0.3, 0.2]);
        let mean = |i: usize, power| summed(a[i], power);
        let m = |i: usize| mean(i, 1) / mean(i, 0);
        let s = |i: usize| mean(i, 2) / mean(i, 0);
        let slopes = [1.0, -0.3, 0.2];
        let mut sum = 0.4 * 0.4;
        for i in 0..3 {
            sum += 0.8 * slopes[i] * m(i) + slopes[i] * slopes[i] * s(i);
            for j in 0..i {
                sum += 2.0 * slopes[i] * slopes[j] * m(i) * m(j);
            }
        }
        let exact = sum * (0..3).map(|i| mean(i, 0)).product::<f64>();
        assert!(low <= exact + 1e-10 && exact <= high + 1e-10 && high - low < 1e-9);
        assert!((moments.whole() - (0..3).map(|i| mean(i, 0)).product::<f64>()).abs() < 1e-9);
    }
}
