//! Requests and results of overdamped motion: exits from a pose, rates between basins.

use super::corridor::PathToFree;
use super::map::Map;
use crate::kinetics::mesh::Unsolved;
use tiles::configuration::Configuration;
use tiles::problem::Problem;
use tiles::units::si;

/// A basin: the configurations with U below a limit that are connected to a given one; with its
/// symmetric copies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basin {
    /// One of its configurations.
    pub at: Configuration,
    /// The limit (J).
    pub below: f64,
}

impl Basin {
    /// Height of a state's basin, as a share of its lowest barrier, or of that to free tiles if it
    /// is lower.
    const PART: f64 = 0.5;
    /// Least barrier (in kT) of traps with rates.
    const LEAST_BARRIER: f64 = 2.0;

    /// The basin of a state of this energy (J), `height` (J) below its lowest way out.
    pub fn of_state(at: Configuration, energy: f64, height: f64) -> Self {
        let below = (energy + Self::PART * height).min(Self::PART * energy);
        Self { at, below }
    }

    /// Whether a trap with this lowest barrier (J) has rates at kT (J).
    pub fn holds(height: f64, kt: f64) -> bool {
        height >= Self::LEAST_BARRIER * kt
    }
}

/// The request.
#[derive(Clone, Debug, PartialEq)]
pub struct RateSettings {
    /// Effective energy of shaking (J).
    pub kt: f64,
    /// Whether the fixed tile moves like the moving one, as on a table of many.
    pub both_move: bool,
    /// The wells.
    pub basins: Vec<Basin>,
    /// The tile is free where the reference points are so far apart (m).
    pub free_at: f64,
    /// Estimated relative error of the committors' energies at which refinement stops.
    pub tolerance: f64,
    /// Unknowns at which it is fine enough anyway, if they are half as many again as the first
    /// mesh's or more.
    pub unknowns: usize,
    /// Number of squares along x and y of a map of the committor from `free` to the first basin, if
    /// requested.
    pub map: Option<usize>,
}

impl RateSettings {
    /// Settings for kT (J) and the places, with the default mesh.
    pub fn new(kt: f64, basins: Vec<Basin>, free_at: f64) -> Self {
        Self {
            kt,
            both_move: false,
            basins,
            free_at,
            tolerance: 0.015,
            unknowns: 60_000,
            map: None,
        }
    }

    /// The lowest energy (J) of the basins' configurations, to which occupations refer.
    pub fn ground(&self, problem: &Problem) -> f64 {
        let energies = self.basins.iter().map(|basin| problem.energy(&basin.at));
        energies.fold(f64::INFINITY, f64::min)
    }
}

/// Rates between places: the basins in their order, and last `free`.
///
/// For each place the committor h(i), 1 there and 0 at the others, gives the occupation Z(i), the
/// integral of h(i) e^(-U/kT), and the flow from it into each other place, C(i, j) = C(j, i). Then
/// k(i, j) = D C(i, j) / Z(i): rates between sets that equilibrate much faster than they are left,
/// with k(i, j) Z(i) = k(j, i) Z(j) on any mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshRates {
    /// From place i (row) to place j, divided by D (1/m^2); 0 on the diagonal.
    pub rates: Vec<Vec<f64>>,
    /// Each place's share of all time, including its copies and, for `free`, the whole table. The
    /// region between places is divided by their committors. These depend on the metric of motion,
    /// which differs for twins under exchange of the tiles: it refers to the moving tile's centre.
    pub occupation: Vec<f64>,
    /// Each place's integral (m^2 rad) of its committor times `exp(-(U - U0) / kT)`, U0 the lowest
    /// energy of the basins' configurations; its copies included.
    pub volumes: Vec<f64>,
    /// Unknowns of the mesh.
    pub unknowns: usize,
    /// Estimated relative error of the committors' energies.
    pub error: f64,
    /// The part of it because basins consist of whole cells.
    pub of_rims: f64,
}

