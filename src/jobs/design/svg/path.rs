//! The shapes of SVG as strokes of a pen: `path` with all its commands, and the basic shapes.

use std::str::FromStr;

use kurbo::{Point, Vec2};
use roxmltree::Node;
use svgtypes::{Length, LengthUnit, NumberListParser, PathParser, PathSegment};

use super::pen::Pen;

/// The fault of an attribute of a shape.
pub(super) struct Fault {
    /// The attribute.
    pub attribute: &'static str,
    /// The character of its value, if known.
    pub character: Option<usize>,
    pub message: String,
}

fn fault(attribute: &'static str, message: impl Into<String>) -> Fault {
    Fault {
        attribute,
        character: None,
        message: message.into(),
    }
}

/// The elements that are read.
pub(super) const SHAPES: [&str; 7] = [
    "path", "polygon", "polyline", "rect", "circle", "ellipse", "line",
];

/// The size of the viewport (user units), if known: lengths in percent refer to it.
pub(super) type Viewport = Option<[f64; 2]>;

/// Draws one of [`SHAPES`].
pub(super) fn draw(node: Node, viewport: Viewport, pen: &mut Pen) -> Result<(), Fault> {
    let of = |name| length(node, name, viewport);
    match node.tag_name().name() {
        "path" => path(node.attribute("d").unwrap_or_default(), pen),
        "polygon" | "polyline" => polyline(node, pen),
        "rect" => rect(&of, pen),
        "line" => line(&of, pen),
        _ => ellipse(node, &of, pen),
    }
}

/// A function that reads a length of a shape in user units.
type Lengths<'a> = &'a dyn Fn(&'static str) -> Result<Option<f64>, Fault>;

fn line(of: Lengths, pen: &mut Pen) -> Result<(), Fault> {
    let at = |name| Ok(of(name)?.unwrap_or(0.0));
    let (start, end) = (
        Point::new(at("x1")?, at("y1")?),
        Point::new(at("x2")?, at("y2")?),
    );
    pen.move_to(start);
    if start != end {
        pen.line_to(end);
    }
    Ok(())
}

fn path(d: &str, pen: &mut Pen) -> Result<(), Fault> {
    // The last control point, which smooth curves reflect.
    let (mut cubic, mut quadratic): (Option<Point>, Option<Point>) = (None, None);
    for segment in PathParser::from(d) {
        let segment = segment.map_err(|error| malformed("d", d, &error))?;
        let at = pen.at();
        let origin = if segment.is_abs() { Point::ORIGIN } else { at };
        let point = |x: f64, y: f64| Point::new(origin.x + x, origin.y + y);
        let mirrored = |control: Option<Point>| at + (at - control.unwrap_or(at));
        let (mut next_cubic, mut next_quadratic) = (None, None);
        match segment {
            PathSegment::MoveTo { x, y, .. } => pen.move_to(point(x, y)),
            PathSegment::LineTo { x, y, .. } => pen.line_to(point(x, y)),
            PathSegment::HorizontalLineTo { x, .. } => pen.line_to(Point::new(origin.x + x, at.y)),
            PathSegment::VerticalLineTo { y, .. } => pen.line_to(Point::new(at.x, origin.y + y)),
            PathSegment::CurveTo {
                x1,
                y1,
                x2,
                y2,
                x,
                y,
                ..
            } => {
                next_cubic = Some(point(x2, y2));
                pen.cubic_to(point(x1, y1), point(x2, y2), point(x, y));
            }
            PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
                next_cubic = Some(point(x2, y2));
                pen.cubic_to(mirrored(cubic), point(x2, y2), point(x, y));
            }
            PathSegment::Quadratic { x1, y1, x, y, .. } => {
                next_quadratic = Some(point(x1, y1));
                pen.quadratic_to(point(x1, y1), point(x, y));
            }
            PathSegment::SmoothQuadratic { x, y, .. } => {
                let control = mirrored(quadratic);
                next_quadratic = Some(control);
                pen.quadratic_to(control, point(x, y));
            }
            PathSegment::EllipticalArc {
                rx,
                ry,
                x_axis_rotation,
                large_arc,
                sweep,
                x,
                y,
                ..
            } => {
                let rotation = x_axis_rotation.to_radians();
                let flags = (large_arc, sweep);
                pen.arc_to(Vec2::new(rx, ry), rotation, flags, point(x, y));
            }
            PathSegment::ClosePath { .. } => pen.close(),
        }
        (cubic, quadratic) = (next_cubic, next_quadratic);
    }
    Ok(())
}

/// The fault of a value that cannot be parsed, at the character where parsing ended.
fn malformed(attribute: &'static str, value: &str, error: &svgtypes::Error) -> Fault {
    use svgtypes::Error;
    let position = match error {
        Error::UnexpectedData(at)
        | Error::InvalidNumber(at)
        | Error::InvalidChar(_, at)
        | Error::InvalidString(_, at) => Some(*at),
        Error::UnexpectedEndOfStream => Some(value.chars().count()),
        Error::InvalidValue | Error::InvalidIdent => None,
    };
    Fault {
        attribute,
        // Positions are counted from 1.
        character: position.map(|at| at.saturating_sub(1)),
        message: format!("`{attribute}` cannot be read: {error}"),
    }
}

