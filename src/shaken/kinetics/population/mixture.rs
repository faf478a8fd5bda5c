//! The best schedule of a passive table, which changes its setting over time without observing the
//! tiles.
//!
//! Time is divided into equal slots with one of several settings each, and each setting is a chain
//! over the same states. A schedule is improved by changing one slot after another as long as that
//! helps. An upper bound of all schedules is the optimum of a linear program (after Klavins, Burden
//! and Napp 2006, doi:10.15607/RSS.2006.II.002): let p_j be the probabilities at the start of slot
//! j, of which the part y_jk spends the slot in setting k with transitions P_k:
//!
//! `sum_k y_jk = p_j,   p_(j+1) = sum_k y_jk P_k,   y >= 0;   greatest p_m . value`.
//!
//! It lets every state choose its setting, as a table that observes its tiles could; a passive
//! table, whose shares are the same for all states, cannot do better. The program is solved
//! backwards, state by state (Bellman's dynamic programming, its dual), which is exact.
//!
//! The design is not such a setting: tiles keep their shapes and magnets. Running some time with
//! one design and some with another yields the mean of both, never more than the better one.

use nalgebra::{DMatrix, RowDVector};

use super::chain::Chain;
use tiles::matrix::product;

/// A schedule, its value, and an upper bound of all schedules.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture {
    /// The setting of each slot.
    pub schedule: Vec<usize>,
    /// Its mean value at the end.
    pub value: f64,
    /// Upper bound of the value of any schedule, up to rounding.
    pub bound: f64,
}

/// The best schedule found of `slots` equal slots over `time` (s), from the first state of all
/// chains, by the mean of `values` over the states at the end.
pub fn schedule(settings: &[Chain], values: &[f64], time: f64, slots: usize) -> Mixture {
    let steps: Vec<DMatrix<f64>> = settings
        .iter()
        .map(|chain| chain.transitions(time / slots as f64))
        .collect();
    let value = |schedule: &[usize]| {
        let mut p = RowDVector::zeros(values.len());
        p[0] = 1.0;
        let end = schedule.iter().fold(p, |p, &k| product(&p, &steps[k]));
        end.iter()
            .zip(values)
            .map(|(p, value)| p * value)
            .sum::<f64>()
    };
    let constant = |k: usize| vec![k; slots];
    let constants = (0..settings.len()).map(|k| (value(&constant(k)), k));
    let best = constants.fold((f64::NEG_INFINITY, 0), |best, next| {
        if next.0 > best.0 { next } else { best }
    });
    let (mut schedule, mut reached) = (constant(best.1), best.0);
    // Also two phases, which changes of single slots do not reach.
    for first in 0..settings.len() {
        for last in (0..settings.len()).filter(|last| *last != first) {
            for turn in 1..slots {
                let two = [vec![first; turn], vec![last; slots - turn]].concat();
                let gained = value(&two);
                if gained > reached {
                    (schedule, reached) = (two, gained);
                }
            }
        }
    }
    let mut improved = true;
    while improved {
        improved = false;
        for slot in 0..slots {
            for k in 0..settings.len() {
                let mut other = schedule.clone();
                other[slot] = k;
                let gained = value(&other);
                if gained > reached * (1.0 + 1e-9) {
                    (schedule, reached, improved) = (other, gained, true);
                }
            }
        }
    }
    Mixture {
        schedule,
        value: reached,
        bound: bound(&steps, values, slots),
    }
}

/// The largest value of any choice of settings by slot and state: from the last slot to the first,
/// the value of a state is the maximum over all settings.
fn bound(steps: &[DMatrix<f64>], values: &[f64], slots: usize) -> f64 {
    let mut worth = DMatrix::from_column_slice(values.len(), 1, values);
    for _ in 0..slots {
        let by_setting: Vec<_> = steps.iter().map(|step| product(step, &worth)).collect();
        worth = DMatrix::from_fn(values.len(), 1, |state, _| {
            let each = by_setting.iter().map(|worth| worth[state]);
            each.fold(f64::NEG_INFINITY, f64::max)
        });
    }
    worth[0]
}

