//! Continuous-time Markov chains whose rates differ by many powers of ten.
//!
//! There is no cancellation, so small probabilities are as accurate as large ones, however stiff
//! the chain: stationary distributions and mean first-passage times by graph elimination
//! (Grassmann, Taksar and Heyman 1985, doi:10.1287/opre.33.5.1107), occupation over time by
//! uniformisation (Jensen 1953) over a short time, squared as often as it takes.

use nalgebra::DMatrix;

use tiles::matrix::product;

/// Largest probability of leaving any state within the short time.
const SHORT: f64 = 1.0 / 16.0;
/// Terms of the series over the short time: the rest is below 1e-17.
const TERMS: usize = 10;

/// States, and the rates (1/s) at which each turns into each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Rows: from, columns: to; the diagonal is ignored.
    rates: DMatrix<f64>,
}

impl Chain {
    /// The chain of a square matrix of rates (1/s), row: from, column: to. Rates that are not
    /// positive numbers count as 0.
    pub fn new(mut rates: DMatrix<f64>) -> Self {
        for rate in rates.iter_mut() {
            *rate = if rate.is_finite() { rate.max(0.0) } else { 0.0 };
        }
        rates.fill_diagonal(0.0);
        Self { rates }
    }

    /// How many states it has.
    pub fn len(&self) -> usize {
        self.rates.nrows()
    }

    /// Whether it has no states.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The rate (1/s) from one state to another.
    pub fn rate(&self, from: usize, to: usize) -> f64 {
        self.rates[(from, to)]
    }

    /// The probabilities of all transitions over `time` (s): row: from, column: to; rows add up
    /// to 1.
    pub fn transitions(&self, time: f64) -> DMatrix<f64> {
        let n = self.len();
        let leaving = self.rates.row_iter().map(|row| row.sum());
        let fastest = leaving.clone().fold(0.0, f64::max);
        let identity = DMatrix::identity(n, n);
        if fastest * time <= 0.0 {
            return identity;
        }
        let squarings = libm::log2(fastest * time / SHORT).ceil().max(0.0);
        let short = fastest * time / libm::exp2(squarings);
        // One step of the uniformised chain: stay, or go where the rates lead.
        let mut step = &self.rates / fastest;
        for (k, sum) in leaving.enumerate() {
            step[(k, k)] = 1.0 - sum / fastest;
        }
        let mut sum = identity.clone();
        for k in (1..TERMS).rev() {
            sum = &identity + product(&step, &sum) * (short / k as f64);
        }
        let mut all = with_unit_rows(sum);
        for _ in 0..squarings as usize {
            all = with_unit_rows(product(&all, &all));
        }
        all
    }

    /// The probabilities of the states at `time` (s), from those at the start.
    pub fn occupation(&self, start: &[f64], time: f64) -> Vec<f64> {
        let start = DMatrix::from_row_slice(1, start.len(), start);
        product(&start, &self.transitions(time))
            .iter()
            .copied()
            .collect()
    }

    /// The stationary distribution, over the states that can be reached from all others; `None` if
    /// the chain is not connected.
    pub fn stationary(&self) -> Option<Vec<f64>> {
        let n = self.len();
        let mut rates = self.rates.clone();
        for k in (1..n).rev() {
            let out: f64 = (0..k).map(|j| rates[(k, j)]).sum();
            if out <= 0.0 {
                return None;
            }
            eliminate(&mut rates, k, out, 0..k);
        }
        let mut weights = vec![1.0; n];
        for k in 1..n {
            let out: f64 = (0..k).map(|j| rates[(k, j)]).sum();
            let into: f64 = (0..k).map(|j| weights[j] * rates[(j, k)]).sum();
            weights[k] = into / out;
        }
        let total: f64 = weights.iter().sum();
        Some(weights.into_iter().map(|weight| weight / total).collect())
    }

