//! Rates between basins: the wells of states, and tiles far apart.

use std::f64::consts::{PI, TAU};

use super::field::{Earlier, Field};
use super::mesh::{Nodes, System, UNITS, Unsolved, loads};
use super::sets::{basin, is_at_the_rim, pass};
use crate::configuration::Configuration;
use crate::problem::Problem;
use crate::units::si;

/// How far (in kT) below its lowest pass a well lies in equilibrium.
const DEEP: f64 = 12.0;
/// Meshes at least: from the last two the error is told.
const MESHES: usize = 3;

/// A basin: where U is below a limit, joined to a configuration by such configurations; with its
/// copies under the pair's symmetries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basin {
    /// One of its configurations.
    pub at: Configuration,
    /// The limit (J).
    pub below: f64,
}

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct RateSettings {
    /// Effective energy of shaking (J).
    pub kt: f64,
    /// The wells.
    pub basins: Vec<Basin>,
    /// The tile is free where the reference points are so far apart (m).
    pub free_at: f64,
    /// Estimated relative error of the committors' energies at which the mesh is fine enough.
    pub tolerance: f64,
    /// Unknowns at which it is fine enough anyway.
    pub unknowns: usize,
}

impl RateSettings {
    /// Of kT (J) and the places; the mesh as fine as it is worth.
    pub fn new(kt: f64, basins: Vec<Basin>, free_at: f64) -> Self {
        Self {
            kt,
            basins,
            free_at,
            tolerance: 0.015,
            unknowns: 60_000,
        }
    }
}

/// Rates between places: the basins in their order, and last `free`.
///
/// For each place the committor h(i), 1 there and 0 at the others, gives the occupation Z(i), the
/// integral of h(i) e^(-U/kT), and what flows from it into each other place, C(i, j) = C(j, i).
/// Then k(i, j) = D C(i, j) / Z(i): rates between sets that are left much more slowly than they come
/// to equilibrium, with k(i, j) Z(i) = k(j, i) Z(j) whatever the mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshRates {
    /// From place i (row) to place j, divided by D (1/m^2); 0 on the diagonal.
    pub rates: Vec<Vec<f64>>,
    /// Each place's share of all time, its copies and, for `free`, the whole table included.
    pub occupation: Vec<f64>,
    /// Unknowns of the mesh.
    pub unknowns: usize,
    /// Estimated relative error of the committors' energies.
    pub error: f64,
}

/// The rates on ever finer meshes.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// What the meshes say, each finer than the last.
    pub meshes: Vec<MeshRates>,
}

impl Rates {
    /// What the finest mesh says.
    pub fn finest(&self) -> &MeshRates {
        self.meshes.last().expect("there is a mesh")
    }

    /// By how much a rate differs on the two finest meshes, relative. An estimate of the error, no
    /// bound.
    pub fn spread(&self, from: usize, to: usize) -> f64 {
        let [.., before, last] = &self.meshes[..] else {
            return f64::INFINITY;
        };
        (before.rates[from][to] / last.rates[from][to] - 1.0).abs()
    }
}

/// Why there are no rates.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RatesError {
    /// The basins with these numbers are one.
    #[error(
        "two basins are joined by configurations below {}: states that shallow have no rates at \
         this kT; ask for fewer --traps", si(*.0, "J", 4)
    )]
    Joined(f64),
    /// `free` begins where the table ends, or in a basin.
    #[error(
        "centres {0:.4} m apart are no place for free tiles: a basin reaches as far, or the table \
         ends before; choose another --free-at"
    )]
    NoFree(f64),
    /// A linear system could not be solved.
    #[error(transparent)]
    Unsolved(#[from] Unsolved),
}

/// The rates between basins and `free`.
///
/// # Errors
/// Where the places are not apart from each other, and where a linear system could not be solved.
pub fn rates(problem: &Problem, settings: &RateSettings) -> Result<Rates, RatesError> {
    let RateSettings { kt, free_at, .. } = *settings;
    let area = problem.space.half_size.map(|half| 2.0 * half);
    let outside = area[0] * area[1] - PI * free_at * free_at;
    let is_beyond = |basin: &Basin| basin.at.x.hypot(basin.at.y) >= free_at;
    if outside <= 0.0 || settings.basins.iter().any(is_beyond) {
        return Err(RatesError::NoFree(free_at));
    }
    let seeds: Vec<Configuration> = settings.basins.iter().map(|basin| basin.at).collect();
    let energies = seeds.iter().map(|q| problem.energy(q));
    let ground = energies.fold(f64::INFINITY, f64::min);
    let mut field = Field::new(problem, kt, free_at, ground, &seeds);
    let beyond = outside * TAU * (ground / kt).exp();
    let mut earlier: Option<Earlier> = None;
    let mut meshes = Vec::new();
    loop {
        let places = Places::new(&mut field, settings)?;
        let nodes = Nodes::new(&field.mesh);
        let (found, functions) = places.solve(&field, &nodes, beyond, earlier.as_ref())?;
        let (mut shares, error) = field.errors(&nodes, &functions);
        let unknowns = found.unknowns;
        meshes.push(MeshRates { error, ..found });
        let is_fine = error < settings.tolerance && meshes.len() >= MESHES;
        if is_fine || unknowns > settings.unknowns {
            return match places.shared.first() {
                Some(&(_, limit)) => Err(RatesError::Joined(limit)),
                None => Ok(Rates { meshes }),
            };
        }
        for &(cell, _) in &places.shared {
            shares[cell] = f64::MAX.sqrt();
        }
        field.refine(&shares);
        earlier = Some((nodes, functions));
    }
}

