//! Lengths and their logarithms as the bounds need them many times a cell: no length here comes near
//! where its square is lost, which is what `hypot` and `asinh` spend most of their time on.

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

/// `asinh(s / a)`, for `a` above 0.
pub(super) fn asinh(s: f64, a: f64) -> f64 {
    libm::log(stretch(s, a) / a)
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
                    assert!(off < 1e-15 + 1e-14 * known.abs(), "{s} {a} {off}");
                }
            }
        }
    }
}
