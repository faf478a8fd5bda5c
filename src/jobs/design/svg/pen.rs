//! Draws the segments of a path one by one.

use kurbo::{
    Affine, Arc, CubicBez, Line, ParamCurve, PathEl, PathSeg, Point, QuadBez, SvgArc, Vec2, flatten,
};

/// A connected line.
#[derive(Clone, Debug)]
pub(super) struct Stroke {
    pub start: Point,
    /// One entry per drawn segment: an arc is several cubics, any other segment one piece.
    pub segments: Vec<Vec<PathSeg>>,
    pub closed: bool,
    /// Whether the last segment is not drawn but closes the stroke.
    pub closing: bool,
}

impl Stroke {
    pub fn transform(&mut self, map: Affine) {
        self.start = map * self.start;
        for piece in self.segments.iter_mut().flatten() {
            *piece = map * *piece;
        }
    }
}

/// Largest distance of the cubics from the arc they replace, as a share of its radius; it is far
/// smaller for a short piece of a large circle, as it decreases with the sixth power of the angle.
const ARC_SHARE: f64 = 1e-6;

/// Largest radius of an arc, in units of the distance of its ends. Beyond it, rounding errors move
/// the arc's points.
const LARGEST_RADIUS: f64 = 1e6;

/// Draws absolute segments, in user units.
#[derive(Debug, Default)]
pub(super) struct Pen {
    strokes: Vec<Stroke>,
    at: Point,
    /// Whether an arc was too large to be drawn and was replaced by a line.
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

    /// All strokes except single points.
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
            closing: false,
        });
    }

    fn push(&mut self, segment: Vec<PathSeg>, to: Point) {
        // After a path is closed, drawing continues from its start.
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

    /// An elliptical arc, `rotation` in rad. Without radii it is a line, as SVG specifies.
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
        // Extremely large or small arcs have no computable centre.
        let is_placed = arc.center.is_finite() && (arc.start_angle + arc.sweep_angle).is_finite();
        if !is_placed || radius.is_nan() || radius > LARGEST_RADIUS * self.at.distance(to) {
            self.overdrawn = true;
            return self.line_to(to);
        }
        let mut cubics: Vec<PathSeg> = Vec::new();
        let mut from = self.at;
        arc.to_cubic_beziers(ARC_SHARE * radius, |first, second, end| {
            cubics.push(CubicBez::new(from, first, second, end).into());
            from = end;
        });
        // The last cubic ends exactly at the stated end of the arc.
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
        let closing = self.at != start;
        if closing {
            self.line_to(start);
        }
        if let Some(stroke) = self.strokes.last_mut() {
            (stroke.closed, stroke.closing) = (true, closing);
        }
    }
}

/// The points of a segment after its first, with chords within `chord_error` of each curve.
pub(super) fn points(segment: &[PathSeg], chord_error: f64) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for piece in segment {
        let elements = [PathEl::MoveTo(piece.start()), piece.as_path_el()];
        flatten(elements, chord_error, |element| {
            if let PathEl::LineTo(point) = element {
                points.push([point.x, point.y]);
            }
        });
    }
    points
}

/// Number of points of each piece of a segment that [`is_arc`] checks.
const LOOKS: u32 = 12;

/// Largest distance of a curve from the circle it is identified with, relative to the height of its
/// arc: a quarter circle drawn as one cubic deviates by 0.0009.
const OFF_ARC: f64 = 1e-3;

/// Whether a segment is an arc of a circle: its distance from the circle is at most `error`, or
/// that of the curves with which drawing programs approximate arcs.
pub(super) fn is_arc(segment: &[PathSeg], error: f64) -> bool {
    let Some(last) = segment.last() else {
        return false;
    };
    if segment
        .iter()
        .any(|piece| matches!(piece, PathSeg::Line(_)))
    {
        return false;
    }
    let mut points = Vec::new();
    for piece in segment {
        points.extend((0..LOOKS).map(|k| piece.eval(f64::from(k) / f64::from(LOOKS))));
    }
    points.push(last.end());
    let n = points.len();
    let Some((centre, radius)) = circle([points[0], points[n / 3], points[2 * n / 3]]) else {
        return false;
    };
    let chord = points[n - 1] - points[0];
    let height = |p: &Point| chord.cross(*p - points[0]).abs() / chord.hypot();
    let height = match chord.hypot() > OFF_ARC * radius {
        true => points.iter().map(height).fold(0.0, f64::max),
        false => 2.0 * radius,
    };
    let turn = |w: &[Point]| (w[1] - w[0]).cross(w[2] - w[1]);
    let turns_left = turn(&points[..3]) > 0.0;
    let off = |p: &Point| ((*p - centre).hypot() - radius).abs();
    points
        .iter()
        .map(off)
        .all(|off| off <= error.max(OFF_ARC * height))
        && points.windows(3).all(|w| (turn(w) > 0.0) == turns_left)
}

/// The centre and radius of the circle through three points, if there is one.
fn circle([a, b, c]: [Point; 3]) -> Option<(Point, f64)> {
    let (u, v) = (b - a, c - a);
    let twice = 2.0 * u.cross(v);
    let (uu, vv) = (u.hypot2(), v.hypot2());
    let to_centre = Vec2::new(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / twice;
    let radius = to_centre.hypot();
    radius.is_finite().then(|| (a + to_centre, radius))
}
