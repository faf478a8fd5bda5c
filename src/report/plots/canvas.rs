//! A drawing area in pixels: that of plotters, with what plotters lacks.

use std::cell::{Ref, RefCell};
use std::fmt::Display;
use std::rc::Rc;

use plotters::coord::Shift;
use plotters::element::{CoordMapper, DashedPathElement, Drawable, PointCollection};
use plotters::prelude::{
    Circle, Cross, DrawingArea, PathElement, Polygon, Rectangle, Text as Words,
};
use plotters::style::{Color, WHITE};
use plotters_backend::BackendCoord;

use super::recorder::{Mark, Recorder};
use super::style::{Anchor, INK, SMALL, Text, stroke, unit, units};

/// A point (pixels).
pub type Pixel = (f64, f64);
/// A rectangle (pixels): left, top, right, bottom.
pub type Box4 = [f64; 4];

/// A region with a tooltip in SVG documents, by which a page identifies it.
#[derive(Clone, Debug)]
pub struct Spot {
    pub title: String,
    /// The kind of thing, such as `state`.
    pub kind: &'static str,
    pub value: String,
}

/// An image with a palette, its first row at the top.
#[derive(Clone, Debug)]
pub struct Bitmap {
    pub width: usize,
    pub palette: Vec<[u8; 3]>,
    /// One palette index per pixel.
    pub pixels: Vec<u8>,
}

/// A picture under construction.
pub struct Canvas {
    recorder: Rc<RefCell<Recorder>>,
    /// The whole area.
    pub root: DrawingArea<Recorder, Shift>,
    /// Images beneath the drawing (units: left, top, right, bottom).
    pub images: Vec<(Bitmap, [i32; 4])>,
    /// Regions over it.
    pub spots: Vec<(Vec<BackendCoord>, Spot)>,
    /// The first drawing error.
    failure: Option<String>,
}

/// Length of a dash, radii of a disc and of its rim (pixels).
pub const DASH: f64 = 6.0;
pub const DISC: f64 = 3.2;
pub const RIM: f64 = 4.2;

/// The corners of a rectangle.
pub fn corners([left, top, right, bottom]: Box4) -> [Pixel; 4] {
    [(left, top), (right, top), (right, bottom), (left, bottom)]
}

/// The middle of a rectangle.
pub fn middle([left, top, right, bottom]: Box4) -> Pixel {
    ((left + right) / 2.0, (top + bottom) / 2.0)
}

/// A number of points around a position, the first one above it, at repeating radii (pixels).
pub fn around((x, y): Pixel, count: usize, radii: &[f64]) -> Vec<Pixel> {
    let point = |(k, radius): (usize, &f64)| {
        let (sin, cos) = libm::sincos(k as f64 * std::f64::consts::TAU / count as f64);
        (x + radius * sin, y - radius * cos)
    };
    (0..count).zip(radii.iter().cycle()).map(point).collect()
}

impl Canvas {
    /// An empty picture of this width and height (pixels).
    pub fn new(size: [f64; 2]) -> Self {
        let [width, height] = size.map(|side| unit(side).max(0) as u32);
        let recorder = Rc::new(RefCell::new(Recorder {
            size: (width, height),
            shapes: Vec::new(),
        }));
        Self {
            root: (&recorder).into(),
            recorder,
            images: Vec::new(),
            spots: Vec::new(),
            failure: None,
        }
    }

