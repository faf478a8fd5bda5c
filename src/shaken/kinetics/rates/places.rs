//! Basins and `free` on a mesh, and the rates between them computed from the mesh.

use super::field::{DEEP, Earlier, MeshField};
use super::results::{Basin, MeshRates, RateSettings, RatesError};
use super::rim::Rims;
use super::sets::{basin, pass, reaching};
use crate::kinetics::mesh::{Nodes, System, Unsolved, loads};

/// The assignment of cells to basins.
pub(super) struct Places {
    of: Vec<Option<usize>>,
    /// The energy limits (J) of the basins.
    limits: Vec<f64>,
    /// Which basins have no path out on the mesh.
    pub closed: Vec<bool>,
    /// The number of places, including `free`.
    pub count: usize,
    /// Cells shared by two basins, with the limit (J) of the later one.
    pub shared: Vec<(usize, f64)>,
}

impl Places {
    pub fn new(field: &mut MeshField, settings: &RateSettings) -> Result<Self, RatesError> {
        let beside = field.mesh.neighbours();
        let basins = &settings.basins;
        // Equal tiles can exchange their places.
        let around = |field: &MeshField, basin: &Basin, limit: f64| {
            let mut inside = self::basin(&field.mesh, &beside, &basin.at, limit);
            let image = field.problem.exchange.map(|map| map.apply(&basin.at));
            if let Some(image) =
                image.filter(|q| !field.mesh.holding(q).iter().any(|&id| inside[id]))
            {
                let more = self::basin(&field.mesh, &beside, &image, limit);
                inside
                    .iter_mut()
                    .zip(more)
                    .for_each(|(known, more)| *known |= more);
            }
            inside
        };
        let wells: Vec<Vec<bool>> = basins
            .iter()
            .map(|basin| around(field, basin, basin.below))
            .collect();
        let mesh = &field.mesh;
        let is_rim = |well: &Vec<bool>| (0..well.len()).any(|id| well[id] && mesh.is_outer(id));
        if wells.iter().any(is_rim) {
            return Err(RatesError::NoFree(settings.free_at));
        }
        let to_others = |own: usize| {
            let is_other = |id: usize| (0..wells.len()).any(|k| k != own && wells[k][id]);
            let ends = |id: usize| mesh.is_outer(id) || is_other(id);
            pass(mesh, &beside, &basins[own].at, &ends)
        };
        let passes: Vec<Option<f64>> = (0..wells.len()).map(to_others).collect();
        let closed = passes.iter().map(Option::is_none).collect();
        let passes: Vec<f64> = passes.iter().map(|pass| pass.unwrap_or(0.0)).collect();
        field.set_level(passes.iter().copied().fold(f64::INFINITY, f64::min));
        let mut places = Self {
            of: vec![None; field.mesh.leaves.len()],
            limits: Vec::new(),
            closed,
            count: wells.len() + 1,
            shared: Vec::new(),
        };
        for (number, (basin, pass)) in basins.iter().zip(passes).enumerate() {
            let limit = basin.below.max(pass - DEEP * settings.kt);
            places.limits.push(limit);
            let inside = around(field, basin, limit);
            for id in (0..inside.len()).filter(|&id| inside[id]) {
                match places.of[id] {
                    Some(_) => places.shared.push((id, limit)),
                    None => places.of[id] = Some(number),
                }
            }
        }
        Ok(places)
    }

    /// Whether a place is a basin without a path out on the mesh.
    fn is_closed(&self, place: usize) -> bool {
        self.closed.get(place) == Some(&true)
    }

    /// The rims of the basins.
    pub fn rims(&self, field: &MeshField) -> Rims {
        let limit = |place: &Option<usize>| place.map(|place| self.limits[place]);
        Rims::new(field, &self.of.iter().map(limit).collect::<Vec<_>>())
    }

    /// For each corner the place where its value is given.
    fn pins(&self, field: &MeshField, nodes: &Nodes) -> Vec<Option<usize>> {
        nodes.pins(&field.mesh, self.count - 1, |id| self.of[id])
    }

