//! The convex parts of an outline.

use nalgebra::{Rotation2, Vector2};

use super::{extent, outward_normal, signed_area};
use crate::tile::convex;

/// Rounding of the distance (m) of a disc beyond an edge.
const SLACK: f64 = 1e-12;

/// A convex polygon, counter-clockwise, with the outward unit normal of each edge (edge i runs
/// from point i to point i + 1).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConvexPart {
    /// The vertices (m).
    pub points: Vec<Vector2<f64>>,
    /// The outward unit normal of each edge.
    pub normals: Vec<Vector2<f64>>,
    /// Centre and radius (m) of a disc inside.
    pub disc: (Vector2<f64>, f64),
}

impl ConvexPart {
    /// The part with these corners (m), counter-clockwise.
    pub fn new(points: Vec<Vector2<f64>>) -> Self {
        let normals: Vec<_> = (0..points.len())
            .map(|i| outward_normal(points[i], points[(i + 1) % points.len()]))
            .collect();
        let middle = points.iter().sum::<Vector2<f64>>() / points.len() as f64;
        let depths = points.iter().zip(&normals);
        let depths = depths.map(|(point, normal)| normal.dot(&(point - middle)));
        let radius = depths.fold(f64::INFINITY, f64::min).max(0.0);
        Self {
            points,
            normals,
            disc: (middle, radius),
        }
    }

    /// Becomes `part`, turned and moved; allocates only if it has never held as many points.
    pub fn place(&mut self, part: &Self, rotation: &Rotation2<f64>, position: &Vector2<f64>) {
        self.points.clear();
        self.points
            .extend(part.points.iter().map(|p| position + rotation * p));
        self.normals.clear();
        self.normals
            .extend(part.normals.iter().map(|n| rotation * n));
        self.disc = (position + rotation * part.disc.0, part.disc.1);
    }

    /// The first point (m) and the outward unit normal of each edge.
    pub fn edges(&self) -> impl Iterator<Item = (&Vector2<f64>, &Vector2<f64>)> {
        self.points.iter().zip(&self.normals)
    }

    /// The edges at least `room` (m) away from a disc of this radius (m) for every one of some
    /// places of its centre: only these can separate a body that contains the disc.
    pub fn edges_off<const N: usize>(
        &self,
        middles: [Vector2<f64>; N],
        radius: f64,
        room: f64,
    ) -> impl Iterator<Item = (&Vector2<f64>, &Vector2<f64>)> {
        let least = room + radius - SLACK;
        self.edges().filter(move |(point, normal)| {
            let mut middles = middles.iter();
            middles.all(|middle| normal.dot(&(middle - *point)) >= least)
        })
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
    /// Lowest x and y (m).
    pub low: Vector2<f64>,
    /// Highest x and y (m).
    pub high: Vector2<f64>,
}

impl Bounds {
    fn around(points: impl Iterator<Item = Vector2<f64>>) -> Self {
        let [low, high] = extent(points);
        Self { low, high }
    }

    /// Whether the boxes share no inner point.
    pub fn apart(&self, other: &Self) -> bool {
        self.low.x >= other.high.x
            || other.low.x >= self.high.x
            || self.low.y >= other.high.y
            || other.low.y >= self.high.y
    }
}

/// Convex polygons that fill an outline exactly; `None` if it could not be split.
pub(super) fn fill(vertices: &[Vector2<f64>]) -> Option<Vec<ConvexPart>> {
    let parts: Vec<_> = convex::convex_parts(vertices)?
        .into_iter()
        .map(|part| ConvexPart::new(part.into_iter().map(|k| vertices[k]).collect()))
        .collect();
    let filled: f64 = parts.iter().map(ConvexPart::area).sum();
    let area = signed_area(vertices);
    ((filled - area).abs() <= 1e-9 * area).then_some(parts)
}
