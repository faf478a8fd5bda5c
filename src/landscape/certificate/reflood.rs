//! Floods that fall to where a subdivision of leaves makes a difference, and rise again from there.
//!
//! A flood is a sequence of steps, each of which takes the lowest entry from the queue. After some
//! leaves have been replaced by their parts the steps are the same up to the first that took an
//! entry of a replaced leaf, or before which an entry of a part would have been taken; where the
//! level has fallen, up to the first that took an entry of a leaf which it bars. Up to there they
//! need not be done again: what is found is the same as if all were.

use std::cmp::Reverse;

use super::flood::{BARRED, DIVIDE, Deed, Entry, FROM, Flood, NONE, Seeds, TO, TOUCHED};
use super::level::ordered;
use super::store::Store;

impl Flood {
    /// Floods up to `level` (J) for leaves some of which, those in `divided` that do not live any
    /// more, were replaced by their parts since these rose.
    pub fn after(self, store: &Store, divided: &[u32], seeds: &Seeds, level: f64) -> Self {
        let known = self.state.len();
        let is_new = |seed: &&(u32, f64)| seed.0 as usize >= known;
        let seeds_are_known = !seeds.from.iter().chain(&seeds.to).any(|seed| is_new(&seed));
        // Without a level the ranks are others.
        let is_lower = self.level < f64::INFINITY && level <= self.level;
        if !seeds_are_known || (level != self.level && !is_lower) {
            return Self::new(store, seeds, level);
        }
        let mut flood = self;
        if level < flood.level {
            flood.level = level;
            for (state, lower) in flood.state.iter_mut().zip(store.lowers()) {
                if *lower > level {
                    *state |= BARRED;
                }
            }
        }
        flood.extend(store);
        let fresh = known as u32..store.len() as u32;
        let kept = flood.unaffected(store, divided, fresh.clone());
        flood.fall(store, kept);
        for id in fresh {
            flood.touch(store, id);
        }
        flood
    }

    /// How many steps are the same as before.
    fn unaffected(&self, store: &Store, divided: &[u32], fresh: std::ops::Range<u32>) -> usize {
        let is_gone = |id: u32| !store.leaf(id).live;
        let flooded = divided.iter().filter(|&&id| is_gone(id));
        let flooded = flooded.map(|&id| self.time[id as usize]);
        let in_divide = self.divided.iter().copied();
        let in_divide = in_divide.filter(|&step| is_gone(self.steps[step as usize].entry.id()));
        let first = flooded.chain(in_divide).min().unwrap_or(NONE) as usize;
        let is_barred = |id: u32| self.state[id as usize] & BARRED != 0;
        let steps = &self.steps[..first.min(self.steps.len())];
        let barred = steps.iter().position(|step| is_barred(step.entry.id()));
        let mut kept = barred.unwrap_or(steps.len());
        let ranks = self.ranks(store);
        for id in fresh.filter(|&id| !is_barred(id)) {
            let around = store.leaf(id).neighbours.iter();
            let touched = around.map(|&n| self.time[n as usize]).min().unwrap_or(NONE) as usize;
            if touched < kept {
                // Taken as soon as no lower one is left.
                let rank = ordered(ranks[id as usize]);
                let later = &self.steps[touched..kept];
                kept = touched + later.partition_point(|step| step.top < rank).max(1);
            }
        }
        kept
    }

    /// Undoes all steps but the first `kept`.
    fn fall(&mut self, store: &Store, kept: usize) {
        let undone = self.steps.split_off(kept);
        let is_undone = |time: u32| time as usize >= kept;
        let mut entries: Vec<Entry> = std::mem::take(&mut self.queue)
            .into_iter()
            .map(|Reverse(entry)| entry)
            .chain(undone.iter().map(|step| step.entry))
            .collect();
        entries.retain(|entry| {
            let before = entry.before();
            if before != NONE && is_undone(self.time[before as usize]) {
                self.state[entry.id() as usize] &= !(entry.side() << TOUCHED);
                return false;
            }
            store.leaf(entry.id()).live && self.state[entry.id() as usize] & BARRED == 0
        });
        for step in &undone {
            let id = step.entry.id() as usize;
            match step.deed {
                Deed::Nothing => {}
                Deed::Divided => self.state[id] &= !DIVIDE,
                Deed::Flooded => {
                    self.state[id] &= !step.entry.side();
                    self.time[id] = NONE;
                }
            }
        }
        self.waiting = [0; 3];
        for entry in &entries {
            self.waiting[usize::from(entry.side())] += 1;
        }
        self.queue = entries.into_iter().map(Reverse).collect();
        let divides = self.divided.partition_point(|step| !is_undone(*step));
        self.divided.truncate(divides);
        if self.divided.is_empty() {
            self.pass = None;
        }
    }

    /// Puts a new leaf in the queue of each flood that touches it, as one to spread to from the leaf
    /// that did so first.
    fn touch(&mut self, store: &Store, id: u32) {
        if self.state[id as usize] & BARRED != 0 {
            return;
        }
        for side in [FROM, TO] {
            let around = store.leaf(id).neighbours.iter().copied();
            let first = around
                .filter(|&n| self.state[n as usize] & side != 0)
                .min_by_key(|&n| self.time[n as usize]);
            if let Some(before) = first {
                self.state[id as usize] |= side << TOUCHED;
                let rank = self.ranks(store)[id as usize];
                self.push(Entry::new(rank, id, side, before));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::ConfigurationSpace;
    use crate::landscape::certificate::lower::Assessment;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn falling_and_rising_again_finds_what_a_flood_from_the_start_does() {
        let space = ConfigurationSpace {
            half_size: [1.0, 1.0],
            rho: 0.2,
            free_distance: 0.9,
        };
        let mut spared = 0;
        for seed in 0..6 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut known = |least: f64| {
                let lower = rng.random_range(least..1.0);
                let estimate = rng.random_range(lower..1.5);
                Assessment {
                    lower,
                    estimate,
                    overlap: 0.0,
                    axis: rng.random_range(0..3),
                }
            };
            let mut store = Store::new(&space);
            let first: Vec<_> = Store::first_keys()
                .into_iter()
                .map(|key| (key, known(0.0)))
                .collect();
            store.fill(&first);
            let seeds = Seeds {
                from: vec![(3, f64::NEG_INFINITY)],
                to: vec![(900, 0.1), (500, 0.2)],
            };
            let mut level = 0.8;
            let mut flood = Flood::new(&store, &seeds, level);
            for round in 0..40 {
                let found = flood.rise(&store, 12);
                let afresh = Flood::new(&store, &seeds, level).rise(&store, 12);
                assert_eq!(found.divide, afresh.divide);
                assert_eq!(found.pass, afresh.pass);
                // What is divided need not be the divide.
                let path = found.pass.map_or_else(Vec::new, |pass| pass.1);
                let also = path.into_iter().skip(4).take(1);
                let divided: Vec<u32> = found.divide.into_iter().chain(also).collect();
                for &id in divided.iter().filter(|id| ![3, 500, 900].contains(*id)) {
                    let whole = store.leaf(id).clone();
                    if let Some(halves) = whole.key.halves(whole.known.axis).filter(|_| whole.live)
                    {
                        let parts = halves.map(|key| (key, known(whole.known.lower)));
                        store.replace(id, &parts);
                    }
                }
                level -= if round % 5 == 0 { 0.01 } else { 0.0 };
                flood = flood.after(&store, &divided, &seeds, level);
                spared += flood.steps.len();
            }
        }
        assert!(spared > 0);
    }
}
