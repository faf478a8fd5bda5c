//! Many tiles on a table: how many are bound and how many are trapped after a given time.
//!
//! Half of the tiles are of the fixed tile's kind, half of the moving one's, or all are of one kind: then
//! `a (a - 1) / 2` pairs of free tiles take the place of `a b`. A tile binds at most
//! one partner (pairs are the product; larger assemblies are not considered), every free tile of
//! one kind meets every free tile of the other equally often (a well stirred table), and a pair
//! changes its state at constant rates. With a and b free tiles of the two kinds, n_i pairs in
//! state i and a table of area S,
//!
//! `a + b -> i at kappa_i a b / S,   i -> a + b at k_i n_i,   i -> j at k_ij n_i.`
//!
//! There are three methods:
//!
//! - Kolmogorov's forward equation for the probabilities of all numbers of pairs in the bond and in
//!   *each* kind of trap ([`Numbers`]), up to [`MOST_STATES`] of them. Traps with different
//!   lifetimes must not be merged: one that releases at once and one that never does would become a
//!   single trap with mean rates, which represents neither;
//! - beyond that, mean numbers (Hosokawa, Shimoyama and Miura 1994, doi:10.1162/artl.1994.1.413,
//!   whose difference equations these are in the limit of short steps):
//!   `dn_i/dt = kappa_i a b / S - k_i n_i + sum over j of (k_ji n_j - k_ij n_i)` with a and b their
//!   means. They approximate `<ab>` by `<a><b>`, an error of the variance of the number of free
//!   tiles: of relative order 1/N, and largest for few tiles;
//! - exact stochastic simulation (Gillespie 1977, doi:10.1021/j100540a008).

pub mod chain;
mod choice;
mod crowd;
pub mod mixture;
pub mod numbers;
mod room;
pub mod rows;
pub mod stiff;

use nalgebra::DMatrix;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use self::numbers::Numbers;
use tiles::interruption;

pub use self::choice::chosen;
pub use self::crowd::{Crowd, PairRates};

/// Largest number of states of a crowd for which all probabilities are computed: ten tiles with ten
/// kinds of states, or six with twenty-six.
pub const MOST_STATES: usize = 4000;
/// Allowed error of the mean numbers per step and pair.
const TOLERANCE: f64 = 1e-8;
/// Most events of a simulation.
const MOST_EVENTS: usize = 20_000_000;

/// Mean shares of all possible pairs over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Shares {
    /// In the bond.
    pub bound: Vec<f64>,
    /// In traps.
    pub trapped: Vec<f64>,
    /// The error of either, of the steps in time.
    pub error: f64,
    /// Whether they follow from all probabilities; those from mean numbers have an additional
    /// error, which simulations estimate.
    pub exact: bool,
}

impl PairRates {
    /// The share of all possible pairs in the bond in equilibrium; `None` if the bond is never
    /// reached or left.
    ///
    /// With z_i = kappa_i / (k_i S), A and B tiles and H pairs in all, the numbers of pairs have
    /// the weights `A! B! / ((A - H)! (B - H)!) prod z_i^n_i / n_i!` (detailed balance); for T
    /// trapped pairs the sum over kinds equals that of one kind with the sum of their z. Rates from
    /// state to state satisfy the same balance and do not change it. N tiles of one kind have the
    /// weights `N! / (N - 2 H)! prod (z_i / 2)^n_i / n_i!`.
    pub fn equilibrium(&self, crowd: &Crowd) -> Option<f64> {
        let each = self.on.iter().zip(&self.off);
        let orders = if crowd.one_kind { 2.0 } else { 1.0 };
        let z: Vec<f64> = each
            .map(|(on, off)| on / off / crowd.area / orders)
            .collect();
        let traps: f64 = z[1..].iter().filter(|z| z.is_finite()).sum();
        if !(z[0] > 0.0 && z[0].is_finite()) {
            return None;
        }
        let pairs = crowd.pairs();
        let all_tiles = crowd.tiles[0] + crowd.tiles[1];
        let mut logs = vec![0.0; all_tiles + 1];
        for k in 1..logs.len() {
            logs[k] = logs[k - 1] + libm::log(k as f64);
        }
        let power = |z: f64, n: usize| match n {
            0 => 0.0,
            n => n as f64 * libm::log(z) - logs[n],
        };
        // Trapped pairs summed first, for each number in the bond: logarithms of the sums.
        let weight = |bound: usize| {
            let terms = (0..=pairs - bound).map(|trapped| {
                let held = bound + trapped;
                let left = match crowd.one_kind {
                    true => logs[all_tiles - 2 * held],
                    false => crowd.tiles.iter().map(|tiles| logs[tiles - held]).sum(),
                };
                power(traps, trapped) - left
            });
            power(z[0], bound) + sum_of_logs(&terms.collect::<Vec<f64>>())
        };
        let weights: Vec<f64> = (0..=pairs).map(weight).collect();
        let all = sum_of_logs(&weights);
        let mean = |(bound, weight): (usize, &f64)| bound as f64 * libm::exp(weight - all);
        Some(weights.iter().enumerate().map(mean).sum::<f64>() / pairs as f64)
    }

