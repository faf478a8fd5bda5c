//! The core of an outline: a large convex polygon inside it.
//!
//! Most overlaps are overlaps of cores, and those are cheap to find. A face with teeth or slots is
//! drawn back to the bottom of its notches; what is left of the convex hull is the core.

use nalgebra::Vector2;

use crate::tile::Outline;
use crate::tile::outline::ConvexPart;

/// Lengths (m) below this are nothing.
const TINY: f64 = 1e-9;

/// A convex polygon inside the outline: the hull with its edges moved in to the bottom of the
/// notches behind them, or the largest convex part where that is not inside.
pub(super) fn core(outline: &Outline) -> ConvexPart {
    drawn_back_hull(outline)
        .filter(|core| is_inside(core, outline))
        .unwrap_or_else(|| largest_part(outline))
}

fn largest_part(outline: &Outline) -> ConvexPart {
    let parts = outline.parts().iter();
    let largest = parts.max_by(|a, b| a.area().total_cmp(&b.area()));
    largest.map_or_else(|| outline.hull(), ConvexPart::clone)
}

fn drawn_back_hull(outline: &Outline) -> Option<ConvexPart> {
    let hull = outline.hull();
    let mut points = hull.points.clone();
    let reflex = outline.vertices().iter().zip(outline.convex_vertices());
    for (vertex, _) in reflex.filter(|(_, convex)| !**convex) {
        let edges = hull.points.iter().zip(&hull.normals);
        let (_, normal) = edges
            .map(|(point, normal)| (normal.dot(&(point - vertex)), normal))
            .min_by(|a, b| a.0.total_cmp(&b.0))?;
        points = cut(&points, normal, normal.dot(vertex));
    }
    points.dedup_by(|a, b| (*a - *b).norm() < TINY);
    while points.len() > 1 && (points[0] - points[points.len() - 1]).norm() < TINY {
        points.pop();
    }
    (points.len() > 2).then(|| ConvexPart::new(points))
}

/// The part of a convex polygon where the coordinate along `normal` is at most `most`.
fn cut(points: &[Vector2<f64>], normal: &Vector2<f64>, most: f64) -> Vec<Vector2<f64>> {
    let mut kept = Vec::with_capacity(points.len() + 1);
    for (i, a) in points.iter().enumerate() {
        let b = &points[(i + 1) % points.len()];
        let (over_a, over_b) = (normal.dot(a) - most, normal.dot(b) - most);
        if over_a <= 0.0 {
            kept.push(*a);
        }
        if (over_a < 0.0 && over_b > 0.0) || (over_a > 0.0 && over_b < 0.0) {
            kept.push(a + (b - a) * (over_a / (over_a - over_b)));
        }
    }
    kept
}

/// Whether no edge of the outline enters the polygon and the polygon is not wholly outside.
fn is_inside(core: &ConvexPart, outline: &Outline) -> bool {
    let middle = core.points.iter().sum::<Vector2<f64>>() / core.points.len() as f64;
    outline.contains(middle)
        && (0..outline.vertices().len()).all(|i| {
            let (a, b) = outline.edge(i);
            // The piece of the edge that lies inside all edges of the polygon.
            let (mut start, mut end) = (0.0_f64, 1.0_f64);
            for (point, normal) in core.points.iter().zip(&core.normals) {
                let from = normal.dot(&(a - point)) + TINY;
                let rate = normal.dot(&(b - a));
                if rate.abs() < TINY * TINY {
                    if from >= 0.0 {
                        return true;
                    }
                } else if rate > 0.0 {
                    end = end.min(-from / rate);
                } else {
                    start = start.max(-from / rate);
                }
            }
            start >= end
        })
}

#[cfg(test)]
mod tests {
    use super::super::tests::{outline, saw, square};
    use super::*;

    #[test]
    fn a_convex_outline_is_its_own_core() {
        let square = square(0.4);
        assert!((core(&square).area() - square.area()).abs() < 1e-12);
    }

    #[test]
    fn a_saw_loses_its_teeth_and_no_more() {
        let saw = saw(false);
        assert!((core(&saw).area() - 0.4 * 0.4).abs() < 1e-9);
    }

    #[test]
    fn cores_lie_inside() {
        // An L, a notch that is wider inside, and a star: nothing simple to draw back.
        let shapes = [
            vec![
                [0.0, 0.0],
                [3.0, 0.0],
                [3.0, 1.0],
                [1.0, 1.0],
                [1.0, 3.0],
                [0.0, 3.0],
            ],
            vec![
                [0.0, 0.0],
                [4.0, 0.0],
                [4.0, 3.0],
                [2.5, 3.0],
                [3.0, 2.0],
                [1.0, 2.0],
                [1.5, 3.0],
                [0.0, 3.0],
            ],
            (0..10)
                .map(|k| {
                    let (r, a) = (if k % 2 == 0 { 1.0 } else { 0.4 }, 0.628 * f64::from(k));
                    [r * f64::cos(a), r * f64::sin(a)]
                })
                .collect(),
        ];
        for shape in shapes {
            let outline = outline(&shape);
            let core = core(&outline);
            assert!(core.area() > 0.2 * outline.area());
            for i in 0..60 {
                for j in 0..60 {
                    let p = Vector2::new(-1.03 + 0.09 * f64::from(i), -1.02 + 0.09 * f64::from(j));
                    let within = core
                        .points
                        .iter()
                        .zip(&core.normals)
                        .all(|(q, n)| n.dot(&(p - q)) < -1e-6);
                    assert!(!within || outline.contains(p), "{p}");
                }
            }
        }
    }
}
