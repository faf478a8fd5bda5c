//! The on-rate: how often tiles attach.

use statrs::distribution::{ContinuousCDF, Gamma};
use tiles::order::Order;

use super::{Docking, End};
use tiles::units::to_digits;

/// The rate of attachment over a series of trials.
///
/// The trajectories of an experiment are concatenated, each until its match or its end; the times
/// between matches are then those of one pair of tiles that is separated at random again and again.
/// The rate is a Monte Carlo integral over the distribution of starts and depends on it.
#[derive(Clone, Debug, PartialEq)]
pub struct OnRate {
    /// Number of matches.
    pub attachments: usize,
    /// Total time of all trials (s).
    pub time: f64,
    /// Attachments per second.
    pub rate: f64,
    /// Its 95 % interval, see [`poisson_interval`]; it holds however unsolved trials end.
    pub interval: [f64; 2],
    /// Number of trials whose ends are unknown.
    pub unsolved: usize,
    /// Times between attachments (s).
    pub times: Vec<f64>,
    /// The Kolmogorov-Smirnov statistic for an exponential distribution with the mean found, `(D -
    /// 0.2/n) (sqrt n + 0.26 + 0.5 / sqrt n)` (Stephens 1974, doi:10.1080/01621459.1974.10480196).
    pub statistic: f64,
}

impl OnRate {
    /// Above this value the statistic rejects an exponential distribution at the 5 % level.
    pub const CRITICAL: f64 = 1.094;

    /// The rate of an experiment's matches.
    pub fn new(docking: &Docking) -> Self {
        Self::of_events(docking.runs.iter().map(|run| match run.end {
            End::Bound { since } => (since, Some(true)),
            End::Unsolved => (run.last.time, None),
            End::Trapped { .. } | End::Free => (docking.settings.duration, Some(false)),
        }))
    }

    /// The rate of events in concatenated trials: each has a duration (s), and whether it ends with
    /// an event, if this is known.
    pub fn of_events(trials: impl Iterator<Item = (f64, Option<bool>)>) -> Self {
        let mut times = Vec::new();
        let mut unsolved = 0;
        let (mut time, mut since) = (0.0, 0.0);
        for (duration, happens) in trials {
            time += duration;
            unsolved += usize::from(happens.is_none());
            if happens == Some(true) {
                times.push(time - since);
                since = time;
            }
        }
        let per_time = |count: f64| if time > 0.0 { count / time } else { 0.0 };
        Self {
            attachments: times.len(),
            time,
            rate: per_time(times.len() as f64),
            interval: poisson_at_least(times.len(), unsolved).map(per_time),
            unsolved,
            statistic: exponential_statistic(&times),
            times,
        }
    }

    /// Whether the times between attachments are compatible with an exponential distribution.
    pub fn is_exponential(&self) -> bool {
        self.statistic <= Self::CRITICAL
    }
}

/// The probability beyond each end of a 95 % interval.
const TAIL: f64 = 0.025;

/// The 95 % interval of the mean of a Poisson process that gave the count n (Garwood 1936,
/// doi:10.1093/biomet/28.3-4.437): the means at which n or more, or n or fewer, events have a
/// probability of 2.5 %. The time of the n-th event has the distribution Gamma(n), so the ends are
/// quantiles of Gamma(n) and of Gamma(n + 1). The interval contains the mean at least as often as
/// stated, and starts at 0 for n = 0. It is rounded to six digits, since the system functions used
/// for the quantiles differ between machines in the last of sixteen.
pub fn poisson_interval(count: usize) -> [f64; 2] {
    let quantile = |events: usize, p: f64| {
        let time = Gamma::new(events as f64, 1.0);
        time.map_or(0.0, |time| to_digits(time.inverse_cdf(p), 6))
    };
    [quantile(count, TAIL), quantile(count + 1, 1.0 - TAIL)]
}

/// The same if `unknown` more events may have happened: the interval holds either way.
pub fn poisson_at_least(count: usize, unknown: usize) -> [f64; 2] {
    [
        poisson_interval(count)[0],
        poisson_interval(count + unknown)[1],
    ]
}

/// The Kolmogorov-Smirnov statistic for an exponential distribution with the mean found, see
/// [`OnRate::statistic`]; 0 without times.
pub fn exponential_statistic(times: &[f64]) -> f64 {
    if times.is_empty() {
        return 0.0;
    }
    let n = times.len() as f64;
    let mean = times.iter().sum::<f64>() / n;
    let mut sorted = times.to_vec();
    sorted.order_by(f64::total_cmp);
    let largest = sorted.iter().enumerate().fold(0.0, |largest: f64, (k, t)| {
        let expected = 1.0 - libm::exp(-t / mean);
        let k = k as f64;
        largest.max(expected - k / n).max((k + 1.0) / n - expected)
    });
    (largest - 0.2 / n) * (n.sqrt() + 0.26 + 0.5 / n.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::docking::stream;
    use rand::RngExt;

    #[test]
    fn exponential_times_pass_and_others_do_not() {
        let mut rng = stream(1, 0);
        let uniform: Vec<f64> = (0..200).map(|_| rng.random()).collect();
        let exponential: Vec<f64> = uniform.iter().map(|u| -libm::log(1.0 - u)).collect();
        assert!(exponential_statistic(&exponential) < OnRate::CRITICAL);
        assert!(exponential_statistic(&uniform) > 2.0 * OnRate::CRITICAL);
    }

    /// Three trials of 2 s; the end of one, after 1 s, is unknown.
    #[test]
    fn unknown_ends_widen_the_interval_upwards() {
        let trials = [(2.0, Some(true)), (1.0, None), (2.0, Some(false))];
        let found = OnRate::of_events(trials.into_iter());
        assert_eq!((found.attachments, found.unsolved), (1, 1));
        assert_eq!((found.time, found.rate), (5.0, 0.2));
        let [one, two] = [1, 2].map(poisson_interval);
        assert_eq!(found.interval, [one[0] / 5.0, two[1] / 5.0]);
    }

    /// Garwood's table.
    #[test]
    fn intervals_of_counts_are_exact() {
        for (count, low, high) in [
            (0, 0.0, 3.689),
            (1, 0.0253, 5.572),
            (10, 4.795, 18.39),
            (100, 81.36, 121.63),
        ] {
            let found = poisson_interval(count);
            for (found, table) in found.into_iter().zip([low, high]) {
                assert!(
                    (found - table).abs() <= 2e-4 * high,
                    "{count}: {found} {table}"
                );
            }
        }
        // For large counts nearly normal: z, then (z^2 - 1) / 3.
        let [low, high] = poisson_interval(40_000);
        assert!(
            (low - 39_609.5).abs() < 1.0 && (high - 40_394.0).abs() < 1.5,
            "{low} {high}"
        );
    }
}