    /// Mean numbers of pairs in the bond and in each kind of trap at ascending `times` (s), of the
    /// equations for mean numbers; `None` if they cannot be solved.
    pub fn mean_numbers(&self, crowd: &Crowd, times: &[f64]) -> Option<stiff::Course> {
        // The linearly implicit step (1 - h J) dn = h f.
        let kinds = self.on.len();
        let leaving: Vec<f64> = (0..kinds).map(|i| self.leaving(i)).collect();
        let euler = |numbers: &[f64], h: f64| {
            let held: f64 = numbers.iter().sum();
            let [meeting, less] = crowd.meetings(held);
            let turned =
                |i: usize| -> f64 { (0..kinds).map(|j| self.turns[(j, i)] * numbers[j]).sum() };
            let change =
                |i: usize, _| h * (self.on[i] * meeting + turned(i) - leaving[i] * numbers[i]);
            let matrix = DMatrix::from_fn(kinds, kinds, |i, j| {
                let own = if i == j {
                    1.0 + h * leaving[i]
                } else {
                    -h * self.turns[(j, i)]
                };
                own + h * self.on[i] * less
            });
            let step = matrix.lu().solve(&DMatrix::from_fn(kinds, 1, change))?;
            Some(numbers.iter().zip(&step).map(|(n, dn)| n + dn).collect())
        };
        let start = vec![0.0; self.on.len()];
        let fastest = self.on.iter().sum::<f64>() * crowd.meetings(0.0)[0]
            + self.off.iter().copied().fold(0.0, f64::max);
        let first = match fastest > 0.0 {
            true => 0.1 / fastest,
            false => f64::MAX,
        };
        let tolerance = TOLERANCE * crowd.pairs() as f64;
        stiff::integrate(start, times, first, tolerance, euler)
    }

    /// Mean shares of all possible pairs at ascending `times` (s) by the forward equation for all
    /// kinds of states; `None` if a crowd has more than `most` states, and where it cannot be
    /// solved.
    pub fn forward_equation(&self, crowd: &Crowd, times: &[f64], most: usize) -> Option<Shares> {
        let count = numbers::count(self.on.len(), crowd.pairs());
        count.filter(|count| *count <= most)?;
        let numbers = Numbers::new(self, crowd);
        let course = numbers.course(times)?;
        let pairs = crowd.pairs() as f64;
        let mean = |p: &Vec<f64>, of: fn(&[u32]) -> u32| {
            let each = p.iter().enumerate();
            let sum: f64 = each.map(|(k, p)| p * f64::from(of(numbers.of(k)))).sum();
            (sum / pairs).max(0.0)
        };
        let bound = |p| mean(p, |state| state[0]);
        let trapped = |p| mean(p, |state| state[1..].iter().sum());
        Some(Shares {
            bound: course.values.iter().map(bound).collect(),
            trapped: course.values.iter().map(trapped).collect(),
            error: course.error,
            exact: true,
        })
    }

    /// The same by the forward equation if a crowd has at most `most` states, and by mean numbers
    /// otherwise; `None` if neither can be solved.
    pub fn shares(&self, crowd: &Crowd, times: &[f64], most: usize) -> Option<Shares> {
        self.forward_equation(crowd, times, most).or_else(|| {
            let course = self.mean_numbers(crowd, times)?;
            let pairs = crowd.pairs() as f64;
            let bound = |row: &Vec<f64>| (row[0] / pairs).max(0.0);
            let trapped = |row: &Vec<f64>| (row[1..].iter().sum::<f64>() / pairs).max(0.0);
            Some(Shares {
                bound: course.values.iter().map(bound).collect(),
                trapped: course.values.iter().map(trapped).collect(),
                error: course.error / pairs,
                exact: false,
            })
        })
    }