/// The rates on ever finer meshes.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// The results of the meshes, each finer than the previous one.
    pub meshes: Vec<MeshRates>,
    /// The requested map, from the last mesh.
    pub map: Option<Map>,
    /// The share of all time that each place is occupied itself: U below the basin's limit, or
    /// centres farther apart than where tiles are free. Unlike [`MeshRates::occupation`] it
    /// excludes the region between the places, and it does not depend on how tiles move.
    pub inside: Vec<f64>,
    /// For each basin whether a path leads from it to free tiles.
    pub ways: Vec<PathToFree>,
    /// For each place (row) and each other place, the known paths between them.
    pub links: Vec<Vec<PathToFree>>,
}

impl Rates {
    /// The results of the finest mesh.
    pub fn finest(&self) -> &MeshRates {
        self.meshes.last().expect("there is a mesh")
    }

    /// Estimated relative error of the flows between places, on the finest mesh.
    pub fn error(&self) -> f64 {
        self.finest().error
    }

    /// The relative difference of a rate on the two finest meshes: an estimate of the error, not a
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
    /// At this kT (J) the deepest basin is this deep (kT).
    #[error(
        "at kT = {} the deepest state is {:.0} kT deep, and no tile ever leaves it; rates are \
         computed up to {DEEPEST} kT: choose a larger --kt", si(*.0, "J", 4), .1
    )]
    Cold(f64, f64),
    /// A linear system could not be solved.
    #[error(transparent)]
    Unsolved(#[from] Unsolved),
}

/// Wells deeper than this (in kT) have no rates: weights that differ by so much are lost to
/// rounding in sums over a mesh, and the times exceed any experiment by many powers of ten.
pub(super) const DEEPEST: f64 = 300.0;

/// Least number of meshes: the last two give the error estimate.
pub(super) const MESHES: usize = 3;

/// Number of unknowns at which refinement stops: the requested number, or half as many again as the
/// first mesh.
pub(super) fn enough(asked: usize, first: usize) -> usize {
    asked.max(first + first / 2)
}

/// The request.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExitSettings {
    /// Effective energy of shaking (J).
    pub kt: f64,
    /// The starting configuration.
    pub start: Configuration,
    /// The tile is bound where U (J) is lower, in the basin of the bond.
    pub basin_energy: f64,
    /// The tile is free where the reference points are so far apart (m).
    pub free_at: f64,
    /// Estimated relative error of the solution's energy at which refinement stops.
    pub tolerance: f64,
    /// Unknowns at which it is fine enough anyway, if they are half as many again as the first
    /// mesh's or more.
    pub unknowns: usize,
}

impl ExitSettings {
    /// Settings for a start, kT (J) and the ends, with the default mesh.
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

/// Half the bond's energy (J), the default limit below which a tile is bound.
pub fn half_bond(problem: &Problem, bound: &Configuration) -> f64 {
    0.5 * problem.energy(bound)
}

/// The result of one mesh.
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
    /// The part of it because the bond's basin consists of whole cells.
    pub of_rims: f64,
}

/// The exit from a configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Exit {
    /// The results of the meshes, each finer than the previous one.
    pub meshes: Vec<MeshExit>,
    /// Whether a path leads from the start to free tiles.
    pub way: PathToFree,
}

impl Exit {
    /// The results of the finest mesh.
    pub fn finest(&self) -> MeshExit {
        *self.meshes.last().expect("there is a mesh")
    }

    /// The difference of the two finest meshes: relative for the mean exit time, and for the
    /// probability. An estimate of the error, not a bound.
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
    /// The mesh has no path from the start to an end.
    #[error(
        "no path leads from the start to the bond or to free tiles; {}", .0.describe()
    )]
    Closed(PathToFree),
    /// At this kT (J) the start is this deep (kT).
    #[error(
        "at kT = {} the start is {:.0} kT deep, and no tile ever leaves it; exits are computed up \
         to {DEEPEST} kT: choose a larger --kt", si(*.0, "J", 4), .1
    )]
    Cold(f64, f64),
    /// The mean exit time overflows.
    #[error("at kT = {} no tile ever leaves: choose a larger --kt", si(*.0, "J", 4))]
    Never(f64),
    /// A linear system could not be solved.
    #[error(transparent)]
    Unsolved(#[from] Unsolved),
}
