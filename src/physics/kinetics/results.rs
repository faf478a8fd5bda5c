//! Requests and results of overdamped motion: exits from a pose, rates between basins.

use super::corridor::Way;
use super::map::Map;
use super::mesh::Unsolved;
use super::proof::{Capacity, Closeness};
use crate::configuration::Configuration;
use crate::problem::Problem;
use crate::units::si;

/// How near each other bounds are asked to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certify {
    /// Their distance as a share of the lower one.
    pub distance: f64,
    /// Unknowns up to which meshes are refined for it.
    pub unknowns: usize,
    /// Pieces of cells, at most, in which integrals are enclosed to prove bounds; 0 for no proof.
    pub pieces: usize,
}

/// Where bounds are to be proved they are no farther apart on the mesh: fluxes are laid in the same
/// way all over it then, and cost more.
const TO_PROVE: f64 = 0.5;

/// Share of the distance asked for that integrals' enclosures may take.
const OF_INTEGRALS: f64 = 0.5;

impl Default for Certify {
    /// As near as it comes within seconds.
    fn default() -> Self {
        Self {
            distance: 0.1,
            unknowns: 60_000,
            pieces: 0,
        }
    }
}

impl Certify {
    /// The same for an exit, which asks for fewer functions.
    pub fn of_exit() -> Self {
        Self {
            unknowns: 80_000,
            ..Self::default()
        }
    }

    /// So near, if that can be had at all.
    pub fn to(distance: f64) -> Self {
        Self {
            distance,
            unknowns: 400_000,
            pieces: 0,
        }
    }

    /// The same, with what can be proved.
    pub fn proved(self) -> Self {
        Self {
            pieces: 800_000,
            ..self
        }
    }

    /// How near each other bounds are to be on a mesh.
    pub(super) fn on_mesh(&self) -> f64 {
        match self.pieces {
            0 => self.distance,
            _ => self.distance.min(TO_PROVE),
        }
    }

    /// How closely integrals are to be enclosed, if bounds are to be proved.
    pub(super) fn proof(&self) -> Option<Closeness> {
        (self.pieces > 0).then_some(Closeness {
            apart: OF_INTEGRALS * self.distance,
            pieces: self.pieces,
        })
    }
}

/// A basin: where U is below a limit, joined to a configuration by such configurations; with its
/// copies under the pair's symmetries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basin {
    /// One of its configurations.
    pub at: Configuration,
    /// The limit (J).
    pub below: f64,
}

impl Basin {
    /// Part of the way up to its lowest barrier to which the basin of a state reaches; or to free
    /// tiles, where that is lower.
    const PART: f64 = 0.5;
    /// Barriers of traps with rates are at least so many kT high.
    const LEAST_BARRIER: f64 = 2.0;

    /// The basin of a state of this energy (J), `height` (J) below its lowest way out.
    pub fn of_state(at: Configuration, energy: f64, height: f64) -> Self {
        let below = (energy + Self::PART * height).min(Self::PART * energy);
        Self { at, below }
    }

    /// Whether a trap whose lowest way out is so high (J) has rates at kT (J).
    pub fn holds(height: f64, kt: f64) -> bool {
        height >= Self::LEAST_BARRIER * kt
    }
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
    /// Unknowns at which it is fine enough anyway, if they are half as many again as the first
    /// mesh's or more.
    pub unknowns: usize,
    /// Relative distance that is asked for of the bounds of the rates out of the basins, and of those
    /// between two places that make up a tenth of what leaves the first or more; without it none are
    /// found.
    pub certify: Option<Certify>,
    /// Squares along x and y of a map of the committor from `free` to the first basin, if one is
    /// asked for.
    pub map: Option<usize>,
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
            certify: Some(Certify::default()),
            map: None,
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
    /// Each place's share of all time, its copies and, for `free`, the whole table included. What
    /// lies between places is shared out by their committors. These depend on the metric of motion,
    /// which is not the same for twins by exchange of the tiles: it is about the moving one's centre.
    pub occupation: Vec<f64>,
    /// Each place's integral (m^2 rad) of its committor times `exp(-(U - U0) / kT)`, U0 the lowest
    /// energy of the basins' configurations; its copies included.
    pub volumes: Vec<f64>,
    /// Unknowns of the mesh.
    pub unknowns: usize,
    /// Estimated relative error of the committors' energies; on a mesh with bounds how far those of
    /// the rates out of the basins are apart.
    pub error: f64,
    /// What of it is due to the basins being made of whole cells, and on a mesh with bounds what
    /// comes to it.
    pub of_rims: f64,
}

