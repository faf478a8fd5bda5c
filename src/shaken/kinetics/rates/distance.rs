//! The distribution of the distance between a pair of tiles in equilibrium.

use super::field::{DIVIDED, MeshField};
use crate::kinetics::mesh::UNITS;
use tiles::configuration::Configuration;
use tiles::problem::Problem;

/// Meshes are refined until the total change of the shares of all distances is less than this, ...
const SETTLED: f64 = 4e-3;
/// ... twice in a row, or until they have this many cells.
const MOST_CELLS: usize = 150_000;

/// The distribution of the distance of the centres of a pair in equilibrium at one kT, up to a
/// limit.
///
/// The probability density of a distance r is proportional to `r` times the integral of e^(-U/kT)
/// over all directions and angles that contact leaves free: without magnets it is `2 r / end^2`
/// outside contact. The size of the table does not matter, as long as its rim is farther away.
#[derive(Clone, Debug, PartialEq)]
pub struct Distances {
    /// The ends of the bins (m), in ascending order: one more than shares.
    pub edges: Vec<f64>,
    /// The probability of each bin.
    pub shares: Vec<f64>,
    /// The sum of the changes of the shares in the last refinement: an estimate of their error.
    pub moved: f64,
}

impl Distances {
    /// Computes the distribution at kT (J) up to a limit (m), in about 32 bins; energies are
    /// relative to the deepest known state, `bond`.
    pub fn new(problem: &Problem, bond: &Configuration, kt: f64, end: f64) -> Self {
        let ground = problem.energy(bond);
        let mut field = MeshField::new(problem, (kt, false), end, ground, &[*bond]);
        field.settle(&[*bond], &[]);
        let mut known: Option<Vec<f64>> = None;
        let mut settled = 0;
        loop {
            let shares = shares(&field);
            let moved = known.map_or(f64::INFINITY, |known| {
                let changes = known.iter().zip(&shares).map(|(a, b)| (a - b).abs());
                changes.sum()
            });
            settled = if moved < SETTLED { settled + 1 } else { 0 };
            let cells = field.mesh.live().count();
            if settled == 2 || cells > MOST_CELLS {
                return Self {
                    edges: edges(&field),
                    shares,
                    moved,
                };
            }
            let mut errors = vec![0.0; field.mesh.leaves.len()];
            for (id, _, element) in field.mesh.live() {
                // Functions that vary little over a cell are integrated accurately.
                let change = ((element.highest - element.lowest) / kt).min(1.0);
                errors[id] = element.held() * change * change;
            }
            field.refine(&errors, DIVIDED);
            known = Some(shares);
        }
    }

    /// The bin of a distance (m); `None` beyond the limit and where tiles would overlap.
    pub fn part(&self, distance: f64) -> Option<usize> {
        let part = self.edges.partition_point(|edge| *edge <= distance);
        let last = self.shares.len();
        let part = if distance == self.edges[last] {
            last
        } else {
            part
        };
        let found = part.checked_sub(1).filter(|part| *part < last)?;
        (self.shares[found] > 0.0).then_some(found)
    }
}

/// The first cells' ends along the distance (m).
fn edges(field: &MeshField) -> Vec<f64> {
    let chart = &field.mesh.chart;
    let radius = |cell: i64| {
        let [s, ..] = chart.coordinates([(cell * UNITS) as f64, 0.0, 0.0]);
        chart.distance(s)
    };
    (0..=chart.cells[0]).map(radius).collect()
}

fn shares(field: &MeshField) -> Vec<f64> {
    let mut sums = vec![0.0; field.mesh.chart.cells[0] as usize];
    for (_, leaf, element) in field.mesh.live() {
        sums[(leaf.low[0] / UNITS) as usize] += element.held();
    }
    let all: f64 = sums.iter().sum();
    sums.iter().map(|sum| sum / all).collect()
}
