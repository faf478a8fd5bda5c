//! How soon a tile leaves a configuration, and where it comes first.

use super::field::{Earlier, Field};
use super::mesh::{Nodes, System, UNITS, Unsolved, loads};
use super::sets::{basin, is_at_the_rim, pass};
use crate::configuration::Configuration;
use crate::problem::Problem;
use crate::units::si;

/// How far (in kT) below the pass an end or a start lies in equilibrium: of the flux no more than
/// e^-12 is left there.
const DEEP: f64 = 12.0;
/// Meshes at least: from the last two the error is told.
const MESHES: usize = 3;

/// What is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExitSettings {
    /// Effective energy of shaking (J).
    pub kt: f64,
    /// Where the tile starts.
    pub start: Configuration,
    /// The tile is bound where U (J) is lower, in the basin of the bond.
    pub basin_energy: f64,
    /// The tile is free where the reference points are so far apart (m).
    pub free_at: f64,
    /// Estimated relative error of the solution's energy at which the mesh is fine enough.
    pub tolerance: f64,
    /// Unknowns at which it is fine enough anyway.
    pub unknowns: usize,
}

impl ExitSettings {
    /// Of a start, kT (J) and the ends; the mesh as fine as it is worth.
    pub fn new(kt: f64, start: Configuration, basin_energy: f64, free_at: f64) -> Self {
        Self {
            kt,
            start,
            basin_energy,
            free_at,
            tolerance: 0.015,
            unknowns: 60_000,
        }
    }
}

/// Half the bond's energy (J), below which a tile is bound where nothing else is asked.
pub fn half_bond(problem: &Problem, bound: &Configuration) -> f64 {
    0.5 * problem.energy(bound)
}

/// What one mesh says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshExit {
    /// Mean exit time times D (m^2).
    pub time: f64,
    /// Probability that the tile is bound before it is free.
    pub bound: f64,
    /// Unknowns of the mesh.
    pub unknowns: usize,
    /// Estimated relative error of the solution's energy.
    pub error: f64,
}

/// The exit from a configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Exit {
    /// What the meshes say, each finer than the last.
    pub meshes: Vec<MeshExit>,
}

impl Exit {
    /// What the finest mesh says.
    pub fn finest(&self) -> MeshExit {
        *self.meshes.last().expect("there is a mesh")
    }

    /// By how much the two finest meshes differ: in the mean exit time, relative, and in the
    /// probability. An estimate of the error, no bound.
    pub fn spread(&self) -> [f64; 2] {
        let [.., before, last] = self.meshes[..] else {
            return [f64::INFINITY; 2];
        };
        [
            ((last.time - before.time) / last.time).abs(),
            (last.bound - before.bound).abs(),
        ]
    }
}

/// Why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ExitError {
    /// The tiles overlap at the start, with this clearance (m).
    #[error(
        "the tiles overlap by {:.4} mm at the start {},{},{}: choose a pose whose clearance is not \
         negative (`tilebind energy` prints it)", -1e3 * .1, .0.x, .0.y, .0.theta
    )]
    Overlap(Configuration, f64),
    /// A pose lies beyond the distance (m) at which tiles are free.
    #[error(
        "the centres are {:.4} m apart at {}, and tiles count as free from {:.4} m on: choose a \
         larger --free-at or another start", .0, .1, .2
    )]
    Free(f64, &'static str, f64),
    /// The limit (J) of the bond's basin is not above the bond's energy (J).
    #[error(
        "no configuration of the bond lies below the basin energy of {}: the bond has {}; choose a \
         --basin-energy between that and 0", si(*.0, "J", 4), si(*.1, "J", 4)
    )]
    NoBasin(f64, f64),
    /// The start lies in the bond's basin.
    #[error(
        "the start lies in the bond's basin, which reaches up to {}: choose a lower --basin-energy \
         or another start", si(*.0, "J", 4)
    )]
    Bound(f64),
    /// The bond's basin reaches to where tiles are free.
    #[error(
        "configurations below the basin energy of {} lead from the bond to where tiles are free: \
         choose a lower --basin-energy", si(*.0, "J", 4)
    )]
    Open(f64),
    /// The mean exit time is no number any more.
    #[error("at kT = {} no tile ever leaves: choose a larger --kt", si(*.0, "J", 4))]
    Never(f64),
    /// A linear system could not be solved.
    #[error(transparent)]
    Unsolved(#[from] Unsolved),
}

