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
            let piece: Vec<(f64, Estimate)> = piece
                .iter()
                .filter_map(|(x, e)| Some((*x, (*e)?)))
                .collect();
            self.piece(&piece)?;
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

    /// A curve without a break, with its band.
    fn piece(&self, piece: &[(f64, Estimate)]) -> Result<(), PictureError> {
        for bounded in piece.split(|(_, e)| e.low.is_none() || e.high.is_none()) {
            let edge = |of: fn(&Estimate) -> Option<f64>| -> Vec<Pixel> {
                let edge = bounded.iter();
                edge.map(|(x, e)| self.at(*x, of(e).unwrap_or(e.value)))
                    .collect()
            };
            let mut band = edge(|e| e.low);
            band.extend(edge(|e| e.high).into_iter().rev());
            if bounded.len() > 1 {
                polygon(self.root, &band, self.colour.mix(0.25), None)?;
            } else if let [low, high] = band[..] {
                polyline(self.root, &[low, high], self.colour.mix(0.5), 4.0)?;
            }
        }
        let line: Vec<Pixel> = piece.iter().map(|(x, e)| self.at(*x, e.value)).collect();
        polyline(self.root, &line, self.colour, self.width)?;
        line.iter()
            .try_for_each(|p| disc(self.root, *p, self.colour))
    }
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
