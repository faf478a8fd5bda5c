//! Joins lines where their ends meet: drawing programs draw an outline as one line, as a path of
//! several, or as an element for each side, and leave gaps too small to see.

use kurbo::{Point, Vec2};

use super::super::quantity::four_digits;
use super::super::source::Source;
use super::SAME_POINT;
use super::document::{DrawnShape, Line, Segment};
use super::line::apart;
use nalgebra::Vector2;
use physics::tile::outline;

/// Widest gap that is closed (m): half the kerf of laser cutters.
const WIDEST_GAP: f64 = 1e-4;

/// The same as a share of the drawn lines' extent, for very small tiles.
const WIDEST_SHARE: f64 = 0.01;

/// Longest closing piece that counts as a gap, relative to the adjacent segments.
const SHORT: f64 = 0.1;

/// Largest number of lines that are joined: their ends may all be close together.
const MOST_LINES: usize = 10_000;

/// The lines of some shapes, joined where their ends meet, and the allowed width of gaps (m).
/// Visible gaps are closed with a warning.
pub(super) fn joined(source: &Source, shapes: &[DrawnShape]) -> (Vec<Line>, f64) {
    let all = || shapes.iter().flat_map(|shape| &shape.lines);
    let widest = WIDEST_GAP.min(WIDEST_SHARE * extent(all().flat_map(Line::points)));
    let (closed, open): (Vec<Line>, Vec<Line>) = all()
        .map(|line| opened(line, widest))
        .partition(|line| line.closed || apart(line.start, line.end()) <= SAME_POINT);
    if open.len() > MOST_LINES {
        return (all().cloned().collect(), widest);
    }
    let links = links(&open, widest);
    let mut gaps: Vec<(f64, [f64; 2])> = Vec::new();
    let mut lines = closed;
    lines.extend(chained(&open, &links, &mut gaps));
    let worst = gaps
        .iter()
        .copied()
        .reduce(|a, b| if b.0 > a.0 { b } else { a });
    if let (Some((gap, [x, y])), Some(first)) = (worst, shapes.first()) {
        let [gap, x, y] = [gap, x, y].map(|length| four_digits(1e3 * length));
        let place = format!("near x = {x} mm, y = {y} mm (y upwards)");
        let message = match gaps.len() {
            1 => format!("closed a gap of {gap} mm between ends of the line, {place}"),
            many => format!(
                "closed {many} gaps between ends of lines; the widest, {gap} mm, is {place}"
            ),
        };
        let limit = four_digits(1e3 * widest);
        let help = format!("let the ends meet; gaps up to {limit} mm are closed");
        source
            .drawings
            .note(source.doubt(first.span, message, help));
    }
    (lines, widest)
}

/// The two closest ends of different lines: their distance (m) and positions.
pub(super) fn nearest_ends(lines: &[Line]) -> Option<(f64, [f64; 2])> {
    let few = &lines[..lines.len().min(1000)];
    let ends = |line: &Line| [line.start, line.end()];
    let mut nearest: Option<(f64, [f64; 2])> = None;
    for (k, line) in few.iter().enumerate() {
        for a in ends(line) {
            for b in few[k + 1..].iter().flat_map(ends) {
                let gap = apart(a, b);
                if gap > SAME_POINT && nearest.is_none_or(|(least, _)| gap < least) {
                    nearest = Some((gap, a));
                }
            }
        }
    }
    nearest
}

/// The larger of the width and the height of some points.
pub(super) fn extent(points: impl Iterator<Item = [f64; 2]>) -> f64 {
    let size = size(points);
    size[0].max(size[1])
}

/// The width and the height of some points.
pub(super) fn size(points: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    let [low, high] = outline::extent(points.map(Vector2::from));
    <[f64; 2]>::from(high - low).map(|x| x.max(0.0))
}

/// A line without its closing piece, if that is only a gap.
fn opened(line: &Line, widest: f64) -> Line {
    let mut line = line.clone();
    let [first, middle @ .., before, _] = &line.segments[..] else {
        return line;
    };
    let from = before.points.last().copied().unwrap_or(line.start);
    let gap = apart(from, line.start);
    // A traced line closes with a step similar to its others.
    let begun = middle.last().unwrap_or(first).points.last();
    let before = begun.into_iter().chain(&before.points).copied();
    let after = std::iter::once(line.start).chain(first.points.iter().copied());
    let is_short = gap <= SHORT * extent(before).min(extent(after));
    if line.closed && line.closing && is_short && gap > SAME_POINT && gap <= widest {
        line.segments.pop();
        line.closed = false;
    }
    line
}

