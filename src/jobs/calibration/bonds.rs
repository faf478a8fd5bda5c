//! Fits the effective kT of shaking to the binding and parting of pairs.
//!
//! In equilibrium the time that a pair is bound is K / S times the time that it is apart, where K
//! is the bond's association constant at kT (see [`physics::kinetics::bond::Hold::association`])
//! and S the area available to the pair: of one pair alone on a table the area that the rim and the
//! fixed tile leave to the moving tile's reference point, averaged over theta
//! ([`physics::problem::Room`]).
//!
//! Intervals of a Markov process are exponentially distributed with some mean t. If n intervals
//! were observed to their ends and some were cut off by the end of the observation, the total time
//! over n is the maximum-likelihood estimate of t (omitting the cut-off intervals would favour
//! short ones), and the total time over t has the gamma distribution of shape n: exactly if none
//! was cut off, approximately otherwise (Epstein and Sobel 1953,
//! doi:10.1080/01621459.1953.10483488). The ratio of two such times has Fisher's distribution,
//! which gives the confidence interval for few and many intervals alike.

use statrs::distribution::{Beta, ContinuousCDF};

use super::lines::{positive, records};
use physics::dynamics::docking::exponential_statistic;
use physics::units::to_digits;

/// The columns of a file of intervals: how long a pair was bound, and how long apart (s). Each
/// entry is one interval, prefixed with `>` if the observation ended first; entries may be empty.
pub const COLUMNS: [&str; 2] = ["bound_s", "apart_s"];

/// The prefix of an unfinished interval.
const CUT: char = '>';
/// The probability beyond each end of a 95 % interval.
const TAIL: f64 = 0.025;

/// Intervals of one kind (s).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times {
    /// Finished intervals.
    pub whole: Vec<f64>,
    /// Intervals cut off by the end of the observation.
    pub cut: Vec<f64>,
}

impl Times {
    /// The total time (s).
    fn total(&self) -> f64 {
        self.whole.iter().chain(&self.cut).sum()
    }

    /// The maximum-likelihood mean (s).
    pub fn mean(&self) -> f64 {
        self.total() / self.whole.len() as f64
    }

    /// The Kolmogorov-Smirnov statistic for exponential intervals; above
    /// [`physics::dynamics::docking::OnRate::CRITICAL`] they are not exponential. `None` if some
    /// were cut off, which the statistic does not cover.
    pub fn statistic(&self) -> Option<f64> {
        self.cut
            .is_empty()
            .then(|| exponential_statistic(&self.whole))
    }
}

/// Measured intervals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PairTimes {
    /// How long pairs were bound, each from attachment to detachment.
    pub bound: Times,
    /// How long they were apart.
    pub apart: Times,
}

/// kT fitted to intervals.
#[derive(Clone, Debug, PartialEq)]
pub struct TimesFit {
    /// The measured intervals.
    pub times: PairTimes,
    /// Area (m^2) available to the pair.
    pub area: f64,
    /// The fitted kT (J); `None` if there is none.
    pub kt: Option<f64>,
    /// Its 95 % interval (J).
    pub interval: [Option<f64>; 2],
}

/// Least number of finished intervals of each kind.
const FEWEST: usize = 5;

