//! What all pictures have in common: colours, text, axes.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, ValueFormatter};
use plotters::prelude::*;
use plotters::style::FontFamily;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::canvas::Canvas;
use super::picture::{Area, PictureError, UNITS};
use super::scale::{minus, round_step};
use super::shapes::{PLOTTERS_FONT_SCALE, text_width};

pub const INK: RGBColor = RGBColor(34, 34, 34);
pub const SOFT: RGBColor = RGBColor(105, 105, 105);
pub const GRID: RGBColor = RGBColor(228, 228, 228);
pub const FIXED_FILL: RGBColor = RGBColor(205, 208, 212);
pub const MOVING_FILL: RGBColor = RGBColor(247, 233, 200);
/// Okabe and Ito's colours, told apart by colour-blind readers.
pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
pub const YELLOW: RGBColor = RGBColor(240, 228, 66);
pub const GREEN: RGBColor = RGBColor(0, 158, 115);

/// Fonts of about the width that labels are laid out for, the last of them any browser's own.
pub const FAMILY: &str = "Noto Sans, Helvetica, Arial, sans-serif";
/// Sizes of text (pixels).
pub const TITLE: f64 = 20.0;
pub const LABEL: f64 = 15.0;
pub const SMALL: f64 = 13.0;
/// Space left of and below the names of axes (pixels).
const EDGE: f64 = 12.0;

/// Pixels as drawing units.
pub fn units(pixels: f64) -> i32 {
    (pixels * f64::from(UNITS)).round() as i32
}

/// A point in pixels as drawing units.
pub fn point((x, y): (f64, f64)) -> (i32, i32) {
    (units(x), units(y))
}

/// A line of this width (pixels).
pub fn line(colour: impl Color, width: f64) -> ShapeStyle {
    colour.stroke_width(units(width).max(1) as u32)
}

/// Text of this size (pixels).
#[derive(Clone, Copy, Debug)]
pub struct Text {
    pub size: f64,
    pub bold: bool,
    pub colour: RGBColor,
}

impl Text {
    pub const fn new(size: f64) -> Self {
        Self {
            size,
            bold: false,
            colour: INK,
        }
    }

    pub const fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    pub const fn colour(self, colour: RGBColor) -> Self {
        Self { colour, ..self }
    }

    /// Width of a text (pixels). Other fonts may be a tenth wider.
    pub fn width(&self, text: &str) -> f64 {
        text_width(text, self.bold) * self.size
    }

    pub fn style(&self, horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
        let size = self.size * f64::from(UNITS) * PLOTTERS_FONT_SCALE;
        let weight = if self.bold {
            FontStyle::Bold
        } else {
            FontStyle::Normal
        };
        FontDesc::new(FontFamily::Name(FAMILY), size, weight)
            .color(&self.colour)
            .pos(Pos::new(horizontal, vertical))
    }

    /// Writes `text` at a point (pixels).
    pub fn write(
        &self,
        root: &Area,
        text: &str,
        at: (f64, f64),
        (horizontal, vertical): (HPos, VPos),
    ) -> Result<(), PictureError> {
        let style = self.style(horizontal, vertical);
        root.draw(&plotters::element::Text::new(
            text.to_owned(),
            point(at),
            style,
        ))?;
        Ok(())
    }
}

/// One axis of a chart: its range, the ticks with their labels, and what is plotted.
#[derive(Clone, Debug)]
pub struct Axis {
    pub range: Range<f64>,
    pub ticks: Vec<(f64, String)>,
    pub name: String,
}

impl Axis {
    /// An axis with about `count` evenly spaced ticks at round numbers.
    pub fn linear(range: Range<f64>, count: usize, name: impl Into<String>) -> Self {
        let step = round_step((range.end - range.start) / count as f64);
        let decimals = (-libm::log10(step).floor()).max(0.0) as usize;
        let (first, last) = (
            (range.start / step - 1e-9).ceil() as i64,
            (range.end / step + 1e-9).floor() as i64,
        );
        let ticks = (first..=last)
            .map(|k| {
                let value = k as f64 * step;
                (value, minus(&format!("{value:.decimals$}")))
            })
            .collect();
        Self {
            range,
            ticks,
            name: name.into(),
        }
    }

