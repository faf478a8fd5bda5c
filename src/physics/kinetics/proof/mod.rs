//! Proved bounds of capacities: Dirichlet's and Thomson's principles with enclosed integrals,
//! between sets that are defined by energies and not by a mesh.
//!
//! # The statement
//! A is the part of U < a connected to a configuration (if that is held by contact: to the nearest
//! position at contact, nm away), B the part of U < b connected to others, all up to the pair's
//! symmetries, and tiles are free if their centres are R apart. The capacity of A against B and
//! free tiles is the minimum of the integral of e^(-U/kT) |grad h|^2 over the configurations at
//! which the tiles do not overlap, with h = 1 on A and 0 on the others. Every such h gives an upper
//! bound. A flux J from A to the others, with no flow through contact and a loss d of its current I
//! on the way, gives a lower bound: `(I - d)^2 <= C int e^(U/kT) |J|^2`, for 0 <= h <= 1.
//!
//! # How it is proved
//! - *Contact.* The mesh begins where two convex tiles touch, so that its cells contain all free
//!   configurations and no others. The distance of contact along a ray, and its slopes, are
//!   enclosed over boxes of rays ([`wall`]).
//! - *Sets.* All cells that may extend into a set, found by flooding with the lower bounds of U in
//!   each cell, have the set's value; fluxes begin and end in cells proved to lie in the set.
//! - *Integrals.* Over a piece of a cell the exponent is a linear function of the position plus a
//!   remainder enclosed by the energy's bounds ([`crate::potential::CellBounds`]); the squared
//!   functions are linear plus a remainder enclosed by first-order expansions. The integrals of
//!   e^(linear) times squares of linear functions have closed forms ([`moments`]). Pieces are
//!   bisected where the bounds are wide.
//! - *Sources.* In the mesh's coordinates a flux that is linear between opposite sides has a
//!   constant divergence, for any wall. The losses of cells and faces are summed and subtracted.
//! - *Rounding* widens every remainder by 4e-15 of the operands, moments by 1e-12 and sums by
//!   1e-11. It is assumed, not proved, as for the certificates of barriers, that sines, cosines and
//!   exponentials are accurate to 8 units in the last place.

mod expansion;
mod moments;
mod piece;
mod rim;
mod sums;
#[cfg(test)]
mod tests;
mod wall;

use super::field::Field;
use super::mesh::{Leaf, Nodes, Profile, System};
use super::sets::{Beside, flood};
use crate::configuration::Configuration;
use crate::parallel;
use piece::{Ground, Piece, Range};
pub(super) use sums::Closeness;
use sums::{Load, Role, bounded};
use wall::Wall;

/// Relative margin of the results, for slivers and rounding errors not covered by the sums.
const MARGIN: f64 = 1e-9;
/// Largest number of divisions of the cells around a set's configuration, until one lies in the
/// set.
const DIVISIONS: usize = 8;
/// Number of bisections of a cell to decide whether rays through it have a positive length.
const NARROW: usize = 6;
/// Number of bisections of a cell for the lower bound of U.
const HALVINGS: usize = 6;

/// A set: the part of U below a limit (J) that is connected to a configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Set {
    pub at: Configuration,
    pub below: f64,
    /// Energy limit (J) of a wider set for the trial committor, which bounds the capacity as well.
    pub wide: f64,
}

/// Proved bounds of a capacity and of the occupation of its set, for one of its symmetric copies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capacity {
    /// The set is where U is below this (J), joined to its configuration.
    pub below: f64,
    /// Bounds of the capacity C (rad) against the other sets and free tiles, with weights relative
    /// to the reference energy of loads.
    pub capacity: [f64; 2],
    /// Bounds of the integral Z of e^(-U/kT) over the set (m^2 rad), relative to the same energy.
    pub held: [f64; 2],
    /// An upper bound of the same integral over everything that is neither in another set nor free.
    pub around: f64,
}

impl Capacity {
    /// Bounds of C / Z (1/m^2): times D, the rate, per time spent in the set, at which a tile
    /// leaves the set and reaches another set or becomes free before it returns.
    pub fn leaving(&self) -> [f64; 2] {
        [
            self.capacity[0] / self.held[1],
            self.capacity[1] / self.held[0],
        ]
    }

