//! A tile's outline drawn as a closed line.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use super::super::error::Result;
use super::super::quantity;
use super::super::reader::Entry;
use super::super::source::Source;
use super::document::DrawnShape;
use super::join::{extent, size};
use super::line::apart;
use super::simplify::{MANY, simplified};
use super::{SAME_POINT, only_line, with_shape};
use physics::tile::Face;
use physics::tile::outline::{Outline, OutlineError, centroid, cross};
use physics::tile::profile::{Arcs, Polyline};

/// The keys of `outline`.
pub(in crate::design) const OUTLINE_KEYS: [&str; 5] = ["file", "unit", "dpi", "id", "corners"];

/// Largest distance (m) of a corner from the drawn point it names: a curved side moves the centre
/// of the area.
const NEAR: f64 = 1e-3;

/// The same as a share of the outline's longer side.
const NEAR_SHARE: f64 = 0.02;

/// Largest number of faces of a tile.
const MOST_FACES: usize = 64;

/// The drawn segments in order, counter-clockwise and closed. Each has all its points; its last
/// point is the first of the next segment.
type Segments = Vec<Vec<Vector2<f64>>>;

/// A corner, with the line and the arcs of the face that begins there.
type Drawn = (Vector2<f64>, (Polyline, Arcs));

/// The ends of an arc.
type Ends = [Vector2<f64>; 2];

/// The corners of a drawn outline, each with the line and the arcs of the face that begins there.
pub(in crate::design) fn read_outline(entry: &Entry) -> Result<Vec<Drawn>> {
    let section = entry.section("`outline`")?;
    section.allow(&OUTLINE_KEYS);
    let (segments, arcs) = with_shape(&section, |source, shape| {
        let (mut segments, centre, arcs) = closed(source, shape)?;
        if let Some(corners) = section.get("corners") {
            segments = joined(&segments, &corners)?;
        }
        if segments.len() > MOST_FACES {
            return Err(entry.error(
                format!(
                    "the outline is drawn in {} segments, but a tile has at most {MOST_FACES} \
                     faces",
                    segments.len()
                ),
                "mark where its faces meet: corners = [[x, y], ...] (m, from the centre of its \
                 area)",
            ));
        }
        let drawn = ring(&segments).len();
        let segments = simplified(source, shape, segments)?;
        if drawn > MANY {
            let points = ring(&segments).iter().map(|point| point + centre).collect();
            sound(source, shape, points)?;
        }
        Ok((segments, arcs))
    })?;
    let face = |points: &Vec<Vector2<f64>>| {
        // Arcs are found by their ends, which may have been removed by simplification.
        let place = |end: &Vector2<f64>| points.iter().position(|point| point == end);
        let arcs = arcs.iter().filter_map(|[first, last]| {
            let (first, last) = (place(first)?, points.iter().rposition(|p| p == last)?);
            (last >= first + 2).then_some([first, last])
        });
        let mut arcs: Arcs = arcs.collect();
        arcs.sort_unstable();
        (points[0], (in_face(points), arcs))
    };
    Ok(segments.iter().map(face).collect())
}

/// The points of closed segments, each once.
fn ring(segments: &Segments) -> Vec<Vector2<f64>> {
    let points = segments.iter();
    let points = points.flat_map(|segment| &segment[..segment.len() - 1]);
    points.copied().collect()
}

/// The segments of a shape's only closed line relative to the centre of its area, this centre in
/// the drawing, and its arcs. For a line with very many points, the check that it is a valid
/// outline is left to its simplified form.
fn closed(source: &Source, shape: &DrawnShape) -> Result<(Segments, Vector2<f64>, Vec<Ends>)> {
    let line = only_line(source, shape)?;
    let fault = |message: String, help: &str| source.error(shape.span, message, help);
    let mut segments: Segments = Vec::new();
    let mut arcs: Vec<bool> = Vec::new();
    let mut at = Vector2::from(line.start);
    for segment in &line.segments {
        let mut points = vec![at];
        points.extend(segment.points.iter().copied().map(Vector2::from));
        points.dedup_by(|a, b| (*a - *b).norm() <= SAME_POINT);
        // A segment without length, such as one that closes an already closed line.
        if let [_, .., end] = points[..] {
            at = end;
            segments.push(points);
            arcs.push(segment.arc);
        }
    }
    let start = Vector2::from(line.start);
    let gap = (at - start).norm();
    if gap > SAME_POINT {
        let message = format!(
            "the outline is open: its ends are {} mm apart",
            quantity::four_digits(1e3 * gap)
        );
        return Err(fault(message, "close the path"));
    }
    if let Some(end) = segments.last_mut().and_then(|segment| segment.last_mut()) {
        *end = start;
    }
    let signed: f64 = segments
        .iter()
        .flat_map(|segment| segment.windows(2))
        .map(|edge| cross(edge[0], edge[1]) / 2.0)
        .sum();
    if signed < 0.0 {
        segments.reverse();
        arcs.reverse();
        segments.iter_mut().for_each(|segment| segment.reverse());
    }
    let ring = ring(&segments);
    check_size(&ring).map_err(|message| fault(message, "check the drawing's size and unit"))?;
    let centre = if ring.len() > MANY {
        centroid(&ring)
    } else {
        sound(source, shape, ring)?.centroid()
    };
    if !(centre.x.is_finite() && centre.y.is_finite()) {
        let message = "the outline encloses no area".to_owned();
        return Err(fault(
            message,
            "draw the tile's outline as one line around it",
        ));
    }
    for point in segments.iter_mut().flatten() {
        *point -= centre;
    }
    let arcs = segments.iter().zip(arcs).filter(|(_, arc)| *arc);
    let arcs = arcs.map(|(points, _)| [points[0], points[points.len() - 1]]);
    let arcs = arcs.collect();
    Ok((segments, centre, arcs))
}

