//! The figures of a sweep as maps over two varied numbers.

use plotters::prelude::RGBColor;
use plotters::style::text_anchor::{HPos, VPos};

use super::composition::{Composition, Panel, remark};
use super::curve::{caption, cross};
use super::curve_data::{Map, Variable};
use super::curves::numbers;
use super::marks::{Box4, outline};
use super::picture::{Area, PictureError};
use super::ranking::block;
use super::scale::{colour, minus};
use super::style::{GRID, INK, LABEL, SMALL, SOFT, Text};
use super::{Figure, Sheet};
use crate::csv::{number, table};
use crate::figures::Shown;
use jobs::comparison::quantity::{NO_TRAPS, placed};
use jobs::comparison::{Assessment, Quantity};

const WIDTH: f64 = 1200.0;
const HEIGHT: f64 = 380.0;
/// The least width (pixels) of a panel beside another.
const LEAST: f64 = 360.0;
/// Space around a panel's plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [52.0, 18.0, 62.0, 76.0];
/// Cells narrower or lower than this (pixels) hold no number.
const ROOM: (f64, f64) = (38.0, 17.0);

/// A panel a figure, a cell a point; the cells of `results` row by row from the lowest.
///
/// # Errors
/// See [`PictureError`].
pub fn draw(
    name: &str,
    map: &Map,
    results: &[Option<Option<&Assessment>>],
    sheet: &Sheet,
) -> Result<Figure, PictureError> {
    let panels = placed(|quantity| quantity.panel.filter(|_| quantity.mapped)).into_iter();
    let panels = panels.map(|(shown, quantities)| {
        let quantity = quantities[0];
        Panel::new(
            quantity.key,
            LEAST,
            |_| HEIGHT,
            move |root, _, place| {
                let [left, top, right, bottom] = place;
                let panel = MapPanel {
                    root,
                    quantity,
                    place: [
                        left + MARGIN[3],
                        top + MARGIN[0],
                        right - MARGIN[1],
                        bottom - MARGIN[2],
                    ],
                    size: [map.x.values.len(), map.y.values.len()],
                };
                panel.draw(shown.heading, results)?;
                panel.axes(&map.x, &map.y)
            },
        )
    });
    let composition = Composition {
        name: name.to_owned(),
        title: map.title.clone(),
        note: None,
        width: WIDTH,
        panels: panels.collect(),
        key: Some(remark(SIGNS.to_owned())),
    };
    Figure::new(&composition, sheet, data(map, results))
}

/// What the marks mean.
const SIGNS: &str = "\u{25cb} no trap; \u{2013} not known; \u{221e} caged, proved; \u{d7} impossible \
    design";

/// Each figure of each cell.
fn data(map: &Map, results: &[Option<Option<&Assessment>>]) -> String {
    let names = [&map.x, &map.y].map(|variable| variable.shown().1);
    let head = [&names[0], &names[1], "figure", "value", "low", "high"];
    let rows = results.iter().enumerate().flat_map(|(k, result)| {
        let at = [&map.x, &map.y]
            .map(Variable::shown)
            .map(|(factor, _)| factor);
        let [x, y] = [
            at[0] * map.x.values[k % map.x.values.len()],
            at[1] * map.y.values[k / map.x.values.len()],
        ];
        numbers((*result).flatten(), [x, y].map(number))
    });
    table(head, rows)
}

struct MapPanel<'a, 'b> {
    root: &'a Area<'b>,
    quantity: &'static Quantity,
    place: Box4,
    size: [usize; 2],
}

impl MapPanel<'_, '_> {
    fn draw(
        &self,
        heading: &str,
        cells: &[Option<Option<&Assessment>>],
    ) -> Result<(), PictureError> {
        let value = |cell: &Option<_>| Some(self.quantity.of((*cell)??)?.value);
        let finite = cells.iter().filter_map(value).filter(|v| v.is_finite());
        let most = finite.fold(f64::MIN_POSITIVE, f64::max);
        let shown = Shown::new(self.quantity.measure, most);
        let [left, top, ..] = self.place;
        caption(self.root, &shown.named(heading), (left, top - 8.0))?;
        for (index, cell) in cells.iter().enumerate() {
            let place = self.cell(index % self.size[0], index / self.size[0]);
            match (cell, value(cell)) {
                (None, _) => {}
                (Some(None), _) => self.impossible(place)?,
                (Some(Some(design)), None) => {
                    let without = (self.quantity.read)(design).err() == Some(NO_TRAPS);
                    let sign = if without { "\u{25cb}" } else { "\u{2013}" };
                    self.plain(place, GRID, sign)?;
                }
                (Some(Some(_)), Some(value)) if value.is_infinite() => {
                    self.plain(place, RGBColor(90, 90, 90), "\u{221e}")?;
                }
                (Some(Some(_)), Some(value)) => {
                    let [r, g, b] = colour(-0.95 * (value / most).clamp(0.0, 1.0));
                    let text = three_digits(value / shown.unit);
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
        block(self.root, place, fill)?;
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
        let [left, top, right, bottom] = place;
        let middle = ((left + right) / 2.0, (top + bottom) / 2.0);
        let font = Text::new(SMALL).colour(ink);
        font.write(self.root, text, middle, (HPos::Center, VPos::Center))
    }

    fn impossible(&self, [left, top, right, bottom]: Box4) -> Result<(), PictureError> {
        let (x, y) = ((left + right) / 2.0, (top + bottom) / 2.0);
        let r = (0.3 * (right - left).min(bottom - top)).min(7.0);
        cross(self.root, (x, y), r, SOFT)
    }

    /// Values beside rows and below columns, as many as there is room for.
    fn axes(&self, x: &Variable, y: &Variable) -> Result<(), PictureError> {
        let [left, _, right, bottom] = self.place;
        let (width, height) = self.cell_size();
        let write = |number: f64, at, anchor| {
            Text::new(SMALL).write(self.root, &three_digits(number), at, anchor)
        };
        let (factor, name) = x.shown();
        let every = (44.0 / width).ceil().max(1.0) as usize;
        for (i, value) in x.values.iter().enumerate().step_by(every) {
            let at = (left + width * (i as f64 + 0.5), bottom + 6.0);
            write(factor * value, at, (HPos::Center, VPos::Top))?;
        }
        let at = ((left + right) / 2.0, bottom + 30.0);
        Text::new(LABEL).write(self.root, &name, at, (HPos::Center, VPos::Top))?;
        let (factor, name) = y.shown();
        let every = (20.0 / height).ceil().max(1.0) as usize;
        for (j, value) in y.values.iter().enumerate().step_by(every) {
            let at = (left - 7.0, bottom - height * (j as f64 + 0.5));
            write(factor * value, at, (HPos::Right, VPos::Center))?;
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
