//! The colours and text sizes that all pictures share.

use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontDesc, FontFamily, FontStyle, RGBColor, ShapeStyle, TextStyle};
use plotters_backend::BackendCoord;

use super::font::{FAMILY, width};

/// Drawing units per pixel. plotters places everything on whole units; with tenths of a pixel,
/// gentle slopes are smooth.
pub const UNITS: f64 = 10.0;
/// plotters sets text of a given size with a font of the size divided by this.
pub const FONT_SCALE: f64 = 1.24;

pub const INK: RGBColor = RGBColor(34, 34, 34);
pub const SOFT: RGBColor = RGBColor(105, 105, 105);
pub const GRID: RGBColor = RGBColor(228, 228, 228);
pub const FIXED_FILL: RGBColor = RGBColor(205, 208, 212);
pub const MOVING_FILL: RGBColor = RGBColor(247, 233, 200);
/// Okabe and Ito's colours, distinguishable by colour-blind readers.
pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
pub const YELLOW: RGBColor = RGBColor(240, 228, 66);
pub const GREEN: RGBColor = RGBColor(0, 158, 115);

/// The colours of series.
pub const COLOURS: [RGBColor; 7] = [
    BLUE,
    VERMILLION,
    GREEN,
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    INK,
];

/// The colour of a series by its number; beyond the last they repeat.
pub fn series_colour(number: usize) -> RGBColor {
    COLOURS[number % COLOURS.len()]
}

/// Pixels as drawing units.
pub fn unit(pixels: f64) -> i32 {
    (pixels * UNITS).round() as i32
}

/// Points in pixels as drawing units.
pub fn units(points: &[(f64, f64)]) -> Vec<BackendCoord> {
    points.iter().map(|(x, y)| (unit(*x), unit(*y))).collect()
}

/// A line of this width (pixels).
pub fn stroke(colour: impl Color, width: f64) -> ShapeStyle {
    colour.stroke_width(unit(width).max(1) as u32)
}

/// The point of a text that its position refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    TopLeft,
    Top,
    TopRight,
    Left,
    Middle,
    Right,
    BottomLeft,
    Bottom,
    BottomRight,
}

/// The style of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Text {
    /// Pixels.
    pub size: f64,
    pub bold: bool,
    pub colour: RGBColor,
}

pub const TITLE: Text = Text::of(20.0);
pub const LABEL: Text = Text::of(15.0);
pub const SMALL: Text = Text::of(13.0);

impl Text {
    pub const fn of(size: f64) -> Self {
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

    /// For plotters.
    pub fn style(self, anchor: Anchor) -> TextStyle<'static> {
        let weight = match self.bold {
            true => FontStyle::Bold,
            false => FontStyle::Normal,
        };
        let across = [HPos::Left, HPos::Center, HPos::Right][anchor as usize % 3];
        let down = [VPos::Top, VPos::Center, VPos::Bottom][anchor as usize / 3];
        FontDesc::new(
            FontFamily::Name(FAMILY),
            self.size * UNITS * FONT_SCALE,
            weight,
        )
        .color(&self.colour)
        .pos(Pos::new(across, down))
    }

    /// Width of a text (pixels).
    pub fn width(&self, text: &str) -> f64 {
        width(text, self.bold) * self.size
    }

    /// Room for a text (pixels): other fonts can be a tenth wider.
    pub fn room(&self, text: &str) -> f64 {
        1.08 * self.width(text)
    }

    /// The same font, smaller if the text does not fit into this width (pixels).
    pub fn within(self, room: f64, text: &str) -> Self {
        let size = self.size * (room / self.room(text).max(1.0)).min(1.0);
        Self { size, ..self }
    }

    /// Wraps a text to a width (pixels), between words.
    pub fn lines(&self, text: &str, room: f64) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        for word in text.split_whitespace() {
            match lines.last_mut() {
                Some(line) if self.room(&format!("{line} {word}")) <= room => {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => lines.push(word.to_owned()),
            }
        }
        lines
    }
}

/// A number's text with a true minus sign.
pub fn minus(text: &str) -> String {
    text.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_has_the_width_of_its_font() {
        assert_eq!(TITLE.width(""), 0.0);
        // Digits of Noto Sans are 0.572 em wide.
        assert!((TITLE.width("00") - 22.88).abs() < 0.01);
        assert!(TITLE.bold().width("m") > TITLE.width("m"));
    }
}
