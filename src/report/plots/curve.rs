//! One figure of one series on a panel, and the signs beside curves.

use plotters::prelude::{Color, RGBColor};
use plotters::style::text_anchor::{HPos, VPos};

use super::curve_data::Series;
use super::marks::{Pixel, polygon, polyline};
use super::picture::{Area, PictureError};
use super::ranking::disc;
use super::style::{Chart, LABEL, Text, pixel};
use jobs::comparison::{Estimate, Quantity};

/// How values stand along a panel's axis.
#[derive(Clone, Copy)]
pub enum Scale {
    /// In multiples of a unit.
    Linear { unit: f64 },
    /// By their decimal logarithms in that unit, from this one on.
    Decades { unit: f64, low: f64 },
}

impl Scale {
    /// Where a value stands; one that has no place, at the lower end.
    pub fn at(self, value: f64) -> f64 {
        match self {
            Self::Linear { unit } => value / unit,
            Self::Decades { unit, low } => libm::log10(value / unit).max(low),
        }
    }
}

/// A series' figure on a panel.
pub struct Curve<'a, 'b, 'c> {
    pub root: &'a Area<'b>,
    pub chart: &'a Chart<'c, 'b>,
    pub scale: Scale,
    /// Upper end of the plot (pixels).
    pub top: f64,
    pub colour: RGBColor,
    pub width: f64,
}

impl Curve<'_, '_, '_> {
    fn at(&self, x: f64, y: f64) -> Pixel {
        pixel(self.chart, x, self.scale.at(y))
    }

    /// Whether there was anything to draw.
    pub fn draw(&self, series: &Series, quantity: &Quantity) -> Result<bool, PictureError> {
        let known: Vec<(f64, Option<Estimate>)> = series
            .points
            .iter()
            .map(|point| (point.x, point.result.and_then(|a| quantity.of(a))))
            .collect();
        let finite = |(_, estimate): &(f64, Option<Estimate>)| {
            estimate.is_some_and(|estimate| estimate.value.is_finite())
        };
        for piece in known.split(|point| !finite(point)) {
            let placed = piece.iter().filter_map(|(x, estimate)| {
                let estimate = (*estimate)?;
                let ends = estimate.low.zip(estimate.high);
                Some(Placed {
                    at: self.at(*x, estimate.value),
                    ends: ends.map(|(low, high)| [self.at(*x, low), self.at(*x, high)]),
                })
            });
            let placed: Vec<Placed> = placed.collect();
            self::piece(self.root, &placed, self.colour, self.width)?;
        }
        for (x, _) in known
            .iter()
            .filter(|(_, e)| e.is_some_and(|e| e.value.is_infinite()))
        {
            let x = self.at(*x, 0.0).0;
            let arrow = [
                (x - 5.0, self.top + 10.0),
                (x, self.top + 2.0),
                (x + 5.0, self.top + 10.0),
            ];
            polyline(self.root, &arrow, self.colour, 2.0)?;
        }
        Ok(known.iter().any(|(_, estimate)| estimate.is_some()))
    }
}

/// A point of a curve with the ends between which it lies (pixels).
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// The point.
    pub at: Pixel,
    /// Its ends.
    pub ends: Option<[Pixel; 2]>,
}

/// A curve without a break, with its band.
pub fn piece(
    root: &Area,
    piece: &[Placed],
    colour: RGBColor,
    width: f64,
) -> Result<(), PictureError> {
    for bounded in piece.split(|placed| placed.ends.is_none()) {
        let ends: Vec<[Pixel; 2]> = bounded.iter().filter_map(|placed| placed.ends).collect();
        match ends[..] {
            [] => {}
            [ends] => polyline(root, &ends, colour.mix(0.5), 4.0)?,
            _ => {
                let low = ends.iter().map(|ends| ends[0]);
                let high = ends.iter().rev().map(|ends| ends[1]);
                let band: Vec<Pixel> = low.chain(high).collect();
                polygon(root, &band, colour.mix(0.25), None)?;
            }
        }
    }
    let line: Vec<Pixel> = piece.iter().map(|placed| placed.at).collect();
    polyline(root, &line, colour, width)?;
    line.iter().try_for_each(|p| disc(root, *p, colour))
}

/// Later curves are thinner, so that an earlier one can be seen beneath.
pub fn width(number: usize, count: usize) -> f64 {
    1.6 + 2.4 * (count - 1 - number) as f64 / count as f64
}

/// Writes what a panel shows; `at` is the lower left corner (pixels).
pub fn caption(root: &Area, text: &str, at: Pixel) -> Result<(), PictureError> {
    let font = Text::new(LABEL).bold();
    font.write(root, text, at, (HPos::Left, VPos::Bottom))
}

/// A ring, for what is none.
pub fn ring(root: &Area, (x, y): Pixel, colour: RGBColor) -> Result<(), PictureError> {
    let around = (0..=20).map(|k| {
        let (sin, cos) = libm::sincos(f64::from(k) * std::f64::consts::TAU / 20.0);
        (x + 4.2 * cos, y + 4.2 * sin)
    });
    polyline(root, &around.collect::<Vec<_>>(), colour, 1.8)
}

/// A cross of half the width `r` (pixels).
pub fn cross(root: &Area, (x, y): Pixel, r: f64, colour: RGBColor) -> Result<(), PictureError> {
    polyline(root, &[(x - r, y - r), (x + r, y + r)], colour, 1.6)?;
    polyline(root, &[(x - r, y + r), (x + r, y - r)], colour, 1.6)
}
