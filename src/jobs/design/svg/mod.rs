//! Lines and outlines drawn in SVG files, as Inkscape and OpenSCAD write them.
//!
//! A drawing is read in metres, y upwards. Its size comes from `width`, `height` and `viewBox` of
//! the file, which must carry a physical unit, or from `unit` of the design, the length of a user
//! unit; where both are there they must agree. Transforms of groups and shapes are composed.
//! `path`, `polygon`, `polyline`, `rect`, `circle` and `ellipse` are read; anything else that would
//! be seen is named in a warning, style sheets too, and what would move a shape without being read
//! (a transform in an element's `style`, another origin of one) is refused.
//!
//! Curves become chords between points on the curve, no chord farther from it than a share of the
//! shape's and the curve's size ([`Shape::chord_error`]). Arcs go by way of cubics that leave them by a
//! millionth of their radius. Of
//! lines with very many points, as tracing programs draw them, the points are left out that lie
//! within half the chord error of the others; curves then are drawn to within the other half.
//!
//! A drawing of several shapes needs `id`, the shape's own in the file; the other shapes then are
//! left out.
//!
//! - A *profile* ([`line`](mod@line)) is one line drawn as the graph of h over s: s to the right, h
//!   upwards, either way along. Its ends are on the base line, and the middle between them is at
//!   s = `offset`, 0 where not given. So a line traced from a tile seen from above is mirrored, as s
//!   runs counter-clockwise. A closed line is taken for a piece that stands on the base line: its
//!   lowest edge falls away.
//! - An *outline* ([`outline`]) is one closed line, drawn as the tile is seen from above. The tile's
//!   reference point is the centre of its area. Each drawn segment is a face, straight or curved,
//!   counter-clockwise from the point where the line begins; or, with `corners`, what lies between
//!   two corners is, counter-clockwise from the first one. The base line of a face is straight.

mod document;
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
use super::error::Result;
use super::reader::{Entry, Section, nearest_help};
use super::source::Source;
use document::{Shape, Skipped};

/// What two points that are meant to be one may lie apart (m): files give micrometres, if that.
const SAME_POINT: f64 = 1e-6;

/// Most kinds of what is not read that are told by name.
const MOST_TOLD: usize = 8;

/// Gives the drawing that `entry` names to `use_it`.
fn with_drawing<T>(entry: &Entry, use_it: impl FnOnce(&Source) -> Result<T>) -> Result<T> {
    let name = entry.string()?;
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
            "paths of drawings start from the design file's folder",
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

/// Notes what of a drawing is not read.
fn note_skipped(source: &Source, skipped: &[Skipped]) {
    let Some(&(first, _)) = skipped.first() else {
        return;
    };
    let line = |at: usize| source.text[..at].matches('\n').count() + 1;
    // By their first places, each kind once.
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
    source.drawings.note(source.doubt(
        first,
        format!("not read of the drawing: {}", told.join(", ")),
        "what belongs to the shape is to be converted to a path; delete the rest",
    ));
}

/// Gives the shape that a section asks for with `file`, `unit` and `id` to `use_it`, with the
/// drawing that it is in.
fn with_shape<T>(
    section: &Section,
    use_it: impl FnOnce(&Source, &Shape) -> Result<T>,
) -> Result<T> {
    let file = section.require("file", "name the drawing: file = \"tile.svg\"")?;
    let unit = section
        .get("unit")
        .map(|entry| entry.word(&UNITS))
        .transpose()?;
    let id = section.get("id");
    with_drawing(&file, |source| {
        let (shapes, skipped) = document::read(*source, unit, 1.0)?;
        note_skipped(source, &skipped);
        let use_it = |index: usize| match &shapes[index] {
            shape if shape.points() <= simplify::MANY => use_it(source, shape),
            // What is left out of it must leave no curve by more than the chord error.
            _ => {
                let (shapes, _) = document::read(*source, unit, 1.0 - simplify::SHARE)?;
                use_it(source, &shapes[index])
            }
        };
        let ids: Vec<&str> = shapes.iter().filter_map(|s| s.id.as_deref()).collect();
        if let Some(entry) = id {
            let wanted = entry.string()?;
            let found = shapes.iter().position(|s| s.id.as_deref() == Some(wanted));
            let missing = || {
                let message = format!("the drawing has no shape with the id \"{wanted}\"");
                entry.error(message, nearest_help(wanted, &ids))
            };
            return use_it(found.ok_or_else(missing)?);
        }
        match shapes.as_slice() {
            [_] => use_it(0),
            [] => Err(source.error(
                (0..0).into(),
                "the drawing holds no shape",
                "draw a path; text and strokes are to be converted to paths",
            )),
            [_, second, ..] => Err(source.error(
                second.span,
                format!(
                    "the drawing holds {} shapes; this is the second",
                    shapes.len()
                ),
                match ids.as_slice() {
                    [] => "keep one shape".to_owned(),
                    ids => format!("keep one, or say which in the design: id = \"{}\"", ids[0]),
                },
            )),
        }
    })
}

/// The one line of a shape.
fn only_line<'a>(source: &Source, shape: &'a Shape) -> Result<&'a document::Line> {
    match shape.lines.as_slice() {
        [line] => Ok(line),
        lines => Err(source.error(
            shape.span,
            format!(
                "this {} draws {} lines, not one",
                shape.element,
                lines.len()
            ),
            "a tile has one outline and no holes; break the path apart and delete the others",
        )),
    }
}
