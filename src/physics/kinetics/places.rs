//! Basins and `free` on a mesh, and the rates between them computed from the mesh.

use super::bracket::{Asked, Bracket};
use super::certify::Step;
use super::field::{DEEP, Earlier, Field};
use super::mesh::{Nodes, System, Unsolved, loads};
use super::results::{Basin, MeshRates, RateBounds, RateSettings, RatesError};
use super::rim::Rims;
use super::sets::{basin, pass, reaching};

/// Rates that are at least this share of the total rate out of a basin are bounded to the requested
/// accuracy.
const MATTERS: f64 = 0.1;

/// The assignment of cells to basins.
pub(super) struct Places {
    of: Vec<Option<usize>>,
    /// The energy limits (J) of the basins.
    limits: Vec<f64>,
    /// For each basin the cells that it extends into.
    reached: Vec<Vec<usize>>,
    /// Which basins have no path out on the mesh.
    pub closed: Vec<bool>,
    /// The number of places, including `free`.
    pub count: usize,
    /// Cells shared by two basins, with the limit (J) of the later one.
    pub shared: Vec<(usize, f64)>,
}

impl Places {
    pub fn new(field: &mut Field, settings: &RateSettings) -> Result<Self, RatesError> {
        let beside = field.mesh.neighbours();
        let basins = &settings.basins;
        // Equal tiles can exchange their places.
        let around = |field: &Field, basin: &Basin, limit: f64| {
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
            reached: Vec::new(),
            closed,
            count: wells.len() + 1,
            shared: Vec::new(),
        };
        for (number, (basin, pass)) in basins.iter().zip(passes).enumerate() {
            let limit = basin.below.max(pass - DEEP * settings.kt);
            places.limits.push(limit);
            let reached = reaching(&field.mesh, &beside, &basin.at, limit);
            places.reached.push(reached);
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
    pub fn rims(&self, field: &Field) -> Rims {
        let limit = |place: &Option<usize>| place.map(|place| self.limits[place]);
        Rims::new(field, &self.of.iter().map(limit).collect::<Vec<_>>())
    }

    /// For each corner the place where its value is given.
    fn pins(&self, field: &Field, nodes: &Nodes) -> Vec<Option<usize>> {
        nodes.pins(&field.mesh, self.count - 1, |id| self.of[id])
    }

    /// The rates on a mesh, and the committors of all places. `beyond` is the occupation of the table
    /// outside the mesh.
    pub fn solve(
        &self,
        field: &Field,
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
    pub fn inside(&self, field: &Field, settings: &RateSettings, beyond: f64) -> Vec<f64> {
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
    pub fn committor(&self, field: &Field, nodes: &Nodes) -> Result<Vec<f64>, Unsolved> {
        let mut pins = self.pins(field, nodes);
        for pin in &mut pins {
            *pin = pin.filter(|place| *place == 0 || *place + 1 == self.count);
        }
        let system = System::new(&field.mesh, nodes, &pins);
        let [found] = system.solve([system.committor(0, None)])?;
        Ok(found)
    }

    /// Upper bounds of the rates out of each place, then of those from each place to each other,
    /// divided by D (1/m^2), for any outline: trial committors can extend through contact, fluxes
    /// cannot. The occupation of a place is at least that of its cells below its limit: all except
    /// their volume times the weight there.
    pub fn upper_bounds(
        &self,
        field: &Field,
        nodes: &Nodes,
        beyond: f64,
        committors: &[Vec<f64>],
    ) -> RateBounds {
        let copies = field.mesh.chart.copies as f64;
        let scale = copies * field.weight();
        // Where nothing leaves, only rounding errors of either sign remain.
        let capacity = |place: usize| match self.is_closed(place) {
            true => 0.0,
            false => field.energy(nodes, &committors[place]).max(0.0),
        };
        let capacities: Vec<f64> = (0..self.count).map(capacity).collect();
        let held = |place: usize| -> f64 {
            let Some(limit) = self.limits.get(place) else {
                return beyond;
            };
            let rim = libm::exp((field.ground() - limit) / field.kt);
            let below = |&id: &usize| {
                let element = field.mesh.leaves[id].element.as_ref();
                element.map_or(0.0, |it| (it.held() - rim * it.free).max(0.0))
            };
            // If that is zero, bounds are infinite.
            let own = self.reached[place].iter().map(below);
            (copies * own.sum::<f64>()).max(f64::MIN_POSITIVE)
        };
        let held: Vec<f64> = (0..self.count).map(held).collect();
        let most = |capacity: f64, place: usize| [0.0, scale * capacity / held[place]];
        RateBounds {
            leaving: (0..self.count).map(|i| most(capacities[i], i)).collect(),
            rates: self.every_two(|i, j| most(capacities[i].min(capacities[j]), i)),
        }
    }

    /// Bounds of the rates out of each place, then of those from each place to each other, divided
    /// by D (1/m^2), and the contribution of each cell to their width. `beyond` is the occupation
    /// of the table outside the mesh.
    pub fn bounds(&self, field: &Field, nodes: &Nodes, beyond: f64) -> Result<Step, Unsolved> {
        let asked = Asked {
            field,
            nodes,
            pins: &self.pins(field, nodes),
            rim: self.count - 1,
            rims: &self.rims(field),
            left_out: &vec![false; field.mesh.leaves.len()],
        };
        let bracket = Bracket::new(&asked, self.count)?;
        let copies = field.mesh.chart.copies as f64;
        let scale = copies * field.weight();
        let places = 0..self.count;
        let rest = |place: usize| if place + 1 == self.count { beyond } else { 0.0 };
        let occupation = |place| copies * bracket.occupation(place) + rest(place);
        let held: Vec<f64> = places.clone().map(occupation).collect();
        let rates = self.every_two(|i, j| match i == j {
            true => 0.0,
            false => scale * bracket.flow(i, j) / held[i],
        });
        let leaving = |place: usize| {
            let [least, most] = bracket.ratio(place, rest(place) / copies);
            [scale / copies / most, scale / copies / least]
        };
        let mut bounds: Vec<[f64; 2]> = places.clone().map(leaving).collect();
        let wells = 0..self.count - 1;
        let matters =
            |i: usize, j: usize| i != j && rates[i][j] >= MATTERS * rates[i].iter().sum::<f64>();
        let pairs: Vec<(usize, usize)> = wells
            .clone()
            .flat_map(|i| places.clone().map(move |j| (i, j)))
            .filter(|&(i, j)| matters(i, j))
            .collect();
        let mut shares = bracket.shares(&pairs);
        if !self.shared.is_empty() {
            // Basins that the mesh does not distinguish.
            bounds[0] = [0.0, f64::INFINITY];
            for &(cell, _) in &self.shared {
                shares[cell] = f64::MAX.sqrt();
            }
        }
        let widest = |far: f64, [lower, upper]: &[f64; 2]| far.max(upper / lower - 1.0);
        let error = bounds[..self.count - 1].iter().fold(0.0, widest);
        let all: f64 = held.iter().sum();
        let rate = |i: usize, j| {
            let bounds = bracket.rate(i, j, rest(i) / copies);
            bounds.map(|rate| scale / copies * rate)
        };
        bounds.extend(self.every_two(rate).into_iter().flatten());
        let at = |&(i, j): &(usize, usize)| self.count * (i + 1) + j;
        let deciding = wells.chain(pairs.iter().map(at)).collect();
        Ok(Step {
            bounds,
            deciding,
            unknowns: nodes.len(),
            shares,
            rates: Some(MeshRates {
                rates,
                occupation: held.iter().map(|own| own / all).collect(),
                volumes: held,
                unknowns: nodes.len(),
                error,
                of_rims: bracket.off_by_rims(),
            }),
        })
    }
}
