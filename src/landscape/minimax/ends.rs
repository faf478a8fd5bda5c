//! The leaves that contain the ends of queries.

use super::Goal;
use super::level::Seeds;
use super::store::Store;
use crate::bounded::Bounded;
use tiles::cell::Cell;
use tiles::configuration::{Configuration, ConfigurationSpace};
use tiles::parallel;

/// The leaves that hold configurations with the tiles far apart, which any query may end in.
#[derive(Default)]
pub(super) struct Ends {
    /// For each leaf at the last look, the energy (J) there; NaN if it holds none.
    far: Vec<f64>,
}

/// The leaves that hold the start and the places of a query, in this order; empty at first.
#[derive(Default)]
pub(super) struct Held(Vec<Vec<u32>>);

impl Ends {
    /// The leaves that hold either end of a query, where those far apart are as at the last
    /// [look](Self::look). `held` are those that held the configurations at the last call.
    pub fn seeds(
        &self,
        store: &Store,
        (from, goal): (&Configuration, &Goal),
        held: &mut Held,
    ) -> Seeds<'_> {
        let places = std::iter::once(from).chain(&goal.places);
        if held.0.is_empty() {
            held.0 = places.map(|q| store.holding(q)).collect();
        } else {
            for (q, ids) in places.zip(&mut held.0) {
                if ids.iter().any(|&id| !store.leaf(id).live) {
                    *ids = store.still_holding(std::mem::take(ids), q);
                }
            }
        }
        let mut to: Vec<u32> = held.0[1..].concat();
        to.sort_unstable();
        to.dedup();
        Seeds {
            from: held.0[0].clone(),
            to,
            far: goal.free.then_some(&self.far),
        }
    }

    /// Examines the leaves added since the last call.
    pub fn look(&mut self, store: &Store, bounded: &Bounded) {
        let energy = |id: usize| {
            let leaf = store.leaf(id as u32);
            let cell = store.cell(&leaf.key);
            if bounded.space.is_far(&cell.centre) {
                return leaf.known.estimate;
            }
            let end = far_end(bounded.space, &cell);
            end.map_or(f64::NAN, |end| bounded.value(&end).1)
        };
        let fresh = parallel::map(self.far.len()..store.len(), energy);
        self.far.extend(fresh);
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
