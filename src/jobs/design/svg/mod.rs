//! Lines and outlines drawn in SVG files, as drawing and CAD programs write them.
//!
//! A drawing is read in metres, with y upwards. Its size comes from `width`, `height` and `viewBox`
//! of the file, which must have a physical unit, or from `unit` or `dpi` of the design, the length
//! of a user unit; if both are given they must agree. `path`, `polygon`, `polyline`, `rect`,
//! `circle`, `ellipse` and `line` are read, also through `use`, `symbol`, `switch` and nested `svg`
//! with their view boxes; transforms are composed. Warnings name any other visible elements, and
//! style sheets that move or hide shapes. Transforms that are not read (in an element's `style`, or
//! with another origin) are errors.
//!
//! This module has its own reader so that every error and warning can name an element and its line,
//! and arcs stay arcs: `usvg` returns paths without positions, in single precision, with arcs as
//! cubics, and silently omits what it cannot read.
//!
//! Curves become chords. The distance of a chord from its curve is limited to a share of the size
//! of the curve and of its whole shape ([`document::chord_error`]). Arcs are approximated by cubics
//! within a millionth of their radius, so that the ends of their chords are within a
//! hundred-thousandth; which points lie on an arc is recorded for workshop files. Lines with very
//! many points, such as those of tracing programs, are simplified: points within half the chord
//! error of the rest are removed, and curves are drawn to within the other half.
//!
//! Lines whose ends meet are one line ([`join`]); gaps up to 0.1 mm are closed with a warning.
//! Shapes without fill and stroke are ignored with a warning, if others have them.
//!
//! A drawing with several shapes needs `id`: that of the shape, or of a group that contains only
//! its lines. The other shapes are then ignored.
//!
//! - A *profile* ([`line`](mod@line)) is one line drawn as the graph of h over s: s to the right, h
//!   upwards, in either direction. Its ends are on the base line, and the middle between them is at
//!   s = `offset` (default 0). A line traced from a tile seen from above is therefore mirrored, as
//!   s runs counter-clockwise. A closed line is interpreted as a piece on the base line: its lowest
//!   edge is removed.
//! - An *outline* ([`outline`]) is one closed line, drawn as the tile is seen from above. The
//!   tile's reference point is the centre of its area. Each drawn segment is a face, straight or
//!   curved, counter-clockwise from the start of the line; with `corners`, each part between two
//!   corners is a face, counter-clockwise from the first corner. The base line of a face is
//!   straight.

mod document;
mod join;
mod line;
mod outline;
mod path;
mod pen;
mod scale;
mod simplify;

pub(super) use line::read_line;
#[cfg(test)]
pub(super) use outline::OUTLINE_KEYS;
pub(super) use outline::read_outline;
pub(super) use scale::UNITS;

use std::collections::HashMap;

use super::drawings;
use super::error::{DesignError, Result, Span};
use super::quantity;
use super::reader::{Entry, Section, nearest_help};
use super::source::Source;
use document::{Drawing, DrawnShape, Skipped};
use path::INCH;

/// Largest distance (m) of two points that are meant to coincide: files are precise to micrometres
/// at best.
const SAME_POINT: f64 = 1e-6;

/// Largest number of kinds of ignored elements that a warning names.
const MOST_TOLD: usize = 8;

/// Calls `use_it` with the drawing that `entry` names.
fn with_drawing<T>(entry: &Entry, use_it: impl FnOnce(&Source) -> Result<T>) -> Result<T> {
    let name = entry.path()?;
    let Source {
        file,
        drawings,
        faults,
        ..
    } = entry.source;
    let text = drawings.text(file, name).map_err(|error| {
        let message = format!("cannot read the drawing \"{name}\": {error}");
        entry.error(
            message,
            "paths of drawings are relative to the design file's folder",
        )
    })?;
    use_it(&Source {
        file: &drawings::path(file, name).display().to_string(),
        text: &text,
        quoted: drawings::may_be_quoted(file, name),
        drawings,
        faults,
    })
}

/// Warns of the ignored parts of a drawing.
fn note_skipped(source: &Source, skipped: &[Skipped]) {
    if let Some((at, told)) = describe(source, skipped) {
        source.drawings.note(source.doubt(
            at,
            format!("ignored in the drawing: {told}"),
            "convert whatever belongs to the shape to a path; delete the rest",
        ));
    }
}

