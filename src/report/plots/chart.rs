//! A chart: series of points over an axis, with error bars.

use plotters::coord::ranged1d::{BoldPoints, Ranged};
use plotters::coord::types::RangedCoordi32;
use plotters::prelude::{Circle, EmptyElement, LineSeries, PathElement, PointSeries, Polygon};
use plotters::series::DashedLineSeries;
use plotters::style::{Color, RGBColor, WHITE};

use super::axes::{Axis, Plot, Spacing};
use super::canvas::{Box4, Canvas, DASH, DISC, Pixel, RIM};
use super::composition::{Composition, Panel, remark};
use super::key::{Meanings, Sign, key};
use super::picture::PictureError;
use super::sheet::Sheet;
use super::style::{COLOURS, INK, series_colour, stroke, unit};
use super::{Drawing, Figure};
use crate::columns::{Unit, describe};
use crate::csv::{number, table};
use physics::units::si;

const WIDTH: f64 = 860.0;
/// Height over width of the plot.
const FLATNESS: f64 = 0.5;
/// Least height of the plot (pixels).
const LOWEST: f64 = 240.0;
/// Space around the plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [14.0, 30.0, 62.0, 92.0];
/// Largest number of marked powers of ten along an axis.
const MOST_POWERS: usize = 8;

/// The quantity of an axis.
#[must_use]
#[derive(Clone, Debug)]
pub struct Dimension {
    /// Its key in files, which ends in the unit.
    key: &'static str,
    /// Its name for people.
    name: String,
    unit: Unit,
    is_logarithmic: bool,
    /// The offset inside logarithms: 1 for counts, which can be 0.
    offset: f64,
    range: Option<[f64; 2]>,
    /// The marks; at round numbers if empty.
    marks: Vec<f64>,
}

impl Dimension {
    /// A quantity whose unit is in its key.
    pub fn new(key: &'static str, name: impl Into<String>) -> Self {
        Self {
            key,
            name: name.into(),
            unit: Unit::of_key(key),
            is_logarithmic: false,
            offset: 0.0,
            range: None,
            marks: Vec::new(),
        }
    }

    /// A share, from 0 to 1.
    pub fn share(key: &'static str, name: impl Into<String>) -> Self {
        Self {
            unit: Unit::Share,
            ..Self::new(key, name)
        }
    }

    /// On a logarithmic axis.
    pub fn logarithmic(self) -> Self {
        Self {
            is_logarithmic: true,
            ..self
        }
    }

    /// On a logarithmic axis for counts that can be 0: by the logarithm of the count plus 1.
    pub fn counting(self) -> Self {
        Self {
            offset: 1.0,
            ..self.logarithmic()
        }
    }

    /// With a fixed range.
    pub fn within(self, range: [f64; 2]) -> Self {
        Self {
            range: Some(range),
            ..self
        }
    }

    /// With marks at these numbers.
    pub fn marked(self, marks: impl IntoIterator<Item = f64>) -> Self {
        Self {
            marks: marks.into_iter().collect(),
            ..self
        }
    }

    /// Whether a value can be shown on the axis.
    fn holds(&self, value: f64) -> bool {
        value.is_finite() && !(self.is_logarithmic && value + self.offset <= 0.0)
    }

