//! How soon a tile leaves a configuration, and which end it reaches first.

use super::bracket::{Asked, Bracket};
use super::certify::{Step, narrowed};
use super::corridor::Way;
use super::field::{DIVIDED, Earlier, Field};
use super::mesh::{Nodes, System, Unsolved, loads};
use super::results::{DEEPEST, MESHES, enough};
pub use super::results::{Exit, ExitError, ExitSettings, MeshExit, half_bond};
use super::rim::Rims;
use super::sets::{basin, pass, reaching};
use crate::configuration::Configuration;
use crate::problem::Problem;

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
    let mut field = Field::new(problem, settings.kt, settings.free_at, ground, &seeds);
    let way = field.open_way(&start);
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
            let mut bounds = bounds(problem, bond, settings)?;
            if let (Some(_), true) = (settings.certify, bounds.is_empty()) {
                let lower = ends.lower_bound(&field, &nodes)?;
                bounds.extend(lower.map(|lower| [lower, f64::INFINITY]));
            }
            let own = meshes[meshes.len() - 1].time;
            let mut midway = None;
            if let Some(&[lower, upper]) = bounds.last()
                && !(lower..=upper).contains(&own)
            {
                // The exit time of a start that is not deep in its well can differ from that of the
                // well.
                match ends.is_deep() && upper.is_finite() {
                    true => midway = Some((lower * upper).sqrt()),
                    false => bounds.clear(),
                }
            }
            return Ok(Exit {
                meshes,
                bounds,
                midway,
                way,
            });
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

/// Bounds of the mean exit time times D (m^2) on increasingly fine meshes that begin at contact.
fn bounds(
    problem: &Problem,
    bond: &Configuration,
    settings: &ExitSettings,
) -> Result<Vec<[f64; 2]>, ExitError> {
    let ground = problem.energy(&settings.start);
    let seeds = seeds(problem, bond, settings.start);
    let fitted = Field::fitted(problem, settings.kt, settings.free_at, ground, &seeds);
    let (Some(certify), Some(mut field)) = (settings.certify, fitted) else {
        return Ok(Vec::new());
    };
    let all = narrowed(&mut field, &certify, |field| {
        let ends = Ends::new(field, bond, settings, Way::Open)?;
        let nodes = Nodes::new(&field.mesh);
        Ok::<_, ExitError>(ends.bounds(field, &nodes)?)
    })?;
    Ok(all.iter().map(|step| step.bounds[0]).collect())
}

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

/// Bounds refer to a start in the well, which extends this many kT above the pose, or as far up as
/// equilibrium is assumed.
const NEAR: f64 = 0.5;

/// Cells in which a tile is bound, and those of the start's well, if the start is deep in it.
struct Ends {
    bound: Vec<bool>,
    well: Option<Vec<bool>>,
    /// The cells around the start to which bounds refer.
    near: Option<Vec<bool>>,
    /// The energy limits (J) of the bound cells, the well and the cells around the start.
    limits: [f64; 3],
}

/// Places where the value at a corner is given: in the well, ...
const WELL: usize = 0;
/// ... where the tile is bound, ...
const BOUND: usize = 1;
/// ... or free.
const FREE: usize = 2;

/// The scale of loads at the pass's level, relative to the start's energy.
fn scale(field: &Field) -> f64 {
    libm::exp((field.level() - field.ground()) / field.kt)
}