/// From a start to the first of two ends: the bond's basin and where tiles are free. All that the
/// pair's symmetries map onto each other is one.
///
/// # Errors
/// Where the start or an end makes no sense, and where a linear system could not be solved.
pub fn exit(
    problem: &Problem,
    bond: &Configuration,
    settings: &ExitSettings,
) -> Result<Exit, ExitError> {
    let start = settings.start;
    check(problem, bond, settings)?;
    let seeds = [start, *bond];
    let ground = problem.energy(&start);
    let mut field = Field::new(problem, settings.kt, settings.free_at, ground, &seeds);
    let mut earlier: Option<Earlier> = None;
    let mut meshes = Vec::new();
    loop {
        let ends = Ends::new(&mut field, bond, settings)?;
        let nodes = Nodes::new(&field.mesh);
        let (found, functions) = ends.solve(&field, &nodes, &start, earlier.as_ref())?;
        if !(found.time.is_finite() && found.time > 0.0) {
            return Err(ExitError::Never(settings.kt));
        }
        let (shares, error) = field.errors(&nodes, &functions);
        meshes.push(MeshExit { error, ..found });
        let is_fine = error < settings.tolerance && meshes.len() >= MESHES;
        if is_fine || found.unknowns > settings.unknowns {
            return Ok(Exit { meshes });
        }
        field.refine(&shares);
        earlier = Some((nodes, functions));
    }
}

fn check(problem: &Problem, bond: &Configuration, asked: &ExitSettings) -> Result<(), ExitError> {
    for (q, name) in [(&asked.start, "the start"), (bond, "the bond")] {
        let distance = q.x.hypot(q.y);
        if distance >= asked.free_at {
            return Err(ExitError::Free(distance, name, asked.free_at));
        }
    }
    if !problem.is_clear(&asked.start) {
        let clearance = problem.clearance(&asked.start);
        return Err(ExitError::Overlap(asked.start, clearance));
    }
    let energy = problem.energy(bond);
    if energy >= asked.basin_energy {
        return Err(ExitError::NoBasin(asked.basin_energy, energy));
    }
    Ok(())
}

/// Cells in which a tile is bound, and, where the start is deep in a well, those of the well.
struct Ends {
    bound: Vec<bool>,
    well: Option<Vec<bool>>,
}

/// Why the value at a corner is given.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pin {
    None,
    Well,
    Bound,
    Free,
}

impl Ends {
    fn new(
        field: &mut Field,
        bond: &Configuration,
        asked: &ExitSettings,
    ) -> Result<Self, ExitError> {
        let beside = field.mesh.neighbours();
        let around = |field: &Field, q: &Configuration, limit: f64| {
            basin(&field.mesh, &beside, &field.mesh.holding(q), limit)
        };
        let inside = around(field, bond, asked.basin_energy);
        let leaves = field.mesh.leaves.iter();
        let rim: Vec<bool> = leaves
            .map(|leaf| is_at_the_rim(&field.mesh, leaf))
            .collect();
        if inside.iter().zip(&rim).any(|(inside, rim)| *inside && *rim) {
            return Err(ExitError::Open(asked.basin_energy));
        }
        let held = field.mesh.holding(&asked.start);
        let is_low = field.energy_at(&asked.start) < asked.basin_energy;
        if is_low && held.iter().any(|&id| inside[id]) {
            return Err(ExitError::Bound(asked.basin_energy));
        }
        let level = pass(&field.mesh, &beside, &held, &|id| inside[id] || rim[id]);
        field.set_level(level.unwrap_or(0.0));
        let deep = field.level() - DEEP * field.kt;
        let is_deep = field.energy_at(&asked.start) < deep;
        Ok(Self {
            bound: around(field, bond, asked.basin_energy.max(deep)),
            well: is_deep.then(|| around(field, &asked.start, deep)),
        })
    }

