//! Physical constants and the printing of quantities with SI prefixes.

use std::f64::consts::PI;

/// Magnetic constant mu0 (T m / A), the conventional value 4 pi 1e-7. (The measured value of
/// CODATA 2018 differs from it by 5.5e-10, far below what is known of any magnet.)
pub const MU0: f64 = 4.0e-7 * PI;

/// A quantity with an SI prefix, `digits` significant digits and its unit: `-65.47 mJ`.
pub fn si(value: f64, unit: &str, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value} {unit}");
    }
    let (scale, prefix) = prefix_of(value.abs());
    let scaled = value / scale;
    let whole = scaled.abs().log10().floor() as i32 + 1;
    let decimals = (digits as i32 - whole).max(0) as usize;
    format!("{scaled:.decimals$} {prefix}{unit}")
}

/// Two quantities with one SI prefix and unit between them, each with `digits` significant digits
/// of the larger one: `14.54 to 15.19 mJ`.
pub fn si_range(low: f64, high: f64, unit: &str, digits: usize) -> String {
    let size = low.abs().max(high.abs());
    if size == 0.0 || !size.is_finite() {
        return format!("{low} to {high} {unit}");
    }
    let (scale, prefix) = prefix_of(size);
    let whole = (size / scale).log10().floor() as i32 + 1;
    let decimals = (digits as i32 - whole).max(0) as usize;
    let [low, high] = [low / scale, high / scale];
    format!("{low:.decimals$} to {high:.decimals$} {prefix}{unit}")
}

/// The SI prefix for a quantity of this size, and what it stands for.
pub fn prefix_of(size: f64) -> (f64, &'static str) {
    const PREFIXES: [(f64, &str); 6] = [
        (1e3, "k"),
        (1.0, ""),
        (1e-3, "m"),
        (1e-6, "µ"),
        (1e-9, "n"),
        (1e-12, "p"),
    ];
    *PREFIXES
        .iter()
        .find(|(scale, _)| size >= *scale)
        .unwrap_or(&PREFIXES[5])
}

#[cfg(test)]
mod tests {
    use super::{si, si_range};

    #[test]
    fn prefixes_and_digits() {
        assert_eq!(si(-0.06547, "J", 4), "-65.47 mJ");
        assert_eq!(si(2.2e-6, "J", 2), "2.2 µJ");
        assert_eq!(si(0.43, "m", 3), "430 mm");
        assert_eq!(si(0.0, "J", 3), "0 J");
        assert_eq!(si_range(0.014537, 0.0151873, "J", 4), "14.54 to 15.19 mJ");
        assert_eq!(si_range(-2e-7, 0.0151873, "J", 3), "-0.0 to 15.2 mJ");
    }
}
