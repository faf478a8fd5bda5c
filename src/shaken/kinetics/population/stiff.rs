//! Time integration of stiff equations, whose rates differ by many powers of ten.
//!
//! Implicit Euler steps, extrapolated to vanishing step size (Deuflhard 1985, doi:10.1137/1027140;
//! Hairer and Wanner, *Solving Ordinary Differential Equations II*, section IV.9): components
//! faster than a step are damped, and the order increases until the last two results agree. Steps
//! grow with time, so that a solution over ten powers of ten takes about a hundred of them.

use tiles::interruption;

/// Largest number of columns of the table of extrapolation, each with a finer division of the step.
const COLUMNS: usize = 6;
/// Number of columns at which steps keep their size; with fewer they grow.
const USUAL: usize = 4;
/// Largest number of attempted steps.
const MOST_STEPS: usize = 4000;

/// Values at the requested times.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// One row a time.
    pub values: Vec<Vec<f64>>,
    /// The sum of the errors of all steps: the differences of the last two extrapolations of each,
    /// as sums of absolute values.
    pub error: f64,
}

/// The course of values from `start` on at ascending `times` (s). `euler` makes one (linearly)
/// implicit Euler step of a length (s), or tells that it cannot. `first` (s) is the first step
/// tried; an error of `tolerance` is allowed a step. `None` if steps fail or become too many.
pub fn integrate(
    start: Vec<f64>,
    times: &[f64],
    first: f64,
    tolerance: f64,
    euler: impl Fn(&[f64], f64) -> Option<Vec<f64>>,
) -> Option<Course> {
    let (mut values, mut error) = (Vec::new(), 0.0);
    let (mut x, mut now, mut step) = (start, 0.0, first);
    let mut left = MOST_STEPS;
    for &time in times {
        while now < time {
            interruption::check();
            left = left.checked_sub(1)?;
            let rest = time - now;
            // No sliver is left for the next step.
            let last = step * 1.01 >= rest;
            let length = if last { rest } else { step };
            match extrapolated(&x, length, tolerance, &euler) {
                Some((next, off, columns)) => {
                    (x, error) = (next, error + off);
                    now = if last { time } else { now + length };
                    let factor = match columns {
                        ..USUAL => 2.0,
                        USUAL => 1.2,
                        _ => 0.8,
                    };
                    // A step shortened by the end does not limit later ones.
                    step = match last {
                        true => step.max(length * factor),
                        false => length * factor,
                    };
                }
                None => step = 0.3 * length,
            }
        }
        values.push(x.clone());
    }
    Some(Course { values, error })
}

/// A step, with the difference of its last two extrapolations and the number of columns.
fn extrapolated(
    x: &[f64],
    length: f64,
    tolerance: f64,
    euler: &impl Fn(&[f64], f64) -> Option<Vec<f64>>,
) -> Option<(Vec<f64>, f64, usize)> {
    let mut row: Vec<Vec<f64>> = Vec::new();
    for columns in 1..=COLUMNS {
        let mut y = x.to_vec();
        for _ in 0..columns {
            y = euler(&y, length / columns as f64)?;
        }
        // Row by row: entry k of this one from entry k - 1 and that of the row before.
        let mut next = vec![y];
        for (k, before) in row.iter().enumerate() {
            let ratio = columns as f64 / (columns - k - 1) as f64 - 1.0;
            let pairs = next[k].iter().zip(before);
            next.push(pairs.map(|(y, z)| y + (y - z) / ratio).collect());
        }
        row = next;
        if columns > 1 {
            let [.., lower, best] = &row[..] else {
                return None;
            };
            let off: f64 = lower.iter().zip(best).map(|(y, z)| (y - z).abs()).sum();
            if off <= tolerance {
                return row.pop().map(|best| (best, off, columns));
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x' = -l x for rates over fifteen powers of ten, each with its own exact course.
    #[test]
    fn decays_of_all_rates_are_exact_within_the_stated_error() {
        let rates = [1e-9, 1e-3, 1.0, 30.0, 1e6];
        let times = [1e-4, 0.1, 2.0, 500.0];
        let euler = |x: &[f64], h: f64| {
            Some(
                x.iter()
                    .zip(rates)
                    .map(|(x, rate)| x / (1.0 + h * rate))
                    .collect(),
            )
        };
        let found = integrate(vec![1.0; 5], &times, 1e-8, 1e-9, euler).unwrap();
        assert!(found.error < 1e-6, "{}", found.error);
        for (time, row) in times.iter().zip(&found.values) {
            for (rate, x) in rates.iter().zip(row) {
                let exact = libm::exp(-rate * time);
                assert!(
                    (x - exact).abs() <= found.error,
                    "{time} {rate}: {x} {exact}"
                );
            }
        }
    }
}
