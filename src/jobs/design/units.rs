//! Numbers with a unit, as `"12 cm"`, `"0.3 T"` or `"30 deg"`.

/// Units of one kind of quantity: the name, and how many of it make one of the file's own unit.
pub(super) type Units = &'static [(&'static str, f64)];

const DEGREES: f64 = 180.0 / std::f64::consts::PI;

pub(super) const LENGTH: Units = &[
    ("m", 1.0),
    ("cm", 1e2),
    ("mm", 1e3),
    ("um", 1e6),
    ("µm", 1e6),
    ("in", 1.0 / 0.0254),
];
pub(super) const ANGLE: Units = &[
    ("rad", 1.0),
    ("mrad", 1e3),
    ("deg", DEGREES),
    ("degrees", DEGREES),
    ("°", DEGREES),
];
pub(super) const FIELD: Units = &[("T", 1.0), ("mT", 1e3), ("G", 1e4), ("kG", 10.0)];
pub(super) const MASS: Units = &[("kg", 1.0), ("g", 1e3), ("mg", 1e6)];
pub(super) const MOMENT: Units = &[
    ("A m^2", 1.0),
    ("A·m²", 1.0),
    ("A m²", 1.0),
    ("Am2", 1.0),
    ("mA m^2", 1e3),
    ("mA·m²", 1e3),
    ("emu", 1e3),
];
pub(super) const SHARE: Units = &[("%", 1e2)];

/// A finite number and one of `units` behind it, with or without a space, in the file's own unit.
pub(super) fn read(text: &str, units: Units) -> Option<f64> {
    units.iter().find_map(|(name, factor)| {
        let number = text.trim().strip_suffix(name)?.trim_end();
        // Not `inf` and `nan`, which are numbers to Rust; and `12 m` is none of `12 mm`.
        let plain = number.ends_with(|c: char| c.is_ascii_digit() || c == '.');
        let value: f64 = number.parse().ok().filter(|_| plain)?;
        Some(value / factor)
    })
}

/// A number and a unit of any kind at the beginning of a value, such as `12cm` or `12 cm`: the number
/// in the file's own unit, and both as they are written.
pub(super) fn beginning(text: &str) -> Option<(f64, &str)> {
    let end = text.find(['\n', '\r', ',', ']', '}', '#']);
    let written = text[..end.unwrap_or(text.len())].trim_end();
    let kinds = [LENGTH, ANGLE, FIELD, MASS, MOMENT, SHARE];
    let value = kinds.iter().find_map(|units| read(written, units))?;
    Some((value, written))
}

/// A length (m): a plain number, or one with a unit behind it.
///
/// ```
/// use tilebind_jobs::design::{angle, length};
/// assert_eq!((length("0.12"), length("12 cm"), length("12 kg")), (Some(0.12), Some(0.12), None));
/// assert_eq!(angle("180 deg"), Some(std::f64::consts::PI));
/// ```
pub fn length(text: &str) -> Option<f64> {
    plain(text).or_else(|| read(text, LENGTH))
}

/// An angle (rad): a plain number, or one with a unit behind it.
pub fn angle(text: &str) -> Option<f64> {
    plain(text).or_else(|| read(text, ANGLE))
}

fn plain(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|x: &f64| x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

    #[test]
    fn numbers_are_read_with_their_units() {
        for (text, units, expected) in [
            ("12 cm", LENGTH, 0.12),
            ("43mm", LENGTH, 0.043),
            (" -0.3 mm ", LENGTH, -3e-4),
            ("1e1 cm", LENGTH, 0.1),
            ("2 in", LENGTH, 0.0508),
            ("0.3 T", FIELD, 0.3),
            ("12000 G", FIELD, 1.2),
            ("100 g", MASS, 0.1),
            ("286.5 mA m^2", MOMENT, 0.2865),
            ("30 %", SHARE, 0.3),
            ("90 deg", ANGLE, FRAC_PI_2),
        ] {
            assert_eq!(read(text, units), Some(expected), "{text}");
        }
        assert!((read("30°", ANGLE).unwrap() - FRAC_PI_6).abs() < 2e-16);
        for (text, units) in [
            ("12", LENGTH),
            ("cm", LENGTH),
            ("inf m", LENGTH),
            ("12 m m", LENGTH),
            ("0.3 T", LENGTH),
        ] {
            assert_eq!(read(text, units), None, "{text}");
        }
        assert_eq!(beginning("12cm # wide"), Some((0.12, "12cm")));
        assert_eq!(beginning("12 # wide"), None);
    }
}
