//! The leaves of a subdivision of the configuration space, and which of them are adjacent.
//!
//! Leaves are adjacent if they meet in a face: those that meet only in an edge or a corner need not
//! be. A path that stays at or below an energy E has, at each of its points, only leaves with lower
//! bounds of at most E around it, as each of them contains the point; and all leaves around a point
//! are joined through faces that contain it, because a ball about it without the edges and corners
//! is connected.

use std::f64::consts::PI;
use std::ops::Range;

use super::adjacency::Adjacency;
use tiles::assessment::Assessment;
use tiles::cell::Cell;
use tiles::configuration::{Configuration, ConfigurationSpace};
use tiles::parallel;

/// Every coordinate is divided into this many units, the smallest size a cell can have.
const UNITS: u32 = 1 << 30;

/// Cells along x, y and theta at the start.
const FIRST: [u32; 3] = [8, 8, 16];

/// Where a cell lies: its lower corner and its size, in units of each coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    low: [u32; 3],
    size: [u32; 3],
}

impl Key {
    /// The two halves along a coordinate; `None` if the cell cannot be halved.
    pub fn halves(&self, axis: usize) -> Option<[Self; 2]> {
        if self.size[axis] < 2 {
            return None;
        }
        let mut lower = *self;
        lower.size[axis] /= 2;
        let mut upper = lower;
        upper.low[axis] += lower.size[axis];
        Some([lower, upper])
    }

    /// In cubes of units.
    pub fn volume(&self) -> f64 {
        self.size.map(f64::from).iter().product()
    }

    /// Whether the cell may hold what lies at a [place](Store::place).
    pub fn may_hold(&self, place: &[f64; 3]) -> bool {
        let holds = |i: usize, at: f64| {
            f64::from(self.low[i]) <= at + 1.0 && at - 1.0 <= f64::from(self.low[i] + self.size[i])
        };
        let turn = f64::from(UNITS);
        let turns = [place[2], place[2] - turn, place[2] + turn];
        holds(0, place[0]) && holds(1, place[1]) && turns.iter().any(|&at| holds(2, at))
    }

    /// Whether two cells of a subdivision meet in a face, or a part of one. The angle is periodic.
    fn meets(&self, other: &Self) -> bool {
        let end = |key: &Self, i: usize| key.low[i] + key.size[i];
        let overlap = |i: usize| self.low[i] < end(other, i) && other.low[i] < end(self, i);
        let abut = |i: usize| {
            let around = |a: &Self, b: &Self| i == 2 && a.low[2] == 0 && end(b, 2) == UNITS;
            self.low[i] == end(other, i)
                || other.low[i] == end(self, i)
                || around(self, other)
                || around(other, self)
        };
        (0..3).filter(|&i| overlap(i)).count() == 2 && (0..3).all(|i| overlap(i) || abut(i))
    }
}

/// A cell of the subdivision, and what is known of it.
pub(super) type CellEntry = (Key, Assessment);

/// A cell of the subdivision that is neither subdivided nor blocked.
#[derive(Clone, Debug)]
pub(super) struct Leaf {
    pub key: Key,
    pub known: Assessment,
    /// Whether it still is a leaf.
    pub live: bool,
    /// The leaf that it is a part of; itself for a first cell.
    pub whole: u32,
    /// If it is none any more, its parts that are not blocked.
    parts: Range<u32>,
}

/// The leaves. All other parts of the table's configuration space are blocked.
#[derive(Clone, Debug)]
pub(super) struct Store {
    half_size: [f64; 2],
    /// Number of first cells, the first of the leaves, sorted by x.
    firsts: usize,
    leaves: Vec<Leaf>,
    // The data that floods use most are stored side by side.
    neighbours: Adjacency,
    pub lowers: Vec<f64>,
    /// The rank of each leaf in a flood by energy (J),
    pub estimates: Vec<f64>,
    /// and in one by overlap.
    pub by_overlap: Vec<f64>,
}

impl Store {
    pub fn new(space: &ConfigurationSpace) -> Self {
        Self {
            half_size: space.half_size,
            firsts: 0,
            leaves: Vec::new(),
            neighbours: Adjacency::default(),
            lowers: Vec::new(),
            estimates: Vec::new(),
            by_overlap: Vec::new(),
        }
    }

