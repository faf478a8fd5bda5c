//! How soon a tile leaves a configuration, and which end it reaches first.

use super::corridor::PathToFree;
use super::field::{DIVIDED, Earlier, MeshField};
use super::results::{DEEPEST, MESHES, enough};
pub use super::results::{Exit, ExitError, ExitSettings, MeshExit, half_bond};
use super::rim::Rims;
use super::sets::{basin, pass};
use crate::kinetics::mesh::{Nodes, System, Unsolved, loads};
use tiles::configuration::Configuration;
use tiles::problem::Problem;

/// The exit from a start to the first of two ends: the bond's basin and free tiles. All contacts that
/// count as the bond are one end.
///
/// # Errors
/// If the start or an end is invalid, or a linear system cannot be solved.
pub fn exit(
    problem: &Problem,
    bond: &Configuration,
    settings: &ExitSettings,
) -> Result<Exit, ExitError> {
    exit_on(problem, bond, settings, |_| ())
}

/// The same; `on_mesh` gets the exit on each mesh as soon as it is known, coarse meshes first.
///
/// # Errors
/// As [`exit()`].
pub fn exit_on(
    problem: &Problem,
    bond: &Configuration,
    settings: &ExitSettings,
    on_mesh: impl Fn(&MeshExit),
) -> Result<Exit, ExitError> {
    let start = settings.start;
    check(problem, bond, settings)?;
    let seeds = seeds(problem, bond, start);
    let ground = problem.energy(&start);
    let mut field = MeshField::new(
        problem,
        (settings.kt, false),
        settings.free_at,
        ground,
        &seeds,
    );
    let way = field.open_way(&start);
    field.settle(&seeds, &[start]);
    let mut earlier: Option<Earlier> = None;
    let mut meshes = Vec::new();
    let mut grows = true;
    loop {
        let ends = Ends::new(&mut field, bond, settings, way)?;
        let nodes = Nodes::new(&field.mesh);
        let (found, functions) = ends.solve(&field, &nodes, &start, earlier.as_ref())?;
        if !(found.time.is_finite() && found.time > 0.0) {
            return Err(ExitError::Never(settings.kt));
        }
        let errors = field.errors(
            &nodes,
            &ends.rims(&field),
            &functions.iter().collect::<Vec<_>>(),
        );
        let found = MeshExit {
            error: errors.largest,
            of_rims: errors.of_rims,
            ..found
        };
        on_mesh(&found);
        meshes.push(found);
        let is_fine = errors.largest < settings.tolerance && meshes.len() >= MESHES;
        if is_fine || found.unknowns > enough(settings.unknowns, meshes[0].unknowns) || !grows {
            return Ok(Exit { meshes, way });
        }
        grows = field.refine(&errors.shares, DIVIDED);
        earlier = Some((nodes, functions));
    }
}

/// The places that meshes resolve: the start, the bond, and the contacts that count as it but are no
/// copies by turns.
fn seeds(problem: &Problem, bond: &Configuration, start: Configuration) -> Vec<Configuration> {
    let mut seeds = vec![start, *bond];
    for equal in problem.bonds() {
        let is_copy = |seed: &Configuration| {
            let mut images = problem.symmetries.iter().map(|turn| turn.apply(seed));
            images.any(|image| {
                problem.space.distance(&image, &equal.pose) < problem.scaled(SAME_CONTACT)
            })
        };
        if !seeds[1..].iter().any(is_copy) {
            seeds.push(equal.pose);
        }
    }
    seeds
}

/// Configurations closer than this (m, for the paper's tile) are the same contact.
const SAME_CONTACT: f64 = 1e-3;

fn check(problem: &Problem, bond: &Configuration, asked: &ExitSettings) -> Result<(), ExitError> {
    for (q, name) in [(&asked.start, "the start"), (bond, "the bond")] {
        let distance = libm::hypot(q.x, q.y);
        if distance >= asked.free_at {
            return Err(ExitError::Free(distance, name, asked.free_at));
        }
    }
    if !problem.is_clear(&asked.start) {
        let clearance = problem.clearance(&asked.start);
        return Err(ExitError::Overlap(asked.start, clearance));
    }
    let depth = -problem.energy(&asked.start) / asked.kt;
    if depth > DEEPEST {
        return Err(ExitError::Cold(asked.kt, depth));
    }
    let energy = problem.energy(bond);
    if energy >= asked.basin_energy {
        return Err(ExitError::NoBasin(asked.basin_energy, energy));
    }
    Ok(())
}

/// Cells in which a tile is bound, and those of the start's well, if the start is deep in it.
struct Ends {
    bound: Vec<bool>,
    well: Option<Vec<bool>>,
    /// The energy limits (J) of the bound cells and of the well.
    limits: [f64; 2],
}

/// Places where the value at a corner is given: in the well, ...
const WELL: usize = 0;
/// ... where the tile is bound, ...
const BOUND: usize = 1;
/// ... or free.
const FREE: usize = 2;

/// The scale of loads at the pass's level, relative to the start's energy.
fn scale(field: &MeshField) -> f64 {
    libm::exp((field.level() - field.ground()) / field.kt)
}

