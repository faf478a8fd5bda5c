//! The points at which two outlines touch or are closer than a margin, each with its contact
//! normal.
//!
//! Outlines that touch do so at a convex corner of one of them. This corner meets
//!
//! - an *edge* of the other: the corner must stay in front of the edge's line. If the edge ends in
//!   a notch (a concave corner), its line also holds beyond the end, since points in front of both
//!   edges of a notch are outside; so a corner that slides along a chain of chords is stopped by
//!   the next chord exactly where it begins to rise, and never by the end of a chord;
//! - or a *convex corner* of the other. There the edges' lines do not hold beyond their ends: a
//!   corner may pass. Two such corners give one point: if each is closest to the other, along the
//!   line between them; otherwise along the normal of the one of their four edges that separates
//!   the two corners most (separating axis theorem, with corners cut off at twice the margin).

use nalgebra::{Rotation2, Vector2};

use super::Contact;
use super::shape::SearchedOutline;
use crate::configuration::Configuration;
use crate::tile::Outline;
use crate::tile::outline::distance_to_segment;

/// Overlaps are detected down to the margin. Those shallower than this share of it need no test
/// whether the corner is inside the tile, or behind one edge but in front of another, past a sharp
/// corner.
const SHALLOW: f64 = 0.1;

/// A point of contact, or of an imminent one, in the fixed tile's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// The point of the moving tile (m).
    pub on_moving: Vector2<f64>,
    /// Unit vector from the fixed tile to the moving one.
    pub normal: Vector2<f64>,
    /// Distance (m) to the fixed tile's point behind it along the normal; negative if the tiles
    /// overlap.
    pub gap: f64,
    /// What the normal turns with.
    pub turns_with: TurnsWith,
}

/// What the normal of a contact point turns with if the tiles turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TurnsWith {
    /// The tile behind the normal, whose edge it belongs to: the fixed one, or the rim.
    Behind,
    /// The tile in front of it, whose edge it belongs to: the moving one.
    InFront,
    /// The line between two corners.
    Line,
}

impl ContactPoint {
    /// The point of the fixed tile (m).
    pub fn on_fixed(&self) -> Vector2<f64> {
        self.on_moving - self.normal * self.gap
    }
}

/// Edges of one tile and convex corners of the other that are near each other.
#[derive(Clone, Debug, Default)]
pub struct NearPairs {
    /// Edges of the fixed tile, vertices of the moving one.
    on_fixed: Vec<[usize; 2]>,
    /// The other way round.
    on_moving: Vec<[usize; 2]>,
}

/// Where a tile lies in another one's frame: its rotation and its position (m).
type Placed = (Rotation2<f64>, Vector2<f64>);

/// A corner of one tile against the other tile, in the other's frame.
enum Obstacle {
    /// In front of an edge, with the gap (m).
    Edge(usize, f64),
    /// Near a convex corner.
    Corner(usize),
}

impl Contact {
    /// The pairs within `distance` (m) of each other.
    pub fn near(&self, q: &Configuration, distance: f64) -> NearPairs {
        let [a, b] = [self.fixed(), self.moving()].map(Outline::circumradius);
        if q.position().norm() > a + b + distance {
            return NearPairs::default();
        }
        NearPairs {
            on_fixed: near(&self.fixed, &self.moving, q, distance),
            on_moving: near(&self.moving, &self.fixed, &q.inverse(), distance),
        }
    }

    /// The points where the tiles are at most `margin` (m) apart, or overlap by at most that, among
    /// the given pairs, which must include all within one and a half margins. The margin is assumed
    /// to be small relative to the tiles' edges and the spaces between them.
    ///
    /// If there is none, the tiles are farther apart than the margin; otherwise their distance is
    /// at least the smallest gap.
    pub fn points(&self, q: &Configuration, margin: f64, pairs: &NearPairs) -> Vec<ContactPoint> {
        let mut found = Vec::new();
        let mut corners: Vec<[usize; 2]> = Vec::new();
        let (fixed, moving) = (&self.fixed, &self.moving);
        let (rotation, position) = (q.rotation(), q.position());
        let back = rotation.inverse();
        meet(
            [fixed, moving],
            (rotation, position),
            margin,
            &pairs.on_fixed,
            |i, p, what| match what {
                Obstacle::Corner(k) => corners.push([k, i]),
                Obstacle::Edge(edge, gap) => found.push(ContactPoint {
                    on_moving: p,
                    normal: fixed.outline.normals()[edge],
                    gap,
                    turns_with: TurnsWith::Behind,
                }),
            },
        );
        meet(
            [moving, fixed],
            (back, back * -position),
            margin,
            &pairs.on_moving,
            |k, _, what| match what {
                Obstacle::Corner(i) => corners.push([k, i]),
                Obstacle::Edge(edge, gap) => {
                    let normal = -(rotation * moving.outline.normals()[edge]);
                    found.push(ContactPoint {
                        on_moving: fixed.outline.vertices()[k] + normal * gap,
                        normal,
                        gap,
                        turns_with: TurnsWith::InFront,
                    });
                }
            },
        );
        corners.sort_unstable();
        corners.dedup();
        let between = corners
            .iter()
            .map(|&pair| self.between_corners(pair, (rotation, position), 2.0 * margin));
        found.extend(between.filter(|point| point.gap <= margin));
        found
    }

