//! The legend of marks, lines and colours.

use plotters::style::RGBColor;

use super::canvas::{Canvas, Pixel};
use super::composition::Panel;
use super::heat;
use super::marks::{Mark, marker};
use super::style::{Anchor, BLUE, INK, SMALL, SOFT, VERMILLION};

/// A sign in a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sign {
    Mark(Mark),
    Pathway,
    Blocked,
    Block(RGBColor),
    Line(RGBColor),
    /// With the lengths of dashes and of the gaps between them (pixels).
    Dashed(RGBColor, [f64; 2]),
    Dot(RGBColor),
    Circle(RGBColor),
    Start,
}

/// Signs and their meanings.
pub type Meanings = Vec<(Sign, String)>;

/// The signs of states.
pub const STATES: [(Sign, &str); 2] = [
    (Sign::Mark(Mark::Bond), "bond"),
    (Sign::Mark(Mark::Trap), "trap"),
];
/// The signs of magnets.
pub const POLES: [(Sign, &str); 2] = [
    (Sign::Block(VERMILLION), "north pole"),
    (Sign::Block(BLUE), "south pole"),
];

/// Space left of a key, the width of a sign and the space right of a meaning, and the height of a
/// line (pixels).
const LEFT: f64 = 22.0;
const SIGN: f64 = 31.0;
const GAP: f64 = 22.0;
const LINE: f64 = 25.0;

/// The square at the start of a path.
pub fn start(canvas: &mut Canvas, (x, y): Pixel, colour: RGBColor) {
    canvas.block([x - 3.0, y - 3.0, x + 3.0, y + 3.0], colour);
}

impl Sign {
    /// Draws it to the right of a position.
    fn draw(self, canvas: &mut Canvas, (x, y): Pixel) {
        let (line, middle) = ([(x, y), (x + 24.0, y)], (x + 12.0, y));
        let block = [x + 4.0, y - 7.0, x + 20.0, y + 7.0];
        match self {
            Self::Mark(mark) => marker(canvas, mark, middle, 7.0),
            Self::Pathway => canvas.seamed(&line, INK, 1.8),
            Self::Start => start(canvas, middle, SOFT),
            Self::Line(colour) => canvas.line(&line, colour, 2.4),
            Self::Dashed(colour, dashes) => canvas.dashed(&line, colour, dashes),
            Self::Dot(colour) => canvas.disc(middle, colour),
            Self::Circle(colour) => canvas.circle(middle, colour),
            Self::Block(colour) => canvas.block(block, colour),
            Self::Blocked => {
                let hatched = heat::shaded([14, 12], heat::HATCH, |_| [255; 3], |_, _| None);
                canvas.image(hatched, block);
                canvas.frame(block, INK);
            }
        }
    }
}

/// A key of signs, wrapped to lines.
pub fn key<'a, T: Into<String>>(meanings: impl IntoIterator<Item = (Sign, T)>) -> Panel<'a> {
    let meanings = meanings.into_iter().map(|(sign, text)| (sign, text.into()));
    let meanings: Meanings = meanings.collect();
    let texts: Vec<f64> = meanings.iter().map(|(_, text)| SMALL.room(text)).collect();
    let places = move |width: f64| -> Vec<Pixel> {
        let (mut x, mut y) = (LEFT, 14.0);
        let place = |text: &f64| {
            let wide = SIGN + text + GAP;
            if x > LEFT && x + wide > width {
                (x, y) = (LEFT, y + LINE);
            }
            x += wide;
            (x - wide, y)
        };
        texts.iter().map(place).collect()
    };
    let placed = places.clone();
    let height = move |width| placed(width).last().map_or(0.0, |(_, y)| y + 14.0);
    Panel::alone(height, move |canvas, [left, top, right, _]| {
        for ((sign, text), (x, y)) in meanings.iter().zip(places(right - left)) {
            let at = (left + x, top + y);
            sign.draw(canvas, at);
            canvas.note(text, (at.0 + SIGN, at.1), Anchor::Left);
        }
    })
}
