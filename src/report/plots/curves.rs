//! The figures of a sweep as curves over one varied number, bounds as bands around them.

use plotters::prelude::{Color, RGBColor};
use plotters::style::text_anchor::{HPos, VPos};

use super::curve_data::{Group, Series, Variable};
use super::marks::{Pixel, polygon, polyline};
use super::picture::{Area, Picture, PictureError};
use super::ranking::disc;
use super::style::{
    Axis, BLUE, Chart, GREEN, INK, LABEL, SMALL, SOFT, Text, VERMILLION, chart, pixel, title, units,
};
use crate::comparison::quantity::{Measure, placed};
use crate::comparison::{Estimate, Quantity};
use crate::report::figures::Shown;

const WIDTH: f64 = 1200.0;
/// The title and the key of the series (pixels).
const HEAD: f64 = 84.0;
const PANEL_HEIGHT: f64 = 262.0;
const COLUMNS: usize = 3;
/// Space around a panel's plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [34.0, 20.0, 58.0, 78.0];

/// Okabe and Ito's colours, told apart by colour-blind readers.
const COLOURS: [RGBColor; 7] = [
    BLUE,
    VERMILLION,
    GREEN,
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    INK,
];
/// Most series in a picture: one a colour.
pub const MOST_SERIES: usize = COLOURS.len();

/// What a panel shows: figures of the same kind, as one curve or, to either side of zero, two.
struct CurvePanel<'a> {
    heading: &'static str,
    quantities: Vec<&'static Quantity>,
    group: &'a Group<'a>,
}

/// A panel a figure, a curve a series.
///
/// # Errors
/// See [`PictureError`].
pub fn draw(group: &Group, variable: &Variable) -> Result<Picture, PictureError> {
    let panels = placed(|quantity| quantity.panel);
    let rows = panels.len().div_ceil(COLUMNS);
    let height = HEAD + PANEL_HEIGHT * rows as f64 + 8.0;
    Picture::draw((WIDTH as u32, height as u32), |root, _| {
        title(root, &group.title)?;
        key(root, group)?;
        let (_, body) = root.split_vertically(units(HEAD));
        let (body, _) = body.split_vertically(units(PANEL_HEIGHT * rows as f64));
        let areas = body.split_evenly((rows, COLUMNS));
        for (area, (place, quantities)) in areas.iter().zip(panels) {
            let panel = CurvePanel {
                heading: place.heading,
                quantities,
                group,
            };
            panel.draw(area, root, variable)?;
        }
        Ok(())
    })
}

/// Which colour is which series, and what the marks mean.
fn key(root: &Area, group: &Group) -> Result<(), PictureError> {
    let y = HEAD - 24.0;
    let mut x = 22.0;
    let font = Text::new(LABEL);
    for (series, colour) in group.series.iter().zip(COLOURS) {
        if group.series.len() > 1 {
            polyline(root, &[(x, y), (x + 24.0, y)], colour, 2.4)?;
            let at = (x + 31.0, y);
            font.write(root, &series.name, at, (HPos::Left, VPos::Center))?;
            x += 31.0 + 1.08 * font.width(&series.name) + 22.0;
        }
    }
    let note = match group.left_out {
        0 => "bands: certified bounds, 95 % for shares; ^ no way, proved; x impossible".to_owned(),
        more => format!("{more} more series in sweep.csv"),
    };
    let at = (WIDTH - 20.0, 22.0);
    let font = Text::new(SMALL).colour(SOFT);
    font.write(root, &note, at, (HPos::Right, VPos::Top))
}

