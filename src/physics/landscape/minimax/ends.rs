//! The leaves that contain the ends of queries, kept from one round to the next.

use std::collections::HashMap;

use super::level::Seeds;
use super::proved::Goal;
use super::store::Store;
use crate::cell::Cell;
use crate::configuration::{Configuration, ConfigurationSpace};
use crate::landscape::bounded::Bounded;
use crate::order::Order;

/// The leaves of a store that hold something, by their numbers; only leaves added since the last
/// call are examined.
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
    /// Keyed by the bits of a configuration.
    at: HashMap<[u64; 3], Holders<()>>,
    /// With the energy (J) there.
    far: Holders<f64>,
}

impl Ends {
    /// The leaves that hold either end of a query.
    pub fn seeds(
        &mut self,
        store: &Store,
        bounded: &Bounded,
        from: &Configuration,
        goal: &Goal,
    ) -> Seeds {
        let low = |ids: Vec<u32>| ids.into_iter().map(|id| (id, f64::NEG_INFINITY)).collect();
        let from: Vec<(u32, f64)> = low(self.holding(store, from));
        let places = goal.places.iter();
        let mut to: Vec<(u32, f64)> = places
            .flat_map(|place| low(self.holding(store, place)))
            .collect();
        if goal.free {
            to.extend(self.far(store, bounded));
        }
        // If a leaf holds several, the first of them.
        to.order_by_key(|(id, _)| *id);
        to.dedup_by_key(|(id, _)| *id);
        Seeds { from, to }
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
    fn far(&mut self, store: &Store, bounded: &Bounded) -> &[(u32, f64)] {
        self.far.look(store, |id| {
            let leaf = store.leaf(id);
            let cell = store.cell(&leaf.key);
            if bounded.space.is_far(&cell.centre) {
                return Some(leaf.known.estimate);
            }
            let end = far_end(bounded.space, &cell)?;
            Some(bounded.value(&end).1)
        })
    }
}

/// A configuration with the tiles far apart, near the middle of a cell that holds one; `None` if the
/// cell is proved to hold none.
pub(super) fn far_end(space: &ConfigurationSpace, cell: &Cell) -> Option<Configuration> {
    let centre = cell.centre;
    // The one that is farthest from the origin in the plane, at the cell's middle angle.
    let away = |centre: f64, half: f64| centre + half.copysign(centre);
    let [x, y] = [away(centre.x, cell.half[0]), away(centre.y, cell.half[1])];
    let farthest = Configuration::new(x, y, centre.theta);
    if !space.is_far(&farthest) {
        return None;
    }
    let stretch = space.free_distance / libm::hypot(centre.x, centre.y);
    let stretch = stretch.max(1.0) * (1.0 + 1e-12);
    let near = Configuration::new(centre.x * stretch, centre.y * stretch, centre.theta);
    let fits = space.contains(&near) && space.is_far(&near);
    Some(if fits { near } else { farthest })
}
