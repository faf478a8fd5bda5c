//! A committor and its reactive flux projected onto (x, y), combined over theta.

use std::f64::consts::TAU;

use super::field::MeshField;
use crate::kinetics::mesh::{Nodes, slope, value};

/// Number of points along s and phi that represent a cell.
const POINTS: usize = 4;

/// A committor over the landscape: on squares of the plane in which the moving tile's reference
/// point lies.
///
/// E and Vanden-Eijnden, doi:10.1007/s10955-005-9003-9: the flux of tiles from one end to the other
/// is `D e^(-U/kT) grad q`.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Half the size of the map (m) along x and y.
    pub radius: f64,
    /// Squares along x and y.
    pub side: usize,
    /// The mean of the committor over the free configurations of a square, weighted with e^(-U/kT),
    /// row by row from the lowest x and y, x first; NaN if nothing is free.
    pub committor: Vec<f64>,
    /// The flux through a square along x and y per metre, as a share of the total flow from end to
    /// end (1/m).
    pub flux: Vec<[f64; 2]>,
}

impl Map {
    /// Projects a function on a mesh onto a number of squares along x and y.
    pub(super) fn new(field: &MeshField, nodes: &Nodes, values: &[f64], side: usize) -> Self {
        let chart = &field.mesh.chart;
        let radius = chart.distance(1.0);
        let turn = chart.turn();
        let turns = (TAU / turn).round() as usize;
        let mut sums = vec![[0.0; 4]; side * side];
        for (id, leaf, element) in field.mesh.live() {
            let own = nodes.of(id, values);
            let slope = element.gradients * slope([0.5; 3], &own);
            for number in 0..POINTS * POINTS {
                let part =
                    [number % POINTS, number / POINTS].map(|k| (k as f64 + 0.5) / POINTS as f64);
                let part = [part[0], part[1], 0.5];
                let [s, phi, _] = chart.coordinates(leaf.at(part));
                let r = chart.distance(s);
                let value = value(part, &own);
                let weight = element.weight / (POINTS * POINTS) as f64;
                for copy in 0..turns {
                    let (sin, cos) = libm::sincos(phi + turn * copy as f64);
                    let at = [r * cos, r * sin].map(|x| (x / radius + 1.0) / 2.0 * side as f64);
                    let [i, j] = at.map(|x| (x as usize).min(side - 1));
                    let flux = [slope.x * cos - slope.y * sin, slope.x * sin + slope.y * cos];
                    let terms = [1.0, value, flux[0], flux[1]];
                    for (sum, term) in sums[j * side + i].iter_mut().zip(terms) {
                        *sum += weight * term;
                    }
                }
            }
        }
        let through = field.energy(nodes, values) * turns as f64;
        let square = (2.0 * radius / side as f64).powi(2);
        // Committors are between 0 and 1, except for rounding and the solver's tolerance.
        let mean = |sum: &[f64; 4]| (sum[1] / sum[0]).clamp(0.0, 1.0);
        Self {
            radius,
            side,
            committor: sums.iter().map(mean).collect(),
            flux: sums
                .iter()
                .map(|sum| [sum[2], sum[3]].map(|flow| flow / square / through))
                .collect(),
        }
    }

    /// The middle (m) of a square.
    pub fn middle(&self, square: usize) -> [f64; 2] {
        let of = |k: usize| ((k as f64 + 0.5) / self.side as f64 * 2.0 - 1.0) * self.radius;
        [of(square % self.side), of(square / self.side)]
    }
}
