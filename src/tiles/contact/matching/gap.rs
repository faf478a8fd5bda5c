//! The area left between two outlines in contact.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use super::{Facing, TOUCHING};
use crate::configuration::Configuration;
use crate::order::Order;
use crate::scale::Scale;
use crate::tile::Outline;
use crate::tile::outline::signed_area;

/// The area (m^2) between the tiles along their contact: the part of the convex hull of all
/// stretches in contact (of such pairs of edges) that neither tile fills.
pub(super) fn gap_area(
    [fixed, moving]: [&Outline; 2],
    facing: &[Facing],
    q: &Configuration,
    scale: Scale,
) -> f64 {
    let touching = scale.length(TOUCHING);
    let stretches = facing
        .iter()
        .filter_map(|it| it.stretch(q.position(), touching));
    let points: Vec<Vector2<f64>> = stretches.flatten().collect();
    let hull = hull(points);
    let placed = moving.vertices().iter().map(|p| q.transform(*p)).collect();
    let filled = area_within(fixed.vertices().to_vec(), &hull) + area_within(placed, &hull);
    let gap = signed_area(&hull) - filled;
    // Rounding errors of outlines that fit.
    if gap < touching * scale.length(TOUCHING.sqrt()) {
        0.0
    } else {
        gap
    }
}

/// The area (m^2) of the intersection of a polygon with a convex one, both counter-clockwise, by
/// clipping at each side (Sutherland and Hodgman 1974). Edges duplicated by clipping enclose no
/// area.
fn area_within(polygon: Vec<Vector2<f64>>, hull: &[Vector2<f64>]) -> f64 {
    let sides = (0..hull.len()).map(|i| [hull[i], hull[(i + 1) % hull.len()]]);
    signed_area(&sides.fold(polygon, |left, side| clipped(&left, side)))
}

/// The part of a polygon to the left of the line from a to b.
fn clipped(polygon: &[Vector2<f64>], [a, b]: [Vector2<f64>; 2]) -> Vec<Vector2<f64>> {
    let height = |p: &Vector2<f64>| (b - a).perp(&(p - a));
    let next = polygon.iter().cycle().skip(1);
    let mut left = Vec::with_capacity(polygon.len() + 1);
    for (p, q) in polygon.iter().zip(next) {
        let (from, to) = (height(p), height(q));
        if from >= 0.0 {
            left.push(*p);
        }
        if (from < 0.0) != (to < 0.0) {
            left.push(p + (q - p) * (from / (from - to)));
        }
    }
    left
}

/// The convex hull, counter-clockwise (Andrew's monotone chain).
fn hull(mut points: Vec<Vector2<f64>>) -> Vec<Vector2<f64>> {
    points.order_by_key(|p| (OrderedFloat(p.x), OrderedFloat(p.y)));
    points.dedup();
    let mut lower = half_hull(points.iter());
    lower.extend(half_hull(points.iter().rev()));
    lower
}

/// The half of a hull to the right of the path along ordered points, without its last point.
fn half_hull<'a>(points: impl Iterator<Item = &'a Vector2<f64>>) -> Vec<Vector2<f64>> {
    let mut chain: Vec<Vector2<f64>> = Vec::new();
    for p in points {
        while let [.., a, b] = chain[..] {
            if (b - a).perp(&(p - a)) > 1e-12 * (b - a).norm() * (p - a).norm() {
                break;
            }
            chain.pop();
        }
        chain.push(*p);
    }
    chain.pop();
    chain
}
