//! An SVG file as a list of shapes in metres.

use std::collections::HashMap;
use std::str::FromStr;

use kurbo::{Affine, PathSeg, Point};
use nalgebra::Vector2;
use roxmltree::{Document, Node, ParsingOptions};
use svgtypes::Transform;

use super::super::error::{DesignError, Result, Span};
use super::super::quantity;
use super::super::source::Source;
use super::path::{self, Fault, SHAPES, Viewport, draw};
use super::pen::{Pen, Stroke, is_arc, points};
use super::scale::{fitted, scale, span, view_box};
use physics::tile::outline::extent;
use physics::tile::profile::CHORD_SHARE;

const NAMESPACE: &str = "http://www.w3.org/2000/svg";
const XLINK: &str = "http://www.w3.org/1999/xlink";

/// Elements that draw nothing themselves: notes, and definitions that others refer to.
const NOT_DRAWN: [&str; 13] = [
    "title",
    "desc",
    "metadata",
    "defs",
    "symbol",
    "clipPath",
    "mask",
    "marker",
    "filter",
    "pattern",
    "linearGradient",
    "radialGradient",
    "view",
];

/// Properties of a style sheet that shape, move or hide elements.
const TELLING: [&str; 19] = [
    "transform",
    "translate",
    "rotate",
    "scale",
    "offset-path",
    "display",
    "visibility",
    "clip-path",
    "mask",
    "d",
    "x",
    "y",
    "width",
    "height",
    "cx",
    "cy",
    "r",
    "rx",
    "ry",
];

/// How far a shape may extend beyond its window and still count as complete, as a share of the
/// window's size: the resolution of six digits.
const WINDOW_SHARE: f64 = 1e-6;

/// Largest number of elements of a drawing.
const MOST_NODES: u32 = 200_000;

/// Largest number of points of a drawing's lines, with curves as chords.
const MOST_POINTS: usize = 1_000_000;

/// Largest distance of a shape from the drawing's origin (m): room for a tile anywhere in a large
/// plan.
const FARTHEST: f64 = 1e3;

/// Deepest nesting of elements: reading recurses once per level.
const MOST_NESTED: usize = 256;

/// Largest distance of a chord from the curve it replaces: as a share of the longer side of the box
/// around the shape's control points (0.2 mm of a tile of 43 cm), of the shorter side (as
/// [`CHORD_SHARE`] of a profile's depth), and of the longer side of the curve's own box, so that a
/// small rounding keeps its shape.
const CHORD_SHARE_OF_SHAPE: f64 = 1.0 / 2150.0;
const CHORD_SHARE_OF_CURVE: f64 = 1.0 / 32.0;

/// Largest deviation of an arc from its circle, as a share of the allowed deviation of its chords.
const OFF_ARC_SHARE: f64 = 2e-3;

/// A drawing, read.
pub(super) struct Drawing {
    pub shapes: Vec<DrawnShape>,
    pub skipped: Vec<Skipped>,
    /// Whether the length of a user unit is known; if not, it was read as a millimetre.
    pub sized: bool,
    /// The name of its outermost element in the file.
    pub root: Span,
    /// Every `id` of the drawing, and the name of its element.
    pub ids: HashMap<String, String>,
}

/// A shape of a drawing.
#[derive(Clone, Debug)]
pub(super) struct DrawnShape {
    /// The element's name.
    pub element: String,
    /// Its own id, those of the groups it is in, and of the elements that use it.
    pub ids: Vec<String>,
    /// The element's name in the file.
    pub span: Span,
    /// Whether it has a fill or a stroke.
    pub painted: bool,
    /// As drawn (m).
    pub strokes: Vec<Stroke>,
    /// The same, curves as chords.
    pub lines: Vec<Line>,
    /// Largest distance of a chord from its curve (m).
    pub chord_error: f64,
}

impl DrawnShape {
    /// The shape with chords of another largest distance (m) from its curves.
    pub fn with_chords(&self, chord_error: f64) -> Self {
        Self {
            lines: lines(&self.strokes, chord_error, usize::MAX).unwrap_or_default(),
            chord_error,
            ..self.clone()
        }
    }

    /// Points of all its lines.
    pub fn points(&self) -> usize {
        let segments = self.lines.iter().flat_map(|line| &line.segments);
        self.lines.len() + segments.map(|segment| segment.points.len()).sum::<usize>()
    }
}

