//! A tile's outline: a simple, closed, counter-clockwise polygon and its convex parts.

mod convex_part;
mod validity;

use nalgebra::Vector2;
use parry2d_f64::math::Vector;
use parry2d_f64::transformation::convex_hull;

pub use convex_part::{Bounds, ConvexPart};
pub use validity::OutlineError;

use super::edge_grid::EdgeGrid;
use super::plane::outward_normal;
pub use super::plane::{centroid, contains, cross, distance_to_segment, extent, signed_area};
use crate::configuration::Configuration;

/// A simple closed polygon, counter-clockwise, in the tile's frame (m).
#[derive(Clone, Debug)]
pub struct Outline {
    vertices: Vec<Vector2<f64>>,
    normals: Vec<Vector2<f64>>,
    convex: Vec<bool>,
    parts: Vec<ConvexPart>,
    circumradius: f64,
    grid: EdgeGrid,
    arcs: Vec<Option<usize>>,
}

impl Outline {
    /// An outline from its vertices (m), counter-clockwise. Vertices on the straight line between
    /// their neighbours are dropped.
    ///
    /// # Errors
    /// If the vertices do not form a simple counter-clockwise polygon.
    pub fn new(vertices: Vec<Vector2<f64>>) -> Result<Self, OutlineError> {
        validity::check(&vertices)?;
        let vertices = validity::without_collinear(vertices);
        let n = vertices.len();
        // Nearly coincident vertices may all lie on one line.
        if n < 3 {
            return Err(OutlineError::TooFewVertices(n));
        }
        let normals: Vec<_> = (0..n)
            .map(|i| outward_normal(vertices[i], vertices[(i + 1) % n]))
            .collect();
        let convex = (0..n)
            .map(|i| cross(normals[(i + n - 1) % n], normals[i]) > 0.0)
            .collect();
        let parts = convex_part::fill(&vertices).ok_or(OutlineError::NotDecomposable)?;
        let grid = EdgeGrid::new(&vertices);
        let circumradius = vertices.iter().map(|v| v.norm()).fold(0.0, f64::max);
        Ok(Self {
            vertices,
            normals,
            convex,
            parts,
            circumradius,
            grid,
            arcs: vec![None; n],
        })
    }

    /// The same outline with the arcs that its edges are chords of: `points` are those that it was
    /// made from, and `arcs` has the index of the arc of each edge between them.
    pub fn with_arcs(mut self, points: &[Vector2<f64>], arcs: &[Option<usize>]) -> Self {
        let n = points.len();
        let Some(offset) = points.iter().position(|p| *p == self.vertices[0]) else {
            return self;
        };
        let mut at = offset;
        for edge in 0..self.vertices.len() {
            let end = self.vertices[(edge + 1) % self.vertices.len()];
            // Points between two vertices lie on the straight line between them.
            let mut arc = arcs[at % n];
            at += 1;
            while points[at % n] != end && at < offset + n {
                arc = arc.filter(|_| arcs[at % n] == arc);
                at += 1;
            }
            self.arcs[edge] = arc;
        }
        self
    }

    /// The same outline moved by a vector (m).
    pub fn moved(&self, by: Vector2<f64>) -> Result<Self, OutlineError> {
        let vertices = self.vertices.iter().map(|vertex| vertex + by).collect();
        let moved = Self::new(vertices)?;
        // Rounding could make a vertex collinear with its neighbours.
        let arcs = match moved.vertices.len() == self.vertices.len() {
            true => self.arcs.clone(),
            false => moved.arcs.clone(),
        };
        Ok(Self { arcs, ..moved })
    }

    /// The index of the arc that each edge is a chord of; `None` for straight edges. Arcs are for
    /// cutting the outline: contact, areas and distances refer to the polygon.
    pub fn arcs(&self) -> &[Option<usize>] {
        &self.arcs
    }

    /// The vertices (m), counter-clockwise.
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
        centroid(&self.vertices)
    }

    /// Integral of the squared distance from the centroid over the area (m^4).
    pub fn second_moment_about_centroid(&self) -> f64 {
        let about_origin: f64 = self
            .edges()
            .map(|(a, b)| cross(a, b) * (a.dot(&a) + a.dot(&b) + b.dot(&b)) / 12.0)
            .sum();
        about_origin - self.area() * self.centroid().norm_squared()
    }

    /// Whether a point lies inside (either answer is possible on the boundary).
    pub fn contains(&self, p: Vector2<f64>) -> bool {
        contains(&self.vertices, &p)
    }

    /// How far (m) it extends beyond the rim of a table of this half size (m) when it is placed there;
    /// negative if it does not.
    pub fn beyond_rim(&self, at: &Configuration, half_size: [f64; 2]) -> f64 {
        let (rotation, position) = (at.rotation(), at.position());
        let beyond = self.vertices.iter().map(|corner| {
            let p = position + rotation * corner;
            (p.x.abs() - half_size[0]).max(p.y.abs() - half_size[1])
        });
        beyond.fold(f64::NEG_INFINITY, f64::max)
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
