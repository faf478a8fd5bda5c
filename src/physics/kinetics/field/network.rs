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
    /// The last distribution of fluxes, if it was the same for the whole mesh.
    profile: Option<Profile>,
    /// The cost of fluxes in each cell (1/rad), for a distribution.
    known: Vec<Option<(Spread, Box<Resistance>)>>,
}

impl Field<'_> {
    /// The average decay of a function's flux along contact with the distance.
    fn profile(&self, nodes: &Nodes, values: &[f64]) -> Profile {
        let (mut sum, mut all) = (0.0, 0.0);
        for (id, leaf, element) in self.mesh.live().filter(|(_, leaf, _)| leaf.low[0] == 0) {
            let energy = element.energy(&nodes.of(id, values));
            let [_, phi, theta] = self.mesh.chart.coordinates(leaf.at([0.5; 3]));
            let ray = self.mesh.chart.ray([phi, theta]);
            let potential = self.problem.potential();
            let (_, slope) = potential.energy_and_gradient(&ray.configuration(0.0));
            let rate = (slope.x * libm::cos(phi) + slope.y * libm::sin(phi)) * ray.length / self.kt;
            if rate.is_finite() {
                sum += energy * rate.max(0.0);
                all += energy;
            }
        }
        Profile::layer(if all > 0.0 { sum / all } else { 0.0 })
    }

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
        self.spread(&mut costs, &spreads, &place, &|_| false, rim)
    }

    /// Undivided cells with free configurations that satisfy a condition.
    fn live(&self, holds: impl Fn(usize) -> bool) -> Vec<usize> {
        let cells = self.mesh.live().map(|(id, ..)| id);
        cells.filter(|&id| holds(id)).collect()
    }

    /// The cells as conductors of fluxes with a given distribution.
    fn spread(
        &self,
        Costs { known, .. }: &mut Costs,
        spreads: &[Spread],
        place: &dyn Fn(usize) -> Option<usize>,
        is_left_out: &dyn Fn(usize) -> bool,
        rim: usize,
    ) -> Option<Network> {
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
        Network::new(&self.mesh, place, is_left_out, rim, known)
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

    /// The cells as conductors between places given by their cells, without the omitted cells, for
    /// fluxes similar to a function's; fluxes have the same distribution over the whole mesh.
    pub fn network_between(
        &self,
        nodes: &Nodes,
        place: &dyn Fn(usize) -> Option<usize>,
        is_left_out: &dyn Fn(usize) -> bool,
        rim: usize,
        like: &[f64],
    ) -> Option<(Network, Profile)> {
        let found = self.profile(nodes, like);
        let mut costs = self.costs.lock().unwrap_or_else(PoisonError::into_inner);
        let known = costs.profile.filter(|known| known.is_like(&found));
        let profile = *costs.profile.insert(known.unwrap_or(found));
        let spreads = vec![Spread::even(profile); self.mesh.leaves.len()];
        let network = self.spread(&mut costs, &spreads, place, is_left_out, rim)?;
        Some((network, profile))
    }
}
