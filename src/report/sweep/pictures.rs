//! The pictures of a sweep: curves over one varied number, or maps over two.

use crate::csv::{number, table};
use crate::figures::{Shown, cell};
use crate::plots::axes::{Axis, Plot};
use crate::plots::canvas::{Box4, Canvas, Spot, around, corners, middle};
use crate::plots::chart::{ChartPoint, Dimension, Look, Series, meanings, plotted};
use crate::plots::composition::{Composition, Panel, remark};
use crate::plots::heat;
use crate::plots::key::key;
use crate::plots::scale::colour;
use crate::plots::style::{Anchor, COLOURS, GRID, INK, SMALL, SOFT, minus, series_colour};
use crate::plots::{Drawing, Figure, PictureError, Sheet};
use crate::points::{Common, FinishedSweep, Variable};
use jobs::comparison::quantity::{Measure, NO_TRAPS, QUANTITIES, placed};
use jobs::comparison::{Assessment, Quantity};
use jobs::sweep::SweepPoint;
use ordered_float::OrderedFloat;
use physics::order::Order;
use physics::units::to_digits;

/// Largest number of pictures of a sweep, and of series in one picture.
const MOST_PICTURES: usize = 24;
const MOST_SERIES: usize = 2 * COLOURS.len();
const WIDTH: f64 = 1200.0;
/// Height of a panel of curves and of a map, and the smallest width beside another (pixels).
const HEIGHTS: [f64; 2] = [262.0, 380.0];
const LEAST: [f64; 2] = [320.0, 360.0];
/// Space around the plot of curves and around a map (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [34.0, 20.0, 58.0, 78.0];
const MAP_MARGIN: [f64; 4] = [34.0, 18.0, 58.0, 76.0];
/// Numbers that span more powers of ten have a logarithmic axis.
const MOST_DECADES: f64 = 2.0;

/// The meaning of marks, for curves and for maps.
const SIGNS: [&str; 2] = [
    "bands: certified bounds, 95 % intervals; \u{25cb} no trap; ^ caged, proved; \u{d7} \
     impossible design",
    "\u{25cb} no trap; \u{2013} not known; \u{221e} caged, proved; \u{d7} impossible design",
];

/// A named group of points.
type Named<'a> = (String, Vec<&'a SweepPoint>);

/// The content of a picture.
struct Content<'a> {
    sweep: &'a FinishedSweep<'a>,
    /// One number, or two.
    numbers: Vec<Variable>,
    /// The values common to all its points.
    common: Common,
    /// Its points; for curves one series or several.
    series: Vec<Named<'a>>,
}

/// The pictures of a sweep: curves over one varied number, maps over two; none otherwise. All other
/// varied values distinguish series and pictures.
pub fn drawings<'a>(sweep: &'a FinishedSweep) -> Vec<Drawing<'a>> {
    let numbers = sweep.variables();
    if !(1..=2).contains(&numbers.len()) {
        return Vec::new();
    }
    // For curves the first word distinguishes series.
    let words = 2 - numbers.len();
    let mut pictures: Vec<Content> = Vec::new();
    for point in &sweep.points {
        let mut name = sweep.common(point, &numbers);
        let common = name.split_off(words.min(name.len()));
        let name = name.pop().map_or(String::new(), |(_, value)| value);
        let known = pictures.iter().position(|picture| picture.common == common);
        let picture = known.unwrap_or_else(|| {
            pictures.push(Content {
                sweep,
                numbers: numbers.clone(),
                common,
                series: Vec::new(),
            });
            pictures.len() - 1
        });
        let series = &mut pictures[picture].series;
        match series.iter_mut().find(|(known, _)| *known == name) {
            Some((_, points)) => points.push(point),
            None => series.push((name, vec![point])),
        }
    }
    pictures.truncate(MOST_PICTURES);
    let draw =
        |content: Content<'a>| Drawing::new(content.title(), move |sheet| content.draw(sheet));
    pictures.into_iter().map(draw).collect()
}