/// A line drawn without lifting the pen: x to the right, y upwards (m).
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub start: [f64; 2],
    pub segments: Vec<Segment>,
    pub closed: bool,
    /// Whether the last segment is not drawn but closes the line.
    pub closing: bool,
}

/// A drawn segment of a line.
#[derive(Clone, Debug)]
pub(super) struct Segment {
    /// Its points after the first one; one for a straight segment.
    pub points: Vec<[f64; 2]>,
    /// Whether the points lie on an arc of a circle.
    pub arc: bool,
}

impl Line {
    /// All its points.
    pub fn points(&self) -> impl Iterator<Item = [f64; 2]> {
        let drawn = self.segments.iter().flat_map(|segment| &segment.points);
        std::iter::once(self.start).chain(drawn.copied())
    }

    pub fn end(&self) -> [f64; 2] {
        let last = self
            .segments
            .last()
            .and_then(|segment| segment.points.last());
        *last.unwrap_or(&self.start)
    }
}

/// An ignored part of a drawing: its place and its name.
pub(super) type Skipped = (Span, String);

/// Reads all shapes of a drawing, and lists its ignored parts. `unit` is the length (m) of a user
/// unit stated in the design.
pub(super) fn read(source: Source, unit: Option<f64>) -> Result<Drawing> {
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
            "save it again with the program that drew it",
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
    let named = document
        .descendants()
        .filter_map(|node| Some((node.attribute("id")?, node)));
    let mut by_id = HashMap::new();
    for (id, node) in named {
        by_id.entry(id).or_insert(node);
    }
    let sheets = document
        .descendants()
        .filter(|node| node.tag_name().name() == "style");
    let mut reader = Reader {
        source,
        points: 0,
        elements: 0,
        styled: sheets
            .into_iter()
            .any(|sheet| !text(sheet).trim().is_empty()),
        by_id,
        shapes: Vec::new(),
        skipped: Vec::new(),
    };
    reader.refuse_unread_transforms(root, true)?;
    let scale = scale(source, root, unit)?;
    let context = Context {
        map: scale.unwrap_or(Affine::scale_non_uniform(1e-3, -1e-3)),
        viewport: match view_box(source, root)? {
            Some(view_box) => Some([view_box.w, view_box.h]),
            None => reader.size(root, None).ok(),
        },
        depth: 0,
        ids: root
            .attribute("id")
            .map(str::to_owned)
            .into_iter()
            .collect(),
        paint: Paint::default().of(root),
    };
    reader.children(root, &context)?;
    let ids = reader.by_id.iter();
    let ids = ids.map(|(id, node)| ((*id).to_owned(), node.tag_name().name().to_owned()));
    Ok(Drawing {
        ids: ids.collect(),
        shapes: reader.shapes,
        skipped: reader.skipped,
        sized: scale.is_some(),
        root: span(root),
    })
}

/// The context of an element.
#[derive(Clone)]
struct Context {
    /// To metres.
    map: Affine,
    viewport: Viewport,
    /// The nesting depth.
    depth: usize,
    /// The ids of the enclosing elements.
    ids: Vec<String>,
    paint: Paint,
}

/// Whether shapes are filled and stroked.
#[derive(Clone, Copy)]
struct Paint {
    fill: bool,
    stroke: bool,
}

impl Default for Paint {
    fn default() -> Self {
        Self {
            fill: true,
            stroke: false,
        }
    }
}

impl Paint {
    /// The paint of an element that inherits this one.
    fn of(self, node: Node) -> Self {
        let own = |name, inherited| match property(node, name) {
            None | Some("inherit") => inherited,
            Some(value) => value != "none",
        };
        Self {
            fill: own("fill", self.fill),
            stroke: own("stroke", self.stroke),
        }
    }
}

struct Reader<'a, 'd> {
    source: Source<'a>,
    /// Points of all lines so far.
    points: usize,
    /// Elements read so far, each as often as it is drawn.
    elements: u32,
    /// Whether the drawing has a style sheet, which may paint any shape.
    styled: bool,
    by_id: HashMap<&'d str, Node<'d, 'd>>,
    shapes: Vec<DrawnShape>,
    skipped: Vec<Skipped>,
}