#[cfg(test)]
mod tests {
    use microlp::{ComparisonOp, OptimizationDirection, Problem};

    use super::*;

    fn chain(on: [f64; 2], off: [f64; 2]) -> Chain {
        let rates = [0.0, on[0], on[1], off[0], 0.0, 0.0, off[1], 0.0, 0.0];
        Chain::new(DMatrix::from_row_slice(3, 3, &rates))
    }

    /// Strong shaking frees trapped tiles but binds nothing, weak shaking holds everything: the one
    /// followed by the other is better than either, and not better than the bound.
    #[test]
    fn two_phases_beat_one() {
        let hot = chain([1.0, 0.0], [2.0, 50.0]);
        let cold = chain([0.1, 1.0], [1e-6, 1e-6]);
        let values = [0.0, 1.0, 0.0];
        let alone = |chain: &Chain| schedule(std::slice::from_ref(chain), &values, 10.0, 8);
        let both = schedule(&[hot.clone(), cold.clone()], &values, 10.0, 8);
        for one in [&hot, &cold] {
            let alone = alone(one);
            assert!(both.value > alone.value);
            // With one setting there is nothing to choose.
            assert!((alone.bound - alone.value).abs() < 1e-9);
        }
        assert!(both.bound >= both.value - 1e-9, "{both:?}");
        assert!(both.bound <= 1.0 + 1e-9);
    }

    /// Dynamic programming gives the optimum of the linear program.
    #[test]
    fn the_bound_is_that_of_the_linear_program() {
        let all = [
            chain([1.0, 0.3], [2.0, 50.0]),
            chain([0.1, 1.0], [1e-3, 1e-2]),
            chain([0.4, 0.2], [0.03, 0.5]),
        ];
        let values = [0.0, 1.0, 0.2];
        for slots in [1, 4, 8] {
            let steps = all
                .iter()
                .map(|chain| chain.transitions(12.0 / slots as f64));
            let steps: Vec<_> = steps.collect();
            let program = linear_program(&steps, &values, slots).unwrap();
            let found = bound(&steps, &values, slots);
            assert!((program - found).abs() < 1e-8, "{program} {found}");
        }
    }

    /// Probabilities below this are omitted from the linear program.
    const LEAST: f64 = 1e-12;

    /// The optimum of the linear program itself. The program allows loss of probability, which
    /// never pays if no value is negative, so that it has a feasible starting point.
    fn linear_program(steps: &[DMatrix<f64>], values: &[f64], slots: usize) -> Option<f64> {
        let n = values.len();
        let mut problem = Problem::new(OptimizationDirection::Maximize);
        let mut variables = Vec::new();
        for slot in 0..slots {
            for step in steps {
                for state in 0..n {
                    let worth = match slot + 1 == slots {
                        true => (0..n).map(|to| step[(state, to)] * values[to]).sum(),
                        false => 0.0,
                    };
                    variables.push(problem.add_var(worth, (0.0, f64::INFINITY)));
                }
            }
        }
        let at =
            |slot: usize, k: usize, state: usize| variables[(slot * steps.len() + k) * n + state];
        for state in 0..n {
            let here: Vec<_> = (0..steps.len()).map(|k| (at(0, k, state), 1.0)).collect();
            let start = if state == 0 { 1.0 } else { 0.0 };
            problem.add_constraint(here.as_slice(), ComparisonOp::Le, start);
        }
        for slot in 1..slots {
            for to in 0..n {
                let mut terms: Vec<_> = (0..steps.len()).map(|k| (at(slot, k, to), 1.0)).collect();
                for (k, step) in steps.iter().enumerate() {
                    for from in 0..n {
                        let p = step[(from, to)];
                        if p > LEAST {
                            terms.push((at(slot - 1, k, from), -p));
                        }
                    }
                }
                problem.add_constraint(terms.as_slice(), ComparisonOp::Le, 0.0);
            }
        }
        let solution = problem.solve().ok()?.into_solution().ok()?;
        Some(solution.objective())
    }
}
