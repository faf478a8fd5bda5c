//! How much of the target assembly is complete.

use std::collections::BTreeMap;

use super::statistics::in_target;
use super::{About, MeanInterval};
use crate::assembly::growth::{STEPS, Site};
use petgraph::algo::maximum_matching;
use petgraph::graph::UnGraph;
use physics::table::contacts::{Tie, cluster_of_each};
use physics::table::run::Run;
use physics::table::{Crowd, Mover};

/// The completeness of the target at the end of the runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// With a goal: the share of the largest possible number of tiles in such structures. Otherwise,
    /// for designs: the share of the scarcer kind's tiles, or of all pairs of equal tiles, that are
    /// bound to a partner of their own.
    /// For a tile set: the share of the pattern's tiles that are in place in the most complete
    /// cluster.
    pub share: MeanInterval,
    /// For a tile set: tiles of that cluster that are not in a place of the pattern.
    pub defects: Option<MeanInterval>,
    /// With a goal: tiles outside such structures.
    pub outside: Option<MeanInterval>,
    /// The largest possible number of tiles in such structures.
    pub possible: Option<usize>,
}

impl Target {
    /// Evaluates at least one run; `kinds` are the kinds of the tiles.
    pub fn of(about: &About, (crowd, kinds): (&Crowd, &[usize]), runs: &[Run]) -> Self {
        let alone = |share: MeanInterval| Self {
            share,
            defects: None,
            outside: None,
            possible: None,
        };
        if let Some(goal) = &crowd.goal {
            let possible = kinds.len() / goal.tiles() * goal.tiles();
            let last = |run: &Run| run.samples.last().map_or(0, in_target);
            let inside: Vec<usize> = runs.iter().map(last).collect();
            let outside: Vec<usize> = inside.iter().map(|it| kinds.len() - it).collect();
            return Self {
                outside: Some(MeanInterval::of(&outside).up_to(kinds.len())),
                possible: Some(possible),
                ..alone(MeanInterval::of(&inside).of_at_most(possible))
            };
        }
        let Some(pattern) = &about.pattern else {
            let of_designs = &about.named.kinds;
            let found: Vec<usize> = runs.iter().map(bonds).collect();
            let possible = of_designs.iter().map(|own| pairs(crowd, kinds, *own)).sum();
            return alone(MeanInterval::of(&found).of_at_most(possible));
        };
        let grown: Vec<_> = runs.iter().map(|run| grown(crowd, pattern, run)).collect();
        let of = |pick: fn(&(usize, usize)) -> usize| {
            MeanInterval::of(&grown.iter().map(pick).collect::<Vec<_>>())
        };
        Self {
            defects: Some(of(|it| it.1)),
            ..alone(of(|it| it.0).of_at_most(pattern.len()))
        }
    }
}

/// The number of bound pairs of which no two share a tile.
fn bonds(run: &Run) -> usize {
    let held = run.samples.last().map_or(&[][..], |last| &last.held);
    let bonds = held.iter().filter(|held| held.tie == Tie::Bond);
    let pairs: Vec<[usize; 2]> = bonds.map(|held| held.tiles).collect();
    matched(&pairs)
}

/// The largest possible number of such pairs among the tiles of a design.
fn pairs(crowd: &Crowd, kinds: &[usize], [fixed, moving]: [usize; 2]) -> usize {
    let of_kind = |kind: usize| kinds.iter().filter(|it| **it == kind).count();
    let bind_their_own = |kind: usize| !crowd.couple(kind, kind).0.bonds.is_empty();
    let (n, m) = (of_kind(fixed), of_kind(moving));
    if fixed == moving {
        return n / 2;
    }
    let crossed = match crowd.couple(fixed, moving).0.bonds.is_empty() {
        true => 0,
        false => n.min(m),
    };
    let left = |kind: usize, count: usize| match bind_their_own(kind) {
        true => (count - crossed) / 2,
        false => 0,
    };
    crossed + left(fixed, n) + left(moving, m)
}

/// The size of a maximum matching: pairs of which no two share a tile.
fn matched(pairs: &[[usize; 2]]) -> usize {
    let pairs = pairs.iter().map(|tiles| tiles.map(|tile| tile as u32));
    let graph = UnGraph::<(), ()>::from_edges(pairs.map(<(u32, u32)>::from));
    maximum_matching(&graph).len()
}