    /// The axis for these values.
    fn axis(&self, values: impl Iterator<Item = f64>, count: usize) -> Axis {
        let values = values.filter(|value| self.holds(*value));
        let ends = values.fold(None, |ends: Option<[f64; 2]>, value| {
            let [low, high] = ends.unwrap_or([value; 2]);
            Some([low.min(value), high.max(value)])
        });
        let ends = self.range.or(ends).unwrap_or([0.0, 1.0]);
        let mut axis = match self.is_logarithmic {
            true => {
                let ends = self.room(ends.map(|end| libm::log10(end + self.offset)));
                Axis {
                    spacing: Spacing::Logarithms(self.offset),
                    marks: self.powers(ends),
                    ends,
                    name: self.name.clone(),
                }
            }
            false => {
                let (ends, name) = (self.room(ends), &self.name);
                match self.unit {
                    Unit::None => Axis::even(ends, 1.0, count, name),
                    Unit::Share => Axis::even(ends, 0.01, count, format!("{name} (%)")),
                    Unit::Of("rad") => {
                        Axis::even(ends, 1f64.to_radians(), count, format!("{name} (\u{b0})"))
                    }
                    Unit::Of(symbol) => Axis::quantity(ends, symbol, count, name),
                }
            }
        };
        if !self.marks.is_empty() {
            let text = |value: f64| match self.unit {
                Unit::None if value.fract() == 0.0 => value.to_string(),
                unit => describe(value, unit, 2),
            };
            let mark = |value: &f64| (axis.spacing.of(*value), text(*value));
            axis.marks = self.marks.iter().map(mark).collect();
            if !self.is_logarithmic && self.unit != Unit::None {
                axis.name.clone_from(&self.name);
            }
        }
        axis
    }

    /// A range with a margin at its ends, unless they are given.
    fn room(&self, [low, high]: [f64; 2]) -> [f64; 2] {
        let margin = match high > low {
            true => 0.03 * (high - low),
            false => 0.5 * high.abs().max(1e-3),
        };
        match self.range {
            Some(_) => [low, high],
            None if self.unit == Unit::Share && !(0.0..0.7).contains(&(high - 1e-9)) => [0.0, 1.0],
            None if self.unit == Unit::Share => [0.0, high + margin],
            // The axis starts at zero where that leaves little empty space.
            None if !self.is_logarithmic && (0.0..=0.25 * high).contains(&low) => {
                [0.0, high + margin]
            }
            None => [low - margin, high + margin],
        }
    }

    /// Marks at powers of ten, or at 1, 2 and 5 times these if there are few.
    fn powers(&self, [low, high]: [f64; 2]) -> Vec<(f64, String)> {
        let powers = RangedCoordi32::from(low.floor() as i32..high.ceil() as i32);
        let multiples: &[f64] = match high - low < 2.0 {
            true => &[1.0, 2.0, 5.0],
            false => &[1.0],
        };
        let all = powers
            .key_points(BoldPoints(MOST_POWERS))
            .into_iter()
            .flat_map(|power| multiples.iter().map(move |m| m * 10f64.powi(power)))
            .filter(|value| *value >= self.offset);
        let none = (self.offset > 0.0).then_some(0.0);
        let text = |value: f64| match self.unit {
            // Powers of ten of minutes and hours are not round.
            Unit::Of("s") => si(value, "s", 1),
            Unit::None if value.fract() == 0.0 => value.to_string(),
            unit => describe(value, unit, 1),
        };
        let mark = |value: f64| (libm::log10(value + self.offset), text(value));
        let all = none.into_iter().chain(all).map(mark);
        all.filter(|(place, _)| (low..high).contains(place))
            .collect()
    }
}

/// The style of a series.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Look {
    /// A line with dots at its points and a band between their ends.
    #[default]
    Line,
    /// A line without dots.
    Steps,
    /// A dashed line.
    Dashed,
    /// Filled dots, with lines to their ends.
    Dots,
    /// Rings, with lines to their ends.
    Rings,
    /// Bars from zero, as wide as the distance of the points.
    Bars,
}

/// A point with the interval of its y; NaN if it is not known.
#[derive(Clone, Copy, Debug)]
pub struct ChartPoint {
    /// The abscissa.
    pub x: f64,
    /// The vertical axis.
    pub y: f64,
    /// Lower and upper end.
    pub ends: Option<[f64; 2]>,
}

impl From<[f64; 2]> for ChartPoint {
    fn from([x, y]: [f64; 2]) -> Self {
        Self { x, y, ends: None }
    }
}

