//! What pictures are drawn on: lines, areas, texts and images, one over the other, in pixels.

use tiny_skia::{Path, PathBuilder, Transform};

use super::font;
use super::style::{Colour, INK, SMALL, Text, WHITE};

/// A point (pixels).
pub type Pixel = (f64, f64);
/// A rectangle (pixels): left, top, right, bottom.
pub type Box4 = [f64; 4];

/// What is drawn; tenths of a pixel keep gentle slopes smooth.
#[derive(Clone, Debug)]
pub enum Shape {
    Line(Vec<Pixel>, Colour, f64),
    Area(Vec<Pixel>, Colour),
    Words(Words),
    Image(Bitmap, Box4),
    Spot(Vec<Pixel>, Spot),
}

/// What an SVG document tells of a place under the pointer, and what a page knows that place by.
#[derive(Clone, Debug)]
pub struct Spot {
    pub title: String,
    /// Of what it is, such as `state`.
    pub kind: &'static str,
    pub value: String,
}

/// A text at a place.
#[derive(Clone, Debug)]
pub struct Words {
    pub text: String,
    pub font: Text,
    pub at: Pixel,
    pub anchor: Anchor,
    /// Turned, to be read from below.
    pub upwards: bool,
}

/// Which point of a text is named by its place.
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

impl Anchor {
    /// Left, middle or right; top, middle or bottom.
    pub fn place(self) -> (usize, usize) {
        (self as usize % 3, self as usize / 3)
    }
}

/// An image with a palette, its first row at the top.
#[derive(Clone, Debug)]
pub struct Bitmap {
    pub width: usize,
    pub palette: Vec<[u8; 3]>,
    /// One palette index a pixel.
    pub pixels: Vec<u8>,
}

/// A picture in the making.
#[derive(Clone, Debug, Default)]
pub struct Canvas {
    pub shapes: Vec<Shape>,
}

fn apart(a: Pixel, b: Pixel) -> f64 {
    libm::hypot(a.0 - b.0, a.1 - b.1)
}

fn tenths((x, y): Pixel) -> Pixel {
    ((10.0 * x).round() / 10.0, (10.0 * y).round() / 10.0)
}

/// The corners of a rectangle.
pub fn corners([left, top, right, bottom]: Box4) -> [Pixel; 4] {
    [(left, top), (right, top), (right, bottom), (left, bottom)]
}

/// The middle of a rectangle.
pub fn middle([left, top, right, bottom]: Box4) -> Pixel {
    ((left + right) / 2.0, (top + bottom) / 2.0)
}

/// So many points around a place, the first one above it, at radii (pixels) that repeat.
pub fn around((x, y): Pixel, count: usize, radii: &[f64]) -> Vec<Pixel> {
    let point = |(k, radius): (usize, &f64)| {
        let (sin, cos) = libm::sincos(k as f64 * std::f64::consts::TAU / count as f64);
        (x + radius * sin, y - radius * cos)
    };
    (0..count).zip(radii.iter().cycle()).map(point).collect()
}

impl Words {
    fn path(&self) -> Option<(Path, Transform)> {
        let (path, ex) = font::outline(&self.text, self.font.bold)?;
        let (across, down) = self.anchor.place();
        let left = -0.5 * across as f64 * font::width(&self.text, self.font.bold);
        let foot = [0.76, 0.5 * ex, -0.5 * ex][down];
        let size = self.font.size as f32;
        let turn = if self.upwards { 270.0 } else { 0.0 };
        let transform = Transform::from_translate(self.at.0 as f32, self.at.1 as f32)
            .pre_concat(Transform::from_rotate(turn))
            .pre_scale(size, size)
            .pre_translate(left as f32, foot as f32);
        Some((path, transform))
    }
}

impl Shape {
    /// Its path and what takes that to its place; an image has none.
    pub fn path(&self) -> Option<(Path, Transform)> {
        let (points, is_closed) = match self {
            Self::Line(points, ..) => (points, false),
            Self::Area(corners, _) => (corners, true),
            Self::Words(words) => return words.path(),
            Self::Image(..) | Self::Spot(..) => return None,
        };
        let mut builder = PathBuilder::new();
        for (k, (x, y)) in points.iter().enumerate() {
            match k {
                0 => builder.move_to(*x as f32, *y as f32),
                _ => builder.line_to(*x as f32, *y as f32),
            }
        }
        if is_closed {
            builder.close();
        }
        Some((builder.finish()?, Transform::identity()))
    }
}

