//! Fits the effective kT of shaking to the distances at which pairs are found.
//!
//! Statistically independent distances of the centres of a pair follow the distribution that
//! [`Distances`] gives at every kT. The result is the kT of maximum likelihood; its 95 % interval
//! ends where the log-likelihood is lower by half the quantile of chi-square (Wilks 1938,
//! doi:10.1214/aoms/1177732360). Distances are counted in bins of about 2 cm, so they need not be
//! measured more precisely.

use std::cell::RefCell;
use std::collections::BTreeMap;

use csv::StringRecord;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::lines::{positive, records};
use physics::configuration::Configuration;
use physics::kinetics::rates::distance::Distances;
use physics::problem::Problem;
use physics::units::to_digits;

/// The column of a file of distances (m).
pub const COLUMN: &str = "distance_m";

/// Least number of distances.
const FEWEST: usize = 10;
/// Drop of the log-likelihood at the ends of the interval: half of 3.84.
const DROP: f64 = 1.92;
/// Range of the bond's depth in kT in which kT is searched ...
const DEPTHS: [f64; 2] = [0.5, 60.0];
/// ... in steps of its logarithm. The distribution is computed at each step; between steps the
/// logarithms of its shares are interpolated cubically.
const STEP: f64 = 0.1;
/// Stride of the first search, in steps.
const STRIDE: i32 = 6;
/// Subdivisions of a step at which the likelihood is evaluated.
const FINE: i32 = 50;

/// Measured distances (m), with their lines in the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PairDistances {
    rows: Vec<(usize, f64)>,
}

/// kT fitted to distances.
#[derive(Clone, Debug, PartialEq)]
pub struct DistanceFit {
    /// kT (J) of maximum likelihood; `None` if it lies at an end of the searched range.
    pub kt: Option<f64>,
    /// Its 95 % interval (J); `None` for an unbounded end.
    pub interval: [Option<f64>; 2],
    /// Number of distances used.
    pub count: usize,
    /// Number of distances beyond the limit.
    pub beyond: usize,
    /// The limit of distances (m).
    pub within: f64,
    /// The largest error of the distributions' shares, estimated from the last refinement.
    pub error: f64,
    /// Pearson's statistic of the distances against the distribution at kT, and its degrees of
    /// freedom: bins with few expected counts are merged.
    pub pearson: Option<(f64, usize)>,
}

impl PairDistances {
    /// Whether a file's first line names the column of distances.
    pub fn is_named_in(text: &str) -> bool {
        records(text)
            .next()
            .is_some_and(|(_, header)| header == [COLUMN][..])
    }

    /// Reads distances; empty lines and lines that begin with `#` are skipped.
    ///
    /// # Errors
    /// If a line is not a distance.
    pub fn read(text: &str) -> Result<Self, String> {
        let row = |(line, record): (usize, StringRecord)| match record.len() {
            1 => positive(&record[0])
                .map(|distance| (line, distance))
                .ok_or_else(|| {
                    format!(
                        "line {line}: `{}` is not a distance above 0 (m)",
                        &record[0]
                    )
                }),
            _ => Err(format!("line {line} is not a single entry")),
        };
        let rows = records(text).skip(1).map(row).collect::<Result<_, _>>()?;
        Ok(Self { rows })
    }

    /// Fits kT to the distances up to a limit (m).
    ///
    /// # Errors
    /// If there are too few, or the tiles would overlap.
    pub fn fit(
        &self,
        problem: &Problem,
        bond: &Configuration,
        within: f64,
    ) -> Result<DistanceFit, String> {
        let depth = -problem.energy(bond);
        let kt = |at: f64| depth * libm::exp(-at);
        let law = |node: i32| Distances::new(problem, bond, kt(f64::from(node) * STEP), within);
        // At distances where everything is free, so that bins without probability are those closed
        // by contact.
        let nodes = DEPTHS.map(|depth| (libm::log(depth) / STEP).round() as i32);
        let first = law(nodes[0]);
        let (mut counts, mut beyond) = (vec![0_usize; first.shares.len()], 0);
        for &(line, distance) in &self.rows {
            match first.part(distance) {
                Some(part) => counts[part] += 1,
                None if distance > within => beyond += 1,
                None => {
                    return Err(format!(
                        "line {line}: with their centres {distance} m apart the tiles overlap at \
                         any orientation; distances are between the tiles' reference points"
                    ));
                }
            }
        }
        let count = self.rows.len() - beyond;
        if count < FEWEST {
            return Err(format!(
                "{count} distances up to {within} m are too few; measure 10 or more, or choose a larger \
                 --within"
            ));
        }
        let known = RefCell::new(BTreeMap::from([(nodes[0], first)]));
        let logarithms = |node: i32| -> Vec<f64> {
            let mut known = known.borrow_mut();
            let shares = &known.entry(node).or_insert_with(|| law(node)).shares;
            shares
                .iter()
                .map(|p| libm::log(p.max(f64::MIN_POSITIVE)))
                .collect()
        };
        let search = Likelihood {
            nodes,
            logarithms: &logarithms,
            counts: &counts,
        };
        let (best, ends) = search.run();
        let is_inside = best > nodes[0] * FINE && best < nodes[1] * FINE;
        let of = |fine: i32| kt(f64::from(fine) * STEP / f64::from(FINE));
        let pearson = is_inside.then(|| pearson(&search.shares(best), &counts));
        let error = known
            .borrow()
            .values()
            .map(|it| it.moved)
            .fold(0.0, f64::max);
        Ok(DistanceFit {
            kt: is_inside.then(|| of(best)),
            // A higher kT means a shallower bond.
            interval: [ends[1].map(of), ends[0].map(of)],
            count,
            beyond,
            within,
            error,
            pearson,
        })
    }
}

