//! Fast lengths and logarithms for the bounds, which need them many times per cell. No length is so
//! small that its square underflows, a case that `hypot` and `asinh` spend most of their time on,
//! and a few digits of a logarithm with a known error suffice.

/// `sqrt(a^2 + b^2)`.
pub(super) fn hypotenuse(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

/// `a e^(asinh(s / a))`, for `a` above 0: `s + sqrt(s^2 + a^2)`, without cancelling.
pub(super) fn stretch(s: f64, a: f64) -> f64 {
    let root = hypotenuse(s, a);
    if s < 0.0 {
        a * a / (root - s)
    } else {
        root + s
    }
}

/// The natural logarithm of a positive normal number, to [`LN_ERROR`].
///
/// For `m 2^e`, m from 1/sqrt(2) to sqrt(2): `e ln 2 + 2 (s + s^3/3 + s^5/5 + s^7/7)`,
/// `s = (m - 1) / (m + 1)`; the next term is at most 2.9e-8.
pub(super) fn ln(x: f64) -> f64 {
    const MANTISSA: u64 = (1 << 52) - 1;
    // The bits of 1 / sqrt(2) become those of 1, so that the exponent counts from there.
    const START: u64 = std::f64::consts::FRAC_1_SQRT_2.to_bits();
    let above = x.to_bits().wrapping_sub(START);
    let exponent = (above as i64) >> 52;
    let m = f64::from_bits((above & MANTISSA).wrapping_add(START));
    let s = (m - 1.0) / (m + 1.0);
    let q = s * s;
    let series = 2.0 * s * (1.0 + q * (1.0 / 3.0 + q * (0.2 + q * (1.0 / 7.0))));
    exponent as f64 * std::f64::consts::LN_2 + series
}

/// The error of [`ln`].
pub(super) const LN_ERROR: f64 = 3e-8;

/// `asinh(s / a)`, for `a` above 0, to [`LN_ERROR`].
pub(super) fn asinh(s: f64, a: f64) -> f64 {
    ln(stretch(s, a) / a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_are_those_of_the_standard_library() {
        for s in [0.0, 1e-9, 1e-5, 0.003, 0.7, 20.0] {
            for a in [1e-9, 1e-6, 0.001, 0.4] {
                assert!((hypotenuse(s, a) / libm::hypot(s, a) - 1.0).abs() < 1e-15);
                for s in [-s, s] {
                    let known = libm::asinh(s / a);
                    let off = (asinh(s, a) - known).abs();
                    assert!(off < LN_ERROR, "{s} {a} {off}");
                }
            }
        }
    }

    #[test]
    fn the_logarithm_is_as_good_as_it_says() {
        let mut worst: f64 = 0.0;
        for k in -4000..4000 {
            let x = libm::exp(f64::from(k) * 0.011_3);
            worst = worst.max((ln(x) - libm::log(x)).abs());
        }
        assert!(worst < LN_ERROR && worst > 0.5 * LN_ERROR, "{worst}");
        assert_eq!(ln(1.0), 0.0);
    }
}
