//! What tiles have built at one instant: rings, chains and sheets of bonds.
//!
//! Tiles connected by bonds form a structure. Their bonds fix where they would lie if every bond
//! were exact; gaps and shared corners are read off these places, not off the shaken ones.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use nalgebra::Vector2;
use petgraph::unionfind::UnionFind;

use super::contacts::{Held, Tie, cluster_of_each};
use super::crowd::Crowd;
pub use super::goal::Goal;
use super::neighbours::Neighbours;
use crate::rigid::{Mover, Two};
use tiles::configuration::{Configuration, wrap_angle};
use tiles::tile::Face;
use tiles::tile::symmetry::rotations;

/// Corners of different tiles closer than this share of a tile's radius are one point.
const SAME_CORNER: f64 = 0.05;
/// Tiles of a pattern are in place to this share of their radius, and ...
const IN_PLACE: f64 = 0.1;
/// ... to this angle (rad).
const TURNED: f64 = 0.1;

/// The kind of a structure.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
pub enum StructureShape {
    /// A closed cycle of bonds, without other bonds.
    Ring,
    /// An open row: its ends have one bond, all other tiles two.
    Chain,
    /// Anything else: tiles with more bonds, or a cycle around a point of tiles that could have more.
    Sheet,
    /// What is to be built.
    Target,
}

impl StructureShape {
    /// Its name in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ring => "ring",
            Self::Chain => "chain",
            Self::Sheet => "sheet",
            Self::Target => "target",
        }
    }
}

/// Tiles connected by bonds.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Structure {
    /// Its kind.
    pub shape: StructureShape,
    /// Its tiles, ascending.
    pub tiles: Vec<usize>,
    /// Its bonds.
    pub bonds: usize,
    /// Its bonds if every two tiles that would bind in their exact places did.
    pub possible: usize,
    /// Holes that its tiles enclose.
    pub holes: usize,
    /// Columns and rows of a full rectangle of squares, the larger number first.
    pub rectangle: Option<[usize; 2]>,
}

/// All structures of two tiles or more, in the order of their first tiles; those that are the
/// crowd's goal are listed once more as [`StructureShape::Target`].
pub fn structures(crowd: &Crowd, movers: &[Mover], held: &[Held]) -> Vec<Structure> {
    let bonds: Vec<Held> = held
        .iter()
        .filter(|it| it.tie == Tie::Bond)
        .copied()
        .collect();
    let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (tile, first) in cluster_of_each(movers.len(), &bonds)
        .into_iter()
        .enumerate()
    {
        members.entry(first).or_default().push(tile);
    }
    let joined = members.into_values().filter(|tiles| tiles.len() > 1);
    let mut all = Vec::new();
    for tiles in joined {
        let part = Part::new(crowd, movers, tiles, &bonds);
        let found = part.structure();
        if let Some(goal) = crowd.goal.as_ref().filter(|goal| part.is(goal, &found)) {
            debug_assert_eq!(goal.tiles(), found.tiles.len());
            all.push(Structure {
                shape: StructureShape::Target,
                ..found.clone()
            });
        }
        all.push(found);
    }
    all
}

/// Whether bonds join all of these tiles, given by kind and place.
pub fn are_joined(crowd: &Crowd, tiles: &[(usize, Configuration)]) -> bool {
    let places: Vec<Vector2<f64>> = tiles.iter().map(|it| it.1.position()).collect();
    let radius = |it: &(usize, Configuration)| crowd.kinds[it.0].tile.outline.circumradius();
    let range = 2.0 * tiles.iter().map(radius).fold(0.0, f64::max);
    let mut near = Neighbours::default();
    let mut joined = UnionFind::<usize>::new(tiles.len());
    for &[a, b] in near.within(2.0 * range, &places) {
        if bond(crowd, [tiles[a], tiles[b]]).is_some() {
            joined.union(a, b);
        }
    }
    (1..tiles.len()).all(|k| joined.equiv(0, k))
}

/// The exact pose of the second tile in the frame of the first, if they are bound in these places.
fn bond(crowd: &Crowd, tiles: [(usize, Configuration); 2]) -> Option<Configuration> {
    let two = Two::of(tiles.map(|it| it.0), [0, 1]);
    let couple = crowd.couple(tiles[0].0, tiles[1].0).0;
    let [first, second] = [two.first, two.second].map(|k| tiles[k].1);
    let q = first.inverse().compose(&second);
    if q.position().norm() > couple.radii() + couple.near {
        return None;
    }
    let pose = couple.bonds.iter().find_map(|rule| rule.pose_of(&q))?;
    Some(match two.first {
        0 => pose,
        _ => pose.inverse(),
    })
}

