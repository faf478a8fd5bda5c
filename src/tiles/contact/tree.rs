//! A bounding-circle tree over the pieces of an outline, for queries by distance from a point or
//! from another outline.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use crate::order::Order;
use crate::tile::plane::extent;

/// Pieces in a leaf, at most.
const LEAF: usize = 4;

#[derive(Clone, Debug)]
struct Node {
    centre: Vector2<f64>,
    radius: f64,
    /// Largest distance (m) of any point in the circle from the origin.
    lever: f64,
    /// The pieces below it, as a range of `order`.
    first: usize,
    end: usize,
    /// The second child; the first follows its parent. 0 for a leaf.
    second: usize,
}

/// A binary tree over pieces, each within a circle.
#[derive(Clone, Debug)]
pub(super) struct CircleTree {
    nodes: Vec<Node>,
    order: Vec<usize>,
    /// The circles of the pieces, by index.
    circles: Vec<Circle>,
    /// Largest distance (m) of any point of a piece from the origin.
    levers: Vec<f64>,
}

/// A circle: its centre and its radius (m).
pub(super) type Circle = (Vector2<f64>, f64);

fn lever((centre, radius): &Circle) -> f64 {
    centre.norm() + radius
}

/// A node of a tree and the circle around all its pieces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    node: usize,
    pub centre: Vector2<f64>,
    pub radius: f64,
}

/// The children of a branch.
pub(super) enum Below<'a> {
    Branches([Branch; 2]),
    Pieces(&'a [usize]),
}

impl CircleTree {
    /// A tree over circles (centre, radius), of which there is at least one.
    pub fn new(circles: &[Circle]) -> Self {
        let mut tree = Self {
            nodes: Vec::new(),
            order: (0..circles.len()).collect(),
            circles: circles.to_vec(),
            levers: circles.iter().map(lever).collect(),
        };
        tree.build(circles, 0, circles.len());
        tree
    }

    fn build(&mut self, circles: &[Circle], first: usize, end: usize) {
        let pieces = &mut self.order[first..end];
        let [low, high] = extent(pieces.iter().map(|&k| circles[k].0));
        let centre = (low + high) / 2.0;
        let radius = pieces
            .iter()
            .map(|&k| (circles[k].0 - centre).norm() + circles[k].1)
            .fold(0.0, f64::max);
        let axis = (high - low).imax();
        pieces.order_by_key(|&k| OrderedFloat(circles[k].0[axis]));
        let node = self.nodes.len();
        self.nodes.push(Node {
            centre,
            radius,
            lever: lever(&(centre, radius)),
            first,
            end,
            second: 0,
        });
        if end - first > LEAF {
            let middle = (first + end) / 2;
            self.build(circles, first, middle);
            self.nodes[node].second = self.nodes.len();
            self.build(circles, middle, end);
        }
    }

    /// The circle around a piece.
    pub fn circle(&self, piece: usize) -> Circle {
        self.circles[piece]
    }

    pub fn root(&self) -> Branch {
        self.branch(0)
    }

    fn branch(&self, node: usize) -> Branch {
        Branch {
            node,
            centre: self.nodes[node].centre,
            radius: self.nodes[node].radius,
        }
    }

    pub fn below(&self, branch: &Branch) -> Below<'_> {
        let node = &self.nodes[branch.node];
        if node.second == 0 {
            Below::Pieces(&self.order[node.first..node.end])
        } else {
            Below::Branches([self.branch(branch.node + 1), self.branch(node.second)])
        }
    }

    /// One of a branch's pieces: the one with the lowest index.
    pub fn first(&self, branch: &Branch) -> usize {
        let node = &self.nodes[branch.node];
        let pieces = &self.order[node.first..node.end];
        pieces.iter().copied().min().unwrap_or_default()
    }

    /// The smallest distance of a piece from a point; `distance` computes that of each piece.
    pub fn nearest(&self, p: Vector2<f64>, distance: &impl Fn(usize) -> f64) -> f64 {
        self.nearest_below(&self.root(), p, distance, f64::INFINITY)
    }

    fn nearest_below(
        &self,
        branch: &Branch,
        p: Vector2<f64>,
        distance: &impl Fn(usize) -> f64,
        best: f64,
    ) -> f64 {
        let least = |branch: &Branch| (p - branch.centre).norm() - branch.radius;
        if least(branch) >= best {
            return best;
        }
        match self.below(branch) {
            Below::Pieces(pieces) => pieces.iter().map(|&k| distance(k)).fold(best, f64::min),
            Below::Branches([a, b]) => {
                let (first, second) = if least(&a) <= least(&b) {
                    (a, b)
                } else {
                    (b, a)
                };
                let best = self.nearest_below(&first, p, distance, best);
                self.nearest_below(&second, p, distance, best)
            }
        }
    }

    /// Calls `found` for pieces that may be within `distance` of a point, until it returns false;
    /// returns whether it never did.
    pub fn near(
        &self,
        p: Vector2<f64>,
        distance: f64,
        found: &mut impl FnMut(usize) -> bool,
    ) -> bool {
        self.near_below(&self.root(), p, distance, found)
    }

    fn near_below(
        &self,
        branch: &Branch,
        p: Vector2<f64>,
        distance: f64,
        found: &mut impl FnMut(usize) -> bool,
    ) -> bool {
        let most = distance + branch.radius;
        if (p - branch.centre).norm_squared() > most * most {
            return true;
        }
        match self.below(branch) {
            Below::Pieces(pieces) => pieces.iter().all(|&k| found(k)),
            Below::Branches(branches) => branches
                .iter()
                .all(|branch| self.near_below(branch, p, distance, found)),
        }
    }

    /// Calls `found` for pairs of pieces of this tree and of another, whose points are placed by
    /// `place`, that may be closer than a distance, until it returns false; returns whether it
    /// never did. `distance` gives the distance for pieces of the other tree by their largest
    /// distance from its origin.
    pub fn near_pairs(
        &self,
        other: &Self,
        place: &impl Fn(Vector2<f64>) -> Vector2<f64>,
        distance: &impl Fn(f64) -> f64,
        found: &mut impl FnMut(usize, usize) -> bool,
    ) -> bool {
        let search = PairSearch {
            ours: self,
            theirs: other,
            place,
            distance,
        };
        search.below(&self.root(), &search.placed(other.root()), found)
    }
}

