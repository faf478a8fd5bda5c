//! One of the two tiles, prepared for the contact tests of cells.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use crate::contact::tree::CircleTree;
use crate::tile::Outline;
use crate::tile::outline::distance_to_segment;

/// Largest number of inner points used as witnesses of overlap.
const INNER: usize = 8;

/// An edge, prepared for distance queries.
#[derive(Clone, Copy, Debug)]
struct Segment {
    start: Vector2<f64>,
    along: Vector2<f64>,
    /// One over the square of its length (1/m^2).
    inverse: f64,
}

impl Segment {
    fn between((a, b): (Vector2<f64>, Vector2<f64>)) -> Self {
        Self {
            start: a,
            along: b - a,
            inverse: (b - a).norm_squared().recip(),
        }
    }

    /// Whether it comes within a distance (m) of a point.
    fn is_within(&self, distance: f64, at: Vector2<f64>) -> bool {
        let from = at - self.start;
        let share = (from.dot(&self.along) * self.inverse).clamp(0.0, 1.0);
        (from - self.along * share).norm_squared() <= distance * distance
    }
}

/// One tile, prepared for queries.
#[derive(Clone, Debug)]
pub(super) struct Side {
    pub outline: Outline,
    pub edges: CircleTree,
    segments: Vec<Segment>,
    /// Points on the boundary that may lie inside the other tile: vertex i at 2 i, the middle of
    /// edge i at 2 i + 1.
    pub probes: Vec<Vector2<f64>>,
    pub probe_tree: CircleTree,
    /// Points deep inside.
    pub inner: Vec<Vector2<f64>>,
}

impl Side {
    pub fn new(outline: &Outline) -> Self {
        let edges = (0..outline.vertices().len()).map(|i| outline.edge(i));
        let circles: Vec<_> = edges
            .clone()
            .map(|(a, b)| ((a + b) / 2.0, (b - a).norm() / 2.0))
            .collect();
        let probes: Vec<_> = edges
            .clone()
            .flat_map(|(a, b)| [a, (a + b) / 2.0])
            .collect();
        let points: Vec<_> = probes.iter().map(|p| (*p, 0.0)).collect();
        let mut inner: Vec<_> = outline
            .parts()
            .iter()
            .map(|part| part.points.iter().sum::<Vector2<f64>>() / part.points.len() as f64)
            .collect();
        inner.push(outline.centroid());
        inner.retain(|p| outline.contains(*p));
        inner.sort_by_cached_key(|p| OrderedFloat(outline.signed_distance(*p)));
        inner.truncate(INNER);
        Self {
            outline: outline.clone(),
            segments: edges.map(Segment::between).collect(),
            edges: CircleTree::new(&circles),
            probes,
            probe_tree: CircleTree::new(&points),
            inner,
        }
    }

    /// Whether no point of the boundary is within `distance` of a point.
    pub fn boundary_is_beyond(&self, at: Vector2<f64>, distance: f64) -> bool {
        let mut beyond = |i: usize| !self.segments[i].is_within(distance, at);
        self.edges.near(at, distance, &mut beyond)
    }

    /// Whether all points within `distance` of a point are inside.
    pub fn holds_disc(&self, at: Vector2<f64>, distance: f64) -> bool {
        at.norm() < self.outline.circumradius()
            && self.boundary_is_beyond(at, distance)
            && self.outline.contains(at)
    }

    /// The condition of a point at `at` that moves by at most `reach` (m).
    pub fn verdict(&self, at: Vector2<f64>, reach: f64, vertex: bool) -> Verdict {
        let n = self.outline.vertices().len();
        let mut near = [0; 3];
        let mut count = 0;
        self.edges.near(at, reach, &mut |i| {
            if self.segments[i].is_within(reach, at) {
                near[count] = i;
                count += 1;
            }
            count < near.len()
        });
        let near = &mut near[..count];
        near.sort_unstable();
        let inside = || self.outline.contains(at);
        match *near {
            [] if inside() => Verdict::Blocked,
            [] => Verdict::Nothing,
            [edge] if vertex => Verdict::Edges([edge, edge]),
            [i, j] if vertex && (i + 1 == j || (i == 0 && j + 1 == n)) => {
                let corner = if i + 1 == j { j } else { 0 };
                if self.outline.convex_vertices()[corner] {
                    Verdict::Corner([i, j])
                } else {
                    Verdict::Edges([i, j])
                }
            }
            _ if inside() => Verdict::Inside(self.distance_to_boundary(at)),
            _ => Verdict::Nothing,
        }
    }

    pub fn distance_to_boundary(&self, at: Vector2<f64>) -> f64 {
        self.edges.nearest(at, &|i| {
            let (a, b) = self.outline.edge(i);
            distance_to_segment(at, a, b)
        })
    }
}

/// The condition that one point of a tile implies for a cell.
pub(super) enum Verdict {
    Nothing,
    Blocked,
    /// Inside at the centre, at this depth (m), but too close to several edges for a condition.
    Inside(f64),
    /// Must be on the outer side of these edges (twice the same, if it is one).
    Edges([usize; 2]),
    /// Must be on the outer side of one of these edges.
    Corner([usize; 2]),
}
