//! A tile's outline: a simple, closed, counter-clockwise polygon and its convex parts.

use nalgebra::{Rotation2, Vector2};
use parry2d_f64::math::Vector;
use parry2d_f64::transformation::convex_hull;

use super::convex;
use super::edge_grid::EdgeGrid;

/// A convex polygon, counter-clockwise, with the outward unit normal of each edge (edge i runs
/// from point i to point i + 1).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConvexPart {
    pub points: Vec<Vector2<f64>>,
    pub normals: Vec<Vector2<f64>>,
}

impl ConvexPart {
    pub(crate) fn new(points: Vec<Vector2<f64>>) -> Self {
        let normals = (0..points.len())
            .map(|i| outward_normal(points[i], points[(i + 1) % points.len()]))
            .collect();
        Self { points, normals }
    }

    /// Becomes `part`, turned and moved; takes no new memory once it has held as many points.
    pub fn place(&mut self, part: &Self, rotation: &Rotation2<f64>, position: &Vector2<f64>) {
        self.points.clear();
        self.points
            .extend(part.points.iter().map(|p| position + rotation * p));
        self.normals.clear();
        self.normals
            .extend(part.normals.iter().map(|n| rotation * n));
    }

    /// Area (m^2).
    pub fn area(&self) -> f64 {
        signed_area(&self.points)
    }

    /// The box around the part.
    pub fn bounds(&self) -> Bounds {
        Bounds::around(self.points.iter().copied())
    }
}

/// A box with sides along x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub low: Vector2<f64>,
    pub high: Vector2<f64>,
}

impl Bounds {
    fn around(points: impl Iterator<Item = Vector2<f64>>) -> Self {
        let (low, high) = (f64::NEG_INFINITY, f64::INFINITY);
        points.fold(
            Self {
                low: Vector2::repeat(high),
                high: Vector2::repeat(low),
            },
            |bounds, p| Self {
                low: bounds.low.inf(&p),
                high: bounds.high.sup(&p),
            },
        )
    }

    /// Whether the boxes share no inner point.
    pub fn apart(&self, other: &Self) -> bool {
        self.low.x >= other.high.x
            || other.low.x >= self.high.x
            || self.low.y >= other.high.y
            || other.low.y >= self.high.y
    }
}

/// A simple closed polygon, counter-clockwise, in the tile's frame (m).
#[derive(Clone, Debug)]
pub struct Outline {
    vertices: Vec<Vector2<f64>>,
    normals: Vec<Vector2<f64>>,
    convex: Vec<bool>,
    parts: Vec<ConvexPart>,
    circumradius: f64,
    grid: EdgeGrid,
}

/// Why a list of vertices is no outline.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OutlineError {
    #[error("an outline needs at least three vertices, this one has {0}")]
    TooFewVertices(usize),
    #[error("vertices {0} and {1} coincide")]
    RepeatedVertex(usize, usize),
    #[error("the outline runs clockwise; list its vertices counter-clockwise")]
    Clockwise,
    #[error("the edge from vertex {0} crosses or touches the edge from vertex {1}")]
    SelfCrossing(usize, usize),
    #[error("the outline could not be split into convex parts; is it a simple polygon?")]
    NotDecomposable,
}

impl Outline {
    /// An outline from its vertices (m), counter-clockwise. Vertices on the straight line between
    /// their neighbours are dropped.
    ///
    /// # Errors
    /// Where the vertices do not form a simple counter-clockwise polygon.
    pub fn new(vertices: Vec<Vector2<f64>>) -> Result<Self, OutlineError> {
        check(&vertices)?;
        let vertices = without_collinear(vertices);
        let n = vertices.len();
        let normals: Vec<_> = (0..n)
            .map(|i| outward_normal(vertices[i], vertices[(i + 1) % n]))
            .collect();
        let convex = (0..n)
            .map(|i| cross(normals[(i + n - 1) % n], normals[i]) > 0.0)
            .collect();
        let parts = convex_parts(&vertices).ok_or(OutlineError::NotDecomposable)?;
        let grid = EdgeGrid::new(&vertices);
        let circumradius = vertices.iter().map(|v| v.norm()).fold(0.0, f64::max);
        Ok(Self {
            vertices,
            normals,
            convex,
            parts,
            circumradius,
            grid,
        })
    }

    pub fn vertices(&self) -> &[Vector2<f64>] {
        &self.vertices
    }

    /// Outward unit normal of each edge; edge i runs from vertex i to vertex i + 1.
    pub fn normals(&self) -> &[Vector2<f64>] {
        &self.normals
    }

    /// Whether each vertex is convex (its inner angle below pi).
    pub fn convex_vertices(&self) -> &[bool] {
        &self.convex
    }

    /// Convex polygons that fill the outline exactly and share no inner point.
    pub fn parts(&self) -> &[ConvexPart] {
        &self.parts
    }