impl Ends {
    fn new(
        field: &mut Field,
        bond: &Configuration,
        asked: &ExitSettings,
        way: Way,
    ) -> Result<Self, ExitError> {
        let beside = field.mesh.neighbours();
        let around =
            |field: &Field, q: &Configuration, limit: f64| basin(&field.mesh, &beside, q, limit);
        let problem = field.problem;
        let bound_below = |field: &Field, limit: f64| {
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
        let top = energy + NEAR * field.kt;
        let limits = [asked.basin_energy.max(deep), deep, deep.max(top)];
        let bound = bound_below(field, limits[0]);
        // Any well gives valid bounds: the wider it is, the narrower they are.
        let near = reaching(&field.mesh, &beside, &asked.start, limits[2]);
        let is_apart = |&id: &usize| !(bound[id] || field.mesh.is_outer(id));
        let is_well = near.iter().all(is_apart);
        let mut is_near = vec![false; bound.len()];
        for id in near {
            is_near[id] = true;
        }
        Ok(Self {
            bound,
            well: is_deep.then(|| around(field, &asked.start, deep)),
            near: is_well.then_some(is_near),
            limits,
        })
    }

    /// Whether the start is so deep in its well that all starts in the well are equivalent.
    fn is_deep(&self) -> bool {
        self.well.is_some()
    }

    /// The rims of the ends and of the start's well.
    fn rims(&self, field: &Field) -> Rims {
        self.rims_with(field, self.well.as_ref(), self.limits[1])
    }

    /// The rims of the ends and of some cells below a limit (J).
    fn rims_with(&self, field: &Field, well: Option<&Vec<bool>>, below: f64) -> Rims {
        let limit = |id: usize| match well.is_some_and(|well| well[id]) {
            true => Some(below),
            false => self.bound[id].then_some(self.limits[0]),
        };
        let limits: Vec<_> = (0..self.bound.len()).map(limit).collect();
        Rims::new(field, &limits)
    }

    /// For each corner the place where its value is given. Where ends meet, which happens only on
    /// coarse meshes, free takes precedence, then bound.
    fn pins(&self, field: &Field, nodes: &Nodes, well: Option<&Vec<bool>>) -> Vec<Option<usize>> {
        let of = |place: usize, cells: Option<&Vec<bool>>| {
            let is_inside = |id: usize| cells.is_some_and(|cells| cells[id]);
            nodes.pins(&field.mesh, FREE, |id| is_inside(id).then_some(place))
        };
        let pins = of(BOUND, Some(&self.bound)).into_iter().zip(of(WELL, well));
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
        field: &Field,
        nodes: &Nodes,
        start: &Configuration,
        earlier: Option<&Earlier>,
    ) -> Result<(MeshExit, Vec<Vec<f64>>), Unsolved> {
        let pins = self.pins(field, nodes, self.well.as_ref());
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

    /// A lower bound of the mean exit time times D (m^2) from the well around the start, for any
    /// outlines: the occupation of the well's own cells over the energy of a trial committor.
    fn lower_bound(&self, field: &Field, nodes: &Nodes) -> Result<Option<f64>, Unsolved> {
        let Some(near) = &self.near else {
            return Ok(None);
        };
        let pins = self.pins(field, nodes, Some(near));
        let system = System::new(&field.mesh, nodes, &pins);
        let [trial] = system.solve([system.committor(WELL, None)])?;
        let own = field.mesh.live().filter(|(id, ..)| near[*id]);
        let held: f64 = own.map(|(.., element)| element.held()).sum();
        let scale = scale(field);
        Ok(Some(scale * held / field.energy(nodes, &trial)))
    }

    /// Bounds of the mean exit time times D (m^2) from the well around the start, and the
    /// contribution of each cell to their width: as in [`Self::solve`] it is an integral over a
    /// capacity, for any well.
    fn bounds(&self, field: &Field, nodes: &Nodes) -> Result<Option<Step>, Unsolved> {
        let Some(near) = &self.near else {
            return Ok(None);
        };
        let asked = Asked {
            field,
            nodes,
            pins: &self.pins(field, nodes, Some(near)),
            rim: FREE,
            // It does not depend on the well.
            rims: &self.rims_with(field, None, 0.0),
            left_out: &self.bound,
        };
        let bracket = Bracket::new(&asked, 1)?;
        let scale = scale(field);
        Ok(Some(Step {
            bounds: vec![bracket.ratio(0, 0.0).map(|time| scale * time)],
            deciding: vec![0],
            unknowns: nodes.len(),
            shares: bracket.shares(&[]),
            rates: None,
        }))
    }
}