/// A search for pairs of pieces of two trees.
struct PairSearch<'a, P, D> {
    ours: &'a CircleTree,
    theirs: &'a CircleTree,
    place: &'a P,
    distance: &'a D,
}

/// A branch of the placed tree: the position of its centre, and the distance (m) from it beyond
/// which nothing is near its pieces.
struct Placed {
    branch: Branch,
    centre: Vector2<f64>,
    reach: f64,
}

impl<P, D> PairSearch<'_, P, D>
where
    P: Fn(Vector2<f64>) -> Vector2<f64>,
    D: Fn(f64) -> f64,
{
    fn placed(&self, branch: Branch) -> Placed {
        Placed {
            branch,
            centre: (self.place)(branch.centre),
            reach: branch.radius + (self.distance)(self.theirs.nodes[branch.node].lever),
        }
    }

    fn below(&self, a: &Branch, b: &Placed, found: &mut impl FnMut(usize, usize) -> bool) -> bool {
        let most = a.radius + b.reach;
        if (a.centre - b.centre).norm_squared() > most * most {
            return true;
        }
        match (self.ours.below(a), self.theirs.below(&b.branch)) {
            (Below::Pieces(ours), Below::Pieces(theirs)) => self.among(a, ours, theirs, found),
            (Below::Branches(ours), theirs)
                if a.radius >= b.branch.radius || matches!(theirs, Below::Pieces(_)) =>
            {
                ours.iter().all(|a| self.below(a, b, found))
            }
            (_, Below::Branches(theirs)) => theirs
                .iter()
                .all(|b| self.below(a, &self.placed(*b), found)),
            (Below::Branches(ours), Below::Pieces(_)) => {
                ours.iter().all(|a| self.below(a, b, found))
            }
        }
    }

    fn among(
        &self,
        around: &Branch,
        ours: &[usize],
        theirs: &[usize],
        found: &mut impl FnMut(usize, usize) -> bool,
    ) -> bool {
        theirs.iter().all(|&j| {
            let (centre, radius) = self.theirs.circles[j];
            let centre = (self.place)(centre);
            let reach = radius + (self.distance)(self.theirs.levers[j]);
            let most = around.radius + reach;
            if (around.centre - centre).norm_squared() > most * most {
                return true;
            }
            ours.iter().all(|&i| {
                let (ours, radius) = self.ours.circles[i];
                let most = radius + reach;
                (ours - centre).norm_squared() > most * most || found(i, j)
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn no_near_piece_and_no_near_pair_is_missed() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let mut circles = |n: usize| -> Vec<(Vector2<f64>, f64)> {
            (0..n)
                .map(|_| {
                    let mut random = || rng.random_range(-1.0..1.0);
                    (Vector2::new(random(), random()), 0.05 * f64::abs(random()))
                })
                .collect()
        };
        for n in [1, 3, 5, 60] {
            let (a, b) = (circles(n), circles(40));
            let (ta, tb) = (CircleTree::new(&a), CircleTree::new(&b));
            let shift = Vector2::new(0.4, -0.2);
            let gap = |i: usize, j: usize| (a[i].0 - b[j].0 - shift).norm() - a[i].1 - b[j].1;
            let mut pairs = Vec::new();
            ta.near_pairs(&tb, &|p| p + shift, &|_| 0.1, &mut |i, j| {
                pairs.push((i, j));
                true
            });
            for i in 0..n {
                let p = b[i % 40].0;
                let mut found = Vec::new();
                ta.near(p, 0.1, &mut |k| {
                    found.push(k);
                    true
                });
                let distance = |k: usize| (a[k].0 - p).norm() - a[k].1;
                let nearest = (0..n).map(distance).fold(f64::INFINITY, f64::min);
                assert_eq!(ta.nearest(p, &distance), nearest);
                assert!((0..n).all(|k| (a[k].0 - p).norm() - a[k].1 > 0.1 || found.contains(&k)));
                assert!((0..40).all(|j| gap(i, j) > 0.1 || pairs.contains(&(i, j))));
            }
            assert!(pairs.len() < n * 40 || n < 5);
        }
    }
}