impl Content<'_> {
    fn title(&self) -> String {
        let plan = self.sweep.plan;
        let only = plan.designs.first().filter(|_| plan.designs.len() == 1);
        let words = self
            .common
            .iter()
            .map(|(key, value)| format!("{key} {value}"));
        let parts: Vec<String> = only
            .map(|one| one.name.clone())
            .into_iter()
            .chain(words)
            .collect();
        let keys = self
            .numbers
            .iter()
            .map(|number| plan.axes[number.axis].name());
        let over = format!("over {}", keys.collect::<Vec<_>>().join(" and "));
        match parts.is_empty() {
            true => over,
            false => format!("{}: {over}", parts.join(", ")),
        }
    }

    /// The stem of its files.
    fn file(&self) -> String {
        let kind = if self.numbers.len() == 1 {
            "curves"
        } else {
            "map"
        };
        let plain = |c: char| {
            if c.is_alphanumeric() || c == '.' {
                c
            } else {
                '-'
            }
        };
        let words = self
            .common
            .iter()
            .map(|(_, value)| value.chars().map(plain).collect());
        let parts: Vec<String> = [kind.to_owned()].into_iter().chain(words).collect();
        parts.join("-")
    }

    fn draw(&self, sheet: &Sheet) -> Result<Figure, PictureError> {
        let kind = self.numbers.len() - 1;
        let shown = placed(|quantity| quantity.panel.filter(|_| kind == 0 || quantity.mapped));
        let panels = shown.into_iter().map(|(place, quantities)| {
            let name = quantities[0].key;
            let draw = move |canvas: &mut Canvas, at| match kind {
                0 => self.curves(canvas, at, place.heading, &quantities),
                _ => self.map(canvas, at, place.heading, quantities[0]),
            };
            Panel::new(name, LEAST[kind], move |_| HEIGHTS[kind], draw)
        });
        let names = self.series.iter().take(MOST_SERIES).enumerate();
        let names = names.map(|(k, (name, _))| Series::new(&name[..], Look::Line, k, [[0.0; 2]]));
        let more = self.series.len().saturating_sub(MOST_SERIES);
        let composition = Composition {
            name: self.file(),
            title: self.title(),
            note: match more {
                0 => String::new(),
                more => format!("{more} more series in sweep.csv"),
            },
            width: WIDTH,
            panels: panels.collect(),
            keys: vec![
                key(meanings(&names.collect::<Vec<_>>())),
                remark(SIGNS[kind].to_owned()),
            ],
        };
        Figure::new(&composition, sheet, self.numbers())
    }

    /// Each figure of each point.
    fn numbers(&self) -> String {
        let kind = self.numbers.len() - 1;
        let names = self.numbers.iter().map(|variable| variable.shown().1);
        let first = (kind == 0).then(|| "series".to_owned());
        let figures = ["figure", "value", "low", "high"].map(str::to_owned);
        let head = first.into_iter().chain(names).chain(figures);
        let shown = placed(|quantity| quantity.panel).into_iter();
        let shown: Vec<&Quantity> = shown.flat_map(|(_, quantities)| quantities).collect();
        let series = self.series.iter().take(MOST_SERIES);
        let rows = series.flat_map(|(name, points)| {
            let mut points = points.clone();
            // Curves from left to right, maps row by row.
            let place = |it: &Variable, point: &SweepPoint| it.value(point).map(OrderedFloat);
            points.order_by_key(|point| {
                let places = self.numbers.iter().rev().map(|it| place(it, point));
                places.collect::<Vec<_>>()
            });
            points.into_iter().map(move |point| (name, point))
        });
        let rows = rows.flat_map(|(name, point)| {
            let series = (kind == 0).then(|| name.clone());
            let at = self
                .numbers
                .iter()
                .map(|it| it.shown().0 * it.value(point).unwrap_or(f64::NAN));
            let at: Vec<String> = series.into_iter().chain(at.map(number)).collect();
            let figures = shown.iter().filter_map(move |quantity| {
                let numbers = quantity.of(self.sweep.assessment(point.index)?)?.finite();
                let numbers = numbers.map(|value| value.map(number).unwrap_or_default());
                Some([&at[..], &[quantity.name("")], &numbers].concat())
            });
            figures.collect::<Vec<_>>()
        });
        table(head, rows)
    }

    /// The text for the point under the pointer.
    fn describe(&self, point: &SweepPoint, quantities: &[&Quantity]) -> Spot {
        let name = self.sweep.called(point);
        let figure = |one: &Assessment| {
            let shown = quantities.iter().filter(|one| one.panel.is_some());
            let shown =
                shown.map(|quantity| format!("{} {}", quantity.label, cell(&[quantity], one)));
            shown.collect::<Vec<_>>().join(", ")
        };
        let reason = || {
            self.sweep
                .reason(point.index)
                .unwrap_or_default()
                .to_owned()
        };
        let told = self
            .sweep
            .assessment(point.index)
            .map_or_else(reason, figure);
        Spot {
            title: format!("{name}: {told}"),
            kind: "point",
            value: point.index.to_string(),
        }
    }

    /// Figures of the same kind over the number, with one curve per series, or two on both sides of
    /// zero.
    fn curves(
        &self,
        canvas: &mut Canvas,
        place: Box4,
        heading: &str,
        quantities: &[&'static Quantity],
    ) {
        let (variable, measure) = (&self.numbers[0], quantities[0].measure);
        let (factor, name) = variable.shown();
        let ends = [
            variable.values[0],
            variable.values[variable.values.len() - 1],
        ];
        let room = 0.03 * (ends[1] - ends[0]);
        let x =
            Dimension::new("", name).within([factor * (ends[0] - room), factor * (ends[1] + room)]);
        let x_of = |point: &SweepPoint| factor * variable.value(point).unwrap_or(f64::NAN);
        let all = || self.series.iter().take(MOST_SERIES).enumerate();
        let series = all().flat_map(|(k, (name, points))| {
            quantities.iter().map(move |quantity| {
                let placed = |point: &&SweepPoint| {
                    let known = self.sweep.assessment(point.index);
                    let known = known.and_then(|one| quantity.of(one));
                    ChartPoint {
                        x: x_of(point),
                        y: known.map_or(f64::NAN, |it| it.value),
                        ends: known.and_then(|it| Some([it.low?, it.high?])),
                    }
                };
                let mut points: Vec<ChartPoint> = points.iter().map(placed).collect();
                points.order_by_key(|point| OrderedFloat(point.x));
                Series::new(&name[..], Look::Line, k, points)
            })
        });
        let series: Vec<Series> = series.collect();
        let values = || {
            series
                .iter()
                .flat_map(|one| one.points.iter().map(|point| point.y))
        };
        let mut y = dimension(measure);
        if [Measure::Ratio, Measure::Energy].contains(&measure) && !values().any(|it| it < 0.0) {
            let powers = values().map(libm::log10).filter(|power| power.is_finite());
            let [low, high] = powers
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], power| {
                    [low.min(power), high.max(power)]
                });
            if high - low > MOST_DECADES {
                y = y.logarithmic();
            }
        }
        let plot = plotted(canvas, place, MARGIN, [&x, &y], &series);
        plot.heading(canvas, heading);
        let [_, top, _, bottom] = plot.frame;
        let mut any = values().any(|value| !value.is_nan());
        for (number, (_, points)) in all() {
            let step = 9.0 * number as f64;
            for point in points {
                let at = (plot.at(x_of(point), 0.0).0, bottom - 7.0 - step);
                let Some(one) = self.sweep.assessment(point.index) else {
                    canvas.cross(at, 3.5, series_colour(number), 1.6);
                    canvas.spot(&around(at, 8, &[8.0]), self.describe(point, quantities));
                    continue;
                };
                if lacks_traps(quantities[0], one) {
                    any = true;
                    // Without a trap selectivity is infinite.
                    let is_best = measure == Measure::Ratio;
                    let at = (at.0, if is_best { top + 7.0 + step } else { at.1 });
                    canvas.circle(at, series_colour(number));
                    canvas.spot(&around(at, 8, &[8.0]), self.describe(point, quantities));
                }
                for estimate in quantities.iter().filter_map(|quantity| quantity.of(one)) {
                    let y = plot.at(0.0, estimate.value).1.clamp(top, bottom);
                    canvas.spot(
                        &around((at.0, y), 8, &[8.0]),
                        self.describe(point, quantities),
                    );
                }
            }
        }
        if !any {
            canvas.write(
                SMALL.colour(SOFT),
                "none",
                middle(plot.frame),
                Anchor::Middle,
            );
        }
    }

    /// One figure over two numbers, one cell per point.
    fn map(&self, canvas: &mut Canvas, place: Box4, heading: &str, quantity: &Quantity) {
        let points = || self.series.iter().flat_map(|(_, points)| points);
        let value =
            |point: &SweepPoint| Some(quantity.of(self.sweep.assessment(point.index)?)?.value);
        let finite = points().filter_map(|point| value(point).filter(|it| it.is_finite()));
        let most = finite.fold(f64::MIN_POSITIVE, f64::max);
        let shown = Shown::new(quantity.measure, most);
        let axis = |k: usize, room: f64, least: f64| {
            let (factor, name) = self.numbers[k].shown();
            let values = &self.numbers[k].values;
            let every = (least * values.len() as f64 / room).ceil().max(1.0) as usize;
            let marks = values.iter().enumerate().step_by(every);
            let mark = |(k, value): (usize, &f64)| (k as f64 + 0.5, three_digits(factor * value));
            Axis {
                marks: marks.map(mark).collect(),
                name,
                ..Axis::places(values.len())
            }
        };
        let axes = [
            axis(0, place[2] - place[0] - MAP_MARGIN[1] - MAP_MARGIN[3], 44.0),
            axis(1, place[3] - place[1] - MAP_MARGIN[0] - MAP_MARGIN[2], 20.0),
        ];
        let plot = Plot::new(canvas, place, MAP_MARGIN, axes, false);
        plot.heading(canvas, &shown.named(heading));
        for point in points() {
            let place = |k: usize| {
                let value = self.numbers[k].value(point)?;
                self.numbers[k]
                    .values
                    .iter()
                    .position(|known| *known == value)
            };
            let (Some(i), Some(j)) = (place(0), place(1)) else {
                continue;
            };
            let ((left, bottom), (right, top)) = (
                plot.at(i as f64, j as f64),
                plot.at((i + 1) as f64, (j + 1) as f64),
            );
            let place = [left, top, right, bottom];
            match (self.sweep.assessment(point.index), value(point)) {
                (None, _) => {
                    let r = (0.3 * (right - left).min(bottom - top)).min(7.0);
                    canvas.cross(middle(place), r, SOFT, 1.6);
                }
                (Some(one), None) => {
                    let sign = if lacks_traps(quantity, one) {
                        "\u{25cb}"
                    } else {
                        "\u{2013}"
                    };
                    heat::cell(canvas, place, [GRID.0; 3], sign);
                }
                (_, Some(value)) if value.is_infinite() => {
                    heat::cell(canvas, place, [90; 3], "\u{221e}");
                }
                (_, Some(value)) => {
                    let fill = colour(-0.95 * (value / most).clamp(0.0, 1.0));
                    heat::cell(canvas, place, fill, &three_digits(value / shown.unit));
                }
            }
            canvas.spot(
                &corners(place),
                self.describe(point, &QUANTITIES.iter().collect::<Vec<_>>()),
            );
        }
        canvas.frame(plot.frame, INK);
    }
}

/// Whether a design lacks a figure because it has no trap.
fn lacks_traps(quantity: &Quantity, one: &Assessment) -> bool {
    (quantity.read)(one).err() == Some(NO_TRAPS)
}

/// The axis of a measure.
fn dimension(measure: Measure) -> Dimension {
    match measure {
        Measure::Energy => Dimension::new("_J", "energy"),
        Measure::Length => Dimension::new("_m", "length"),
        Measure::Angle => Dimension::new("_rad", "angle"),
        Measure::Share => Dimension::share("", "far starts"),
        Measure::Ratio => Dimension::new("", "ratio"),
        Measure::Count => Dimension::new("", "number"),
    }
}

/// A number to three significant digits.
fn three_digits(value: f64) -> String {
    minus(&format!("{}", to_digits(value, 3) + 0.0))
}
