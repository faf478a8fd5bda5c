//! What is integrated over a cell: e^(-U/kT) times products of shape functions' gradients.

use nalgebra::{Matrix3, Vector3};

use super::chart::Chart;
use super::octree::Leaf;
use super::wall::Ray;

/// The integrals over the free part of a cell, its eight corners numbered as in [`Leaf::corner`].
#[derive(Clone, Debug)]
pub(in crate::kinetics) struct Element {
    /// Of w grad(i) . grad(j), the upper triangle row by row (rad), the weight w kept in bounds.
    pub stiffness: [f64; 36],
    /// Of w, kept in bounds (m^2 rad).
    pub weight: f64,
    /// How much is free (m^2 rad).
    pub free: f64,
    /// Of w times each shape function (m^2 rad).
    pub load: [f64; 8],
    /// The least and the greatest U met (J).
    pub lowest: f64,
    pub highest: f64,
    /// The mean of U over what is free (J).
    pub mean: f64,
    /// In the cell's middle the gradients of the parts of its size, as columns: along the ray from
    /// the centre, across it and by theta.
    pub gradients: Matrix3<f64>,
}

impl Element {
    /// Of which nothing has been integrated.
    pub fn new(gradients: Matrix3<f64>) -> Self {
        Self {
            stiffness: [0.0; 36],
            weight: 0.0,
            free: 0.0,
            load: [0.0; 8],
            lowest: f64::INFINITY,
            highest: f64::NEG_INFINITY,
            mean: 0.0,
            gradients,
        }
    }

    /// The entry of the stiffness for two corners.
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.min(j), i.max(j));
        self.stiffness[i * 8 - i * (i + 1) / 2 + j]
    }

    /// How the load is tilted along phi and theta: as 1 + tilt (2 u - 1) at the part u of the size,
    /// the mean of u as it is; no more than falls to 0.
    pub fn tilts(&self) -> [f64; 2] {
        let all: f64 = self.load.iter().sum();
        [1, 2].map(|axis| {
            let upper = (0..8).filter(|corner| corner >> axis & 1 == 1);
            let mean = upper.map(|corner| self.load[corner]).sum::<f64>() / all;
            if mean.is_finite() {
                (6.0 * mean - 3.0).clamp(-1.0, 1.0)
            } else {
                0.0
            }
        })
    }

    /// The integral of w grad f . grad f for values at the corners (rad).
    pub fn energy(&self, values: &[f64; 8]) -> f64 {
        self.times(values)
            .iter()
            .zip(values)
            .map(|(a, b)| a * b)
            .sum()
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
    /// How much of the cell is free, as a share of it, and the integral of U over that (J).
    pub free: [f64; 2],
}

impl<'a> Sum<'a> {
    /// Of a cell of which nothing has been integrated.
    pub fn new(chart: &'a Chart, leaf: &'a Leaf) -> Self {
        Self {
            chart,
            leaf,
            element: Element::new(Matrix3::zeros()),
            free: [0.0; 2],
        }
    }

    /// (s, phi, theta) of a point given in parts of the cell's size.
    pub fn coordinates(&self, part: [f64; 3]) -> [f64; 3] {
        let size = self.leaf.size() as f64;
        self.chart.coordinates(std::array::from_fn(|i| {
            self.leaf.low[i] as f64 + part[i] * size
        }))
    }

    /// s of a part of the cell's size.
    pub fn along(&self, part: f64) -> f64 {
        self.coordinates([part, 0.0, 0.0])[0]
    }

    /// The ray through a point of the cell's face.
    pub fn ray(&self, [v, w]: [f64; 2]) -> Ray {
        let [_, phi, theta] = self.coordinates([0.0, v, w]);
        self.chart.ray([phi, theta])
    }

    /// Gradients by x, y and theta of the parts at a point of a ray, as columns.
    pub fn gradients(&self, ray: &Ray, s: f64) -> Matrix3<f64> {
        let mut by = ray.gradients(s);
        let sizes = self.chart.size(self.leaf.level);
        for (mut column, size) in by.column_iter_mut().zip(sizes) {
            column /= size;
        }
        by
    }

    /// What gradients by the parts are multiplied with at a point, but for the weight, and the
    /// cell's volume if it were the same everywhere.
    pub fn metric(&self, part: [f64; 3], ray: &Ray, inverse: &Matrix3<f64>) -> (Matrix3<f64>, f64) {
        let s = self.along(part[0]);
        let size: f64 = self.chart.size(self.leaf.level).iter().product();
        let volume = ray.volume(s) * size;
        let by = self.gradients(ray, s);
        (by.transpose() * inverse * by * volume, volume)
    }

    /// Adds a point on a ray with the inverse of the mass metric there, its share of the cell and
    /// its weights, the one kept in bounds and the other not.
    pub fn add(
        &mut self,
        part: [f64; 3],
        ray: &Ray,
        inverse: &Matrix3<f64>,
        share: f64,
        weights: [f64; 2],
    ) {
        let (metric, volume) = self.metric(part, ray, inverse);
        let (metric, volume) = (metric * (share * weights[0]), share * volume);
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
        self.element.free += volume;
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
