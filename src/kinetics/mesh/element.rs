//! What is integrated over a cell: e^(-U/kT) times products of shape functions' gradients.

use nalgebra::{Matrix3, Vector3};

use super::chart::Chart;
use super::octree::Leaf;
use crate::configuration::Configuration;

/// The integrals over the free part of a cell, its eight corners numbered as in [`Leaf::corner`].
#[derive(Clone, Debug)]
pub(in crate::kinetics) struct Element {
    /// Of w grad(i) . grad(j), the upper triangle row by row (rad), the weight w kept in bounds.
    pub stiffness: [f64; 36],
    /// Of w, kept in bounds (m^2 rad).
    pub weight: f64,
    /// Of w times each shape function (m^2 rad).
    pub load: [f64; 8],
    /// The least U met (J).
    pub lowest: f64,
}

impl Element {
    /// The entry of the stiffness for two corners.
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.min(j), i.max(j));
        self.stiffness[i * 8 - i * (i + 1) / 2 + j]
    }

    /// The stiffness times values at the corners.
    pub fn times(&self, values: &[f64; 8]) -> [f64; 8] {
        std::array::from_fn(|i| (0..8).map(|j| self.entry(i, j) * values[j]).sum())
    }
}

/// A cell's integrals as they grow.
pub(super) struct Sum<'a> {
    pub chart: &'a Chart,
    pub leaf: &'a Leaf,
    pub element: Element,
}

impl Sum<'_> {
    /// (r, phi, theta) of a point given in parts of the cell's size.
    pub fn coordinates(&self, part: [f64; 3]) -> [f64; 3] {
        let size = self.leaf.size() as f64;
        self.chart.coordinates(std::array::from_fn(|i| {
            self.leaf.low[i] as f64 + part[i] * size
        }))
    }

    /// The configuration there.
    pub fn configuration(&self, part: [f64; 3]) -> Configuration {
        let [r, phi, theta] = self.coordinates(part);
        Configuration::new(r * phi.cos(), r * phi.sin(), theta)
    }

    /// Adds a point with the inverse of the mass metric there, its share of the cell and its weights,
    /// the one kept in bounds and the other not.
    pub fn add(&mut self, part: [f64; 3], inverse: &Matrix3<f64>, share: f64, weights: [f64; 2]) {
        let [r, phi, _] = self.coordinates(part);
        let size = self.chart.size(self.leaf.level);
        let volume = share * r * size[0] * size[1] * size[2];
        // Gradients by x, y and theta of the parts of r, phi and theta.
        let (sin, cos) = phi.sin_cos();
        let by = Matrix3::from_columns(&[
            Vector3::new(cos, sin, 0.0) / size[0],
            Vector3::new(-sin, cos, 0.0) / (r * size[1]),
            Vector3::new(0.0, 0.0, 1.0 / size[2]),
        ]);
        let metric = by.transpose() * inverse * by * (weights[0] * volume);
        let gradients = gradients(part);
        let flows = gradients.map(|gradient| metric * gradient);
        let mut entry = 0;
        for i in 0..8 {
            for flow in &flows[i..] {
                self.element.stiffness[entry] += gradients[i].dot(flow);
                entry += 1;
            }
        }
        self.element.weight += weights[0] * volume;
        for (load, shape) in self.element.load.iter_mut().zip(shapes(part)) {
            *load += weights[1] * volume * shape;
        }
    }
}

/// The shape functions of the corners at a point of the cell, given in parts of its size.
pub(in crate::kinetics) fn shapes(part: [f64; 3]) -> [f64; 8] {
    std::array::from_fn(|number| {
        (0..3)
            .map(|i| {
                if number >> i & 1 == 1 {
                    part[i]
                } else {
                    1.0 - part[i]
                }
            })
            .product()
    })
}

/// Their gradients by the parts.
pub(in crate::kinetics) fn gradients(part: [f64; 3]) -> [Vector3<f64>; 8] {
    std::array::from_fn(|number| {
        let value = |i: usize| {
            if number >> i & 1 == 1 {
                part[i]
            } else {
                1.0 - part[i]
            }
        };
        let slope = |i: usize| if number >> i & 1 == 1 { 1.0 } else { -1.0 };
        Vector3::new(
            slope(0) * value(1) * value(2),
            value(0) * slope(1) * value(2),
            value(0) * value(1) * slope(2),
        )
    })
}
