//! Colour maps: images of grids, and their colour bars.

use super::axes::Plot;
use super::canvas::{Bitmap, Box4, Canvas, middle};
use super::composition::Panel;
use super::scale::{EnergyScale, colour};
use super::style::{Anchor, INK, SMALL};
use ordered_float::OrderedFloat;
use physics::landscape::grid::{Grid, Sample};
use physics::order::Order;
use plotters::style::{RGBColor, WHITE};

/// Steps of colour.
const COLOURS: usize = 250;
/// Colours of the hatching of blocked regions, and of missing values.
pub const HATCH: [[u8; 3]; 2] = [[226, 226, 226], [198, 198, 198]];
const BLANK: [[u8; 3]; 2] = [[255; 3]; 2];
/// Space left and right of a colour bar, and its height with name and numbers (pixels).
const SIDES: [f64; 2] = [84.0, 24.0];
const BAR: f64 = 84.0;
/// Pixels of an image of cells, enough for sharp edges of cells.
const SHARP: usize = 500;

/// An image of a number of pixels, with the first row at the top, coloured by shares from 0 to 1.
/// `share` returns the share at a position (0 to 1, from the left and from the bottom); `others`
/// are the colours, in stripes, for positions without one.
pub fn shaded(
    [width, height]: [usize; 2],
    others: [[u8; 3]; 2],
    colour: impl Fn(f64) -> [u8; 3],
    share: impl Fn(f64, f64) -> Option<f64>,
) -> Bitmap {
    let last = (COLOURS - 1) as f64;
    let mut palette: Vec<_> = (0..COLOURS).map(|k| colour(k as f64 / last)).collect();
    palette.extend(others);
    let pixel = |index: usize| {
        let (column, row) = (index % width, index / width);
        let u = (column as f64 + 0.5) / width as f64;
        let v = 1.0 - (row as f64 + 0.5) / height as f64;
        match share(u, v) {
            Some(share) => (share * last).round().clamp(0.0, last) as u8,
            None => (COLOURS + usize::from((column + row) % 9 < 2)) as u8,
        }
    };
    Bitmap {
        width,
        palette,
        pixels: (0..width * height).map(pixel).collect(),
    }
}

/// Fills a plot with cells coloured by their shares; rows and columns count from the lower left.
pub fn cells(
    canvas: &mut Canvas,
    plot: &Plot,
    [columns, rows]: [usize; 2],
    colour: impl Fn(f64) -> [u8; 3],
    share: impl Fn(usize, usize) -> Option<f64>,
) {
    let size = [columns, rows].map(|count| count * (SHARP / columns.max(rows)).max(8));
    let image = shaded(size, BLANK, colour, |u, v| {
        share((u * columns as f64) as usize, (v * rows as f64) as usize)
    });
    canvas.image(image, plot.frame);
    canvas.frame(plot.frame, INK);
}

/// A coloured cell of a table with its text, if there is room.
pub fn cell(canvas: &mut Canvas, place: Box4, fill: [u8; 3], text: &str) {
    let [left, top, right, bottom] = place;
    let [r, g, b] = fill;
    canvas.block(place, RGBColor(r, g, b));
    if right - left >= SMALL.width(text) + 2.0 && bottom - top >= 17.0 {
        let bright = 0.3 * f64::from(r) + 0.59 * f64::from(g) + 0.11 * f64::from(b);
        let ink = if bright > 130.0 { INK } else { WHITE };
        canvas.write(SMALL.colour(ink), text, middle(place), Anchor::Middle);
    }
}

/// The range of positions on a scale of energies that the colours cover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    low: f64,
    high: f64,
}

impl Range {
    /// The range of these energies, including zero and a little on both sides of it.
    pub fn of(scale: &EnergyScale, energies: impl Iterator<Item = f64>) -> Self {
        let (low, high) = (-0.15, 0.15);
        energies
            .map(|energy| scale.position(energy))
            .fold(Self { low, high }, |range, p| Self {
                low: range.low.min(p),
                high: range.high.max(p),
            })
    }

    fn share(&self, position: f64) -> f64 {
        (position - self.low) / (self.high - self.low)
    }