impl<'d> Reader<'_, 'd> {
    /// Reads the children of an element.
    fn children(&mut self, parent: Node<'d, 'd>, context: &Context) -> Result<()> {
        if context.depth > MOST_NESTED {
            let message = format!("more than {MOST_NESTED} elements are nested");
            let help = "ungroup the drawing's shapes in the drawing program";
            return Err(self.source.error(span(parent), message, help));
        }
        let within = Context {
            depth: context.depth + 1,
            ..context.clone()
        };
        // Notes of the drawing program, licences and the like draw nothing.
        for node in parent
            .children()
            .filter(|node| node.is_element() && is_svg(*node))
        {
            // Of a `switch`, viewers draw the first child without requirements.
            let choice = parent.tag_name().name() == "switch";
            if choice
                && ["requiredExtensions", "systemLanguage"]
                    .iter()
                    .any(|name| node.has_attribute(*name))
            {
                continue;
            }
            self.element(node, &within)?;
            if choice {
                break;
            }
        }
        Ok(())
    }

    fn element(&mut self, node: Node<'d, 'd>, context: &Context) -> Result<()> {
        self.elements += 1;
        if self.elements > MOST_NODES {
            let message = format!("the drawing has more than {MOST_NODES} elements");
            let help = "keep only the shapes that are needed: a <use> draws all that it refers to";
            return Err(self.source.error(span(node), message, help));
        }
        let name = node.tag_name().name();
        if NOT_DRAWN.contains(&name) || (name == "style" && moves_nothing(&text(node))) {
            return Ok(());
        }
        let container = matches!(name, "g" | "a" | "switch" | "svg" | "use");
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
        let mut context = context.clone();
        context.map *= self.transform(node)?;
        context.paint = context.paint.of(node);
        context.ids.extend(node.attribute("id").map(str::to_owned));
        match name {
            "svg" => self.viewport(node, &context, node),
            "use" => self.used(node, context),
            _ if container => self.children(node, &context),
            _ => self.shape(node, &context),
        }
    }

    /// Reads the element that a `<use>` draws.
    fn used(&mut self, node: Node<'d, 'd>, mut context: Context) -> Result<()> {
        let link = node
            .attribute("href")
            .or_else(|| node.attribute((XLINK, "href")));
        let link = link.unwrap_or_default().trim();
        let target = link.strip_prefix('#').and_then(|id| self.by_id.get(id));
        let Some(&target) = target else {
            let link: String = link.chars().take(40).collect();
            let note = format!("<use> of \"{link}\", which is not in the drawing");
            self.skipped.push((span(node), note));
            return Ok(());
        };
        context.depth += 1;
        if context.depth > MOST_NESTED || node.ancestors().any(|above| above == target) {
            let message = "this <use> refers to itself";
            let help = "remove it, or let it refer to a shape";
            return Err(self.source.error(span(node), message, help));
        }
        let (x, y) = (
            self.length(node, "x", &context)?,
            self.length(node, "y", &context)?,
        );
        context.map *= Affine::translate((x.unwrap_or(0.0), y.unwrap_or(0.0)));
        match target.tag_name().name() {
            "symbol" | "svg" => {
                if let Some(reason) = hidden(target) {
                    let note = format!("<{}> ({reason})", target.tag_name().name());
                    self.skipped.push((span(target), note));
                    return Ok(());
                }
                self.refuse_unread_transforms(target, false)?;
                context.map *= self.transform(target)?;
                context.paint = context.paint.of(target);
                context
                    .ids
                    .extend(target.attribute("id").map(str::to_owned));
                self.viewport(target, &context, node)
            }
            _ => self.element(target, &context),
        }
    }

    /// Reads the contents of a nested `<svg>` or `<symbol>`, which has a viewport of its own. The
    /// size given by `sized`, a `<use>` of it, takes precedence.
    fn viewport(
        &mut self,
        node: Node<'d, 'd>,
        context: &Context,
        sized: Node<'d, 'd>,
    ) -> Result<()> {
        let [x, y] = [
            self.length(node, "x", context)?,
            self.length(node, "y", context)?,
        ];
        let (x, y) = (x.unwrap_or(0.0), y.unwrap_or(0.0));
        let view_box = view_box(self.source, node)?;
        let own = [
            self.length(sized, "width", context)?,
            self.length(sized, "height", context)?,
        ];
        let other = [
            self.length(node, "width", context)?,
            self.length(node, "height", context)?,
        ];
        let whole = context.viewport.map_or([None; 2], |size| size.map(Some));
        let [w, h] = [0, 1].map(|k| own[k].or(other[k]).or(whole[k]));
        // Without a view box, the size only clips.
        let (Some(w), Some(h)) = (w.or(view_box.map(|v| v.w)), h.or(view_box.map(|v| v.h))) else {
            return self.children(node, context);
        };
        if w <= 0.0 || h <= 0.0 {
            let note = format!("<{}> without a size", node.tag_name().name());
            self.skipped.push((span(node), note));
            return Ok(());
        }
        let inner = Context {
            map: context.map
                * match view_box {
                    Some(view_box) => fitted(node, view_box, [x, y, w, h]),
                    None => Affine::translate((x, y)),
                },
            viewport: Some(view_box.map_or([w, h], |view_box| [view_box.w, view_box.h])),
            ..context.clone()
        };
        let before = self.shapes.len();
        self.children(node, &inner)?;
        let window = context.map.inverse();
        let outside = |p: [f64; 2]| {
            let p = window * Point::new(p[0], p[1]);
            let beyond = (x - p.x).max(p.x - x - w).max(y - p.y).max(p.y - y - h);
            beyond > WINDOW_SHARE * w.max(h)
        };
        let drawn = self.shapes[before..].iter().flat_map(|shape| &shape.lines);
        if property(node, "overflow").is_none_or(|value| value != "visible")
            && drawn.flat_map(Line::points).any(outside)
        {
            let note = format!("that <{}> clips its content", node.tag_name().name());
            self.skipped.push((span(node), note));
        }
        Ok(())
    }

    /// The width and height of an element (user units).
    fn size(&self, node: Node, viewport: Viewport) -> std::result::Result<[f64; 2], ()> {
        let of = |name| path::length(node, name, viewport).ok().flatten().ok_or(());
        Ok([of("width")?, of("height")?])
    }

    fn length(&self, node: Node, name: &'static str, context: &Context) -> Result<Option<f64>> {
        let length = path::length(node, name, context.viewport);
        length.map_err(|fault| self.fault(node, fault))
    }

    /// The fault of an attribute, at its place.
    fn fault(&self, node: Node, fault: Fault) -> DesignError {
        let place = node.attribute_node(fault.attribute);
        let place = place.map_or(span(node), |attribute| {
            let value = attribute.range_value();
            let written = &self.source.text[value.clone()];
            let at = fault.character.and_then(|character| {
                // Past the end, the last character is marked.
                written.char_indices().take(character + 1).last()
            });
            match at {
                Some((at, c)) => (value.start + at..value.start + at + c.len_utf8()).into(),
                None => value.into(),
            }
        });
        let help = "fix the shape, or convert it to a path in the drawing program";
        self.source.error(place, fault.message, help)
    }

    fn shape(&mut self, node: Node, context: &Context) -> Result<()> {
        let mut pen = Pen::default();
        draw(node, context.viewport, &mut pen).map_err(|fault| self.fault(node, fault))?;
        let overdrawn = pen.overdrawn();
        let mut strokes = pen.finish();
        for stroke in &mut strokes {
            stroke.transform(context.map);
        }
        self.check_extent(node, &strokes)?;
        if overdrawn {
            let message =
                "an arc is almost straight: its radius is over a million times its length";
            let help = "draw it as a line";
            return Err(self.source.error(span(node), message, help));
        }
        let chord_error = chord_error(&strokes);
        let lines = lines(&strokes, chord_error, MOST_POINTS - self.points).ok_or_else(|| {
            let message = format!("the drawing has more than {MOST_POINTS} points");
            let help = "keep only the shapes that are needed, and simplify them";
            self.source.error(span(node), message, help)
        })?;
        if lines.is_empty() {
            let note = format!("<{}> that draws nothing", node.tag_name().name());
            self.skipped.push((span(node), note));
            return Ok(());
        }
        self.shapes.push(DrawnShape {
            element: node.tag_name().name().to_owned(),
            ids: context.ids.clone(),
            span: span(node),
            painted: self.styled || context.paint.fill || context.paint.stroke,
            strokes,
            lines,
            chord_error,
        });
        Ok(())
    }

    /// Rejects shapes too far from the origin, before curves become chords. Curves stay within the
    /// hull of their control points.
    fn check_extent(&self, node: Node, strokes: &[Stroke]) -> Result<()> {
        let pieces = strokes.iter().flat_map(|s| s.segments.iter().flatten());
        let farthest = pieces
            .map(PathSeg::to_cubic)
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

    /// Rejects transforms that are not read.
    fn refuse_unread_transforms(&self, node: Node, root: bool) -> Result<()> {
        let help = "apply the transform in the drawing program";
        let transformed = node.has_attribute("transform");
        if style(node).any(|(name, _)| name == "transform")
            || (transformed && property(node, "transform-origin").is_some())
        {
            let message = "transforms in styles and about other origins are not read";
            return Err(self.source.error(span(node), message, help));
        }
        if root && transformed {
            let message = "a transform of the whole drawing is not read";
            return Err(self.source.error(span(node), message, help));
        }
        Ok(())
    }
}