    /// The mean time (s) from each state until one of `ends` is reached: 0 there, infinite if none
    /// is ever reached.
    pub fn mean_times(&self, ends: &[usize]) -> Vec<f64> {
        let n = self.len();
        let inner: Vec<usize> = (0..n).filter(|k| !ends.contains(k)).collect();
        // The remaining states, then one for all ends.
        let m = inner.len();
        let mut rates = DMatrix::zeros(m + 1, m + 1);
        for (a, &from) in inner.iter().enumerate() {
            for (b, &to) in inner.iter().enumerate() {
                rates[(a, b)] = self.rates[(from, to)];
            }
            rates[(a, m)] = ends.iter().map(|&end| self.rates[(from, end)]).sum();
        }
        // Waiting, in units of a state's own rate: `rate out * mean = waiting + sum of rates *
        // means`.
        let mut waiting = vec![1.0; m];
        let mut outs = vec![0.0; m];
        for k in (0..m).rev() {
            let out = (0..k).map(|j| rates[(k, j)]).sum::<f64>() + rates[(k, m)];
            outs[k] = out;
            let into_k: Vec<usize> = (0..k).filter(|j| rates[(*j, k)] > 0.0).collect();
            for j in into_k {
                // Infinite if nothing leads out of k.
                waiting[j] += rates[(j, k)] / out * waiting[k];
            }
            if out > 0.0 {
                eliminate(&mut rates, k, out, (0..k).chain(m..m + 1));
            }
        }
        let mut means = vec![0.0; m];
        for k in 0..m {
            let onwards = (0..k).map(|j| match rates[(k, j)] > 0.0 {
                true => rates[(k, j)] * means[j],
                false => 0.0,
            });
            let sum: f64 = waiting[k] + onwards.sum::<f64>();
            means[k] = if outs[k] > 0.0 {
                sum / outs[k]
            } else {
                f64::INFINITY
            };
        }
        let mut all = vec![0.0; n];
        for (mean, &state) in means.into_iter().zip(&inner) {
            all[state] = mean;
        }
        all
    }
}

/// Eliminates state k: its transitions go directly among `left`, to which it has the total rate
/// `out`.
fn eliminate(
    rates: &mut DMatrix<f64>,
    k: usize,
    out: f64,
    left: impl Iterator<Item = usize> + Clone,
) {
    for i in 0..k {
        let share = rates[(i, k)] / out;
        if share > 0.0 {
            for j in left.clone().filter(|j| *j != i) {
                let through = share * rates[(k, j)];
                rates[(i, j)] += through;
            }
        }
    }
}

/// Scales rows to sum to 1, to correct rounding and truncation of the series.
fn with_unit_rows(mut matrix: DMatrix<f64>) -> DMatrix<f64> {
    for mut row in matrix.row_iter_mut() {
        let sum = row.sum();
        row /= sum;
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two states: p(t) = p_eq + (p_0 - p_eq) exp(-(a + b) t).
    #[test]
    fn two_states_relax_exponentially() {
        let (a, b) = (3.0, 0.5);
        let chain = Chain::new(DMatrix::from_row_slice(2, 2, &[0.0, a, b, 0.0]));
        for time in [0.0, 1e-6, 0.1, 1.0, 20.0] {
            let exact = a / (a + b) * -libm::expm1(-(a + b) * time);
            let found = chain.occupation(&[1.0, 0.0], time)[1];
            assert!(
                (found - exact).abs() <= 1e-12 * exact,
                "{time}: {found} {exact}"
            );
        }
    }

    /// free <-> bond, free <-> trap with rates over forty powers of ten: detailed balance to
    /// rounding.
    #[test]
    fn stiff_chains_keep_detailed_balance() {
        let mut rates = DMatrix::zeros(4, 4);
        let weights = [1.0, 1e18, 1e-7, 1e3];
        let pairs = [(0, 1, 1e-3), (0, 2, 1e7), (1, 3, 1e-22), (2, 3, 2.0)];
        for (i, j, rate) in pairs {
            rates[(i, j)] = rate;
            rates[(j, i)] = rate * weights[i] / weights[j];
        }
        let chain = Chain::new(rates);
        let found = chain.stationary().expect("one piece");
        let total: f64 = weights.iter().sum();
        for (p, weight) in found.iter().zip(weights) {
            assert!((p * total / weight - 1.0).abs() < 1e-12, "{p:e} {weight:e}");
        }
        let later = chain.occupation(&found, 1e9);
        for (p, q) in found.iter().zip(later) {
            assert!((p / q - 1.0).abs() < 1e-6, "{p:e} {q:e}");
        }
    }

    /// A random walk on a line: from the middle of n steps to either end it takes (n/2)^2.
    #[test]
    fn mean_times_of_a_walk() {
        let n = 21;
        let mut rates = DMatrix::zeros(n, n);
        for k in 0..n - 1 {
            rates[(k, k + 1)] = 0.5;
            rates[(k + 1, k)] = 0.5;
        }
        let times = Chain::new(rates).mean_times(&[0, n - 1]);
        assert!(
            (times[10] - 100.0).abs() < 1e-9 && times[0] == 0.0,
            "{times:?}"
        );
        let apart = Chain::new(DMatrix::zeros(2, 2));
        assert_eq!(apart.mean_times(&[0]), [0.0, f64::INFINITY]);
        assert!(apart.stationary().is_none());
        // From the first state half of the transitions lead to a state without an exit.
        let trap = DMatrix::from_row_slice(3, 3, &[0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(
            Chain::new(trap).mean_times(&[1]),
            [f64::INFINITY, 0.0, f64::INFINITY]
        );
    }
}
