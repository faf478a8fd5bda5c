//! Many tiles on a table: how many of them are bound, and how many caught, after a time.
//!
//! Half of the tiles are of the fixed tile's kind, half of the moving one's. A tile binds one
//! partner at most (pairs are the product; no larger assembly is looked at), every tile of the one
//! kind meets every free one of the other equally often (a well stirred table), and a pair goes from
//! state to state by constant rates. With a and b free tiles of the two kinds, n_i pairs in state i
//! and a table of the area S,
//!
//! `a + b -> i at kappa_i a b / S,   i -> a + b at k_i n_i,   i -> j at k_ij n_i.`
//!
//! Three views of the same: difference equations for the mean numbers, an event at a time (Hosokawa,
//! Shimoyama and Miura 1994, doi:10.1162/artl.1994.1.413), the forward equation of Kolmogorov for
//! all probabilities, where traps are taken together as one kind, and exact stochastic simulation
//! (Gillespie 1977, doi:10.1021/j100540a008).

use nalgebra::DMatrix;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::chain::Chain;
use crate::interruption;

/// Most pairs for which all probabilities are computed: 406 states.
pub const MOST_PAIRS: usize = 27;
/// A step of the difference equations is at most this share of the fastest state's lifetime.
const SHARE: f64 = 0.1;
/// Most steps of the difference equations, and most events of a simulation.
const MOST_STEPS: usize = 20_000_000;

/// The rates of a pair of tiles: state 0 is the bond, the others are traps.
#[derive(Clone, Debug, PartialEq)]
pub struct PairRates {
    /// kappa: attachments a second for one tile a square metre (m^2/s).
    pub on: Vec<f64>,
    /// Detachments a second (1/s).
    pub off: Vec<f64>,
    /// From state to state without coming free (1/s), row: from.
    pub turns: DMatrix<f64>,
}

/// A table and the tiles on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crowd {
    /// How many tiles of the fixed and of the moving tile's kind.
    pub tiles: [usize; 2],
    /// The table's area (m^2).
    pub area: f64,
}

impl Crowd {
    /// So many tiles, half of either kind, of `tile_area` (m^2) that cover a share of a table.
    pub fn new(tiles: usize, coverage: f64, tile_area: f64) -> Self {
        Self {
            tiles: [tiles.div_ceil(2), tiles / 2],
            area: tiles as f64 * tile_area / coverage,
        }
    }

    /// Most pairs that there can be.
    pub fn pairs(&self) -> usize {
        self.tiles[0].min(self.tiles[1])
    }
}

impl PairRates {
    /// Rates without ways from state to state but through free tiles.
    pub fn through_free(on: Vec<f64>, off: Vec<f64>) -> Self {
        let n = on.len();
        Self {
            on,
            off,
            turns: DMatrix::zeros(n, n),
        }
    }

    /// The chain of a single pair on a table: state 0 is free, then come the bond and the traps.
    pub fn pair_chain(&self, area: f64) -> Chain {
        let n = self.on.len();
        let mut rates = DMatrix::zeros(n + 1, n + 1);
        for i in 0..n {
            rates[(0, i + 1)] = self.on[i] / area;
            rates[(i + 1, 0)] = self.off[i];
            for j in (0..n).filter(|j| *j != i) {
                rates[(i + 1, j + 1)] = self.turns[(i, j)];
            }
        }
        Chain::new(rates)
    }

    /// The bond, and all traps as one state that holds and lets go as they do together in
    /// equilibrium.
    pub fn lumped(&self) -> Self {
        if self.on.len() <= 2 {
            return self.clone();
        }
        let traps = 1..self.on.len();
        let on: f64 = self.on[traps.clone()].iter().sum();
        // Occupation against free tiles, kappa / k.
        let held: f64 = traps.clone().map(|i| self.on[i] / self.off[i]).sum();
        if on <= 0.0 || held <= 0.0 {
            return Self::through_free(vec![self.on[0]], vec![self.off[0]]);
        }
        let share = |i: usize| self.on[i] / self.off[i] / held;
        let mut turns = DMatrix::zeros(2, 2);
        turns[(0, 1)] = traps.clone().map(|i| self.turns[(0, i)]).sum();
        turns[(1, 0)] = traps.clone().map(|i| share(i) * self.turns[(i, 0)]).sum();
        let off = traps.map(|i| share(i) * self.off[i]).sum();
        Self {
            on: vec![self.on[0], on],
            off: vec![self.off[0], off],
            turns,
        }
    }