    /// The drawing, or its first error.
    pub fn shapes(&self) -> Result<Ref<'_, [Mark]>, String> {
        match &self.failure {
            Some(why) => Err(why.clone()),
            None => Ok(Ref::map(self.recorder.borrow(), |it| &it.shapes[..])),
        }
    }

    /// Draws an element of plotters, in units.
    pub fn draw<'a, E, B: CoordMapper>(&mut self, element: &'a E)
    where
        &'a E: PointCollection<'a, BackendCoord, B>,
        E: Drawable<Recorder, B>,
    {
        let drawn = self.root.draw(element);
        self.done(drawn);
    }

    /// Records a drawing error.
    pub fn done<E: Display>(&mut self, drawn: Result<(), E>) {
        if let Err(why) = drawn {
            self.failure.get_or_insert(why.to_string());
        }
    }

    /// A line of this width (pixels) through points.
    pub fn line(&mut self, points: &[Pixel], colour: impl Color, width: f64) {
        self.draw(&PathElement::new(units(points), stroke(colour, width)));
    }

    /// A line with a white seam that makes it visible on any background.
    pub fn seamed(&mut self, points: &[Pixel], colour: impl Color, width: f64) {
        self.line(points, WHITE.mix(0.8), width + 2.4);
        self.line(points, colour, width);
    }

    /// A line of dashes with gaps between them (pixels).
    pub fn dashed(&mut self, points: &[Pixel], colour: impl Color, dashes: [f64; 2]) {
        let [dash, gap] = dashes.map(unit);
        let style = stroke(colour, 2.0);
        self.draw(&DashedPathElement::new(units(points), dash, gap, style));
    }

    /// A closed line.
    pub fn ring(&mut self, corners: &[Pixel], colour: impl Color, width: f64) {
        let closed: Vec<Pixel> = corners.iter().chain(corners.first()).copied().collect();
        self.line(&closed, colour, width);
    }

    /// A filled polygon.
    pub fn area(&mut self, corners: &[Pixel], fill: impl Color) {
        self.draw(&Polygon::new(units(corners), fill.filled()));
    }

    /// A filled polygon with a dark outline.
    pub fn outlined(&mut self, corners: &[Pixel], fill: impl Color) {
        self.area(corners, fill);
        self.ring(corners, INK, 1.2);
    }

    /// A filled rectangle.
    pub fn block(&mut self, [left, top, right, bottom]: Box4, fill: impl Color) {
        let corners = [(left, top), (right, bottom)].map(|(x, y)| (unit(x), unit(y)));
        self.draw(&Rectangle::new(corners, fill.filled()));
    }

    /// The outline of a rectangle.
    pub fn frame(&mut self, place: Box4, colour: impl Color) {
        self.ring(&corners(place), colour, 1.0);
    }

    /// A small disc with a white rim.
    pub fn disc(&mut self, (x, y): Pixel, colour: impl Color) {
        let at = (unit(x), unit(y));
        self.draw(&Circle::new(at, unit(RIM), WHITE.filled()));
        self.draw(&Circle::new(at, unit(DISC), colour.filled()));
    }

    /// A small empty circle, for an absent value.
    pub fn circle(&mut self, (x, y): Pixel, colour: impl Color) {
        self.draw(&Circle::new(
            (unit(x), unit(y)),
            unit(RIM),
            stroke(colour, 1.8),
        ));
    }

    /// A cross of half the width `r` (pixels) in lines of a width.
    pub fn cross(&mut self, (x, y): Pixel, r: f64, colour: impl Color, width: f64) {
        self.draw(&Cross::new(
            (unit(x), unit(y)),
            unit(r),
            stroke(colour, width),
        ));
    }

    /// A text; `anchor` says which of its points is at `at`.
    pub fn write(&mut self, font: Text, text: &str, (x, y): Pixel, anchor: Anchor) {
        if !text.is_empty() {
            self.draw(&Words::new(text, (unit(x), unit(y)), font.style(anchor)));
        }
    }

    /// A small text in ink.
    pub fn note(&mut self, text: &str, at: Pixel, anchor: Anchor) {
        self.write(SMALL, text, at, anchor);
    }

    /// An invisible region with a tooltip.
    pub fn spot(&mut self, corners: &[Pixel], spot: Spot) {
        self.spots.push((units(corners), spot));
    }

    /// An image stretched over a rectangle, beneath everything drawn.
    pub fn image(&mut self, bitmap: Bitmap, place: Box4) {
        self.images.push((bitmap, place.map(unit)));
    }
}
