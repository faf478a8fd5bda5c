//! What all pictures have in common: colours and sizes of text.

use super::font::width;

/// A colour, which may let through what lies beneath.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colour {
    pub rgb: [u8; 3],
    pub opacity: f64,
}

impl Colour {
    pub const fn new(red: u8, green: u8, blue: u8) -> Self {
        Self {
            rgb: [red, green, blue],
            opacity: 1.0,
        }
    }

    pub const fn faint(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

pub const INK: Colour = Colour::new(34, 34, 34);
pub const SOFT: Colour = Colour::new(105, 105, 105);
pub const GRID: Colour = Colour::new(228, 228, 228);
pub const WHITE: Colour = Colour::new(255, 255, 255);
pub const FIXED_FILL: Colour = Colour::new(205, 208, 212);
pub const MOVING_FILL: Colour = Colour::new(247, 233, 200);
/// Okabe and Ito's colours, told apart by colour-blind readers.
pub const VERMILLION: Colour = Colour::new(213, 94, 0);
pub const BLUE: Colour = Colour::new(0, 114, 178);
pub const YELLOW: Colour = Colour::new(240, 228, 66);
pub const GREEN: Colour = Colour::new(0, 158, 115);

/// The colours of series.
pub const COLOURS: [Colour; 7] = [
    BLUE,
    VERMILLION,
    GREEN,
    Colour::new(204, 121, 167),
    Colour::new(230, 159, 0),
    Colour::new(86, 180, 233),
    INK,
];

/// How a text looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Text {
    /// Pixels.
    pub size: f64,
    pub bold: bool,
    pub colour: Colour,
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

    pub const fn colour(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }

    /// Width of a text (pixels).
    pub fn width(&self, text: &str) -> f64 {
        width(text, self.bold) * self.size
    }

    /// Room for a text (pixels): other fonts may be a tenth wider.
    pub fn room(&self, text: &str) -> f64 {
        1.08 * self.width(text)
    }

    /// A text in lines that fit into so many pixels, as far as its words do.
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
