//! Cells about which nothing is proved, grouped where they lie close to each other.

use std::collections::BTreeMap;

use ordered_float::OrderedFloat;
use petgraph::unionfind::UnionFind;

use tiles::cell::Cell;
use tiles::configuration::{Configuration, ConfigurationSpace};
use tiles::order::Order;

/// A part of the space about which nothing is proved.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct OpenRegion {
    /// The configuration where the lowest energy may be.
    pub pose: Configuration,
    /// Volume of its cells (m^2 rad).
    pub volume: f64,
    /// The lowest energy (J) that it can hide.
    pub lowest: f64,
}

/// Cells closer than this fraction of the distance at which tiles are free belong together.
const NEIGHBOURING: f64 = 1.0 / 32.0;

/// A region under construction.
struct Part {
    region: OpenRegion,
    /// The box around it.
    around: Cell,
}

impl Part {
    fn of_cell(cell: &Cell, lowest: f64) -> Self {
        Self {
            region: OpenRegion {
                pose: cell.centre,
                volume: cell.volume(),
                lowest,
            },
            around: *cell,
        }
    }

    fn add(&mut self, other: &Self) {
        let volume = self.region.volume + other.region.volume;
        if other.region.lowest < self.region.lowest {
            self.region = other.region;
        }
        self.region.volume = volume;
        let step = self.around.centre.step_to(&other.around.centre);
        for (i, half) in self.around.half.iter_mut().enumerate() {
            *half = half.max(step[i].abs() + other.around.half[i]);
        }
    }

    /// Whether the boxes are no farther apart than `gap` (m, m, rad) along each coordinate.
    fn is_beside(&self, other: &Self, gap: &[f64; 3]) -> bool {
        let apart = (self.around.centre.y - other.around.centre.y).abs();
        if apart > self.around.half[1] + other.around.half[1] + gap[1] {
            return false;
        }
        let step = self.around.centre.step_to(&other.around.centre);
        (0..3).all(|i| step[i].abs() <= self.around.half[i] + other.around.half[i] + gap[i])
    }
}

/// The regions of some cells with the lowest energy (J) that each can hide, the lowest first.
pub(super) fn of_cells(space: &ConfigurationSpace, cells: &[(Cell, f64)]) -> Vec<OpenRegion> {
    let size = NEIGHBOURING * space.free_distance;
    let gap = [size, size, size / space.rho];
    let place = |cell: &Cell| {
        let at = cell.centre.to_array();
        [0, 1, 2].map(|i| (at[i] / gap[i]).floor() as i64)
    };
    // First cells at one place, then adjacent ones.
    let mut places: BTreeMap<[i64; 3], Part> = BTreeMap::new();
    for (cell, lowest) in cells {
        let part = Part::of_cell(cell, *lowest);
        places
            .entry(place(cell))
            .and_modify(|known| known.add(&part))
            .or_insert(part);
    }
    let parts: Vec<Part> = places.into_values().collect();
    let mut joined = UnionFind::<usize>::new(parts.len());
    for [i, j] in beside(&parts, &gap) {
        joined.union(i, j);
    }
    let mut regions: BTreeMap<usize, Part> = BTreeMap::new();
    for (i, part) in parts.into_iter().enumerate() {
        regions
            .entry(joined.find(i))
            .and_modify(|known| known.add(&part))
            .or_insert(part);
    }
    let mut regions: Vec<OpenRegion> = regions.into_values().map(|part| part.region).collect();
    regions.order_by_key(|region| OrderedFloat(region.lowest));
    regions
}

/// The parts that lie beside each other, swept along x: there may be a hundred thousand of them, and
/// all pairs of those would take longer than the proof.
fn beside(parts: &[Part], gap: &[f64; 3]) -> Vec<[usize; 2]> {
    let [left, right] = [-1.0, 1.0].map(|side| {
        move |part: &Part| part.around.centre.x + side * (part.around.half[0] + gap[0] / 2.0)
    });
    let mut swept: Vec<usize> = (0..parts.len()).collect();
    swept.order_by_key(|&i| OrderedFloat(left(&parts[i])));
    let mut found = Vec::new();
    for (k, &i) in swept.iter().enumerate() {
        let a = &parts[i];
        // Rounding here excludes none that are beside each other.
        let end = right(a) + 1e-9 * gap[0];
        let after = swept[k + 1..].iter().copied();
        let near = after.take_while(|&j| left(&parts[j]) <= end);
        found.extend(
            near.filter(|&j| a.is_beside(&parts[j], gap))
                .map(|j| [i, j]),
        );
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use tiles::configuration::Configuration;

    #[test]
    fn cells_side_by_side_are_one_region_and_cells_apart_are_two() {
        let space = ConfigurationSpace {
            half_size: [10.0, 10.0],
            rho: 0.5,
            free_distance: 1.0,
        };
        let half = [0.001, 0.001, 0.001];
        let cell = |x: f64, theta: f64| Cell {
            centre: Configuration::new(x, 0.1, theta),
            half,
        };
        let gap = NEIGHBOURING * space.free_distance;
        let regions = |cells: &[(Cell, f64)]| of_cells(&space, cells);
        // Boxes whose sides are slightly less, and slightly more, than the gap apart.
        for (apart, count) in [(gap + 0.0019, 1), (gap + 0.0021, 2)] {
            let beside = [(cell(0.3, 0.2), -2.0), (cell(0.3 + apart, 0.2), -3.0)];
            let found = regions(&beside);
            assert_eq!(found.len(), count, "{apart}");
            assert_eq!(found[0].lowest, -3.0);
            let volume: f64 = found.iter().map(|region| region.volume).sum();
            assert!((volume - 2.0 * beside[0].0.volume()).abs() < 1e-15);
            let turned = [
                (cell(0.3, 0.2), 0.0),
                (cell(0.3, 0.2 + gap / space.rho + apart - gap), 0.0),
            ];
            assert_eq!(regions(&turned).len(), count, "{apart}");
        }
    }

    /// Boxes of all sizes, across theta = pi.
    #[test]
    fn a_sweep_finds_the_same_parts_beside_each_other_as_all_pairs_do() {
        use rand::{RngExt, SeedableRng};
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let mut draw = |most: f64| rng.random_range(-most..most);
        let mut part = || {
            let centre = Configuration::new(draw(1.0), draw(1.0), draw(3.1));
            let half = [0.1, 0.1, 0.3].map(|most| draw(most).powi(2) / most);
            Part::of_cell(&Cell { centre, half }, 0.0)
        };
        let parts: Vec<Part> = (0..800).map(|_| part()).collect();
        let gap = [0.03, 0.03, 0.1];
        let mut swept = beside(&parts, &gap);
        swept.iter_mut().for_each(|pair| pair.sort_unstable());
        swept.sort_unstable();
        let pairs = (0..parts.len()).flat_map(|i| (i + 1..parts.len()).map(move |j| [i, j]));
        let all: Vec<[usize; 2]> = pairs
            .filter(|[i, j]| parts[*i].is_beside(&parts[*j], &gap))
            .collect();
        assert!(all.len() > 100, "{}", all.len());
        assert_eq!(swept, all);
    }
}