    /// For each corner whether its value is given. Where ends meet, which they do on coarse meshes
    /// only, being free comes first.
    fn pins(&self, field: &Field, nodes: &Nodes) -> Vec<Pin> {
        let outer = field.mesh.chart.cells[0] * UNITS;
        let mut pins = vec![Pin::None; nodes.len()];
        for (id, leaf, _) in field.mesh.live() {
            let in_well = self.well.as_ref().is_some_and(|well| well[id]);
            for (number, &node) in nodes.corners[id].iter().enumerate() {
                let pin = &mut pins[node as usize];
                if leaf.corner(number)[0] == outer {
                    *pin = Pin::Free;
                } else if self.bound[id] {
                    *pin = Pin::Bound;
                } else if in_well && *pin == Pin::None {
                    *pin = Pin::Well;
                }
            }
        }
        pins
    }

    /// The exit on a mesh, and the functions it was found from.
    ///
    /// Far below the passes the start's well is in equilibrium before anything leaves it. Then one
    /// function tells all: the probability h to come back to the well before an end is reached.
    /// What flows into the ends is the capacity C, and the mean exit time is the integral of
    /// h e^(-U/kT) over D C. No small difference of large numbers is taken.
    fn solve(
        &self,
        field: &Field,
        nodes: &Nodes,
        start: &Configuration,
        earlier: Option<&Earlier>,
    ) -> Result<(MeshExit, Vec<Vec<f64>>), Unsolved> {
        let pins = self.pins(field, nodes);
        let pinned: Vec<bool> = pins.iter().map(|pin| *pin != Pin::None).collect();
        let system = System::new(&field.mesh, nodes, &pinned);
        let none = vec![0.0; nodes.len()];
        let guesses = earlier.map(|earlier| field.carry_over(nodes, earlier));
        let guess = |i: usize| {
            let known = guesses.as_ref().and_then(|guesses| guesses.get(i));
            known.unwrap_or(&none)
        };
        let one_on = |end: Pin| -> Vec<f64> {
            let one = |pin: &Pin| if *pin == end { 1.0 } else { 0.0 };
            pins.iter().map(one).collect()
        };
        let loads = loads(&field.mesh, nodes, &self.bound);
        let exit = |time: f64, bound: f64| MeshExit {
            time: time * ((field.level() - field.ground()) / field.kt).exp(),
            bound: bound.clamp(0.0, 1.0),
            unknowns: system.len(),
            error: f64::INFINITY,
        };
        if self.well.is_none() {
            let committor = system.solve(&one_on(Pin::Bound), &none, guess(0))?;
            let time = system.solve(&none, &loads, guess(1))?;
            let at = |values: &[f64]| nodes.at(&field.mesh, values, start).unwrap_or(f64::NAN);
            return Ok((exit(at(&time), at(&committor)), vec![committor, time]));
        }
        let back = system.solve(&one_on(Pin::Well), &none, guess(0))?;
        let flux = system.fluxes(&back);
        let into = |end: Pin| {
            let ends = pins.iter().zip(&flux).filter(|(pin, _)| **pin == end);
            -ends.map(|(_, flux)| flux).sum::<f64>()
        };
        let (bound, free) = (into(Pin::Bound), into(Pin::Free));
        let products = loads.iter().zip(&back).map(|(load, value)| load * value);
        let time = products.sum::<f64>() / (bound + free);
        Ok((exit(time, bound / (bound + free)), vec![back]))
    }
}