    /// The rates on a mesh, and the committors of all places. `beyond` is the occupation of the table
    /// outside the mesh.
    pub fn solve(
        &self,
        field: &MeshField,
        nodes: &Nodes,
        beyond: f64,
        earlier: Option<&Earlier>,
    ) -> Result<(MeshRates, Vec<Vec<f64>>), Unsolved> {
        let pins = self.pins(field, nodes);
        let system = System::new(&field.mesh, nodes, &pins);
        let guesses = earlier.map(|earlier| field.carry_over(nodes, earlier));
        let guess = |place: usize| guesses.as_ref().map(|guesses| &guesses[place]);
        let last = self.count - 1;
        let sought = (0..last).map(|place| system.committor(place, guess(place)));
        let mut committors = system.solve_all(&sought.collect::<Vec<_>>())?;
        let flows: Vec<Vec<f64>> = committors
            .iter()
            .map(|committor| system.flows(committor, self.count))
            .collect();
        let rest = |node: usize| 1.0 - committors.iter().map(|h| h[node]).sum::<f64>();
        committors.push((0..nodes.len()).map(rest).collect());
        let copies = field.mesh.chart.copies as f64;
        let occupied = |place: usize| -> f64 {
            // The part of cells at its rim that belongs to another place is not counted.
            let is_others = |of: &Option<usize>| of.is_some_and(|of| of != place);
            let others: Vec<bool> = self.of.iter().map(is_others).collect();
            let loads = loads(&field.mesh, nodes, &others);
            let parts = loads.iter().zip(&committors[place]);
            let sum: f64 = parts.map(|(load, part)| load * part).sum();
            copies * sum + if place == last { beyond } else { 0.0 }
        };
        let occupations: Vec<f64> = (0..self.count).map(occupied).collect();
        // Symmetrised, to remove rounding errors.
        let flow = |i: usize, j: usize| match (i == last, j == last) {
            _ if i == j || self.is_closed(i) || self.is_closed(j) => 0.0,
            (true, _) => flows[j][i],
            (_, true) => flows[i][j],
            _ => 0.5 * (flows[i][j] + flows[j][i]),
        };
        let scale = copies * field.weight();
        let rate = |from: usize, to: usize| (scale * flow(from, to) / occupations[from]).max(0.0);
        let all: f64 = occupations.iter().sum();
        let found = MeshRates {
            rates: self.every_two(rate),
            occupation: occupations.iter().map(|own| own / all).collect(),
            volumes: occupations,
            unknowns: system.len(),
            error: f64::INFINITY,
            of_rims: f64::INFINITY,
        };
        Ok((found, committors))
    }

    /// A table of a quantity from each place (row) to each other.
    fn every_two<T>(&self, of: impl Fn(usize, usize) -> T) -> Vec<Vec<T>> {
        let places = 0..self.count;
        let row = |from: usize| places.clone().map(|to| of(from, to)).collect();
        places.clone().map(row).collect()
    }

    /// The occupation of each place itself (m^2 rad): of a basin below its limit, where committors
    /// are 1.
    pub fn inside(&self, field: &MeshField, settings: &RateSettings, beyond: f64) -> Vec<f64> {
        let beside = field.mesh.neighbours();
        let copies = field.mesh.chart.copies as f64;
        let held = |basin: &Basin| -> f64 {
            let reached = reaching(&field.mesh, &beside, &basin.at, basin.below);
            let parts = reached.iter().map(|&id| field.held_below(id, basin.below));
            // The sum of nothing is -0.
            copies * parts.sum::<f64>() + 0.0
        };
        let inside = settings.basins.iter().map(held);
        inside.chain([beyond]).collect()
    }

    /// The probability that the first place, the bond, is reached before `free`, with the other
    /// places treated like any configuration.
    pub fn committor(&self, field: &MeshField, nodes: &Nodes) -> Result<Vec<f64>, Unsolved> {
        let mut pins = self.pins(field, nodes);
        for pin in &mut pins {
            *pin = pin.filter(|place| *place == 0 || *place + 1 == self.count);
        }
        let system = System::new(&field.mesh, nodes, &pins);
        let [found] = system.solve([system.committor(0, None)])?;
        Ok(found)
    }
}
