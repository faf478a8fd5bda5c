//! A matrix as a colour map.

use super::canvas::{Box4, Canvas, Spot, corners};
use super::composition::{Composition, Panel, remark};
use super::heat::{Marked, bar, cell};
use super::picture::PictureError;
use super::style::{Anchor, GRID, SMALL, VERMILLION};
use super::{Drawing, Figure, Sheet};

const WIDTH: f64 = 860.0;
/// Largest side of a cell (pixels).
const CELL: f64 = 56.0;
/// Space right of and below the cells (pixels).
const EDGE: f64 = 16.0;

/// A matrix.
#[derive(Clone, Debug)]
pub struct Matrix {
    /// The stem of its files.
    pub name: &'static str,
    /// The title.
    pub title: String,
    /// Names of rows and columns.
    pub names: Vec<String>,
    /// Numbers from 0 to 1, row by row; `None` if there is none.
    pub shares: Vec<Vec<Option<f64>>>,
    /// Whether rows and columns are framed.
    pub is_framed: fn(row: usize, column: usize, count: usize) -> bool,
    /// The meaning of its numbers.
    pub legend: &'static str,
    /// A remark; may be empty.
    pub remark: &'static str,
    /// The numbers, as CSV.
    pub numbers: String,
}

impl Matrix {
    /// Draws the matrix.
    ///
    /// # Errors
    /// See [`PictureError`].
    pub fn draw(&self, sheet: &Sheet) -> Result<Figure, PictureError> {
        let (names, count) = (self.widest(), self.names.len() as f64);
        let side = move |width: f64| ((width - names - EDGE) / count.max(1.0)).min(CELL);
        let height = move |width| names + side(width) * count + EDGE;
        let panel = Panel::alone(height, move |canvas, [left, top, right, _]| {
            self.cells(canvas, (left + names, top + names), side(right - left));
        });
        let ends = [0.0, 1.0].map(|at| Marked {
            at,
            text: at.to_string(),
            is_crossed: false,
        });
        let composition = Composition {
            name: self.name.to_owned(),
            title: self.title.clone(),
            width: WIDTH.min(names + CELL * count + EDGE).max(0.6 * WIDTH),
            panels: vec![panel],
            keys: vec![
                bar(self.legend, colour, ends),
                remark(self.remark.to_owned()),
            ],
            ..Composition::default()
        };
        Figure::new(&composition, sheet, self.numbers.clone())
    }

    /// Room for a name (pixels).
    fn widest(&self) -> f64 {
        let widths = self.names.iter().map(|name| SMALL.room(name));
        widths.fold(20.0, f64::max) + 14.0
    }

    fn cells(&self, canvas: &mut Canvas, (left, top): (f64, f64), side: f64) {
        let at = |k: usize| (k as f64 + 0.5) * side;
        // The names for which there is room.
        let [lines, columns] = [16.0, self.widest()].map(|room| (room / side).ceil() as usize);
        for (k, name) in self.names.iter().enumerate() {
            if k % lines == 0 {
                canvas.note(name, (left - 6.0, top + at(k)), Anchor::Right);
            }
            if k % columns == 0 {
                canvas.note(name, (left + at(k), top - 12.0), Anchor::Middle);
            }
        }
        let place = |row: usize, column: usize, less: f64| -> Box4 {
            let (x, y) = (left + at(column), top + at(row));
            let half = 0.5 * side - less;
            [x - half, y - half, x + half, y + half]
        };
        for (row, shares) in self.shares.iter().enumerate() {
            for (column, share) in shares.iter().enumerate() {
                let fill = share.map_or([GRID.0; 3], colour);
                let text = share.map_or(String::new(), |share| format!("{share:.2}"));
                cell(canvas, place(row, column, 0.3), fill, &text);
                let spot = Spot {
                    title: format!("{} on {} {text}", self.names[row], self.names[column]),
                    kind: "cell",
                    value: format!("{row} {column}"),
                };
                canvas.spot(&corners(place(row, column, 0.0)), spot);
                if (self.is_framed)(row, column, self.names.len()) {
                    let inner = corners(place(row, column, 0.04 * side + 0.6));
                    canvas.ring(&inner, VERMILLION, 1.6);
                }
            }
        }
    }
}

/// White to dark blue.
fn colour(share: f64) -> [u8; 3] {
    let mix = |from: f64, to: f64| (from + (to - from) * share.clamp(0.0, 1.0)).round() as u8;
    [mix(247.0, 8.0), mix(251.0, 48.0), mix(255.0, 107.0)]
}

impl From<Matrix> for Drawing<'_> {
    fn from(matrix: Matrix) -> Self {
        Self::new(matrix.title.clone(), move |sheet| matrix.draw(sheet))
    }
}
