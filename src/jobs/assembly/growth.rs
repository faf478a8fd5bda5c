//! What a tile set grows into without errors: the abstract model (aTAM).
//!
//! A tile stays where its bonds sum to tau at least, and never leaves. Places are filled in the
//! order in which they become neighbours of tiles, so that what grows is round.

use std::collections::{BTreeMap, VecDeque};

use super::{Axis, TileSet};

/// A place: to the east and to the north of the seed.
pub type Place = (i32, i32);

/// What has grown.
#[derive(Clone, Debug, PartialEq)]
pub struct Grown {
    /// Tiles by place.
    pub tiles: BTreeMap<Place, usize>,
    /// The places in the order in which they were filled.
    pub order: Vec<Place>,
    /// Whether nothing more can be added.
    pub complete: bool,
    /// Places where more than one tile would have stayed; the first of the set was taken.
    pub choices: usize,
}

/// The neighbour's offset on each side.
pub const STEPS: [Place; 4] = [(0, 1), (1, 0), (0, -1), (-1, 0)];

/// The strength with which a tile's side holds its neighbour there, by tile, side and neighbour.
pub struct Holds {
    strengths: Vec<Vec<f64>>,
    glues: Vec<[Option<usize>; 4]>,
}

impl Holds {
    /// Of a set.
    pub fn new(set: &TileSet) -> Self {
        Self {
            strengths: set.strengths(),
            glues: set.tiles.iter().map(|tile| tile.glues).collect(),
        }
    }

    /// Of a tile and its neighbour on a side.
    pub fn between(&self, tile: usize, side: usize, neighbour: usize) -> f64 {
        let (own, other) = (
            self.glues[tile][side],
            self.glues[neighbour][(side + 2) % 4],
        );
        own.zip(other).map_or(0.0, |(a, b)| self.strengths[a][b])
    }

    /// The sum over the neighbours of a place.
    pub fn at(&self, tiles: &BTreeMap<Place, usize>, place: Place, tile: usize) -> f64 {
        let near = neighbours(place).map(|(side, there)| {
            tiles
                .get(&there)
                .map_or(0.0, |near| self.between(tile, side, *near))
        });
        near.sum()
    }
}

/// The sides of a place and the places there.
pub fn neighbours(place: Place) -> impl Iterator<Item = (usize, Place)> {
    let there = move |(dx, dy): Place| (place.0 + dx, place.1 + dy);
    STEPS.into_iter().map(there).enumerate()
}

/// Grows up to `most` tiles from the seed, or from the set's first tile.
pub fn grow(set: &TileSet, most: usize) -> Grown {
    let mut tiles: BTreeMap<Place, usize> = BTreeMap::new();
    let first = set
        .seed
        .first()
        .map_or((0, 0), |(row, column, _)| (*row, *column));
    for (row, column, tile) in &set.seed {
        let at = (
            *column as i32 - first.1 as i32,
            first.0 as i32 - *row as i32,
        );
        tiles.insert(at, *tile);
    }
    if tiles.is_empty() && !set.tiles.is_empty() {
        tiles.insert((0, 0), 0);
    }
    let holds = Holds::new(set);
    let tau = set.tau() - 1e-9;
    let mut choices = 0;
    let mut order: Vec<Place> = tiles.keys().copied().collect();
    let mut open: VecDeque<Place> = tiles.keys().copied().collect();
    let around: Vec<Place> = open
        .iter()
        .flat_map(|it| neighbours(*it).map(|it| it.1))
        .collect();
    open = around.into();
    while let Some(place) = open.pop_front() {
        if tiles.contains_key(&place) {
            continue;
        }
        let mut fitting = (0..set.tiles.len())
            .filter(|tile| set.tiles[*tile].stoic > 0.0 && holds.at(&tiles, place, *tile) >= tau);
        let Some(tile) = fitting.next() else { continue };
        choices += usize::from(fitting.next().is_some());
        if tiles.len() >= most {
            return Grown {
                tiles,
                order,
                complete: false,
                choices,
            };
        }
        tiles.insert(place, tile);
        order.push(place);
        open.extend(neighbours(place).map(|it| it.1));
    }
    Grown {
        tiles,
        order,
        complete: true,
        choices,
    }
}

/// Two tiles that meet in an assembly: along an axis the first lies west or south of the second.
pub type Met = (usize, Axis, usize);

impl Grown {
    /// How many there are of each tile of a set of so many.
    pub fn counts(&self, tiles: usize) -> Vec<usize> {
        let mut counts = vec![0; tiles];
        self.tiles.values().for_each(|tile| counts[*tile] += 1);
        counts
    }

    /// The tiles that meet, with how often.
    pub fn meetings(&self) -> BTreeMap<Met, usize> {
        let mut met = BTreeMap::new();
        for ((x, y), tile) in &self.tiles {
            for (axis, there) in [
                (Axis::Horizontal, (x + 1, *y)),
                (Axis::Vertical, (*x, y + 1)),
            ] {
                if let Some(other) = self.tiles.get(&there) {
                    *met.entry((*tile, axis, *other)).or_default() += 1;
                }
            }
        }
        met
    }

    /// The least and largest place.
    pub fn extent(&self) -> [Place; 2] {
        let fold = |start: i32, pick: fn(i32, i32) -> i32, axis: fn(&Place) -> i32| {
            self.tiles.keys().map(axis).fold(start, pick)
        };
        let of = |start, pick| (fold(start, pick, |p| p.0), fold(start, pick, |p| p.1));
        [of(0, i32::min), of(0, i32::max)]
    }
}
