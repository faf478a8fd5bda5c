//! The Markov chain over the numbers of pairs in each kind of state: sparse, for stiff rates.
//!
//! A state of a crowd is (n_0, n_1, ...): the numbers of pairs in the bond and in each kind of
//! trap; there are H states in all. Attachment increases one number, detachment decreases one, and
//! a pair that changes its state does both, so a state has few neighbours. Probabilities p follow
//! p' = Q^T p with the generator Q (1/s).
//!
//! Implicit Euler steps solve `(1 - h Q^T) x = p` by restarted GMRES (Saad and Schultz 1986,
//! doi:10.1137/0907058), preconditioned by a Gauss-Seidel sweep from many pairs to few (which
//! treats detachments, the fast transitions, exactly) and back. As no column sum of the inverse
//! exceeds 1, the sum of the absolute residuals bounds that of the errors.

use nalgebra::DMatrix;

use super::chain::Chain;
use super::crowd::{Crowd, PairRates};
use super::stiff::{self, Course};

/// Vectors of GMRES between restarts, and restarts.
const VECTORS: usize = 40;
const RESTARTS: usize = 25;
/// Residuals of the probabilities, sum of absolute values.
const RESIDUAL: f64 = 1e-12;
/// Error allowed in the probabilities at each step, sum of absolute values.
const TOLERANCE: f64 = 1e-9;

/// All states of a crowd, and the rates among them.
#[derive(Clone, Debug, PartialEq)]
pub struct Numbers {
    /// Kinds of states.
    kinds: usize,
    /// The numbers of pairs of each state, state by state; few pairs first.
    pairs: Vec<u32>,
    /// Where the entries of each state begin in `into`.
    begins: Vec<usize>,
    /// Source states and rates (1/s), in ascending order.
    into: Vec<(usize, f64)>,
    /// The rate (1/s) at which each state is left.
    out: Vec<f64>,
}

/// The number of states of a crowd with the given numbers of pairs and kinds; `None` if it is
/// astronomical.
pub fn count(kinds: usize, pairs: usize) -> Option<usize> {
    (1..=pairs).try_fold(1usize, |count, k| {
        count.checked_mul(kinds + k).map(|count| count / k)
    })
}

impl Numbers {
    /// The chain of a crowd with the rates of a pair.
    pub fn new(rates: &PairRates, crowd: &Crowd) -> Self {
        let (kinds, most) = (rates.on.len(), crowd.pairs());
        let mut states: Vec<Vec<u32>> = vec![vec![]];
        for _ in 0..kinds {
            let longer = |state: &Vec<u32>| {
                let held: u32 = state.iter().sum();
                let state = state.clone();
                (0..=most as u32 - held).map(move |n| [&state[..], &[n]].concat())
            };
            states = states.iter().flat_map(longer).collect();
        }
        let held = |state: &[u32]| state.iter().sum::<u32>();
        states.sort_by(|a, b| (held(a), a).cmp(&(held(b), b)));
        let place = |state: &[u32]| {
            let key = (held(state), state);
            states
                .binary_search_by(|other| (held(other), &other[..]).cmp(&key))
                .ok()
        };
        let meeting = |state: &[u32]| crowd.meetings(f64::from(held(state)))[0];
        let (mut begins, mut into) = (vec![0], Vec::new());
        let mut out = vec![0.0; states.len()];
        for state in &states {
            let mut here = Vec::new();
            for kind in 0..kinds {
                let mut other = state.clone();
                if let Some(fewer) = state[kind].checked_sub(1) {
                    other[kind] = fewer;
                    let rate = rates.on[kind] * meeting(&other);
                    here.extend(place(&other).map(|from| (from, rate)));
                }
                other[kind] = state[kind] + 1;
                let rate = rates.off[kind] * f64::from(other[kind]);
                here.extend(place(&other).map(|from| (from, rate)));
                for to in (0..kinds).filter(|to| *to != kind && state[*to] > 0) {
                    let rate = rates.turns[(kind, to)] * f64::from(other[kind]);
                    if rate > 0.0 {
                        other[to] -= 1;
                        here.extend(place(&other).map(|from| (from, rate)));
                        other[to] += 1;
                    }
                }
            }
            here.retain(|entry| entry.1 > 0.0 && entry.1.is_finite());
            here.sort_by_key(|entry| entry.0);
            for (from, rate) in &here {
                out[*from] += rate;
            }
            into.extend(here);
            begins.push(into.len());
        }
        Self {
            kinds,
            pairs: states.concat(),
            begins,
            into,
            out,
        }
    }