/// A series of points.
#[derive(Clone, Debug)]
pub struct Series {
    /// Its name.
    pub name: String,
    /// Its style.
    pub look: Look,
    /// The index of its colour; beyond the last colour lines are dashed.
    pub colour: usize,
    /// The points, from left to right.
    pub points: Vec<ChartPoint>,
}

impl Series {
    /// A series with a colour by its index.
    pub fn new<P: Into<ChartPoint>>(
        name: impl Into<String>,
        look: Look,
        colour: usize,
        points: impl IntoIterator<Item = P>,
    ) -> Self {
        Self {
            name: name.into(),
            look,
            colour,
            points: points.into_iter().map(Into::into).collect(),
        }
    }

    /// Lengths of the line's dashes and gaps (pixels); `None` for a solid line.
    fn dashes(&self) -> Option<[f64; 2]> {
        match (self.look, self.colour / COLOURS.len()) {
            (Look::Dashed, _) => Some([DASH; 2]),
            (_, 0) => None,
            (_, 1) => Some([3.0 * DASH, 0.5 * DASH]),
            _ => Some([0.4 * DASH, 0.6 * DASH]),
        }
    }

    /// Its entry in the key.
    pub fn meaning(&self) -> (Sign, String) {
        let (colour, dashes) = (series_colour(self.colour), self.dashes());
        let sign = match self.look {
            Look::Line | Look::Steps | Look::Dashed => match dashes {
                None => Sign::Line(colour),
                Some(dashes) => Sign::Dashed(colour, dashes),
            },
            Look::Dots => Sign::Dot(colour),
            Look::Rings => Sign::Circle(colour),
            Look::Bars => Sign::Block(colour),
        };
        (sign, self.name.clone())
    }
}

/// A chart.
#[must_use]
#[derive(Clone, Debug)]
pub struct Chart {
    /// The stem of its files.
    pub name: &'static str,
    /// The title.
    pub title: String,
    /// The horizontal axis.
    pub x: Dimension,
    /// The vertical axis.
    pub y: Dimension,
    /// Its series.
    pub series: Vec<Series>,
    /// A remark; may be empty.
    pub remark: String,
}

impl Chart {
    /// A chart without series: the stem of its files, its title, and its axes.
    pub fn new(name: &'static str, title: impl Into<String>, x: Dimension, y: Dimension) -> Self {
        Self {
            name,
            title: title.into(),
            x,
            y,
            series: Vec::new(),
            remark: String::new(),
        }
    }

    /// Sets the remark.
    pub fn remarked(mut self, remark: impl Into<String>) -> Self {
        self.remark = remark.into();
        self
    }

    /// Adds a series in a new colour.
    pub fn with<P: Into<ChartPoint>>(
        mut self,
        name: impl Into<String>,
        look: Look,
        points: impl IntoIterator<Item = P>,
    ) -> Self {
        let colour = self.series.len();
        self.series.push(Series::new(name, look, colour, points));
        self
    }

    /// Gives the last series a colour by its index, such as that of another series.
    pub fn in_colour(mut self, number: usize) -> Self {
        if let Some(series) = self.series.last_mut() {
            series.colour = number;
        }
        self
    }

    /// Draws the chart.
    ///
    /// # Errors
    /// See [`PictureError`].
    pub fn draw(&self, sheet: &Sheet) -> Result<Figure, PictureError> {
        let height = |width: f64| (FLATNESS * width).max(LOWEST) + MARGIN[0] + MARGIN[2];
        let panel = Panel::alone(height, |canvas, place| {
            plotted(canvas, place, MARGIN, [&self.x, &self.y], &self.series);
        });
        let composition = Composition {
            name: self.name.to_owned(),
            title: self.title.clone(),
            width: WIDTH,
            panels: vec![panel],
            keys: vec![key(meanings(&self.series)), remark(self.remark.clone())],
            ..Composition::default()
        };
        Figure::new(&composition, sheet, self.numbers())
    }

