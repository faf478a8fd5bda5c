//! The cells of a mesh as conductors of fluxes.

use std::sync::{MutexGuard, PoisonError};

use nalgebra::Matrix6;
use rayon::prelude::*;

use super::Field;
use crate::kinetics::mesh::{Network, Nodes, Profile};

/// What fluxes cost in cells (1/rad), as far as it is known, for fluxes spread as a profile says.
#[derive(Default)]
pub(super) struct Costs {
    profile: Option<Profile>,
    of: Vec<Option<Box<Matrix6<f64>>>>,
}

impl Field<'_> {
    /// How a function's flux along contact falls off with the distance, on average.
    pub fn profile(&self, nodes: &Nodes, values: &[f64]) -> Profile {
        let (mut sum, mut all) = (0.0, 0.0);
        for (id, leaf, element) in self.mesh.live().filter(|(_, leaf, _)| leaf.low[0] == 0) {
            let energy = element.energy(&nodes.of(id, values));
            let middle = leaf.low.map(|low| (low + leaf.size() / 2) as f64);
            let [_, phi, theta] = self.mesh.chart.coordinates(middle);
            let ray = self.mesh.chart.ray([phi, theta]);
            let (_, slope) = self
                .problem
                .potential()
                .energy_and_gradient(&ray.configuration(0.0));
            let rate = (slope.x * phi.cos() + slope.y * phi.sin()) * ray.length / self.kt;
            if rate.is_finite() {
                sum += energy * rate.max(0.0);
                all += energy;
            }
        }
        Profile {
            rate: if all > 0.0 { sum / all } else { 0.0 },
        }
    }

    /// The cells as conductors between places, for fluxes like a function's.
    pub fn network(
        &self,
        nodes: &Nodes,
        pins: &[Option<usize>],
        rim: usize,
        like: &[f64],
    ) -> Option<Network> {
        let (profile, costs) = self.costs(nodes, like);
        Network::new(&self.mesh, nodes, pins, rim, profile, &costs.of)
    }

    /// The same between places given by the cells that they are made of, through none of the cells
    /// left out, with how fluxes are spread.
    pub fn network_between(
        &self,
        nodes: &Nodes,
        place: &dyn Fn(usize) -> Option<usize>,
        is_left_out: &dyn Fn(usize) -> bool,
        rim: usize,
        like: &[f64],
    ) -> Option<(Network, Profile)> {
        let (profile, costs) = self.costs(nodes, like);
        let network = Network::between(&self.mesh, place, is_left_out, rim, profile, &costs.of)?;
        Some((network, profile))
    }

    /// What fluxes like a function's cost in all cells.
    fn costs(&self, nodes: &Nodes, like: &[f64]) -> (Profile, MutexGuard<'_, Costs>) {
        let found = self.profile(nodes, like);
        let mut costs = self.costs.lock().unwrap_or_else(PoisonError::into_inner);
        let profile = costs.profile.filter(|known| known.is_like(&found));
        let profile = profile.unwrap_or_else(|| {
            costs.of.clear();
            *costs.profile.insert(found)
        });
        costs.of.resize(self.mesh.leaves.len(), None);
        let is_known = |id: &usize| costs.of[*id].is_some();
        let cells = self.mesh.live().map(|(id, ..)| id);
        let new: Vec<usize> = cells.filter(|id| !is_known(id)).collect();
        let resistance = |&id: &usize| {
            let leaf = &self.mesh.leaves[id];
            Box::new(self.integrator.resistance(&self.mesh.chart, leaf, &profile))
        };
        let found: Vec<_> = new.par_iter().map(resistance).collect();
        for (id, cost) in new.into_iter().zip(found) {
            costs.of[id] = Some(cost);
        }
        (profile, costs)
    }
}