/// The rates on ever finer meshes.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// What the meshes say, each finer than the last; but where bounds are nearer each other than
    /// that is known, the last is the mesh that they hold on, which begins at contact.
    pub meshes: Vec<MeshRates>,
    /// Whether the last is that one.
    pub is_between_bounds: bool,
    /// Bounds, if they are asked for.
    pub bounds: Option<RateBounds>,
    /// The map asked for, from the last mesh without bounds.
    pub map: Option<Map>,
    /// The share of all time that each place is occupied itself: U below the basin's limit, or
    /// centres farther apart than where tiles are free. Unlike [`MeshRates::occupation`] it leaves
    /// out what lies between the places; it does not depend on how tiles move.
    pub inside: Vec<f64>,
    /// For each basin whether a way leads out of it to free tiles.
    pub ways: Vec<Way>,
    /// From each place (row) to each other what is known of ways between them.
    pub links: Vec<Vec<Way>>,
    /// For each basin what is proved of it, if that was asked for and can be had.
    pub proved: Vec<Option<Leaving>>,
}

impl Rates {
    /// What the finest mesh says.
    pub fn finest(&self) -> &MeshRates {
        self.meshes.last().expect("there is a mesh")
    }

    /// Estimated relative error of what flows between places, on the finest mesh without bounds.
    pub fn error(&self) -> f64 {
        let of_bounds = usize::from(self.is_between_bounds);
        let meshes = &self.meshes[..self.meshes.len() - of_bounds];
        meshes.last().map_or(f64::INFINITY, |mesh| mesh.error)
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
         this kT; use fewer --traps", si(*.0, "J", 4)
    )]
    Joined(f64),
    /// `free` begins where the table ends, or in a basin.
    #[error(
        "with centres {0:.4} m apart tiles cannot be free: a basin extends that far, or the table \
         ends before; choose another --free-at"
    )]
    NoFree(f64),
    /// At this kT (J) the deepest basin is so many kT deep.
    #[error(
        "at kT = {} the deepest state is {:.0} kT deep, and no tile ever leaves it; rates are \
         computed up to {DEEPEST} kT: choose a larger --kt", si(*.0, "J", 4), .1
    )]
    Cold(f64, f64),
    /// A linear system could not be solved.
    #[error(transparent)]
    Unsolved(#[from] Unsolved),
}

/// Wells deeper than this, in kT, have no rates: weights that far apart are lost to rounding in sums
/// over a mesh, and the times are many powers of ten of any table's life.
pub(super) const DEEPEST: f64 = 300.0;

/// Meshes at least: from the last two the error is told.
pub(super) const MESHES: usize = 3;

/// Unknowns at which meshes are fine enough: what is asked, or half as many again as the first has.
pub(super) fn enough(asked: usize, first: usize) -> usize {
    asked.max(first + first / 2)
}

/// What is proved of how a basin is left for any other or free tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaving {
    /// Its capacity against the others and free tiles.
    pub capacity: Capacity,
    /// Where the others' proofs say that this basin is reached: it lies below this (J).
    pub end_below: f64,
}

/// Bounds of rates, from below and above, divided by D (1/m^2). They hold but for what the integrals
/// over cells are off by. Where rays may leave contact more than once, those from below are 0: fluxes
/// that contact lets through are laid along rays, see [`crate::contact::Contact::least_lever`].
#[derive(Clone, Debug, PartialEq)]
pub struct RateBounds {
    /// Out of each place.
    pub leaving: Vec<[f64; 2]>,
    /// From place i (row) to place j; of no meaning on the diagonal.
    pub rates: Vec<Vec<[f64; 2]>>,
}

impl RateBounds {
    /// Whether a mesh's rates lie between them, those out of places as well.
    pub(super) fn hold(&self, mesh: &MeshRates) -> bool {
        let lies = |rate: f64, [lower, upper]: [f64; 2]| lower <= rate && rate <= upper;
        let mut places = mesh.rates.iter().enumerate();
        places.all(|(from, rates)| {
            let mut others = rates.iter().enumerate().filter(|(to, _)| *to != from);
            lies(rates.iter().sum(), self.leaving[from])
                && others.all(|(to, rate)| lies(*rate, self.rates[from][to]))
        })
    }

