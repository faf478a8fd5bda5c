//! Pairs of neighbouring milestones, found with a k-d tree in the metric of the configuration
//! space.

use std::f64::consts::{E, PI, TAU};
use std::num::NonZeroUsize;

use kiddo::{ImmutableKdTree, SquaredEuclidean};
use ordered_float::OrderedFloat;

use super::point::Point;
use tiles::configuration::{Configuration, ConfigurationSpace};
use tiles::parallel;

/// Neighbours per milestone that a roadmap of n milestones needs for its paths to tend to the best
/// ones: `e (1 + 1/d) ln n` in d = 3 dimensions, rounded up (PRM* of Karaman and Frazzoli,
/// *Sampling-based algorithms for optimal motion planning*, IJRR 2011, section 3.3).
pub fn neighbours_per_milestone(n: usize) -> usize {
    (E * (1.0 + 1.0 / 3.0) * libm::log(n.max(2) as f64)).ceil() as usize
}

/// The number of milestones that are looked for at first.
const FIRST: usize = 32;

/// Finds the milestones closest to a configuration.
///
/// The metric `d^2 = dx^2 + dy^2 + rho^2 dtheta^2` is Euclidean in (x, y, rho theta); theta's
/// period is handled by a second query one turn away if the seam is closer than the farthest
/// neighbour found.
pub struct NeighbourSearch<'a> {
    tree: ImmutableKdTree<f64, 3>,
    space: &'a ConfigurationSpace,
}

impl<'a> NeighbourSearch<'a> {
    /// The search over milestones, indexed in the given order.
    pub fn new(milestones: &[Configuration], space: &'a ConfigurationSpace) -> Self {
        let points: Vec<[f64; 3]> = milestones
            .iter()
            .map(|q| point(q, space.rho, 0.0))
            .collect();
        Self {
            tree: ImmutableKdTree::new_from_slice(&points)
                .expect("a tree of milestones with finite coordinates"),
            space,
        }
    }

    /// The `k` milestones closest to `q` with their squared distances (m^2), nearest first; equal
    /// distances by index.
    pub fn nearest(&self, q: &Configuration, k: usize) -> Vec<(f64, u32)> {
        let Some(count) = NonZeroUsize::new(k) else {
            return Vec::new();
        };
        let mut found = self.ask(q, count, 0.0);
        let seam = self.space.rho * (PI - q.theta.abs());
        if found.len() < k || found.last().is_some_and(|f| f.0 >= seam * seam) {
            found.extend(self.ask(q, count, -q.theta.signum() * TAU));
            found.sort_by_key(|&(squared, index)| (OrderedFloat(squared), index));
            let mut seen = std::collections::HashSet::new();
            found.retain(|f| seen.insert(f.1));
            found.truncate(k);
        }
        found
    }

    /// All milestones, nearest to `q` first. Few are looked for at once, as most callers need a few.
    pub fn by_distance(&self, q: Configuration) -> impl Iterator<Item = usize> {
        let all = self.tree.size();
        let ends = std::iter::successors(Some(FIRST.min(all)), move |&end| {
            (end < all).then_some((2 * end).min(all))
        });
        let mut from = 0;
        ends.flat_map(move |end| {
            let found = self.nearest(&q, end);
            let fresh = found.into_iter().skip(std::mem::replace(&mut from, end));
            fresh.map(|(_, index)| index as usize)
        })
    }

    fn ask(&self, q: &Configuration, count: NonZeroUsize, turn: f64) -> Vec<(f64, u32)> {
        let mut found: Vec<(f64, u32)> = self
            .tree
            .query(&point(q, self.space.rho, turn))
            .nearest_n::<SquaredEuclidean<f64>>(count)
            .execute()
            .into_iter()
            .map(|f| (f.distance, f.item))
            .collect();
        found.sort_by_key(|&(squared, index)| (OrderedFloat(squared), index));
        found
    }
}

fn point(q: &Configuration, rho: f64, turn: f64) -> [f64; 3] {
    [q.x, q.y, rho * (q.theta + turn)]
}

/// All pairs (smaller index, larger index) in which one milestone is among the other's `k`
/// nearest, sorted.
pub fn neighbour_pairs(
    milestones: &[Point],
    space: &ConfigurationSpace,
    k: usize,
) -> Vec<(u32, u32)> {
    if milestones.len() < 2 {
        return Vec::new();
    }
    let k = k.min(milestones.len() - 1);
    let places: Vec<Configuration> = milestones.iter().map(|milestone| milestone.q).collect();
    let search = NeighbourSearch::new(&places, space);
    let near: Vec<Vec<u32>> = parallel::map(milestones, |milestone| {
        let found = search.nearest(&milestone.q, k + 1);
        found.into_iter().map(|(_, index)| index).collect()
    });
    let mut later: Vec<Vec<u32>> = vec![Vec::new(); milestones.len()];
    for (i, near) in (0u32..).zip(&near) {
        for &j in near.iter().filter(|j| **j != i).take(k) {
            later[i.min(j) as usize].push(i.max(j));
        }
    }
    parallel::for_each(&mut later, |later| {
        later.sort_unstable();
        later.dedup();
    });
    let with = |(i, later): (u32, Vec<u32>)| later.into_iter().map(move |j| (i, j));
    (0..).zip(later).flat_map(with).collect()
}
