//! Axes, and the positions of values on them.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::element::{Drawable, PointCollection};
use plotters::prelude::{Cartesian2d, ChartBuilder, ChartContext, TRANSPARENT};

use super::canvas::{Box4, Canvas, Pixel};
use super::recorder::Recorder;
use super::scale::{EnergyScale, round_numbers};
use super::style::{Anchor, GRID, INK, LABEL, SMALL, UNITS, minus, stroke, unit};
use physics::units::prefix_of;

/// Space left of and below the names of axes (pixels).
const EDGE: f64 = 12.0;

/// The spacing of values along an axis.
#[derive(Clone, Copy, Debug)]
pub enum Spacing {
    /// As multiples of a unit.
    Even(f64),
    /// By the decimal logarithms of values plus this offset.
    Logarithms(f64),
    /// By a scale of energies.
    Energies(EnergyScale),
}

impl Spacing {
    /// The position of a value on an unbounded axis.
    pub fn of(self, value: f64) -> f64 {
        match self {
            Self::Even(unit) => value / unit,
            Self::Logarithms(offset) => libm::log10(value + offset),
            Self::Energies(scale) => scale.position(value),
        }
    }
}

/// One axis: its range, the marked values with their texts, and its name.
#[derive(Clone, Debug)]
pub struct Axis {
    pub spacing: Spacing,
    /// The ends, in the spacing of the axis.
    pub ends: [f64; 2],
    /// Positions of marks, in the spacing of the axis.
    pub marks: Vec<(f64, String)>,
    pub name: String,
}

impl Axis {
    /// An axis of multiples of a unit with about `count` marks at round numbers. A range of zero
    /// width is widened around its value until marks can be distinguished.
    pub fn even(range: [f64; 2], unit: f64, count: usize, name: impl Into<String>) -> Self {
        let ends = widened(range.map(|end| end / unit));
        let numbers = round_numbers(ends, count + 1);
        let steps = numbers.windows(2).map(|pair| pair[1] - pair[0]);
        let step = steps.fold(ends[1] - ends[0], f64::min);
        let decimals = (-(libm::log10(step) + 1e-9).floor()).max(0.0) as usize;
        let mark = |value| (value, minus(&format!("{value:.decimals$}")));
        Self {
            spacing: Spacing::Even(unit),
            ends,
            marks: numbers.into_iter().map(mark).collect(),
            name: name.into(),
        }
    }

    /// An axis of a quantity in the SI unit `symbol`, with the prefix that suits its size.
    pub fn quantity(range: [f64; 2], symbol: &str, count: usize, name: &str) -> Self {
        // Just below a power of a thousand still counts as the smaller unit: 1000 mm, not 1 m.
        let (unit, prefix) = prefix_of(0.999 * range[0].abs().max(range[1].abs()));
        Self::even(range, unit, count, format!("{name} ({prefix}{symbol})"))
    }

    /// An axis of indices without marks.
    pub fn places(count: usize) -> Self {
        Self {
            spacing: Spacing::Even(1.0),
            ends: [0.0, count as f64],
            marks: Vec::new(),
            name: String::new(),
        }
    }

    /// In the form of plotters.
    fn spaced(&self) -> RangedCoordf64 {
        (self.ends[0]..self.ends[1]).into()
    }
}

/// Larger numbers are clamped to this, so that the width of an axis is finite.
const FARTHEST: f64 = 1e300;

/// A range of non-zero width, from one whose ends may be equal or undefined.
fn widened(range: [f64; 2]) -> [f64; 2] {
    let [low, high] = range.map(|end| match end.is_nan() {
        true => 0.0,
        false => end.clamp(-FARTHEST, FARTHEST),
    });
    let size = low.abs().max(high.abs());
    match high - low > 1e-9 * size {
        true => [low, high],
        false => {
            let half = if size > 1.0 / FARTHEST {
                0.1 * size
            } else {
                0.5
            };
            [low - half, low + half]
        }
    }
}

/// Values along the axis are in its spacing.
impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, place: &f64, limit: (i32, i32)) -> i32 {
        self.spaced().map(place, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        let room = 1e-9 * (self.ends[1] - self.ends[0]);
        let within = self.ends[0] - room..=self.ends[1] + room;
        let places = self.marks.iter().map(|mark| mark.0);
        places.filter(|place| within.contains(place)).collect()
    }

    fn range(&self) -> Range<f64> {
        self.spaced().range()
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, place: &f64) -> String {
        let mark = self.marks.iter().find(|mark| mark.0 == *place);
        mark.map_or_else(String::new, |(_, text)| text.clone())
    }
}

/// A rectangle between axes.
pub struct Plot {
    /// Pixels.
    pub frame: Box4,
    spacing: [Spacing; 2],
    chart: ChartContext<'static, Recorder, Cartesian2d<Axis, Axis>>,
}