    /// The same, where they say nothing from above with what others say, which hold as well.
    pub(super) fn or_below(mut self, others: &Self) -> Self {
        let lower = |own: &mut [f64; 2], other: &[f64; 2]| {
            if !own[1].is_finite() {
                own[1] = other[1];
            }
        };
        for (from, rates) in self.rates.iter_mut().enumerate() {
            lower(&mut self.leaving[from], &others.leaving[from]);
            for (own, other) in rates.iter_mut().zip(&others.rates[from]) {
                lower(own, other);
            }
        }
        self
    }

    /// Whether there are bounds from above only.
    pub fn are_one_sided(&self) -> bool {
        self.leaving.iter().all(|[lower, _]| *lower == 0.0)
    }
}

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
    /// Unknowns at which it is fine enough anyway, if they are half as many again as the first
    /// mesh's or more.
    pub unknowns: usize,
    /// Relative distance of the bounds of the mean exit time that is asked for; without it none are found.
    pub certify: Option<Certify>,
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
            certify: Some(Certify::default()),
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
    /// What of it is due to the bond's basin being made of whole cells.
    pub of_rims: f64,
}

/// The exit from a configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Exit {
    /// What the meshes say, each finer than the last.
    pub meshes: Vec<MeshExit>,
    /// Bounds of the mean exit time times D (m^2) on other meshes, each finer than the last: of a
    /// tile that starts in the well about the start, where it is last left. They hold but for what
    /// the integrals over cells are off by. None where the start lies in no well; from below only,
    /// the upper ones infinite, where rays may leave contact more than once.
    pub bounds: Vec<[f64; 2]>,
    /// What lies midway between the bounds, if the finest mesh's mean exit time does not lie between
    /// them: far below the passes cells that do not begin at contact may be too coarse for what the
    /// well holds.
    pub midway: Option<f64>,
    /// Proved bounds of the capacity of the well about the start, half way up to the pass, against
    /// the ends, where they are asked for and can be had.
    pub proved: Option<Capacity>,
    /// Whether a way leads from the start to free tiles.
    pub way: Way,
}

impl Exit {
    /// The mean exit time times D (m^2).
    pub fn time(&self) -> f64 {
        self.midway.unwrap_or(self.finest().time)
    }

    /// What the finest mesh says.
    pub fn finest(&self) -> MeshExit {
        *self.meshes.last().expect("there is a mesh")
    }

    /// The narrowest bounds of the mean exit time times D (m^2).
    pub fn bracket(&self) -> Option<[f64; 2]> {
        self.bounds.last().copied()
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
        "the centres are {:.4} m apart at {}, but tiles count as free from {:.4} m: choose a \
         larger --free-at or another start", .0, .1, .2
    )]
    Free(f64, &'static str, f64),
    /// The limit (J) of the bond's basin is not above the bond's energy (J).
    #[error(
        "no configuration of the bond is below the basin energy of {}: the bond has {}; choose a \
         --basin-energy between that and 0", si(*.0, "J", 4), si(*.1, "J", 4)
    )]
    NoBasin(f64, f64),
    /// The start lies in the bond's basin.
    #[error(
        "the start is in the bond's basin, which extends up to {}: choose a lower --basin-energy \
         or another start", si(*.0, "J", 4)
    )]
    Bound(f64),
    /// The bond's basin reaches to where tiles are free.
    #[error(
        "configurations below the basin energy of {} lead from the bond to where tiles are free: \
         choose a lower --basin-energy", si(*.0, "J", 4)
    )]
    Open(f64),
    /// The mesh has no way from the start to an end.
    #[error(
        "no path leads from the start to the bond or to free tiles; {}", .0.told()
    )]
    Closed(Way),
    /// At this kT (J) the start lies so many kT deep.
    #[error(
        "at kT = {} the start is {:.0} kT deep, and no tile ever leaves it; exits are computed up \
         to {DEEPEST} kT: choose a larger --kt", si(*.0, "J", 4), .1
    )]
    Cold(f64, f64),
    /// The mean exit time is no number any more.
    #[error("at kT = {} no tile ever leaves: choose a larger --kt", si(*.0, "J", 4))]
    Never(f64),
    /// A linear system could not be solved.
    #[error(transparent)]
    Unsolved(#[from] Unsolved),
}
