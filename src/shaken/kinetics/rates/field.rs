//! A mesh with its energies at one temperature, and its refinement.

use std::cmp::Reverse;

use ordered_float::OrderedFloat;

use crate::kinetics::mesh::{Chart, Integrator, Nodes, Octree, value};
use tiles::configuration::Configuration;
use tiles::order::Order;
use tiles::parallel;
use tiles::problem::Problem;

/// First cells from the centre to the end of the chart.
const FIRST: f64 = 32.0;
/// Largest size (m) of the cells that contain a seed.
const SEED: f64 = 4e-3;
/// Size (m) to which they are divided if no energy near the seed's was found in them, ...
const LEAST_SEED: f64 = 2e-4;
/// ... that is, one higher by at most this many kT.
const NEAR: f64 = 2.0;
/// Share of the estimated error in the cells that are divided, if the goal is far.
pub(super) const DIVIDED: f64 = 0.7;
/// Depth (in kT) below the pass at which a well is in equilibrium: the flux there is at most e^-12.
pub(super) const DEEP: f64 = 12.0;
/// The level of the barriers is updated when it has changed by this many kT.
const MOVED: f64 = 2.0;

/// A mesh with the integrals over its cells at one temperature.
pub(super) struct MeshField<'a> {
    pub mesh: Octree,
    pub kt: f64,
    /// The problem.
    pub problem: &'a Problem,
    integrator: Integrator<'a>,
}

/// Functions on an earlier, coarser mesh.
pub(super) type Earlier = (Nodes, Vec<Vec<f64>>);

impl<'a> MeshField<'a> {
    /// A mesh up to `radius` (m) at kT (J), of the motion of the moving tile or of both, with loads relative to the energy `ground` (J) and
    /// small cells around the `seeds`; their wells are not settled yet.
    pub fn new(
        problem: &'a Problem,
        (kt, both_move): (f64, bool),
        radius: f64,
        ground: f64,
        seeds: &[Configuration],
    ) -> Self {
        let chart = Chart::new(problem, radius, radius / FIRST);

        let mut field = Self {
            mesh: Octree::new(chart, problem.space.rho),
            kt,
            problem,
            integrator: Integrator::new(problem, (kt, both_move), 0.0, ground),
        };
        field.evaluate();
        loop {
            let size = |id: &usize| field.mesh.chart.depth(field.mesh.leaves[*id].level);
            let mut large = Vec::new();
            for q in seeds {
                let held = field.mesh.holding(q);
                let lowest = held.iter().map(|&id| field.mesh.lowest(id));
                let met = lowest.fold(f64::INFINITY, f64::min);
                let is_met = met < problem.energy(q) + NEAR * kt;
                let least = problem.scaled(if is_met { SEED } else { LEAST_SEED });
                large.extend(held.into_iter().filter(|id| size(id) > least));
            }
            if large.is_empty() {
                break;
            }
            field.divide(&large);
        }
        field
    }

    /// Integrates over new cells.
    pub fn evaluate(&mut self) {
        let is_new = |id: &usize| {
            let leaf = &self.mesh.leaves[*id];
            leaf.is_live() && !leaf.blocked && !leaf.seen
        };
        let new: Vec<usize> = (0..self.mesh.leaves.len()).filter(is_new).collect();
        let integrate = |&id: &usize| {
            self.integrator
                .integrate(&self.mesh.chart, &self.mesh.leaves[id])
        };
        let found: Vec<_> = parallel::map(&new, integrate);
        for (id, (element, blocked)) in new.into_iter().zip(found) {
            let leaf = &mut self.mesh.leaves[id];
            leaf.seen = true;
            leaf.element = element;
            leaf.blocked = blocked;
        }
    }

    /// The energy (J) around which weights are limited.
    pub fn level(&self) -> f64 {
        self.integrator.level
    }

    /// The energy (J) below which wells are in equilibrium.
    pub fn deep(&self) -> f64 {
        self.level() - DEEP * self.kt
    }

    /// The weight e^(-U/kT) at the level, relative to that at the ground.
    pub fn weight(&self) -> f64 {
        libm::exp((self.ground() - self.level()) / self.kt)
    }

    /// The reference energy (J) of loads.
    pub fn ground(&self) -> f64 {
        self.integrator.ground
    }

    /// Changes the energy (J) around which weights are limited, unless the change is small.
    pub fn set_level(&mut self, level: f64) {
        if (level - self.integrator.level).abs() > MOVED * self.kt {
            self.integrator.level = level;
            for leaf in &mut self.mesh.leaves {
                leaf.seen = false;
            }
            self.evaluate();
        }
    }

    /// The load (m^2 rad) of a cell below an energy (J).
    pub fn held_below(&self, id: usize, limit: f64) -> f64 {
        let leaf = &self.mesh.leaves[id];
        match &leaf.element {
            Some(element) if element.highest <= limit => element.held(),
            Some(element) if element.lowest < limit => {
                self.integrator.held_below(&self.mesh.chart, leaf, limit)
            }
            _ => 0.0,
        }
    }

    /// Divides the cells with the largest shares of an estimated error, up to a part of the total;
    /// returns whether there were any.
    pub fn refine(&mut self, shares: &[f64], part: f64) -> bool {
        let count = self.mesh.leaves.len();
        let mut order: Vec<usize> = (0..shares.len()).collect();
        order.order_by_key(|&id| Reverse(OrderedFloat(shares[id])));
        let mut left = part * shares.iter().sum::<f64>();
        let first = |id: &usize| {
            let divided = left > 0.0;
            left -= shares[*id];
            divided
        };
        let marked: Vec<usize> = order.into_iter().take_while(first).collect();
        self.divide(&marked);
        self.mesh.leaves.len() > count
    }

    /// The integral of w grad f . grad f of a function (rad).
    pub fn energy(&self, nodes: &Nodes, values: &[f64]) -> f64 {
        let energies = self
            .mesh
            .live()
            .map(|(id, _, element)| element.energy(&nodes.of(id, values)));
        energies.sum()
    }

    /// Interpolates functions from an earlier mesh.
    pub fn carry_over(&self, nodes: &Nodes, (old, functions): &Earlier) -> Vec<Vec<f64>> {
        let mut carried = vec![vec![0.0; nodes.len()]; functions.len()];
        for (id, leaf, _) in self.mesh.live() {
            let mut ancestor = Some(id);
            while let Some(cell) = ancestor.filter(|&cell| !old.know(cell)) {
                ancestor = self.mesh.leaves[cell].parent.map(|parent| parent as usize);
            }
            let Some(ancestor) = ancestor else { continue };
            let large = &self.mesh.leaves[ancestor];
            for (number, &node) in nodes.corners[id].iter().enumerate() {
                let place = leaf.corner(number);
                let aside = |i: usize| (place[i] - large.low[i]) as f64;
                let part = std::array::from_fn(|i| aside(i) / large.size() as f64);
                for (new, values) in carried.iter_mut().zip(functions) {
                    new[node as usize] = value(part, &old.of(ancestor, values));
                }
            }
        }
        carried
    }
}