/// The outline of a drawn ring.
fn sound(source: &Source, shape: &DrawnShape, ring: Vec<Vector2<f64>>) -> Result<Outline> {
    Outline::new(ring.clone()).map_err(|error| {
        let message = match error {
            OutlineError::SelfCrossing(i, j) => {
                let n = ring.len();
                let near = (ring[i] + ring[(i + 1) % n] + ring[j] + ring[(j + 1) % n]) / 4.0;
                format!(
                    "the outline crosses or touches itself near x = {} mm, y = {} mm (y upwards)",
                    quantity::four_digits(1e3 * near.x),
                    quantity::four_digits(1e3 * near.y)
                )
            }
            other => format!("not a valid outline: {other}"),
        };
        let help = "draw the tile's outline as one line around it";
        source.error(shape.span, message, help)
    })
}

fn check_size(ring: &[Vector2<f64>]) -> std::result::Result<(), String> {
    // A drawing can shrink to a point, and nothing is left of it.
    let [width, height] = size(ring.iter().map(|p| [p.x, p.y]));
    for (what, size) in [
        ("the outline's width", width),
        ("the outline's height", height),
    ] {
        let check = quantity::TILE_SIDE.check(what, size);
        check.map_err(|(message, _)| message)?;
    }
    Ok(())
}

/// The segments joined from corner to corner, from the first corner on.
fn joined(segments: &Segments, corners: &Entry) -> Result<Segments> {
    let items = corners.array()?;
    let points = segments.iter().flatten().map(|point| [point.x, point.y]);
    let near = NEAR.max(NEAR_SHARE * extent(points));
    let mut places = Vec::with_capacity(items.len());
    for item in &items {
        let wanted = item.numbers::<2>(quantity::TILE_CORNER, "x and y of a corner")?;
        let (place, nearest) = nearest(segments, wanted);
        if apart(wanted, nearest) > near {
            let [x, y] = nearest.map(quantity::four_digits);
            return Err(item.error(
                "no point of the outline is here",
                format!("the nearest drawn point is [{x}, {y}]"),
            ));
        }
        places.push(place);
    }
    let n = segments.len();
    let from_first = |place: usize| (place + n - places[0]) % n;
    if let Some(k) = (1..places.len()).find(|&k| from_first(places[k]) <= from_first(places[k - 1]))
    {
        return Err(items[k].error(
            "this corner does not follow the one before it",
            "list each corner once, counter-clockwise around the tile",
        ));
    }
    if places.len() < 2 {
        return Err(corners.error(
            "a tile needs corners between its faces",
            "give two corners or more",
        ));
    }
    let ends = places.iter().skip(1).chain(places.first());
    let ends = ends.map(|&place| match from_first(place) {
        0 => n,
        end => end,
    });
    let starts = places.iter().map(|&place| from_first(place));
    Ok(starts
        .zip(ends)
        .map(|(start, end)| {
            let mut points = vec![segments[(places[0] + start) % n][0]];
            for k in start..end {
                points.extend(segments[(places[0] + k) % n].iter().skip(1));
            }
            points
        })
        .collect())
}

/// The index of the segment that begins nearest to a point, and its start.
fn nearest(segments: &Segments, [x, y]: [f64; 2]) -> (usize, [f64; 2]) {
    let distance = |start: &Vector2<f64>| libm::hypot(start.x - x, start.y - y);
    let starts = segments.iter().map(|segment| segment[0]).enumerate();
    let nearest = starts.min_by_key(|(_, start)| OrderedFloat(distance(start)));
    nearest.map_or((0, [f64::NAN; 2]), |(k, start)| (k, [start.x, start.y]))
}

/// The points of a face's line in its frame; empty if it is straight.
fn in_face(points: &[Vector2<f64>]) -> Polyline {
    let [start, inner @ .., end] = points else {
        return Polyline::new();
    };
    if inner.is_empty() {
        return Polyline::new();
    }
    let face = Face {
        name: String::new(),
        start: *start,
        end: *end,
    };
    let half = face.length() / 2.0;
    let mut line = vec![[-half, 0.0]];
    line.extend(inner.iter().map(|point| {
        let d = point - face.middle();
        [d.dot(&face.tangent()), d.dot(&face.normal())]
    }));
    line.push([half, 0.0]);
    line
}