    /// The cells to begin with.
    pub fn first_keys() -> Vec<Key> {
        let size = FIRST.map(|n| UNITS / n);
        let mut keys = Vec::new();
        for i in 0..FIRST[0] {
            for j in 0..FIRST[1] {
                for k in 0..FIRST[2] {
                    keys.push(Key {
                        low: [i * size[0], j * size[1], k * size[2]],
                        size,
                    });
                }
            }
        }
        keys
    }

    /// The box of a key. Cells with a common face compute it from the same units, and every box is
    /// widened by more than its rounding, so that the boxes cover the table without gaps.
    pub fn cell(&self, key: &Key) -> Cell {
        let scale = [self.half_size[0], self.half_size[1], PI];
        let at =
            |i: usize, units: u32| scale[i] * (f64::from(units) * (2.0 / f64::from(UNITS)) - 1.0);
        let ends: [[f64; 2]; 3] =
            std::array::from_fn(|i| [at(i, key.low[i]), at(i, key.low[i] + key.size[i])]);
        let middle = ends.map(|[a, b]| (a + b) / 2.0);
        Cell {
            centre: Configuration::new(middle[0], middle[1], middle[2]),
            half: std::array::from_fn(|i| {
                (ends[i][1] - ends[i][0]) / 2.0 + 4.0 * f64::EPSILON * scale[i]
            }),
        }
    }

    /// A configuration in units of each coordinate, accurate to less than one unit.
    pub fn place(&self, q: &Configuration) -> [f64; 3] {
        let [x, y] = self.half_size;
        [q.x / x, q.y / y, q.theta / PI].map(|share| (share + 1.0) * f64::from(UNITS / 2))
    }

    pub fn leaf(&self, id: u32) -> &Leaf {
        &self.leaves[id as usize]
    }

    /// The leaves that meet a leaf in a face.
    pub fn neighbours(&self, id: u32) -> &[u32] {
        self.neighbours.of(id)
    }

    /// A leaf's lower bound of the energy (J).
    pub fn lower(&self, id: u32) -> f64 {
        self.lowers[id as usize]
    }

    /// Number of leaves, including former ones.
    pub fn len(&self) -> usize {
        self.leaves.len()
    }

    #[cfg(test)]
    pub fn live(&self) -> impl Iterator<Item = (u32, &Leaf)> {
        (0..).zip(&self.leaves).filter(|(_, leaf)| leaf.live)
    }

    /// Adds the first cells.
    pub fn fill(&mut self, cells: &[CellEntry]) {
        let all = self.push(None, cells);
        self.firsts = cells.len();
        let adjacent = |id| self.adjacent(id as u32, all.clone());
        for neighbours in parallel::map(0..cells.len(), adjacent) {
            self.neighbours.push(&neighbours);
        }
    }

    /// Replaces leaves by their parts that are not blocked.
    pub fn replace(&mut self, wholes: &[(u32, Vec<CellEntry>)]) {
        let first = self.leaves.len();
        let mut around = Vec::new();
        for (id, parts) in wholes {
            let parts = self.push(Some(*id), parts);
            let whole = &mut self.leaves[*id as usize];
            (whole.live, whole.parts) = (false, parts);
            around.extend(self.neighbours(*id));
        }
        around.sort_unstable();
        around.dedup();
        around.retain(|&id| self.leaf(id).live);
        let of_those_around = parallel::map(&around, |&id| {
            self.adjacent(id, self.neighbours(id).iter().copied())
        });
        let of_parts = parallel::map(first..self.leaves.len(), |id| {
            let whole = self.leaves[id].whole;
            let around = self.neighbours(whole).iter().copied();
            self.adjacent(id as u32, around.chain([whole]))
        });
        for (id, neighbours) in around.into_iter().zip(of_those_around) {
            self.neighbours.replace(id, &neighbours);
        }
        for neighbours in of_parts {
            self.neighbours.push(&neighbours);
        }
        for (id, _) in wholes {
            self.neighbours.replace(*id, &[]);
        }
        self.neighbours.compact();
    }

    /// The leaves that hold a configuration, ascending.
    pub fn holding(&self, q: &Configuration) -> Vec<u32> {
        let place = self.place(q);
        let firsts = &self.leaves[..self.firsts];
        let is_left = |leaf: &Leaf| f64::from(leaf.key.low[0] + leaf.key.size[0]) < place[0] - 1.0;
        let is_near = |leaf: &Leaf| f64::from(leaf.key.low[0]) <= place[0] + 1.0;
        let [start, end] = [
            firsts.partition_point(is_left),
            firsts.partition_point(is_near),
        ];
        self.still_holding((start as u32..end as u32).collect(), q)
    }

