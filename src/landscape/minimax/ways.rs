//! The leaves crossed by proved pathways.

use std::ops::Range;

use super::store::{Key, Store};
use tiles::configuration::Configuration;
use tiles::parallel;

/// Pathways and the leaves that they cross, kept from one round to the next.
#[derive(Default)]
pub(super) struct Ways {
    /// The points of all pathways, with their approximate energies (J).
    points: Vec<(Configuration, f64)>,
    /// The range of points of each pathway.
    each: Vec<Range<usize>>,
    /// By leaf.
    crossed: Vec<Crossed>,
    /// The leaves that something crosses, ascending up to the last call.
    now: Vec<u32>,
}

/// What crosses a leaf.
struct Crossed {
    /// Stretches, as indices of their first points.
    stretches: Vec<u32>,
    /// The highest energy (J) on them there, interpolated linearly between the points.
    highest: f64,
}

impl Ways {
    /// Whether a pathway through these points is one of them.
    pub fn include(&self, points: &[Configuration]) -> bool {
        let is_it = |range: &Range<usize>| {
            let known = self.points[range.clone()].iter().map(|(q, _)| q);
            range.len() == points.len() && known.eq(points)
        };
        self.each.iter().any(is_it)
    }

    /// Adds a pathway that starts in the leaves `start`.
    pub fn add(&mut self, store: &Store, start: Vec<u32>, way: &[(Configuration, f64)]) {
        self.follow(store);
        let first = self.points.len();
        self.points.extend(way);
        self.each.push(first..self.points.len());
        let mut open = start;
        for stretch in first..self.points.len() - 1 {
            let mut met: Vec<u32> = Vec::new();
            while let Some(id) = open.pop() {
                if !met.contains(&id) && self.note(store, id, stretch as u32) {
                    met.push(id);
                    open.extend(store.neighbours(id));
                }
            }
            let (end, _) = self.points[stretch + 1];
            met.retain(|&id| store.cell(&store.leaf(id).key).contains(&end));
            open = met;
        }
    }

    /// The leaves crossed now, with the highest energy (J) on the pathways there.
    pub fn leaves(&mut self, store: &Store) -> impl Iterator<Item = (u32, f64)> {
        self.follow(store);
        self.now.retain(|&id| store.leaf(id).live);
        self.now.sort_unstable();
        let highest = |&id: &u32| (id, self.crossed[id as usize].highest);
        self.now.iter().map(highest)
    }

    /// Examines the leaves added since the last call.
    fn follow(&mut self, store: &Store) {
        while self.crossed.len() < store.len() {
            let first = self.crossed.len();
            let whole = |id: usize| store.leaf(id as u32).whole as usize;
            // Parts of parts come after those that they are parts of.
            let is_next = |id: &usize| whole(*id) < first || whole(*id) == *id;
            let fresh = (first..store.len()).take_while(is_next).count();
            let crossed = parallel::map(first..first + fresh, |id| {
                let mut crossed = Crossed::default();
                let whole = self
                    .crossed
                    .get(whole(id))
                    .map(|whole| &whole.stretches[..]);
                for &stretch in whole.unwrap_or_default() {
                    crossed.include(stretch, self.highest_in(store, id as u32, stretch));
                }
                crossed
            });
            let is_crossed = |id: &u32| !crossed[*id as usize - first].stretches.is_empty();
            let fresh = first as u32..(first + fresh) as u32;
            self.now.extend(fresh.filter(is_crossed));
            self.crossed.extend(crossed);
        }
    }

    /// Records a stretch that crosses a leaf; false if it does not.
    fn note(&mut self, store: &Store, id: u32, stretch: u32) -> bool {
        let highest = self.highest_in(store, id, stretch);
        let crossed = &mut self.crossed[id as usize];
        if highest.is_some() && crossed.stretches.is_empty() {
            self.now.push(id);
        }
        crossed.include(stretch, highest);
        highest.is_some()
    }

    /// The highest energy (J) on a stretch in a leaf, if it crosses the leaf.
    fn highest_in(&self, store: &Store, id: u32, stretch: u32) -> Option<f64> {
        let k = stretch as usize;
        let [(from, a), (to, b)] = [self.points[k], self.points[k + 1]];
        let within = within(store, &store.leaf(id).key, [&from, &to])?;
        let [first, last] = within.map(|t| a + (b - a) * t);
        Some(first.max(last))
    }
}

