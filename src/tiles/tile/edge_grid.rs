//! Finds the edges of an outline near a point, with a uniform grid.

use nalgebra::Vector2;

use super::plane::extent;

/// Outlines with fewer edges are searched one by one.
const WORTHWHILE: usize = 16;
/// Cells along the longer side of the outline's bounding box.
const CELLS: f64 = 64.0;

/// A uniform grid; each cell lists the edges that pass through it.
#[derive(Clone, Debug)]
pub struct EdgeGrid {
    low: Vector2<f64>,
    high: Vector2<f64>,
    cell: f64,
    columns: usize,
    rows: usize,
    /// The edges of cell (i, j), row by row: `edges[starts[c]..starts[c + 1]]`.
    starts: Vec<u32>,
    edges: Vec<u32>,
    count: usize,
}

impl EdgeGrid {
    /// The grid of a closed polygon.
    pub fn new(vertices: &[Vector2<f64>]) -> Self {
        let [low, high] = extent(vertices.iter().copied());
        let size = high - low;
        let cell = size.max() / CELLS;
        let columns = (size.x / cell) as usize + 1;
        let rows = (size.y / cell) as usize + 1;
        let mut grid = Self {
            low,
            high,
            cell,
            columns,
            rows,
            starts: Vec::new(),
            edges: Vec::new(),
            count: vertices.len(),
        };
        if vertices.len() >= WORTHWHILE {
            grid.fill(vertices);
        }
        grid
    }

    fn fill(&mut self, vertices: &[Vector2<f64>]) {
        let mut lists: Vec<Vec<u32>> = vec![Vec::new(); self.columns * self.rows];
        for (edge, a) in vertices.iter().enumerate() {
            let b = vertices[(edge + 1) % vertices.len()];
            // Pieces no longer than a cell, each entered into the cells of its bounding box.
            let pieces = ((b - a).norm() / self.cell).ceil().max(1.0) as usize;
            for piece in 0..pieces {
                let at = |k: usize| a + (b - a) * (k as f64 / pieces as f64);
                let (p, q) = (at(piece), at(piece + 1));
                for cell in self.cells(p.inf(&q), p.sup(&q)) {
                    if lists[cell].last() != Some(&(edge as u32)) {
                        lists[cell].push(edge as u32);
                    }
                }
            }
        }
        self.starts = vec![0];
        for list in lists {
            self.edges.extend(list);
            self.starts.push(self.edges.len() as u32);
        }
    }

    fn cells(&self, low: Vector2<f64>, high: Vector2<f64>) -> impl Iterator<Item = usize> + use<> {
        let index = |value: f64, most: usize| {
            (((value) / self.cell).floor().max(0.0) as usize).min(most - 1)
        };
        let columns =
            index(low.x - self.low.x, self.columns)..=index(high.x - self.low.x, self.columns);
        let rows = index(low.y - self.low.y, self.rows)..=index(high.y - self.low.y, self.rows);
        let width = self.columns;
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    /// Writes into `found` all edges that may come within `margin` (m) of a point, ascending.
    pub fn near(&self, p: Vector2<f64>, margin: f64, found: &mut Vec<u32>) {
        found.clear();
        let around = Vector2::repeat(margin);
        let (low, high) = (p - around, p + around);
        let outside = high.x < self.low.x
            || low.x > self.high.x
            || high.y < self.low.y
            || low.y > self.high.y;
        if outside {
            return;
        }
        if self.starts.is_empty() {
            found.extend(0..self.count as u32);
            return;
        }
        for cell in self.cells(low, high) {
            let list = self.starts[cell] as usize..self.starts[cell + 1] as usize;
            found.extend_from_slice(&self.edges[list]);
        }
        found.sort_unstable();
        found.dedup();
    }
}
