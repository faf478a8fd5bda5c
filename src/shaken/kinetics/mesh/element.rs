//! Element integrals of a cell: e^(-U/kT) times products of the gradients of shape functions.

use nalgebra::{Matrix3, Vector3};

/// A point of an integral.
pub(super) struct QuadraturePoint {
    /// Its position as a share of the cell's size.
    pub part: [f64; 3],
    /// The metric for gradients by these shares, without the weight.
    pub metric: Matrix3<f64>,
    /// The cell's volume if the volume element were constant.
    pub volume: f64,
    /// Its share of the cell.
    pub share: f64,
    /// Weight and load.
    pub weights: [f64; 2],
    /// U (J).
    pub energy: f64,
}

/// The integrals over the free part of a cell, its eight corners numbered as in [`super::Leaf::corner`].
#[derive(Clone, Debug)]
pub(in crate::kinetics) struct Element {
    /// Integrals of w grad(i) . grad(j), the upper triangle row by row (rad), with the weight w
    /// limited.
    pub stiffness: [f64; 36],
    /// Integral of the limited w (m^2 rad).
    pub weight: f64,
    /// Integrals of w times each shape function (m^2 rad).
    pub load: [f64; 8],
    /// The least and the greatest U met (J).
    pub lowest: f64,
    pub highest: f64,
    /// The mean of U over the free part (J).
    pub mean: f64,
    /// The gradients, at the cell's centre, of the positions as shares of its size, as columns:
    /// along s, across it and by theta.
    pub gradients: Matrix3<f64>,
}

impl Element {
    /// An element without any integrals yet.
    pub fn new(gradients: Matrix3<f64>) -> Self {
        Self {
            stiffness: [0.0; 36],
            weight: 0.0,
            load: [0.0; 8],
            lowest: f64::INFINITY,
            highest: f64::NEG_INFINITY,
            mean: 0.0,
            gradients,
        }
    }

    /// Adds a point to the integrals.
    pub(super) fn add(&mut self, point: &QuadraturePoint) {
        let [weight, load] = point.weights;
        let metric = point.metric * (point.share * weight);
        let volume = point.share * point.volume;
        let gradients = gradients(point.part);
        let flows = gradients.map(|gradient| metric * gradient);
        let mut entry = 0;
        for i in 0..8 {
            for flow in &flows[i..] {
                self.stiffness[entry] += gradients[i].dot(flow);
                entry += 1;
            }
        }
        self.weight += weight * volume;
        for (sum, shape) in self.load.iter_mut().zip(shapes(point.part)) {
            *sum += load * volume * shape;
        }
    }

    /// Its load (m^2 rad).
    pub fn held(&self) -> f64 {
        self.load.iter().sum()
    }

    /// The entry of the stiffness for two corners.
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.min(j), i.max(j));
        self.stiffness[i * 8 - i * (i + 1) / 2 + j]
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

/// A function's value at a point of the cell, given in parts of its size, from those at the corners.
pub(in crate::kinetics) fn value(part: [f64; 3], corners: &[f64; 8]) -> f64 {
    shapes(part).iter().zip(corners).map(|(s, v)| s * v).sum()
}

/// Its gradient by the parts.
pub(in crate::kinetics) fn slope(part: [f64; 3], corners: &[f64; 8]) -> Vector3<f64> {
    let each = gradients(part).into_iter().zip(corners);
    each.map(|(gradient, value)| gradient * *value).sum()
}

/// The shape functions of the corners at a point of the cell, given in parts of its size.
pub(super) fn shapes(part: [f64; 3]) -> [f64; 8] {
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
pub(super) fn gradients(part: [f64; 3]) -> [Vector3<f64>; 8] {
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
