//! The figures of a sweep as curves over one varied number, bounds as bands around them.

use plotters::style::text_anchor::{HPos, VPos};

use super::chart::{COLOURS, Look, names_of_series};
use super::composition::{Composition, Panel, part, remark, stacked};
use super::curve::{Curve, Scale, caption, cross, ring, width};
use super::curve_data::{CurvePoint, Group, Variable};
use super::marks::{Box4, polyline};
use super::picture::{Area, PictureError};
use super::style::{Axis, INK, SMALL, SOFT, Text, chart, pixel};
use super::{Figure, Sheet};
use crate::csv::{number, table};
use crate::figures::Shown;
use jobs::comparison::quantity::{Measure, NO_TRAPS, placed};
use jobs::comparison::{Assessment, Estimate, Quantity};

const WIDTH: f64 = 1200.0;
const PANEL_HEIGHT: f64 = 262.0;
/// The least width (pixels) of a panel beside another.
const LEAST: f64 = 320.0;
/// Space around a panel's plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [34.0, 20.0, 58.0, 78.0];
/// Numbers that span more powers of ten stand by their logarithms.
const MOST_DECADES: f64 = 2.0;

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
pub fn draw(
    name: &str,
    group: &Group,
    variable: &Variable,
    sheet: &Sheet,
) -> Result<Figure, PictureError> {
    let panels = placed(|quantity| quantity.panel).into_iter();
    let panels = panels.map(|(place, quantities)| {
        let key = quantities[0].key;
        let panel = CurvePanel {
            heading: place.heading,
            quantities,
            group,
        };
        Panel::new(
            key,
            LEAST,
            |_| PANEL_HEIGHT,
            move |root, _, place| panel.draw(root, place, variable),
        )
    });
    let names = group.series.iter().zip(COLOURS);
    let names = names.map(|(series, colour)| (series.name.clone(), colour, Look::Line));
    let names = names.collect();
    let composition = Composition {
        name: name.to_owned(),
        title: group.title.clone(),
        note: (group.left_out > 0).then(|| format!("{} more series in sweep.csv", group.left_out)),
        width: WIDTH,
        panels: panels.collect(),
        key: Some(stacked(names_of_series(names), remark(SIGNS.to_owned()))),
    };
    Figure::new(&composition, sheet, data(group, variable))
}

/// What the marks mean.
const SIGNS: &str = "bands: certified bounds, 95 % intervals of shares; \u{25cb} no trap; ^ caged, \
    proved; \u{d7} impossible design";

/// Each figure of each point.
fn data(group: &Group, variable: &Variable) -> String {
    let head = [
        "series",
        &variable.shown().1,
        "figure",
        "value",
        "low",
        "high",
    ];
    let points = group.series.iter().flat_map(|series| {
        let points = series.points.iter();
        points.map(move |point| (&series.name, point))
    });
    let rows = points.flat_map(|(series, point)| {
        let at = [series.clone(), number(point.x)];
        numbers(point.result, at)
    });
    table(head, rows)
}

/// The figures of a design as rows of a table, each with its name, value and bounds, after the cells
/// that say where.
pub fn numbers(design: Option<&Assessment>, at: [String; 2]) -> Vec<Vec<String>> {
    let figures = placed(|quantity| quantity.panel).into_iter();
    let figures = figures.flat_map(|(_, quantities)| quantities);
    let row = |quantity: &Quantity| {
        let numbers = quantity.of(design?)?.finite();
        let mut row = at.to_vec();
        row.push(quantity.name(""));
        row.extend(numbers.map(|value| value.map(number).unwrap_or_default()));
        Some(row)
    };
    figures.filter_map(row).collect()
}

impl CurvePanel<'_> {
    fn draw(&self, root: &Area, place: Box4, variable: &Variable) -> Result<(), PictureError> {
        let (low, high) = self.range();
        let shown = Shown::new(self.measure(), low.abs().max(high.abs()));
        let (unit, name) = (shown.unit, shown.axis());
        let x = variable.axis();
        let (scale, y, [low, high]) = match self.decades(unit) {
            Some(powers @ [low, high]) => {
                let y = Axis::decades(low..high, name);
                let ends = powers.map(|power| unit * libm::pow(10f64, power));
                (Scale::Decades { unit, low }, y, ends)
            }
            None => {
                let y = Axis::linear(low / unit..high / unit, 5, name);
                (Scale::Linear { unit }, y, [low, high])
            }
        };
        let area = part(root, place);
        let chart = chart(&area, MARGIN, &x, &y, true)?;
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
                let x = pixel(&chart, point.x, y.range.start).0;
                let step = 9.0 * number as f64;
                if point.result.is_none() {
                    cross(root, (x, bottom - 7.0 - step), 3.5, colour)?;
                }
                if self.has_no_trap(point) {
                    any = true;
                    // Without a trap nothing competes: selectivity is beyond any scale.
                    let best = self.measure() == Measure::Ratio;
                    let y = if best {
                        top + 7.0 + step
                    } else {
                        bottom - 7.0 - step
                    };
                    ring(root, (x, y), colour)?;
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

    /// Whether a point has no figure for want of a trap.
    fn has_no_trap(&self, point: &CurvePoint) -> bool {
        let read = |design| (self.quantities[0].read)(design);
        point
            .result
            .is_some_and(|design| read(design).err() == Some(NO_TRAPS))
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

    /// The range of ratios or energies that span several powers of ten, as decimal logarithms of
    /// multiples of a unit.
    fn decades(&self, unit: f64) -> Option<[f64; 2]> {
        let scales = [Measure::Ratio, Measure::Energy].contains(&self.measure());
        let powers = self.estimates().map(|e| libm::log10(e.value / unit));
        let powers: Vec<f64> = powers.filter(|power| power.is_finite()).collect();
        let low = powers.iter().copied().fold(f64::INFINITY, f64::min);
        let high = powers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let wide = scales && high - low > MOST_DECADES && self.range().0 >= 0.0;
        wide.then_some([low - 0.2, high + 0.2])
    }
}

/// The least and the greatest of some numbers and zero.
fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((0.0, 0.0), |(low, high), value| {
        (f64::min(low, value), f64::max(high, value))
    })
}
