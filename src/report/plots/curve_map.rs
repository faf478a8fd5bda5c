//! The figures of a sweep as maps over two varied numbers.

use plotters::prelude::RGBColor;
use plotters::style::text_anchor::{HPos, VPos};

use super::curve_data::Variable;
use super::marks::{Box4, outline, polygon, polyline};
use super::picture::{Area, Picture, PictureError};
use super::scale::{colour, minus};
use super::style::{GRID, INK, LABEL, SMALL, SOFT, Text, title};
use crate::comparison::{Assessment, Quantity};
use crate::units::prefix_and_decimals;

const WIDTH: f64 = 1200.0;
const HEAD: f64 = 60.0;
const PANEL: (f64, f64) = (400.0, 380.0);
const COLUMNS: usize = 3;
/// Space around a panel's plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [52.0, 18.0, 62.0, 76.0];
/// Cells narrower or lower than this (pixels) hold no number.
const ROOM: (f64, f64) = (38.0, 17.0);

const PANELS: [(Quantity, &str); 6] = [
    (Quantity::BondDepth, "bond: depth"),
    (Quantity::TrapDepth, "deepest trap: depth"),
    (Quantity::Selectivity, "selectivity"),
    (Quantity::Unbinding, "unbinding barrier"),
    (Quantity::TrapEscape, "escape from the deepest trap"),
    (Quantity::Captured, "captured far starts"),
];

/// A panel a figure, a cell a point; `cells` row by row from the lowest. Crosses mark impossible
/// designs.
///
/// # Errors
/// See [`PictureError`].
pub fn draw(
    text: &str,
    x: &Variable,
    y: &Variable,
    cells: &[Option<Option<&Assessment>>],
) -> Result<Picture, PictureError> {
    let rows = PANELS.len().div_ceil(COLUMNS);
    let height = HEAD + PANEL.1 * rows as f64;
    Picture::draw((WIDTH as u32, height as u32), |root, _| {
        title(root, text)?;
        for (k, (quantity, heading)) in PANELS.into_iter().enumerate() {
            let (column, row) = (k % COLUMNS, k / COLUMNS);
            let left = PANEL.0 * column as f64 + MARGIN[3];
            let top = HEAD + PANEL.1 * row as f64 + MARGIN[0];
            let place = [
                left,
                top,
                left + PANEL.0 - MARGIN[3] - MARGIN[1],
                top + PANEL.1 - MARGIN[0] - MARGIN[2],
            ];
            let panel = Map {
                root,
                quantity,
                place,
                size: [x.values.len(), y.values.len()],
            };
            panel.draw(heading, cells)?;
            panel.axes(x, y)?;
        }
        Ok(())
    })
}

struct Map<'a, 'b> {
    root: &'a Area<'b>,
    quantity: Quantity,
    place: Box4,
    size: [usize; 2],
}

impl Map<'_, '_> {
    fn draw(
        &self,
        heading: &str,
        cells: &[Option<Option<&Assessment>>],
    ) -> Result<(), PictureError> {
        let value = |cell: &Option<Option<&Assessment>>| {
            cell.flatten()
                .and_then(|a| self.quantity.of(a))
                .map(|e| e.value)
        };
        let finite = cells.iter().filter_map(value).filter(|v| v.is_finite());
        let most = finite.fold(f64::MIN_POSITIVE, f64::max);
        let (unit, name) = match (self.quantity, self.quantity.unit()) {
            (Quantity::Captured, _) => (0.01, "%".to_owned()),
            (_, "J") => {
                let (unit, prefix, _) = prefix_and_decimals(most, 3);
                (unit, format!("{prefix}J"))
            }
            _ => (1.0, String::new()),
        };
        let [left, top, ..] = self.place;
        let heading = if name.is_empty() {
            heading.to_owned()
        } else {
            format!("{heading} ({name})")
        };
        let bold = Text::new(LABEL).bold();
        bold.write(
            self.root,
            &heading,
            (left, top - 8.0),
            (HPos::Left, VPos::Bottom),
        )?;
        for (index, cell) in cells.iter().enumerate() {
            let place = self.cell(index % self.size[0], index / self.size[0]);
            match (cell, value(cell)) {
                (None, _) => {}
                (Some(None), _) => self.impossible(place)?,
                (Some(Some(_)), None) => self.plain(place, GRID, "-")?,
                (Some(Some(_)), Some(value)) if value.is_infinite() => {
                    self.plain(place, RGBColor(90, 90, 90), "\u{221e}")?;
                }
                (Some(Some(_)), Some(value)) => {
                    let [r, g, b] = colour(-0.95 * (value / most).clamp(0.0, 1.0));
                    let text = three_digits(value / unit);
                    self.plain(place, RGBColor(r, g, b), &text)?;
                }
            }
        }
        outline(self.root, self.place, INK)
    }

