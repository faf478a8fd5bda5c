//! A chart: series of points over an axis, with what they may be off by.

use std::ops::Range;

use plotters::prelude::{Color, RGBColor};
use plotters::style::text_anchor::{HPos, VPos};

use super::composition::{Composition, Panel, part, remark, stacked};
use super::curve::{Placed, piece};
use super::marks::{Box4, Pixel, polygon, polyline};
use super::picture::{Area, PictureError};
use super::ranking::disc;
use super::style::{Axis, BLUE, GREEN, INK, LABEL, Text, VERMILLION, chart, pixel};
use super::{Figure, Sheet};
use crate::csv::{number, table};
use crate::document::{Drawing, Unit, told};
use physics::units::{prefix_of, si};

const WIDTH: f64 = 860.0;
/// Height over width of the plot.
const FLATNESS: f64 = 0.5;
/// Space around the plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [14.0, 30.0, 62.0, 92.0];
/// Most marked powers of ten along an axis.
const MOST_POWERS: usize = 8;

/// Okabe and Ito's colours, told apart by colour-blind readers.
pub const COLOURS: [RGBColor; 7] = [
    BLUE,
    VERMILLION,
    GREEN,
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    INK,
];

/// What is told along an axis.
#[derive(Clone, Debug)]
pub struct Dimension {
    /// What files call it; ends in the unit.
    key: &'static str,
    /// What people call it.
    name: String,
    unit: Unit,
    is_logarithmic: bool,
    /// What logarithms are taken beside: 1 of counts, which begin at none.
    offset: f64,
    range: Option<[f64; 2]>,
    /// Where marks are; wherever numbers are round if there are none.
    marks: Vec<f64>,
}

impl Dimension {
    /// A quantity whose unit its key says.
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

    /// A share of all, from none to all.
    pub fn share(key: &'static str, name: impl Into<String>) -> Self {
        Self {
            unit: Unit::Share,
            range: Some([0.0, 1.0]),
            ..Self::new(key, name)
        }
    }

    /// By its decimal logarithm.
    #[must_use]
    pub fn logarithmic(self) -> Self {
        Self {
            is_logarithmic: true,
            ..self
        }
    }

    /// Of counts, none among them: by the decimal logarithm of one more.
    #[must_use]
    pub fn counting(self) -> Self {
        Self {
            offset: 1.0,
            ..self.logarithmic()
        }
    }

    /// From one number to another.
    #[must_use]
    pub fn within(self, range: [f64; 2]) -> Self {
        Self {
            range: Some(range),
            ..self
        }
    }

    /// With marks at these numbers.
    #[must_use]
    pub fn marked(self, marks: impl IntoIterator<Item = f64>) -> Self {
        Self {
            marks: marks.into_iter().collect(),
            ..self
        }
    }

    /// Whether a value has a place on the axis.
    fn holds(&self, value: f64) -> bool {
        value.is_finite() && !(self.is_logarithmic && value + self.offset <= 0.0)
    }

    /// The axis for values up to the greatest of these, and where a value stands on it.
    fn axis(&self, values: impl Iterator<Item = f64>) -> (Axis, impl Fn(f64) -> f64) {
        let values = values.filter(|value| self.holds(*value));
        let ends = values.fold(None, |ends: Option<[f64; 2]>, value| {
            let [low, high] = ends.unwrap_or([value; 2]);
            Some([low.min(value), high.max(value)])
        });
        let [low, high] = self.range.or(ends).unwrap_or([0.0, 1.0]);
        let (is_logarithmic, offset) = (self.is_logarithmic, self.offset);
        let (scale, name) = match self.unit {
            _ if is_logarithmic => (1.0, self.name.clone()),
            Unit::Share => (0.01, format!("{} (%)", self.name)),
            Unit::None => (1.0, self.name.clone()),
            Unit::Of(symbol) => {
                let (scale, prefix) = prefix_of(0.999 * low.abs().max(high.abs()));
                (scale, format!("{} ({prefix}{symbol})", self.name))
            }
        };
        let place = move |value: f64| match is_logarithmic {
            true => libm::log10(value + offset),
            false => value / scale,
        };
        let range = self.room(place(low), place(high));
        let mut axis = match self.is_logarithmic {
            true => Axis {
                ticks: self.powers(&range),
                range,
                name,
            },
            false => Axis::linear(range, 7, name),
        };
        if !self.marks.is_empty() {
            let text = |value: f64| match self.unit {
                Unit::None if value.fract() == 0.0 => value.to_string(),
                unit => told(value, unit, 2),
            };
            let mark = |value: &f64| (place(*value), text(*value));
            axis.ticks = self.marks.iter().map(mark).collect();
            if !self.is_logarithmic && self.unit != Unit::None {
                axis.name.clone_from(&self.name);
            }
        }
        (axis, place)
    }

