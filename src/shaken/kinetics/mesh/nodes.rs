//! The corners of cells, and the values of continuous functions at them.

use std::collections::HashMap;

use super::chart::MeshPoint;
use super::element::{shapes, value};
use super::octree::Octree;
use tiles::configuration::Configuration;

/// The corners of a mesh's cells. A corner on the side of a larger cell *hangs*: its value follows
/// from those of that cell's corners, which makes functions continuous.
pub(in crate::kinetics) struct Nodes {
    /// For each cell the numbers of its corners.
    pub corners: Vec<[u32; 8]>,
    /// For each corner those that determine its value, with their weights: only itself if it does
    /// not hang.
    pub sources: Vec<Vec<(u32, f64)>>,
}

impl Nodes {
    pub fn new(mesh: &Octree) -> Self {
        let mut numbers: HashMap<MeshPoint, u32> = HashMap::new();
        let mut places: Vec<MeshPoint> = Vec::new();
        let mut corners = vec![[0; 8]; mesh.leaves.len()];
        for (id, leaf, _) in mesh.live() {
            corners[id] = std::array::from_fn(|number| {
                let place = mesh.chart.fold(leaf.corner(number), true);
                let place = place.expect("corners of cells lie in the chart");
                *numbers.entry(place).or_insert_with(|| {
                    places.push(place);
                    places.len() as u32 - 1
                })
            });
        }
        let hangs: Vec<_> = places.iter().map(|place| hangs(mesh, *place)).collect();
        let mut sources = vec![Vec::new(); places.len()];
        for node in 0..places.len() {
            resolve(node, &hangs, &corners, &mut sources);
        }
        Self { corners, sources }
    }

    pub fn len(&self) -> usize {
        self.sources.len()
    }

    pub fn is_hanging(&self, node: usize) -> bool {
        self.sources[node][0].0 as usize != node
    }

    /// Whether a cell has corners.
    pub fn know(&self, cell: usize) -> bool {
        self.corners
            .get(cell)
            .is_some_and(|corners| *corners != [0; 8])
    }

    /// For each corner the place where its value is given: `rim` at the outer end, otherwise the
    /// place of the first adjacent cell that belongs to one.
    pub fn pins(
        &self,
        mesh: &Octree,
        rim: usize,
        place: impl Fn(usize) -> Option<usize>,
    ) -> Vec<Option<usize>> {
        let mut pins = vec![None; self.len()];
        for (id, leaf, _) in mesh.live() {
            for (number, &node) in self.corners[id].iter().enumerate() {
                let pin = &mut pins[node as usize];
                if mesh.chart.is_outer(leaf.corner(number)) {
                    *pin = Some(rim);
                } else if pin.is_none() {
                    *pin = place(id);
                }
            }
        }
        pins
    }

    /// The values at a cell's corners.
    pub fn of(&self, cell: usize, values: &[f64]) -> [f64; 8] {
        self.corners[cell].map(|node| values[node as usize])
    }

    /// The value at a configuration; `None` if no cell with free configurations contains it.
    pub fn at(&self, mesh: &Octree, values: &[f64], q: &Configuration) -> Option<f64> {
        let held = mesh.holding(q);
        let &cell = held.iter().find(|&&id| mesh.leaves[id].element.is_some())?;
        let leaf = &mesh.leaves[cell];
        let place = mesh.chart.place(q);
        let period = mesh.chart.period();
        let part = std::array::from_fn(|i| {
            // The side of the period that the cell lies on.
            let middle = leaf.low[i] as f64 + leaf.size() as f64 / 2.0;
            let mut aside = place[i] - middle;
            if i > 0 {
                aside -= (aside / period[i]).round() * period[i];
            }
            (aside / leaf.size() as f64 + 0.5).clamp(0.0, 1.0)
        });
        Some(value(part, &self.of(cell, values)))
    }

    /// Values at all corners from those that do not hang.
    pub fn interpolate(&self, values: &mut [f64]) {
        for node in 0..self.len() {
            if self.is_hanging(node) {
                let sources = self.sources[node].iter();
                values[node] = sources
                    .map(|&(of, share)| share * values[of as usize])
                    .sum();
            }
        }
    }
}

/// Shares of a cell's corners in a corner that hangs on it.
type Hanging = (usize, [f64; 8]);

/// The largest cell with the place on its side but not at a corner.
fn hangs(mesh: &Octree, place: MeshPoint) -> Option<Hanging> {
    let mut largest: Option<(u8, Hanging)> = None;
    for octant in 0..8 {
        let bit = |i: usize| (octant >> i & 1) as i64;
        let unit = std::array::from_fn(|i| place[i] - bit(i));
        let Some(id) = mesh.find(unit) else { continue };
        let leaf = &mesh.leaves[id];
        if leaf.element.is_none() || largest.is_some_and(|(level, _)| level <= leaf.level) {
            continue;
        }
        let unit = mesh.chart.fold(unit, false).expect("it was found");
        let size = leaf.size();
        let aside: MeshPoint = std::array::from_fn(|i| unit[i] + bit(i) - leaf.low[i]);
        if aside.iter().any(|&units| units != 0 && units != size) {
            let part = aside.map(|units| units as f64 / size as f64);
            largest = Some((leaf.level, (id, shapes(part))));
        }
    }
    largest.map(|(_, hanging)| hanging)
}

fn resolve(
    node: usize,
    hangs: &[Option<Hanging>],
    corners: &[[u32; 8]],
    sources: &mut [Vec<(u32, f64)>],
) {
    if !sources[node].is_empty() {
        return;
    }
    let Some((cell, shares)) = &hangs[node] else {
        sources[node] = vec![(node as u32, 1.0)];
        return;
    };
    let mut all: Vec<(u32, f64)> = Vec::new();
    for (corner, share) in corners[*cell].iter().zip(shares) {
        if *share == 0.0 {
            continue;
        }
        resolve(*corner as usize, hangs, corners, sources);
        for &(of, part) in &sources[*corner as usize] {
            match all.iter_mut().find(|(known, _)| *known == of) {
                Some((_, sum)) => *sum += share * part,
                None => all.push((of, share * part)),
            }
        }
    }
    sources[node] = all;
}
