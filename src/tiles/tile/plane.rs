//! Points, segments and polygons of the plane.

use nalgebra::Vector2;

/// Whether a point lies inside a closed polygon (even-odd rule; either answer is possible on the
/// boundary).
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

/// The lower left and the upper right corner of the smallest rectangle around points; infinite for none.
pub fn extent(points: impl IntoIterator<Item = Vector2<f64>>) -> [Vector2<f64>; 2] {
    let none = Vector2::repeat(f64::INFINITY);
    let points = points.into_iter();
    points.fold([none, -none], |[low, high], p| [low.inf(&p), high.sup(&p)])
}

/// z component of the cross product of two plane vectors.
#[inline]
pub fn cross(a: Vector2<f64>, b: Vector2<f64>) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Distance of a point to a segment (m).
pub fn distance_to_segment(p: Vector2<f64>, a: Vector2<f64>, b: Vector2<f64>) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (p - a - along * t).norm()
}

/// Unit normal to the right of the direction from `a` to `b`: outward for a counter-clockwise
/// polygon.
pub(super) fn outward_normal(a: Vector2<f64>, b: Vector2<f64>) -> Vector2<f64> {
    let t = (b - a).normalize();
    Vector2::new(t.y, -t.x)
}

/// Area of a closed polygon, negative where it runs clockwise (m^2).
pub fn signed_area(vertices: &[Vector2<f64>]) -> f64 {
    let n = vertices.len();
    (0..n)
        .map(|i| cross(vertices[i], vertices[(i + 1) % n]))
        .sum::<f64>()
        / 2.0
}

/// Centre of mass of an evenly filled polygon (m).
pub fn centroid(vertices: &[Vector2<f64>]) -> Vector2<f64> {
    let edges = vertices
        .iter()
        .enumerate()
        .map(|(i, a)| (*a, vertices[(i + 1) % vertices.len()]));
    edges
        .map(|(a, b)| (a + b) * cross(a, b))
        .sum::<Vector2<f64>>()
        / (6.0 * signed_area(vertices))
}

/// Whether two segments share a point, ends included. An end counts as lying on the other segment's
/// line if its direction from the line's first point deviates by an angle of sine `straight` or
/// less.
pub(in crate::tile) fn segments_meet(
    [a, b]: [Vector2<f64>; 2],
    [c, d]: [Vector2<f64>; 2],
    straight: f64,
) -> bool {
    // Segments on one line meet only if their boxes do; for all others the boxes then overlap
    // anyway.
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
