//! The ends of an exit on a mesh, and what the mesh says of it.

use super::bracket::{Asked, Bracket};
use super::certify::Step;
use super::corridor::Way;
use super::field::{Earlier, Field};
use super::mesh::{Nodes, System, Unsolved, loads};
use super::proof::Set;
use super::results::{ExitError, ExitSettings, MeshExit};
use super::rim::Rims;
use super::sets::{basin, pass, reaching, rim};
use crate::configuration::Configuration;

/// Bounds are of a start in the well, which reaches so many kT above the pose, or as deep as it is
/// taken to be in equilibrium.
const NEAR: f64 = 0.5;

/// Cells in which a tile is bound, and, where the start is deep in a well, those of the well.
pub(super) struct Ends {
    bound: Vec<bool>,
    well: Option<Vec<bool>>,
    /// The cells about the start that bounds are of.
    near: Option<Vec<bool>>,
    /// Below which energies (J) these lie: the bound, the well and the cells about the start.
    limits: [f64; 3],
}

/// Where the value at a corner is given: in the well, ...
const WELL: usize = 0;
/// ... where the tile is bound, ...
const BOUND: usize = 1;
/// ... or free.
const FREE: usize = 2;

/// Of what loads at the pass's level add up to, counted from the start's energy on.
fn scale(field: &Field) -> f64 {
    libm::exp((field.level() - field.ground()) / field.kt)
}

impl Ends {
    pub fn new(
        field: &mut Field,
        bond: &Configuration,
        asked: &ExitSettings,
        way: Way,
    ) -> Result<Self, ExitError> {
        let beside = field.mesh.neighbours();
        let around = |field: &Field, q: &Configuration, limit: f64| {
            basin(&field.mesh, &beside, &field.mesh.holding(q), limit)
        };
        let inside = around(field, bond, asked.basin_energy);
        let rim = rim(&field.mesh);
        if inside.iter().zip(&rim).any(|(inside, rim)| *inside && *rim) {
            return Err(ExitError::Open(asked.basin_energy));
        }
        let held = field.mesh.holding(&asked.start);
        let is_low = field.energy_at(&asked.start) < asked.basin_energy;
        if is_low && held.iter().any(|&id| inside[id]) {
            return Err(ExitError::Bound(asked.basin_energy));
        }
        let level = pass(&field.mesh, &beside, &held, &|id| inside[id] || rim[id]);
        field.set_level(level.ok_or(ExitError::Closed(way))?);
        let deep = field.deep();
        let is_deep = field.energy_at(&asked.start) < deep;
        let top = field.energy_at(&asked.start) + NEAR * field.kt;
        let limits = [asked.basin_energy.max(deep), deep, deep.max(top)];
        let bound = around(field, bond, limits[0]);
        // Any well does for bounds: the wider it is, the nearer they are.
        let mut near = vec![false; field.mesh.leaves.len()];
        for id in reaching(&field.mesh, &beside, &held, limits[2]) {
            near[id] = true;
        }
        let is_apart = |(id, near): (usize, &bool)| !near || !(bound[id] || rim[id]);
        let is_well = near.iter().enumerate().all(is_apart);
        Ok(Self {
            bound,
            well: is_deep.then(|| around(field, &asked.start, deep)),
            near: is_well.then_some(near),
            limits,
        })
    }

    /// Whether the start lies so deep in its well that it is as good as anywhere else there.
    pub fn is_deep(&self) -> bool {
        self.well.is_some()
    }

    /// The start's well, half way up to the pass, and the bond's basin, as sets whose capacity is
    /// proved.
    pub fn sets(field: &Field, bond: &Configuration, asked: &ExitSettings) -> [Set; 2] {
        let deep = field.deep();
        let energy = field.energy_at(&asked.start);
        let half = 0.5 * (energy + field.level());
        let set = |at: &Configuration, below: f64| Set {
            at: *at,
            below,
            wide: below.max(deep),
        };
        [set(&asked.start, half), set(bond, asked.basin_energy)]
    }

    /// The rims of the ends and of the start's well.
    pub fn rims(&self, field: &Field) -> Rims {
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

    /// For each corner in which place its value is given. Where ends meet, which they do on coarse
    /// meshes only, being free comes first, then being bound.
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
    /// function tells all: the probability h to come back to the well before an end is reached.
    /// What flows into the ends is the capacity C, and the mean exit time is the integral of
    /// h e^(-U/kT) over D C. No small difference of large numbers is taken.
    pub fn solve(
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
            let committor = system.committor(BOUND, guess(0))?;
            let time = system.loaded(&loads, guess(1))?;
            let at = |values: &[f64]| nodes.at(&field.mesh, values, start).unwrap_or(f64::NAN);
            return Ok((exit(at(&time), at(&committor)), vec![committor, time]));
        }
        let back = system.committor(WELL, guess(0))?;
        let flux = system.fluxes(&back);
        let into = |end: usize| {
            let ends = pins.iter().zip(&flux).filter(|(pin, _)| **pin == Some(end));
            -ends.map(|(_, flux)| flux).sum::<f64>()
        };
        let (bound, free) = (into(BOUND), into(FREE));
        let products = loads.iter().zip(&back).map(|(load, value)| load * value);
        let time = products.sum::<f64>() / (bound + free);
        Ok((exit(time, bound / (bound + free)), vec![back]))
    }

    /// A bound from below of the mean exit time times D (m^2) from the well about the start, whatever
    /// the outlines: what the well's own cells hold over the energy of a trial committor.
    pub fn lower_bound(&self, field: &Field, nodes: &Nodes) -> Result<Option<f64>, Unsolved> {
        let Some(near) = &self.near else {
            return Ok(None);
        };
        let pins = self.pins(field, nodes, Some(near));
        let trial = System::new(&field.mesh, nodes, &pins).committor(WELL, None)?;
        let own = field.mesh.live().filter(|(id, ..)| near[*id]);
        let held: f64 = own
            .map(|(.., element)| element.load.iter().sum::<f64>())
            .sum();
        let scale = scale(field);
        Ok(Some(scale * held / field.energy(nodes, &trial)))
    }

    /// Bounds of the mean exit time times D (m^2) from the well about the start, and what refining
    /// the cells may bring to them: as in [`Self::solve`] it is an integral over a capacity,
    /// whatever the well.
    pub fn bounds(&self, field: &Field, nodes: &Nodes) -> Result<Option<Step>, Unsolved> {
        let Some(near) = &self.near else {
            return Ok(None);
        };
        let asked = Asked {
            field,
            nodes,
            pins: &self.pins(field, nodes, Some(near)),
            rim: FREE,
            // It is the same whatever the well.
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