/// The likelihood over the logarithm of the depth in kT, in fine steps.
struct Likelihood<'a> {
    nodes: [i32; 2],
    logarithms: &'a dyn Fn(i32) -> Vec<f64>,
    counts: &'a [usize],
}

impl Likelihood<'_> {
    /// The maximum, and the positions on both sides where the likelihood has dropped.
    fn run(&self) -> (i32, [Option<i32>; 2]) {
        let [low, high] = self.nodes;
        let rough = (low..=high).step_by(STRIDE as usize);
        let best_of = |places: &mut dyn Iterator<Item = i32>, unit: i32| -> i32 {
            let valued = places.map(|place| (self.likelihood(place * unit), place));
            let best = valued.max_by(|a, b| a.0.total_cmp(&b.0));
            best.map_or(low, |(_, place)| place)
        };
        let middle = best_of(&mut rough.into_iter(), FINE);
        let around = |middle: i32, by: i32, [low, high]: [i32; 2]| {
            (middle - by).max(low)..=(middle + by).min(high)
        };
        let node = best_of(&mut around(middle, STRIDE - 1, self.nodes), FINE);
        let ends = [low * FINE, high * FINE];
        let best = best_of(&mut around(node * FINE, FINE, ends), 1);
        let least = self.likelihood(best) - DROP;
        let end = |by: i32| {
            let places = (1..).map(|k| best + by * k);
            let mut inside = places.take_while(|place| (ends[0]..=ends[1]).contains(place));
            inside.find(|&place| self.likelihood(place) < least)
        };
        (best, [end(-1), end(1)])
    }

    fn likelihood(&self, fine: i32) -> f64 {
        let logarithms = self.at(fine);
        let terms = self.counts.iter().zip(logarithms).filter(|(n, _)| **n > 0);
        terms.map(|(&n, log)| n as f64 * log).sum()
    }

    fn shares(&self, fine: i32) -> Vec<f64> {
        self.at(fine).into_iter().map(libm::exp).collect()
    }

    /// The logarithms of the shares, by Lagrange's cubic through four nodes.
    fn at(&self, fine: i32) -> Vec<f64> {
        let [low, high] = self.nodes;
        let below = fine.div_euclid(FINE);
        if fine == below * FINE {
            return (self.logarithms)(below);
        }
        let first = (below - 1).clamp(low, high - 3);
        let t = f64::from(fine - first * FINE) / f64::from(FINE);
        let mut sums = vec![0.0; self.counts.len()];
        for k in 0..4 {
            let others = (0..4).filter(|other| *other != k).map(f64::from);
            let share: f64 = others.map(|x| (t - x) / (f64::from(k) - x)).product();
            for (sum, log) in sums.iter_mut().zip((self.logarithms)(first + k)) {
                *sum += share * log;
            }
        }
        sums
    }
}

/// Pearson's statistic and its degrees of freedom, less one for the fitted kT.
fn pearson(shares: &[f64], counts: &[usize]) -> (f64, usize) {
    /// Least expected count of a bin.
    const EXPECTED: f64 = 5.0;
    let all = counts.iter().sum::<usize>() as f64;
    let mut groups: Vec<[f64; 2]> = vec![[0.0; 2]];
    for (share, count) in shares.iter().zip(counts) {
        if groups.last().is_some_and(|group| group[0] >= EXPECTED) {
            groups.push([0.0; 2]);
        }
        if let Some(group) = groups.last_mut() {
            group[0] += share * all;
            group[1] += *count as f64;
        }
    }
    if let (Some(last), Some(before)) = (groups.pop(), groups.last_mut()) {
        *before = [before[0] + last[0], before[1] + last[1]];
    }
    let terms = groups
        .iter()
        .map(|[expected, found]| (found - expected).powi(2) / expected);
    (terms.sum(), groups.len().saturating_sub(2))
}

/// The 95 % quantile of chi-square with so many degrees of freedom, at least one.
///
/// ```
/// use tilebind_jobs::calibration::distances::critical;
/// assert_eq!([1, 4, 10, 30].map(critical), [3.84146, 9.48773, 18.307, 43.773]);
/// ```
pub fn critical(freedom: usize) -> f64 {
    let all = ChiSquared::new(freedom.max(1) as f64);
    all.map_or(f64::NAN, |all| to_digits(all.inverse_cdf(0.95), 6))
}
