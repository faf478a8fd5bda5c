//! Estimates of the discretisation error of functions on a mesh.

use nalgebra::Vector3;

use super::field::MeshField;
use super::rim::Rims;
use crate::kinetics::mesh::{Element, Nodes, slope};

/// Estimated relative errors of functions' energies.
pub(super) struct Errors {
    /// Errors by cell, summed over functions.
    pub shares: Vec<f64>,
    /// The largest of all functions, ...
    pub largest: f64,
    /// ... and its part because basins consist of whole cells.
    pub of_rims: f64,
}

impl MeshField<'_> {
    /// The estimated errors of functions' energies by cell, each relative to the function's energy,
    /// and summed. Functions without energy have no error.
    ///
    /// The estimate is Zienkiewicz and Zhu's (1987, doi:10.1002/nme.1620240206): the gradient
    /// against the continuous one that results from averaging it at the corners; the error because
    /// basins consist of whole cells is added.
    pub fn errors(&self, nodes: &Nodes, rims: &Rims, functions: &[&Vec<f64>]) -> Errors {
        let mut shares = vec![0.0; self.mesh.leaves.len()];
        let (mut largest, mut of_rims) = (0.0_f64, 0.0_f64);
        for values in functions {
            let energy = self.energy(nodes, values).max(f64::MIN_POSITIVE);
            let (at_rims, mut sum) = rims.errors(self, nodes, values);
            of_rims = of_rims.max(sum);
            for (id, error) in at_rims {
                shares[id] += error;
            }
            for (id, leaf, element) in self.mesh.live().filter(|(_, leaf, _)| leaf.doubt > 0.0) {
                let error = leaf.doubt * element.energy(&nodes.of(id, values)).max(0.0);
                shares[id] += error / energy;
                sum += error / energy;
            }
            for (id, error) in self.gradient_errors(nodes, values) {
                shares[id] += error / energy;
                sum += error / energy;
            }
            largest = largest.max(sum);
        }
        Errors {
            shares,
            largest,
            of_rims,
        }
    }

    fn gradient_errors(&self, nodes: &Nodes, values: &[f64]) -> Vec<(usize, f64)> {
        let mut averages = vec![(Vector3::zeros(), 0.0); nodes.len()];
        for (id, _, element) in self.mesh.live() {
            for (corner, &node) in nodes.corners[id].iter().enumerate() {
                let (sum, weight) = &mut averages[node as usize];
                *sum += self.slope(nodes, values, id, corner) * element.weight;
                *weight += element.weight;
            }
        }
        let error = |(id, _, element): (usize, _, &Element)| {
            let corners = nodes.corners[id].iter().enumerate();
            let squares = corners.map(|(corner, &node)| {
                let (sum, weight) = averages[node as usize];
                (self.slope(nodes, values, id, corner) - sum / weight).norm_squared()
            });
            (id, element.weight * squares.sum::<f64>() / 8.0)
        };
        self.mesh.live().map(error).collect()
    }

    /// The gradient (1/m) at a corner of a cell.
    fn slope(&self, nodes: &Nodes, values: &[f64], id: usize, corner: usize) -> Vector3<f64> {
        let part = std::array::from_fn(|i| (corner >> i & 1) as f64);
        let by = slope(part, &nodes.of(id, values));
        let element = self.mesh.leaves[id].element.as_ref();
        let by = element.map_or(by, |element| element.gradients * by);
        by.component_div(&Vector3::new(1.0, 1.0, self.mesh.rho))
    }
}
