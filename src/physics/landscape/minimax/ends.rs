//! The leaves that contain the ends of queries.

use super::Goal;
use super::level::Seeds;
use super::store::Store;
use crate::cell::Cell;
use crate::configuration::{Configuration, ConfigurationSpace};
use crate::landscape::bounded::Bounded;
use crate::order::Order;
use crate::parallel;

/// The leaves that hold configurations with the tiles far apart, which any query may end in.
#[derive(Default)]
pub(super) struct Ends {
    /// With the energy (J) there.
    far: Vec<(u32, f64)>,
    /// Number of leaves at the last call.
    seen: u32,
}

impl Ends {
    /// The leaves that hold either end of a query, where those far apart are as at the last
    /// [look](Self::look).
    pub fn seeds(&self, store: &Store, from: &Configuration, goal: &Goal) -> Seeds {
        let holding = |q: &Configuration| {
            let held = store.holding(q).into_iter();
            held.map(|id| (id, f64::NEG_INFINITY)).collect::<Vec<_>>()
        };
        let from = holding(from);
        let mut to: Vec<(u32, f64)> = goal.places.iter().flat_map(holding).collect();
        if goal.free {
            to.extend(&self.far);
        }
        // If a leaf holds several, the first of them.
        to.order_by_key(|(id, _)| *id);
        to.dedup_by_key(|(id, _)| *id);
        Seeds { from, to }
    }

    /// Examines the leaves added since the last call.
    pub fn look(&mut self, store: &Store, bounded: &Bounded) {
        let energy = |id: u32| {
            let leaf = store.leaf(id);
            let cell = store.cell(&leaf.key);
            if bounded.space.is_far(&cell.centre) {
                return Some(leaf.known.estimate);
            }
            let end = far_end(bounded.space, &cell)?;
            Some(bounded.value(&end).1)
        };
        self.far.retain(|(id, _)| store.leaf(*id).live);
        let fresh: Vec<u32> = (self.seen..store.len() as u32)
            .filter(|&id| store.leaf(id).live)
            .collect();
        self.far
            .extend(parallel::flat_map(&fresh, |&id| Some((id, energy(id)?))));
        self.seen = store.len() as u32;
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