    /// The convex hull.
    pub fn hull(&self) -> ConvexPart {
        let points: Vec<Vector> = self
            .vertices
            .iter()
            .map(|v| Vector::new(v.x, v.y))
            .collect();
        let hull = convex_hull(&points);
        ConvexPart::new(hull.iter().map(|p| Vector2::new(p.x, p.y)).collect())
    }

    /// Finds the edges near a point.
    pub fn grid(&self) -> &EdgeGrid {
        &self.grid
    }

    /// Largest distance of a point of the outline from the reference point (m).
    pub fn circumradius(&self) -> f64 {
        self.circumradius
    }

    /// The ends of edge i.
    pub fn edge(&self, i: usize) -> (Vector2<f64>, Vector2<f64>) {
        (
            self.vertices[i],
            self.vertices[(i + 1) % self.vertices.len()],
        )
    }

    /// Area (m^2).
    pub fn area(&self) -> f64 {
        signed_area(&self.vertices)
    }

    /// Centre of mass of the evenly filled outline (m).
    pub fn centroid(&self) -> Vector2<f64> {
        self.edges()
            .map(|(a, b)| (a + b) * cross(a, b))
            .sum::<Vector2<f64>>()
            / (6.0 * self.area())
    }

    /// Integral of the squared distance from the centroid over the area (m^4).
    pub fn second_moment_about_centroid(&self) -> f64 {
        let about_origin: f64 = self
            .edges()
            .map(|(a, b)| cross(a, b) * (a.dot(&a) + a.dot(&b) + b.dot(&b)) / 12.0)
            .sum();
        about_origin - self.area() * self.centroid().norm_squared()
    }

    /// Whether a point lies inside (on the boundary either answer may come).
    pub fn contains(&self, p: Vector2<f64>) -> bool {
        contains(&self.vertices, &p)
    }

    /// Distance of a point to the boundary, positive outside, negative inside (m).
    pub fn signed_distance(&self, p: Vector2<f64>) -> f64 {
        let distance = self
            .edges()
            .map(|(a, b)| distance_to_segment(p, a, b))
            .fold(f64::INFINITY, f64::min);
        if self.contains(p) {
            -distance
        } else {
            distance
        }
    }

    fn edges(&self) -> impl Iterator<Item = (Vector2<f64>, Vector2<f64>)> + '_ {
        (0..self.vertices.len()).map(|i| self.edge(i))
    }
}

/// Whether a point lies inside a closed polygon (even-odd rule; on the boundary either answer may
/// come).
pub fn contains(polygon: &[Vector2<f64>], p: &Vector2<f64>) -> bool {
    let n = polygon.len();
    let mut inside = false;
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % n];
        if (a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x {
            inside = !inside;
        }
    }
    inside
}

/// z component of the cross product of two plane vectors.
pub fn cross(a: Vector2<f64>, b: Vector2<f64>) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Distance of a point to a segment (m).
pub fn distance_to_segment(p: Vector2<f64>, a: Vector2<f64>, b: Vector2<f64>) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (p - a - along * t).norm()
}

fn outward_normal(a: Vector2<f64>, b: Vector2<f64>) -> Vector2<f64> {
    let t = (b - a).normalize();
    Vector2::new(t.y, -t.x)
}

pub(super) fn signed_area(vertices: &[Vector2<f64>]) -> f64 {
    let n = vertices.len();
    (0..n)
        .map(|i| cross(vertices[i], vertices[(i + 1) % n]))
        .sum::<f64>()
        / 2.0
}

fn check(vertices: &[Vector2<f64>]) -> Result<(), OutlineError> {
    let n = vertices.len();
    if n < 3 {
        return Err(OutlineError::TooFewVertices(n));
    }
    if let Some(i) = (0..n).find(|&i| vertices[i] == vertices[(i + 1) % n]) {
        return Err(OutlineError::RepeatedVertex(i, (i + 1) % n));
    }
    for i in 0..n {
        for j in i + 1..n {
            if edges_cross(vertices, i, j) {
                return Err(OutlineError::SelfCrossing(i, j));
            }
        }
    }
    if signed_area(vertices) <= 0.0 {
        return Err(OutlineError::Clockwise);
    }
    Ok(())
}

/// Whether edges i < j share a point they should not: any point for edges that are not
/// neighbours, a second point for neighbours.
fn edges_cross(vertices: &[Vector2<f64>], i: usize, j: usize) -> bool {
    let n = vertices.len();
    let (a, b) = (vertices[i], vertices[(i + 1) % n]);
    let (c, d) = (vertices[j], vertices[(j + 1) % n]);
    let folds_back = |corner: Vector2<f64>, before: Vector2<f64>, after: Vector2<f64>| {
        let (u, v) = (before - corner, after - corner);
        cross(u, v).abs() <= 1e-12 * u.norm() * v.norm() && u.dot(&v) > 0.0
    };
    if j == i + 1 {
        return folds_back(b, a, d);
    }
    if i == 0 && j == n - 1 {
        return folds_back(a, b, c);
    }
    segments_meet([a, b], [c, d], 0.0)
}

