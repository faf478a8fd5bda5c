//! An SVG file as the shapes that it draws, in metres.

use std::str::FromStr;

use kurbo::{Affine, PathSeg};
use roxmltree::{Document, Node, ParsingOptions};
use svgtypes::Transform;

use super::super::error::{Result, Span};
use super::super::quantity;
use super::super::source::Source;
use super::path::{SHAPES, draw};
use super::pen::{Pen, Stroke, points};
use super::scale::{scale, span};
use physics::tile::profile::CHORD_SHARE;

const NAMESPACE: &str = "http://www.w3.org/2000/svg";

/// Most elements of a drawing.
const MOST_NODES: u32 = 200_000;

/// Most points of a drawing's lines, curves drawn as chords.
const MOST_POINTS: usize = 1_000_000;

/// Farthest that a shape reaches from the drawing's origin (m): room for a tile in any plan.
const FARTHEST: f64 = 1e3;

/// Most elements within one another: reading goes one call deeper with each.
const MOST_NESTED: usize = 256;

/// Largest distance of a chord from the curve that it stands for: as a share of the longer side of the
/// box around the shape's control points (0.2 mm of a tile of 43 cm), of the shorter side (as
/// [`CHORD_SHARE`] of a profile's depth), and of the longer side of the curve's own box, so that a small
/// rounding keeps its shape.
const CHORD_SHARE_OF_SHAPE: f64 = 1.0 / 2150.0;
const CHORD_SHARE_OF_CURVE: f64 = 1.0 / 32.0;

/// A shape of a drawing.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// The element's name.
    pub element: String,
    pub id: Option<String>,
    /// The element's name in the file.
    pub span: Span,
    pub lines: Vec<Line>,
    /// Largest distance of a chord from its curve (m).
    pub chord_error: f64,
}

impl Shape {
    /// Points of all its lines.
    pub fn points(&self) -> usize {
        let segments = self.lines.iter().flat_map(|line| &line.segments);
        self.lines.len() + segments.map(Vec::len).sum::<usize>()
    }
}

/// A line drawn without lifting the pen: x to the right, y upwards (m).
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub start: [f64; 2],
    /// For each drawn segment its points after the first one; one for a straight segment.
    pub segments: Vec<Vec<[f64; 2]>>,
    pub closed: bool,
}

/// What is not read of a drawing: the place, and what is there.
pub(super) type Skipped = (Span, String);

/// All shapes of a drawing, and what else is in it. `unit` is what the design says of the length
/// (m) of a user unit. Curves are drawn with chords that leave them by `chord_share` of the
/// [`Shape::chord_error`] at most.
pub(super) fn read(
    source: Source,
    unit: Option<f64>,
    chord_share: f64,
) -> Result<(Vec<Shape>, Vec<Skipped>)> {
    let options = ParsingOptions {
        // OpenSCAD begins with one.
        allow_dtd: true,
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(source.text, options).map_err(|error| {
        let at = byte_of(source.text, error.pos());
        source.error(
            (at..at + 1).into(),
            format!("the drawing is not well-formed XML: {error}"),
            "write it anew with the program that drew it",
        )
    })?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" || !is_svg(root) {
        return Err(source.error(
            span(root),
            format!("a drawing is an <svg>, not a <{}>", root.tag_name().name()),
            "save the drawing as plain SVG",
        ));
    }
    let mut reader = Reader {
        source,
        chord_share,
        points: 0,
        shapes: Vec::new(),
        skipped: Vec::new(),
    };
    reader.refuse_unread_transforms(root, true)?;
    let map = scale(source, root, unit)?;
    reader.children(root, map, 0)?;
    Ok((reader.shapes, reader.skipped))
}

struct Reader<'a> {
    source: Source<'a>,
    /// What chords may use of the chord error.
    chord_share: f64,
    /// Points of all lines so far.
    points: usize,
    shapes: Vec<Shape>,
    skipped: Vec<Skipped>,
}

