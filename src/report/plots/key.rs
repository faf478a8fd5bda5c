//! What marks and colours mean.

use plotters::prelude::RGBColor;
use plotters::style::text_anchor::{HPos, VPos};

use super::composition::Panel;
use super::heat::Range;
use super::marks::{Mark, Pixel, marker, outline, polygon, polyline, seamed_line};
use super::picture::{Area, PictureError, Underlay};
use super::style::{BLUE, INK, SMALL, SOFT, Text, VERMILLION, units};

/// Space left and right of a bar of colours and of a key (pixels).
pub const BAR_SIDES: (f64, f64) = (84.0, 24.0);

/// Columns of a key at a width (pixels).
fn columns(width: f64) -> usize {
    (((width - BAR_SIDES.0) / 170.0) as usize).clamp(1, 4)
}

/// An entry of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Key {
    Mark(Mark),
    Pathway,
    Blocked,
    Colour(RGBColor),
    Line(RGBColor),
    Start,
}

pub const STATE_KEYS: [(Key, &str); 2] = [
    (Key::Mark(Mark::Bond), "bond"),
    (Key::Mark(Mark::Trap), "trap"),
];
pub const POLE_KEYS: [(Key, &str); 2] = [
    (Key::Colour(VERMILLION), "north pole"),
    (Key::Colour(BLUE), "south pole"),
];

/// Height of an entry of a key (pixels).
const ENTRY: f64 = 25.0;

/// The square at which a path starts.
pub fn start(root: &Area, (x, y): Pixel, colour: RGBColor) -> Result<(), PictureError> {
    let square = [(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)];
    polygon(root, &square.map(|(dx, dy)| (x + dx, y + dy)), colour, None)
}

/// What marks mean, in columns.
pub fn key_table(entries: Vec<(Key, &'static str)>) -> Panel<'static> {
    let rows = {
        let count = entries.len();
        move |width: f64| count.div_ceil(columns(width))
    };
    let height = move |width| ENTRY * rows(width) as f64 + 12.0;
    Panel::new(
        "",
        0.0,
        height,
        move |root, underlays, [left, top, right, _]| {
            let width = right - left;
            let step = (width - BAR_SIDES.0) / columns(width) as f64;
            for (k, column) in entries.chunks(rows(width)).enumerate() {
                let at = (left + BAR_SIDES.0 + step * k as f64, top + 12.0);
                keys(root, underlays, at, column)?;
            }
            Ok(())
        },
    )
}

/// Explains marks in one row at the right of a picture.
pub fn key_row(entries: Vec<(Key, &'static str)>) -> Panel<'static> {
    Panel::new(
        "",
        0.0,
        |_| 34.0,
        move |root, underlays, [_, top, right, _]| {
            let mut x = right - 20.0;
            for entry in entries.iter().rev() {
                x -= 32.0 + 1.08 * Text::new(SMALL).width(entry.1) + 12.0;
                keys(root, underlays, (x, top + 14.0), &[*entry])?;
            }
            Ok(())
        },
    )
}

/// Explains marks, one below the other.
pub fn keys(
    root: &Area,
    underlays: &mut Vec<Underlay>,
    (left, top): Pixel,
    entries: &[(Key, &str)],
) -> Result<(), PictureError> {
    let mut y = top;
    for (key, text) in entries {
        let (a, b) = (left, left + 22.0);
        match key {
            Key::Mark(mark) => marker(root, *mark, (left + 11.0, y), 7.0)?,
            Key::Pathway => seamed_line(root, &[(a, y), (b, y)], INK, 1.8)?,
            Key::Start => start(root, (left + 11.0, y), SOFT)?,
            Key::Line(colour) => polyline(root, &[(a, y), (b, y)], *colour, 2.4)?,
            Key::Blocked => {
                let place = [a, y - 8.0, b, y + 8.0];
                let range = Range {
                    low: -1.0,
                    high: 1.0,
                };
                underlays.push(Underlay {
                    bitmap: range.bitmap((16, 12), |_, _| None),
                    rectangle: place.map(units),
                });
                outline(root, place, INK)?;
            }
            Key::Colour(colour) => {
                let block = [(5.0, -6.0), (17.0, -6.0), (17.0, 6.0), (5.0, 6.0)]
                    .map(|(dx, dy)| (left + dx, y + dy));
                polygon(root, &block, colour, None)?;
            }
        }
        Text::new(SMALL).write(root, text, (left + 32.0, y), (HPos::Left, VPos::Center))?;
        y += ENTRY;
    }
    Ok(())
}
