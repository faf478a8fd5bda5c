//! Sparse symmetric equations, and their solution by conjugate gradients.

use nalgebra_sparse::{CooMatrix, CsrMatrix};

use crate::interruption;

/// Solved when the preconditioned residual has shrunk to this share.
const SHRUNK: f64 = 1e-10;
/// Steps of conjugate gradients at most.
const MOST_STEPS: usize = 20_000;

/// Calls with every entry (row, column, value) of a matrix; entries at one place add up.
pub(super) type Entries<'a> = Box<dyn Fn(&mut dyn FnMut(usize, usize, f64)) + Sync + 'a>;

/// A positive matrix in which some values are given and the others are to be found, its rows and
/// columns scaled so that the diagonal is 1.
pub(super) struct Equations<'a> {
    entries: Entries<'a>,
    /// The number of each value among the unknowns.
    unknown: Vec<Option<u32>>,
    /// One over the root of each unknown's diagonal.
    scale: Vec<f64>,
    matrix: CsrMatrix<f64>,
}

/// The solution was not found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("conjugate gradients did not converge")]
pub struct Unsolved;

impl<'a> Equations<'a> {
    /// For so many values, of which some are to be found.
    pub fn new(count: usize, is_asked: &dyn Fn(usize) -> bool, entries: Entries<'a>) -> Self {
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
        let mut matrix = CooMatrix::new(scale.len(), scale.len());
        entries(&mut |i, j, entry| {
            if let (Some(i), Some(j)) = (unknown[i], unknown[j]) {
                let (i, j) = (i as usize, j as usize);
                matrix.push(i, j, entry * scale[i] * scale[j]);
            }
        });
        Self {
            entries,
            unknown,
            scale,
            matrix: CsrMatrix::from(&matrix),
        }
    }

    /// How many values are to be found.
    pub fn len(&self) -> usize {
        self.scale.len()
    }

    /// The given values with those that make the matrix times all of them equal `right` where
    /// values are to be found, from a guess.
    ///
    /// # Errors
    /// Where they are not found.
    pub fn solve(&self, given: &[f64], right: &[f64], guess: &[f64]) -> Result<Vec<f64>, Unsolved> {
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
        (self.entries)(&mut |i, j, entry| {
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

    /// The matrix times values.
    pub fn product(&self, values: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; values.len()];
        (self.entries)(&mut |i, j, entry| out[i] += entry * values[j]);
        out
    }

    /// Hestenes and Stiefel's method (1952), preconditioned by a symmetric sweep of Gauss and
    /// Seidel's.
    fn conjugate_gradients(&self, right: &[f64], x: &mut [f64]) -> Result<(), Unsolved> {
        let mut along = vec![0.0; x.len()];
        let mut swept = vec![0.0; x.len()];
        self.sweep(right, &mut swept);
        let goal = SHRUNK * SHRUNK * dot(right, &swept);
        self.times(x, &mut along);
        let mut residual: Vec<f64> = right.iter().zip(&along).map(|(b, a)| b - a).collect();
        self.sweep(&residual, &mut swept);
        let mut direction = swept.clone();
        let mut size = dot(&residual, &swept);
        for _ in 0..MOST_STEPS {
            if size <= goal {
                return Ok(());
            }
            interruption::check();
            self.times(&direction, &mut along);
            let length = size / dot(&direction, &along);
            for i in 0..x.len() {
                x[i] += length * direction[i];
                residual[i] -= length * along[i];
            }
            self.sweep(&residual, &mut swept);
            let next = dot(&residual, &swept);
            for (d, s) in direction.iter_mut().zip(&swept) {
                *d = s + next / size * *d;
            }
            size = next;
        }
        Err(Unsolved)
    }

    fn times(&self, x: &[f64], out: &mut [f64]) {
        for (row, out) in self.matrix.row_iter().zip(out) {
            let entries = row.col_indices().iter().zip(row.values());
            *out = entries.map(|(&j, a)| a * x[j]).sum();
        }
    }

    /// Solves (1 + L)(1 + L^T) z = r for the matrix 1 + L + L^T.
    fn sweep(&self, r: &[f64], z: &mut [f64]) {
        let n = self.len();
        for i in 0..n {
            let row = self.matrix.row(i);
            let before = row.col_indices().iter().zip(row.values());
            let sum: f64 = before
                .take_while(|(j, _)| **j < i)
                .map(|(&j, a)| a * z[j])
                .sum();
            z[i] = r[i] - sum;
        }
        for i in (0..n).rev() {
            let row = self.matrix.row(i);
            let after = row.col_indices().iter().zip(row.values()).rev();
            let sum: f64 = after
                .take_while(|(j, _)| **j > i)
                .map(|(&j, a)| a * z[j])
                .sum();
            z[i] -= sum;
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