impl Reader<'_> {
    /// Reads what an element holds, `depth` elements below the root.
    fn children(&mut self, parent: Node, map: Affine, depth: usize) -> Result<()> {
        if depth > MOST_NESTED {
            let message = format!("more than {MOST_NESTED} elements are within one another");
            let help = "ungroup the drawing's shapes in the drawing program";
            return Err(self.source.error(span(parent), message, help));
        }
        for node in parent.children().filter(Node::is_element) {
            // Notes of the drawing program, licences and the like draw nothing.
            if is_svg(node) {
                self.element(node, map, depth)?;
            }
        }
        Ok(())
    }

    fn element(&mut self, node: Node, map: Affine, depth: usize) -> Result<()> {
        let name = node.tag_name().name();
        let empty = || node.text().is_none_or(|text| text.trim().is_empty());
        match name {
            // Drawn only where a <use> asks for it, and that is listed.
            "title" | "desc" | "metadata" | "defs" | "symbol" => return Ok(()),
            "style" if empty() => return Ok(()),
            _ => {}
        }
        let container = matches!(name, "g" | "a");
        if !container && !SHAPES.contains(&name) {
            self.skipped.push((span(node), format!("<{name}>")));
            return Ok(());
        }
        if let Some(reason) = hidden(node) {
            let note = format!("<{name}> ({reason})");
            self.skipped.push((span(node), note));
            return Ok(());
        }
        for unread in ["clip-path", "mask"] {
            if property(node, unread).is_some_and(|value| value != "none") {
                let note = format!("the {unread} of <{name}>");
                self.skipped.push((span(node), note));
            }
        }
        self.refuse_unread_transforms(node, false)?;
        let map = map * self.transform(node)?;
        if container {
            return self.children(node, map, depth + 1);
        }
        self.shape(node, map)
    }

    fn shape(&mut self, node: Node, map: Affine) -> Result<()> {
        let mut pen = Pen::default();
        draw(node, &mut pen).map_err(|fault| {
            let place = node.attribute_node(fault.attribute);
            let place = place.map_or(span(node), |attribute| {
                let value = attribute.range_value();
                let written = &self.source.text[value.clone()];
                let at = fault.character.and_then(|character| {
                    // Past the end, the last character is to blame.
                    written.char_indices().take(character + 1).last()
                });
                match at {
                    Some((at, c)) => (value.start + at..value.start + at + c.len_utf8()).into(),
                    None => value.into(),
                }
            });
            let help = "mend the shape, or convert it to a path in the drawing program";
            self.source.error(place, fault.message, help)
        })?;
        let overdrawn = pen.overdrawn();
        let strokes = pen.finish();
        self.check_extent(node, &strokes, map)?;
        if overdrawn {
            let message =
                "an arc is all but straight: its radius is over a million times its length";
            let help = "draw it as a line";
            return Err(self.source.error(span(node), message, help));
        }
        let all = strokes.iter().flat_map(|s| s.segments.iter().flatten());
        let [longer, shorter] = sides(all, map);
        let flat = CHORD_SHARE * shorter;
        let chord_error = match CHORD_SHARE_OF_SHAPE * longer {
            error if flat > 0.0 => error.min(flat),
            error => error,
        };
        let lines = self.lines(node, &strokes, (map, chord_error))?;
        if lines.is_empty() {
            let note = format!("<{}> that draws nothing", node.tag_name().name());
            self.skipped.push((span(node), note));
            return Ok(());
        }
        self.shapes.push(Shape {
            element: node.tag_name().name().to_owned(),
            id: node.attribute("id").map(str::to_owned),
            span: span(node),
            lines,
            chord_error,
        });
        Ok(())
    }

    /// Refuses what lies too far out, before it is drawn as chords. Curves stay among their control
    /// points.
    fn check_extent(&self, node: Node, strokes: &[Stroke], map: Affine) -> Result<()> {
        let pieces = strokes.iter().flat_map(|s| s.segments.iter().flatten());
        let farthest = pieces
            .map(|piece| map * piece.to_cubic())
            .flat_map(|cubic| [cubic.p0, cubic.p1, cubic.p2, cubic.p3])
            .flat_map(|point| [point.x.abs(), point.y.abs()])
            .map(|x| if x.is_nan() { f64::INFINITY } else { x })
            .fold(0.0, f64::max);
        let message = if !farthest.is_finite() {
            "the shape's coordinates are not finite".to_owned()
        } else if farthest > FARTHEST {
            let far = match quantity::four_digits(farthest) {
                far if far < 1e7 => format!("{far}"),
                far => format!("{far:e}"),
            };
            format!("the shape reaches {far} m from the drawing's origin, more than {FARTHEST}")
        } else {
            return Ok(());
        };
        let help = "look for very large numbers in the shape and its transforms";
        Err(self.source.error(span(node), message, help))
    }

    /// The lines of a shape, curves as chords.
    fn lines(
        &mut self,
        node: Node,
        strokes: &[Stroke],
        (map, chord_error): (Affine, f64),
    ) -> Result<Vec<Line>> {
        let mut lines = Vec::with_capacity(strokes.len());
        for stroke in strokes {
            let start = map * stroke.start;
            let mut segments = Vec::with_capacity(stroke.segments.len());
            for segment in &stroke.segments {
                let [longer, _] = sides(segment.iter(), map);
                let error = chord_error.min(CHORD_SHARE_OF_CURVE * longer);
                segments.push(points(segment, map, self.chord_share * error));
                self.points += segments.last().map_or(0, Vec::len);
                if self.points > MOST_POINTS {
                    let message = format!("the drawing has more than {MOST_POINTS} points");
                    let help = "keep the shapes that are needed, and draw them simpler";
                    return Err(self.source.error(span(node), message, help));
                }
            }
            lines.push(Line {
                start: [start.x, start.y],
                segments,
                closed: stroke.closed,
            });
        }
        Ok(lines)
    }

    fn transform(&self, node: Node) -> Result<Affine> {
        let Some(attribute) = node.attribute_node("transform") else {
            return Ok(Affine::IDENTITY);
        };
        let Transform { a, b, c, d, e, f } =
            Transform::from_str(attribute.value()).map_err(|error| {
                let message = format!("`transform` cannot be read: {error}");
                let help = "apply the transform in the drawing program";
                self.source
                    .error(attribute.range_value().into(), message, help)
            })?;
        Ok(Affine::new([a, b, c, d, e, f]))
    }

    /// Refuses what would move a shape and is not read.
    fn refuse_unread_transforms(&self, node: Node, root: bool) -> Result<()> {
        let help = "apply the transform in the drawing program";
        if style(node).any(|(name, _)| name.starts_with("transform"))
            || node.has_attribute("transform-origin")
        {
            let message = "transforms in styles and about other origins are not read";
            return Err(self.source.error(span(node), message, help));
        }
        if root && node.has_attribute("transform") {
            let message = "a transform of the whole drawing is not read";
            return Err(self.source.error(span(node), message, help));
        }
        Ok(())
    }
}

