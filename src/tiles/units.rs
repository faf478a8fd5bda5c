//! Physical constants, and quantities printed with SI prefixes.

use std::f64::consts::PI;

/// Magnetic constant mu0 (T m / A), the conventional value 4 pi 1e-7. (The measured value of CODATA
/// 2018 differs from it by 5.5e-10, far below the uncertainty of any magnet.)
pub const MU0: f64 = 4.0e-7 * PI;

/// `mu0 / (4 pi)` (T m / A), the factor of Coulomb's law between magnetic charges and of the energy
/// between dipoles.
pub const MU0_OVER_4PI: f64 = MU0 / (4.0 * PI);

/// The SI prefixes and their factors, ascending.
const PREFIXES: [(f64, &str); 6] = [
    (1e-12, "p"),
    (1e-9, "n"),
    (1e-6, "µ"),
    (1e-3, "m"),
    (1.0, ""),
    (1e3, "k"),
];

/// A quantity with an SI prefix, `digits` significant digits and its unit: `-65.47 mJ`. Zero and
/// non-finite values have no prefix.
pub fn si(value: f64, unit: &str, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{} {unit}", value + 0.0);
    }
    let (scale, prefix, decimals) = prefix_and_decimals(value.abs(), digits);
    format!("{:.decimals$} {prefix}{unit}", value / scale)
}

/// A number with this many significant digits; very small and large ones with a power of ten. No
/// digit before the decimal point is omitted.
pub fn plain(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{}", value + 0.0);
    }
    let after_first = digits.max(1) as i32 - 1;
    match exponent(value.abs(), digits) {
        power @ -3..=3 => format!("{value:.*}", (after_first - power).max(0) as usize),
        _ => format!("{value:.*e}", after_first as usize),
    }
}

/// `1 magnet`, `3 magnets`: so many of something whose plural ends in s.
pub fn counted(count: usize, one: &str) -> String {
    format!("{count} {one}{}", if count == 1 { "" } else { "s" })
}

/// `4.25 %`: a share with this many significant digits.
pub fn share_to(share: f64, digits: usize) -> String {
    format!("{} %", plain(100.0 * share, digits))
}

/// `4.3 %`: a share with this many decimals.
pub fn share_with(share: f64, decimals: usize) -> String {
    format!("{:.decimals$} %", 100.0 * share)
}

/// `+4.3 %`: a relative change with this many decimals.
pub fn change_with(change: f64, decimals: usize) -> String {
    format!("{:+.decimals$} %", 100.0 * change)
}

/// Units of time (s), ascending: its length, its name, and the number of it from which on the next
/// one is used.
const SPANS: [(f64, &str, f64); 5] = [
    (1.0, "s", 100.0),
    (60.0, "minutes", 100.0),
    (3600.0, "hours", 48.0),
    (86_400.0, "days", 700.0),
    (31_557_600.0, "years", f64::INFINITY),
];

/// A time (s) in a readable unit, with this many significant digits: `12 ms`, `4.2 hours`, `3e+40
/// years`.
pub fn duration(time: f64, digits: usize) -> String {
    duration_to(time, digits, f64::round)
}

/// The same, with the last digit rounded by `whole`.
pub fn duration_to(time: f64, digits: usize, whole: fn(f64) -> f64) -> String {
    if time == f64::INFINITY {
        return "for ever".to_owned();
    }
    let fits = |(span, _, most): &&(f64, &str, f64)| time < span * most;
    let (span, name, _) = SPANS.iter().find(fits).copied().unwrap_or(SPANS[0]);
    let size = time / span;
    let unit = 10f64.powi(exponent(size, 16).saturating_sub(digits.max(1) as i32 - 1));
    // Too small or large a number has no such digits.
    let rounded = match whole(size / unit) * unit {
        rounded if rounded.is_finite() && rounded > 0.0 => rounded,
        _ => size,
    };
    match name {
        "s" => si(rounded, name, digits),
        _ => format!("{} {name}", plain(rounded, digits)),
    }
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
/// significant digits, is printed below 1000: its factor, the prefix, and the number of decimals.
/// They are determined after rounding: 0.99999 J with four digits are 1.000 J.
pub fn prefix_and_decimals(size: f64, digits: usize) -> (f64, &'static str, usize) {
    // No digit before the decimal point is omitted, so three are printed correctly.
    let fits = |&&(scale, _): &&(f64, _)| exponent(size / scale, digits.max(3)) < 3;
    let (scale, prefix) = *PREFIXES.iter().find(fits).unwrap_or(&PREFIXES[5]);
    let after_first = digits as i32 - 1;
    let decimals = after_first - exponent(size / scale, digits).min(after_first);
    (scale, prefix, decimals as usize)
}

/// A finite number rounded to this many significant digits (at least one).
pub fn to_digits(value: f64, digits: usize) -> f64 {
    let rounded = format!("{value:.*e}", digits.max(1) - 1);
    rounded.parse().unwrap_or(value)
}

/// The power of ten of a number rounded to this many significant digits.
fn exponent(value: f64, digits: usize) -> i32 {
    let rounded = format!("{value:.*e}", digits.max(1) - 1);
    let power = rounded.split_once('e').and_then(|(_, e)| e.parse().ok());
    power.unwrap_or(i32::MAX)
}

/// The SI prefix for a quantity of this size without rounding, as for an axis' range, and its
/// factor.
pub fn prefix_of(size: f64) -> (f64, &'static str) {
    let mut descending = PREFIXES.iter().rev();
    *descending
        .find(|(scale, _)| size >= *scale)
        .unwrap_or(&PREFIXES[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_told_as_people_read_them() {
        for (time, told) in [
            (0.0123, "12.3 ms"),
            (99.94, "99.9 s"),
            (120.0, "2.00 minutes"),
            (7.96e8, "25.2 years"),
            (86_400.0, "24.0 hours"),
            (1e6, "11.6 days"),
            (1.01e60, "3.20e52 years"),
            (f64::INFINITY, "for ever"),
        ] {
            assert_eq!(duration(time, 3), told);
        }
        assert_eq!(duration_to(7.99e8, 2, f64::floor), "25 years");
        assert_eq!(duration_to(7.99e8, 2, f64::ceil), "26 years");
    }

    #[test]
    fn numbers_have_the_digits_asked_for() {
        for (value, told) in [
            (9.4, "9.40"),
            (0.112_34, "0.112"),
            (5432.1, "5432"),
            (1e4, "1.00e4"),
            (1.55e-5, "1.55e-5"),
            (0.0, "0"),
            (999.96, "1000"),
        ] {
            assert_eq!(plain(value, 3), told);
        }
    }
}