/// The largest distance (m) of chords from the curves of one shape, by its size.
pub(super) fn chord_error<'a>(strokes: impl IntoIterator<Item = &'a Stroke>) -> f64 {
    let segments = strokes.into_iter().flat_map(|stroke| &stroke.segments);
    let [longer, shorter] = sides(segments.flatten());
    let flat = CHORD_SHARE * shorter;
    match CHORD_SHARE_OF_SHAPE * longer {
        error if flat > 0.0 => error.min(flat),
        error => error,
    }
}

/// The lines of some strokes, with chords that are within the error (m) of the curves; `None` if
/// they have more than `most` points.
fn lines(strokes: &[Stroke], chord_error: f64, most: usize) -> Option<Vec<Line>> {
    let mut lines = Vec::with_capacity(strokes.len());
    let mut count = 0;
    for stroke in strokes {
        let mut segments = Vec::with_capacity(stroke.segments.len());
        for segment in &stroke.segments {
            let [longer, _] = sides(segment);
            let error = chord_error.min(CHORD_SHARE_OF_CURVE * longer);
            let points = points(segment, error);
            count += points.len();
            if count > most {
                return None;
            }
            let arc = points.len() > 1 && is_arc(segment, OFF_ARC_SHARE * error);
            segments.push(Segment { points, arc });
        }
        lines.push(Line {
            start: [stroke.start.x, stroke.start.y],
            segments,
            closed: stroke.closed,
            closing: stroke.closing,
        });
    }
    Some(lines)
}

