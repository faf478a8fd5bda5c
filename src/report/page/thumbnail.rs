//! A small drawing of the tiles of a sweep's point.

use serde::Serialize;

use super::landscape::{Drawn, pose};
use crate::points::FinishedSweep;
use jobs::sweep::SweepPoint;

/// With more points the page would grow large.
const MOST_POINTS: usize = 200;
/// Largest distance of omitted corners from the simplified outline, as a fraction of its extent:
/// less than a pixel of a small picture.
const TOLERANCE: f64 = 0.004;

/// Both tiles, bound.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Thumbnail {
    fixed: Drawn,
    moving: Drawn,
    bound: [f64; 3],
}

impl Thumbnail {
    /// `None` if the design is impossible, or there are too many.
    pub fn of(sweep: &FinishedSweep, point: &SweepPoint) -> Option<Self> {
        if sweep.points.len() > MOST_POINTS {
            return None;
        }
        let design = sweep.plan.design(point).ok()?;
        let [fixed, moving] = [&design.pair.fixed, &design.pair.moving].map(|tile| {
            let mut drawn = Drawn::new(tile);
            drawn.outline = simplified(&drawn.outline);
            drawn
        });
        Some(Self {
            fixed,
            moving,
            bound: pose(&design.pair.bound),
        })
    }
}

type Corner = [f64; 2];

/// An outline without negligible corners.
fn simplified(outline: &[Corner]) -> Vec<Corner> {
    let extent = outline
        .iter()
        .flatten()
        .fold(0.0, |most: f64, c| most.max(c.abs()));
    // The outline is closed: it starts and ends at the first corner.
    let mut closed = outline.to_vec();
    closed.extend(outline.first());
    let mut kept = vec![false; closed.len()];
    keep(&closed, 0, closed.len() - 1, TOLERANCE * extent, &mut kept);
    let corners = outline.iter().zip(&kept).enumerate();
    let corners = corners.filter(|(k, (_, kept))| *k == 0 || **kept);
    corners.map(|(_, (corner, _))| *corner).collect()
}

/// Keeps the corner farthest from the line through two others, and recurses on both sides of it
/// (Ramer, Douglas and Peucker).
fn keep(corners: &[Corner], first: usize, last: usize, tolerance: f64, kept: &mut [bool]) {
    let far = |k: usize| apart(corners[k], [corners[first], corners[last]]);
    let between = first + 1..last;
    let Some(farthest) = between.max_by(|a, b| far(*a).total_cmp(&far(*b))) else {
        return;
    };
    if far(farthest) > tolerance {
        kept[farthest] = true;
        keep(corners, first, farthest, tolerance, kept);
        keep(corners, farthest, last, tolerance, kept);
    }
}

/// Distance of a point from the line through two others, or from their common position.
fn apart(p: Corner, [a, b]: [Corner; 2]) -> f64 {
    let (along, from) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length = libm::hypot(along[0], along[1]);
    if length == 0.0 {
        return libm::hypot(from[0], from[1]);
    }
    (along[0] * from[1] - along[1] * from[0]).abs() / length
}

#[cfg(test)]
mod tests {
    use super::simplified;

    #[test]
    fn corners_stay_and_points_between_them_go() {
        let square = [
            [1.0, -1.0],
            [1.0, 0.0],
            [1.0, 1.0],
            [0.0, 1.0005],
            [-1.0, 1.0],
            [-1.0, -1.0],
        ];
        let expected = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
        assert_eq!(simplified(&square), expected);
    }
}