    /// An axis of decimal logarithms with a tick at each power of ten, marked by that power.
    pub fn decades(range: Range<f64>, name: impl Into<String>) -> Self {
        let ticks = (range.start.ceil() as i32..=range.end.floor() as i32)
            .map(|power| (f64::from(power), format!("{}", 10f64.powi(power))))
            .collect();
        Self {
            range,
            ticks,
            name: name.into(),
        }
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (low, high): (i32, i32)) -> i32 {
        let t = (value - self.range.start) / (self.range.end - self.range.start);
        low + (t * f64::from(high - low)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.ticks.iter().map(|(value, _)| *value).collect()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

impl ValueFormatter<f64> for Axis {
    fn format(value: &f64) -> String {
        value.to_string()
    }

    fn format_ext(&self, value: &f64) -> String {
        let tick = self.ticks.iter().find(|(tick, _)| tick == value);
        tick.map_or_else(String::new, |(_, label)| label.clone())
    }
}

pub type Chart<'a, 'b> = ChartContext<'a, Canvas<'b>, Cartesian2d<Axis, Axis>>;

/// A chart with its axes, filling `area` but for the margins (pixels: top, right, bottom, left),
/// which hold the tick labels and names of the axes as well.
pub fn chart<'a, 'b>(
    area: &'a Area<'b>,
    [top, right, bottom, left]: [f64; 4],
    x: &Axis,
    y: &Axis,
    mesh: bool,
) -> Result<Chart<'a, 'b>, PictureError> {
    let mut chart = ChartBuilder::on(area)
        .margin_top(units(top))
        .margin_right(units(right))
        .margin_left(units(EDGE))
        .margin_bottom(units(EDGE))
        .x_label_area_size(units(bottom - EDGE))
        .y_label_area_size(units(left - EDGE))
        .build_cartesian_2d(x.clone(), y.clone())?;
    let text = Text::new(LABEL);
    let small = Text::new(SMALL);
    let mut style = chart.configure_mesh();
    if !mesh {
        style.disable_mesh();
    }
    style
        .light_line_style(TRANSPARENT)
        .bold_line_style(line(GRID, 1.0))
        .axis_style(line(INK, 1.0))
        .set_all_tick_mark_size(units(5.0))
        .x_label_style(small.style(HPos::Center, VPos::Top))
        .y_label_style(small.style(HPos::Right, VPos::Center))
        .axis_desc_style(text.style(HPos::Center, VPos::Top))
        .x_desc(x.name.clone())
        .y_desc(y.name.clone())
        .draw()?;
    Ok(chart)
}

/// Where a point of a chart lies on the picture (pixels).
pub fn pixel(chart: &Chart, x: f64, y: f64) -> (f64, f64) {
    let (x, y) = chart.backend_coord(&(x, y));
    (
        f64::from(x) / f64::from(UNITS),
        f64::from(y) / f64::from(UNITS),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        let labels = |axis: Axis| -> Vec<String> {
            axis.ticks.into_iter().map(|(_, label)| label).collect()
        };
        let wide = labels(Axis::linear(-0.73..0.73, 7, "x (m)"));
        assert_eq!(wide, ["\u{2212}0.5", "0.0", "0.5"]);
        let gaps = labels(Axis::linear(0.0..86.0, 9, "gap (mm)"));
        assert_eq!(gaps[..3], ["0", "10", "20"]);
        assert_eq!(gaps.len(), 9);
    }

    #[test]
    fn text_has_the_width_of_its_font() {
        let text = Text::new(20.0);
        assert_eq!(text.width(""), 0.0);
        // Digits of Noto Sans are 0.572 em wide.
        assert!((text.width("00") - 22.88).abs() < 0.01);
        assert!(text.bold().width("m") > text.width("m"));
    }
}