/// Which cell belongs to which basin.
struct Places {
    of: Vec<Option<usize>>,
    /// How many places there are, `free` among them.
    count: usize,
    /// Cells that two basins reach into, with the limit (J) of the later one.
    shared: Vec<(usize, f64)>,
}

impl Places {
    fn new(field: &mut Field, settings: &RateSettings) -> Result<Self, RatesError> {
        let beside = field.mesh.neighbours();
        let around = |field: &Field, basin: &Basin, limit: f64| {
            let held = field.mesh.holding(&basin.at);
            self::basin(&field.mesh, &beside, &held, limit)
        };
        let leaves = field.mesh.leaves.iter();
        let rim: Vec<bool> = leaves
            .map(|leaf| is_at_the_rim(&field.mesh, leaf))
            .collect();
        let wells: Vec<Vec<bool>> = settings
            .basins
            .iter()
            .map(|basin| around(field, basin, basin.below))
            .collect();
        let reaches_rim = |well: &Vec<bool>| well.iter().zip(&rim).any(|(well, rim)| *well && *rim);
        if wells.iter().any(reaches_rim) {
            return Err(RatesError::NoFree(settings.free_at));
        }
        let passes: Vec<f64> = (0..wells.len())
            .map(|own| {
                let others = wells.iter().enumerate().filter(|(k, _)| *k != own);
                let ends = |id: usize| rim[id] || others.clone().any(|(_, well)| well[id]);
                let from = field.mesh.holding(&settings.basins[own].at);
                pass(&field.mesh, &beside, &from, &ends).unwrap_or(0.0)
            })
            .collect();
        field.set_level(passes.iter().copied().fold(f64::INFINITY, f64::min));
        let mut places = Self {
            of: vec![None; field.mesh.leaves.len()],
            count: wells.len() + 1,
            shared: Vec::new(),
        };
        for (number, (basin, pass)) in settings.basins.iter().zip(passes).enumerate() {
            let limit = basin.below.max(pass - DEEP * settings.kt);
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

    /// For each corner the place in which its value is given.
    fn pins(&self, field: &Field, nodes: &Nodes) -> Vec<Option<usize>> {
        let outer = field.mesh.chart.cells[0] * UNITS;
        let mut pins = vec![None; nodes.len()];
        for (id, leaf, _) in field.mesh.live() {
            for (number, &node) in nodes.corners[id].iter().enumerate() {
                let pin = &mut pins[node as usize];
                if leaf.corner(number)[0] == outer {
                    *pin = Some(self.count - 1);
                } else if pin.is_none() {
                    *pin = self.of[id];
                }
            }
        }
        pins
    }

    /// The rates on a mesh, and the committors of all places but `free`. `beyond` is the occupation
    /// of the table outside the mesh.
    fn solve(
        &self,
        field: &Field,
        nodes: &Nodes,
        beyond: f64,
        earlier: Option<&Earlier>,
    ) -> Result<(MeshRates, Vec<Vec<f64>>), Unsolved> {
        let pins = self.pins(field, nodes);
        let pinned: Vec<bool> = pins.iter().map(Option::is_some).collect();
        let system = System::new(&field.mesh, nodes, &pinned);
        let none = vec![0.0; nodes.len()];
        let guesses = earlier.map(|earlier| field.carry_over(nodes, earlier));
        let committors: Vec<Vec<f64>> = (0..self.count - 1)
            .map(|place| {
                let one = |pin: &Option<usize>| if *pin == Some(place) { 1.0 } else { 0.0 };
                let given: Vec<f64> = pins.iter().map(one).collect();
                let guess = guesses.as_ref().map_or(&none, |guesses| &guesses[place]);
                system.solve(&given, &none, guess)
            })
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
        let flow = |i: usize, j: usize| match (i == last, j == last) {
            (true, true) => 0.0,
            (true, false) => flows[j][i],
            (false, true) => flows[i][j],
            (false, false) => 0.5 * (flows[i][j] + flows[j][i]),
        };
        let scale = copies * ((field.ground() - field.level()) / field.kt).exp();
        let rate = |from: usize, to: usize| (scale * flow(from, to) / occupations[from]).max(0.0);
        let all: f64 = occupations.iter().sum();
        let found = MeshRates {
            rates: (0..self.count)
                .map(|from| (0..self.count).map(|to| rate(from, to)).collect())
                .collect(),
            occupation: occupations.iter().map(|own| own / all).collect(),
            unknowns: system.len(),
            error: f64::INFINITY,
        };
        Ok((found, committors))
    }
}
