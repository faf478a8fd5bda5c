//! The linear system of a mesh's corners, and its solution by conjugate gradients.

use nalgebra_sparse::{CooMatrix, CsrMatrix};

use super::nodes::Nodes;
use super::octree::Octree;
use crate::interruption;

/// Solved when the preconditioned residual has shrunk to this share.
const SHRUNK: f64 = 1e-10;
/// Steps of conjugate gradients at most.
const MOST_STEPS: usize = 20_000;

/// The stiffness of the corners whose values are to be found, its rows and columns scaled so that
/// the diagonal is 1.
pub(in crate::kinetics) struct System<'a> {
    mesh: &'a Octree,
    nodes: &'a Nodes,
    /// The number of each corner among the unknowns.
    unknown: Vec<Option<u32>>,
    /// One over the root of each unknown's diagonal.
    scale: Vec<f64>,
    matrix: CsrMatrix<f64>,
}

/// The solution was not found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("conjugate gradients did not converge")]
pub struct Unsolved;

impl<'a> System<'a> {
    /// With the values at `pinned` corners given.
    pub fn new(mesh: &'a Octree, nodes: &'a Nodes, pinned: &[bool]) -> Self {
        let mut diagonal = vec![0.0; nodes.len()];
        each_entry(mesh, nodes, |i, j, entry| {
            if i == j {
                diagonal[i] += entry;
            }
        });
        let mut scale = Vec::new();
        let unknown: Vec<Option<u32>> = (0..nodes.len())
            .map(|node| {
                let is_unknown = !nodes.is_hanging(node) && !pinned[node] && diagonal[node] > 0.0;
                is_unknown.then(|| {
                    scale.push(1.0 / diagonal[node].sqrt());
                    scale.len() as u32 - 1
                })
            })
            .collect();
        let mut entries = CooMatrix::new(scale.len(), scale.len());
        each_entry(mesh, nodes, |i, j, entry| {
            if let (Some(i), Some(j)) = (unknown[i], unknown[j]) {
                let (i, j) = (i as usize, j as usize);
                entries.push(i, j, entry * scale[i] * scale[j]);
            }
        });
        Self {
            mesh,
            nodes,
            unknown,
            scale,
            matrix: CsrMatrix::from(&entries),
        }
    }

    /// How many values are to be found.
    pub fn len(&self) -> usize {
        self.scale.len()
    }

    /// The function with these values at the pinned corners and this load at each corner, found
    /// from a guess.
    ///
    /// # Errors
    /// Where it is not found.
    pub fn solve(&self, pinned: &[f64], load: &[f64], guess: &[f64]) -> Result<Vec<f64>, Unsolved> {
        let mut right = vec![0.0; self.len()];
        let mut x = vec![0.0; self.len()];
        let unknowns = || self.unknown.iter().enumerate();
        for (node, unknown) in unknowns() {
            if let Some(i) = unknown {
                right[*i as usize] = load[node];
                x[*i as usize] = guess[node] / self.scale[*i as usize];
            }
        }
        each_entry(self.mesh, self.nodes, |i, j, entry| {
            if let (Some(i), None) = (self.unknown[i], self.unknown[j]) {
                right[i as usize] -= entry * pinned[j];
            }
        });
        for (value, scale) in right.iter_mut().zip(&self.scale) {
            *value *= scale;
        }
        self.conjugate_gradients(&right, &mut x)?;
        let mut values = pinned.to_vec();
        for (node, unknown) in unknowns() {
            if let Some(i) = unknown {
                values[node] = x[*i as usize] * self.scale[*i as usize];
            }
        }
        self.nodes.interpolate(&mut values);
        Ok(values)
    }

    /// What flows out of each corner that does not hang: the stiffness times the values (rad).
    pub fn fluxes(&self, values: &[f64]) -> Vec<f64> {
        let mut fluxes = vec![0.0; values.len()];
        each_entry(self.mesh, self.nodes, |i, j, entry| {
            fluxes[i] += entry * values[j]
        });
        fluxes
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

/// Calls with every entry that a cell adds to the stiffness of corners that do not hang.
fn each_entry(mesh: &Octree, nodes: &Nodes, mut call: impl FnMut(usize, usize, f64)) {
    for (id, _, element) in mesh.live() {
        let corners = nodes.corners[id];
        for (a, &corner) in corners.iter().enumerate() {
            for (b, &other) in corners.iter().enumerate() {
                let entry = element.entry(a, b);
                for &(i, by_i) in &nodes.sources[corner as usize] {
                    for &(j, by_j) in &nodes.sources[other as usize] {
                        call(i as usize, j as usize, entry * by_i * by_j);
                    }
                }
            }
        }
    }
}

/// What the loads of cells that are not `left_out` add up to at each corner that does not hang.
pub(in crate::kinetics) fn loads(mesh: &Octree, nodes: &Nodes, left_out: &[bool]) -> Vec<f64> {
    let mut sums = vec![0.0; nodes.len()];
    for (id, _, element) in mesh.live().filter(|(id, ..)| !left_out[*id]) {
        for (&corner, load) in nodes.corners[id].iter().zip(element.load) {
            for &(of, share) in &nodes.sources[corner as usize] {
                sums[of as usize] += share * load;
            }
        }
    }
    sums
}