    /// The point of two convex corners, of the fixed and of the moving tile.
    fn between_corners(
        &self,
        [k, i]: [usize; 2],
        (rotation, position): Placed,
        reach: f64,
    ) -> ContactPoint {
        let fixed = self.fixed.corner(k, reach);
        let moving = self
            .moving
            .corner(i, reach)
            .map(|p| position + rotation * p);
        let ([b, ..], [p, ..]) = (fixed, moving);
        let away = p - b;
        let faces = |corner: &[Vector2<f64>; 3], toward: &Vector2<f64>| {
            corner[1..]
                .iter()
                .all(|end| (end - corner[0]).dot(toward) < 0.0)
        };
        let distance = away.norm();
        if distance > 0.0 && faces(&fixed, &away) && faces(&moving, &-away) {
            return ContactPoint {
                on_moving: p,
                normal: away / distance,
                gap: distance,
                turns_with: TurnsWith::Line,
            };
        }
        // The largest separation over the four edges, the moving tile's point there, and the normal.
        let nearest = |points: &[Vector2<f64>; 3], normal: &Vector2<f64>, from: &Vector2<f64>| {
            let gaps = points.map(|x| (normal.dot(&(x - from)), x));
            let first = gaps[0];
            gaps[1..]
                .iter()
                .fold(first, |a, b| if b.0 < a.0 { *b } else { a })
        };
        let of_fixed = [k, self.fixed.before(k)].map(|edge| {
            let normal = self.fixed.outline.normals()[edge];
            let (gap, on_moving) = nearest(&moving, &normal, &b);
            ContactPoint {
                on_moving,
                normal,
                gap,
                turns_with: TurnsWith::Behind,
            }
        });
        let of_moving = [i, self.moving.before(i)].map(|edge| {
            let normal = rotation * self.moving.outline.normals()[edge];
            let (gap, on_fixed) = nearest(&fixed, &normal, &p);
            ContactPoint {
                on_moving: on_fixed - normal * gap,
                normal: -normal,
                gap,
                turns_with: TurnsWith::InFront,
            }
        });
        let [first, rest @ ..] = [of_fixed[0], of_fixed[1], of_moving[0], of_moving[1]];
        rest.into_iter()
            .fold(first, |a, b| if b.gap > a.gap { b } else { a })
    }
}

/// Edges of `ours`, and the convex corners of `theirs`, which lies at `pose` in the frame of `ours`,
/// within `distance` (m) of them.
fn near(
    ours: &SearchedOutline,
    theirs: &SearchedOutline,
    pose: &Configuration,
    distance: f64,
) -> Vec<[usize; 2]> {
    let (rotation, position) = (pose.rotation(), pose.position());
    let place = |p: Vector2<f64>| position + rotation * p;
    let mut pairs = Vec::new();
    let mut look = |edge, corner: usize| {
        let i = theirs.numbers[corner];
        let p = place(theirs.outline.vertices()[i]);
        let (start, end) = ours.outline.edge(edge);
        if distance_to_segment(p, start, end) <= distance {
            pairs.push([edge, i]);
        }
        true
    };
    ours.edges
        .near_pairs(&theirs.corners, &place, &|_| distance, &mut look);
    pairs
}

/// Calls `found(vertex, where it is, what it meets)` for convex corners of `theirs` near `ours`,
/// in whose frame `theirs` is placed.
fn meet(
    [ours, theirs]: [&SearchedOutline; 2],
    (rotation, position): Placed,
    margin: f64,
    pairs: &[[usize; 2]],
    mut found: impl FnMut(usize, Vector2<f64>, Obstacle),
) {
    let outline = &ours.outline;
    for &[edge, i] in pairs {
        let p = position + rotation * theirs.outline.vertices()[i];
        let next = ours.next(edge);
        let (start, end) = outline.edge(edge);
        let normal = outline.normals()[edge];
        let gap = normal.dot(&(p - start));
        if gap.abs() > margin {
            continue;
        }
        // Normals point to the right of their edges.
        let along = Vector2::new(-normal.y, normal.x);
        let mut faces_it = true;
        for (k, vertex, inwards) in [(edge, start, along), (next, end, -along)] {
            let from = p - vertex;
            let t = from.dot(&inwards);
            if outline.convex_vertices()[k] {
                if from.norm_squared() <= margin * margin {
                    found(i, p, Obstacle::Corner(k));
                    faces_it = false;
                }
                faces_it &= t >= 0.0;
            } else if t < 0.0 {
                // Beyond a notch up to the end of its other edge.
                let other = if k == edge { ours.before(edge) } else { next };
                faces_it &= t >= -margin.min(ours.length(other));
            }
        }
        let is_real = gap >= -SHALLOW * margin
            || (faces_it && (outline.signed_distance(p) - gap).abs() <= 1e-3 * margin);
        if faces_it && is_real {
            found(i, p, Obstacle::Edge(edge, gap));
        }
    }
}