    /// The points as a table of numbers.
    fn numbers(&self) -> String {
        let points = self.series.iter().flat_map(|series| {
            let points = series.points.iter();
            points.map(|point| (series.name.clone(), point))
        });
        let known = |value: f64| match value.is_finite() {
            true => number(value),
            false => String::new(),
        };
        let rows = points.map(|(name, point)| {
            let [low, high] = point.ends.unwrap_or([f64::NAN; 2]);
            let numbers = [point.x, point.y, low, high].map(known);
            [&[name][..], &numbers].concat()
        });
        table(["series", self.x.key, self.y.key, "low", "high"], rows)
    }
}

impl From<Chart> for Drawing<'_> {
    fn from(chart: Chart) -> Self {
        Self::new(chart.title.clone(), move |sheet| chart.draw(sheet))
    }
}

/// The entries of the key; empty for a single series.
pub fn meanings(series: &[Series]) -> Meanings {
    let shown = series.iter().filter(|series| !series.points.is_empty());
    let meanings: Meanings = shown.map(Series::meaning).collect();
    if meanings.len() > 1 {
        meanings
    } else {
        Vec::new()
    }
}

/// Draws series between axes that contain them all.
pub fn plotted(
    canvas: &mut Canvas,
    place: Box4,
    margin: [f64; 4],
    [x, y]: [&Dimension; 2],
    series: &[Series],
) -> Plot {
    let points = || series.iter().flat_map(|series| &series.points);
    let ends = |point: &ChartPoint| point.ends.unwrap_or([point.y; 2]);
    // Bars begin at zero.
    let foot = series
        .iter()
        .filter(|one| one.look == Look::Bars)
        .map(|_| 0.0);
    let up = points().flat_map(|point| [&[point.y][..], &ends(point)].concat());
    let [width, height] = [place[2] - place[0], place[3] - place[1]];
    let mut axes = [
        x.axis(
            points().map(|point| point.x),
            if width < 420.0 { 5 } else { 7 },
        ),
        y.axis(up.chain(foot), if height < 320.0 { 5 } else { 7 }),
    ];
    // A curve on the axis itself would hide there.
    let has_bars = series.iter().any(|one| one.look == Look::Bars);
    let is_hidden = !y.is_logarithmic && axes[1].ends[0] == 0.0 && points().any(|it| it.y == 0.0);
    if is_hidden && !has_bars {
        axes[1].ends[0] = -0.03 * axes[1].ends[1];
    }
    let is_crossed = !y.is_logarithmic && axes[1].ends[0] < 0.0 && axes[1].ends[1] > 0.0;
    let mut plot = Plot::new(canvas, place, margin, axes, true);
    if is_crossed {
        canvas.line(&plot.level(0.0), INK, 1.2);
    }
    for (number, series_drawn) in series.iter().enumerate() {
        let known = |point: &ChartPoint| x.holds(point.x) && point.y.is_finite();
        for run in series_drawn.points.split(|point| !known(point)) {
            // Later curves are thinner, so that an earlier one can be seen beneath.
            let later = (series.len() - 1 - number) as f64 / series.len() as f64;
            drawn(canvas, &mut plot, series_drawn, run, 2.0 + 2.0 * later);
        }
        // Infinity.
        let beyond = series_drawn.points.iter();
        for point in beyond.filter(|point| point.y == f64::INFINITY) {
            let (x, top) = (plot.at(point.x, 0.0).0, plot.frame[1]);
            let arrow = [(x - 5.0, top + 10.0), (x, top + 2.0), (x + 5.0, top + 10.0)];
            canvas.line(&arrow, series_colour(series_drawn.colour), 2.0);
        }
    }
    plot
}