    /// The leaves that hold a configuration, ascending, found from former ones.
    pub fn still_holding(&self, mut open: Vec<u32>, q: &Configuration) -> Vec<u32> {
        let place = self.place(q);
        let mut held = Vec::new();
        while let Some(id) = open.pop() {
            let leaf = self.leaf(id);
            if !leaf.key.may_hold(&place) {
                continue;
            }
            open.extend(leaf.parts.clone());
            if leaf.live && self.cell(&leaf.key).contains(q) {
                held.push(id);
            }
        }
        held.sort_unstable();
        held
    }

    /// Adds leaves, cut from the leaf `whole`, without their neighbours; returns their numbers.
    fn push(&mut self, whole: Option<u32>, parts: &[CellEntry]) -> Range<u32> {
        let first = self.leaves.len() as u32;
        for (id, &(key, known)) in (first..).zip(parts) {
            self.lowers.push(known.lower);
            self.estimates.push(known.estimate);
            self.by_overlap.push(known.overlap);
            self.leaves.push(Leaf {
                key,
                known,
                live: true,
                whole: whole.unwrap_or(id),
                parts: 0..0,
            });
        }
        first..self.leaves.len() as u32
    }

    /// The leaves that meet a leaf in a face, among these or, where they are none any more, their
    /// parts.
    fn adjacent(&self, id: u32, among: impl Iterator<Item = u32>) -> Vec<u32> {
        let key = &self.leaf(id).key;
        let now = |n: u32| {
            let leaf = self.leaf(n);
            if leaf.live {
                n..n + 1
            } else {
                leaf.parts.clone()
            }
        };
        among
            .flat_map(now)
            .filter(|&n| n != id && self.leaf(n).key.meets(key))
            .collect()
    }