/// For each end of each line (line k begins at end 2 k and ends at end 2 k + 1) the end that it
/// meets. The closest ends are matched first, and each meets one.
fn links(lines: &[Line], widest: f64) -> Vec<Option<usize>> {
    let ends: Vec<[f64; 2]> = lines
        .iter()
        .flat_map(|line| [line.start, line.end()])
        .collect();
    let mut order: Vec<usize> = (0..ends.len()).collect();
    order.sort_by(|&a, &b| ends[a][0].total_cmp(&ends[b][0]).then(a.cmp(&b)));
    let mut pairs = Vec::new();
    for (k, &a) in order.iter().enumerate() {
        let near = order[k + 1..].iter();
        for &b in near.take_while(|&&b| ends[b][0] - ends[a][0] <= widest) {
            let gap = apart(ends[a], ends[b]);
            // A dash not longer than a gap is not closed on itself.
            let own = a / 2 == b / 2 && extent(lines[a / 2].points()) <= 4.0 * widest;
            if gap <= widest && !own {
                pairs.push((gap, a.min(b), a.max(b)));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut links = vec![None; ends.len()];
    for (_, a, b) in pairs {
        if links[a].is_none() && links[b].is_none() {
            (links[a], links[b]) = (Some(b), Some(a));
        }
    }
    links
}

/// The chains of linked lines. A closed chain begins at the beginning of its first line and follows
/// its direction.
fn chained(lines: &[Line], links: &[Option<usize>], gaps: &mut Vec<(f64, [f64; 2])>) -> Vec<Line> {
    let mut used = vec![false; lines.len()];
    let mut chains = Vec::new();
    for first in 0..lines.len() {
        if used[first] {
            continue;
        }
        // Back to the free end, or around.
        let mut enter = 2 * first;
        while let Some(before) = links[enter] {
            enter = before ^ 1;
            if enter == 2 * first {
                break;
            }
        }
        let begin = enter;
        let mut pieces: Vec<Piece> = Vec::new();
        let closed = loop {
            used[enter / 2] = true;
            let seam = pieces.len();
            pieces.extend(directed(&lines[enter / 2], enter % 2 == 1));
            if seam > 0 {
                close_gap(&mut pieces, seam, gaps);
            }
            match links[enter ^ 1] {
                Some(next) if next == begin => break true,
                Some(next) => enter = next,
                None => break false,
            }
        };
        if closed {
            close_gap(&mut pieces, 0, gaps);
        }
        let start = pieces[0].points[0];
        let segments = pieces.into_iter().map(|piece| Segment {
            points: piece
                .points
                .into_iter()
                .skip(1)
                .map(|p| [p.x, p.y])
                .collect(),
            arc: piece.arc,
        });
        chains.push(Line {
            start: [start.x, start.y],
            segments: segments.collect(),
            closed,
            closing: false,
        });
    }
    chains
}

/// A segment with all its points.
struct Piece {
    points: Vec<Point>,
    arc: bool,
}

/// The segments of a line, from its end to its beginning where `reversed`.
fn directed(line: &Line, reversed: bool) -> Vec<Piece> {
    let mut at = line.start;
    let mut pieces: Vec<Piece> = Vec::with_capacity(line.segments.len());
    for segment in &line.segments {
        let points = std::iter::once(at).chain(segment.points.iter().copied());
        pieces.push(Piece {
            points: points.map(|[x, y]| Point::new(x, y)).collect(),
            arc: segment.arc,
        });
        at = segment.points.last().copied().unwrap_or(at);
    }
    if reversed {
        pieces.reverse();
        pieces.iter_mut().for_each(|piece| piece.points.reverse());
    }
    pieces
}

/// Makes the piece `next` begin where the previous one ends; the last piece comes before the first.
fn close_gap(pieces: &mut [Piece], next: usize, gaps: &mut Vec<(f64, [f64; 2])>) {
    let n = pieces.len();
    let before = (next + n - 1) % n;
    let (Some(&end), Some(&start)) = (pieces[before].points.last(), pieces[next].points.first())
    else {
        return;
    };
    let gap = (start - end).hypot();
    if gap == 0.0 {
        return;
    }
    if gap <= SAME_POINT {
        pieces[next].points[0] = end;
        return;
    }
    gaps.push((gap, [end.x, end.y]));
    let meeting = meeting(&pieces[before].points, &pieces[next].points, gap);
    let last = pieces[before].points.len() - 1;
    let fixed = pieces[before].points[0];
    stretch(&mut pieces[before].points, fixed, meeting);
    pieces[before].points[last] = meeting;
    let points = &mut pieces[next].points;
    let fixed = points[points.len() - 1];
    stretch(points, meeting, fixed);
    points[0] = meeting;
}

/// The point at which two pieces across a gap are joined: the intersection of straight ones if it
/// is near, otherwise the midpoint.
fn meeting(before: &[Point], next: &[Point], gap: f64) -> Point {
    let (end, start) = (before[before.len() - 1], next[0]);
    let middle = end.midpoint(start);
    let (&[a, _], &[_, b]) = (before, next) else {
        return middle;
    };
    let (u, v) = (end - a, b - start);
    let sine = u.cross(v) / (u.hypot() * v.hypot());
    if sine.is_nan() || sine.abs() < 0.1 {
        return middle;
    }
    let crossing = end + u * ((start - end).cross(v) / u.cross(v));
    let near = |p: Point| (crossing - p).hypot() <= 2.0 * gap;
    if near(end) && near(start) {
        crossing
    } else {
        middle
    }
}

/// Turns and scales a piece so that its ends are at `first` and `last`: an arc stays an arc.
fn stretch(points: &mut [Point], first: Point, last: Point) {
    let (start, end) = (points[0], points[points.len() - 1]);
    let (from, to): (Vec2, Vec2) = (end - start, last - first);
    let square = from.hypot2();
    if square == 0.0 {
        return;
    }
    let (cos, sin) = (from.dot(to) / square, from.cross(to) / square);
    for p in points.iter_mut() {
        let d = *p - start;
        *p = first + Vec2::new(cos * d.x - sin * d.y, sin * d.x + cos * d.y);
    }
}