/// For the cluster that contains most of the pattern: the number of its tiles in place, and of its
/// others.
fn grown(crowd: &Crowd, pattern: &BTreeMap<Site, usize>, run: &Run) -> (usize, usize) {
    let held = run.samples.last().map_or(&[][..], |last| &last.held);
    let tiles = run.movers.len();
    let mut bound: Vec<Vec<(usize, Site)>> = vec![Vec::new(); tiles];
    for held in held.iter().filter(|held| held.tie == Tie::Bond) {
        let [a, b] = held.tiles;
        for (one, other) in [(a, b), (b, a)] {
            bound[one].push((other, step(crowd, [one, other].map(|it| &run.movers[it]))));
        }
    }
    let mut clusters: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (tile, cluster) in cluster_of_each(tiles, held).into_iter().enumerate() {
        clusters.entry(cluster).or_default().push(tile);
    }
    let mut best = (0, 0);
    for cluster in clusters.into_values() {
        // Within it, tiles connected by bonds have relative places.
        let size = cluster.len();
        let mut rest = cluster;
        while let Some(&first) = rest.first() {
            let places = placed(first, &bound);
            rest.retain(|it| !places.contains_key(it));
            let kinds = places
                .iter()
                .map(|(tile, at)| (run.movers[*tile].kind, *at));
            let right = overlap(pattern, &kinds.collect::<Vec<_>>());
            let found = (right, size - right);
            if found.0 > best.0 || (found.0 == best.0 && found.1 < best.1) {
                best = found;
            }
        }
    }
    best
}

/// The step on the pattern from a tile to one bound to it.
fn step(crowd: &Crowd, [one, other]: [&Mover; 2]) -> Site {
    let [a, b] = [one, other].map(|it| it.motion(crowd).configuration);
    let p = a.inverse_transform(b.position());
    let [north, east, south, west] = STEPS;
    match p.x.abs() > p.y.abs() {
        true if p.x > 0.0 => east,
        true => west,
        false if p.y > 0.0 => north,
        false => south,
    }
}

/// The relative places of all tiles connected to one by bonds.
fn placed(first: usize, bound: &[Vec<(usize, Site)>]) -> BTreeMap<usize, Site> {
    let mut places = BTreeMap::from([(first, (0, 0))]);
    let mut open = vec![first];
    while let Some(tile) = open.pop() {
        let at = places[&tile];
        for (other, step) in &bound[tile] {
            if !places.contains_key(other) {
                places.insert(*other, (at.0 + step.0, at.1 + step.1));
                open.push(*other);
            }
        }
    }
    places
}

/// The largest number of tiles, given by kind and place, that match a pattern over all shifts of
/// it.
fn overlap(pattern: &BTreeMap<Site, usize>, tiles: &[(usize, Site)]) -> usize {
    let mut shifts: BTreeMap<Site, usize> = BTreeMap::new();
    for (kind, at) in tiles {
        for (there, _) in pattern.iter().filter(|(_, other)| *other == kind) {
            *shifts.entry((there.0 - at.0, there.1 - at.1)).or_default() += 1;
        }
    }
    shifts.into_values().max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_partner_counts_twice() {
        assert_eq!(matched(&[]), 0);
        assert_eq!(matched(&[[0, 5], [1, 5], [2, 5]]), 1);
        // Tile 0 must leave its first partner to tile 1.
        assert_eq!(matched(&[[0, 5], [0, 6], [1, 5]]), 2);
    }

    #[test]
    fn tiles_are_set_against_the_pattern_wherever_it_lies() {
        let pattern = BTreeMap::from([((0, 0), 0), ((1, 0), 1), ((0, 1), 2), ((1, 1), 0)]);
        let part = [(1, (5, 5)), (0, (5, 6)), (2, (4, 6))];
        assert_eq!(overlap(&pattern, &part), 3);
        let wrong = [(1, (5, 5)), (2, (5, 6)), (2, (4, 6))];
        assert_eq!(overlap(&pattern, &wrong), 2);
        assert_eq!(overlap(&pattern, &[(3, (0, 0))]), 0);
        let bound = [
            vec![(1, (1, 0))],
            vec![(0, (-1, 0)), (2, (0, 1))],
            vec![(1, (0, -1))],
        ];
        let places = placed(2, &bound);
        assert_eq!(places[&0], (-1, -1));
    }
}
