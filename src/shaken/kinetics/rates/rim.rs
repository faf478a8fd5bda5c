//! The error made by building basins from whole cells.
//!
//! A basin is the region where U is below a limit; on the mesh it consists of the cells whose mean
//! is below it. By Hadamard's formula the capacity changes by `w |grad q|^2` per volume by which a
//! basin's rim moves outwards, which is the energy of the function in the cells beside it. So the
//! rim of the cells is compared with the surface where U, interpolated linearly between the cells'
//! middles, meets the limit.

use super::field::MeshField;
use crate::kinetics::mesh::{Element, Nodes};

/// A cell of a basin beside one that is not.
struct Step {
    inner: usize,
    outer: usize,
    /// How far the basin extends beyond the side between them, in sizes of the outer cell.
    reach: f64,
}

/// The rims of basins on a mesh.
pub(super) struct Rims {
    steps: Vec<Step>,
    /// For each cell with how many sides it bounds basins.
    sides: Vec<u32>,
}

impl Rims {
    /// The rims of basins given by the limit (J) of each of their cells.
    pub fn new(field: &MeshField, limits: &[Option<f64>]) -> Self {
        let mesh = &field.mesh;
        let mut sides = vec![0; mesh.leaves.len()];
        let mut steps = Vec::new();
        for (inner, beside) in mesh.neighbours().iter().enumerate() {
            let Some(limit) = limits[inner] else { continue };
            for outer in beside.iter().map(|&outer| outer as usize) {
                let [own, other] = [inner, outer].map(|id| &mesh.leaves[id]);
                if let (None, Some(a), Some(b)) = (limits[outer], &own.element, &other.element) {
                    let sizes = [own, other].map(|leaf| leaf.size() as f64);
                    sides[outer] += 1;
                    steps.push(Step {
                        inner,
                        outer,
                        reach: reach([a, b], sizes, limit),
                    });
                }
            }
        }
        Self { steps, sides }
    }

    /// The contributions of cells to the relative error of a function's energy, and the total: the
    /// systematic sum plus, for the random part, the root of the sum of squares.
    pub fn errors(
        &self,
        field: &MeshField,
        nodes: &Nodes,
        values: &[f64],
    ) -> (Vec<(usize, f64)>, f64) {
        let energy = field.energy(nodes, values).max(f64::MIN_POSITIVE);
        let element = |id: usize| field.mesh.leaves[id].element.as_ref();
        let own = |step: &Step| {
            let id = step.outer;
            let held = element(id).map_or(0.0, |it| it.energy(&nodes.of(id, values)));
            let change = held / energy * step.reach / f64::from(self.sides[id]);
            let of = if step.reach < 0.0 { step.inner } else { id };
            (of, change)
        };
        let changes: Vec<(usize, f64)> = self.steps.iter().map(own).collect();
        let sum = |of: &dyn Fn(f64) -> f64| changes.iter().map(|it| of(it.1)).sum::<f64>();
        let error = sum(&|change| change).abs() + sum(&|change| change * change).sqrt();
        let scale = error / sum(&f64::abs).max(f64::MIN_POSITIVE);
        let shares = changes.iter().map(|(id, it)| (*id, it.abs() * scale));
        (shares.collect(), error)
    }
}

/// How far a basin reaches beyond the side between a cell of it and one that is not, in sizes of the
/// latter.
fn reach([inner, outer]: [&Element; 2], [size, beyond]: [f64; 2], limit: f64) -> f64 {
    if inner.highest <= limit && outer.lowest >= limit {
        return 0.0;
    }
    if inner.mean >= limit {
        // A cell that is held although little of it lies below.
        let above = (inner.highest - limit) / (inner.highest - inner.lowest);
        return -above * size / beyond;
    }
    let part = ((limit - inner.mean) / (outer.mean - inner.mean)).clamp(0.0, 1.0);
    (part * (size + beyond) - size) / (2.0 * beyond)
}