impl CurvePanel<'_> {
    fn draw<'a>(
        &self,
        area: &Area<'a>,
        root: &Area<'a>,
        variable: &Variable,
    ) -> Result<(), PictureError> {
        let (low, high) = self.range();
        let shown = Shown::new(self.measure(), low.abs().max(high.abs()));
        let (unit, name) = (shown.unit, shown.axis());
        let x = variable.axis();
        let (scale, y, [low, high]) = match self.decades() {
            Some(powers @ [low, high]) => {
                let y = Axis::decades(low..high, name);
                (
                    Scale::Decades(powers),
                    y,
                    powers.map(|power| 10f64.powf(power)),
                )
            }
            None => {
                let y = Axis::linear(low / unit..high / unit, 5, name);
                (Scale::Linear { unit }, y, [low, high])
            }
        };
        let chart = chart(area, MARGIN, &x, &y, true)?;
        let at = |x: f64, y: f64| pixel(&chart, x, scale.at(y));
        let (left, top) = at(x.range.start, high);
        let (right, bottom) = at(x.range.end, low);
        caption(root, self.heading, (left, top - 8.0))?;
        if low < 0.0 {
            let zero = at(0.0, 0.0).1;
            polyline(root, &[(left, zero), (right, zero)], INK, 1.2)?;
        }
        let mut any = false;
        for (number, (series, colour)) in self.group.series.iter().zip(COLOURS).enumerate() {
            for quantity in &self.quantities {
                let curve = Curve {
                    root,
                    chart: &chart,
                    scale,
                    top,
                    colour,
                    width: width(number, self.group.series.len()),
                };
                any |= curve.draw(series, quantity)?;
            }
            for point in &series.points {
                if point.result.is_none() {
                    let x = pixel(&chart, point.x, y.range.start).0;
                    let y = bottom - 7.0 - 9.0 * number as f64;
                    cross(root, (x, y), 3.5, colour)?;
                }
            }
        }
        if !any {
            let at = ((left + right) / 2.0, (top + bottom) / 2.0);
            let font = Text::new(SMALL).colour(SOFT);
            font.write(root, "none", at, (HPos::Center, VPos::Center))?;
        }
        Ok(())
    }

    fn measure(&self) -> Measure {
        self.quantities[0].measure
    }

    /// All that is drawn.
    fn estimates(&self) -> impl Iterator<Item = Estimate> {
        let points = self.group.series.iter().flat_map(|series| &series.points);
        let results = points.filter_map(|point| point.result);
        results.flat_map(|result| self.quantities.iter().filter_map(|q| q.of(result)))
    }

    /// From zero, or from below it, to a little above the highest value.
    fn range(&self) -> (f64, f64) {
        if self.measure() == Measure::Share {
            return (0.0, 1.0);
        }
        let values = self.estimates().flat_map(|e| e.finite()).flatten();
        let (low, high) = extent(values);
        let span = high - low;
        if span <= 0.0 {
            let energy = self.measure() == Measure::Energy;
            return (0.0, if energy { 2e-3 } else { 1.0 });
        }
        let below = if low < 0.0 { 0.08 * span } else { 0.0 };
        (low - below, high + 0.08 * span)
    }

    /// The range of a ratio that spans more than two powers of ten, as decimal logarithms.
    fn decades(&self) -> Option<[f64; 2]> {
        let powers = self.estimates().map(|e| e.value.log10());
        let (low, high) = extent(powers.filter(|power| power.is_finite()));
        let wide = self.measure() == Measure::Ratio && high - low > 2.0;
        wide.then_some([low - 0.1, high + 0.1])
    }
}

/// The least and the greatest of some numbers and zero.
fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((0.0, 0.0), |(low, high), value| {
        (f64::min(low, value), f64::max(high, value))
    })
}

/// How values stand along a panel's axis.
#[derive(Clone, Copy)]
enum Scale {
    /// In multiples of a unit.
    Linear { unit: f64 },
    /// By their decimal logarithms, in this range.
    Decades([f64; 2]),
}

impl Scale {
    /// Where a value stands; one that has no place, at the lower end.
    fn at(self, value: f64) -> f64 {
        match self {
            Self::Linear { unit } => value / unit,
            Self::Decades([low, _]) => value.log10().max(low),
        }
    }
}

/// A series' figure on a panel.
struct Curve<'a, 'b, 'c> {
    root: &'a Area<'b>,
    chart: &'a Chart<'c, 'b>,
    scale: Scale,
    top: f64,
    colour: RGBColor,
    width: f64,
}

impl Curve<'_, '_, '_> {
    fn at(&self, x: f64, y: f64) -> Pixel {
        pixel(self.chart, x, self.scale.at(y))
    }

    /// Whether there was anything to draw.
    fn draw(&self, series: &Series, quantity: &Quantity) -> Result<bool, PictureError> {
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
fn width(number: usize, count: usize) -> f64 {
    1.6 + 2.4 * (count - 1 - number) as f64 / count as f64
}

/// Writes what a panel shows; `at` is the lower left corner (pixels).
pub(super) fn caption(root: &Area, text: &str, at: Pixel) -> Result<(), PictureError> {
    let font = Text::new(LABEL).bold();
    font.write(root, text, at, (HPos::Left, VPos::Bottom))
}

/// A cross of half the width `r` (pixels).
pub(super) fn cross(
    root: &Area,
    (x, y): Pixel,
    r: f64,
    colour: RGBColor,
) -> Result<(), PictureError> {
    polyline(root, &[(x - r, y - r), (x + r, y + r)], colour, 1.6)?;
    polyline(root, &[(x - r, y + r), (x + r, y - r)], colour, 1.6)
}