    /// Numbers of pairs in each state at `time` (s) in one run of the exact simulation; `None` if
    /// it has too many events.
    pub fn simulate(&self, crowd: &Crowd, time: f64, rng: &mut ChaCha8Rng) -> Option<Vec<usize>> {
        let n = self.on.len();
        let mut numbers = vec![0usize; n];
        let mut rates = vec![0.0; n * (n + 2)];
        let mut now = 0.0;
        for event in 0..MOST_EVENTS {
            if event % 1024 == 0 {
                interruption::check();
            }
            let held: usize = numbers.iter().sum();
            let [meeting, _] = crowd.meetings(held as f64);
            for i in 0..n {
                let here = numbers[i] as f64;
                rates[i] = self.on[i] * meeting;
                rates[n + i] = self.off[i] * here;
                for j in 0..n {
                    rates[(2 + i) * n + j] = self.turns[(i, j)] * here;
                }
            }
            let all: f64 = rates.iter().sum();
            now += -libm::log(1.0 - rng.random::<f64>()) / all;
            // Never, if no event is possible.
            if now.is_nan() || now >= time {
                return Some(numbers);
            }
            let chosen = chosen(rates.iter().copied(), rng.random::<f64>() * all);
            match (chosen / n, chosen % n) {
                (0, i) => numbers[i] += 1,
                (1, i) => numbers[i] = numbers[i].saturating_sub(1),
                (row, j) => {
                    numbers[row - 2] = numbers[row - 2].saturating_sub(1);
                    numbers[j] += 1;
                }
            }
        }
        None
    }
}

