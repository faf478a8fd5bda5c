//! A face profile drawn as a line.

use nalgebra::Vector2;

use super::super::error::Result;
use super::super::quantity;
use super::super::reader::Section;
use super::super::source::Source;
use super::document::{DrawnShape, Line};
use super::simplify::simplified;
use super::{SAME_POINT, only_line, with_shape};
use physics::tile::outline::{Outline, OutlineError};
use physics::tile::profile::{Arcs, Polyline};

/// Largest distance (m) of the ends from a common base line: the resolution of six digits of a tile
/// in mm.
const SAME_HEIGHT: f64 = 1e-5;

/// The line of a profile `shape = "svg"`, as points (s, h).
pub(in crate::design) fn read_line(section: &Section) -> Result<(Polyline, Arcs)> {
    let offset = section
        .number("offset", quantity::ALONG_FACE)?
        .unwrap_or(0.0);
    let (mut line, arcs) = with_shape(section, |source, shape| {
        let line = only_line(source, shape)?;
        let points = if line.closed || apart(line.end(), line.start) <= SAME_POINT {
            standing(source, shape, line)?
        } else {
            line.points().collect()
        };
        let (drawn, reversed, shift) = on_base_line(source, shape, points)?;
        let arcs = arc_ends(line).into_iter().filter_map(|[first, last]| {
            let place = |p: [f64; 2]| {
                let moved = [p[0] - shift[0], p[1] - shift[1]];
                drawn.iter().position(|q| apart(*q, moved) <= SAME_POINT)
            };
            let (first, last) = (place(first)?, place(last)?);
            let (first, last) = if reversed {
                (last, first)
            } else {
                (first, last)
            };
            (last >= first + 2).then_some([first, last])
        });
        let mut arcs: Arcs = arcs.collect();
        arcs.sort_unstable();
        Ok((drawn, arcs))
    })?;
    for point in &mut line {
        point[0] += offset;
    }
    Ok((line, arcs))
}

/// The ends of each arc of a line.
fn arc_ends(line: &Line) -> Vec<[[f64; 2]; 2]> {
    let mut at = line.start;
    let mut ends = Vec::new();
    for segment in &line.segments {
        let end = segment.points.last().copied().unwrap_or(at);
        if segment.arc {
            ends.push([at, end]);
        }
        at = end;
    }
    ends
}

pub(super) fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

/// The points of a closed line without its lowest edge, from one end of this edge to the other.
fn standing(source: &Source, shape: &DrawnShape, line: &Line) -> Result<Vec<[f64; 2]>> {
    let mut ring: Vec<[f64; 2]> = line.points().collect();
    if apart(ring[0], ring[ring.len() - 1]) <= SAME_POINT {
        ring.pop();
    }
    let n = ring.len();
    let lowest = ring.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
    let low = |k: usize| ring[k % n][1] - lowest <= SAME_HEIGHT;
    let on_it: Vec<usize> = (0..n).filter(|&k| low(k) && low(k + 1)).collect();
    let [base] = on_it[..] else {
        return Err(source.error(
            shape.span,
            "a closed line must have one edge on the base line",
            "draw the profile as an open line, from its left end to its right end",
        ));
    };
    Ok((1..=n).map(|k| ring[(base + k) % n]).collect())
}

/// The points from left to right, with the middle between the ends at s = 0 and the ends at h = 0;
/// also whether they were reversed, and the translation.
fn on_base_line(
    source: &Source,
    shape: &DrawnShape,
    mut points: Vec<[f64; 2]>,
) -> Result<(Polyline, bool, [f64; 2])> {
    let fault = |message: String, help: &str| Err(source.error(shape.span, message, help));
    let last = points.len() - 1;
    let reversed = points[0][0] > points[last][0];
    if reversed {
        points.reverse();
    }
    let ([left, h_left], [right, h_right]) = (points[0], points[last]);
    let width = right - left;
    if let Err((message, _)) = quantity::PROFILE_WIDTH.check("the line's width", width) {
        let help = "its ends are on the face's base line, left and right; check the drawing's \
            size and unit";
        return fault(message, help);
    }
    if (h_left - h_right).abs() > SAME_HEIGHT {
        let message = format!(
            "the line's ends are not on one base line: one is {} mm higher",
            quantity::four_digits(1e3 * (h_left - h_right).abs())
        );
        return fault(message, "draw both ends at the same height");
    }
    let (middle, height) = ((left + right) / 2.0, (h_left + h_right) / 2.0);
    for point in &mut points {
        *point = [point[0] - middle, point[1] - height];
    }
    points[0][1] = 0.0;
    points[last][1] = 0.0;
    points.dedup_by(|a, b| apart(*a, *b) <= SAME_POINT);
    let points = simplified(source, shape, vec![points])?.concat();
    if let Some([s, h]) = crossing(&points) {
        let message = format!(
            "the line crosses or touches itself, or the base line beyond its ends, near s = {} mm, \
             h = {} mm",
            quantity::four_digits(1e3 * s),
            quantity::four_digits(1e3 * h)
        );
        return fault(
            message,
            "draw the profile as one line, from its left end to its right end",
        );
    }
    Ok((points, reversed, [middle, height]))
}

/// A point near which a line from left to right crosses or touches itself, or the base line on
/// either side of it.
fn crossing(points: &[[f64; 2]]) -> Option<[f64; 2]> {
    // Closes the outline far beyond the line, with the base line and a tile below it.
    let reach = points
        .iter()
        .flatten()
        .fold(1.0, |most: f64, x| most.max(x.abs()));
    let far = 3.0 * reach;
    let below = [[far, 0.0], [far, -far], [-far, -far], [-far, 0.0]];
    let ring = points.iter().chain(&below).rev().copied();
    let ring: Vec<Vector2<f64>> = ring.map(Vector2::from).collect();
    match Outline::new(ring.clone()) {
        Err(OutlineError::SelfCrossing(i, _)) => Some(ring[i].into()),
        _ => None,
    }
}
