//! The outline of a tile as lines and arcs, offset outwards by half the kerf.

use std::f64::consts::TAU;

use nalgebra::Vector2;
use physics::tile::outline::{self, Outline, cross};

/// Tangents that differ by less than this (rad) form no corner: the intersection of nearly parallel
/// curves would be far away. Ignoring such a corner causes an error of this share of the cut.
const SMOOTH: f64 = 1e-3;

/// A corner of a closed line, with the segment to the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// m.
    pub point: Vector2<f64>,
    /// The tangent of a quarter of the angle that the arc to the next corner spans, counter-clockwise
    /// above 0; 0 for a straight line.
    pub bulge: f64,
}

impl Corner {
    /// The radius (m) of the arc to the given next corner, and whether it is more than half a
    /// circle; `None` for a straight line.
    pub fn arc(&self, next: &Corner) -> Option<(f64, bool)> {
        let chord = (next.point - self.point).norm();
        let bulge = self.bulge.abs();
        // Bulge b: the arc rises by b c / 2 over its chord c, so r = c (1 + b^2) / 4 b.
        (bulge > 0.0).then(|| (chord * (1.0 + bulge * bulge) / (4.0 * bulge), bulge > 1.0))
    }

    /// The centre (m) of the arc to the given next point.
    pub fn centre(&self, next: Vector2<f64>) -> Vector2<f64> {
        // It lies to the left of the chord by this share of it.
        let share = (1.0 - self.bulge * self.bulge) / (4.0 * self.bulge);
        (self.point + next) / 2.0 - right_of(next - self.point) * share
    }

    /// The points at which the piece to the given next point meets a straight line.
    pub(super) fn crossings(
        &self,
        next: Vector2<f64>,
        point: Vector2<f64>,
        along: Vector2<f64>,
    ) -> Vec<Vector2<f64>> {
        let chord = next - self.point;
        if self.bulge == 0.0 {
            let sine = cross(chord, along);
            let share = cross(point - self.point, along) / sine;
            let on_it = sine != 0.0 && (0.0..=1.0).contains(&share);
            return on_it
                .then(|| self.point + chord * share)
                .into_iter()
                .collect();
        }
        let centre = self.centre(next);
        let circle = Circle {
            centre,
            radius: (self.point - centre).norm(),
            left: self.bulge > 0.0,
        };
        let found = on_line(circle, point, along).into_iter().flatten();
        let on_it = |p: &Vector2<f64>| cross(chord, p - self.point) * self.bulge <= 0.0;
        found.filter(on_it).collect()
    }

    /// The points at which the arc to the given next corner has an extremum in x or y.
    pub fn turning_points(&self, next: &Corner) -> Vec<Vector2<f64>> {
        let Some((radius, _)) = self.arc(next) else {
            return Vec::new();
        };
        let (bulge, chord) = (self.bulge, next.point - self.point);
        let centre = self.centre(next.point);
        let axes = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
        let points = axes.map(|axis| centre + Vector2::from(axis) * radius);
        // Points on the arc are to the right of the chord if it runs counter-clockwise.
        let on_it = |p: &Vector2<f64>| cross(chord, p - self.point) * bulge < 0.0;
        points.into_iter().filter(on_it).collect()
    }
}

/// The length (m) of a closed line.
pub fn length(corners: &[Corner]) -> f64 {
    let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
    let piece = |(a, b): (&Corner, &Corner)| match a.arc(b) {
        Some((radius, _)) => radius * 4.0 * libm::atan(a.bulge.abs()),
        None => (b.point - a.point).norm(),
    };
    pairs.map(piece).sum()
}

/// The smallest and the largest x and y (m) of a closed line.
pub fn extent(corners: &[Corner]) -> [[f64; 2]; 2] {
    let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
    let points = pairs.flat_map(|(corner, next)| {
        let turns = corner.turning_points(next);
        turns.into_iter().chain([corner.point])
    });
    outline::extent(points).map(Into::into)
}

/// A circle that runs counter-clockwise or clockwise.
#[derive(Clone, Copy)]
struct Circle {
    centre: Vector2<f64>,
    radius: f64,
    left: bool,
}

/// A piece of the rim.
#[derive(Clone, Copy)]
struct Piece {
    start: Vector2<f64>,
    end: Vector2<f64>,
    circle: Option<Circle>,
}

/// The rim of an outline, offset outwards by `shift` (m); `None` if an arc is narrower than that.
pub(super) fn rim(outline: &Outline, shift: f64) -> Option<Vec<Corner>> {
    let pieces = pieces(outline);
    let n = pieces.len();
    let shifted: Vec<Piece> = pieces.iter().map(|piece| piece.shifted(shift)).collect();
    if shifted
        .iter()
        .any(|piece| piece.circle.is_some_and(|circle| circle.radius <= 0.0))
    {
        return None;
    }
    let corner = |k: usize| {
        let before = (k + n - 1) % n;
        match shift {
            0.0 => pieces[k].start,
            _ => meeting(
                [&pieces[before], &pieces[k]],
                [&shifted[before], &shifted[k]],
                shift,
            ),
        }
    };
    let points: Vec<Vector2<f64>> = (0..n).map(corner).collect();
    let corners = shifted.iter().enumerate().map(|(k, piece)| Corner {
        point: points[k],
        bulge: piece.bulge(points[k], points[(k + 1) % n]),
    });
    Some(corners.collect())
}