fn polyline(node: Node, pen: &mut Pen) -> Result<(), Fault> {
    let value = node.attribute("points").unwrap_or_default();
    let numbers: Result<Vec<f64>, _> = NumberListParser::from(value).collect();
    let numbers = numbers.map_err(|error| malformed("points", value, &error))?;
    if numbers.is_empty() || numbers.len() % 2 == 1 {
        let message = format!(
            "`points` has {} numbers, but points are pairs of numbers",
            numbers.len()
        );
        return Err(fault("points", message));
    }
    let points: Vec<Point> = numbers
        .chunks(2)
        .map(|xy| Point::new(xy[0], xy[1]))
        .collect();
    for (k, point) in points.iter().enumerate() {
        if k == 0 {
            pen.move_to(*point);
        } else {
            pen.line_to(*point);
        }
    }
    if node.tag_name().name() == "polygon" {
        pen.close();
    }
    Ok(())
}

/// User units (CSS px) in one inch.
const PX_PER_INCH: f64 = 96.0;

/// A length of an element in user units; `None` if it is not given or `auto`.
pub(super) fn length(
    node: Node,
    attribute: &'static str,
    viewport: Viewport,
) -> Result<Option<f64>, Fault> {
    let Some(text) = node.attribute(attribute).filter(|text| *text != "auto") else {
        return Ok(None);
    };
    let length = Length::from_str(text.trim()).map_err(|_| {
        fault(
            attribute,
            format!("`{attribute}` = \"{text}\" is not a length"),
        )
    })?;
    let whole = || {
        let [width, height] = viewport?;
        Some(match attribute {
            "x" | "x1" | "x2" | "cx" | "rx" | "width" => width,
            "y" | "y1" | "y2" | "cy" | "ry" | "height" => height,
            _ => libm::hypot(width, height) / std::f64::consts::SQRT_2,
        })
    };
    let user_units = match (length.unit, metres(length.unit)) {
        (LengthUnit::None | LengthUnit::Px, _) => Some(length.number),
        (LengthUnit::Percent, _) => whole().map(|whole| length.number / 100.0 * whole),
        (_, unit) => unit.map(|unit| length.number * unit / INCH * PX_PER_INCH),
    };
    let relative = || {
        let message = format!("`{attribute}` = \"{text}\" is relative to something else");
        fault(attribute, message)
    };
    user_units.ok_or_else(relative).map(Some)
}

/// An inch (m).
pub(super) const INCH: f64 = 0.0254;

/// A physical unit of length (m).
pub(super) fn metres(unit: LengthUnit) -> Option<f64> {
    match unit {
        LengthUnit::Mm => Some(1e-3),
        LengthUnit::Cm => Some(1e-2),
        LengthUnit::In => Some(INCH),
        LengthUnit::Pt => Some(INCH / 72.0),
        LengthUnit::Pc => Some(INCH / 6.0),
        _ => None,
    }
}

/// A rectangle, with rounded corners if `rx` or `ry` are given.
fn rect(of: Lengths, pen: &mut Pen) -> Result<(), Fault> {
    let (x, y) = (of("x")?.unwrap_or(0.0), of("y")?.unwrap_or(0.0));
    let (width, height) = (of("width")?.unwrap_or(0.0), of("height")?.unwrap_or(0.0));
    for (name, size) in [("width", width), ("height", height)] {
        if size <= 0.0 {
            return Err(fault(name, format!("a rectangle without a {name}")));
        }
    }
    let (rx, ry) = (of("rx")?, of("ry")?);
    let rounding = |r: Option<f64>, most: f64| r.unwrap_or(0.0).clamp(0.0, most);
    let (rx, ry) = (
        rounding(rx.or(ry), width / 2.0),
        rounding(ry.or(rx), height / 2.0),
    );
    let radii = Vec2::new(rx, ry);
    let (right, bottom) = (x + width, y + height);
    // Each corner, with the ends of its rounding.
    let corners = [
        (Point::new(right - rx, y), Point::new(right, y + ry)),
        (
            Point::new(right, bottom - ry),
            Point::new(right - rx, bottom),
        ),
        (Point::new(x + rx, bottom), Point::new(x, bottom - ry)),
        (Point::new(x, y + ry), Point::new(x + rx, y)),
    ];
    pen.move_to(Point::new(x + rx, y));
    for (begin, end) in corners {
        if pen.at() != begin {
            pen.line_to(begin);
        }
        if begin != end {
            pen.arc_to(radii, 0.0, (false, true), end);
        }
    }
    pen.close();
    Ok(())
}

/// A circle or an ellipse in four quarters, from its rightmost point.
fn ellipse(node: Node, of: Lengths, pen: &mut Pen) -> Result<(), Fault> {
    let (rx, ry) = if node.tag_name().name() == "circle" {
        let r = of("r")?;
        (("r", r), ("r", r))
    } else {
        let (rx, ry) = (of("rx")?, of("ry")?);
        (("rx", rx.or(ry)), ("ry", ry.or(rx)))
    };
    for (name, radius) in [rx, ry] {
        if radius.is_none_or(|radius| radius <= 0.0) {
            return Err(fault(name, format!("a circle or ellipse without `{name}`")));
        }
    }
    let (rx, ry) = (rx.1.unwrap_or(0.0), ry.1.unwrap_or(0.0));
    let centre = Point::new(of("cx")?.unwrap_or(0.0), of("cy")?.unwrap_or(0.0));
    let quarters = [(rx, 0.0), (0.0, ry), (-rx, 0.0), (0.0, -ry)].map(|(x, y)| centre + (x, y));
    pen.move_to(quarters[0]);
    for k in 1..=4 {
        pen.arc_to(Vec2::new(rx, ry), 0.0, (false, true), quarters[k % 4]);
    }
    pen.close();
    Ok(())
}
