//! Basins and `free` on a mesh, and the rates between them that the mesh says.

use super::bracket::{Asked, Bounded, Bracket};
use super::certify::Step;
use super::field::{DEEP, Earlier, Field};
use super::mesh::{Nodes, System, Unsolved, loads};
use super::results::{Basin, MeshRates, RateBounds, RateSettings, RatesError};
use super::rim::Rims;
use super::sets::{basin, pass, reaching, rim};

/// Rates that make up this share of all that leaves a basin are bounded as closely as it is asked.
const MATTERS: f64 = 0.1;

/// Which cell belongs to which basin.
pub(super) struct Places {
    of: Vec<Option<usize>>,
    /// Below which energies (J) the basins lie.
    limits: Vec<f64>,
    /// For each basin the cells that it reaches into.
    reached: Vec<Vec<usize>>,
    /// Which basins the mesh has no way out of.
    pub closed: Vec<bool>,
    /// How many places there are, `free` among them.
    pub count: usize,
    /// Cells that two basins reach into, with the limit (J) of the later one.
    pub shared: Vec<(usize, f64)>,
}

impl Places {
    pub fn new(field: &mut Field, settings: &RateSettings) -> Result<Self, RatesError> {
        let beside = field.mesh.neighbours();
        let around = |field: &Field, basin: &Basin, limit: f64| {
            let held = field.mesh.holding(&basin.at);
            self::basin(&field.mesh, &beside, &held, limit)
        };
        let rim = rim(&field.mesh);
        let wells: Vec<Vec<bool>> = settings
            .basins
            .iter()
            .map(|basin| around(field, basin, basin.below))
            .collect();
        let reaches_rim = |well: &Vec<bool>| well.iter().zip(&rim).any(|(well, rim)| *well && *rim);
        if wells.iter().any(reaches_rim) {
            return Err(RatesError::NoFree(settings.free_at));
        }
        let passes: Vec<Option<f64>> = (0..wells.len())
            .map(|own| {
                let others = wells.iter().enumerate().filter(|(k, _)| *k != own);
                let ends = |id: usize| rim[id] || others.clone().any(|(_, well)| well[id]);
                let from = field.mesh.holding(&settings.basins[own].at);
                pass(&field.mesh, &beside, &from, &ends)
            })
            .collect();
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
        for (number, (basin, pass)) in settings.basins.iter().zip(passes).enumerate() {
            let limit = basin.below.max(pass - DEEP * settings.kt);
            places.limits.push(limit);
            let held = field.mesh.holding(&basin.at);
            let reached = reaching(&field.mesh, &beside, &held, limit);
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

    /// The rims of the basins.
    pub fn rims(&self, field: &Field) -> Rims {
        let limits: Vec<_> = self
            .of
            .iter()
            .map(|place| place.map(|place| self.limits[place]))
            .collect();
        Rims::new(field, &limits)
    }

    /// For each corner the place in which its value is given.
    fn pins(&self, field: &Field, nodes: &Nodes) -> Vec<Option<usize>> {
        nodes.pins(&field.mesh, self.count - 1, |id| self.of[id])
    }

    /// The rates on a mesh, and the committors of all places but `free`. `beyond` is the occupation
    /// of the table outside the mesh.
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
        let committors: Vec<Vec<f64>> = (0..self.count - 1)
            .map(|place| system.committor(place, guess(place)))
            .collect::<Result<_, _>>()?;
        let copies = field.mesh.chart.copies() as f64;
        let occupied = |place: usize| -> f64 {
            // What is another place's in cells at its rim is not counted.
            let others: Vec<bool> = self
                .of
                .iter()
                .map(|of| of.is_some_and(|of| of != place))
                .collect();
            let loads = loads(&field.mesh, nodes, &others);
            let part = |node: usize| match committors.get(place) {
                Some(committor) => committor[node],
                None => 1.0 - committors.iter().map(|h| h[node]).sum::<f64>(),
            };
            let sum: f64 = (0..nodes.len()).map(|node| loads[node] * part(node)).sum();
            copies * sum + if place + 1 == self.count { beyond } else { 0.0 }
        };
        let occupations: Vec<f64> = (0..self.count).map(occupied).collect();
        let mut flows = vec![vec![0.0; self.count]; self.count];
        for (from, committor) in committors.iter().enumerate() {
            for (pin, flux) in pins.iter().zip(system.fluxes(committor)) {
                if let Some(to) = pin.filter(|&to| to != from) {
                    flows[from][to] -= flux;
                }
            }
        }
        let last = self.count - 1;
        // As symmetric as they are without rounding.
        let is_closed = |place: usize| self.closed.get(place) == Some(&true);
        let flow = |i: usize, j: usize| match (i == last, j == last) {
            _ if is_closed(i) || is_closed(j) => 0.0,
            (true, true) => 0.0,
            (true, false) => flows[j][i],
            (false, true) => flows[i][j],
            (false, false) => 0.5 * (flows[i][j] + flows[j][i]),
        };
        let scale = copies * field.weight();
        let rate = |from: usize, to: usize| (scale * flow(from, to) / occupations[from]).max(0.0);
        let all: f64 = occupations.iter().sum();
        let found = MeshRates {
            rates: (0..self.count)
                .map(|from| (0..self.count).map(|to| rate(from, to)).collect())
                .collect(),
            occupation: occupations.iter().map(|own| own / all).collect(),
            volumes: occupations,
            unknowns: system.len(),
            error: f64::INFINITY,
            of_rims: f64::INFINITY,
        };
        Ok((found, committors))
    }

    /// What each place holds itself (m^2 rad): a basin below its limit, wherever committors are 1.
    pub fn inside(&self, field: &Field, settings: &RateSettings, beyond: f64) -> Vec<f64> {
        let beside = field.mesh.neighbours();
        let copies = field.mesh.chart.copies() as f64;
        let held = |basin: &Basin| -> f64 {
            let from = field.mesh.holding(&basin.at);
            let reached = reaching(&field.mesh, &beside, &from, basin.below);
            let parts = reached.iter().map(|&id| field.held_below(id, basin.below));
            // Of nothing the sum is a negative nothing.
            copies * parts.sum::<f64>() + 0.0
        };
        let inside = settings.basins.iter().map(held);
        inside.chain([beyond]).collect()
    }

    /// The probability that the first place, the bond, is reached before `free`, where the others are
    /// places like any.
    pub fn committor(&self, field: &Field, nodes: &Nodes) -> Result<Vec<f64>, Unsolved> {
        let mut pins = self.pins(field, nodes);
        for pin in &mut pins {
            *pin = pin.filter(|place| *place == 0 || *place + 1 == self.count);
        }
        System::new(&field.mesh, nodes, &pins).committor(0, None)
    }

    /// Bounds from above of the rates out of each place, then of those from each place to each other,
    /// divided by D (1/m^2), for any outline: trial committors may reach through contact, fluxes may
    /// not. A place is occupied for no less than what the cells that it reaches into hold below its
    /// limit: all but their volume times the weight there.
    pub fn upper_bounds(
        &self,
        field: &Field,
        nodes: &Nodes,
        beyond: f64,
        committors: &[Vec<f64>],
    ) -> RateBounds {
        let copies = field.mesh.chart.copies() as f64;
        let scale = copies * field.weight();
        let last = self.count - 1;
        let capacity = |place: usize| match committors.get(place) {
            Some(committor) => field.energy(nodes, committor),
            None => {
                let rest = |node: usize| 1.0 - committors.iter().map(|h| h[node]).sum::<f64>();
                field.energy(nodes, &(0..nodes.len()).map(rest).collect::<Vec<_>>())
            }
        };
        // Of what nothing leaves nothing is left but rounding, of either sign.
        let capacities: Vec<f64> = (0..self.count)
            .map(|place| match self.closed.get(place) {
                Some(true) => 0.0,
                _ => capacity(place).max(0.0),
            })
            .collect();
        let held = |place: usize| -> f64 {
            if place == last {
                return beyond;
            }
            let rim = libm::exp((field.ground() - self.limits[place]) / field.kt);
            let below = |&id: &usize| {
                let element = field.mesh.leaves[id].element.as_ref();
                element.map_or(0.0, |it| it.load.iter().sum::<f64>() - rim * it.free)
            };
            let own = self.reached[place].iter().map(below);
            // Where that is nothing, bounds are infinite.
            (copies * own.map(|part| part.max(0.0)).sum::<f64>()).max(f64::MIN_POSITIVE)
        };
        let held: Vec<f64> = (0..self.count).map(held).collect();
        let least = |i: usize, j: usize| capacities[i].min(capacities[j]);
        RateBounds {
            leaving: (0..self.count)
                .map(|i| [0.0, scale * capacities[i] / held[i]])
                .collect(),
            rates: (0..self.count)
                .map(|i| {
                    let rate = |j| [0.0, scale * least(i, j) / held[i]];
                    (0..self.count).map(rate).collect()
                })
                .collect(),
        }
    }

    /// Bounds of the rates out of each place, then of those from each place to each other, divided
    /// by D (1/m^2), and what refining the cells may bring to them. `beyond` is the occupation of
    /// the table outside the mesh.
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
        let copies = field.mesh.chart.copies() as f64;
        let scale = copies * field.weight();
        let places = 0..self.count;
        let held: Vec<Bounded> = places
            .clone()
            .map(|place| {
                let rest = if place + 1 == self.count { beyond } else { 0.0 };
                let Bounded { value, ends } = bracket.occupation(place);
                let whole = |part: f64| copies * part + rest;
                Bounded {
                    value: whole(value),
                    ends: ends.map(whole),
                }
            })
            .collect();
        let rest = |place: usize| match place + 1 == self.count {
            true => beyond / copies,
            false => 0.0,
        };
        let value = |i: usize, j: usize| match i == j {
            true => 0.0,
            false => scale * bracket.flow(i, j) / held[i].value,
        };
        let rates: Vec<Vec<f64>> = places
            .clone()
            .map(|i| places.clone().map(|j| value(i, j)).collect())
            .collect();
        let mut bounds: Vec<[f64; 2]> = places
            .clone()
            .map(|place| {
                let [least, most] = bracket.ratio(place, rest(place));
                [scale / copies / most, scale / copies / least]
            })
            .collect();
        let matters =
            |&(i, j): &(usize, usize)| rates[i][j] >= MATTERS * rates[i].iter().sum::<f64>();
        let wells = 0..self.count - 1;
        let pairs: Vec<(usize, usize)> = wells
            .clone()
            .flat_map(|i| places.clone().filter(move |j| *j != i).map(move |j| (i, j)))
            .filter(matters)
            .collect();
        let mut shares = bracket.shares(&pairs);
        if !self.shared.is_empty() {
            // Basins that the mesh does not tell apart.
            bounds[0] = [0.0, f64::INFINITY];
            for &(cell, _) in &self.shared {
                shares[cell] = f64::MAX.sqrt();
            }
        }
        let widest = |far: f64, [lower, upper]: &[f64; 2]| far.max(upper / lower - 1.0);
        let error = bounds[..self.count - 1].iter().fold(0.0, widest);
        let all: f64 = held.iter().map(|own| own.value).sum();
        for i in places.clone() {
            let rate = |j| {
                bracket
                    .rate(i, j, rest(i))
                    .map(|rate| scale / copies * rate)
            };
            bounds.extend(places.clone().map(rate));
        }
        let at = |&(i, j): &(usize, usize)| self.count * (i + 1) + j;
        let deciding = wells.chain(pairs.iter().map(at)).collect();
        Ok(Step {
            bounds,
            deciding,
            unknowns: nodes.len(),
            shares,
            rates: Some(MeshRates {
                rates,
                occupation: held.iter().map(|own| own.value / all).collect(),
                volumes: held.iter().map(|own| own.value).collect(),
                unknowns: nodes.len(),
                error,
                of_rims: bracket.off_by_rims(),
            }),
        })
    }
}
