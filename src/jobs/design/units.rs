//! Numbers with a unit, as `"12 cm"`, `"0.3 T"` or `"30 deg"`.

/// Units of one kind of quantity: the name, and how many of them make one of the file's own unit.
pub(crate) type Units = &'static [(&'static str, f64)];

const DEGREES: f64 = 180.0 / std::f64::consts::PI;

pub(crate) const LENGTH: Units = &[
    ("m", 1.0),
    ("cm", 1e2),
    ("mm", 1e3),
    ("um", 1e6),
    ("µm", 1e6),
    ("in", 1.0 / 0.0254),
    ("inch", 1.0 / 0.0254),
    ("inches", 1.0 / 0.0254),
    ("ft", 1.0 / 0.3048),
];
pub(super) const ANGLE: Units = &[
    ("rad", 1.0),
    ("mrad", 1e3),
    ("deg", DEGREES),
    ("degrees", DEGREES),
    ("°", DEGREES),
];
pub(super) const FIELD: Units = &[
    ("T", 1.0),
    ("mT", 1e3),
    ("G", 1e4),
    ("kG", 10.0),
    ("gauss", 1e4),
    ("Gauss", 1e4),
    ("Gs", 1e4),
];
/// Pounds and ounces in a kilogram (avoirdupois, by definition).
const POUNDS: f64 = 1.0 / 0.453_592_37;
pub(super) const MASS: Units = &[
    ("kg", 1.0),
    ("g", 1e3),
    ("mg", 1e6),
    ("gram", 1e3),
    ("grams", 1e3),
    ("lb", POUNDS),
    ("lbs", POUNDS),
    ("oz", 16.0 * POUNDS),
];
/// Kilograms that weigh a newton, by the standard gravity of 9.80665 m/s^2.
const WEIGHT: f64 = 1.0 / 9.806_65;
/// Units of force, including weights: shops state pulls in kilograms and pounds.
pub(crate) const FORCE: Units = &[
    ("N", 1.0),
    ("kN", 1e-3),
    ("mN", 1e3),
    ("kg", WEIGHT),
    ("kgf", WEIGHT),
    ("kp", WEIGHT),
    ("g", 1e3 * WEIGHT),
    ("gf", 1e3 * WEIGHT),
    ("gram", 1e3 * WEIGHT),
    ("grams", 1e3 * WEIGHT),
    ("lb", POUNDS * WEIGHT),
    ("lbs", POUNDS * WEIGHT),
    ("lbf", POUNDS * WEIGHT),
    ("oz", 16.0 * POUNDS * WEIGHT),
];
pub(super) const MOMENT: Units = &[
    ("A m^2", 1.0),
    ("A·m²", 1.0),
    ("A m²", 1.0),
    ("Am2", 1.0),
    ("mA m^2", 1e3),
    ("mA·m²", 1e3),
    ("emu", 1e3),
];
const ENERGY: Units = &[
    ("J", 1.0),
    ("kJ", 1e-3),
    ("mJ", 1e3),
    ("uJ", 1e6),
    ("µJ", 1e6),
    ("nJ", 1e9),
    ("pJ", 1e12),
];
const TIME: Units = &[
    ("s", 1.0),
    ("ms", 1e3),
    ("us", 1e6),
    ("µs", 1e6),
    ("min", 1.0 / 60.0),
    ("minutes", 1.0 / 60.0),
    ("h", 1.0 / 3600.0),
    ("hours", 1.0 / 3600.0),
    ("d", 1.0 / 86_400.0),
    ("days", 1.0 / 86_400.0),
];
const FREQUENCY: Units = &[
    ("Hz", 1.0),
    ("kHz", 1e-3),
    ("mHz", 1e3),
    ("rpm", 60.0),
    ("/min", 60.0),
    ("rps", 1.0),
    ("/s", 1.0),
];
const RATE: Units = &[
    ("/s", 1.0),
    ("1/s", 1.0),
    ("s^-1", 1.0),
    ("Hz", 1.0),
    ("/ms", 1e-3),
    ("/min", 60.0),
    ("1/min", 60.0),
];
const SPEED: Units = &[
    ("m/s", 1.0),
    ("cm/s", 1e2),
    ("mm/s", 1e3),
    ("um/s", 1e6),
    ("in/s", 1.0 / 0.0254),
];
const SPIN: Units = &[
    ("rad/s", 1.0),
    ("mrad/s", 1e3),
    ("deg/s", DEGREES),
    ("degrees/s", DEGREES),
    ("rpm", 60.0 / std::f64::consts::TAU),
    ("Hz", 1.0 / std::f64::consts::TAU),
];
const AREA: Units = &[
    ("m2", 1.0),
    ("m^2", 1.0),
    ("cm2", 1e4),
    ("cm^2", 1e4),
    ("mm2", 1e6),
    ("mm^2", 1e6),
];
const DENSITY: Units = &[
    ("kg/m3", 1.0),
    ("kg/m^3", 1.0),
    ("g/cm3", 1e-3),
    ("g/cm^3", 1e-3),
    ("g/cc", 1e-3),
];
pub(super) const SHARE: Units = &[("%", 1e2)];

