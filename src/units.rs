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