    /// A range with a little room at its ends, unless they are given.
    fn room(&self, low: f64, high: f64) -> Range<f64> {
        let margin = match high > low {
            true => 0.03 * (high - low),
            false => 0.5 * high.abs().max(1e-3),
        };
        match self.range {
            Some(_) => low..high,
            None if self.is_logarithmic || low < 0.0 => low - margin..high + margin,
            // What counts from zero begins there.
            None => 0.0f64.min(low)..high + margin,
        }
    }

    /// Marks at powers of ten, or at 1, 2 and 5 times these where there are few.
    fn powers(&self, range: &Range<f64>) -> Vec<(f64, String)> {
        let powers = range.start.floor() as i32..=range.end.ceil() as i32;
        let count = (range.end - range.start) as usize;
        let multiples: &[f64] = if count < 2 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let all = powers
            .step_by(count / MOST_POWERS + 1)
            .flat_map(|power| multiples.iter().map(move |m| m * 10f64.powi(power)))
            .filter(|value| *value >= self.offset);
        let none = (self.offset > 0.0).then_some(0.0);
        let text = |value: f64| match self.unit {
            // Powers of ten of minutes and hours are none.
            Unit::Of("s") => si(value, "s", 1),
            Unit::None if value.fract() == 0.0 => value.to_string(),
            unit => told(value, unit, 1),
        };
        let mark = |value: f64| (libm::log10(value + self.offset), text(value));
        none.into_iter()
            .chain(all)
            .map(mark)
            .filter(|(place, _)| range.contains(place))
            .collect()
    }
}

/// How a series looks.
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
    /// Bars from zero, as far apart as the points.
    Bars,
}

/// A point with the ends between which its y lies; NaN where it is not known.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Along the chart.
    pub x: f64,
    /// Up it.
    pub y: f64,
    /// Lower and upper end.
    pub ends: Option<[f64; 2]>,
}

impl From<[f64; 2]> for Point {
    fn from([x, y]: [f64; 2]) -> Self {
        Self { x, y, ends: None }
    }
}

/// Points that belong together.
#[derive(Clone, Debug)]
pub struct Series {
    /// What they are.
    pub name: String,
    /// How they look.
    pub look: Look,
    /// Which of the [`COLOURS`].
    pub colour: usize,
    /// The points, from left to right.
    pub points: Vec<Point>,
}

/// A chart.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The stem of its files.
    pub name: &'static str,
    /// What it shows.
    pub title: String,
    /// Along it.
    pub x: Dimension,
    /// Up it.
    pub y: Dimension,
    /// What is in it.
    pub series: Vec<Series>,
    /// What to know of it; may be empty.
    pub remark: String,
}

impl Chart {
    /// With another series, in a colour of its own.
    #[must_use]
    pub fn with<P: Into<Point>>(
        mut self,
        name: impl Into<String>,
        look: Look,
        points: impl IntoIterator<Item = P>,
    ) -> Self {
        self.series.push(Series {
            name: name.into(),
            look,
            colour: self.series.len() % COLOURS.len(),
            points: points.into_iter().map(Into::into).collect(),
        });
        self
    }

    /// The last series in a colour by its number, such as that of another.
    #[must_use]
    pub fn in_colour(mut self, number: usize) -> Self {
        if let Some(series) = self.series.last_mut() {
            series.colour = number % COLOURS.len();
        }
        self
    }