    /// The same as [`Self::lumped`], with a kind of trap that never catches anything where there is
    /// none.
    pub fn with_traps(&self) -> Self {
        let lumped = self.lumped();
        match lumped.on.len() {
            1 => Self::through_free(vec![lumped.on[0], 0.0], vec![lumped.off[0], 1.0]),
            _ => lumped,
        }
    }

    /// The share of all possible pairs that are in the bond in equilibrium; `None` for more than
    /// [`MOST_PAIRS`], and where nothing ever attaches.
    pub fn equilibrium(&self, crowd: &Crowd) -> Option<f64> {
        if crowd.pairs() > MOST_PAIRS {
            return None;
        }
        let (states, chain) = self.crowd_chain(crowd);
        let found = chain.stationary()?;
        let bound = states
            .iter()
            .zip(found)
            .map(|(state, p)| state[0] as f64 * p);
        Some(bound.sum::<f64>() / crowd.pairs() as f64)
    }

    /// Mean numbers of pairs in the bond and in each trap at `time` (s) by Hosokawa's difference equations: at each step as much happens as
    /// one event, or a tenth of the shortest lifetime passes. `None` where that takes too many steps.
    pub fn difference_equations(&self, crowd: &Crowd, time: f64) -> Option<Vec<f64>> {
        let n = self.on.len();
        let leaving = |i: usize| self.off[i] + self.turns.row(i).sum();
        let fastest = (0..n).map(leaving).fold(0.0, f64::max);
        let most_on = self.on.iter().sum::<f64>() / crowd.area;
        let fastest = fastest + most_on * (crowd.tiles[0] + crowd.tiles[1]) as f64;
        let mut numbers = vec![0.0; n];
        let mut now = 0.0;
        for step in 0..MOST_STEPS {
            if step % 1024 == 0 {
                interruption::check();
            }
            let held: f64 = numbers.iter().sum();
            let [a, b] = crowd.tiles.map(|tiles| tiles as f64 - held);
            let meeting = a * b / crowd.area;
            let all = most_on * a * b + (0..n).map(|i| leaving(i) * numbers[i]).sum::<f64>();
            let step = (1.0 / all).min(SHARE / fastest).min(time - now);
            let change = |i: usize| {
                let turned = (0..n).map(|j| self.turns[(j, i)] * numbers[j]).sum::<f64>();
                self.on[i] * meeting + turned - leaving(i) * numbers[i]
            };
            let changes: Vec<f64> = (0..n).map(change).collect();
            for (number, change) in numbers.iter_mut().zip(changes) {
                *number += step * change;
            }
            now += step;
            if now >= time {
                return Some(numbers);
            }
        }
        None
    }

    /// All numbers of pairs in the bond and in traps (taken together, see [`Self::lumped`]) that a
    /// crowd can have, and the chain among them.
    pub fn crowd_chain(&self, crowd: &Crowd) -> (Vec<[usize; 2]>, Chain) {
        let rates = self.lumped();
        let kinds = rates.on.len();
        let pairs = crowd.pairs();
        let most_trapped = |bound: usize| if kinds > 1 { pairs - bound } else { 0 };
        let states: Vec<[usize; 2]> = (0..=pairs)
            .flat_map(|bound| (0..=most_trapped(bound)).map(move |trapped| [bound, trapped]))
            .collect();
        let index = |state: [usize; 2]| states.binary_search(&state).ok();
        let mut chain = DMatrix::zeros(states.len(), states.len());
        for (k, state) in states.iter().enumerate() {
            let free = crowd
                .tiles
                .map(|tiles| (tiles - state[0] - state[1]) as f64);
            let meeting = free[0] * free[1] / crowd.area;
            let mut add = |to: Option<usize>, rate: f64| {
                if let Some(to) = to {
                    chain[(k, to)] += rate;
                }
            };
            for i in 0..kinds {
                let mut more = *state;
                more[i] += 1;
                add(index(more), rates.on[i] * meeting);
                if state[i] == 0 {
                    continue;
                }
                let mut fewer = *state;
                fewer[i] -= 1;
                add(index(fewer), rates.off[i] * state[i] as f64);
                for j in (0..kinds).filter(|j| *j != i) {
                    let mut turned = fewer;
                    turned[j] += 1;
                    add(index(turned), rates.turns[(i, j)] * state[i] as f64);
                }
            }
        }
        (states, Chain::new(chain))
    }

