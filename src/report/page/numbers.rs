//! The numbers of a page, as short as it needs them.

use crate::values::positive_zero;
use physics::units::to_digits;

/// A number with `digits` significant digits, 0 if it is not finite.
pub fn rounded(value: f64, digits: usize) -> f64 {
    Some(positive_zero(to_digits(value, digits)))
        .filter(|it| it.is_finite())
        .unwrap_or(0.0)
}

/// A length (m) or an angle to 8 decimals: ten nanometres, a hundred-thousandth of a tile of 1 mm.
pub fn fixed(value: f64) -> f64 {
    let scale = 1e8;
    positive_zero((value * scale).round() / scale)
}

/// Like [`rounded`], `None` if it is not finite.
pub fn finite(value: f64, digits: usize) -> Option<f64> {
    value.is_finite().then(|| rounded(value, digits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_significant_digits() {
        assert_eq!(rounded(0.123_456_78, 4), 0.1235);
        assert_eq!(rounded(-0.0, 4).to_bits(), 0);
        assert_eq!(finite(f64::INFINITY, 4), None);
        assert_eq!(fixed(-1.3e-17).to_bits(), 0);
        assert_eq!(fixed(0.477_512_902_9), 0.477_512_9);
    }
}
