//! What the heat maps share: grids as images, the colour bar, keys.

use ordered_float::OrderedFloat;
use plotters::style::text_anchor::{HPos, VPos};

use super::composition::{Panel, stacked};
use super::key::{BAR_SIDES, Key, key_table};
use super::marks::{Box4, outline, polyline};
use super::picture::{Area, Bitmap, PictureError, Underlay};
use super::scale::{COLOURS, EnergyScale, HATCH, colour};
use super::style::{Chart, INK, SMALL, Text, pixel, units};
use physics::landscape::grid::{Grid, Sample};
use physics::order::Order;

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

/// Height of the bar with its name and its numbers (pixels).
const BAR: f64 = 84.0;

/// The colours with their energies, in a bar from left to right, and what marks mean.
pub fn legend<'a>(
    scale: &'a EnergyScale,
    range: Range,
    entries: Vec<(Key, &'static str)>,
) -> Panel<'a> {
    let bar = Panel::new(
        "",
        0.0,
        |_| BAR,
        move |root, underlays, place| {
            let [left, top, right, _] = place;
            let bar = [
                left + BAR_SIDES.0,
                top + 26.0,
                right - BAR_SIDES.1,
                top + 46.0,
            ];
            colour_bar(root, underlays, scale, &range, bar)
        },
    );
    stacked(bar, key_table(entries))
}

fn colour_bar(
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
    let above = (left, top - 6.0);
    Text::new(SMALL).write(root, &scale.axis(), above, (HPos::Left, VPos::Bottom))?;
    let place = |energy: f64| left + (right - left) * (scale.position(energy) - range.low) / span;
    let mut taken: Vec<(f64, f64)> = Vec::new();
    let mut ticks = scale.ticks(range.low, range.high);
    // Zero first, then outwards: where numbers would collide the later ones are left out.
    ticks.order_by_key(|energy| OrderedFloat(energy.abs()));
    for energy in ticks {
        let x = place(energy);
        let (start, width, text, font) = if energy == 0.0 {
            (top, 1.6, "0".into(), Text::new(SMALL).bold())
        } else {
            let text = scale.tick(energy);
            (bottom, 1.0, text, Text::new(SMALL))
        };
        polyline(root, &[(x, start), (x, bottom + 6.0)], INK, width)?;
        let half = 0.54 * font.width(&text) + 4.0;
        if taken
            .iter()
            .all(|(from, to)| x + half < *from || *to < x - half)
        {
            taken.push((x - half, x + half));
            font.write(root, &text, (x, bottom + 9.0), (HPos::Center, VPos::Top))?;
        }
    }
    Ok(())
}