impl Crossed {
    /// Adds a stretch, if it has a highest energy (J) here.
    fn include(&mut self, stretch: u32, highest: Option<f64>) {
        let Some(highest) = highest else { return };
        self.stretches.push(stretch);
        self.highest = self.highest.max(highest);
    }
}

impl Default for Crossed {
    fn default() -> Self {
        Self {
            stretches: Vec::new(),
            highest: f64::NEG_INFINITY,
        }
    }
}

/// The part of a straight stretch that lies in a leaf's cell, as shares of its length; `None` if
/// none does.
fn within(store: &Store, key: &Key, [from, to]: [&Configuration; 2]) -> Option<[f64; 2]> {
    let cell = store.cell(key);
    let (start, step) = (cell.centre.step_to(from), from.step_to(to));
    let mut part = [0.0f64, 1.0f64];
    for i in 0..3 {
        // The angle, up to whole turns, that is closest to the cell in the middle of the stretch.
        let turns = if i == 2 {
            let middle = start[2] + step[2] / 2.0;
            std::f64::consts::TAU * (middle / std::f64::consts::TAU).round()
        } else {
            0.0
        };
        let at = start[i] - turns;
        if step[i] == 0.0 {
            if at.abs() > cell.half[i] {
                return None;
            }
            continue;
        }
        let (a, b) = (
            (-cell.half[i] - at) / step[i],
            (cell.half[i] - at) / step[i],
        );
        part = [part[0].max(a.min(b)), part[1].min(a.max(b))];
    }
    (part[0] <= part[1]).then_some(part)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::minimax::store::tests::{KNOWN, first_cells};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// A few steps, across theta = pi, with x as the energy.
    fn way(rng: &mut ChaCha8Rng) -> Vec<(Configuration, f64)> {
        let mut at = Configuration::new(0.3, -0.2, 2.9);
        let steps = (0..12).map(|k| {
            let mut draw = |most: f64| rng.random_range(-most..most);
            let turn = if k % 3 == 0 { 0.0 } else { 0.1 + draw(0.05) };
            at = at.moved([draw(0.1), draw(0.1), turn].into());
            (at, at.x)
        });
        steps.collect()
    }

    /// The leaves that hold closely sampled points of the paths, and the highest energy there.
    fn held(store: &Store, ways: &[Vec<(Configuration, f64)>]) -> BTreeMap<u32, f64> {
        let mut held: BTreeMap<u32, f64> = BTreeMap::new();
        let stretches = ways.iter().flat_map(|way| way.windows(2));
        for k in stretches.flat_map(|ends| (0..=400).map(move |k| (ends, k))) {
            let ([(a, _), (b, _)], k) = k else { continue };
            let q = a.interpolate(b, f64::from(k) / 400.0);
            for (id, leaf) in store.live() {
                if store.cell(&leaf.key).contains(&q) {
                    let highest = held.entry(id).or_insert(q.x);
                    *highest = highest.max(q.x);
                }
            }
        }
        held
    }

    #[test]
    fn ways_are_in_the_leaves_that_hold_their_points_however_those_are_cut() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let mut store = first_cells();
        let mut ways = Ways::default();
        let mut all = Vec::new();
        for _ in 0..3 {
            let new = way(&mut rng);
            let start = store.holding(&new[0].0);
            let points: Vec<Configuration> = new.iter().map(|(q, _)| *q).collect();
            assert!(!ways.include(&points));
            ways.add(&store, start, &new);
            assert!(ways.include(&points) && !ways.include(&points[1..]));
            all.push(new);
            for _ in 0..40 {
                let on: Vec<u32> = ways.leaves(&store).map(|(id, _)| id).collect();
                let id = on[rng.random_range(0..on.len())];
                let halves = store.leaf(id).key.halves(rng.random_range(0..3)).unwrap();
                store.replace(&[(id, halves.map(|key| (key, KNOWN)).to_vec())]);
            }
            let found: BTreeMap<u32, f64> = ways.leaves(&store).collect();
            let held = held(&store, &all);
            // Leaves crossed only at a corner hold no sampled point.
            assert!(held.keys().all(|id| found.contains_key(id)));
            assert!(
                found.len() <= held.len() + 12,
                "{} {}",
                found.len(),
                held.len()
            );
            for (id, highest) in held {
                let most = found[&id];
                assert!(
                    most >= highest - 1e-12 && most < highest + 1e-3,
                    "{most} {highest}"
                );
            }
        }
    }
}