    /// The probability of each number of pairs in the bond at `time` (s), from 0 on, and the mean
    /// number in traps, by Kolmogorov's forward equation. `None` for more than [`MOST_PAIRS`].
    pub fn forward_equation(&self, crowd: &Crowd, time: f64) -> Option<(Vec<f64>, f64)> {
        if crowd.pairs() > MOST_PAIRS {
            return None;
        }
        let (states, chain) = self.crowd_chain(crowd);
        let mut start = vec![0.0; states.len()];
        start[0] = 1.0;
        let found = chain.occupation(&start, time);
        let mut bound = vec![0.0; crowd.pairs() + 1];
        let mut trapped = 0.0;
        for (state, p) in states.iter().zip(found) {
            bound[state[0]] += p;
            trapped += p * state[1] as f64;
        }
        Some((bound, trapped))
    }

    /// Numbers of pairs in each state at `time` (s) in one run of the exact simulation; `None` where
    /// it has too many events.
    pub fn simulate(&self, crowd: &Crowd, time: f64, rng: &mut ChaCha8Rng) -> Option<Vec<usize>> {
        let n = self.on.len();
        let mut numbers = vec![0usize; n];
        let mut rates = vec![0.0; n * (n + 2)];
        let mut now = 0.0;
        for event in 0..MOST_STEPS {
            if event % 1024 == 0 {
                interruption::check();
            }
            let held: usize = numbers.iter().sum();
            let free = crowd.tiles.map(|tiles| (tiles - held) as f64);
            let meeting = free[0] * free[1] / crowd.area;
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
            // Never, where nothing can happen.
            if now.is_nan() || now >= time {
                return Some(numbers);
            }
            let mut rest = rng.random::<f64>() * all;
            let mut chosen = rates.len() - 1;
            for (k, rate) in rates.iter().enumerate() {
                if rest < *rate {
                    chosen = k;
                    break;
                }
                rest -= rate;
            }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::docking::stream;

    fn rates() -> PairRates {
        PairRates::through_free(vec![0.02, 0.03], vec![2e-3, 0.2])
    }

    fn mean(bound: &[f64]) -> f64 {
        bound.iter().enumerate().map(|(k, p)| k as f64 * p).sum()
    }

    /// One pair: the crowd's chain is the pair's.
    #[test]
    fn two_tiles_are_a_pair() {
        let crowd = Crowd {
            tiles: [1, 1],
            area: 3.0,
        };
        let (bound, trapped) = rates().forward_equation(&crowd, 40.0).unwrap();
        let alone = rates().pair_chain(3.0).occupation(&[1.0, 0.0, 0.0], 40.0);
        assert!((bound[1] - alone[1]).abs() < 1e-12 && (trapped - alone[2]).abs() < 1e-12);
    }

    /// The forward equation within the simulation's error, for few tiles; difference equations for
    /// many.
    #[test]
    fn three_views_agree() {
        let crowd = Crowd {
            tiles: [5, 5],
            area: 12.0,
        };
        let (bound, trapped) = rates().forward_equation(&crowd, 60.0).unwrap();
        let count = 4000;
        let (mut sums, mut squares) = ([0.0; 2], [0.0; 2]);
        for k in 0..count {
            let run = rates().simulate(&crowd, 60.0, &mut stream(5, k)).unwrap();
            for i in 0..2 {
                sums[i] += run[i] as f64;
                squares[i] += (run[i] * run[i]) as f64;
            }
        }
        for (i, exact) in [mean(&bound), trapped].into_iter().enumerate() {
            let n = count as f64;
            let found = sums[i] / n;
            let error = ((squares[i] / n - found * found) / n).sqrt();
            assert!(
                (found - exact).abs() < 4.0 * error,
                "{i}: {found} {exact} {error}"
            );
        }
        let crowded = |pairs: usize| {
            let crowd = Crowd {
                tiles: [pairs; 2],
                area: 2.4 * pairs as f64,
            };
            let (bound, _) = rates().forward_equation(&crowd, 60.0).unwrap();
            let smooth = rates().difference_equations(&crowd, 60.0).unwrap()[0];
            (mean(&bound) - smooth).abs() / pairs as f64
        };
        let [few, many] = [crowded(3), crowded(24)];
        assert!(many < 0.01 && many < 0.3 * few, "{few} {many}");
    }

    /// In the long run numbers are those of the law of mass action for one pair.
    #[test]
    fn equilibrium_is_that_of_the_constants() {
        let crowd = Crowd {
            tiles: [1, 1],
            area: 2.0,
        };
        let (bound, trapped) = rates().forward_equation(&crowd, 1e7).unwrap();
        let weights = [1.0, 0.02 / 2.0 / 2e-3, 0.03 / 2.0 / 0.2];
        let total: f64 = weights.iter().sum();
        assert!((bound[1] - weights[1] / total).abs() < 1e-10);
        assert!((trapped - weights[2] / total).abs() < 1e-10);
    }
}