/// Whether two segments share a point, ends included. An end counts as lying on the other
/// segment's line where it is seen from the line's first point at an angle of sine `straight` or
/// less.
pub(super) fn segments_meet(
    [a, b]: [Vector2<f64>; 2],
    [c, d]: [Vector2<f64>; 2],
    straight: f64,
) -> bool {
    // Segments on one line meet only where their boxes do; all others then at the latest.
    let boxes = |p: f64, q: f64, r: f64, s: f64| p.min(q) <= r.max(s) && r.min(s) <= p.max(q);
    if !boxes(a.x, b.x, c.x, d.x) || !boxes(a.y, b.y, c.y, d.y) {
        return false;
    }
    let side = |p: Vector2<f64>, q: Vector2<f64>, r: Vector2<f64>| {
        let (u, v) = (q - p, r - p);
        let across = cross(u, v);
        if across.abs() <= straight * u.norm() * v.norm() {
            0.0
        } else {
            across
        }
    };
    let apart = |s: f64, t: f64| (s > 0.0 && t > 0.0) || (s < 0.0 && t < 0.0);
    !apart(side(a, b, c), side(a, b, d)) && !apart(side(c, d, a), side(c, d, b))
}

fn without_collinear(vertices: Vec<Vector2<f64>>) -> Vec<Vector2<f64>> {
    let n = vertices.len();
    (0..n)
        .filter(|&i| {
            let (a, b, c) = (
                vertices[(i + n - 1) % n],
                vertices[i],
                vertices[(i + 1) % n],
            );
            cross(b - a, c - b).abs() > 1e-12 * (b - a).norm() * (c - b).norm()
        })
        .map(|i| vertices[i])
        .collect()
}

fn convex_parts(vertices: &[Vector2<f64>]) -> Option<Vec<ConvexPart>> {
    let parts: Vec<_> = convex::convex_parts(vertices)?
        .into_iter()
        .map(|part| ConvexPart::new(part.into_iter().map(|k| vertices[k]).collect()))
        .collect();
    let filled: f64 = parts.iter().map(ConvexPart::area).sum();
    let area = signed_area(vertices);
    ((filled - area).abs() <= 1e-9 * area).then_some(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outline(points: &[[f64; 2]]) -> Result<Outline, OutlineError> {
        Outline::new(points.iter().map(|p| Vector2::new(p[0], p[1])).collect())
    }

    #[test]
    fn a_square_has_the_textbook_area_and_moments() {
        let square = outline(&[[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]]).unwrap();
        assert!((square.area() - 4.0).abs() < 1e-14);
        assert!((square.centroid() - Vector2::new(2.0, 2.0)).norm() < 1e-14);
        // Polar second moment of a square of side a: a^4 / 6.
        assert!((square.second_moment_about_centroid() - 16.0 / 6.0).abs() < 1e-12);
    }

    #[test]
    fn a_saw_blade_keeps_its_notches() {
        let mut points = vec![[0.0, 0.0], [4.0, 0.0]];
        for k in 0..4 {
            points.push([4.0 - k as f64, 2.0]);
            points.push([3.5 - k as f64, 1.0]);
        }
        points.push([0.0, 2.0]);
        let saw = outline(&points).unwrap();
        assert!(!saw.contains(Vector2::new(3.5, 1.5)));
        let in_parts = |p: Vector2<f64>| {
            saw.parts().iter().any(|part| {
                part.points
                    .iter()
                    .zip(&part.normals)
                    .all(|(q, n)| n.dot(&(p - q)) <= 0.0)
            })
        };
        for i in 0..80 {
            for j in 0..40 {
                let p = Vector2::new(0.0251 + i as f64 * 0.05, 0.0249 + j as f64 * 0.05);
                assert_eq!(in_parts(p), saw.contains(p), "{p}");
            }
        }
    }

    #[test]
    fn wrong_outlines_are_refused() {
        let clockwise = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
        assert_eq!(outline(&clockwise).unwrap_err(), OutlineError::Clockwise);
        let bow_tie = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        assert!(matches!(
            outline(&bow_tie).unwrap_err(),
            OutlineError::SelfCrossing(..)
        ));
        let spike = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
        assert!(matches!(
            outline(&spike).unwrap_err(),
            OutlineError::SelfCrossing(..)
        ));
    }

    #[test]
    fn points_on_straight_lines_are_dropped() {
        let square = outline(&[[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(square.unwrap().vertices().len(), 4);
    }
}
