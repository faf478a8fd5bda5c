//! An octree over the folded configurations.

use super::chart::{Chart, DEEPEST, MeshPoint, UNITS};
use super::element::Element;
use tiles::configuration::Configuration;

/// A cell of the octree.
#[derive(Clone, Debug)]
pub(in crate::kinetics) struct Leaf {
    /// Its lower corner.
    pub low: MeshPoint,
    /// Its level of subdivision.
    pub level: u8,
    /// The first of its eight parts, in the order of corners.
    parts: Option<u32>,
    /// The integrals over it; `None` if no configuration is free.
    pub element: Option<Box<Element>>,
    /// Whether contact proves that none is free.
    pub blocked: bool,
    /// The cell it is a part of.
    pub parent: Option<u32>,
    /// Whether it has been evaluated.
    pub seen: bool,
    /// Estimated relative error of the integral over its parent: its relative change at the last
    /// division.
    pub doubt: f64,
}

impl Leaf {
    fn new(low: MeshPoint, level: u8, blocked: bool, parent: Option<u32>) -> Self {
        Self {
            low,
            level,
            parts: None,
            element: None,
            blocked,
            seen: false,
            parent,
            doubt: 0.0,
        }
    }

    /// Whether it has not been divided.
    pub fn is_live(&self) -> bool {
        self.parts.is_none()
    }

    /// Its size in smallest units.
    pub fn size(&self) -> i64 {
        UNITS >> self.level
    }

    /// A corner; bit i of its number says whether it is the upper one along coordinate i.
    pub fn corner(&self, number: usize) -> MeshPoint {
        std::array::from_fn(|i| self.low[i] + if number >> i & 1 == 1 { self.size() } else { 0 })
    }

    /// A point given in parts of its size, in smallest units.
    pub fn at(&self, part: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| self.low[i] as f64 + part[i] * self.size() as f64)
    }

    /// A place just beyond the middle of one of its sides: 2 i and 2 i + 1 are the lower and upper
    /// ones along coordinate i.
    pub fn beyond(&self, side: usize) -> MeshPoint {
        let mut place = self.low.map(|low| low + self.size() / 2);
        let axis = side / 2;
        place[axis] = self.low[axis] + if side % 2 == 1 { self.size() } else { -1 };
        place
    }
}

/// The cells: first those into which the chart is divided, in rows along theta, then their parts.
pub(in crate::kinetics) struct Octree {
    pub chart: Chart,
    pub leaves: Vec<Leaf>,
    /// Radius of gyration (m).
    pub rho: f64,
}

impl Octree {
    /// The first cells.
    pub fn new(chart: Chart, rho: f64) -> Self {
        let [n, m, l] = chart.cells;
        let first = |cell: i64| {
            let low = [cell / (m * l), cell / l % m, cell % l].map(|cell| cell * UNITS);
            Leaf::new(low, 0, false, None)
        };
        Self {
            chart,
            leaves: (0..n * m * l).map(first).collect(),
            rho,
        }
    }

    /// The undivided cell that contains the unit cell with this lower corner.
    pub fn find(&self, place: MeshPoint) -> Option<usize> {
        let place = self.chart.fold(place, false)?;
        let [_, across, turning] = self.chart.cells;
        let [i, j, k] = place.map(|units| units / UNITS);
        let mut id = ((i * across + j) * turning + k) as usize;
        let mut half = UNITS;
        while let Some(first) = self.leaves[id].parts {
            half /= 2;
            let upper = |axis: usize| usize::from(place[axis] & half != 0) << axis;
            id = first as usize + upper(0) + upper(1) + upper(2);
        }
        Some(id)
    }

    /// The undivided cells that contain a configuration, or have it on a side.
    pub fn holding(&self, q: &Configuration) -> Vec<usize> {
        let place = self.chart.place(q);
        // A small tolerance, in smallest units.
        const HAIR: f64 = 1e-3;
        let mut found: Vec<usize> = (0..8)
            .filter_map(|corner| {
                let side = |i: usize| if corner >> i & 1 == 1 { HAIR } else { -HAIR };
                self.find(std::array::from_fn(|i| (place[i] + side(i)).floor() as i64))
            })
            .collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Divides a cell, after adjacent cells that would be more than twice as large as its parts.
    pub fn divide(&mut self, id: usize) {
        let (low, level) = (self.leaves[id].low, self.leaves[id].level);
        if !self.leaves[id].is_live() || level >= DEEPEST {
            return;
        }
        let size = self.leaves[id].size();
        for number in 0..27 {
            let aside = [number % 3, number / 3 % 3, number / 9].map(|side| side as i64 - 1);
            let beside = std::array::from_fn(|i| low[i] + aside[i] * size);
            if let Some(other) = self.find(beside)
                && self.leaves[other].level < level
            {
                self.divide(other);
            }
        }
        let first = self.leaves.len() as u32;
        let leaf = &mut self.leaves[id];
        leaf.parts = Some(first);
        leaf.element = None;
        let blocked = leaf.blocked;
        for number in 0..8 {
            let part = std::array::from_fn(|i| low[i] + (number >> i & 1) * size / 2);
            let part = Leaf::new(part, level + 1, blocked, Some(id as u32));
            self.leaves.push(part);
        }
    }

    /// The undivided cells with free configurations, with their indices.
    pub fn live(&self) -> impl Iterator<Item = (usize, &Leaf, &Element)> {
        let live = self.leaves.iter().enumerate();
        let live = live.filter(|(_, leaf)| leaf.is_live());
        live.filter_map(|(id, leaf)| Some((id, leaf, leaf.element.as_deref()?)))
    }

    /// The lowest energy (J) found in a cell; infinite if nothing is free.
    pub fn lowest(&self, id: usize) -> f64 {
        let element = self.leaves[id].element.as_ref();
        element.map_or(f64::INFINITY, |element| element.lowest)
    }

    /// The load of a cell (m^2 rad).
    pub fn held(&self, id: usize) -> f64 {
        let element = self.leaves[id].element.as_ref();
        element.map_or(0.0, |element| element.held())
    }

    /// Whether a cell lies along the outer end of the chart.
    pub fn is_outer(&self, id: usize) -> bool {
        self.chart.is_outer(self.leaves[id].corner(7))
    }

    /// For each cell those that share a face with it.
    pub fn neighbours(&self) -> Vec<Vec<u32>> {
        self.joined(&|leaf| leaf.element.is_some())
    }

    /// For each of some undivided cells those among them that share a face with it.
    pub fn joined(&self, is_one: &dyn Fn(&Leaf) -> bool) -> Vec<Vec<u32>> {
        let mut beside = vec![Vec::new(); self.leaves.len()];
        for (id, leaf) in self.leaves.iter().enumerate() {
            if !leaf.is_live() || !is_one(leaf) {
                continue;
            }
            for side in 0..6 {
                if let Some(other) = self.find(leaf.beyond(side))
                    && is_one(&self.leaves[other])
                {
                    beside[id].push(other as u32);
                    beside[other].push(id as u32);
                }
            }
        }
        beside
    }
}