/// The names of a drawing's ignored parts, and the place of the first.
fn describe(source: &Source, skipped: &[Skipped]) -> Option<(Span, String)> {
    let &(first, _) = skipped.first()?;
    let line = |at: usize| source.text[..at].matches('\n').count() + 1;
    // In the order of their first places, each kind once.
    let mut kinds: Vec<(&str, usize, usize)> = Vec::new();
    let mut numbers = HashMap::new();
    for (span, what) in skipped {
        let number = *numbers.entry(what.as_str()).or_insert(kinds.len());
        match kinds.get_mut(number) {
            Some(kind) => kind.2 += 1,
            None => kinds.push((what, span.start, 0)),
        }
    }
    let mut told: Vec<String> = kinds
        .iter()
        .take(MOST_TOLD)
        .map(|&(what, at, more)| match more {
            0 => format!("{what} in line {}", line(at)),
            _ => format!("{what} in line {} and {more} more of it", line(at)),
        })
        .collect();
    if kinds.len() > MOST_TOLD {
        told.push(format!("and {} more kinds", kinds.len() - MOST_TOLD));
    }
    Some((first, told.join(", ")))
}

/// The length (m) of a user unit that a section states with `unit` or `dpi`.
fn user_unit(section: &Section) -> Result<Option<f64>> {
    match (section.get("unit"), section.get("dpi")) {
        (Some(_), Some(dpi)) => Err(dpi.key_error(
            "`unit` and `dpi` both set the length of a user unit",
            "keep one of the two",
        )),
        (None, Some(dpi)) => Ok(Some(INCH / dpi.number(quantity::DPI)?)),
        (Some(unit), None) => match unit.is_quantity() {
            true => Ok(Some(unit.number(quantity::DRAWING_UNIT)?)),
            false => Ok(Some(unit.word(&UNITS)?)),
        },
        (None, None) => Ok(None),
    }
}

/// Calls `use_it` with the shape that a section names with `file`, `unit`, `dpi` and `id`, and its
/// drawing. Lines whose ends meet are joined.
fn with_shape<T>(
    section: &Section,
    use_it: impl FnOnce(&Source, &DrawnShape) -> Result<T>,
) -> Result<T> {
    let file = section.require("file", "give the drawing: file = \"tile.svg\"")?;
    let unit = user_unit(section)?;
    let id = section.get("id");
    with_drawing(&file, |source| {
        let drawing = document::read(*source, unit)?;
        note_skipped(source, &drawing.skipped);
        let chosen = choose(source, &drawing, id);
        if !drawing.sized {
            let chosen = chosen.as_deref().unwrap_or(&[]);
            return Err(unsized_error(source, &drawing, chosen));
        }
        let chosen: Vec<&DrawnShape> = chosen?.iter().map(|&k| &drawing.shapes[k]).collect();
        // For the whole shape, which may be drawn in pieces.
        let error = document::chord_error(chosen.iter().flat_map(|shape| &shape.strokes));
        let drawn = |error| -> Vec<DrawnShape> {
            let drawn = chosen.iter().map(|shape| shape.with_chords(error));
            drawn.collect()
        };
        let mut shapes = drawn(error);
        if shapes.iter().map(DrawnShape::points).sum::<usize>() > simplify::MANY {
            // Removing points must not exceed the chord error of any curve.
            shapes = drawn((1.0 - simplify::SHARE) * error);
        }
        let whole = DrawnShape {
            chord_error: error,
            ..merged(source, &shapes)?
        };
        use_it(source, &whole)
    })
}

/// The indices of the selected shapes: those with the id, or all painted ones.
fn choose(source: &Source, drawing: &Drawing, id: Option<Entry>) -> Result<Vec<usize>> {
    let shapes = || drawing.shapes.iter().enumerate();
    if let Some(entry) = id {
        let wanted = entry.string()?;
        let found = shapes().filter(|(_, shape)| shape.ids.iter().any(|id| id == wanted));
        let found: Vec<usize> = found.map(|(k, _)| k).collect();
        if !found.is_empty() {
            return Ok(found);
        }
        let mut ids: Vec<&str> = Vec::new();
        for (_, shape) in shapes() {
            ids.extend(shape.ids.last().map(String::as_str));
        }
        ids.dedup();
        return Err(match drawing.ids.get(wanted) {
            Some(element) => entry.error(
                format!("\"{wanted}\", a <{element}>, draws nothing that can be read"),
                "convert it to a path in the drawing program",
            ),
            None => entry.error(
                format!("the drawing has no shape with the id \"{wanted}\""),
                match ids.is_empty() {
                    true => {
                        "remove `id`, or give a shape this id in the drawing program".to_owned()
                    }
                    false => nearest_help(wanted, &ids),
                },
            ),
        });
    }
    let all: Vec<usize> = shapes().map(|(k, _)| k).collect();
    let painted: Vec<usize> = all
        .iter()
        .copied()
        .filter(|&k| drawing.shapes[k].painted)
        .collect();
    if !painted.is_empty() {
        let left: Vec<Skipped> = shapes()
            .filter(|(_, shape)| !shape.painted)
            .map(|(_, shape)| {
                (
                    shape.span,
                    format!("<{}> (no fill, no stroke)", shape.element),
                )
            })
            .collect();
        note_skipped(source, &left);
        return Ok(painted);
    }
    if all.is_empty() {
        let (at, message) = match describe(source, &drawing.skipped) {
            Some((at, told)) => (
                at,
                format!("the drawing has no shape that can be read, but {told}"),
            ),
            None => ((0..0).into(), "the drawing has no shape".to_owned()),
        };
        let help = "draw a path; convert text and strokes to paths";
        return Err(source.error(at, message, help));
    }
    Ok(all)
}

