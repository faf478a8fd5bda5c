//! A matrix: a number of every two of some things, as a colour.

use plotters::prelude::{RGBColor, WHITE};
use plotters::style::text_anchor::{HPos, VPos};

use super::composition::{Composition, Panel, remark, stacked};
use super::marks::{Box4, outline, polygon, polyline};
use super::picture::{Area, PictureError};
use super::style::{GRID, INK, SMALL, Text, VERMILLION};
use super::{Figure, Sheet};
use crate::document::Drawing;

const WIDTH: f64 = 860.0;
/// Greatest side of a cell (pixels).
const CELL: f64 = 56.0;
/// Space right of and below the cells (pixels).
const EDGE: f64 = 16.0;
/// Height of the key (pixels).
const KEY: f64 = 28.0;
/// Steps of the key's colours.
const STEPS: usize = 11;

/// A matrix.
#[derive(Clone, Debug)]
pub struct Matrix {
    /// The stem of its files.
    pub name: &'static str,
    /// What it shows.
    pub title: String,
    /// Of rows and of columns.
    pub names: Vec<String>,
    /// Numbers from 0 to 1, row by row; `None` where there is none.
    pub shares: Vec<Vec<Option<f64>>>,
    /// Whether rows and columns are framed.
    pub is_framed: fn(row: usize, column: usize, count: usize) -> bool,
    /// What its numbers are.
    pub legend: String,
    /// The numbers, as CSV.
    pub numbers: String,
}

impl Matrix {
    /// Draws it.
    ///
    /// # Errors
    /// See [`PictureError`].
    pub fn draw(&self, sheet: &Sheet) -> Result<Figure, PictureError> {
        let (names, count) = (self.widest(), self.names.len() as f64);
        let cell = move |width: f64| ((width - names - EDGE) / count.max(1.0)).min(CELL);
        let height = move |width| names + cell(width) * count + EDGE;
        let panel = Panel::new("", 0.0, height, move |root, _, [left, top, right, _]| {
            self.cells(root, (left + names, top + names), cell(right - left))
        });
        let composition = Composition {
            name: self.name.to_owned(),
            title: self.title.clone(),
            note: None,
            width: WIDTH.min(names + CELL * count + EDGE).max(0.6 * WIDTH),
            panels: vec![panel],
            key: Some(stacked(
                Panel::new("", 0.0, |_| KEY, |root, _, place| key(root, place)),
                remark(self.legend.clone()),
            )),
        };
        Figure::new(&composition, sheet, self.numbers.clone())
    }

    /// Room for a name (pixels).
    fn widest(&self) -> f64 {
        let widths = self.names.iter().map(|name| Text::new(SMALL).width(name));
        1.1 * widths.fold(20.0, f64::max) + 14.0
    }

    fn cells(&self, root: &Area, (left, top): (f64, f64), side: f64) -> Result<(), PictureError> {
        let middle = (HPos::Center, VPos::Center);
        let at = |k: usize| (k as f64 + 0.5) * side;
        // Names with room for each.
        let [lines, columns] = [16.0, self.widest()].map(|room| (room / side).ceil() as usize);
        let font = Text::new(SMALL);
        for (k, name) in self.names.iter().enumerate() {
            if k % lines == 0 {
                let place = (left - 6.0, top + at(k));
                font.write(root, name, place, (HPos::Right, VPos::Center))?;
            }
            if k % columns == 0 {
                font.write(root, name, (left + at(k), top - 12.0), middle)?;
            }
        }
        let places = |row: usize, column: usize, less: f64| {
            let (x, y) = (left + at(column), top + at(row));
            let half = 0.5 * side - less;
            [x - half, y - half, x + half, y + half]
        };
        for (row, shares) in self.shares.iter().enumerate() {
            for (column, share) in shares.iter().enumerate() {
                rectangle(root, places(row, column, 0.3), share.map_or(GRID, colour))?;
                if let Some(share) = share.filter(|_| side >= 30.0) {
                    let ink = if share > 0.5 { WHITE } else { INK };
                    let at = (left + at(column), top + at(row));
                    let font = Text::new(SMALL).colour(ink);
                    font.write(root, &format!("{share:.2}"), at, middle)?;
                }
                if (self.is_framed)(row, column, self.names.len()) {
                    let [left, top, right, bottom] = places(row, column, 0.04 * side + 0.6);
                    let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
                    let closed = [&corners[..], &corners[..1]].concat();
                    polyline(root, &closed, VERMILLION, 1.6)?;
                }
            }
        }
        Ok(())
    }
}

/// The colours from 0 to 1.
fn key(root: &Area, [left, top, ..]: Box4) -> Result<(), PictureError> {
    const STEP: f64 = 20.0;
    let (left, top, bottom) = (left + EDGE + 18.0, top + 8.0, top + 22.0);
    for step in 0..STEPS {
        let x = left + STEP * step as f64;
        let share = step as f64 / (STEPS - 1) as f64;
        rectangle(root, [x, top, x + STEP, bottom], colour(share))?;
    }
    let right = left + STEP * STEPS as f64;
    outline(root, [left, top, right, bottom], INK)?;
    let middle = (top + bottom) / 2.0;
    let font = Text::new(SMALL);
    font.write(root, "0", (left - 6.0, middle), (HPos::Right, VPos::Center))?;
    font.write(root, "1", (right + 6.0, middle), (HPos::Left, VPos::Center))
}

fn rectangle(
    root: &Area,
    [left, top, right, bottom]: Box4,
    fill: RGBColor,
) -> Result<(), PictureError> {
    let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
    polygon(root, &corners, fill, None)
}

/// White to dark blue.
fn colour(share: f64) -> RGBColor {
    let mix = |from: f64, to: f64| (from + (to - from) * share.clamp(0.0, 1.0)).round() as u8;
    RGBColor(mix(247.0, 8.0), mix(251.0, 48.0), mix(255.0, 107.0))
}

impl From<Matrix> for Drawing<'_> {
    fn from(matrix: Matrix) -> Self {
        Self::new(matrix.title.clone(), move |sheet| matrix.draw(sheet))
    }
}