    /// Bounds of the mean time T, times D (m^2), until a tile reaches another set or is free, if it
    /// starts on the set's boundary with the distribution of its last exits: T D is the integral of
    /// h e^(-U/kT) over C, and h is 1 on the set and at most 1 elsewhere (Bovier, Eckhoff, Gayrard
    /// and Klein 2004, doi:10.4171/JEMS/14). The bounds are narrow if nearly all of the occupation
    /// outside of other sets is in this set; otherwise the upper bound is poor.
    pub fn mean_exit(&self) -> [f64; 2] {
        [
            self.held[0] / self.capacity[1],
            self.around / self.capacity[0],
        ]
    }
}

/// Cells of a set: those that may extend into it, or into the wider one, and those that lie in it.
struct Cells {
    wide: Vec<bool>,
    outer: Vec<bool>,
    inner: Vec<bool>,
}

/// Proved bounds of the capacity of the first set against the others and free tiles, with the
/// requested accuracy of the integrals; `None` if nothing can be proved on this mesh. Divides
/// cells.
pub(super) fn capacity(field: &mut Field, sets: &[Set], asked: Closeness) -> Option<Capacity> {
    let problem = field.problem;
    let bounds = problem.bounds().ok()?;
    // The centre of mass must be the reference point, otherwise the coordinates are not orthogonal.
    let metric = problem.mass_metric(0.0);
    let is_upright = metric[(0, 2)].abs().max(metric[(1, 2)].abs()) < 1e-11 * problem.space.rho;
    if !is_upright || !field.mesh.chart.is_fitted() {
        return None;
    }
    let wall = Wall::new(problem.contact.as_ref(), field.mesh.chart.circle())?;
    let chart = field.mesh.chart.clone();
    let (kt, level, rho) = (field.kt, field.level(), field.mesh.rho);
    let ground = |profile| Ground {
        bounds,
        wall: &wall,
        chart: &chart,
        kt,
        level,
        rho,
        profile,
    };
    let even = ground(Profile::layer(0.0));
    let mut cells = Vec::new();
    for _ in 0..=DIVISIONS {
        let energies = energies(field, &even, sets);
        let beside = field.mesh.neighbours();
        let of = |set| Cells::new(field, &beside, &energies, set);
        cells = sets.iter().map(of).collect();
        let is_lost = |(_, cells): &(&Set, &Cells)| !cells.inner.iter().any(|inner| *inner);
        let lost = sets.iter().zip(&cells).filter(is_lost);
        let open: Vec<usize> = lost
            .flat_map(|(set, _)| field.mesh.holding(&set.at))
            .collect();
        if open.is_empty() {
            break;
        }
        field.divide(&open);
        cells.clear();
    }
    let mesh = &field.mesh;
    let is_wide = |id: usize| cells.iter().any(|cells| cells.wide[id]);
    let touches_rim = |id: usize| is_wide(id) && mesh.is_outer(id);
    if cells.is_empty() || (0..mesh.leaves.len()).any(touches_rim) {
        return None;
    }
    let nodes = &Nodes::new(mesh);
    let rim = sets.len();
    // Pieces in which contact extends to free tiles, as at corners, are omitted from both.
    let is_narrow = |id: usize| {
        let leaf = &mesh.leaves[id];
        leaf.is_live() && is_narrow(&even, Piece::whole(id, leaf), leaf, NARROW)
    };
    let narrow: Vec<bool> = parallel::map(0..mesh.leaves.len(), is_narrow);
    // Dirichlet's side.
    let mut pins = vec![None; nodes.len()];
    let mut pin = |node: u32, set: usize| -> Option<()> {
        for &(of, _) in &nodes.sources[node as usize] {
            let pin = &mut pins[of as usize];
            if pin.is_some_and(|other| other != set) {
                return None;
            }
            *pin = Some(set);
        }
        Some(())
    };
    for (id, leaf, _) in mesh.live() {
        for (number, &node) in nodes.corners[id].iter().enumerate() {
            if narrow[id] || mesh.chart.is_outer(leaf.corner(number)) {
                pin(node, rim)?;
            }
            for set in (0..sets.len()).filter(|&set| cells[set].wide[id]) {
                pin(node, set)?;
            }
        }
    }
    let trial = System::new(mesh, nodes, &pins).committor(0, None).ok()?;
    // Thomson's.
    let inside = |id: usize| (0..sets.len()).find(|&set| cells[set].inner[id]);
    let (network, profile) =
        field.network_between(nodes, &inside, &|id| narrow[id], rim, &trial)?;
    let flux = network.from(0, &network.potentials(nodes, &trial)).ok()?;
    let mut upwards = vec![None; mesh.leaves.len()];
    for (cell, sides) in network.upwards(&flux) {
        upwards[cell] = Some(sides);
    }
    let is_others = |id: usize| cells[1..].iter().any(|cells| cells.inner[id]);
    let role = |id: usize| Role {
        values: Some(nodes.of(id, &trial)).filter(|it| it.iter().any(|value| *value != it[0])),
        fluxes: upwards[id].filter(|sides| sides.iter().any(|flux| *flux != 0.0)),
        load: cells[0].inner[id].then_some(Load::All),
        around: !is_others(id),
    };
    let own = |id: usize| Piece::whole(id, &mesh.leaves[id]);
    let mut roles: Vec<(Piece, Role)> = mesh.live().map(|(id, ..)| (own(id), role(id))).collect();
    roles.extend(rim::pieces(mesh, &even, &cells[0], sets[0].below));
    let load = |is_asked: &dyn Fn(usize) -> bool| -> f64 {
        let asked = mesh.live().filter(|(id, ..)| is_asked(*id));
        asked.map(|(.., element)| element.held()).sum()
    };
    let held = load(&|id| cells[0].inner[id]);
    let around = load(&|id| !is_others(id));
    let scale = libm::exp((field.ground() - level) / kt);
    // If the set has little of the occupation around it, that bound is of little use, and so is its
    // accuracy.
    let of_use = (held / around).min(1.0);
    let sizes = [
        field.energy(nodes, &trial),
        flux.cost,
        held / scale,
        around / scale / of_use,
    ];
    let [energy, cost, load, around] = bounded(&ground(profile), mesh, &roles, sizes, asked);
    let lower = flux.carried * flux.carried / cost[1];
    let least = scale * (1.0 - MARGIN);
    let most = scale * (1.0 + MARGIN);
    let found = Capacity {
        below: sets[0].below,
        capacity: [least * lower, most * energy[1]],
        held: [least * load[0], most * load[1]],
        around: most * around[1],
    };
    (found.capacity[1].is_finite() && found.held[0] > 0.0).then_some(found)
}

