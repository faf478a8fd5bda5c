//! What the heat maps share: grids as images, the colour bar, keys.

use plotters::prelude::RGBColor;
use plotters::style::text_anchor::{HPos, VPos};

use super::marks::{Box4, Mark, Pixel, marker, outline, polygon, polyline, seamed_line};
use super::picture::{Area, Bitmap, PictureError, Underlay};
use super::scale::{COLOURS, EnergyScale, HATCH, colour};
use super::style::{BLUE, Chart, INK, LABEL, SMALL, Text, VERMILLION, pixel, units};
use crate::landscape::map::{Grid, Sample};

/// The positions on a scale that colours are given to, and two colours for the hatching of what
/// is blocked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub low: f64,
    pub high: f64,
}

impl Range {
    /// The positions of these energies, with zero and a little on either side of it.
    pub fn of(scale: &EnergyScale, energies: impl Iterator<Item = f64>) -> Self {
        let margin = 0.15;
        energies.map(|u| scale.position(u)).fold(
            Self {
                low: -margin,
                high: margin,
            },
            |range, p| Self {
                low: range.low.min(p),
                high: range.high.max(p),
            },
        )
    }

    /// An image of `width` by `height` pixels, first row at the top: `position` tells the position
    /// at the fraction (0 to 1, from the left and from the bottom), `None` where blocked.
    pub fn bitmap(
        &self,
        (width, height): (usize, usize),
        position: impl Fn(f64, f64) -> Option<f64>,
    ) -> Bitmap {
        let last = (COLOURS - 1) as f64;
        let span = self.high - self.low;
        let mut palette: Vec<_> = (0..COLOURS)
            .map(|i| colour(self.low + span * i as f64 / last))
            .collect();
        palette.extend(HATCH);
        let pixels = (0..width * height)
            .map(|index| {
                let (column, row) = (index % width, index / width);
                let u = (column as f64 + 0.5) / width as f64;
                let v = 1.0 - (row as f64 + 0.5) / height as f64;
                match position(u, v) {
                    Some(p) => ((p - self.low) / span * last).round().clamp(0.0, last) as u8,
                    None => (COLOURS + usize::from((column + row) % 9 < 2)) as u8,
                }
            })
            .collect();
        Bitmap {
            width,
            palette,
            pixels,
        }
    }
}

/// A grid's energies as positions on a scale, linear between grid points.
pub struct Interpolated {
    columns: usize,
    rows: usize,
    positions: Vec<Option<f64>>,
}

impl Interpolated {
    pub fn new(grid: &Grid<Sample>, scale: &EnergyScale) -> Self {
        Self {
            columns: grid.x.len(),
            rows: grid.y.len(),
            positions: grid
                .values
                .iter()
                .map(|v| v.map(|sample| scale.position(sample.energy)))
                .collect(),
        }
    }

    /// The four grid points about a place (fractions of the width and the height) with their
    /// weights.
    pub fn corners(&self, u: f64, v: f64) -> [(usize, f64); 4] {
        let cell = |f: f64, count: usize| {
            let at = f.clamp(0.0, 1.0) * (count - 1) as f64;
            let low = (at.floor() as usize).min(count - 2);
            (low, at - low as f64)
        };
        let (i, s) = cell(u, self.columns);
        let (j, t) = cell(v, self.rows);
        let index = |i: usize, j: usize| j * self.columns + i;
        [
            (index(i, j), (1.0 - s) * (1.0 - t)),
            (index(i + 1, j), s * (1.0 - t)),
            (index(i, j + 1), (1.0 - s) * t),
            (index(i + 1, j + 1), s * t),
        ]
    }

    /// The mean over the free grid points about a place, and their share of the weight.
    pub fn position(&self, u: f64, v: f64) -> Option<(f64, f64)> {
        let (mut sum, mut weight) = (0.0, 0.0);
        for (index, w) in self.corners(u, v) {
            if let Some(position) = self.positions[index] {
                sum += w * position;
                weight += w;
            }
        }
        (weight > 0.0).then(|| (sum / weight, weight))
    }
}

/// Left, top, right, bottom (pixels) of a plot of values over `x` and `y`.
pub fn frame(chart: &Chart, x: &[f64], y: &[f64]) -> Box4 {
    let low = pixel(chart, x[0], y[0]);
    let high = pixel(chart, x[x.len() - 1], y[y.len() - 1]);
    [low.0, high.1, high.0, low.1]
}

/// The colours with their energies, in a bar from left to right.
pub fn colour_bar(
    root: &Area,
    underlays: &mut Vec<Underlay>,
    scale: &EnergyScale,
    range: &Range,
    [left, top, right, bottom]: Box4,
) -> Result<(), PictureError> {
    let span = range.high - range.low;
    underlays.push(Underlay {
        bitmap: range.bitmap((COLOURS, 2), |u, _| Some(range.low + span * u)),
        rectangle: [left, top, right, bottom].map(units),
    });
    outline(root, [left, top, right, bottom], INK)?;
    let middle = (left - 14.0, (top + bottom) / 2.0);
    Text::new(LABEL).write(root, "U", middle, (HPos::Right, VPos::Center))?;
    for energy in scale.ticks(range.low, range.high) {
        let x = left + (right - left) * (scale.position(energy) - range.low) / span;
        let (start, width, text, font) = if energy == 0.0 {
            (top, 1.6, "0".into(), Text::new(SMALL).bold())
        } else {
            let text = scale.label(energy, 1);
            (bottom, 1.0, text, Text::new(SMALL))
        };
        polyline(root, &[(x, start), (x, bottom + 6.0)], INK, width)?;
        font.write(root, &text, (x, bottom + 9.0), (HPos::Center, VPos::Top))?;
    }
    Ok(())
}

/// An entry of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Key {
    Mark(Mark),
    Pathway,
    Blocked,
    Colour(RGBColor),
}

pub const STATE_KEYS: [(Key, &str); 2] = [
    (Key::Mark(Mark::Bond), "bond"),
    (Key::Mark(Mark::Trap), "trap"),
];
pub const POLE_KEYS: [(Key, &str); 2] = [
    (Key::Colour(VERMILLION), "north pole"),
    (Key::Colour(BLUE), "south pole"),
];

/// Height of an entry of a key (pixels).
const ENTRY: f64 = 25.0;

/// Explains marks, one below the other.
pub fn keys(
    root: &Area,
    underlays: &mut Vec<Underlay>,
    (left, top): Pixel,
    entries: &[(Key, &str)],
) -> Result<(), PictureError> {
    let mut y = top;
    for (key, text) in entries {
        let (a, b) = (left, left + 22.0);
        match key {
            Key::Mark(mark) => marker(root, *mark, (left + 11.0, y), 7.0)?,
            Key::Pathway => seamed_line(root, &[(a, y), (b, y)], INK, 1.8)?,
            Key::Blocked => {
                let place = [a, y - 8.0, b, y + 8.0];
                let range = Range {
                    low: -1.0,
                    high: 1.0,
                };
                underlays.push(Underlay {
                    bitmap: range.bitmap((16, 12), |_, _| None),
                    rectangle: place.map(units),
                });
                outline(root, place, INK)?;
            }
            Key::Colour(colour) => {
                let block = [(5.0, -6.0), (17.0, -6.0), (17.0, 6.0), (5.0, 6.0)]
                    .map(|(dx, dy)| (left + dx, y + dy));
                polygon(root, &block, colour, None)?;
            }
        }
        Text::new(SMALL).write(root, text, (left + 32.0, y), (HPos::Left, VPos::Center))?;
        y += ENTRY;
    }
    Ok(())
}