/// Connected tiles in their exact places.
struct Part<'a> {
    crowd: &'a Crowd,
    movers: &'a [Mover],
    tiles: Vec<usize>,
    /// The bonds, as indices into `tiles`.
    bonds: BTreeSet<[usize; 2]>,
    /// The place of each tile.
    places: Vec<Configuration>,
}

impl<'a> Part<'a> {
    fn new(crowd: &'a Crowd, movers: &'a [Mover], tiles: Vec<usize>, bonds: &[Held]) -> Self {
        let number: BTreeMap<usize, usize> = tiles
            .iter()
            .enumerate()
            .map(|(k, tile)| (*tile, k))
            .collect();
        let own = bonds.iter().filter_map(|held| {
            let [a, b] = held.tiles.map(|tile| number.get(&tile).copied());
            Some([a?, b?])
        });
        let bonds: BTreeSet<[usize; 2]> = own.collect();
        let mut part = Self {
            crowd,
            movers,
            places: tiles
                .iter()
                .map(|&tile| movers[tile].motion(crowd).configuration)
                .collect(),
            tiles,
            bonds,
        };
        part.places = part.exact();
        part
    }

    fn kind(&self, k: usize) -> usize {
        self.movers[self.tiles[k]].kind
    }

    fn placed(&self, k: usize) -> (usize, Configuration) {
        (self.kind(k), self.places[k])
    }

    /// The places that follow from the first tile's along a tree of bonds.
    fn exact(&self) -> Vec<Configuration> {
        let mut next: Vec<Vec<usize>> = vec![Vec::new(); self.tiles.len()];
        for [a, b] in &self.bonds {
            next[*a].push(*b);
            next[*b].push(*a);
        }
        let mut exact = vec![None; self.tiles.len()];
        exact[0] = Some(self.places[0]);
        let mut open = VecDeque::from([0]);
        while let Some(here) = open.pop_front() {
            let at = exact[here].unwrap_or(self.places[here]);
            for &there in &next[here] {
                if exact[there].is_some() {
                    continue;
                }
                let bond = bond(self.crowd, [here, there].map(|k| self.placed(k)));
                exact[there] = Some(bond.map_or(self.places[there], |pose| at.compose(&pose)));
                open.push_back(there);
            }
        }
        let found = exact.into_iter().zip(&self.places);
        found
            .map(|(exact, place)| exact.unwrap_or(*place))
            .collect()
    }

    fn structure(&self) -> Structure {
        let mut degrees = vec![0; self.tiles.len()];
        for end in self.bonds.iter().flatten() {
            degrees[*end] += 1;
        }
        let count = self.tiles.len();
        let mut possible = self.bonds.clone();
        for b in 0..count {
            for a in 0..b {
                if bond(self.crowd, [a, b].map(|k| self.placed(k))).is_some() {
                    possible.insert([a, b]);
                }
            }
        }
        let holes = self.holes();
        let ends = degrees.iter().filter(|degree| **degree == 1).count();
        let is_row = degrees.iter().all(|degree| *degree <= 2);
        // Tiles that can have two bonds at most close to rings, also around a point.
        let two_at_most = || (0..count).all(|k| self.crowd.binding_faces(self.kind(k)) <= 2);
        let shape = match (is_row, ends) {
            (true, 2) => StructureShape::Chain,
            (true, 0) if holes > 0 || two_at_most() => StructureShape::Ring,
            _ => StructureShape::Sheet,
        };
        Structure {
            shape,
            tiles: self.tiles.clone(),
            bonds: self.bonds.len(),
            possible: possible.len(),
            holes,
            rectangle: self.rectangle(),
        }
    }

    /// The number of holes: by Euler's formula, one less the corners, plus the sides, less the tiles,
    /// where touching tiles share corners and sides.
    fn holes(&self) -> usize {
        let radius = self.radius();
        let faces = |k: usize| self.crowd.kinds[self.kind(k)].tile.faces.iter();
        let lengths = (0..self.tiles.len()).flat_map(|k| faces(k).map(Face::length));
        let shortest = lengths.fold(f64::INFINITY, f64::min);
        let mut points = Points::new((SAME_CORNER * radius).min(0.2 * shortest));
        let mut sides: BTreeSet<[usize; 2]> = BTreeSet::new();
        for (k, place) in self.places.iter().enumerate() {
            for face in faces(k) {
                let [a, b] = [face.start, face.end].map(|end| points.number(place.transform(end)));
                sides.insert([a.min(b), a.max(b)]);
            }
        }
        (1 + sides.len()).saturating_sub(points.count + self.tiles.len())
    }

