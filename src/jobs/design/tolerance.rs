//! Tolerance for lengths that differ by less than a cutter resolves.
//!
//! Faces that meet may differ by up to [`allowance`]: a side drawn in points or in inches, corners
//! that a program rounded to 0.01 mm, an arc drawn once as an arc and once as Bezier curves. They
//! are treated as follows, always with a warning:
//!
//! - the outlines stay as drawn, and the base lines of the target faces meet centre on centre;
//! - the complement of a longer face ends where its own face ends;
//! - if the target faces then overlap by no more than the allowance, the tiles are drawn straight
//!   apart until they touch; if that takes more (a tab with upright flanks, too wide for its slot),
//!   the moving face is drawn back by the overlap, as by `fit`.
//!
//! Contact, energies and their bounds then refer exactly to the resulting outlines and bound
//! configuration: no bound is widened.

use super::error::DesignError;
use super::reader::Entry;
use physics::tile::congruence::allowed;
use physics::units::{plain, to_digits};

/// Lengths that differ by less than this share are equal up to rounding.
const ROUNDING: f64 = 1e-9;

/// The allowed difference or overlap (m) of two faces of these lengths (m).
pub(super) fn allowance(a: f64, b: f64) -> f64 {
    allowed(a.min(b))
}

/// How two lengths compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lengths {
    /// Equal up to rounding.
    Same,
    /// Different by no more than the allowance.
    Near,
    /// Different.
    Unequal,
}

impl Lengths {
    /// Compares the lengths of two faces (m).
    pub fn of(a: f64, b: f64) -> Self {
        match (a - b).abs() {
            difference if difference <= ROUNDING * a.max(b) => Self::Same,
            // With a tolerance for the rounding of a difference that is just allowed.
            difference if difference <= allowance(a, b) * (1.0 + 1e-9) => Self::Near,
            _ => Self::Unequal,
        }
    }
}

/// Two lengths (m) in millimetres, with enough digits to distinguish them.
pub(super) fn distinguished(a: f64, b: f64) -> [String; 2] {
    let both = |digits: usize| [a, b].map(|x| to_digits(x * 1e3, digits).to_string());
    let digits = (4..16).find(|digits| {
        let [first, second] = both(*digits);
        first != second
    });
    both(digits.unwrap_or(16)).map(|told| format!("{told} mm"))
}

/// A small length (m) in micrometres.
pub(super) fn micrometres(length: f64) -> String {
    format!("{} um", plain(length * 1e6, 3))
}

/// The warning that two faces differ by less than a cutter resolves, and how they are treated.
pub(super) fn nearly_equal(entry: &Entry, what: &str, a: f64, b: f64) -> DesignError {
    let [first, second] = distinguished(a, b);
    entry.source.doubt(
        entry.span(),
        format!(
            "{what} {first} and {second}: {} apart, less than a cutter can resolve",
            micrometres((a - b).abs())
        ),
        "the outlines stay as drawn, and the faces meet centre to centre; make them equal if they \
         are meant to be",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_differences_are_allowed_in_proportion() {
        for (a, b, expected) in [
            (0.08, 0.08, Lengths::Same),
            (0.08, 0.08 + 1e-12, Lengths::Same),
            (0.08, 0.080_000_12, Lengths::Near),
            (0.08, 0.079_95, Lengths::Near),
            (0.08, 0.079_949, Lengths::Unequal),
            (0.01, 0.010_01, Lengths::Near),
            (0.01, 0.010_02, Lengths::Unequal),
            (0.1, 0.08, Lengths::Unequal),
        ] {
            assert_eq!(Lengths::of(a, b), expected, "{a} {b}");
            assert_eq!(Lengths::of(b, a), expected, "{b} {a}");
        }
    }

    #[test]
    fn digits_that_differ_are_told() {
        assert_eq!(distinguished(0.08, 0.080_000_12), ["80 mm", "80.0001 mm"]);
        assert_eq!(
            distinguished(0.08, 0.080_000_000_12),
            ["80 mm", "80.0000001 mm"]
        );
        assert_eq!(distinguished(0.1, 0.08), ["100 mm", "80 mm"]);
        assert_eq!(micrometres(1.2e-7), "0.120 um");
    }
}