/// Draws an unbroken run of a series' points, with a line of this width (pixels).
fn drawn(canvas: &mut Canvas, plot: &mut Plot, series: &Series, run: &[ChartPoint], width: f64) {
    let colour = series_colour(series.colour);
    let dashes = series.dashes().map(|lengths| lengths.map(unit));
    let line: Vec<_> = run.iter().map(|one| plot.place(one.x, one.y)).collect();
    match series.look {
        Look::Line => {
            bands(canvas, plot, run, colour);
            let style = stroke(colour, width);
            match dashes {
                None => plot.series(canvas, LineSeries::new(line.clone(), style)),
                Some([dash, gap]) => {
                    let series = DashedLineSeries::new(line.clone(), dash, gap, style);
                    plot.series(canvas, series);
                }
            }
            // Dots so close that they would hide the line are left out.
            if 3.0 * RIM * run.len() as f64 <= plot.frame[2] - plot.frame[0] {
                discs(canvas, plot, line, colour);
            }
        }
        Look::Steps => plot.series(canvas, LineSeries::new(line, stroke(colour, 2.0))),
        Look::Dashed => {
            let (dash, style) = (unit(DASH), stroke(colour, 2.0));
            plot.series(canvas, DashedLineSeries::new(line, dash, dash, style));
        }
        Look::Dots | Look::Rings => {
            let ends = run.iter().filter_map(|one| Some((one.x, one.ends?)));
            let ends = ends.map(|(x, ends)| ends.map(|end| plot.place(x, end)));
            let ends = ends.map(|ends| PathElement::new(ends, stroke(colour, 2.0)));
            let ends: Vec<_> = ends.collect();
            plot.series(canvas, ends);
            match series.look {
                Look::Rings => {
                    let style = stroke(colour, 1.8);
                    let rings = PointSeries::<_, _, Circle<_, _>, _>::new(line, unit(RIM), style);
                    plot.series(canvas, rings);
                }
                _ => discs(canvas, plot, line, colour),
            }
        }
        Look::Bars => {
            let tops: Vec<Pixel> = run.iter().map(|one| plot.at(one.x, one.y)).collect();
            bars(canvas, &tops, plot.at(0.0, 0.0).1, colour);
        }
    }
}

/// Discs with white rims.
fn discs(canvas: &mut Canvas, plot: &mut Plot, at: Vec<(f64, f64)>, colour: RGBColor) {
    let disc = |at, radius, style| {
        EmptyElement::at(at)
            + Circle::new((0, 0), unit(RIM), WHITE.filled())
            + Circle::new((0, 0), radius, style)
    };
    plot.series(
        canvas,
        PointSeries::of_element(at, unit(DISC), colour.filled(), &disc),
    );
}

/// The bands between the ends of points.
fn bands(canvas: &mut Canvas, plot: &mut Plot, run: &[ChartPoint], colour: RGBColor) {
    for bounded in run.split(|point| point.ends.is_none()) {
        let end = |k: usize| {
            let ends = bounded
                .iter()
                .filter_map(move |one| Some((one.x, one.ends?[k])));
            ends.map(|(x, end)| plot.place(x, end)).collect::<Vec<_>>()
        };
        let (low, high) = (end(0), end(1));
        let corners: Vec<_> = low.into_iter().chain(high.into_iter().rev()).collect();
        match corners.len() {
            0 => {}
            2 => plot.series(
                canvas,
                LineSeries::new(corners, stroke(colour.mix(0.5), 4.0)),
            ),
            _ => plot.series(canvas, [Polygon::new(corners, colour.mix(0.25).filled())]),
        }
    }
}

/// Bars from a height (pixels) to points, as wide as the distance of the points.
fn bars(canvas: &mut Canvas, tops: &[Pixel], zero: f64, colour: RGBColor) {
    let step = tops.windows(2).map(|pair| pair[1].0 - pair[0].0);
    let half = 0.46 * step.fold(f64::INFINITY, f64::min).min(40.0);
    for (x, y) in tops {
        canvas.block([x - half, *y, x + half, zero], colour);
    }
}
