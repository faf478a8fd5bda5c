//! Growth without errors: the abstract tile assembly model (aTAM).
//!
//! A tile attaches where the strengths of its bonds sum to at least tau, and never leaves. Places
//! are filled in the order in which they become neighbours of tiles, so that the assembly grows
//! evenly in all directions.

use std::collections::{BTreeMap, VecDeque};

use super::TileSet;
use super::axis::{MeetingAxis, Met};

/// A place: steps to the east and to the north of the seed.
pub type Site = (i32, i32);

/// A grown assembly.
#[derive(Clone, Debug, PartialEq)]
pub struct Grown {
    /// Tiles by place.
    pub tiles: BTreeMap<Site, usize>,
    /// The places in the order in which they were filled.
    pub order: Vec<Site>,
    /// Whether nothing more can be added.
    pub complete: bool,
    /// The number of places where more than one tile could have attached; the first of the set was
    /// taken.
    pub choices: usize,
    /// The number of tiles of the seed.
    pub seeds: usize,
}

/// The neighbour's offset on each side.
pub const STEPS: [Site; 4] = [(0, 1), (1, 0), (0, -1), (-1, 0)];

/// The strength with which a tile binds its neighbour, by tile, side and neighbour.
pub struct Holds {
    strengths: Vec<Vec<f64>>,
    glues: Vec<[Option<usize>; 4]>,
}

impl Holds {
    /// The strengths of a set.
    pub fn new(set: &TileSet) -> Self {
        Self {
            strengths: set.strengths(),
            glues: set.tiles.iter().map(|tile| tile.glues).collect(),
        }
    }

    /// The strength between a tile and its neighbour on a side.
    pub fn between(&self, tile: usize, side: usize, neighbour: usize) -> f64 {
        let glues = self.glues[tile][side].zip(self.glues[neighbour][(side + 2) % 4]);
        glues.map_or(0.0, |(a, b)| self.strengths[a][b])
    }

    /// The sum of the strengths over the neighbours of a place.
    pub fn at(&self, tiles: &BTreeMap<Site, usize>, place: Site, tile: usize) -> f64 {
        let hold = |(side, there)| Some(self.between(tile, side, *tiles.get(&there)?));
        neighbours(place)
            .map(|near| hold(near).unwrap_or(0.0))
            .sum()
    }
}

/// The sides of a place and the places there.
pub fn neighbours(place: Site) -> impl Iterator<Item = (usize, Site)> {
    let there = move |(dx, dy): Site| (place.0 + dx, place.1 + dy);
    STEPS.into_iter().map(there).enumerate()
}

/// Grows up to `most` tiles from the seed, or from the set's first tile.
pub fn grow(set: &TileSet, most: usize) -> Grown {
    let mut tiles: BTreeMap<Site, usize> = BTreeMap::new();
    for (row, column, tile) in &set.seed {
        let (first_row, first_column, _) = set.seed[0];
        let east = *column as i32 - first_column as i32;
        tiles.insert((east, first_row as i32 - *row as i32), *tile);
    }
    if tiles.is_empty() && !set.tiles.is_empty() {
        tiles.insert((0, 0), 0);
    }
    let holds = Holds::new(set);
    let tau = set.tau() - 1e-9;
    let order: Vec<Site> = tiles.keys().copied().collect();
    let around = order.iter().flat_map(|it| neighbours(*it).map(|it| it.1));
    let mut open: VecDeque<Site> = around.collect();
    let mut grown = Grown {
        seeds: tiles.len(),
        tiles,
        order,
        complete: true,
        choices: 0,
    };
    while let Some(place) = open.pop_front() {
        if grown.tiles.contains_key(&place) {
            continue;
        }
        let fits = |tile: &usize| {
            set.tiles[*tile].stoic > 0.0 && holds.at(&grown.tiles, place, *tile) >= tau
        };
        let mut fitting = (0..set.tiles.len()).filter(fits);
        let Some(tile) = fitting.next() else { continue };
        let is_choice = fitting.next().is_some();
        grown.choices += usize::from(is_choice);
        if grown.tiles.len() >= most {
            grown.complete = false;
            break;
        }
        grown.tiles.insert(place, tile);
        grown.order.push(place);
        open.extend(neighbours(place).map(|it| it.1));
    }
    grown
}

impl Grown {
    /// Whether no tile attached to the seed.
    pub fn is_stuck(&self) -> bool {
        self.tiles.len() == self.seeds
    }

    /// The count of each tile, for a set with the given number of tiles.
    pub fn counts(&self, tiles: usize) -> Vec<usize> {
        let mut counts = vec![0; tiles];
        self.tiles.values().for_each(|tile| counts[*tile] += 1);
        counts
    }

    /// The tiles that meet, with how often.
    pub fn meetings(&self) -> BTreeMap<Met, usize> {
        let mut met = BTreeMap::new();
        for (place, tile) in &self.tiles {
            for axis in MeetingAxis::ALL {
                let there = neighbours(*place).nth(axis.sides()[0]);
                if let Some(other) = there.and_then(|(_, there)| self.tiles.get(&there)) {
                    *met.entry((*tile, axis, *other)).or_default() += 1;
                }
            }
        }
        met
    }

    /// The corners of the bounding box.
    pub fn extent(&self) -> [Site; 2] {
        // The first one lies at the origin.
        let ends = |pick: fn(i32, i32) -> i32| {
            let both = |a: Site, b: &Site| (pick(a.0, b.0), pick(a.1, b.1));
            self.tiles.keys().fold((0, 0), both)
        };
        [ends(i32::min), ends(i32::max)]
    }
}
