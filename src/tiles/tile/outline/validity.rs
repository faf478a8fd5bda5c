//! Checks that a list of vertices is a valid outline.

use nalgebra::Vector2;

use crate::tile::plane::{cross, segments_meet, signed_area};

/// Why a list of vertices is not an outline.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OutlineError {
    /// Fewer than three vertices, not counting those on the straight line between their neighbours.
    #[error("an outline needs at least three corners, this one has {0}")]
    TooFewVertices(usize),
    /// Two vertices, given by their indices, coincide.
    #[error("vertices {0} and {1} coincide")]
    RepeatedVertex(usize, usize),
    /// The vertices run the wrong way round.
    #[error("the outline runs clockwise; list its vertices counter-clockwise")]
    Clockwise,
    /// Two edges, given by the indices of their first vertices, intersect.
    #[error("the edge from vertex {0} crosses or touches the edge from vertex {1}")]
    SelfCrossing(usize, usize),
    /// No convex parts were found.
    #[error("the outline could not be split into convex parts; is it a simple polygon?")]
    NotDecomposable,
}

/// Whether vertices form a simple, counter-clockwise polygon.
pub(super) fn check(vertices: &[Vector2<f64>]) -> Result<(), OutlineError> {
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

/// The vertices that do not lie on the straight line between their neighbours.
pub(super) fn without_collinear(vertices: Vec<Vector2<f64>>) -> Vec<Vector2<f64>> {
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
