//! Physical constants and the printing of quantities with SI prefixes.

use std::f64::consts::PI;

/// Magnetic constant mu0 (T m / A), the conventional value 4 pi 1e-7. (The measured value of
/// CODATA 2018 differs from it by 5.5e-10, far below what is known of any magnet.)
pub const MU0: f64 = 4.0e-7 * PI;

/// `mu0 / (4 pi)` (T m / A), the factor of Coulomb's law between magnetic charges and of the energy
/// between dipoles.
pub const MU0_OVER_4PI: f64 = MU0 / (4.0 * PI);

/// What SI prefixes stand for, ascending.
const PREFIXES: [(f64, &str); 6] = [
    (1e-12, "p"),
    (1e-9, "n"),
    (1e-6, "µ"),
    (1e-3, "m"),
    (1.0, ""),
    (1e3, "k"),
];

/// A quantity with an SI prefix, `digits` significant digits and its unit: `-65.47 mJ`. Zero and
/// what is not finite have no prefix.
pub fn si(value: f64, unit: &str, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{} {unit}", value + 0.0);
    }
    let (scale, prefix, decimals) = prefix_and_decimals(value.abs(), digits);
    format!("{:.decimals$} {prefix}{unit}", value / scale)
}

/// Two quantities with one SI prefix and unit between them, each with `digits` significant digits
/// of the larger one that is finite: `14.54 to 15.19 mJ`.
pub fn si_range(low: f64, high: f64, unit: &str, digits: usize) -> String {
    let sizes = [low, high].map(f64::abs).into_iter();
    let size = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
    if size == 0.0 {
        return format!("{} to {} {unit}", low + 0.0, high + 0.0);
    }
    let (scale, prefix, decimals) = prefix_and_decimals(size, digits);
    let [low, high] = [low / scale, high / scale];
    format!("{low:.decimals$} to {high:.decimals$} {prefix}{unit}")
}

/// The SI prefix with which a quantity of this size (finite, above zero), rounded to `digits`
/// significant digits, is printed below 1000: what it stands for, the prefix, and the decimals.
/// All is taken from what rounding makes of the number: 0.99999 J with four digits are 1.000 J.
pub fn prefix_and_decimals(size: f64, digits: usize) -> (f64, &'static str, usize) {
    // No digit before the decimal point is ever left out, so three are printed right.
    let fits = |&&(scale, _): &&(f64, _)| exponent(size / scale, digits.max(3)) < 3;
    let (scale, prefix) = *PREFIXES.iter().find(fits).unwrap_or(&PREFIXES[5]);
    let after_first = digits as i32 - 1;
    let decimals = after_first - exponent(size / scale, digits).min(after_first);
    (scale, prefix, decimals as usize)
}

/// The power of ten of a number rounded to so many significant digits.
fn exponent(value: f64, digits: usize) -> i32 {
    let rounded = format!("{value:.*e}", digits.max(1) - 1);
    let power = rounded.split_once('e').and_then(|(_, e)| e.parse().ok());
    power.unwrap_or(i32::MAX)
}

/// The SI prefix for a quantity of this size that is not to be rounded, as for an axis' range,
/// and what it stands for.
pub fn prefix_of(size: f64) -> (f64, &'static str) {
    let mut descending = PREFIXES.iter().rev();
    *descending
        .find(|(scale, _)| size >= *scale)
        .unwrap_or(&PREFIXES[0])
}

#[cfg(test)]
mod tests {
    use super::{PREFIXES, si, si_range};

    #[test]
    fn prefixes_and_digits() {
        assert_eq!(si(-0.06547, "J", 4), "-65.47 mJ");
        assert_eq!(si(2.2e-6, "J", 2), "2.2 µJ");
        assert_eq!(si(0.43, "m", 3), "430 mm");
        assert_eq!(si_range(0.014537, 0.0151873, "J", 4), "14.54 to 15.19 mJ");
        assert_eq!(si_range(-2e-7, 0.0151873, "J", 3), "-0.0 to 15.2 mJ");
    }

    #[test]
    fn prefix_and_decimals_are_those_of_the_rounded_number() {
        assert_eq!(si(0.99999, "J", 4), "1.000 J");
        assert_eq!(si(-0.99999, "J", 4), "-1.000 J");
        assert_eq!(si(0.99994, "J", 4), "999.9 mJ");
        assert_eq!(si(9.9999, "J", 3), "10.0 J");
        assert_eq!(si(-99.96, "J", 3), "-100 J");
        // With fewer digits than stand before the point none of these is rounded.
        assert_eq!(si(0.96, "J", 1), "960 mJ");
        assert_eq!(si(0.9996, "J", 1), "1 J");
    }

    #[test]
    fn beyond_the_prefixes_numbers_go_on() {
        assert_eq!(si(999_960.0, "J", 4), "1000 kJ");
        assert_eq!(si(1.23456e9, "J", 4), "1234560 kJ");
        assert_eq!(si(9.99996e-13, "J", 4), "1.000 pJ");
        assert_eq!(si(-1.2346e-15, "J", 4), "-0.001235 pJ");
        assert_eq!(si(f64::MAX, "J", 4).len(), 306 + " kJ".len());
        for zero in [0.0, -0.0] {
            assert_eq!(si(zero, "J", 3), "0 J");
        }
        assert_eq!(si(f64::INFINITY, "J", 3), "inf J");
        assert_eq!(si(f64::NEG_INFINITY, "J", 3), "-inf J");
    }

    #[test]
    fn both_ends_of_a_range_follow_its_larger_one() {
        assert_eq!(si_range(0.5, 0.99999, "J", 4), "0.500 to 1.000 J");
        assert_eq!(si_range(-0.99999, 0.5, "J", 4), "-1.000 to 0.500 J");
        assert_eq!(si_range(-0.99999, 0.99999, "J", 4), "-1.000 to 1.000 J");
        assert_eq!(si_range(9.9996e-4, 9.9999e-3, "J", 3), "1.0 to 10.0 mJ");
        assert_eq!(si_range(0.0, 0.0, "J", 4), "0 to 0 J");
        assert_eq!(si_range(-0.0, f64::INFINITY, "J", 4), "0 to inf J");
        assert_eq!(
            si_range(0.0145374, f64::INFINITY, "J", 4),
            "14.54 to inf mJ"
        );
    }

    /// Also where a tie falls on one side as joules and on the other as millijoules.
    #[test]
    fn never_a_thousand_and_never_a_digit_more() {
        for (scale, _) in &PREFIXES[1..] {
            for digits in 3..9 {
                let below = 1.0 - 0.5 * 10f64.powi(-(digits as i32));
                for ulps in -20..=20 {
                    let value = f64::from_bits((scale * below).to_bits().wrapping_add_signed(ulps));
                    let text = si(value, "J", digits);
                    let number = text.split(' ').next().unwrap();
                    assert!(number.parse::<f64>().unwrap() < 1000.0, "{value}: {text}");
                    let significant = number.trim_start_matches(['0', '.']);
                    let count = significant.bytes().filter(u8::is_ascii_digit).count();
                    assert_eq!(count, digits, "{value}: {text}");
                }
            }
        }
    }
}
