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
//!   corner may pass. A corner that lies beside an edge of the other meets this edge; if each is
//!   closest to the other, they meet along the line between them. Gaps are distances, so they and
//!   the normals are continuous where a corner slides past the end of an edge. A corner inside the
//!   other tile, or edges that cross, meet the edge that separates the two corners most (separating axis
//!   theorem).

use nalgebra::{Rotation2, Vector2};
use ordered_float::OrderedFloat;

use super::Contact;
use super::shape::SearchedOutline;
use crate::configuration::Configuration;
use crate::tile::Outline;
use crate::tile::outline::distance_to_segment;

/// Overlaps are detected down to the margin. Those shallower than this share of it need no test
/// whether the corner is inside the tile, or behind one edge but in front of another, past a sharp
/// corner.
const SHALLOW: f64 = 0.1;
/// The edges of two corners lie along each other if the cosine of the angle of their normals is above this.
const ALIKE: f64 = 0.9;

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
        for pair in corners {
            self.between_corners(pair, (rotation, position), margin, &mut found);
        }
        // Lines of edges go on beyond what a large margin sees of the tiles.
        let overlaps = |point: &ContactPoint| point.gap < -self.touch();
        if found.iter().any(overlaps) && self.is_free(q) {
            found.retain(|point| !overlaps(point));
        }
        found
    }

    /// The points of two convex corners, of the fixed and of the moving tile.
    fn between_corners(
        &self,
        [k, i]: [usize; 2],
        (rotation, position): Placed,
        margin: f64,
        found: &mut Vec<ContactPoint>,
    ) {
        let fixed = Wedge::new(&self.fixed, k, &(Rotation2::identity(), Vector2::zeros()));
        let moving = Wedge::new(&self.moving, i, &(rotation, position));
        let away = moving.corner - fixed.corner;
        let before_fixed = |(normal, gap): (Vector2<f64>, f64)| ContactPoint {
            on_moving: moving.corner,
            normal,
            gap,
            turns_with: TurnsWith::Behind,
        };
        let before_moving = |(normal, gap): (Vector2<f64>, f64)| ContactPoint {
            on_moving: fixed.corner - normal * gap,
            normal: -normal,
            gap,
            turns_with: TurnsWith::InFront,
        };
        if !fixed.has_inside(&away) && !moving.has_inside(&-away) {
            // Their edges may cross although neither corner is inside the other.
            let [one, other] = [fixed.most(&moving, margin), moving.most(&fixed, margin)];
            if one.0 < 0.0 && other.0 < 0.0 {
                found.push(match one.0 > other.0 {
                    true => before_fixed(one.1),
                    false => before_moving(other.1),
                });
                return;
            }
        }
        let on_fixed = fixed.meets(&moving, margin).map(before_fixed);
        let on_moving = moving.meets(&fixed, margin).map(before_moving);
        match (on_fixed, on_moving) {
            // Only one of the two stops the corners: the nearer one, or the way out of an overlap.
            (Some(one), Some(other)) if one.normal.dot(&other.normal) < ALIKE => {
                let [low, high] = if one.gap < other.gap {
                    [one, other]
                } else {
                    [other, one]
                };
                found.push(if high.gap < 0.0 { high } else { low });
            }
            (one, other) => found.extend(one.into_iter().chain(other)),
        }
        let distance = away.norm();
        if distance > 0.0 && fixed.faces(&away) && moving.faces(&-away) {
            found.push(ContactPoint {
                on_moving: moving.corner,
                normal: away / distance,
                gap: distance,
                turns_with: TurnsWith::Line,
            });
        }
    }
}

/// A convex corner with its two edges.
struct Wedge {
    /// Where it is (m).
    corner: Vector2<f64>,
    /// The edges.
    sides: [Side; 2],
}

/// An edge at a corner.
struct Side {
    /// Unit vector from the corner along it.
    along: Vector2<f64>,
    /// Its outward normal.
    normal: Vector2<f64>,
    /// Its length (m).
    length: f64,
}

impl Wedge {
    fn new(of: &SearchedOutline, i: usize, (rotation, position): &Placed) -> Self {
        let vertices = of.outline.vertices();
        let side = |edge: usize, end: usize| {
            let along = vertices[end] - vertices[i];
            let length = along.norm();
            Side {
                along: rotation * (along / length),
                normal: rotation * of.outline.normals()[edge],
                length,
            }
        };
        Self {
            corner: position + rotation * vertices[i],
            sides: [side(i, of.next(i)), side(of.before(i), of.before(i))],
        }
    }

    /// Whether a direction from the corner leaves both edges behind: the corner is the nearest point to all that
    /// lies there.
    fn faces(&self, toward: &Vector2<f64>) -> bool {
        self.sides.iter().all(|it| it.along.dot(toward) < 0.0)
    }

    /// Whether a place, relative to the corner, is behind both edges.
    fn has_inside(&self, from: &Vector2<f64>) -> bool {
        self.sides.iter().all(|it| it.normal.dot(from) < 0.0)
    }

    /// How far (m) another wedge, cut off at twice a margin (m), is in front of an edge; negative if a part of it
    /// is behind.
    fn separation(&self, side: &Side, other: &Self, margin: f64) -> f64 {
        let deepest = |end: &Side| {
            let reach = end.length.min(2.0 * margin);
            (side.normal.dot(&end.along) * reach).min(0.0)
        };
        let corner = side.normal.dot(&(other.corner - self.corner));
        corner + other.sides.iter().map(deepest).fold(0.0, f64::min)
    }

    /// The largest separation (m) by one of the edges; its normal, and how far (m) the corner of the other wedge is
    /// in front of it.
    fn most(&self, other: &Self, margin: f64) -> (f64, (Vector2<f64>, f64)) {
        let of = |side: &Side| {
            let gap = side.normal.dot(&(other.corner - self.corner));
            (self.separation(side, other, margin), (side.normal, gap))
        };
        let [one, two] = [0, 1].map(|k| of(&self.sides[k]));
        if one.0 > two.0 { one } else { two }
    }

    /// The outward normal of the edge that the corner of another wedge meets, and how far (m) it is in front of
    /// this edge; none if it is nearest to the corner, or beyond the end of an edge. Inside the wedge it is the
    /// edge that separates the wedges most, cut off at twice a margin (m).
    fn meets(&self, other: &Self, margin: f64) -> Option<(Vector2<f64>, f64)> {
        let from = other.corner - self.corner;
        let in_front = |side: &Side| side.normal.dot(&from);
        let is_inside = self.has_inside(&from);
        let meets = |side: &&Side| {
            let t = side.along.dot(&from);
            is_inside || (in_front(side) >= 0.0 && t >= 0.0 && t <= side.length)
        };
        let met = self.sides.iter().filter(meets);
        met.max_by_key(|side| OrderedFloat(self.separation(side, other, margin)))
            .map(|side| (side.normal, in_front(side)))
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