/// The longer and the shorter side (m) of the box around the control points of some segments.
fn sides<'a>(segments: impl Iterator<Item = &'a PathSeg>, map: Affine) -> [f64; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for cubic in segments.map(|segment| map * segment.to_cubic()) {
        for point in [cubic.p0, cubic.p1, cubic.p2, cubic.p3] {
            for (k, x) in [point.x, point.y].into_iter().enumerate() {
                low[k] = f64::min(low[k], x);
                high[k] = f64::max(high[k], x);
            }
        }
    }
    let sides = [0, 1].map(|k| (high[k] - low[k]).max(0.0));
    [sides[0].max(sides[1]), sides[0].min(sides[1])]
}

/// Whether an element is SVG's; a drawing without any namespace is taken for one.
fn is_svg(node: Node) -> bool {
    node.tag_name()
        .namespace()
        .is_none_or(|uri| uri == NAMESPACE)
}

/// The properties in an element's `style`.
fn style<'a>(node: Node<'a, '_>) -> impl Iterator<Item = (&'a str, &'a str)> {
    let declarations = node.attribute("style").unwrap_or_default().split(';');
    declarations.filter_map(|declaration| {
        let (name, value) = declaration.split_once(':')?;
        Some((name.trim(), value.trim()))
    })
}

/// A property, in the style or as an attribute.
fn property<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    let styled = style(node).find(|(property, _)| *property == name);
    styled
        .map(|(_, value)| value)
        .or_else(|| node.attribute(name))
}

/// Why an element is not to be seen.
fn hidden(node: Node) -> Option<&'static str> {
    if property(node, "display") == Some("none") {
        return Some("not displayed");
    }
    let invisible = matches!(property(node, "visibility"), Some("hidden" | "collapse"));
    invisible.then_some("hidden")
}

/// The byte of a position that the XML parser gives, row and column from 1.
fn byte_of(text: &str, position: roxmltree::TextPos) -> usize {
    let rows: usize = text
        .split_inclusive('\n')
        .take((position.row as usize).saturating_sub(1))
        .map(str::len)
        .sum();
    let column = (position.col as usize).saturating_sub(1);
    let within = text[rows..].char_indices().nth(column);
    rows + within.map_or(0, |(at, _)| at)
}
