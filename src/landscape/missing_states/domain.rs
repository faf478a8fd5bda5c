//! The part of the space that is searched; its images under the problem's symmetries cover the
//! whole space.

use std::f64::consts::PI;

use tiles::cell::Cell;
use tiles::configuration::Configuration;
use tiles::problem::{Problem, Symmetry};

/// Cells along theta at the start.
const SLICES: u32 = 8;
/// Rounding of coordinates is less than this fraction of the largest of them.
const ROUNDING: f64 = 1e-12;

/// A wedge of the plane and a sector of theta. An n-fold symmetry of the moving tile leaves the
/// n-th part of theta, one of the fixed tile the n-th part of the plane.
pub(super) struct Domain {
    half_size: [f64; 2],
    /// Turns of the moving tile onto itself.
    of_moving: u32,
    /// Sine and cosine of half the wedge's angle; `None` if it is the whole plane.
    wedge: Option<(f64, f64)>,
}

impl Domain {
    pub fn new(problem: &Problem) -> Self {
        let count = |unturned: &dyn Fn(&Symmetry) -> f64| {
            let all = problem.symmetries.iter();
            all.filter(|s| unturned(s).abs() < 1e-9).count().max(1) as u32
        };
        let of_fixed = count(&|s| s.moving);
        let [x, y] = problem.space.half_size;
        // A turned table is a different one, unless the tiles do not reach its rim.
        let is_wide = x.min(y) >= problem.space.free_distance;
        Self {
            half_size: [x, y],
            of_moving: count(&|s| s.fixed),
            wedge: (of_fixed > 1 && is_wide).then(|| libm::sincos(PI / f64::from(of_fixed))),
        }
    }

    /// The rounding of a coordinate (m).
    fn rounding(&self) -> f64 {
        ROUNDING * self.half_size[0].max(self.half_size[1])
    }

    /// The cells at the start of the search.
    pub fn first_cells(&self) -> Vec<Cell> {
        let slice = PI / f64::from(self.of_moving * SLICES);
        let rounding = self.rounding();
        let [x, y] = self.half_size.map(|size| size / 2.0);
        let mut cells = Vec::new();
        for k in 0..SLICES {
            let theta = f64::from(2 * k + 1) * slice - PI / f64::from(self.of_moving);
            for [right, up] in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
                cells.push(Cell {
                    centre: Configuration::new(right * x, up * y, theta),
                    half: [x + rounding, y + rounding, slice + ROUNDING],
                });
            }
        }
        cells.retain(|cell| self.meets(cell));
        cells
    }

    /// Whether a cell may reach into the wedge.
    pub fn meets(&self, cell: &Cell) -> bool {
        let Some((sin, cos)) = self.wedge else {
            return true;
        };
        // The corner farthest to the inner side of either of the wedge's lines.
        [cos, -cos].into_iter().all(|cos| {
            let centre = sin * cell.centre.x + cos * cell.centre.y;
            centre + sin * cell.half[0] + cos.abs() * cell.half[1] >= -self.rounding()
        })
    }
}