    /// Draws it.
    ///
    /// # Errors
    /// See [`PictureError`].
    pub fn draw(&self, sheet: &Sheet) -> Result<Figure, PictureError> {
        let height = |width| FLATNESS * width + MARGIN[0] + MARGIN[2];
        let panel = Panel::new("", 0.0, height, |root, _, place| self.plot(root, place));
        let shown = |series: &&Series| !series.points.is_empty();
        let names = self.series.iter().filter(shown);
        let names = names.map(|series| (series.name.clone(), COLOURS[series.colour], series.look));
        let mut key = names_of_series(names.collect());
        if !self.remark.is_empty() {
            key = stacked(key, remark(self.remark.clone()));
        }
        let composition = Composition {
            name: self.name.to_owned(),
            title: self.title.clone(),
            note: None,
            width: WIDTH,
            panels: vec![panel],
            key: Some(key),
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

    fn plot(&self, root: &Area, place: Box4) -> Result<(), PictureError> {
        let points = || self.series.iter().flat_map(|series| &series.points);
        let ends = |point: &Point| point.ends.unwrap_or([point.y; 2]);
        let (x_axis, x_at) = self.x.axis(points().map(|point| point.x));
        let up = points().flat_map(|point| [&[point.y][..], &ends(point)].concat());
        let (y_axis, y_at) = self.y.axis(up);
        let area = part(root, place);
        let floor = y_axis.range.start;
        let chart = chart(&area, MARGIN, &x_axis, &y_axis, true)?;
        let at = |x: f64, y: f64| pixel(&chart, x_at(x), y_at(y).max(floor));
        for series in &self.series {
            let colour = COLOURS[series.colour];
            let known = |point: &Point| self.x.holds(point.x) && self.y.holds(point.y);
            let placed = |point: &Point| Placed {
                at: at(point.x, point.y),
                ends: point.ends.map(|ends| ends.map(|end| at(point.x, end))),
            };
            for run in series.points.split(|point| !known(point)) {
                let run: Vec<Placed> = run.iter().map(placed).collect();
                match series.look {
                    Look::Line => piece(root, &run, colour, 2.0)?,
                    Look::Steps | Look::Dashed => {
                        let line: Vec<Pixel> = run.iter().map(|placed| placed.at).collect();
                        match series.look {
                            Look::Steps => polyline(root, &line, colour, 2.0)?,
                            _ => dashed(root, &line, colour)?,
                        }
                    }
                    Look::Dots | Look::Rings => {
                        for placed in &run {
                            dot(root, placed, colour, series.look)?;
                        }
                    }
                    Look::Bars => bars(root, &run, at(0.0, 0.0).1, colour)?,
                }
            }
        }
        Ok(())
    }
}

impl From<Chart> for Drawing<'_> {
    fn from(chart: Chart) -> Self {
        Self::new(chart.title.clone(), move |sheet| chart.draw(sheet))
    }
}

/// A dot or a ring with lines to its ends.
fn dot(root: &Area, placed: &Placed, colour: RGBColor, look: Look) -> Result<(), PictureError> {
    if let Some(ends) = placed.ends {
        polyline(root, &ends, colour, 2.0)?;
    }
    match look {
        Look::Rings => super::curve::ring(root, placed.at, colour),
        _ => disc(root, placed.at, colour),
    }
}

/// Bars from a height (pixels) to their points, as wide as these are apart.
fn bars(root: &Area, run: &[Placed], zero: f64, colour: RGBColor) -> Result<(), PictureError> {
    let step = run.windows(2).map(|pair| pair[1].at.0 - pair[0].at.0);
    let half = 0.46 * step.fold(f64::INFINITY, f64::min).min(40.0);
    run.iter().try_for_each(|Placed { at: (x, y), .. }| {
        let corners = [
            (x - half, zero),
            (x + half, zero),
            (x + half, *y),
            (x - half, *y),
        ];
        polygon(root, &corners, colour, None)
    })
}

/// A dashed line.
fn dashed(root: &Area, line: &[Pixel], colour: impl Color + Copy) -> Result<(), PictureError> {
    const DASH: f64 = 6.0;
    let mut behind = 0.0;
    for pair in line.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let length = libm::hypot(b.0 - a.0, b.1 - a.1);
        let along = |s: f64| {
            let t = (s - behind) / length;
            (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1))
        };
        // Dashes go on around corners: every other stretch of the whole line is drawn.
        for k in (behind / DASH) as usize..=((behind + length) / DASH) as usize {
            let from = (k as f64 * DASH).max(behind);
            let to = ((k + 1) as f64 * DASH).min(behind + length);
            if k % 2 == 0 && to > from {
                polyline(root, &[along(from), along(to)], colour, 2.0)?;
            }
        }
        behind += length;
    }
    Ok(())
}

/// Which colour is which series, in as many lines as it takes; nothing for a single one.
pub fn names_of_series<'a>(series: Vec<(String, RGBColor, Look)>) -> Panel<'a> {
    const LINE: f64 = 24.0;
    let font = Text::new(LABEL);
    let series = std::sync::Arc::new(match series.len() {
        0 | 1 => Vec::new(),
        _ => series,
    });
    let all = series.clone();
    let places = move |width: f64| -> Vec<Pixel> {
        let (mut x, mut y) = (22.0, 14.0);
        let mut place = |(name, ..): &(String, RGBColor, Look)| {
            let wide = 31.0 + 1.08 * font.width(name) + 22.0;
            if x > 22.0 && x + wide > width {
                (x, y) = (22.0, y + LINE);
            }
            let at = (x, y);
            x += wide;
            at
        };
        all.iter().map(&mut place).collect()
    };
    let height = {
        let places = places.clone();
        move |width| places(width).last().map_or(0.0, |(_, y)| y + 14.0)
    };
    Panel::new("", 0.0, height, move |root, _, [left, top, right, _]| {
        for ((name, colour, look), (x, y)) in series.iter().zip(places(right - left)) {
            let (x, y) = (left + x, top + y);
            let line = [(x, y), (x + 24.0, y)];
            match look {
                Look::Dashed => dashed(root, &line, *colour)?,
                Look::Dots | Look::Rings => {
                    let placed = Placed {
                        at: (x + 12.0, y),
                        ends: None,
                    };
                    dot(root, &placed, *colour, *look)?;
                }
                Look::Bars => {
                    let (right, [above, below]) = (x + 20.0, [y - 8.0, y + 8.0]);
                    let corners = [
                        (x + 4.0, above),
                        (right, above),
                        (right, below),
                        (x + 4.0, below),
                    ];
                    polygon(root, &corners, *colour, None)?;
                }
                Look::Line | Look::Steps => polyline(root, &line, *colour, 2.4)?,
            }
            font.write(root, name, (x + 31.0, y), (HPos::Left, VPos::Center))?;
        }
        Ok(())
    })
}
