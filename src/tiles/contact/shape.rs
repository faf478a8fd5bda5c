//! The shape of one tile, as the contact queries use it.

use ordered_float::OrderedFloat;

use super::tree::{Circle, CircleTree};
use crate::tile::Outline;
use crate::tile::outline::{Bounds, ConvexPart};

/// One tile's outline with its search structures.
#[derive(Clone, Debug)]
pub(super) struct SearchedOutline {
    pub outline: Outline,
    pub edges: CircleTree,
    pub corners: CircleTree,
    /// The vertex of each piece of `corners`.
    pub numbers: Vec<usize>,
    /// The tree over the convex parts.
    pub parts: CircleTree,
    /// The bounds of each convex part.
    pub bounds: Vec<Bounds>,
    pub hull: ConvexPart,
    /// The largest convex part, which is most likely to collide.
    pub core: ConvexPart,
}

impl SearchedOutline {
    pub fn new(outline: &Outline) -> Self {
        let n = outline.vertices().len();
        let circle = |i: usize| {
            let (a, b) = outline.edge(i);
            ((a + b) / 2.0, (b - a).norm() / 2.0)
        };
        let edges: Vec<_> = (0..n).map(circle).collect();
        let numbers: Vec<_> = (0..n).filter(|&i| outline.convex_vertices()[i]).collect();
        let corners: Vec<_> = numbers
            .iter()
            .map(|&i| (outline.vertices()[i], 0.0))
            .collect();
        let parts = outline.parts();
        let hull = outline.hull();
        let largest = parts.iter().max_by_key(|part| OrderedFloat(part.area()));
        Self {
            edges: CircleTree::new(&edges),
            corners: CircleTree::new(&corners),
            numbers,
            parts: CircleTree::new(&parts.iter().map(around).collect::<Vec<_>>()),
            bounds: parts.iter().map(ConvexPart::bounds).collect(),
            core: largest.unwrap_or(&hull).clone(),
            hull,
            outline: outline.clone(),
        }
    }

    pub fn next(&self, i: usize) -> usize {
        (i + 1) % self.outline.vertices().len()
    }

    pub fn before(&self, i: usize) -> usize {
        let n = self.outline.vertices().len();
        (i + n - 1) % n
    }

    pub fn length(&self, edge: usize) -> f64 {
        let (a, b) = self.outline.edge(edge);
        (b - a).norm()
    }
}

/// A circle around a convex part.
fn around(part: &ConvexPart) -> Circle {
    let bounds = part.bounds();
    let middle = (bounds.low + bounds.high) / 2.0;
    let distances = part.points.iter().map(|p| (p - middle).norm());
    (middle, distances.fold(0.0, f64::max))
}
