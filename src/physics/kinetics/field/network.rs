//! The cells of a mesh as a network of conductors.

use std::sync::PoisonError;

use super::Field;
use crate::kinetics::mesh::{Network, Nodes, Profile, Resistance, Spread, spreads};
use crate::parallel;

/// Largest decrease of the density of a flux over a cell, in powers of e: it would hardly follow a
/// stronger one.
const MOST: f64 = 4.0;

/// Cached costs of fluxes in cells.
#[derive(Default)]
pub(super) struct Costs {
    /// The decay of e^(-U/kT) in each cell.
    own: Vec<Option<Spread>>,
    /// The cost of fluxes in each cell (1/rad), for a distribution.
    known: Vec<Option<(Spread, Box<Resistance>)>>,
}

impl Field<'_> {
    /// The cells as conductors between the places of corners and the rim, for fluxes that follow
    /// e^(-U/kT) along s.
    pub fn network(&self, nodes: &Nodes, pins: &[Option<usize>], rim: usize) -> Option<Network> {
        let mut costs = self.costs.lock().unwrap_or_else(PoisonError::into_inner);
        costs.own.resize(self.mesh.leaves.len(), None);
        let new = self.live(|id| costs.own[id].is_none());
        let found = parallel::map(&new, |&id| Some(self.falls(id)));
        for (id, spread) in new.into_iter().zip(found) {
            costs.own[id] = spread;
        }
        // A function that is 1 at a place's corners is 1 throughout the cells that have no other
        // corners.
        let place = |id: usize| -> Option<usize> {
            let corners = nodes.corners[id].iter();
            let sources = corners.flat_map(|&n| &nodes.sources[n as usize]);
            let mut places = sources.map(|&(of, _)| pins[of as usize]);
            let first = places.next()??;
            places.all(|other| other == Some(first)).then_some(first)
        };
        let spreads = spreads(&self.mesh, &costs.own);
        let known = &mut costs.known;
        known.resize_with(spreads.len(), || None);
        let new = self.live(|id| known[id].as_ref().is_none_or(|it| it.0 != spreads[id]));
        let found = parallel::map(&new, |&id| {
            let (chart, leaf) = (&self.mesh.chart, &self.mesh.leaves[id]);
            let cost = self.integrator.resistance(chart, leaf, &spreads[id]);
            Some((spreads[id], Box::new(cost)))
        });
        for (id, cost) in new.into_iter().zip(found) {
            known[id] = cost;
        }
        Network::new(&self.mesh, &place, rim, known)
    }

    /// Undivided cells with free configurations that satisfy a condition.
    fn live(&self, holds: impl Fn(usize) -> bool) -> Vec<usize> {
        let cells = self.mesh.live().map(|(id, ..)| id);
        cells.filter(|&id| holds(id)).collect()
    }

    /// The decay of e^(-U/kT) along s in the middles of a cell's sides 2 to 5 and in its centre.
    fn falls(&self, id: usize) -> Spread {
        let leaf = &self.mesh.leaves[id];
        let chart = &self.mesh.chart;
        let ends = leaf.along(chart);
        let at = |aside: [f64; 2]| {
            let [_, phi, theta] = chart.coordinates(leaf.at([0.0, aside[0], aside[1]]));
            let qs = chart.places([phi, theta], ends);
            let weight = |q| self.integrator.power(self.problem.energy(&q));
            let [near, far] = qs.map(weight);
            Profile::falling((near - far).clamp(-MOST, MOST), ends)
        };
        let sides = [[0.0, 0.5], [1.0, 0.5], [0.5, 0.0], [0.5, 1.0], [0.5, 0.5]];
        Spread {
            profiles: sides.map(at),
            tilts: leaf.element.as_ref().map_or([0.0; 2], |it| it.tilts()),
        }
    }
}