/// The logarithm of a sum of numbers of which the logarithms are given.
fn sum_of_logs(logs: &[f64]) -> f64 {
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    most + libm::log(logs.iter().map(|log| libm::exp(log - most)).sum::<f64>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::docking::stream;
    use crate::dynamics::exits::mean_and_error;
    use crate::kinetics::population::mixture;

    /// A bond and traps whose lifetimes differ by six powers of ten.
    fn rates() -> PairRates {
        let on = vec![0.008, 0.03, 0.01, 0.004];
        PairRates::through_free(on, vec![2e-4, 27.0, 0.02, 1e-5])
    }

    fn crowd(pairs: usize) -> Crowd {
        Crowd {
            tiles: [pairs; 2],
            one_kind: false,
            area: 0.4 * pairs as f64,
            table: 0.4 * pairs as f64,
        }
    }

    /// Two equal tiles are one pair, as two different ones are; of four equal tiles six pairs can form
    /// first, and equilibrium, the forward equation and simulations agree.
    #[test]
    fn tiles_of_one_kind_are_counted_once() {
        let rates = rates();
        let equal = |tiles: usize| Crowd {
            tiles: [tiles / 2; 2],
            one_kind: true,
            area: 0.8,
            table: 0.8,
        };
        let different = Crowd {
            one_kind: false,
            ..equal(2)
        };
        assert_eq!(equal(4).meetings(0.0)[0] * 0.8, 6.0);
        let shares = |crowd: &Crowd, time: f64| {
            let shares = rates.forward_equation(crowd, &[time], MOST_STATES);
            shares.unwrap().bound[0]
        };
        for time in [3.0, 300.0] {
            let [one, two] = [equal(2), different].map(|crowd| shares(&crowd, time));
            assert!((one - two).abs() < 1e-12, "{one} {two}");
        }
        let late = shares(&equal(6), 1e8);
        let expected = rates.equilibrium(&equal(6)).unwrap();
        assert!((late - expected).abs() < 1e-6, "{late} {expected}");
        let time = 40.0;
        let runs = (0..4000).map(|run| {
            let numbers = rates.simulate(&equal(6), time, &mut stream(3, run));
            numbers.unwrap()[0] as f64 / 3.0
        });
        let [mean, error] = mean_and_error(&runs.collect::<Vec<_>>());
        let exact = shares(&equal(6), time);
        assert!((mean - exact).abs() < 4.0 * error, "{mean} {error} {exact}");
    }

    /// One pair: the crowd's chain is the pair's.
    #[test]
    fn two_tiles_are_a_pair() {
        let found = rates().forward_equation(&crowd(1), &[40.0], 100).unwrap();
        let alone = rates()
            .pair_chain(0.4)
            .occupation(&[1.0, 0.0, 0.0, 0.0, 0.0], 40.0);
        assert!((found.bound[0] - alone[1]).abs() < 1e-7, "{found:?}");
        let trapped: f64 = alone[2..].iter().sum();
        assert!((found.trapped[0] - trapped).abs() < 1e-7, "{found:?}");
    }

    /// All methods agree within their stated errors: the forward equation, the simulation, mean
    /// numbers (whose error the simulation estimates), schedules of one setting, the largest value
    /// of any schedule.
    #[test]
    fn all_views_agree_within_their_errors() {
        let slower = PairRates {
            off: rates().off.iter().map(|off| off / 30.0).collect(),
            ..rates()
        };
        // Some go from trap to trap and on to the bond, in detailed balance.
        let mut turning = rates();
        for (i, j, flow) in [(0, 2, 4e-6), (1, 2, 1e-3), (1, 3, 3e-5)] {
            for (i, j) in [(i, j), (j, i)] {
                turning.turns[(i, j)] = flow * turning.off[i] / turning.on[i];
            }
        }
        for rates in [rates(), slower, turning] {
            for (pairs, time) in [(3, 3.0), (3, 600.0), (5, 60.0)] {
                let crowd = crowd(pairs);
                let exact = rates
                    .forward_equation(&crowd, &[time], MOST_STATES)
                    .unwrap();
                let run = |k| rates.simulate(&crowd, time, &mut stream(5, k)).unwrap();
                let runs: Vec<Vec<usize>> = (0..3000).map(run).collect();
                let of = |share: fn(&Vec<usize>) -> usize| {
                    let shares = runs.iter().map(|run| share(run) as f64 / pairs as f64);
                    mean_and_error(&shares.collect::<Vec<f64>>())
                };
                let simulated = [of(|run| run[0]), of(|run| run[1..].iter().sum())];
                for ([mean, error], exact_share) in simulated
                    .into_iter()
                    .zip([exact.bound[0], exact.trapped[0]])
                {
                    let far = (mean - exact_share).abs();
                    assert!(
                        far < 4.0 * error + exact.error,
                        "{pairs}, {time}: {far} {error}"
                    );
                }
                let smooth = rates.shares(&crowd, &[time], 0).unwrap();
                let [mean, error] = simulated[0];
                let stated = (smooth.bound[0] - mean).abs() + 2.0 * error;
                let far = (smooth.bound[0] - exact.bound[0]).abs();
                assert!(
                    !smooth.exact && far <= stated + 2.0 * error,
                    "{far} {stated}"
                );
                let values: Vec<f64> = {
                    let numbers = Numbers::new(&rates, &crowd);
                    let states = 0..numbers.len();
                    states
                        .map(|k| f64::from(numbers.of(k)[0]) / pairs as f64)
                        .collect()
                };
                let chain = Numbers::new(&rates, &crowd).chain();
                let alone = mixture::schedule(&[chain], &values, time, 4);
                for share in [alone.value, alone.bound] {
                    assert!((share - exact.bound[0]).abs() < 1e-6, "{share} {exact:?}");
                }
            }
        }
    }

    /// Traps with different lifetimes are not equivalent to a single trap with their mean lifetime,
    /// which would be wrong by more than a third.
    #[test]
    fn unlike_traps_are_not_one() {
        let rates = PairRates::through_free(vec![0.008, 0.03, 0.02], vec![2e-6, 20.0, 1e-5]);
        let held: f64 = (1..3).map(|i| rates.on[i] / rates.off[i]).sum();
        let on = rates.on[1] + rates.on[2];
        let as_one = PairRates::through_free(vec![rates.on[0], on], vec![rates.off[0], on / held]);
        let share = |rates: &PairRates| {
            let found = rates.forward_equation(&crowd(3), &[3000.0], MOST_STATES);
            found.unwrap().bound[0]
        };
        assert!(share(&rates) > 1.3 * share(&as_one), "{}", share(&rates));
    }

    /// Mean numbers are right for many tiles.
    #[test]
    fn mean_numbers_are_those_of_many_tiles() {
        let rates = PairRates::through_free(vec![0.02, 0.03], vec![2e-3, 0.2]);
        let far = |pairs: usize| {
            let crowd = Crowd {
                tiles: [pairs; 2],
                one_kind: false,
                area: 2.4 * pairs as f64,
                table: 2.4 * pairs as f64,
            };
            let of = |most: usize| rates.shares(&crowd, &[60.0], most).unwrap().bound[0];
            (of(MOST_STATES) - of(0)).abs()
        };
        let [few, many] = [far(3), far(40)];
        assert!(many < 0.01 && many < 0.2 * few, "{few} {many}");
    }

    /// In the long run the numbers follow the law of mass action, for one pair and for several.
    #[test]
    fn equilibrium_is_that_of_the_constants() {
        let rates = PairRates::through_free(vec![0.02, 0.03, 0.01], vec![2e-3, 0.2, 0.01]);
        let weights = [1.0, 0.02 / 2.0 / 2e-3, 0.03 / 2.0 / 0.2, 0.01 / 2.0 / 0.01];
        let one = Crowd {
            tiles: [1, 1],
            one_kind: false,
            area: 2.0,
            table: 2.0,
        };
        let share = weights[1] / weights.iter().sum::<f64>();
        assert!((rates.equilibrium(&one).unwrap() - share).abs() < 1e-12);
        for pairs in [1, 4] {
            let crowd = crowd(pairs);
            let later = rates.forward_equation(&crowd, &[1e6], MOST_STATES).unwrap();
            let equilibrium = rates.equilibrium(&crowd).unwrap();
            assert!(
                (later.bound[0] - equilibrium).abs() < 1e-6,
                "{later:?} {equilibrium}"
            );
        }
        let many = rates.equilibrium(&crowd(3000)).unwrap();
        let later = rates.mean_numbers(&crowd(3000), &[1e6]).unwrap();
        assert!((later.values[0][0] / 3000.0 - many).abs() < 1e-3, "{many}");
    }
}
