//! A Gaussian process over the places of a space, and the expected improvement.

use std::f64::consts::PI;

use super::space::{GridPoint, Space};

/// Correlation lengths that are tried along each dimension, relative to its range.
const LENGTHS: [f64; 6] = [0.06, 0.12, 0.25, 0.5, 1.0, 2.0];
/// Variance of what the process does not follow, relative to that of the values.
const NOISE: f64 = 1e-4;
/// Rounds over the dimensions in which lengths are chosen.
const SWEEPS: usize = 2;

/// A process through the values at places. All sums are in a fixed order, so that the bytes of the
/// result are the same on every processor.
pub struct Model<'a> {
    space: &'a Space,
    places: Vec<&'a GridPoint>,
    /// One over the squared correlation length along each dimension.
    weights: Vec<f64>,
    /// The lower triangle of Cholesky's factor, row by row.
    factor: Vec<Vec<f64>>,
    /// The covariances' inverse applied to the values.
    solved: Vec<f64>,
    mean: f64,
    variance: f64,
}

impl<'a> Model<'a> {
    /// The process with the most likely correlation lengths.
    pub fn fitted(space: &'a Space, places: Vec<&'a GridPoint>, values: &[f64]) -> Self {
        let mut weights = vec![1.0 / (0.5 * 0.5); space.dimensions.len()];
        for _ in 0..SWEEPS {
            for k in 0..weights.len() {
                let mut best = (f64::NEG_INFINITY, weights[k]);
                for length in LENGTHS {
                    weights[k] = 1.0 / (length * length);
                    let likely = Self::new(space, &places, &weights, values).likelihood();
                    if likely > best.0 {
                        best = (likely, weights[k]);
                    }
                }
                weights[k] = best.1;
            }
        }
        Self::new(space, &places, &weights, values)
    }

    fn new(space: &'a Space, places: &[&'a GridPoint], weights: &[f64], values: &[f64]) -> Self {
        let mut model = Self {
            space,
            places: places.to_vec(),
            weights: weights.to_vec(),
            factor: Vec::with_capacity(places.len()),
            solved: Vec::new(),
            mean: values.iter().sum::<f64>() / values.len() as f64,
            variance: 1.0,
        };
        for k in 0..places.len() {
            let row: Vec<f64> = (0..k)
                .map(|j| model.covariance(places[k], places[j]))
                .collect();
            let mut row = model.forward(&row);
            let rest = 1.0 + NOISE - row.iter().map(|x| x * x).sum::<f64>();
            row.push(libm::sqrt(rest.max(NOISE)));
            model.factor.push(row);
        }
        let centred: Vec<f64> = values.iter().map(|value| value - model.mean).collect();
        let half = model.forward(&centred);
        let squares: f64 = half.iter().map(|x| x * x).sum();
        model.variance = (squares / values.len() as f64).max(1e-12);
        model.solved = model.backward(half);
        model
    }

    /// Matern's covariance of order 5/2.
    fn covariance(&self, a: &GridPoint, b: &GridPoint) -> f64 {
        let parts = self.space.differences(a, b).zip(&self.weights);
        let square: f64 = parts.map(|(difference, weight)| weight * difference).sum();
        let r = libm::sqrt(5.0 * square);
        (1.0 + r + r * r / 3.0) * libm::exp(-r)
    }

    /// Solves with the factor, for as many rows as there are numbers.
    fn forward(&self, right: &[f64]) -> Vec<f64> {
        let mut solved: Vec<f64> = Vec::with_capacity(right.len());
        for (row, value) in self.factor.iter().zip(right) {
            let known: f64 = row.iter().zip(&solved).map(|(a, b)| a * b).sum();
            solved.push((value - known) / row[solved.len()]);
        }
        solved
    }

    /// Solves with the factor's transpose.
    fn backward(&self, mut right: Vec<f64>) -> Vec<f64> {
        for k in (0..right.len()).rev() {
            right[k] /= self.factor[k][k];
            for j in 0..k {
                right[j] -= self.factor[k][j] * right[k];
            }
        }
        right
    }

    /// The logarithm of the likelihood, without constants.
    fn likelihood(&self) -> f64 {
        let count = self.places.len() as f64;
        let determinant = self
            .factor
            .iter()
            .enumerate()
            .map(|(k, row)| libm::log(row[k]));
        -0.5 * count * libm::log(self.variance) - determinant.sum::<f64>()
    }

    /// The expected value at a place, and its standard deviation.
    pub fn predict(&self, place: &GridPoint) -> (f64, f64) {
        let known = self.places.iter().map(|one| self.covariance(one, place));
        let known: Vec<f64> = known.collect();
        let mean: f64 = known.iter().zip(&self.solved).map(|(a, b)| a * b).sum();
        let left = 1.0 - self.forward(&known).iter().map(|x| x * x).sum::<f64>();
        let deviation = libm::sqrt(self.variance * left.max(0.0));
        (self.mean + mean, deviation)
    }

    /// By how much a place is expected to exceed a value.
    pub fn improvement(&self, place: &GridPoint, best: f64) -> f64 {
        let (mean, deviation) = self.predict(place);
        if deviation <= 0.0 {
            return (mean - best).max(0.0);
        }
        let z = (mean - best) / deviation;
        let density = libm::exp(-0.5 * z * z) / libm::sqrt(2.0 * PI);
        let share = 0.5 * libm::erfc(-z / libm::sqrt(2.0));
        (mean - best) * share + deviation * density
    }

    /// The chance that the value at a place is above 0.
    pub fn chance(&self, place: &GridPoint) -> f64 {
        let (mean, deviation) = self.predict(place);
        0.5 * libm::erfc(-mean / (deviation.max(1e-12) * libm::sqrt(2.0)))
    }

    /// The same process with another place, at which the value is as expected: the next place is
    /// then sought elsewhere.
    #[must_use]
    pub fn with(&self, place: &'a GridPoint, values: &mut Vec<f64>) -> Self {
        values.push(self.predict(place).0);
        let places = [&self.places[..], &[place]].concat();
        Self::new(self.space, &places, &self.weights, values)
    }
}