/// Reads a finite number followed by one of `units`, with or without a space; returns it in the
/// file's own unit.
pub(super) fn read(text: &str, units: Units) -> Option<f64> {
    read_with_unit(text, units).map(|(value, _)| value)
}

/// The same, with one of the text's unit in the file's own unit.
pub(crate) fn read_with_unit(text: &str, units: Units) -> Option<(f64, f64)> {
    units.iter().find_map(|(name, factor)| {
        let value = number(text.trim().strip_suffix(name)?.trim_end())?;
        Some((value / factor, 1.0 / factor))
    })
}

/// A decimal number, or one with a fraction, as usual for inches: `1/2`, `1 3/8`.
fn number(text: &str) -> Option<f64> {
    let plain = |text: &str| {
        // Rejects `inf` and `nan`, which Rust parses as numbers; and does not read `12 mm` as `12
        // m`.
        let plain = text.ends_with(|c: char| c.is_ascii_digit() || c == '.');
        text.parse::<f64>().ok().filter(|_| plain)
    };
    let whole = |text: &str| text.parse::<u16>().ok().map(f64::from);
    let Some((above, below)) = text.split_once('/') else {
        return plain(text);
    };
    let (units, above) = above.rsplit_once(' ').unwrap_or(("0", above));
    let below = whole(below).filter(|below| *below > 0.0)?;
    Some(whole(units.trim_end())? + whole(above)? / below)
}

/// A number and a unit of any kind at the beginning of a value, such as `12cm` or `12 cm`: the
/// number in the file's own unit, if only one kind of quantity has this unit, and both as written.
pub(super) fn beginning(text: &str) -> Option<(Option<f64>, &str)> {
    let end = text.find(['\n', '\r', ',', ']', '}', '#']);
    let written = text[..end.unwrap_or(text.len())].trim_end();
    let kinds = [LENGTH, ANGLE, FIELD, MASS, FORCE, MOMENT, SHARE];
    let mut values = kinds.iter().filter_map(|units| read(written, units));
    let value = values.next()?;
    Some((values.next().is_none().then_some(value), written))
}

/// A length (m): a plain number, or one followed by a unit.
///
/// ```
/// use tilebind_jobs::design::{angle, energy, length, time};
/// assert_eq!((length("0.12"), length("12 cm"), length("12 kg")), (Some(0.12), Some(0.12), None));
/// assert_eq!(angle("180 deg"), Some(std::f64::consts::PI));
/// assert_eq!((energy("3 mJ"), time("2 min")), (Some(3e-3), Some(120.0)));
/// ```
pub fn length(text: &str) -> Option<f64> {
    plain(text).or_else(|| read(text, LENGTH))
}

/// An angle (rad): a plain number, or one followed by a unit.
pub fn angle(text: &str) -> Option<f64> {
    plain(text).or_else(|| read(text, ANGLE))
}