    fn radius(&self) -> f64 {
        let radius = |k: usize| self.crowd.kinds[self.kind(k)].tile.outline.circumradius();
        (0..self.tiles.len())
            .map(radius)
            .fold(f64::INFINITY, f64::min)
    }

    /// See [`Structure::rectangle`].
    fn rectangle(&self) -> Option<[usize; 2]> {
        let is_square = |k: usize| self.crowd.kinds[self.kind(k)].tile.faces.len() == 4;
        if !(0..self.tiles.len()).all(is_square) {
            return None;
        }
        let back = self.places[0].inverse();
        let within = SAME_CORNER * self.radius();
        let distinct = |axis: usize| {
            let mut values: Vec<f64> = self
                .places
                .iter()
                .map(|place| back.compose(place).to_array()[axis])
                .collect();
            values.sort_by(f64::total_cmp);
            values.dedup_by(|a, b| (*a - *b).abs() <= within);
            values.len()
        };
        let [a, b] = [distinct(0), distinct(1)];
        (a * b == self.tiles.len()).then_some([a.max(b), a.min(b)])
    }

    /// Whether this is the goal.
    fn is(&self, goal: &Goal, found: &Structure) -> bool {
        match goal {
            Goal::Ring(count) => found.shape == StructureShape::Ring && found.tiles.len() == *count,
            Goal::Chain(count) => {
                found.shape == StructureShape::Chain && found.tiles.len() == *count
            }
            Goal::Sheet(rows, columns) => {
                found.rectangle == Some([*rows.max(columns), *rows.min(columns)])
                    && found.bonds == found.possible
            }
            Goal::Pattern(pattern) => self.matches(pattern),
        }
    }

    /// Whether the tiles lie as in a pattern, up to a motion of all of them and turns of tiles onto
    /// themselves.
    fn matches(&self, pattern: &[(usize, Configuration)]) -> bool {
        let count = self.tiles.len();
        if count != pattern.len() {
            return false;
        }
        let turns: BTreeMap<usize, Vec<f64>> = (0..count)
            .map(|k| self.kind(k))
            .collect::<BTreeSet<_>>()
            .into_iter()
            .map(|kind| (kind, rotations(&self.crowd.kinds[kind].tile)))
            .collect();
        let Some(((kind, first), of_kind)) = pattern
            .first()
            .and_then(|first| Some((*first, turns.get(&first.0)?)))
        else {
            return false;
        };
        let within = IN_PLACE * self.radius();
        let is_taken = |wanted: &Configuration, kind: usize, k: usize| {
            let place = &self.places[k];
            self.kind(k) == kind
                && (place.position() - wanted.position()).norm() <= within
                && turns[&kind]
                    .iter()
                    .any(|turn| wrap_angle(place.theta - wanted.theta - turn).abs() <= TURNED)
        };
        let fits = |motion: &Configuration| {
            pattern.iter().all(|(kind, place)| {
                let wanted = motion.compose(place);
                turns.contains_key(kind) && (0..count).any(|k| is_taken(&wanted, *kind, k))
            })
        };
        let back = first.inverse();
        let candidates = (0..count).filter(|k| self.kind(*k) == kind);
        candidates
            .flat_map(|k| of_kind.iter().map(move |turn| (k, *turn)))
            .any(|(k, turn)| {
                let turned = self.places[k].compose(&Configuration::new(0.0, 0.0, turn));
                fits(&turned.compose(&back))
            })
    }
}

/// Points, numbered; near ones have the same number.
struct Points {
    within: f64,
    known: BTreeMap<[i64; 2], Vec<(Vector2<f64>, usize)>>,
    count: usize,
}

impl Points {
    fn new(within: f64) -> Self {
        Self {
            within,
            known: BTreeMap::new(),
            count: 0,
        }
    }

    fn number(&mut self, point: Vector2<f64>) -> usize {
        let [x, y] = [point.x, point.y].map(|it| (it / self.within).floor() as i64);
        for i in -1..=1 {
            for j in -1..=1 {
                let here = self.known.get(&[x + i, y + j]).into_iter().flatten();
                let near = |it: &&(Vector2<f64>, usize)| (it.0 - point).norm() <= self.within;
                if let Some((_, number)) = here.into_iter().find(near) {
                    return *number;
                }
            }
        }
        self.known
            .entry([x, y])
            .or_default()
            .push((point, self.count));
        self.count += 1;
        self.count - 1
    }
}
