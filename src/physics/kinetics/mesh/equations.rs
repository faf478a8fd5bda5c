//! Sparse symmetric linear equations, solved by conjugate gradients.

use nalgebra_sparse::{CooMatrix, CsrMatrix};

use crate::interruption;

/// Relative size of the preconditioned residual at which a system counts as solved.
const SHRUNK: f64 = 1e-9;
/// Steps of conjugate gradients at most.
const MOST_STEPS: usize = 20_000;

/// Calls a function with every entry (row, column, value) of a matrix; entries at one position are
/// summed.
pub(super) type Entries<'a> = dyn Fn(&mut dyn FnMut(usize, usize, f64)) + 'a;

/// Equations with a positive definite matrix in which some values are given and the others unknown;
/// rows and columns are scaled so that the diagonal is 1.
pub(super) struct Equations {
    /// The index of each value among the unknowns.
    unknown: Vec<Option<u32>>,
    /// One over the root of each unknown's diagonal.
    scale: Vec<f64>,
    /// The lower triangle of the scaled matrix, row by row: starts of rows, ...
    starts: Vec<u32>,
    /// ... columns, ...
    columns: Vec<u32>,
    /// ... and values.
    entries_before: Vec<f64>,
}

/// The solver did not converge.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("conjugate gradients did not converge")]
pub struct Unsolved;

impl Equations {
    /// Equations for a number of values, some of them unknown, with a matrix whose entries are
    /// requested again later.
    pub fn new(count: usize, is_asked: &dyn Fn(usize) -> bool, entries: &Entries) -> Self {
        let mut diagonal = vec![0.0; count];
        entries(&mut |i, j, entry| {
            if i == j {
                diagonal[i] += entry;
            }
        });
        let mut scale = Vec::new();
        let unknown: Vec<Option<u32>> = (0..count)
            .map(|i| {
                (is_asked(i) && diagonal[i] > 0.0).then(|| {
                    scale.push(1.0 / diagonal[i].sqrt());
                    scale.len() as u32 - 1
                })
            })
            .collect();
        let mut before = CooMatrix::new(scale.len(), scale.len());
        entries(&mut |i, j, entry| {
            if let (Some(i), Some(j)) = (unknown[i], unknown[j])
                && j < i
            {
                let (i, j) = (i as usize, j as usize);
                before.push(i, j, entry * scale[i] * scale[j]);
            }
        });
        let (starts, columns, before) = CsrMatrix::from(&before).disassemble();
        let short = |all: Vec<usize>| all.into_iter().map(|k| k as u32).collect();
        Self {
            unknown,
            scale,
            starts: short(starts),
            columns: short(columns),
            entries_before: before,
        }
    }

    /// The number of unknowns.
    pub fn len(&self) -> usize {
        self.scale.len()
    }

    /// All values, with unknowns such that the matrix times the values equals `right` in the rows
    /// of unknowns; starts from a guess.
    ///
    /// # Errors
    /// If the solver does not converge.
    pub fn solve(
        &self,
        entries: &Entries,
        given: &[f64],
        right: &[f64],
        guess: &[f64],
    ) -> Result<Vec<f64>, Unsolved> {
        let mut sides = vec![0.0; self.len()];
        let mut x = vec![0.0; self.len()];
        let unknowns = || {
            let all = self.unknown.iter().enumerate();
            all.filter_map(|(i, unknown)| Some((i, (*unknown)? as usize)))
        };
        for (i, k) in unknowns() {
            sides[k] = right[i];
            x[k] = guess[i] / self.scale[k];
        }
        entries(&mut |i, j, entry| {
            if let (Some(i), None) = (self.unknown[i], self.unknown[j]) {
                sides[i as usize] -= entry * given[j];
            }
        });
        for (value, scale) in sides.iter_mut().zip(&self.scale) {
            *value *= scale;
        }
        self.conjugate_gradients(&sides, &mut x)?;
        let mut values = given.to_vec();
        for (i, k) in unknowns() {
            values[i] = x[k] * self.scale[k];
        }
        Ok(values)
    }

    /// Hestenes and Stiefel's method (1952), preconditioned by a symmetric Gauss-Seidel sweep, (1 +
    /// L)(1 + L^T) for the matrix 1 + L + L^T. As Eisenstat (1981, doi:10.1137/0902001) showed, the
    /// two halves of a sweep also give the matrix product: with `y = (1 + L^T)^-1 p` the
    /// preconditioned matrix times p is `y + (1 + L)^-1 (p - y)`.
    fn conjugate_gradients(&self, right: &[f64], x: &mut [f64]) -> Result<(), Unsolved> {
        let mut swept = right.to_vec();
        self.forwards(&mut swept);
        let goal = SHRUNK * SHRUNK * dot(&swept, &swept);
        if goal == 0.0 {
            x.fill(0.0);
            return Ok(());
        }
        let mut residual = self.left(right, x);
        self.forwards(&mut residual);
        let mut direction = residual.clone();
        let mut size = dot(&residual, &residual);
        let mut along = vec![0.0; x.len()];
        for _ in 0..MOST_STEPS {
            if size <= goal {
                return Ok(());
            }
            interruption::check();
            along.copy_from_slice(&direction);
            self.backwards(&mut along);
            for ((rest, d), y) in swept.iter_mut().zip(&direction).zip(&along) {
                *rest = d - y;
            }
            self.forwards(&mut swept);
            let product = |i: usize| along[i] + swept[i];
            let curvature: f64 = (0..x.len()).map(|i| direction[i] * product(i)).sum();
            let length = size / curvature;
            for i in 0..x.len() {
                residual[i] -= length * product(i);
                x[i] += length * along[i];
            }
            let next = dot(&residual, &residual);
            for (d, r) in direction.iter_mut().zip(&residual) {
                *d = r + next / size * *d;
            }
            size = next;
        }
        Err(Unsolved)
    }

    /// The residual.
    fn left(&self, right: &[f64], x: &[f64]) -> Vec<f64> {
        let mut left: Vec<f64> = right.iter().zip(x).map(|(b, x)| b - x).collect();
        for i in 0..x.len() {
            for (j, entry) in self.row(i) {
                left[i] -= entry * x[j];
                left[j] -= entry * x[i];
            }
        }
        left
    }

    /// The entries of a row before the diagonal.
    fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let own = self.starts[i] as usize..self.starts[i + 1] as usize;
        let columns = self.columns[own.clone()].iter();
        columns
            .zip(&self.entries_before[own])
            .map(|(&j, &entry)| (j as usize, entry))
    }

    /// Solves (1 + L) z = r in place.
    fn forwards(&self, z: &mut [f64]) {
        for i in 0..z.len() {
            let sum: f64 = self.row(i).map(|(j, entry)| entry * z[j]).sum();
            z[i] -= sum;
        }
    }

    /// Solves (1 + L^T) z = r in place.
    fn backwards(&self, z: &mut [f64]) {
        for i in (0..z.len()).rev() {
            let own = z[i];
            for (j, entry) in self.row(i) {
                z[j] -= entry * own;
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