/// The longer and the shorter side (m) of the box around the control points of some segments.
fn sides<'a>(segments: impl IntoIterator<Item = &'a PathSeg>) -> [f64; 2] {
    let cubics = segments.into_iter().map(PathSeg::to_cubic);
    let points = cubics.flat_map(|it| [it.p0, it.p1, it.p2, it.p3]);
    let [low, high] = extent(points.map(|p| Vector2::new(p.x, p.y)));
    let [width, height] = <[f64; 2]>::from(high - low).map(|side| side.max(0.0));
    [width.max(height), width.min(height)]
}

/// Whether an element belongs to SVG; a drawing without any namespace counts as SVG.
fn is_svg(node: Node) -> bool {
    node.tag_name()
        .namespace()
        .is_none_or(|uri| uri == NAMESPACE)
}

/// The text that an element holds.
fn text(node: Node) -> String {
    let texts = node.descendants().filter(Node::is_text);
    texts.filter_map(|text| text.text()).collect()
}

/// Whether a style sheet has none of the properties that shape, move or hide elements.
fn moves_nothing(sheet: &str) -> bool {
    let mut plain = String::new();
    for (k, part) in sheet.split("/*").enumerate() {
        let after = part.split_once("*/").map_or("", |(_, after)| after);
        plain.push_str(if k == 0 { part } else { after });
    }
    let names = plain
        .split(['{', '}', ';'])
        .filter_map(|declaration| declaration.split_once(':'));
    let mut names = names.map(|(name, _)| name.trim());
    !plain.contains("@import") && !names.any(|name| TELLING.contains(&name))
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

/// Why an element is invisible.
fn hidden(node: Node) -> Option<&'static str> {
    if property(node, "display") == Some("none") {
        return Some("not displayed");
    }
    let invisible = matches!(property(node, "visibility"), Some("hidden" | "collapse"));
    invisible.then_some("hidden")
}

/// The byte of a position from the XML parser, with row and column from 1.
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