/// An energy (J): a plain number, or one followed by a unit.
pub fn energy(text: &str) -> Option<f64> {
    plain(text).or_else(|| read(text, ENERGY))
}

/// A time (s): a plain number, or one followed by a unit.
pub fn time(text: &str) -> Option<f64> {
    plain(text).or_else(|| read(text, TIME))
}

/// A frequency (Hz): a plain number, or one followed by a unit, such as rpm.
pub fn frequency(text: &str) -> Option<f64> {
    plain(text).or_else(|| read(text, FREQUENCY))
}

/// A rate (1/s): a plain number, or one followed by a unit.
pub fn rate(text: &str) -> Option<f64> {
    plain(text).or_else(|| read(text, RATE))
}

/// A speed (m/s): a plain number, or one followed by a unit.
pub fn speed(text: &str) -> Option<f64> {
    plain(text).or_else(|| read(text, SPEED))
}

/// An angular velocity (rad/s): a plain number, or one followed by a unit.
pub fn spin(text: &str) -> Option<f64> {
    plain(text).or_else(|| read(text, SPIN))
}

/// An area (m^2): a plain number, or one followed by a unit.
pub fn area(text: &str) -> Option<f64> {
    plain(text).or_else(|| read(text, AREA))
}

/// A density (kg/m^3): a plain number, or one followed by a unit.
pub fn density(text: &str) -> Option<f64> {
    plain(text).or_else(|| read(text, DENSITY))
}

fn plain(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|x: &f64| x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, PI};

    #[test]
    fn numbers_are_read_with_their_units() {
        for (text, units, expected) in [
            ("12 cm", LENGTH, 0.12),
            ("43mm", LENGTH, 0.043),
            (" -0.3 mm ", LENGTH, -3e-4),
            ("1e1 cm", LENGTH, 0.1),
            ("2 in", LENGTH, 0.0508),
            ("0.5 inch", LENGTH, 0.0127),
            ("1/2 in", LENGTH, 0.0127),
            ("1 1/2inches", LENGTH, 0.0381),
            ("12000 gauss", FIELD, 1.2),
            ("100 gram", MASS, 0.1),
            ("1 lb", MASS, 0.453_592_37),
            ("2 kg", FORCE, 2.0 * 9.806_65),
            ("18 N", FORCE, 18.0),
            ("0.3 T", FIELD, 0.3),
            ("12000 G", FIELD, 1.2),
            ("100 g", MASS, 0.1),
            ("286.5 mA m^2", MOMENT, 0.2865),
            ("30 %", SHARE, 0.3),
            ("90 deg", ANGLE, FRAC_PI_2),
        ] {
            assert_eq!(read(text, units), Some(expected), "{text}");
        }
        assert!((frequency("300 rpm").unwrap() - 5.0).abs() < 1e-15);
        assert_eq!((rate("0.5 /s"), rate("0.5 1/s")), (Some(0.5), Some(0.5)));
        assert_eq!((speed("40 cm/s"), spin("180 deg/s")), (Some(0.4), Some(PI)));
        assert_eq!(
            (area("4 cm2"), density("0.6 g/cm3")),
            (Some(4e-4), Some(600.0))
        );
        assert!((read("30°", ANGLE).unwrap() - FRAC_PI_6).abs() < 2e-16);
        for (text, units) in [
            ("12", LENGTH),
            ("cm", LENGTH),
            ("inf m", LENGTH),
            ("12 m m", LENGTH),
            ("1/0 in", LENGTH),
            ("1/ in", LENGTH),
            ("0.5/2 in", LENGTH),
            ("1 kg", LENGTH),
            ("0.3 T", LENGTH),
        ] {
            assert_eq!(read(text, units), None, "{text}");
        }
        assert_eq!(beginning("12cm # wide"), Some((Some(0.12), "12cm")));
        assert_eq!(beginning("12 kg"), Some((None, "12 kg")));
        assert_eq!(beginning("12 # wide"), None);
    }
}
