//! The cells of a mesh as conductors of fluxes.

use std::sync::{MutexGuard, PoisonError};

use super::Field;
use crate::kinetics::mesh::{Network, Nodes, Profile, Resistance, Spread, spreads};
use crate::parallel;

/// Powers of e by which the density of a flux falls over a cell, at most: over more of them it would
/// hardly follow.
const MOST: f64 = 4.0;

/// What fluxes cost in cells (1/rad), as far as it is known.
#[derive(Default)]
pub(super) struct Costs {
    /// Spread as one profile says for the whole mesh: it, and what they cost.
    layer: (Option<Profile>, Vec<Option<Box<Resistance>>>),
    /// Spread as the energy is: how that is from each cell, over its sides in the end, and the costs.
    own: Vec<Option<Spread>>,
    spreads: Vec<Spread>,
    local: Vec<Option<Box<Resistance>>>,
}

impl Field<'_> {
    /// How a function's flux along contact falls off with the distance, on average.
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

    /// The cells as conductors between the places that corners belong to, and the rim, for fluxes that follow e^(-U/kT) along s.
    pub fn network(&self, nodes: &Nodes, pins: &[Option<usize>], rim: usize) -> Option<Network> {
        let mut costs = self.costs.lock().unwrap_or_else(PoisonError::into_inner);
        let count = self.mesh.leaves.len();
        costs.own.resize(count, None);
        let is_known = |id: &usize| costs.own[*id].is_some();
        let cells = self.mesh.live().map(|(id, ..)| id);
        let new: Vec<usize> = cells.filter(|id| !is_known(id)).collect();
        let found: Vec<_> = parallel::map(&new, |&id| self.falls(id));
        for (id, spread) in new.into_iter().zip(found) {
            costs.own[id] = Some(spread);
        }
        let spreads = spreads(&self.mesh, &costs.own);
        costs.local.resize(count, None);
        costs.spreads.resize(count, Spread::default());
        let is_new = |id: &usize| costs.local[*id].is_none() || costs.spreads[*id] != spreads[*id];
        let cells = self.mesh.live().map(|(id, ..)| id);
        let new: Vec<usize> = cells.filter(is_new).collect();
        let found = self.resistances(&new, |id| spreads[id]);
        for (id, cost) in new.into_iter().zip(found) {
            costs.local[id] = Some(Box::new(cost));
        }
        costs.spreads = spreads;
        // A function that is 1 at a place's corners is so all over the cells that have no others.
        let place = |id: usize| -> Option<usize> {
            let corners = nodes.corners[id].iter();
            let sources = corners.flat_map(|&n| &nodes.sources[n as usize]);
            let mut places = sources.map(|&(of, _)| pins[of as usize]);
            let first = places.next()??;
            places.all(|other| other == Some(first)).then_some(first)
        };
        let (spreads, costs) = (&costs.spreads, &costs.local);
        Network::new(&self.mesh, &place, &|_| false, rim, spreads, costs)
    }

    /// How e^(-U/kT) falls along s in the middles of a cell's sides 2 to 5 and in its own.
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

    fn resistances(
        &self,
        cells: &[usize],
        spread: impl Fn(usize) -> Spread + Sync,
    ) -> Vec<Resistance> {
        let resistance = |&id: &usize| {
            let leaf = &self.mesh.leaves[id];
            self.integrator
                .resistance(&self.mesh.chart, leaf, &spread(id))
        };
        parallel::map(cells, resistance)
    }

    /// The cells as conductors between places given by the cells that they are made of, through none
    /// of the cells left out, for fluxes like a function's; with how fluxes are spread, all over the
    /// mesh in the same way.
    pub fn network_between(
        &self,
        nodes: &Nodes,
        place: &dyn Fn(usize) -> Option<usize>,
        is_left_out: &dyn Fn(usize) -> bool,
        rim: usize,
        like: &[f64],
    ) -> Option<(Network, Profile)> {
        let (profile, costs) = self.costs(nodes, like);
        let spreads = vec![Spread::even(profile); self.mesh.leaves.len()];
        let (mesh, known) = (&self.mesh, &costs.layer.1);
        let network = Network::new(mesh, place, is_left_out, rim, &spreads, known)?;
        Some((network, profile))
    }

    /// What fluxes like a function's cost in all cells.
    fn costs(&self, nodes: &Nodes, like: &[f64]) -> (Profile, MutexGuard<'_, Costs>) {
        let found = self.profile(nodes, like);
        let mut costs = self.costs.lock().unwrap_or_else(PoisonError::into_inner);
        let (known, of) = &mut costs.layer;
        let profile = known.filter(|known| known.is_like(&found));
        let profile = profile.unwrap_or_else(|| {
            of.clear();
            *known.insert(found)
        });
        of.resize(self.mesh.leaves.len(), None);
        let cells = self.mesh.live().map(|(id, ..)| id);
        let new: Vec<usize> = cells.filter(|id| of[*id].is_none()).collect();
        let found = self.resistances(&new, |_| Spread::even(profile));
        for (id, cost) in new.into_iter().zip(found) {
            of[id] = Some(Box::new(cost));
        }
        (profile, costs)
    }
}