    /// How many states there are.
    pub fn len(&self) -> usize {
        self.out.len()
    }

    /// Whether there are no states; the first, in which all tiles are free, always exists.
    pub fn is_empty(&self) -> bool {
        self.out.is_empty()
    }

    /// The numbers of pairs of a state: in the bond, then in each kind of trap.
    pub fn of(&self, state: usize) -> &[u32] {
        &self.pairs[state * self.kinds..][..self.kinds]
    }

    /// The source states of a state, and their rates (1/s).
    pub fn into(&self, state: usize) -> &[(usize, f64)] {
        &self.into[self.begins[state]..self.begins[state + 1]]
    }

    /// The same as a dense chain, for few states.
    pub fn chain(&self) -> Chain {
        let mut rates = DMatrix::zeros(self.len(), self.len());
        for state in 0..self.len() {
            for (from, rate) in self.into(state) {
                rates[(*from, state)] = *rate;
            }
        }
        Chain::new(rates)
    }

    /// The probabilities of all states at ascending `times` (s), starting with all tiles free;
    /// `None` if the solver fails.
    pub fn course(&self, times: &[f64]) -> Option<Course> {
        let mut start = vec![0.0; self.len()];
        start[0] = 1.0;
        let fastest = self.out.iter().copied().fold(0.0, f64::max);
        let first = match fastest > 0.0 {
            true => 0.1 / fastest,
            false => f64::MAX,
        };
        stiff::integrate(start, times, first, TOLERANCE, |p, h| self.euler(p, h))
    }

    /// `p - h Q^T x - x`, and the sum of absolute values.
    fn residual(&self, p: &[f64], x: &[f64], h: f64) -> (Vec<f64>, f64) {
        let of = |state: usize| p[state] - self.applied(x, h, state);
        let residual: Vec<f64> = (0..self.len()).map(of).collect();
        let sum = residual.iter().map(|r| r.abs()).sum();
        (residual, sum)
    }

    /// A component of `(1 - h Q^T) x`.
    fn applied(&self, x: &[f64], h: f64, state: usize) -> f64 {
        let into: f64 = self
            .into(state)
            .iter()
            .map(|(from, rate)| rate * x[*from])
            .sum();
        x[state] + h * (self.out[state] * x[state] - into)
    }

    /// The sweeps, there and back.
    fn swept(&self, mut x: Vec<f64>, h: f64) -> Vec<f64> {
        for state in (0..self.len()).rev() {
            let later = self
                .into(state)
                .iter()
                .rev()
                .take_while(|(from, _)| *from > state);
            let into: f64 = later.map(|(from, rate)| rate * x[*from]).sum();
            x[state] = (x[state] + h * into) / (1.0 + h * self.out[state]);
        }
        for state in 0..self.len() {
            let earlier = self
                .into(state)
                .iter()
                .take_while(|(from, _)| *from < state);
            let into: f64 = earlier.map(|(from, rate)| rate * x[*from]).sum();
            x[state] += h * into / (1.0 + h * self.out[state]);
        }
        x
    }

    /// An implicit Euler step of the length h (s).
    fn euler(&self, p: &[f64], h: f64) -> Option<Vec<f64>> {
        let mut x = p.to_vec();
        for _ in 0..RESTARTS {
            let (residual, sum) = self.residual(p, &x, h);
            // Rounding errors.
            let flow: f64 = x.iter().zip(&self.out).map(|(x, out)| x.abs() * out).sum();
            if sum <= RESIDUAL + 16.0 * f64::EPSILON * h * flow {
                return Some(x);
            }
            let change = self.swept(self.gmres(residual, h), h);
            for (x, change) in x.iter_mut().zip(change) {
                *x += change;
            }
        }
        None
    }

