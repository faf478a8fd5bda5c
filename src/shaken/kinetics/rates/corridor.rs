//! Free corridors that are narrower than the cells of a mesh.
//!
//! If none of the integration lines through a cell meets a free configuration, the cell is closed,
//! although contact may not prove it blocked. If only such cells separate a state from free tiles,
//! they are divided until a path is found or excluded.

use super::field::MeshField;
use super::sets::{best_way, flood};
use tiles::configuration::Configuration;

/// Cells of this size (m, for the paper's tile) are not divided any further.
pub const NARROW: f64 = 1e-4;
/// Largest number of divisions for one path.
const MOST_DIVIDED: usize = 20_000;

/// Whether the mesh has a path from a state to free tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathToFree {
    /// It has a path.
    Open,
    /// Contact proves that there is no path.
    Blocked,
    /// No path was found, and paths narrower than 0.1 mm are not excluded.
    Lost,
}

impl PathToFree {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::Blocked => "blocked",
            Self::Lost => "not found",
        }
    }

    /// Its description.
    pub fn describe(self) -> String {
        match self {
            Self::Open => "a path leads to free tiles".to_owned(),
            Self::Blocked => "contact blocks every path to free tiles".to_owned(),
            Self::Lost => format!(
                "no path to free tiles was found; paths narrower than {} of a tile's circumradius \
                 are not excluded",
                "a 3000th"
            ),
        }
    }
}

impl MeshField<'_> {
    /// Refines the mesh until it has a path from a configuration to its rim, if there is one.
    pub fn open_way(&mut self, from: &Configuration) -> PathToFree {
        let mut divided = 0;
        let mut is_excluded = true;
        loop {
            let Some(closed) = self.closed_on_way(from, &mut is_excluded) else {
                return if is_excluded {
                    PathToFree::Blocked
                } else {
                    PathToFree::Lost
                };
            };
            if closed.is_empty() {
                return PathToFree::Open;
            }
            divided += closed.len();
            if divided > MOST_DIVIDED {
                return PathToFree::Lost;
            }
            self.divide(&closed);
        }
    }

    /// For every two of some configurations, and last the mesh's rim, whether contact blocks every
    /// path between them.
    pub fn blocked(&self, places: &[Configuration]) -> Vec<Vec<bool>> {
        let mesh = &self.mesh;
        let beside = mesh.joined(&|leaf| !leaf.blocked);
        let reach = |from: &Configuration| flood(&beside, mesh.holding(from), &|_| true);
        let reached: Vec<Vec<bool>> = places.iter().map(reach).collect();
        let to_rim =
            |reached: &Vec<bool>| (0..reached.len()).any(|id| reached[id] && mesh.is_outer(id));
        let met = |from: usize, to: usize| match (reached.get(from), places.get(to)) {
            (Some(from), Some(to)) => mesh.holding(to).iter().any(|&id| from[id]),
            (Some(from), None) => to_rim(from),
            (None, Some(_)) => to_rim(&reached[to]),
            (None, None) => true,
        };
        let all = 0..=places.len();
        all.clone()
            .map(|from| all.clone().map(|to| !met(from, to)).collect())
            .collect()
    }

    /// The closed cells on the path to the rim with the fewest of them, by size, if there is a
    /// path. If some cells are too small to be tested, nothing is excluded.
    fn closed_on_way(&self, from: &Configuration, is_excluded: &mut bool) -> Option<Vec<usize>> {
        let mesh = &self.mesh;
        let is_small = |level: u8| mesh.chart.depth(level) < self.problem.scaled(NARROW);
        let beside = mesh.joined(&|leaf| !leaf.blocked);
        let cost = |id: usize| match mesh.leaves[id].element {
            Some(_) => 0,
            None => mesh.leaves[id].size(),
        };
        // The start has no cost.
        let after = |length: Option<i64>, id: usize| match length {
            None => Some(Some(0)),
            Some(_) if cost(id) > 0 && is_small(mesh.leaves[id].level) => {
                *is_excluded = false;
                None
            }
            Some(length) => Some(Some(length + cost(id))),
        };
        let to_rim = |id: usize| mesh.is_outer(id);
        let (_, mut way) = best_way(&beside, None, mesh.holding(from), after, &to_rim)?;
        way.retain(|&id| cost(id) > 0);
        Some(way)
    }
}
