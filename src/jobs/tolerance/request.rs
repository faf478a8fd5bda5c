//! The request of a tolerance: the errors of making, and when a design works.

use serde::{Deserialize, Serialize};

use crate::request::{self, options};

/// Largest standard deviation of a place or a gap (m): more is no error of making.
const MOST_SHIFTED: f64 = 0.02;
/// Largest standard deviation of an angle (rad), 45 degrees.
const MOST_TURNED: f64 = std::f64::consts::FRAC_PI_4;

options! {
    /// The errors of making. Each is 0 if it is not stated.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct MakingErrors {
        /// Error of the magnets' strength: standard deviation, such as 5%
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub strength: Option<f64> = value("F", request::share),

        /// Error of the magnets' places, along and across the face: standard deviation, such as "0.3 mm"
        #[serde(default, rename = "place_m", skip_serializing_if = "Option::is_none")]
        pub place: Option<f64> = value("L", shift).alias("place_m"),

        /// Error of the magnets' axes: standard deviation, such as "3 deg"
        #[serde(default, rename = "turn_rad", skip_serializing_if = "Option::is_none")]
        pub turn: Option<f64> = value("A", turn).alias("turn_rad"),

        /// Gap left between touching faces by glue, paint or rough cuts, such as "0.1 mm"
        #[serde(default, rename = "gap_m", skip_serializing_if = "Option::is_none")]
        pub gap: Option<f64> = value("L", shift).alias("gap_m"),

        /// Chance that a magnet is glued in with its poles exchanged, such as 0.01
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub flip: Option<f64> = value("P", request::share),

        /// Share of the strength's variance that all magnets of a draw have in common
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub batch: Option<f64> = value("F", request::share),

        /// Number of drawn pairs of tiles [default: 1000]
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub draws: Option<usize> = value("N", draws),

        /// Least ratio of the bond's depth to the deepest trap's with which a pair works [default: 1.5]
        #[serde(default, rename = "least_selectivity", skip_serializing_if = "Option::is_none")]
        pub selectivity: Option<f64> = value("R", request::positive).alias("least_selectivity"),
    }
}

/// Default number of draws.
const DRAWS: usize = 1000;
/// Largest number of draws, whose energies are kept in memory.
const MOST_DRAWS: usize = 1_000_000;
/// Default least selectivity.
const SELECTIVITY: f64 = 1.5;

impl MakingErrors {
    /// Whether an error is stated, be it 0.
    pub fn is_stated(&self) -> bool {
        let Self {
            strength,
            place,
            turn,
            gap,
            flip,
            ..
        } = self;
        [strength, place, turn, gap, flip]
            .iter()
            .any(|it| it.is_some())
    }

    /// The number of draws.
    pub fn draws(&self) -> usize {
        self.draws.unwrap_or(DRAWS)
    }

    /// The least selectivity of a pair that works.
    pub fn least_selectivity(&self) -> f64 {
        self.selectivity.unwrap_or(SELECTIVITY)
    }

    /// The standard deviation of strength, place (m), turn (rad) and gap (m).
    pub(super) fn spreads(&self) -> [f64; 4] {
        [self.strength, self.place, self.turn, self.gap].map(Option::unwrap_or_default)
    }

    /// How far (m) these errors typically move a point of a magnet of this size (m).
    pub(super) fn typical(&self, size: f64) -> f64 {
        let [_, place, turn, gap] = self.spreads();
        place + gap + turn * size / 2.0
    }
}

options! {
    /// The options.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Request {
        /// The errors, and when a pair works.
        pub making: MakingErrors = group(),

        /// Also count the draws whose deepest trap is deeper than this share of the nominal bond
        ///
        /// The default is 1 over --selectivity.
        pub beats: Option<f64> = value("F", request::share),

        /// Number of draws that are analysed anew, with a full search of states
        pub checks: usize = value("N", request::runs_or_none).or(2),

        /// Random seed; the same seed gives the same results
        pub seed: u64 = value("N", request::seed).or(1),
    }
}

/// A standard deviation of a length (m), or with a unit.
fn shift(text: &str) -> Result<f64, String> {
    let found = request::length_or_none(text)?;
    match found <= MOST_SHIFTED {
        true => Ok(found),
        false => Err(format!(
            "{found} m is too much for an error of making, which is at most {MOST_SHIFTED} m; lengths without a \
             unit are in metres: for millimetres write \"{} mm\"",
            text.trim()
        )),
    }
}

/// A standard deviation of an angle (rad), or with a unit.
fn turn(text: &str) -> Result<f64, String> {
    let found = request::turn(text)?;
    match found <= MOST_TURNED {
        true => Ok(found),
        false => Err(format!(
            "{found} rad is too much for an error of making, which is at most 45 degrees; angles without a unit \
             are in radians: for degrees write \"{} deg\"",
            text.trim()
        )),
    }
}

fn draws(text: &str) -> Result<usize, String> {
    match request::runs_of_a_mean(text)? {
        count if count <= MOST_DRAWS => Ok(count),
        _ => Err(format!("at most {MOST_DRAWS} draws fit in memory")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_and_angles_without_their_unit_are_refused_with_the_unit() {
        assert_eq!(shift("0.3 mm"), Ok(3e-4));
        assert!(shift("0.3").unwrap_err().contains("\"0.3 mm\""));
        assert!(shift("-1 mm").is_err() && shift("nan").is_err() && shift("3 deg").is_err());
        assert!(turn("3").unwrap_err().contains("\"3 deg\""));
        assert!((turn("3 deg").unwrap() - 3f64.to_radians()).abs() < 1e-15);
        assert!(turn("-3 deg").is_err() && draws("1").is_err() && draws("0").is_err());
    }
}
