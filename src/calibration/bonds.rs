//! From pairs that bind and part to the effective kT of their shaking.
//!
//! In equilibrium a pair is bound for K / S times as long as it is apart, K being the bond's constant
//! of association at kT (see [`crate::kinetics::bond::Hold::association`]) and S the area that the
//! two have for themselves. Intervals of a Markov process are exponential, so that the logarithm of
//! a mean of n of them has the standard error `1 / sqrt(n)`.

use csv::{ReaderBuilder, Trim};

use crate::dynamics::docking::exponential_statistic;

/// The columns of a file of intervals: how long a pair was bound, and how long apart (s). Each entry
/// is one whole interval; entries may be left empty.
pub const COLUMNS: [&str; 2] = ["bound_s", "apart_s"];

/// Two-sided normal quantile of 95 %.
const Z: f64 = 1.96;

/// Intervals that were measured (s).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PairTimes {
    /// How long pairs were bound, each from attachment to detachment.
    pub bound: Vec<f64>,
    /// How long they were apart.
    pub apart: Vec<f64>,
}

/// What is wrong with a file of intervals, and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TimesError {
    /// A column is not there, or another one is.
    #[error(
        "the first line must name the columns bound_s,apart_s (in any order) or distance_m alone, not \
         `{0}`"
    )]
    Columns(String),
    /// A line has too many entries, or cannot be read.
    #[error("line {0} has not two entries; leave one empty, but keep its comma")]
    Entries(usize),
    /// An entry is no positive number.
    #[error("line {line}: `{text}` is no time above 0 (s)")]
    NoTime {
        /// Which line, from 1.
        line: usize,
        /// The entry.
        text: String,
    },
    /// One of the columns has too few entries.
    #[error("{column}: {found} intervals are too few; measure 5 or more")]
    TooFew {
        /// Which column.
        column: &'static str,
        /// How many entries it has.
        found: usize,
    },
}

/// Fewest intervals of either kind.
const FEWEST: usize = 5;

impl PairTimes {
    /// Reads intervals; empty lines and lines that begin with `#` are skipped.
    ///
    /// # Errors
    /// Where the text is no table of [`COLUMNS`], or has fewer than five intervals of a kind.
    pub fn read(text: &str) -> Result<Self, TimesError> {
        let mut reader = ReaderBuilder::new()
            .flexible(true)
            .trim(Trim::All)
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        let header: Vec<String> = reader
            .headers()
            .map(|header| header.iter().map(str::to_owned).collect())
            .unwrap_or_default();
        let place = |name: &str| header.iter().position(|column| column == name);
        let (Some(bound), Some(apart), 2) = (place(COLUMNS[0]), place(COLUMNS[1]), header.len())
        else {
            return Err(TimesError::Columns(header.join(",")));
        };
        let mut times = Self::default();
        for record in reader.records() {
            let record = record.map_err(|_| TimesError::Entries(0))?;
            let line = record.position().map_or(0, |at| at.line() as usize);
            if record.len() != 2 {
                return Err(TimesError::Entries(line));
            }
            for (column, list) in [(bound, &mut times.bound), (apart, &mut times.apart)] {
                let text = &record[column];
                if text.is_empty() {
                    continue;
                }
                let time = text
                    .parse()
                    .ok()
                    .filter(|time: &f64| time.is_finite() && *time > 0.0);
                let wrong = || TimesError::NoTime {
                    line,
                    text: text.to_owned(),
                };
                list.push(time.ok_or_else(wrong)?);
            }
        }
        for (column, list) in COLUMNS.into_iter().zip([&times.bound, &times.apart]) {
            if list.len() < FEWEST {
                return Err(TimesError::TooFew {
                    column,
                    found: list.len(),
                });
            }
        }
        Ok(times)
    }

    /// Mean times (s) bound and apart.
    pub fn means(&self) -> [f64; 2] {
        [&self.bound, &self.apart].map(|list| list.iter().sum::<f64>() / list.len() as f64)
    }

    /// ln of the time bound over the time apart, and its 95 % interval.
    pub fn log_odds(&self) -> (f64, [f64; 2]) {
        let [bound, apart] = self.means();
        let value = (bound / apart).ln();
        let variance = 1.0 / self.bound.len() as f64 + 1.0 / self.apart.len() as f64;
        let half = Z * variance.sqrt();
        (value, [value - half, value + half])
    }

    /// The statistics of Kolmogorov and Smirnov for exponential intervals, bound and apart; above
    /// [`crate::dynamics::docking::OnRate::CRITICAL`] they are not exponential.
    pub fn statistics(&self) -> [f64; 2] {
        [&self.bound, &self.apart].map(|list| exponential_statistic(list))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_intervals() {
        let text = "# a table\napart_s, bound_s\n1,2\n,3\n4,\n5,6\n1,1\n2,2\n3,1\n";
        let times = PairTimes::read(text).unwrap();
        assert_eq!(times.bound, [2.0, 3.0, 6.0, 1.0, 2.0, 1.0]);
        assert_eq!(times.apart, [1.0, 4.0, 5.0, 1.0, 2.0, 3.0]);
        let (value, [low, high]) = times.log_odds();
        assert!(value.abs() < 0.1 && low < value && value < high);
        for (wrong, what) in [
            ("", "columns"),
            ("bound_s\n1\n", "columns"),
            ("bound_s,apart_s\n1,-2\n", "line 2"),
            ("bound_s,apart_s\n1,x\n", "line 2"),
            ("bound_s,apart_s\n1,2,3\n", "line 2"),
            ("bound_s,apart_s\n1,2\n", "too few"),
        ] {
            let error = PairTimes::read(wrong).unwrap_err().to_string();
            assert!(error.contains(what), "{wrong}: {error}");
        }
    }
}