impl Ends {
    fn new(
        field: &mut MeshField,
        bond: &Configuration,
        asked: &ExitSettings,
        way: PathToFree,
    ) -> Result<Self, ExitError> {
        let beside = field.mesh.neighbours();
        let around = |field: &MeshField, q: &Configuration, limit: f64| {
            basin(&field.mesh, &beside, q, limit)
        };
        let problem = field.problem;
        let bound_below = |field: &MeshField, limit: f64| {
            let mut inside = around(field, bond, limit);
            for equal in problem.bonds() {
                // Symmetric copies lie in the same cells.
                let is_there = field.mesh.holding(&equal.pose).iter().any(|&id| inside[id]);
                if !is_there && problem.energy(&equal.pose) < limit {
                    let more = around(field, &equal.pose, limit);
                    inside
                        .iter_mut()
                        .zip(more)
                        .for_each(|(known, more)| *known |= more);
                }
            }
            inside
        };
        let inside = bound_below(field, asked.basin_energy);
        let mesh = &field.mesh;
        if (0..inside.len()).any(|id| inside[id] && mesh.is_outer(id)) {
            return Err(ExitError::Open(asked.basin_energy));
        }
        let energy = field.problem.energy(&asked.start);
        let is_low = energy < asked.basin_energy;
        if is_low && mesh.holding(&asked.start).iter().any(|&id| inside[id]) {
            return Err(ExitError::Bound(asked.basin_energy));
        }
        let is_end = |id: usize| inside[id] || mesh.is_outer(id);
        let level = pass(mesh, &beside, &asked.start, &is_end);
        field.set_level(level.ok_or(ExitError::Closed(way))?);
        let deep = field.deep();
        let is_deep = energy < deep;
        let limits = [asked.basin_energy.max(deep), deep];
        let bound = bound_below(field, limits[0]);
        Ok(Self {
            bound,
            well: is_deep.then(|| around(field, &asked.start, deep)),
            limits,
        })
    }

    /// The rims of the ends and of the start's well.
    fn rims(&self, field: &MeshField) -> Rims {
        let is_well = |id: usize| self.well.as_ref().is_some_and(|well| well[id]);
        let limit = |id: usize| match is_well(id) {
            true => Some(self.limits[1]),
            false => self.bound[id].then_some(self.limits[0]),
        };
        let limits: Vec<_> = (0..self.bound.len()).map(limit).collect();
        Rims::new(field, &limits)
    }

    /// For each corner the place where its value is given. Where ends meet, which happens only on
    /// coarse meshes, free takes precedence, then bound.
    fn pins(&self, field: &MeshField, nodes: &Nodes) -> Vec<Option<usize>> {
        let of = |place: usize, cells: Option<&Vec<bool>>| {
            let is_inside = |id: usize| cells.is_some_and(|cells| cells[id]);
            nodes.pins(&field.mesh, FREE, |id| is_inside(id).then_some(place))
        };
        let pins = of(BOUND, Some(&self.bound))
            .into_iter()
            .zip(of(WELL, self.well.as_ref()));
        pins.map(|(bound, well)| bound.or(well)).collect()
    }

    /// The exit on a mesh, and the functions it was found from.
    ///
    /// Far below the passes the start's well is in equilibrium before anything leaves it. Then one
    /// function suffices: the probability h to return to the well before an end is reached. The
    /// flow into the ends is the capacity C, and the mean exit time is the integral of h e^(-U/kT)
    /// over D C. There is no small difference of large numbers.
    fn solve(
        &self,
        field: &MeshField,
        nodes: &Nodes,
        start: &Configuration,
        earlier: Option<&Earlier>,
    ) -> Result<(MeshExit, Vec<Vec<f64>>), Unsolved> {
        let pins = self.pins(field, nodes);
        let system = System::new(&field.mesh, nodes, &pins);
        let guesses = earlier.map(|earlier| field.carry_over(nodes, earlier));
        let guess = |i: usize| guesses.as_ref().and_then(|guesses| guesses.get(i));
        let loads = loads(&field.mesh, nodes, &self.bound);
        let exit = |time: f64, bound: f64| MeshExit {
            time: time * scale(field),
            bound: bound.clamp(0.0, 1.0),
            unknowns: system.len(),
            error: f64::INFINITY,
            of_rims: f64::INFINITY,
        };
        if self.well.is_none() {
            let sought = [
                system.committor(BOUND, guess(0)),
                system.loaded(&loads, guess(1)),
            ];
            let [committor, time] = system.solve(sought)?;
            let at = |values: &[f64]| nodes.at(&field.mesh, values, start).unwrap_or(f64::NAN);
            return Ok((exit(at(&time), at(&committor)), vec![committor, time]));
        }
        let [back] = system.solve([system.committor(WELL, guess(0))])?;
        let flows = system.flows(&back, FREE + 1);
        let (bound, free) = (flows[BOUND], flows[FREE]);
        let products = loads.iter().zip(&back).map(|(load, value)| load * value);
        let time = products.sum::<f64>() / (bound + free);
        Ok((exit(time, bound / (bound + free)), vec![back]))
    }
}
