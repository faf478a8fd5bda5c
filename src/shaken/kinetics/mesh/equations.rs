//! Sparse symmetric linear equations, solved by conjugate gradients.

use nalgebra_sparse::{CooMatrix, CsrMatrix};

use tiles::{interruption, parallel};

/// Relative size of the preconditioned residual at which a system counts as solved.
const SHRUNK: f64 = 1e-9;
/// Steps of conjugate gradients at most.
const MOST_STEPS: usize = 20_000;
/// Most solutions computed together. The sweeps of one wait for each other's results; those of three
/// take hardly longer.
const BATCH: usize = 3;

/// Calls a function with every entry (row, column, value) of a matrix; entries at one position are
/// summed.
pub(super) type Entries<'a> = dyn Fn(&mut dyn FnMut(usize, usize, f64)) + Sync + 'a;

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

/// What a solution is sought for.
pub(in crate::kinetics) struct Sought<'a> {
    /// All values; those of unknowns do not matter.
    pub given: Vec<f64>,
    /// The right side; `None` for zeros.
    pub right: Option<&'a [f64]>,
    /// A guess of all values; `None` for zeros.
    pub guess: Option<&'a [f64]>,
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

    /// All values of each solution, with unknowns such that the matrix times the values equals the
    /// right side in the rows of unknowns.
    ///
    /// # Errors
    /// If the solver does not converge.
    pub fn solve(&self, entries: &Entries, sought: &[Sought]) -> Result<Vec<Vec<f64>>, Unsolved> {
        let parts = sought.len().div_ceil(BATCH).max(1);
        let part = sought.len().div_ceil(parts).max(1);
        let parts: Vec<&[Sought]> = sought.chunks(part).collect();
        let found = parallel::map(&parts[..], |part| match part {
            [a] => self.solved(entries, [a]).map(Vec::from),
            [a, b] => self.solved(entries, [a, b]).map(Vec::from),
            [a, b, c] => self.solved(entries, [a, b, c]).map(Vec::from),
            _ => unreachable!("at most {BATCH} together"),
        });
        let found = found.into_iter().collect::<Result<Vec<_>, _>>()?;
        Ok(found.into_iter().flatten().collect())
    }

    /// Solutions computed together; each has the same bits as alone.
    fn solved<const N: usize>(
        &self,
        entries: &Entries,
        sought: [&Sought; N],
    ) -> Result<[Vec<f64>; N], Unsolved> {
        let mut sides = vec![[0.0; N]; self.len()];
        let mut x = vec![[0.0; N]; self.len()];
        let unknowns = || {
            let all = self.unknown.iter().enumerate();
            all.filter_map(|(i, unknown)| Some((i, (*unknown)? as usize)))
        };
        for (i, k) in unknowns() {
            sides[k] = sought.map(|it| it.right.map_or(0.0, |right| right[i]));
            x[k] = sought.map(|it| it.guess.map_or(0.0, |guess| guess[i]) / self.scale[k]);
        }
        entries(&mut |i, j, entry| {
            if let (Some(i), None) = (self.unknown[i], self.unknown[j]) {
                let side = &mut sides[i as usize];
                for (side, it) in side.iter_mut().zip(sought) {
                    *side -= entry * it.given[j];
                }
            }
        });
        for (values, scale) in sides.iter_mut().zip(&self.scale) {
            *values = values.map(|value| value * scale);
        }
        let solutions = self.conjugate_gradients(&sides, x)?;
        Ok(std::array::from_fn(|n| {
            let mut values = sought[n].given.clone();
            for (i, k) in unknowns() {
                values[i] = solutions[n][k] * self.scale[k];
            }
            values
        }))
    }

    /// The solutions for some right sides, starting from x.
    ///
    /// Hestenes and Stiefel's method (1952), preconditioned by a symmetric Gauss-Seidel sweep, (1 +
    /// L)(1 + L^T) for the matrix 1 + L + L^T. As Eisenstat (1981, doi:10.1137/0902001) showed, the
    /// two halves of a sweep also give the matrix product: with `y = (1 + L^T)^-1 p` the
    /// preconditioned matrix times p is `y + (1 + L)^-1 (p - y)`.
    fn conjugate_gradients<const N: usize>(
        &self,
        right: &[[f64; N]],
        mut x: Vec<[f64; N]>,
    ) -> Result<[Vec<f64>; N], Unsolved> {
        let column = |x: &[[f64; N]], n: usize| x.iter().map(|values| values[n]).collect();
        let mut swept = right.to_vec();
        self.forwards(&mut swept);
        let goals = dot(&swept, &swept).map(|size| SHRUNK * SHRUNK * size);
        let mut residual = self.left(right, &x);
        self.forwards(&mut residual);
        let mut direction = residual.clone();
        let mut sizes = dot(&residual, &residual);
        let mut along = vec![[0.0; N]; x.len()];
        // Those that are found take part in further steps, which are not used.
        let mut found: [Option<Vec<f64>>; N] = goals.map(|goal| {
            let nothing = || vec![0.0; x.len()];
            (goal == 0.0).then(nothing)
        });
        for _ in 0..MOST_STEPS {
            for n in 0..N {
                if found[n].is_none() && sizes[n] <= goals[n] {
                    found[n] = Some(column(&x, n));
                }
            }
            if found.iter().all(Option::is_some) {
                return Ok(found.map(Option::unwrap_or_default));
            }
            interruption::check();
            along.copy_from_slice(&direction);
            self.backwards(&mut along);
            for ((rest, d), y) in swept.iter_mut().zip(&direction).zip(&along) {
                *rest = std::array::from_fn(|n| d[n] - y[n]);
            }
            self.forwards(&mut swept);
            let mut curvatures = [-0.0; N];
            for ((d, y), rest) in direction.iter().zip(&along).zip(&swept) {
                for n in 0..N {
                    curvatures[n] += d[n] * (y[n] + rest[n]);
                }
            }
            let lengths: [f64; N] = std::array::from_fn(|n| sizes[n] / curvatures[n]);
            for ((residual, x), (y, rest)) in residual
                .iter_mut()
                .zip(&mut x)
                .zip(along.iter().zip(&swept))
            {
                for n in 0..N {
                    residual[n] -= lengths[n] * (y[n] + rest[n]);
                    x[n] += lengths[n] * y[n];
                }
            }
            let next = dot(&residual, &residual);
            for (d, r) in direction.iter_mut().zip(&residual) {
                *d = std::array::from_fn(|n| r[n] + next[n] / sizes[n] * d[n]);
            }
            sizes = next;
        }
        Err(Unsolved)
    }

    /// The residual.
    fn left<const N: usize>(&self, right: &[[f64; N]], x: &[[f64; N]]) -> Vec<[f64; N]> {
        let both = right.iter().zip(x);
        let mut left: Vec<[f64; N]> = both
            .map(|(b, x)| std::array::from_fn(|n| b[n] - x[n]))
            .collect();
        for i in 0..x.len() {
            for (j, entry) in self.row(i) {
                for n in 0..N {
                    left[i][n] -= entry * x[j][n];
                    left[j][n] -= entry * x[i][n];
                }
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
    fn forwards<const N: usize>(&self, z: &mut [[f64; N]]) {
        for i in 0..z.len() {
            let mut sums = [-0.0; N];
            for (j, entry) in self.row(i) {
                for (sum, z) in sums.iter_mut().zip(z[j]) {
                    *sum += entry * z;
                }
            }
            for (z, sum) in z[i].iter_mut().zip(sums) {
                *z -= sum;
            }
        }
    }

    /// Solves (1 + L^T) z = r in place.
    fn backwards<const N: usize>(&self, z: &mut [[f64; N]]) {
        for i in (0..z.len()).rev() {
            let own = z[i];
            for (j, entry) in self.row(i) {
                for (z, own) in z[j].iter_mut().zip(own) {
                    *z -= entry * own;
                }
            }
        }
    }
}

fn dot<const N: usize>(a: &[[f64; N]], b: &[[f64; N]]) -> [f64; N] {
    let mut sums = [-0.0; N];
    for (a, b) in a.iter().zip(b) {
        for n in 0..N {
            sums[n] += a[n] * b[n];
        }
    }
    sums
}