/// One shape of several, their lines joined where they meet.
fn merged(source: &Source, shapes: &[DrawnShape]) -> Result<DrawnShape> {
    let (lines, widest) = join::joined(source, shapes);
    let first = &shapes[0];
    if let (2.., [_, second, ..]) = (lines.len(), shapes) {
        let open = lines.iter().filter(|line| !line.closed).count();
        let nearest = join::nearest_ends(&lines).filter(|_| open == lines.len());
        if let Some((gap, [x, y])) = nearest {
            let [gap, x, y, widest] = [gap, x, y, widest].map(|x| quantity::four_digits(1e3 * x));
            return Err(source.error(
                second.span,
                format!(
                    "the drawing's {} shapes join to {} open lines instead of one: the nearest \
                     open ends are {gap} mm apart, near x = {x} mm, y = {y} mm (y upwards)",
                    shapes.len(),
                    lines.len()
                ),
                format!("let the ends meet; gaps up to {widest} mm are closed"),
            ));
        }
        let ids = shapes.iter().find_map(|shape| shape.ids.last());
        return Err(source.error(
            second.span,
            format!(
                "the drawing has {} shapes; this is the second",
                shapes.len()
            ),
            match ids {
                None => "keep one shape".to_owned(),
                Some(id) => format!("keep one, or select one in the design: id = \"{id}\""),
            },
        ));
    }
    Ok(DrawnShape {
        lines,
        ..first.clone()
    })
}

/// The fault of a drawing without a scale; it lists the sizes of the selected shape, or of the
/// whole drawing, for possible units. The drawing was read in mm.
fn unsized_error(source: &Source, drawing: &Drawing, chosen: &[usize]) -> DesignError {
    let shapes = &drawing.shapes;
    let meant = |k: &usize| chosen.is_empty() || chosen.contains(k);
    let meant = (0..shapes.len())
        .filter(meant)
        .flat_map(|k| &shapes[k].lines);
    let [width, height] = join::size(meant.flat_map(document::Line::points));
    let drawn = |name: &str, unit: f64| {
        let [width, height] = [width, height].map(|x| quantity::four_digits(1e6 * x * unit));
        format!("{name} (the drawing is then {width} x {height} mm)")
    };
    let units = UNITS
        .iter()
        .filter(|(name, _)| matches!(*name, "px" | "pt" | "mm"));
    let units = units.map(|(name, unit)| drawn(&format!("unit = \"{name}\""), *unit));
    let mut units: Vec<String> = units.rev().collect();
    units.push(drawn("dpi = 300", INCH / 300.0));
    source.error(
        drawing.root,
        "the drawing does not give its size: its width and height are not in mm, cm, in, pt or pc",
        format!(
            "give the length of a user unit in the design: {}; or write width and height with \
             units in the drawing, such as width=\"430mm\"",
            units.join(", ")
        ),
    )
}

/// The one line of a shape.
fn only_line<'a>(source: &Source, shape: &'a DrawnShape) -> Result<&'a document::Line> {
    match shape.lines.as_slice() {
        [line] => Ok(line),
        lines => Err(source.error(
            shape.span,
            format!(
                "this {} draws {} lines, not one",
                shape.element,
                lines.len()
            ),
            match join::nearest_ends(lines).filter(|_| lines.iter().all(|line| !line.closed)) {
                Some((gap, _)) => format!(
                    "draw one line, or lines whose ends meet: the nearest are {} mm apart",
                    quantity::four_digits(1e3 * gap)
                ),
                None => "a tile has one outline and no holes; break the path apart and delete the \
                    others"
                    .to_owned(),
            },
        )),
    }
}
