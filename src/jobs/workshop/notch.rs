//! Pockets without a wall to the rim become notches of the outline.

use std::f64::consts::TAU;

use nalgebra::Vector2;
use physics::tile::outline::cross;

use super::rim::Corner;

/// Shortest piece of a line (m).
const SHORT: f64 = 1e-9;

/// A crossing of a ray with a closed line.
struct Crossing {
    /// The index of the piece.
    piece: usize,
    /// The point (m).
    point: Vector2<f64>,
}

/// The closed line with a notch: it leaves the line beside the first point of `bottom`, follows
/// `bottom` and returns to the line beside its last point. `out` is the direction of both sides of
/// the notch, outwards. `None` if a side misses the line.
pub(super) fn cut(line: &[Corner], bottom: &[Corner], out: Vector2<f64>) -> Option<Vec<Corner>> {
    let (first, last) = (bottom.first()?, bottom.last()?);
    let [from, to] = [first.point, last.point];
    let [leave, enter] = [crossing(line, from, out)?, crossing(line, to, out)?];
    let n = line.len();
    // Counter-clockwise from where the line is entered again to where it is left.
    let mut notched = Vec::with_capacity(n + bottom.len() + 2);
    let end = |piece: usize| line[(piece + 1) % n].point;
    let bulge = |piece: usize, from, to| part(&line[piece], end(piece), from, to);
    let same = leave.piece == enter.piece;
    let is_before = (enter.point - line[enter.piece].point).norm()
        <= (leave.point - line[leave.piece].point).norm();
    if same && is_before {
        // The notch would be all of the line but a piece of one edge.
        return None;
    }
    notched.push(Corner {
        point: enter.point,
        bulge: bulge(enter.piece, enter.point, end(enter.piece)),
    });
    let mut piece = (enter.piece + 1) % n;
    while piece != leave.piece {
        notched.push(line[piece]);
        piece = (piece + 1) % n;
    }
    notched.push(Corner {
        point: line[leave.piece].point,
        bulge: bulge(leave.piece, line[leave.piece].point, leave.point),
    });
    notched.push(Corner {
        point: leave.point,
        bulge: 0.0,
    });
    notched.extend_from_slice(bottom);
    let count = notched.len();
    let is_long = |k: &usize| {
        let next = notched[(k + 1) % count].point;
        (next - notched[*k].point).norm() > SHORT
    };
    let kept = (0..count).filter(is_long).map(|k| notched[k]);
    Some(kept.collect())
}

/// Width and length (m) of the piece of material on one side of a notch: at the corner of its bottom
/// up to the next line, and along the side of the notch. `aside` is the direction away from it.
pub(super) fn beside(
    line: &[Corner],
    corner: Vector2<f64>,
    out: Vector2<f64>,
    aside: Vector2<f64>,
) -> Option<[f64; 2]> {
    let start = corner + aside * (10.0 * SHORT);
    let reach =
        |along: Vector2<f64>| Some((crossing(line, start, along)?.point - start).dot(&along));
    Some([reach(aside)?, reach(out)?])
}

/// The bulge of the part of a piece between two of its points.
fn part(piece: &Corner, end: Vector2<f64>, from: Vector2<f64>, to: Vector2<f64>) -> f64 {
    if piece.bulge == 0.0 {
        return 0.0;
    }
    let centre = piece.centre(end);
    let (u, v) = (from - centre, to - centre);
    let turn = libm::atan2(cross(u, v), u.dot(&v)) * piece.bulge.signum();
    // Counted along the piece: more than half a turn is negative here.
    let turn = if turn < -SHORT {
        turn + TAU
    } else {
        turn.max(0.0)
    };
    libm::tan(turn / 4.0) * piece.bulge.signum()
}

/// The first crossing of a ray with a closed line.
fn crossing(line: &[Corner], start: Vector2<f64>, along: Vector2<f64>) -> Option<Crossing> {
    let n = line.len();
    let mut best: Option<(f64, Crossing)> = None;
    for (piece, corner) in line.iter().enumerate() {
        let end = line[(piece + 1) % n].point;
        for point in corner.crossings(end, start, along) {
            let far = (point - start).dot(&along);
            if far > 0.0 && best.as_ref().is_none_or(|(known, _)| far < *known) {
                best = Some((far, Crossing { piece, point }));
            }
        }
    }
    best.map(|(_, crossing)| crossing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workshop::rim::area;

    fn corner(x: f64, y: f64, bulge: f64) -> Corner {
        Corner {
            point: Vector2::new(x, y),
            bulge,
        }
    }

    #[test]
    fn a_notch_takes_its_area_from_a_square_and_from_a_disc() {
        let square = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
        let square = square.map(|[x, y]| corner(x, y, 0.0));
        // 1 wide, from x = 1.5 to the side at x = 2; then a second one beside it.
        let bottom = [corner(1.5, -0.5, 0.0), corner(1.5, 0.5, 0.0)];
        let once = cut(&square, &bottom, Vector2::x()).unwrap();
        assert!((area(&once) - 15.5).abs() < 1e-12, "{once:?}");
        let bottom = [corner(1.5, 1.0, 0.0), corner(1.5, 1.5, 0.0)];
        let twice = cut(&once, &bottom, Vector2::x()).unwrap();
        assert!((area(&twice) - 15.25).abs() < 1e-12, "{twice:?}");
        // Half a disc as the bottom: a round pocket that opens through the rim.
        let bottom = [corner(1.5, -0.5, -1.0), corner(1.5, 0.5, 0.0)];
        let round = cut(&square, &bottom, Vector2::x()).unwrap();
        let expected = 15.5 - std::f64::consts::PI / 8.0;
        assert!((area(&round) - expected).abs() < 1e-12, "{round:?}");
        // A circle of two arcs, cut at x = 0.
        let disc = [corner(0.0, -2.0, 1.0), corner(0.0, 2.0, 1.0)];
        let bottom = [corner(0.0, -1.0, 0.0), corner(0.0, 1.0, 0.0)];
        let cut = cut(&disc, &bottom, Vector2::x()).unwrap();
        // The segment between y = -1 and 1 has half the angle 30 degrees.
        let slice = 4.0 * std::f64::consts::PI / 6.0 + 3f64.sqrt();
        let expected = 4.0 * std::f64::consts::PI - slice;
        assert!(
            (area(&cut) - expected).abs() < 1e-12,
            "{} {expected}",
            area(&cut)
        );
    }
}