    fn cell(&self, i: usize, j: usize) -> Box4 {
        let [left, top, right, bottom] = self.place;
        let (width, height) = self.cell_size();
        let (x, y) = (left + width * i as f64, bottom - height * j as f64);
        [x, (y - height).max(top), (x + width).min(right), y]
    }

    fn cell_size(&self) -> (f64, f64) {
        let [left, top, right, bottom] = self.place;
        (
            (right - left) / self.size[0] as f64,
            (bottom - top) / self.size[1] as f64,
        )
    }

    /// A cell with its number, where there is room.
    fn plain(&self, place: Box4, fill: RGBColor, text: &str) -> Result<(), PictureError> {
        let [left, top, right, bottom] = place;
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        polygon(self.root, &corners, fill, None)?;
        let (width, height) = self.cell_size();
        if width < ROOM.0 || height < ROOM.1 {
            return Ok(());
        }
        let RGBColor(r, g, b) = fill;
        let brightness = 0.3 * f64::from(r) + 0.59 * f64::from(g) + 0.11 * f64::from(b);
        let ink = if brightness > 130.0 {
            INK
        } else {
            RGBColor(255, 255, 255)
        };
        let middle = ((left + right) / 2.0, (top + bottom) / 2.0);
        let font = Text::new(SMALL).colour(ink);
        font.write(self.root, text, middle, (HPos::Center, VPos::Center))
    }

    fn impossible(&self, [left, top, right, bottom]: Box4) -> Result<(), PictureError> {
        let (x, y) = ((left + right) / 2.0, (top + bottom) / 2.0);
        let r = (0.3 * (right - left).min(bottom - top)).min(7.0);
        polyline(self.root, &[(x - r, y - r), (x + r, y + r)], SOFT, 1.6)?;
        polyline(self.root, &[(x - r, y + r), (x + r, y - r)], SOFT, 1.6)
    }

    /// Values beside rows and below columns, as many as there is room for.
    fn axes(&self, x: &Variable, y: &Variable) -> Result<(), PictureError> {
        let [left, _, right, bottom] = self.place;
        let (width, height) = self.cell_size();
        let font = Text::new(SMALL);
        let (factor, name) = x.shown();
        let every = (44.0 / width).ceil().max(1.0) as usize;
        for (i, value) in x.values.iter().enumerate().step_by(every) {
            let at = (left + width * (i as f64 + 0.5), bottom + 6.0);
            font.write(
                self.root,
                &three_digits(factor * value),
                at,
                (HPos::Center, VPos::Top),
            )?;
        }
        let at = ((left + right) / 2.0, bottom + 30.0);
        Text::new(LABEL).write(self.root, &name, at, (HPos::Center, VPos::Top))?;
        let (factor, name) = y.shown();
        let every = (20.0 / height).ceil().max(1.0) as usize;
        for (j, value) in y.values.iter().enumerate().step_by(every) {
            let at = (left - 7.0, bottom - height * (j as f64 + 0.5));
            font.write(
                self.root,
                &three_digits(factor * value),
                at,
                (HPos::Right, VPos::Center),
            )?;
        }
        let [_, top, ..] = self.place;
        let at = (left - MARGIN[3] + 12.0, top - 26.0);
        Text::new(LABEL).write(self.root, &name, at, (HPos::Left, VPos::Bottom))
    }
}

/// A number to three significant digits.
fn three_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    minus(&format!("{}", rounded + 0.0))
}