impl PairTimes {
    /// Reads intervals; empty lines and lines that begin with `#` are skipped.
    ///
    /// # Errors
    /// If the text is not a table of [`COLUMNS`], or has fewer than five finished intervals of a
    /// kind.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut records = records(text);
        let header = records.next().map(|(_, header)| header).unwrap_or_default();
        let place = |name: &str| header.iter().position(|column| column == name);
        let (Some(bound), Some(apart), 2) = (place(COLUMNS[0]), place(COLUMNS[1]), header.len())
        else {
            let named = header.iter().collect::<Vec<_>>().join(",");
            return Err(format!(
                "the first line must name the columns bound_s,apart_s (in any order) or distance_m \
                 alone, not `{named}`"
            ));
        };
        let mut times = Self::default();
        for (line, record) in records {
            if record.len() != 2 {
                return Err(format!(
                    "line {line} does not have two entries; leave one empty, but keep its comma"
                ));
            }
            for (column, list) in [(bound, &mut times.bound), (apart, &mut times.apart)] {
                let text = &record[column];
                let (list, number) = match text.strip_prefix(CUT) {
                    Some(number) => (&mut list.cut, number),
                    None => (&mut list.whole, text),
                };
                match positive(number) {
                    Some(time) => list.push(time),
                    None if text.is_empty() => {}
                    None => {
                        return Err(format!(
                            "line {line}: `{text}` is not a time above 0 (s), with or without > \
                             before it"
                        ));
                    }
                }
            }
        }
        for (column, list) in COLUMNS.into_iter().zip([&times.bound, &times.apart]) {
            let found = list.whole.len();
            if found < FEWEST {
                return Err(format!(
                    "{column}: {found} finished intervals are too few; measure 5 or more"
                ));
            }
        }
        Ok(times)
    }

    /// ln of the time bound over the time apart, and its 95 % interval.
    pub fn log_odds(&self) -> (f64, [f64; 2]) {
        let value = libm::log(self.bound.mean() / self.apart.mean());
        let [n, m] = [&self.bound, &self.apart].map(|times| times.whole.len() as f64);
        let share = Beta::new(n, m);
        let end = |p: f64| {
            // In units of the means: the share of the total time, then the ratio of the two.
            let share = share.map_or(f64::NAN, |share| to_digits(share.inverse_cdf(p), 6));
            value - libm::log(share / (1.0 - share) * m / n)
        };
        (value, [end(1.0 - TAIL), end(TAIL)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use physics::dynamics::docking::stream;
    use rand::RngExt;

    #[test]
    fn files_of_intervals() {
        let text = "# a table\napart_s, bound_s\n1,2\n,3\n4,\n5,6\n1,1\n2,2\n3,1\n";
        let times = PairTimes::read(text).unwrap();
        assert_eq!(times.bound.whole, [2.0, 3.0, 6.0, 1.0, 2.0, 1.0]);
        assert_eq!(times.apart.whole, [1.0, 4.0, 5.0, 1.0, 2.0, 3.0]);
        let text = "bound_s,apart_s\n1,> 7\n2,>3\n3,1\n4,1\n5,1\n,1\n,1\n";
        let cut = PairTimes::read(text).unwrap().apart;
        assert_eq!((cut.whole.len(), &cut.cut[..]), (5, &[7.0, 3.0][..]));
        assert!((cut.mean() - 3.0).abs() < 1e-12 && cut.statistic().is_none());
        let (value, [low, high]) = times.log_odds();
        assert!(value.abs() < 0.1 && low < value && value < high);
        for (wrong, what) in [
            ("", "columns"),
            ("bound_s\n1\n", "columns"),
            ("bound_s,apart_s\n1,-2\n", "line 2"),
            ("bound_s,apart_s\n1,>\n", "line 2"),
            (
                "bound_s,apart_s\n>1,>1\n>1,>1\n>1,1\n>1,1\n>1,1\n",
                "too few",
            ),
            ("bound_s,apart_s\n1,x\n", "line 2"),
            ("bound_s,apart_s\n1,2,3\n", "line 2"),
            ("bound_s,apart_s\n1,2\n", "too few"),
        ] {
            let error = PairTimes::read(wrong).unwrap_err().to_string();
            assert!(error.contains(what), "{wrong}: {error}");
        }
    }

    /// Fisher's F at 97.5 % from tables: the interval's end over the value.
    #[test]
    fn intervals_are_those_of_fishers_distribution() {
        let times = |count: usize| Times {
            whole: vec![2.0; count],
            cut: Vec::new(),
        };
        for (n, m, of_low, of_high) in [
            (5, 5, 3.7168, 3.7168),
            (5, 10, 2.7737, 3.4185),
            (10, 5, 3.4185, 2.7737),
            (60, 60, 1.4327, 1.4327),
        ] {
            let pair = PairTimes {
                bound: times(n),
                apart: times(m),
            };
            let (value, [low, high]) = pair.log_odds();
            assert!(value.abs() < 1e-12);
            let found = [-low, high].map(libm::exp);
            for (found, table) in found.into_iter().zip([of_low, of_high]) {
                assert!(
                    (found / table - 1.0).abs() < 5e-5,
                    "{n} {m}: {found} {table}"
                );
            }
        }
        let pair = PairTimes {
            bound: times(30_000),
            apart: times(20_000),
        };
        // For many intervals nearly normal, with the variance 1 / n + 1 / m.
        let high = pair.log_odds().1[1];
        assert!((high / 0.017_89 - 1.0).abs() < 2e-3, "{high}");
    }

    /// If the observation is no longer than bonds last on average, half of them or more are cut
    /// off. The estimated mean is right, and its interval contains the true mean as often as
    /// stated; the mean of the finished intervals alone is wrong.
    #[test]
    fn what_is_cut_off_counts() {
        let mut rng = stream(3, 0);
        let mut draw = |mean: f64| -mean * libm::log(1.0 - rng.random::<f64>());
        let (trials, mut held) = (2000, [0; 2]);
        for _ in 0..trials {
            let mut pair = PairTimes::default();
            while pair.bound.whole.len() + pair.bound.cut.len() < 40 {
                let (time, watched) = (draw(30.0), 20.0);
                match time < watched {
                    true => pair.bound.whole.push(time),
                    false => pair.bound.cut.push(watched),
                }
            }
            pair.apart.whole = (0..12).map(|_| draw(3.0)).collect();
            let without = PairTimes {
                bound: Times {
                    cut: Vec::new(),
                    ..pair.bound.clone()
                },
                apart: pair.apart.clone(),
            };
            for (held, pair) in held.iter_mut().zip([pair, without]) {
                let [low, high] = pair.log_odds().1;
                *held += usize::from(low < libm::log(10f64) && libm::log(10f64) < high);
            }
        }
        let [all, whole] = held.map(|held| held as f64 / f64::from(trials));
        // Three standard errors of such a share are 1.5 points.
        assert!((all - 0.95).abs() < 0.015, "{all}");
        assert!(whole < 0.5, "{whole}");
    }
}