impl Plot {
    /// Draws axes within a rectangle minus the margins (pixels: top, right, bottom, left), which
    /// contain the texts of marks and the names of axes; with or without a grid.
    pub fn new(
        canvas: &mut Canvas,
        [left, top, right, bottom]: Box4,
        margin: [f64; 4],
        [x, y]: [Axis; 2],
        grid: bool,
    ) -> Self {
        let spacing = [x.spacing, y.spacing];
        let names = [x.name.clone(), y.name.clone()];
        let area = canvas.root.clone().shrink(
            (unit(left), unit(top)),
            (unit(right - left), unit(bottom - top)),
        );
        let [wide, high] = [
            right - left - margin[1] - margin[3],
            bottom - top - margin[0] - margin[2],
        ];
        // Both names are of one size.
        let named = LABEL.within(wide, &names[0]).within(high, &names[1]);
        let [edge, foot] = [margin[3], margin[2]].map(|wide| wide.min(EDGE));
        let built = ChartBuilder::on(&area)
            .margin_top(unit(margin[0]))
            .margin_right(unit(margin[1]))
            .margin_bottom(unit(foot))
            .margin_left(unit(edge))
            .x_label_area_size(unit(margin[2] - foot))
            .y_label_area_size(unit(margin[3] - edge))
            .build_cartesian_2d(x, y);
        let mut chart = built.expect("without a title nothing is drawn that could fail");
        let mut mesh = chart.configure_mesh();
        if !grid {
            mesh.disable_mesh();
        }
        let drawn = mesh
            .light_line_style(TRANSPARENT)
            .bold_line_style(stroke(GRID, 1.0))
            .axis_style(stroke(INK, 1.0))
            .set_all_tick_mark_size(unit(5.0))
            .label_style(SMALL.style(Anchor::Middle))
            .axis_desc_style(named.style(Anchor::Middle))
            .x_desc(&names[0])
            .y_desc(&names[1])
            .draw();
        canvas.done(drawn);
        let area = chart.plotting_area();
        let [across, up] = [area.get_x_axis_pixel_range(), area.get_y_axis_pixel_range()];
        let frame = [across.start, up.start, across.end, up.end];
        Self {
            frame: frame.map(|end| f64::from(end) / UNITS),
            spacing,
            chart,
        }
    }

    /// A point in the spacing of the axes, as used by series.
    pub fn place(&self, x: f64, y: f64) -> (f64, f64) {
        (self.spacing[0].of(x), self.spacing[1].of(y))
    }

    /// The position of a point (pixels).
    pub fn at(&self, x: f64, y: f64) -> Pixel {
        let (x, y) = self.chart.backend_coord(&self.place(x, y));
        (f64::from(x) / UNITS, f64::from(y) / UNITS)
    }

    /// Draws a series, within the plot.
    pub fn series<E, S: IntoIterator<Item = E>>(&mut self, canvas: &mut Canvas, series: S)
    where
        for<'b> &'b E: PointCollection<'b, (f64, f64)>,
        E: Drawable<Recorder>,
    {
        let drawn = self.chart.draw_series(series).map(drop);
        canvas.done(drawn);
    }

    /// A level line across the plot.
    pub fn level(&self, y: f64) -> [Pixel; 2] {
        let [left, _, right, _] = self.frame;
        let y = self.at(0.0, y).1;
        [(left, y), (right, y)]
    }

    /// Draws a heading above the plot.
    pub fn heading(&self, canvas: &mut Canvas, text: &str) {
        let [left, top, right, _] = self.frame;
        let font = LABEL.bold().within(right - left, text);
        canvas.write(font, text, (left, top - 8.0), Anchor::BottomLeft);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_always_has_a_width() {
        for range in [
            [0.0, 0.0],
            [0.5, 0.5],
            [-3e-9, -3e-9],
            [0.5, 0.5 + f64::EPSILON],
            [1.0, 0.0],
            [5e-324, 5e-324],
            [-f64::MAX, f64::MAX],
            [f64::MAX, f64::MAX],
            [f64::NEG_INFINITY, f64::INFINITY],
            [f64::NAN, 1.0],
            [f64::NAN, f64::NAN],
        ] {
            for unit in [1.0, 1e-3, 1e3] {
                let Axis { ends, marks, .. } = Axis::even(range, unit, 7, "x");
                assert!(ends[1] > ends[0], "{range:?}: {ends:?}");
                assert!((ends[1] - ends[0]).is_finite(), "{range:?}: {ends:?}");
                assert!(marks.len() < 30, "{range:?}: {marks:?}");
            }
            Axis::quantity(range, "m", 7, "x");
        }
    }

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        let labels = |axis: Axis| -> Vec<String> {
            axis.marks.into_iter().map(|(_, label)| label).collect()
        };
        let wide = labels(Axis::even([-0.73, 0.73], 1.0, 7, "x (m)"));
        assert_eq!(
            wide[..4],
            ["\u{2212}0.6", "\u{2212}0.4", "\u{2212}0.2", "0.0"]
        );
        assert_eq!(wide.len(), 7);
        let gaps = labels(Axis::even([0.0, 86.0], 1.0, 9, "gap (mm)"));
        assert_eq!(gaps[..3], ["0", "10", "20"]);
        assert_eq!(gaps.len(), 9);
    }
}
