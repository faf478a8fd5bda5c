//! The probability of a match over orientation and speed: the paper's figure 6.

use super::Docking;
use landscape::Proportion;

/// One cell of the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapCell {
    /// Relative orientation (rad), lowest and highest.
    pub orientation: [f64; 2],
    /// Speed (m/s), lowest and highest.
    pub speed: [f64; 2],
    /// Share of the starts in the cell that matched.
    pub matched: Proportion,
}

/// Probabilities of a match over initial relative orientation and speed.
#[derive(Clone, Debug, PartialEq)]
pub struct DockingMap {
    /// Cells along the orientation and along the speed.
    pub size: [usize; 2],
    /// Cells, orientation by orientation within each speed.
    pub cells: Vec<MapCell>,
}

impl DockingMap {
    /// The trajectories of an experiment sorted into `size` cells over the range of its starts: one
    /// cell if the range is a single number.
    pub fn new(docking: &Docking, size: [usize; 2]) -> Self {
        let starts = &docking.settings.starts;
        let across = [-starts.orientation, starts.orientation];
        let up = starts.speed;
        let is_range = |[low, high]: [f64; 2]| high - low > 1e-9 * high.abs();
        let cells = |range, n| if is_range(range) { n } else { 1 };
        let size = [cells(across, size[0]), cells(up, size[1])];
        let cell = |value: f64, [low, high]: [f64; 2], n: usize| {
            let t = (value - low) / (high - low).max(f64::MIN_POSITIVE) * n as f64;
            (t.max(0.0) as usize).min(n - 1)
        };
        let mut counts = vec![(0, 0); size[0] * size[1]];
        for run in &docking.runs {
            let i = cell(run.start.orientation, across, size[0]);
            let j = cell(run.start.speed, up, size[1]);
            let count = &mut counts[j * size[0] + i];
            count.0 += usize::from(run.is_bound());
            count.1 += 1;
        }
        let ends = |k: usize, [low, high]: [f64; 2], n: usize| {
            [k, k + 1].map(|k| low + (high - low) * k as f64 / n as f64)
        };
        let cells = counts
            .iter()
            .enumerate()
            .map(|(k, &(matched, of))| MapCell {
                orientation: ends(k % size[0], across, size[0]),
                speed: ends(k / size[0], up, size[1]),
                matched: Proportion::new(matched, of),
            });
        Self {
            cells: cells.collect(),
            size,
        }
    }
}