/// Bounds of U in each cell (J), as accurate as sets require.
fn energies(field: &Field, ground: &Ground, sets: &[Set]) -> Vec<Range> {
    let leaves = &field.mesh.leaves;
    let of = |id: usize| {
        if !leaves[id].is_live() {
            return [f64::INFINITY; 2];
        }
        let is_open = |[low, high]: Range| {
            let limits = sets.iter().flat_map(|set| [set.below, set.wide]);
            limits.into_iter().any(|limit| low < limit && high >= limit)
        };
        let leaf = &leaves[id];
        range(ground, Piece::whole(id, leaf), leaf, &is_open, 0)
    };
    parallel::map(0..leaves.len(), of)
}

fn range(
    ground: &Ground,
    piece: Piece,
    leaf: &Leaf,
    is_open: &dyn Fn(Range) -> bool,
    halved: usize,
) -> Range {
    let place = ground.place(&piece, leaf);
    let found = place
        .as_ref()
        .map_or([f64::NEG_INFINITY, f64::INFINITY], |place| {
            place.energies(ground.kt, ground.level)
        });
    if halved == HALVINGS || !is_open(found) {
        return found;
    }
    let axis = place.map_or(halved % 3, |place| place.axis());
    let halves = piece
        .halves(axis)
        .map(|half| range(ground, half, leaf, is_open, halved + 1));
    let [[a, b], [c, d]] = halves;
    [a.min(c).max(found[0]), b.max(d).min(found[1])]
}

/// Whether rays through a piece may have no length, tested with a number of bisections.
fn is_narrow(ground: &Ground, piece: Piece, leaf: &Leaf, halvings: usize) -> bool {
    let place = ground.place(&piece, leaf);
    let is_clear = place.as_ref().is_some_and(|place| !place.is_narrow());
    if is_clear || halvings == 0 {
        return !is_clear && place.is_some();
    }
    let axis = place.map_or(halvings % 3, |place| place.axis());
    let mut halves = piece.halves(axis).into_iter();
    halves.any(|half| is_narrow(ground, half, leaf, halvings - 1))
}

impl Cells {
    fn new(field: &Field, beside: &Beside, energies: &[Range], set: &Set) -> Self {
        let joined = |is_in: &dyn Fn(usize) -> bool| {
            let mut from = field.mesh.holding(&set.at);
            from.retain(|&id| is_in(id));
            flood(beside, from, is_in)
        };
        Self {
            wide: joined(&|id| energies[id][0] < set.wide),
            outer: joined(&|id| energies[id][0] < set.below),
            inner: joined(&|id| energies[id][1] < set.below),
        }
    }
}
