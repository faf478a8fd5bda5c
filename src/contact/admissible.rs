//! The admissible motion closest to a wanted one: a small quadratic program.

use nalgebra::{Matrix3, Vector3};
use ordered_float::OrderedFloat;

use super::Constraint;

/// The point closest to `wanted` in the metric `(v - w)^T metric (v - w)` with
/// `gradient . v >= -gap` for every constraint, and the constraints' multipliers (>= 0, zero where
/// the constraint does not bind). `None` where the constraints contradict each other.
///
/// A working set of binding constraints grows by the most violated one; the small problem on the
/// working set is solved by trying its subsets of at most three.
pub fn closest_admissible(
    wanted: Vector3<f64>,
    metric: &Matrix3<f64>,
    constraints: &[Constraint],
) -> Option<(Vector3<f64>, Vec<f64>)> {
    let inverse = metric.try_inverse()?;
    let mut working: Vec<usize> = Vec::new();
    let mut point = wanted;
    let mut multipliers = Vec::new();
    for _ in 0..100 {
        let violated = (0..constraints.len())
            .map(|k| {
                (
                    k,
                    slack(&constraints[k], &point) / norm(&constraints[k], &inverse),
                )
            })
            .min_by_key(|(_, slack)| OrderedFloat(*slack));
        let scale = 1e-13 * (1.0 + point.norm());
        match violated {
            Some((k, slack)) if slack < -scale && !working.contains(&k) => working.push(k),
            _ => {
                let mut all = vec![0.0; constraints.len()];
                for (&k, &multiplier) in working.iter().zip(&multipliers) {
                    all[k] = multiplier;
                }
                return Some((point, all));
            }
        }
        let (best, set, lambda) = best_subset(wanted, &inverse, constraints, &working)?;
        point = best;
        working = set;
        multipliers = lambda;
    }
    None
}

fn slack(c: &Constraint, v: &Vector3<f64>) -> f64 {
    c.gradient.dot(v) + c.gap
}

fn norm(c: &Constraint, inverse: &Matrix3<f64>) -> f64 {
    c.gradient.dot(&(inverse * c.gradient)).sqrt()
}

/// A point, the constraints that bind there, and their multipliers.
type Optimum = (Vector3<f64>, Vec<usize>, Vec<f64>);

/// The optimum over the working set: the subset of at most three constraints, taken as equalities,
/// whose multipliers are not negative and that leaves the others satisfied.
fn best_subset(
    wanted: Vector3<f64>,
    inverse: &Matrix3<f64>,
    constraints: &[Constraint],
    working: &[usize],
) -> Option<Optimum> {
    let tolerance = 1e-11 * (1.0 + wanted.norm());
    let mut best: Option<(f64, Optimum)> = None;
    for set in subsets(working) {
        let Some((point, lambda)) = equality_optimum(wanted, inverse, constraints, &set) else {
            continue;
        };
        let feasible = working
            .iter()
            .all(|&k| slack(&constraints[k], &point) >= -tolerance);
        if feasible && lambda.iter().all(|&l| l >= 0.0) {
            let cost = (point - wanted).norm_squared();
            if best.as_ref().is_none_or(|b| cost < b.0) {
                best = Some((cost, (point, set, lambda)));
            }
        }
    }
    best.map(|(_, optimum)| optimum)
}

fn subsets(working: &[usize]) -> Vec<Vec<usize>> {
    let n = working.len();
    let mut sets = Vec::new();
    for i in 0..n {
        sets.push(vec![working[i]]);
        for j in i + 1..n {
            sets.push(vec![working[i], working[j]]);
            for k in j + 1..n {
                sets.push(vec![working[i], working[j], working[k]]);
            }
        }
    }
    sets
}

fn equality_optimum(
    wanted: Vector3<f64>,
    inverse: &Matrix3<f64>,
    constraints: &[Constraint],
    set: &[usize],
) -> Option<(Vector3<f64>, Vec<f64>)> {
    let m = set.len();
    let gram = nalgebra::DMatrix::from_fn(m, m, |a, b| {
        constraints[set[a]]
            .gradient
            .dot(&(inverse * constraints[set[b]].gradient))
    });
    let missing = nalgebra::DVector::from_fn(m, |a, _| -slack(&constraints[set[a]], &wanted));
    let scale = (0..m).map(|a| gram[(a, a)]).product::<f64>();
    if gram.determinant() <= 1e-12 * scale {
        return None;
    }
    let lambda = gram.cholesky()?.solve(&missing);
    let push: Vector3<f64> = (0..m)
        .map(|a| constraints[set[a]].gradient * lambda[a])
        .sum();
    Some((wanted + inverse * push, lambda.iter().copied().collect()))
}