    /// The correction, before the sweep, that reduces a residual as much as [`VECTORS`] vectors
    /// can.
    fn gmres(&self, residual: Vec<f64>, h: f64) -> Vec<f64> {
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let dot = |v: &[f64], w: &[f64]| v.iter().zip(w).map(|(x, y)| x * y).sum::<f64>();
        let scaled = |v: Vec<f64>, by: f64| v.into_iter().map(|x| x / by).collect::<Vec<f64>>();
        let size = norm(&residual);
        let mut basis = vec![scaled(residual, size)];
        // Columns of the upper triangle, and the right side, both turned by Givens' rotations.
        let (mut columns, mut turns) = (Vec::<Vec<f64>>::new(), Vec::<[f64; 2]>::new());
        let mut right = vec![size];
        for k in 0..VECTORS {
            let z = self.swept(basis[k].clone(), h);
            let mut w: Vec<f64> = (0..self.len())
                .map(|state| self.applied(&z, h, state))
                .collect();
            let mut column = Vec::with_capacity(k + 2);
            for v in &basis {
                let share = dot(&w, v);
                column.push(share);
                w.iter_mut().zip(v).for_each(|(w, v)| *w -= share * v);
            }
            let rest = norm(&w);
            for (i, [c, s]) in turns.iter().enumerate() {
                let (a, b) = (column[i], column[i + 1]);
                (column[i], column[i + 1]) = (c * a + s * b, c * b - s * a);
            }
            let length = (column[k] * column[k] + rest * rest).sqrt();
            if length == 0.0 {
                break;
            }
            let [c, s] = [column[k] / length, rest / length];
            column[k] = length;
            columns.push(column);
            turns.push([c, s]);
            right.push(-s * right[k]);
            right[k] *= c;
            // In the Euclidean norm, which is at most the sum of absolute values.
            if right[k + 1].abs() * (self.len() as f64).sqrt() <= 0.1 * RESIDUAL || rest == 0.0 {
                break;
            }
            basis.push(scaled(w, rest));
        }
        let mut y = vec![0.0; columns.len()];
        for i in (0..columns.len()).rev() {
            let later: f64 = (i + 1..columns.len()).map(|j| columns[j][i] * y[j]).sum();
            y[i] = (right[i] - later) / columns[i][i];
        }
        let mut sum = vec![0.0; self.len()];
        for (v, y) in basis.iter().zip(y) {
            sum.iter_mut().zip(v).for_each(|(sum, v)| *sum += y * v);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same as the dense chain, squared from short times: an independent method.
    #[test]
    fn sparse_and_dense_chains_agree() {
        let mut rates = PairRates::through_free(vec![0.02, 0.03, 0.004], vec![1e-7, 25.0, 3e-3]);
        rates.turns[(1, 0)] = 0.4;
        rates.turns[(0, 1)] = 1e-9;
        let crowd = Crowd {
            tiles: [4, 4],
            one_kind: false,
            area: 3.0,
            table: 3.0,
        };
        let numbers = Numbers::new(&rates, &crowd);
        assert_eq!(Some(numbers.len()), count(3, 4));
        let dense = numbers.chain();
        let mut start = vec![0.0; numbers.len()];
        start[0] = 1.0;
        for time in [0.02, 7.0, 600.0, 1e5] {
            let found = numbers.course(&[time]).unwrap();
            let exact = dense.occupation(&start, time);
            let off: f64 = found.values[0]
                .iter()
                .zip(&exact)
                .map(|(p, q)| (p - q).abs())
                .sum();
            assert!(
                off <= found.error + 1e-10 && found.error < 1e-6,
                "{time}: {off:e}"
            );
        }
    }
}
