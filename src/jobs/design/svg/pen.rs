//! The segments of a path, drawn one by one.

use kurbo::{
    Affine, Arc, CubicBez, Line, ParamCurve, PathEl, PathSeg, Point, QuadBez, SvgArc, Vec2, flatten,
};

/// What a pen draws without being lifted.
#[derive(Clone, Debug)]
pub(super) struct Stroke {
    pub start: Point,
    /// One for each drawn segment: an arc is several cubics, any other segment one piece.
    pub segments: Vec<Vec<PathSeg>>,
    pub closed: bool,
}

/// Cubics that stand for an arc leave it by this share of its radius at most; of a short piece of a
/// large circle by far less, as what they leave falls as the sixth power of its angle.
const ARC_SHARE: f64 = 1e-6;

/// Largest radius of an arc, in units of the distance of its ends. Beyond, rounding moves the arc's
/// points.
const LARGEST_RADIUS: f64 = 1e6;

/// Draws absolute segments, in user units.
#[derive(Debug, Default)]
pub(super) struct Pen {
    strokes: Vec<Stroke>,
    at: Point,
    /// Whether an arc was too large to be drawn; a line stands in its place.
    overdrawn: bool,
}

impl Pen {
    pub fn at(&self) -> Point {
        self.at
    }

    /// Whether an arc's radius is more than [`LARGEST_RADIUS`] times the distance of its ends.
    pub fn overdrawn(&self) -> bool {
        self.overdrawn
    }

    /// All strokes that are more than a point.
    pub fn finish(self) -> Vec<Stroke> {
        let mut strokes = self.strokes;
        strokes.retain(|stroke| !stroke.segments.is_empty());
        strokes
    }

    pub fn move_to(&mut self, to: Point) {
        self.at = to;
        self.strokes.push(Stroke {
            start: to,
            segments: Vec::new(),
            closed: false,
        });
    }

    fn push(&mut self, segment: Vec<PathSeg>, to: Point) {
        // What is drawn after a path was closed begins where that path began.
        if self.strokes.last().is_none_or(|stroke| stroke.closed) {
            self.move_to(self.at);
        }
        if let Some(stroke) = self.strokes.last_mut() {
            stroke.segments.push(segment);
        }
        self.at = to;
    }

    pub fn line_to(&mut self, to: Point) {
        self.push(vec![Line::new(self.at, to).into()], to);
    }

    pub fn quadratic_to(&mut self, control: Point, to: Point) {
        self.push(vec![QuadBez::new(self.at, control, to).into()], to);
    }

    pub fn cubic_to(&mut self, first: Point, second: Point, to: Point) {
        self.push(vec![CubicBez::new(self.at, first, second, to).into()], to);
    }

    /// An elliptical arc, `rotation` in rad. Without radii it is a line, as SVG has it.
    pub fn arc_to(&mut self, radii: Vec2, rotation: f64, (large, sweep): (bool, bool), to: Point) {
        let arc = Arc::from_svg_arc(&SvgArc {
            from: self.at,
            to,
            radii,
            x_rotation: rotation,
            large_arc: large,
            sweep,
        });
        let Some(arc) = arc else {
            return self.line_to(to);
        };
        let radius = arc.radii.x.abs().max(arc.radii.y.abs());
        if radius.is_nan() || radius > LARGEST_RADIUS * self.at.distance(to) {
            self.overdrawn = true;
            return self.line_to(to);
        }
        let mut cubics: Vec<PathSeg> = Vec::new();
        let mut from = self.at;
        arc.to_cubic_beziers(ARC_SHARE * radius, |first, second, end| {
            cubics.push(CubicBez::new(from, first, second, end).into());
            from = end;
        });
        // The last cubic ends where the arc is said to end, to the last bit.
        if let Some(PathSeg::Cubic(last)) = cubics.last_mut() {
            last.p3 = to;
        }
        self.push(cubics, to);
    }

    /// Draws back to where the stroke began.
    pub fn close(&mut self) {
        let Some(start) = self.strokes.last().map(|stroke| stroke.start) else {
            return;
        };
        if self.at != start {
            self.line_to(start);
        }
        if let Some(stroke) = self.strokes.last_mut() {
            stroke.closed = true;
        }
    }
}

/// The points of a segment after its first, each curve as chords that leave it by no more than
/// `chord_error` where the affine map has taken it.
pub(super) fn points(segment: &[PathSeg], map: Affine, chord_error: f64) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for &piece in segment {
        let piece = map * piece;
        let elements = [PathEl::MoveTo(piece.start()), piece.as_path_el()];
        flatten(elements, chord_error, |element| {
            if let PathEl::LineTo(point) = element {
                points.push([point.x, point.y]);
            }
        });
    }
    points
}