/// The lines and arcs of an outline, one after the other.
fn pieces(outline: &Outline) -> Vec<Piece> {
    let (vertices, arcs) = (outline.vertices(), outline.arcs());
    let n = vertices.len();
    let goes_on = |edge: usize| arcs[edge].is_some() && arcs[edge] == arcs[(edge + n - 1) % n];
    // Starts at an edge that does not continue the previous arc.
    let first = (0..n).find(|&edge| !goes_on(edge)).unwrap_or(0);
    let mut pieces = Vec::new();
    let mut edge = 0;
    while edge < n {
        let mut end = edge + 1;
        while end < n && goes_on((first + end) % n) {
            end += 1;
        }
        let run: Vec<Vector2<f64>> = (edge..=end).map(|k| vertices[(first + k) % n]).collect();
        pieces.push(Piece {
            start: run[0],
            end: run[run.len() - 1],
            circle: circle(&run),
        });
        edge = end;
    }
    pieces
}

/// The circle of an arc's points, if there are three or more. On a face that is drawn back, arcs
/// end slightly off their circles, so inner points are better.
fn circle(run: &[Vector2<f64>]) -> Option<Circle> {
    let inner = match run.len() {
        5.. => &run[1..run.len() - 1],
        3.. => run,
        _ => return None,
    };
    let [a, b, c] = [inner[0], inner[inner.len() / 2], inner[inner.len() - 1]];
    let (u, v) = (b - a, c - a);
    let twice = 2.0 * cross(u, v);
    let (uu, vv) = (u.norm_squared(), v.norm_squared());
    let to_centre = Vector2::new(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / twice;
    let radius = to_centre.norm();
    radius.is_finite().then_some(Circle {
        centre: a + to_centre,
        radius,
        left: twice > 0.0,
    })
}

impl Piece {
    /// The direction at one of its points.
    fn direction(&self, at: Vector2<f64>) -> Vector2<f64> {
        let Some(circle) = self.circle else {
            return (self.end - self.start).normalize();
        };
        let out = (at - circle.centre).normalize();
        let left = Vector2::new(-out.y, out.x);
        if circle.left { left } else { -left }
    }

    /// The piece moved to its right, which is outwards.
    fn shifted(&self, shift: f64) -> Self {
        let moved = |at: Vector2<f64>| at + right_of(self.direction(at)) * shift;
        let circle = self.circle.map(|circle| Circle {
            radius: circle.radius + if circle.left { shift } else { -shift },
            ..circle
        });
        Self {
            start: moved(self.start),
            end: moved(self.end),
            circle,
        }
    }

    /// The bulge of the piece between two of its points.
    fn bulge(&self, start: Vector2<f64>, end: Vector2<f64>) -> f64 {
        let Some(circle) = self.circle else {
            return 0.0;
        };
        let (from, to) = (start - circle.centre, end - circle.centre);
        let turn = libm::atan2(cross(from, to), from.dot(&to));
        let sweep = match (circle.left, turn < 0.0) {
            (true, true) => turn + TAU,
            (false, false) => turn - TAU,
            _ => turn,
        };
        libm::tan(sweep / 4.0)
    }
}

fn right_of(direction: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(direction.y, -direction.x)
}

/// The point at which two pieces meet after they are moved outwards.
fn meeting(before: [&Piece; 2], moved: [&Piece; 2], shift: f64) -> Vector2<f64> {
    let corner = before[1].start;
    let [a, b] = before.map(|piece| piece.direction(corner));
    let sine = cross(a, b);
    let (right_a, right_b) = (right_of(a), right_of(b));
    if sine.abs() < SMOOTH {
        return corner + (right_a + right_b).normalize() * shift;
    }
    // The point x from the corner with x . right_a = x . right_b = shift: exact for straight lines.
    let tangents = corner + (a - b) * (shift / sine);
    let found = match moved.map(|piece| piece.circle) {
        [None, None] => return tangents,
        [Some(circle), None] => on_line(circle, moved[1].start, b),
        [None, Some(circle)] => on_line(circle, moved[0].end, a),
        [Some(one), Some(other)] => on_circle(one, other),
    };
    let nearer = |p: &Vector2<f64>, q: &Vector2<f64>| {
        (p - tangents).norm().total_cmp(&(q - tangents).norm())
    };
    found
        .into_iter()
        .flatten()
        .min_by(nearer)
        .unwrap_or(tangents)
}

/// The intersection of a circle and a line through a point.
fn on_line(circle: Circle, point: Vector2<f64>, along: Vector2<f64>) -> Option<[Vector2<f64>; 2]> {
    let foot = point + along * (circle.centre - point).dot(&along);
    let square = circle.radius * circle.radius - (foot - circle.centre).norm_squared();
    let half = along * square.sqrt();
    (square >= 0.0).then(|| [foot - half, foot + half])
}

/// The intersection of two circles.
fn on_circle(one: Circle, other: Circle) -> Option<[Vector2<f64>; 2]> {
    let d = other.centre - one.centre;
    let square = d.norm_squared();
    // The line through both intersections has this distance from the first centre, as a share of d.
    let share = (1.0 + (one.radius * one.radius - other.radius * other.radius) / square) / 2.0;
    on_line(one, one.centre + d * share, right_of(d).normalize())
}

/// The area (m^2) within a closed line.
#[cfg(test)]
pub(super) fn area(corners: &[Corner]) -> f64 {
    let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
    let piece = |(a, b): (&Corner, &Corner)| {
        let sweep = 4.0 * libm::atan(a.bulge);
        let segment = a.arc(b);
        let segment = segment.map_or(0.0, |(r, _)| r * r * (sweep - libm::sin(sweep)) / 2.0);
        cross(a.point, b.point) / 2.0 + segment
    };
    pairs.map(piece).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// A circle of four arcs with a number of chords each.
    fn disc(radius: f64, chords: usize) -> Outline {
        let n = 4 * chords;
        let point = |k: usize| {
            let (sin, cos) = libm::sincos(TAU * k as f64 / n as f64);
            Vector2::new(cos, sin) * radius
        };
        let points: Vec<_> = (0..n).map(point).collect();
        let arcs: Vec<_> = (0..n).map(|k| Some(k / chords)).collect();
        Outline::new(points.clone())
            .unwrap()
            .with_arcs(&points, &arcs)
    }

    #[test]
    fn chords_of_a_circle_become_the_circle_and_grow_with_it() {
        for chords in [2, 3, 9] {
            for shift in [0.0, 0.3, -0.4] {
                let rim = rim(&disc(2.0, chords), shift).unwrap();
                assert_eq!(rim.len(), 4);
                let expected = PI * (2.0 + shift) * (2.0 + shift);
                assert!((area(&rim) - expected).abs() < 1e-12, "{}", area(&rim));
                assert!(
                    rim.iter()
                        .all(|c| (c.bulge - libm::tan(PI / 8.0)).abs() < 1e-12)
                );
            }
        }
        assert!(rim(&disc(2.0, 3), -2.0).is_none());
        // Half a disc from its lowest point to its highest extends only to the right.
        let half = [[0.0, -2.0], [0.0, 2.0]].map(|point| Corner {
            point: Vector2::from(point),
            bulge: 1.0,
        });
        let turning = half[0].turning_points(&half[1]);
        assert!(
            turning
                .iter()
                .any(|p| (p - Vector2::new(2.0, 0.0)).norm() < 1e-12)
        );
        assert!(turning.iter().all(|p| p.x > -1e-12), "{turning:?}");
        // The same polygon without arcs keeps its corners.
        let polygon = Outline::new(disc(2.0, 3).vertices().to_vec()).unwrap();
        assert_eq!(rim(&polygon, 0.0).unwrap().len(), 12);
    }

    #[test]
    fn a_hollow_meets_straight_sides_where_both_are_shifted() {
        // A square of side 4 with a half circle of radius 1 cut out of its right side.
        let mut points = vec![Vector2::new(2.0, -2.0)];
        let chords = 8;
        for k in 0..=chords {
            let (sin, cos) = libm::sincos(-PI / 2.0 - PI * k as f64 / chords as f64);
            points.push(Vector2::new(2.0 + cos, sin));
        }
        points.extend([[2.0, 2.0], [-2.0, 2.0], [-2.0, -2.0]].map(Vector2::from));
        let arcs: Vec<_> = (0..points.len())
            .map(|k| (1..=chords).contains(&k).then_some(0))
            .collect();
        let outline = Outline::new(points.clone())
            .unwrap()
            .with_arcs(&points, &arcs);
        let drawn = rim(&outline, 0.0).unwrap();
        assert!(
            (area(&drawn) - (16.0 - PI / 2.0)).abs() < 1e-12,
            "{drawn:?}"
        );
        // Shifted by s, the circle has the radius 1 - s, and the side cuts it at a distance s from
        // its middle.
        let s = 0.1;
        let shifted = rim(&outline, s).unwrap();
        let (r, side) = (1.0_f64 - s, 4.0 + 2.0 * s);
        let half = libm::acos(s / r);
        let cut = r * r * (PI - half + libm::sin(2.0 * half) / 2.0);
        assert!(
            (area(&shifted) - (side * side - cut)).abs() < 1e-12,
            "{shifted:?}"
        );
        assert!(shifted.iter().filter(|c| c.bulge < 0.0).count() == 1);
    }
}