    /// The midpoint of the intersection of two adjacent leaves.
    pub fn between(&self, a: u32, b: u32) -> Configuration {
        let (a, b) = (self.cell(&self.leaf(a).key), self.cell(&self.leaf(b).key));
        let step = a.centre.step_to(&b.centre);
        // In the frame of a: the interval [-a, a] and the one about `step`.
        let middle = |i: usize| {
            let low = (-a.half[i]).max(step[i] - b.half[i]);
            let high = a.half[i].min(step[i] + b.half[i]);
            (low + high) / 2.0
        };
        a.centre.moved([middle(0), middle(1), middle(2)].into())
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    pub const KNOWN: Assessment = Assessment {
        lower: 0.0,
        estimate: 0.0,
        overlap: 0.0,
        axis: 0,
    };

    /// The first cells of a table, not yet assessed.
    pub fn first_cells() -> Store {
        let space = ConfigurationSpace {
            half_size: [1.0, 0.7],
            rho: 0.2,
            free_distance: 0.9,
        };
        let mut store = Store::new(&space);
        let keys = Store::first_keys().into_iter();
        store.fill(&keys.map(|key| (key, KNOWN)).collect::<Vec<_>>());
        store
    }

    #[test]
    fn neighbours_are_the_leaves_that_share_a_face_and_the_tree_leads_to_those_that_hold_a_place() {
        let mut store = first_cells();
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        for _ in 0..60 {
            // Some beside each other.
            let mut ids: Vec<u32> = store.live().map(|(id, _)| id).collect();
            let first = rng.random_range(0..ids.len() - 4);
            ids = ids[first..first + 4].to_vec();
            ids.extend(store.neighbours(ids[0]));
            ids.sort_unstable();
            ids.dedup();
            let wholes = ids.iter().map(|&id| {
                let mut parts = vec![store.leaf(id).key];
                for axis in 0..3 {
                    parts = parts.iter().flat_map(|k| k.halves(axis).unwrap()).collect();
                }
                parts.remove(rng.random_range(0..8));
                (id, parts.into_iter().map(|key| (key, KNOWN)).collect())
            });
            let wholes: Vec<_> = wholes.collect();
            store.replace(&wholes[..wholes.len().min(6)]);
        }
        let live: Vec<u32> = store.live().map(|(id, _)| id).collect();
        for &a in live.iter().step_by(7) {
            let mut listed = store.neighbours(a).to_vec();
            listed.sort_unstable();
            // Judged from the boxes alone.
            let box_a = store.cell(&store.leaf(a).key);
            let adjacent: Vec<u32> = live
                .iter()
                .copied()
                .filter(|&b| {
                    let box_b = store.cell(&store.leaf(b).key);
                    let step = box_a.centre.step_to(&box_b.centre);
                    let apart: [f64; 3] =
                        std::array::from_fn(|i| step[i].abs() - box_a.half[i] - box_b.half[i]);
                    b != a
                        && apart.iter().all(|apart| *apart < 1e-12)
                        && apart.iter().filter(|apart| **apart < -1e-12).count() == 2
                })
                .collect();
            assert_eq!(listed, adjacent);
        }
        for _ in 0..200 {
            let [x, y] = [1.0, 0.7].map(|half: f64| rng.random_range(-half..half));
            let q = Configuration::new(x, y, rng.random_range(-PI..PI));
            let holds = |id: &u32| store.cell(&store.leaf(*id).key).contains(&q);
            let held: Vec<u32> = live.iter().copied().filter(holds).collect();
            assert_eq!(store.holding(&q), held);
        }
    }

    /// Paths that lead exactly along edges and through corners of leaves as well.
    #[test]
    fn leaves_around_the_points_of_a_path_are_joined_through_faces() {
        let mut store = first_cells();
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        for _ in 0..400 {
            let live: Vec<u32> = store.live().map(|(id, _)| id).collect();
            let id = live[rng.random_range(0..live.len())];
            let halves = store.leaf(id).key.halves(rng.random_range(0..3)).unwrap();
            store.replace(&[(id, halves.map(|key| (key, KNOWN)).to_vec())]);
        }
        let live: Vec<(u32, Key)> = store.live().map(|(id, leaf)| (id, leaf.key)).collect();
        let corner = |rng: &mut ChaCha8Rng| {
            let (_, key) = live[rng.random_range(0..live.len())];
            key.low
        };
        for _ in 0..100 {
            let ends = [corner(&mut rng), corner(&mut rng)];
            let holds = |key: &Key, at: [f64; 3]| {
                let within = |i: usize, at: f64| {
                    f64::from(key.low[i]) <= at && at <= f64::from(key.low[i] + key.size[i])
                };
                let turns = [at[2], at[2] - f64::from(UNITS), at[2] + f64::from(UNITS)];
                within(0, at[0]) && within(1, at[1]) && turns.iter().any(|&at| within(2, at))
            };
            let mut met: Vec<u32> = Vec::new();
            // From corner to corner along the axes, in steps that meet every leaf on the way.
            let mut at = ends[0].map(f64::from);
            for axis in 0..3 {
                let [from, to] = ends.map(|end| f64::from(end[axis]));
                for step in 0..=4096 {
                    at[axis] = from + (to - from) * f64::from(step) / 4096.0;
                    met.extend(
                        live.iter()
                            .filter(|(_, key)| holds(key, at))
                            .map(|leaf| leaf.0),
                    );
                }
            }
            met.sort_unstable();
            met.dedup();
            let mut open = vec![met[0]];
            let mut joined = open.clone();
            while let Some(id) = open.pop() {
                for &n in store.neighbours(id) {
                    if met.contains(&n) && !joined.contains(&n) {
                        joined.push(n);
                        open.push(n);
                    }
                }
            }
            joined.sort_unstable();
            assert_eq!(joined, met);
        }
    }

    #[test]
    fn a_cell_is_halved_down_to_units_and_holds_what_its_halves_do() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        for axis in 0..3 {
            let mut key = Key {
                low: [64, 128, 0],
                size: [16, 32, 64],
            };
            while let Some(halves) = key.halves(axis) {
                for _ in 0..50 {
                    let place = [90.0, 200.0, 80.0].map(|most| rng.random_range(0.0..most));
                    let held = halves.iter().any(|half| half.may_hold(&place));
                    assert_eq!(key.may_hold(&place), held, "{key:?} {place:?}");
                }
                key = halves[rng.random_range(0..2)];
            }
            assert_eq!(key.size[axis], 1);
        }
        // Within a unit of its sides, and round the circle.
        let key = Key {
            low: [64, 128, 0],
            size: [16, 32, 64],
        };
        assert!(key.may_hold(&[63.5, 160.5, 30.0]) && !key.may_hold(&[62.5, 150.0, 30.0]));
        assert!(key.may_hold(&[70.0, 150.0, f64::from(UNITS) - 0.5]));
        assert!(!key.may_hold(&[70.0, 150.0, f64::from(UNITS) - 1.5]));
        assert!(!key.may_hold(&[70.0, 170.0, 30.0]) && !key.may_hold(&[82.0, 150.0, 30.0]));
        assert!(!key.may_hold(&[70.0, 150.0, 66.0]));
    }
}
