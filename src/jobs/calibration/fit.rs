//! Least squares by the Levenberg-Marquardt method.

use nalgebra::{DMatrix, DVector};

/// The outcome of a fit of `N` numbers.
#[derive(Clone, Debug)]
pub struct Fit<const N: usize> {
    pub best: [f64; N],
    /// Sum of the squares of the residuals there.
    pub square: f64,
    /// Standard errors, infinite where the residuals do not depend on a number.
    pub standard_errors: [f64; N],
    /// Number of steps.
    pub steps: usize,
    /// Whether it converged: no step led further down.
    pub settled: bool,
}

/// Minimises the sum of the squares of `residuals`, starting at `start`, in at most `limit` steps.
///
/// Each step solves `(J^T J + lambda diag(J^T J)) d = -J^T r` with J by central differences;
/// lambda falls by a factor of 3 after a step that leads down and rises fourfold otherwise (Marquardt
/// 1963, doi:10.1137/0111030).
pub fn least_squares<const N: usize>(
    start: [f64; N],
    limit: usize,
    residuals: impl Fn(&[f64; N]) -> Vec<f64>,
) -> Fit<N> {
    const STILL: f64 = 1e-10;
    let square = |r: &[f64]| r.iter().map(|x| x * x).sum::<f64>();
    let mut best = start;
    let mut r = residuals(&best);
    let mut lambda = 1e-3;
    let mut taken = 0;
    let mut settled = false;
    'steps: while taken < limit {
        let jacobian = jacobian(&best, r.len(), &residuals);
        let (normal, slope) = normal_equations(&jacobian, &r);
        loop {
            let mut damped = normal.clone();
            for i in 0..N {
                damped[(i, i)] += lambda * normal[(i, i)].max(1e-12);
            }
            let Some(step) = damped.lu().solve(&-&slope) else {
                settled = false;
                break 'steps;
            };
            let next: [f64; N] = std::array::from_fn(|i| best[i] + step[i].clamp(-2.0, 2.0));
            let next_r = residuals(&next);
            if square(&next_r) < square(&r) {
                let gain = 1.0 - square(&next_r) / square(&r);
                (best, r) = (next, next_r);
                lambda /= 3.0;
                taken += 1;
                if gain < STILL {
                    settled = true;
                    break 'steps;
                }
                break;
            }
            lambda *= 4.0;
            if lambda > 1e12 {
                settled = true;
                break 'steps;
            }
        }
    }
    let standard_errors = standard_errors(&best, &r, &residuals);
    Fit {
        best,
        square: square(&r),
        standard_errors,
        steps: taken,
        settled,
    }
}

fn jacobian<const N: usize>(
    at: &[f64; N],
    rows: usize,
    residuals: &impl Fn(&[f64; N]) -> Vec<f64>,
) -> DMatrix<f64> {
    const STEP: f64 = 1e-5;
    let mut jacobian = DMatrix::zeros(rows, N);
    for i in 0..N {
        let shifted = |by: f64| {
            let mut x = *at;
            x[i] += by;
            DVector::from_vec(residuals(&x))
        };
        jacobian.set_column(i, &((shifted(STEP) - shifted(-STEP)) / (2.0 * STEP)));
    }
    jacobian
}

/// `J^T J` and `J^T r`.
fn normal_equations(jacobian: &DMatrix<f64>, r: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
    (
        jacobian.tr_mul(jacobian),
        jacobian.tr_mul(&DVector::from_column_slice(r)),
    )
}

/// From `(J^T J)^-1` times the residuals' variance.
fn standard_errors<const N: usize>(
    best: &[f64; N],
    r: &[f64],
    residuals: &impl Fn(&[f64; N]) -> Vec<f64>,
) -> [f64; N] {
    let (normal, _) = normal_equations(&jacobian(best, r.len(), residuals), r);
    let freedom = r.len().saturating_sub(N).max(1) as f64;
    let variance = r.iter().map(|x| x * x).sum::<f64>() / freedom;
    match normal.try_inverse() {
        Some(inverse) => std::array::from_fn(|i| (inverse[(i, i)] * variance).max(0.0).sqrt()),
        None => [f64::INFINITY; N],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exponential_is_fitted() {
        let truth = |t: f64| 3.0 * libm::exp(-0.7 * t);
        let residuals = |x: &[f64; 2]| -> Vec<f64> {
            (0..20)
                .map(|i| 0.3 * i as f64)
                .map(|t| truth(t) - x[0] * libm::exp(-x[1] * t))
                .collect()
        };
        let fit = least_squares([1.0, 0.1], 100, residuals);
        assert!(fit.settled);
        assert!((fit.best[0] - 3.0).abs() < 1e-6 && (fit.best[1] - 0.7).abs() < 1e-6);
    }

    #[test]
    fn the_standard_error_of_a_mean_is_the_textbooks() {
        let values = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let fit = least_squares([0.0], 100, |x: &[f64; 1]| {
            values.iter().map(|v| v - x[0]).collect()
        });
        assert!((fit.best[0] - 3.5).abs() < 1e-6);
        let expected = (3.5f64 / 6.0).sqrt();
        assert!((fit.standard_errors[0] - expected).abs() < 1e-6);
    }
}
