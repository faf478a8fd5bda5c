//! The distance between two outlines.
//!
//! Outlines that do not overlap are closest to each other at a convex corner of one of them and an
//! edge of the other, so their distance is the minimum over all such pairs. Nearer branches of the
//! trees over both outlines are searched first, and branches farther than the best distance are
//! skipped.

use nalgebra::Vector2;

use super::Contact;
use super::shape::SearchedOutline;
use super::tree::{Below, Branch};
use crate::configuration::Configuration;
use crate::tile::outline::distance_to_segment;

impl Contact {
    /// The distance (m) of the outlines, which do not overlap: exact if it is between `least` and
    /// `most`. For a smaller distance the result is some value below `least`, for a larger one
    /// `most`.
    pub fn distance(&self, q: &Configuration, [least, most]: [f64; 2]) -> f64 {
        let distance = nearest(&self.fixed, &self.moving, q, [least, most]);
        nearest(&self.moving, &self.fixed, &q.inverse(), [least, distance])
    }
}

/// The least distance (m) of a corner of `theirs`, which lies at `pose` in the frame of `ours`,
/// from an edge of `ours`, if it is below `most`.
fn nearest(
    ours: &SearchedOutline,
    theirs: &SearchedOutline,
    pose: &Configuration,
    [least, most]: [f64; 2],
) -> f64 {
    let (rotation, position) = (pose.rotation(), pose.position());
    let place = |p: Vector2<f64>| position + rotation * p;
    let mut search = NearestPair {
        ours,
        theirs,
        place: &place,
        least,
        best: most,
    };
    let [edges, corners] = [ours.edges.root(), theirs.corners.root()];
    let pair = (edges, corners, place(corners.centre));
    search.below(search.gap(&pair), pair);
    search.best
}

/// A branch of our edges, one of their corners, and the position of its centre.
type Pair = (Branch, Branch, Vector2<f64>);

struct NearestPair<'a, P> {
    ours: &'a SearchedOutline,
    theirs: &'a SearchedOutline,
    place: &'a P,
    least: f64,
    best: f64,
}

impl<P: Fn(Vector2<f64>) -> Vector2<f64>> NearestPair<'_, P> {
    /// Least distance (m) of the contents of two branches.
    fn gap(&self, (edges, corners, centre): &Pair) -> f64 {
        (edges.centre - centre).norm() - edges.radius - corners.radius
    }

    fn below(&mut self, gap: f64, (edges, corners, centre): Pair) {
        if gap >= self.best || self.best <= self.least {
            return;
        }
        let lists = (
            self.ours.edges.below(&edges),
            self.theirs.corners.below(&corners),
        );
        let parts: [Pair; 2] = match lists {
            (Below::Pieces(ours), Below::Pieces(theirs)) => return self.among(ours, theirs),
            (Below::Branches(halves), theirs)
                if edges.radius >= corners.radius || matches!(theirs, Below::Pieces(_)) =>
            {
                halves.map(|half| (half, corners, centre))
            }
            (Below::Branches(_) | Below::Pieces(_), Below::Branches(halves)) => {
                halves.map(|half| (edges, half, (self.place)(half.centre)))
            }
            (Below::Branches(halves), Below::Pieces(_)) => {
                halves.map(|half| (half, corners, centre))
            }
        };
        let [first, second] = parts.map(|pair| (self.gap(&pair), pair));
        let (first, second) = if first.0 <= second.0 {
            (first, second)
        } else {
            (second, first)
        };
        self.below(first.0, first.1);
        self.below(second.0, second.1);
    }

    fn among(&mut self, ours: &[usize], theirs: &[usize]) {
        for &corner in theirs {
            let vertices = self.theirs.outline.vertices();
            let p = (self.place)(vertices[self.theirs.numbers[corner]]);
            for &edge in ours {
                let (middle, radius) = self.ours.edges.circle(edge);
                let most = self.best + radius;
                if (middle - p).norm_squared() >= most * most {
                    continue;
                }
                let (start, end) = self.ours.outline.edge(edge);
                self.best = self.best.min(distance_to_segment(p, start, end));
            }
        }
    }
}