impl Canvas {
    /// A line of this width (pixels) through points.
    pub fn line(&mut self, points: &[Pixel], colour: Colour, width: f64) {
        let Some((last, rest)) = points.split_last() else {
            return;
        };
        // Points too close together to be seen apart only make the file longer.
        let mut kept: Vec<Pixel> = Vec::new();
        for point in rest {
            if kept.last().is_none_or(|known| apart(*known, *point) > 0.5) {
                kept.push(*point);
            }
        }
        kept.push(*last);
        if kept.len() > 1 {
            let points = kept.into_iter().map(tenths).collect();
            self.shapes.push(Shape::Line(points, colour, width));
        }
    }

    /// A line with a white seam that sets it off from any ground.
    pub fn seamed(&mut self, points: &[Pixel], colour: Colour, width: f64) {
        self.line(points, WHITE.faint(0.8), width + 2.4);
        self.line(points, colour, width);
    }

    /// A dashed line.
    pub fn dashed(&mut self, points: &[Pixel], colour: Colour) {
        const DASH: f64 = 6.0;
        let mut behind = 0.0;
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let length = apart(a, b);
            let along = |s: f64| {
                let t = (s - behind) / length;
                (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1))
            };
            // Dashes go on around corners: every other stretch of the whole line is drawn.
            for k in (behind / DASH) as usize..=((behind + length) / DASH) as usize {
                let from = (k as f64 * DASH).max(behind);
                let to = ((k + 1) as f64 * DASH).min(behind + length);
                if k % 2 == 0 && to > from {
                    self.line(&[along(from), along(to)], colour, 2.0);
                }
            }
            behind += length;
        }
    }

    /// A closed line.
    pub fn ring(&mut self, corners: &[Pixel], colour: Colour, width: f64) {
        let closed: Vec<Pixel> = corners.iter().chain(corners.first()).copied().collect();
        self.line(&closed, colour, width);
    }

    /// A filled polygon.
    pub fn area(&mut self, corners: &[Pixel], fill: Colour) {
        let corners = corners.iter().copied().map(tenths).collect();
        self.shapes.push(Shape::Area(corners, fill));
    }

    /// A filled polygon with a dark outline.
    pub fn outlined(&mut self, corners: &[Pixel], fill: Colour) {
        self.area(corners, fill);
        self.ring(corners, INK, 1.2);
    }

    /// A filled rectangle.
    pub fn block(&mut self, place: Box4, fill: Colour) {
        self.area(&corners(place), fill);
    }

    /// The outline of a rectangle.
    pub fn frame(&mut self, place: Box4, colour: Colour) {
        self.ring(&corners(place), colour, 1.0);
    }

    /// A small disc with a white rim.
    pub fn disc(&mut self, at: Pixel, colour: Colour) {
        self.area(&around(at, 24, &[4.2]), WHITE);
        self.area(&around(at, 24, &[3.2]), colour);
    }

    /// A small circle, for what is none.
    pub fn circle(&mut self, at: Pixel, colour: Colour) {
        self.ring(&around(at, 20, &[4.2]), colour, 1.8);
    }

    /// A cross of half the width `r` (pixels) in lines of a width.
    pub fn cross(&mut self, (x, y): Pixel, r: f64, colour: Colour, width: f64) {
        self.line(&[(x - r, y - r), (x + r, y + r)], colour, width);
        self.line(&[(x - r, y + r), (x + r, y - r)], colour, width);
    }

    /// A text; `anchor` tells which of its points is at `at`.
    pub fn write(&mut self, font: Text, text: &str, at: Pixel, anchor: Anchor) {
        if !text.is_empty() {
            self.words(font, text, at, anchor, false);
        }
    }

    /// A small text in ink.
    pub fn note(&mut self, text: &str, at: Pixel, anchor: Anchor) {
        self.write(SMALL, text, at, anchor);
    }

    /// A text to be read from below.
    pub fn write_upwards(&mut self, font: Text, text: &str, at: Pixel) {
        self.words(font, text, at, Anchor::Top, true);
    }

    fn words(&mut self, font: Text, text: &str, at: Pixel, anchor: Anchor, upwards: bool) {
        let (text, at) = (text.to_owned(), tenths(at));
        self.shapes.push(Shape::Words(Words {
            text,
            font,
            at,
            anchor,
            upwards,
        }));
    }

    /// A place under the pointer, of which nothing is seen.
    pub fn spot(&mut self, corners: &[Pixel], spot: Spot) {
        let corners = corners.iter().copied().map(tenths).collect();
        self.shapes.push(Shape::Spot(corners, spot));
    }

    /// An image stretched over a rectangle.
    pub fn image(&mut self, bitmap: Bitmap, [left, top, right, bottom]: Box4) {
        let ((left, top), (right, bottom)) = (tenths((left, top)), tenths((right, bottom)));
        let place = [left, top, right, bottom];
        self.shapes.push(Shape::Image(bitmap, place));
    }
}
