//! The admissible motion closest to a wanted one: a small quadratic program.

use arrayvec::ArrayVec;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use ordered_float::OrderedFloat;

use super::Constraint;

/// The point closest to `wanted` in the metric `(v - w)^T metric (v - w)` with `gradient . v >=
/// -gap` for every constraint, and the constraints' multipliers (>= 0, zero where the constraint
/// does not bind). `None` if the constraints contradict each other. `unit` is the scale of the
/// vectors, 1 for directions: constraints are satisfied within 1e-13 of it.
///
/// A working set of binding constraints grows by the most violated one; the small problem on the
/// working set is solved by trying its subsets of at most three.
pub fn closest_admissible(
    (wanted, unit): (Vector3<f64>, f64),
    metric: &Matrix3<f64>,
    constraints: &[Constraint],
) -> Option<(Vector3<f64>, Vec<f64>)> {
    if constraints.is_empty() {
        return Some((wanted, Vec::new()));
    }
    let inverse = metric.try_inverse()?;
    let length = |v: &Vector3<f64>| v.dot(&(metric * v)).max(0.0).sqrt();
    let small = 1e-11 * (unit + length(&wanted));
    let norms: Vec<f64> = constraints.iter().map(|c| norm(c, &inverse)).collect();
    let mut best = Optimum {
        point: wanted,
        binding: ArrayVec::new(),
    };
    for _ in 0..100 {
        let violated = (0..constraints.len())
            .map(|k| (k, slack(&constraints[k], &best.point) / norms[k]))
            .min_by_key(|(_, slack)| OrderedFloat(*slack));
        let scale = 1e-13 * (unit + length(&best.point));
        let mut working: ArrayVec<usize, 4> = best.binding.iter().map(|(k, _)| *k).collect();
        match violated {
            Some((k, slack)) if slack < -scale && !working.contains(&k) => working.push(k),
            _ => {
                let mut multipliers = vec![0.0; constraints.len()];
                for (k, multiplier) in best.binding {
                    multipliers[k] = multiplier;
                }
                return Some((best.point, multipliers));
            }
        }
        best = best_subset((wanted, small), &inverse, constraints, &working)?;
    }
    None
}

fn slack(c: &Constraint, v: &Vector3<f64>) -> f64 {
    c.gradient.dot(v) + c.gap
}

fn norm(c: &Constraint, inverse: &Matrix3<f64>) -> f64 {
    c.gradient.dot(&(inverse * c.gradient)).sqrt()
}

/// A point, and the constraints that bind there with their multipliers.
struct Optimum {
    point: Vector3<f64>,
    binding: ArrayVec<(usize, f64), 3>,
}

/// The optimum over the working set: the subset of at most three constraints, taken as equalities,
/// whose multipliers are not negative and that leaves the others satisfied.
fn best_subset(
    (wanted, tolerance): (Vector3<f64>, f64),
    inverse: &Matrix3<f64>,
    constraints: &[Constraint],
    working: &[usize],
) -> Option<Optimum> {
    let mut search = SubsetSearch {
        wanted,
        inverse,
        constraints,
        working,
        tolerance,
        best: None,
    };
    let n = working.len();
    for i in 0..n {
        search.look_at([working[i]]);
        for j in i + 1..n {
            search.look_at([working[i], working[j]]);
            for k in j + 1..n {
                search.look_at([working[i], working[j], working[k]]);
            }
        }
    }
    search.best.map(|(_, optimum)| optimum)
}

struct SubsetSearch<'a> {
    wanted: Vector3<f64>,
    inverse: &'a Matrix3<f64>,
    constraints: &'a [Constraint],
    working: &'a [usize],
    tolerance: f64,
    /// With its cost.
    best: Option<(f64, Optimum)>,
}

impl SubsetSearch<'_> {
    /// Keeps the optimum over a subset, taken as equalities, if it is the best so far.
    fn look_at<const M: usize>(&mut self, set: [usize; M]) {
        let Some((point, lambda)) = self.equality_optimum(&set) else {
            return;
        };
        let cost = (point - self.wanted).norm_squared();
        let is_better = self.best.as_ref().is_none_or(|best| cost < best.0);
        let holds = |&k: &usize| slack(&self.constraints[k], &point) >= -self.tolerance;
        if is_better && lambda.iter().all(|&l| l >= 0.0) && self.working.iter().all(holds) {
            let binding = set.into_iter().zip(lambda.iter().copied()).collect();
            self.best = Some((cost, Optimum { point, binding }));
        }
    }

    fn equality_optimum<const M: usize>(
        &self,
        set: &[usize; M],
    ) -> Option<(Vector3<f64>, SVector<f64, M>)> {
        let gradients = set.map(|k| self.constraints[k].gradient);
        let pushes = gradients.map(|gradient| self.inverse * gradient);
        let gram = SMatrix::<f64, M, M>::from_fn(|a, b| gradients[a].dot(&pushes[b]));
        let missing =
            SVector::<f64, M>::from_fn(|a, _| -slack(&self.constraints[set[a]], &self.wanted));
        let scale = (0..M).map(|a| gram[(a, a)]).product::<f64>();
        let factor = gram
            .cholesky()
            .filter(|factor| factor.determinant() > 1e-12 * scale)?;
        let lambda = solved(factor.l_dirty(), missing);
        let push: Vector3<f64> = (0..M).map(|a| gradients[a] * lambda[a]).sum();
        Some((self.wanted + self.inverse * push, lambda))
    }
}

/// The solution of the linear equations whose matrix has this Cholesky factor.
fn solved<const M: usize>(factor: &SMatrix<f64, M, M>, right: SVector<f64, M>) -> SVector<f64, M> {
    let mut x = right;
    for i in 0..M {
        for k in 0..i {
            x[i] -= factor[(i, k)] * x[k];
        }
        x[i] /= factor[(i, i)];
    }
    for i in (0..M).rev() {
        for k in i + 1..M {
            x[i] -= factor[(k, i)] * x[k];
        }
        x[i] /= factor[(i, i)];
    }
    x
}