    fn colour(&self, share: f64) -> [u8; 3] {
        colour(self.low + (self.high - self.low) * share)
    }

    /// Fills a plot with an image of positions, `None` if blocked.
    pub fn fill(
        &self,
        canvas: &mut Canvas,
        plot: &Plot,
        size: [usize; 2],
        position: impl Fn(f64, f64) -> Option<f64>,
    ) {
        let share = |u, v| Some(self.share(position(u, v)?));
        canvas.image(
            shaded(size, HATCH, |share| self.colour(share), share),
            plot.frame,
        );
        canvas.frame(plot.frame, INK);
    }

    /// The colour bar with its energies.
    pub fn bar<'a>(self, scale: &EnergyScale) -> Panel<'a> {
        let mut marks = scale.ticks(self.low, self.high);
        // Zero first, then outwards.
        marks.order_by_key(|energy| OrderedFloat(energy.abs()));
        let marks = marks.into_iter().map(|energy| Marked {
            at: self.share(scale.position(energy)),
            text: match energy {
                0.0 => "0".to_owned(),
                _ => scale.tick(energy),
            },
            is_crossed: energy == 0.0,
        });
        bar(scale.axis(), move |share| self.colour(share), marks)
    }
}

/// A mark of a colour bar.
pub struct Marked {
    /// Its position, from 0 to 1.
    pub at: f64,
    pub text: String,
    /// Whether a line crosses the colours there.
    pub is_crossed: bool,
}

/// A colour bar from left to right with its marks; texts that would overlap earlier ones are
/// omitted.
pub fn bar<'a>(
    name: impl Into<String>,
    colour: impl Fn(f64) -> [u8; 3] + Send + Sync + 'a,
    marks: impl IntoIterator<Item = Marked>,
) -> Panel<'a> {
    let (name, marks): (String, Vec<Marked>) = (name.into(), marks.into_iter().collect());
    Panel::alone(
        |_| BAR,
        move |canvas, [left, top, right, _]| {
            let [left, right] = [left + SIDES[0], right - SIDES[1]];
            let [top, bottom] = [top + 26.0, top + 46.0];
            let place = [left, top, right, bottom];
            canvas.image(shaded([COLOURS, 2], HATCH, &colour, |u, _| Some(u)), place);
            canvas.frame(place, INK);
            let font = SMALL.within(right - left, &name);
            canvas.write(font, &name, (left, top - 6.0), Anchor::BottomLeft);
            let mut taken: Vec<[f64; 2]> = Vec::new();
            for mark in &marks {
                let x = left + (right - left) * mark.at;
                let (start, width) = if mark.is_crossed {
                    (top, 1.6)
                } else {
                    (bottom, 1.0)
                };
                canvas.line(&[(x, start), (x, bottom + 6.0)], INK, width);
                let half = 0.5 * SMALL.room(&mark.text) + 4.0;
                if taken
                    .iter()
                    .all(|[from, to]| x + half < *from || *to < x - half)
                {
                    taken.push([x - half, x + half]);
                    canvas.note(&mark.text, (x, bottom + 9.0), Anchor::Top);
                }
            }
        },
    )
}

/// A grid's energies as positions on a scale, linear between grid points.
pub struct Interpolated {
    columns: usize,
    rows: usize,
    positions: Vec<Option<f64>>,
}

impl Interpolated {
    pub fn new(grid: &Grid<Sample>, scale: &EnergyScale) -> Self {
        let position = |sample: &Option<Sample>| sample.map(|it| scale.position(it.energy));
        Self {
            columns: grid.x.len(),
            rows: grid.y.len(),
            positions: grid.values.iter().map(position).collect(),
        }
    }

    /// The four grid points around a position (fractions of the width and the height) with their
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

    /// The mean over the free grid points around a position, and their share of the weight.
    pub fn position(&self, u: f64, v: f64) -> Option<(f64, f64)> {
        let known = self.corners(u, v).into_iter();
        let known = known.filter_map(|(index, weight)| Some((self.positions[index]?, weight)));
        let (sum, weight) = known.fold((0.0, 0.0), |(sum, weight), (position, w)| {
            (sum + w * position, weight + w)
        });
        (weight > 0.0).then(|| (sum / weight, weight))
    }
}
