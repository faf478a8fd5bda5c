//! The leaves that hold the ends of queries, known from one round to the next.

use std::collections::HashMap;

use super::flood::Seeds;
use super::landscape::Landscape;
use super::query::Goal;
use super::store::Store;
use crate::configuration::Configuration;
use crate::order::Order;

/// The leaves of a store that hold something, by their numbers; only leaves that were added since
/// the last look are looked at.
#[derive(Default)]
struct Holders<T> {
    known: Vec<(u32, T)>,
    seen: u32,
}

impl<T: Copy> Holders<T> {
    fn look(&mut self, store: &Store, holds: impl Fn(u32) -> Option<T>) -> &[(u32, T)] {
        self.known.retain(|(id, _)| store.leaf(*id).live);
        let end = store.len() as u32;
        let fresh = (self.seen..end).filter(|&id| store.leaf(id).live);
        self.known
            .extend(fresh.filter_map(|id| Some((id, holds(id)?))));
        self.seen = end;
        &self.known
    }
}

/// Where the ends of queries lie in a store.
#[derive(Default)]
pub(super) struct Ends {
    /// By the bits of a configuration.
    at: HashMap<[u64; 3], Holders<()>>,
    /// With the energy (J) there.
    far: Holders<f64>,
}

impl Ends {
    /// The leaves that hold either end of a query.
    pub fn seeds(
        &mut self,
        store: &Store,
        landscape: &Landscape,
        from: &Configuration,
        to: &Goal,
    ) -> Seeds {
        let low = |ids: Vec<u32>| ids.into_iter().map(|id| (id, f64::NEG_INFINITY)).collect();
        Seeds {
            from: low(self.holding(store, from)),
            to: match to {
                Goal::At(to) => low(self.holding(store, to)),
                Goal::Free => self.far(store, landscape).to_vec(),
                Goal::Any(goals) => {
                    let mut all: Vec<(u32, f64)> = goals
                        .iter()
                        .flat_map(|goal| low(self.holding(store, goal)))
                        .collect();
                    all.extend(self.far(store, landscape));
                    // Of a leaf that holds both, what comes first.
                    all.order_by_key(|(id, _)| *id);
                    all.dedup_by_key(|(id, _)| *id);
                    all
                }
            },
        }
    }

    /// The leaves that hold a configuration.
    pub fn holding(&mut self, store: &Store, q: &Configuration) -> Vec<u32> {
        let bits = [q.x, q.y, q.theta].map(f64::to_bits);
        let place = store.place(q);
        let holds = |id: u32| {
            let key = &store.leaf(id).key;
            (key.may_hold(&place) && store.cell(key).contains(q)).then_some(())
        };
        let held = self.at.entry(bits).or_default().look(store, holds);
        held.iter().map(|(id, ())| *id).collect()
    }

    /// The leaves that hold configurations with the tiles far apart.
    fn far(&mut self, store: &Store, landscape: &Landscape) -> &[(u32, f64)] {
        self.far.look(store, |id| {
            let leaf = store.leaf(id);
            let cell = store.cell(&leaf.key);
            if landscape.space.is_far(&cell.centre) {
                return Some(leaf.known.estimate);
            }
            let end = landscape.far_end(&cell)?;
            Some(landscape.proof().value(&end).1)
        })
    }
}
