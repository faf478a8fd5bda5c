//! Rates between basins: the wells of states, and tiles far apart.

use std::f64::consts::{PI, TAU};

use super::bounded::bounded;
pub use super::bounded::{Leaving, RateBounds};
use super::certify::Certify;
use super::corridor::Way;
use super::exit::half_bond;
use super::field::{DIVIDED, Earlier, Field};
use super::links::links;
use super::map::Map;
use super::mesh::{Nodes, Unsolved};
use super::places::Places;
use crate::configuration::Configuration;
use crate::problem::Problem;
use crate::units::si;

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
         this kT; ask for fewer --traps", si(*.0, "J", 4)
    )]
    Joined(f64),
    /// `free` begins where the table ends, or in a basin.
    #[error(
        "centres {0:.4} m apart are no place for free tiles: a basin reaches as far, or the table \
         ends before; choose another --free-at"
    )]
    NoFree(f64),
    /// At this kT (J) the deepest basin is so many kT deep.
    #[error(
        "at kT = {} the deepest state is {:.0} kT deep, and no tile ever leaves it; rates are told up \
         to {DEEPEST} kT: choose a larger --kt", si(*.0, "J", 4), .1
    )]
    Cold(f64, f64),
    /// A linear system could not be solved.
    #[error(transparent)]
    Unsolved(#[from] Unsolved),
}

/// Wells deeper than this, in kT, have no rates: weights that far apart are lost to rounding in sums
/// over a mesh, and the times are many powers of ten of any table's life.
pub(super) const DEEPEST: f64 = 300.0;

/// The rates between basins and `free`.
///
/// # Errors
/// Where the places are not apart from each other, and where a linear system could not be solved.
pub fn rates(problem: &Problem, settings: &RateSettings) -> Result<Rates, RatesError> {
    let RateSettings { kt, free_at, .. } = *settings;
    let area = problem.space.half_size.map(|half| 2.0 * half);
    let outside = area[0] * area[1] - PI * free_at * free_at;
    let is_beyond = |basin: &Basin| libm::hypot(basin.at.x, basin.at.y) >= free_at;
    if outside <= 0.0 || settings.basins.iter().any(is_beyond) {
        return Err(RatesError::NoFree(free_at));
    }
    let seeds: Vec<Configuration> = settings.basins.iter().map(|basin| basin.at).collect();
    let energies = seeds.iter().map(|q| problem.energy(q));
    let ground = energies.fold(f64::INFINITY, f64::min);
    if -ground > DEEPEST * kt {
        return Err(RatesError::Cold(kt, -ground / kt));
    }
    let mut field = Field::new(problem, kt, free_at, ground, &seeds);
    let ways: Vec<Way> = seeds.iter().map(|seed| field.open_way(seed)).collect();
    let blocked = field.blocked(&seeds);
    let beyond = outside * TAU * libm::exp(ground / kt);
    let mut earlier: Option<Earlier> = None;
    let mut meshes = Vec::new();
    let mut grows = true;
    loop {
        let places = Places::new(&mut field, settings)?;
        let nodes = Nodes::new(&field.mesh);
        let (found, functions) = places.solve(&field, &nodes, beyond, earlier.as_ref())?;
        let left = functions.iter().zip(&places.closed);
        let left: Vec<_> = left
            .filter_map(|(h, closed)| (!closed).then_some(h))
            .collect();
        let errors = field.errors(&nodes, &places.rims(&field), &left);
        // Where nothing is left that flows, no error of it is known.
        let error = match left.is_empty() {
            true => f64::INFINITY,
            false => errors.largest,
        };
        let mut shares = errors.shares;
        let unknowns = found.unknowns;
        meshes.push(MeshRates {
            error,
            of_rims: errors.of_rims,
            ..found
        });
        let is_fine = error < settings.tolerance && meshes.len() >= MESHES;
        let is_done = is_fine || unknowns > enough(settings.unknowns, meshes[0].unknowns) || !grows;
        if let Some(&(_, limit)) = places.shared.first() {
            if is_done || meshes.len() > MESHES {
                return Err(RatesError::Joined(limit));
            }
        } else if is_done {
            let map = settings.map.map(|side| {
                let committor = places.committor(&field, &nodes)?;
                Ok::<_, Unsolved>(Map::new(&field, &nodes, &committor, side))
            });
            let map = map.transpose()?;
            let all: f64 = meshes[meshes.len() - 1].volumes.iter().sum();
            let inside = places.inside(&field, settings, beyond);
            let inside = inside.iter().map(|own| own / all).collect();
            let upper = places.upper_bounds(&field, &nodes, beyond, &functions);
            let found = bounded(problem, settings, [ground, beyond])?;
            let (between, bounds, proved) = found.unwrap_or_default();
            // Values lie between their bounds; of two that do the better known ones are taken: those
            // midway are off by half of what the bounds are apart at most.
            let is_better = |between: &MeshRates| {
                let holds = bounds
                    .as_ref()
                    .is_some_and(|it| it.hold(&meshes[meshes.len() - 1]));
                !holds || 0.5 * between.error < error
            };
            let between = between.filter(is_better);
            let is_between_bounds = between.is_some();
            meshes.extend(between);
            let links = links(&ways, &places.closed, &blocked);
            let bounds = match bounds {
                Some(bounds) => Some(bounds.or_below(&upper)),
                None => settings.certify.map(|_| upper),
            };
            return Ok(Rates {
                meshes,
                is_between_bounds,
                bounds: bounds.map(|bounds| bounds.known(&links)),
                map,
                inside,
                ways,
                links,
                proved: match proved.is_empty() {
                    true => vec![None; settings.basins.len()],
                    false => proved,
                },
            });
        }
        for &(cell, _) in &places.shared {
            shares[cell] = f64::MAX.sqrt();
        }
        grows = field.refine(&shares, DIVIDED);
        earlier = Some((nodes, functions));
    }
}

/// How often tiles leave a bond for good: rates of overdamped motion, divided by D (1/m^2) unless it is
/// said otherwise. With C what flows from the bond to free tiles and h the committor:
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loosening {
    /// C / Z(h), over the time until tiles are free.
    pub rate: f64,
    /// What bounds that from below and above.
    pub bounds: [f64; 2],
    /// C / Z(well), over the time in the well alone.
    ///
    /// Over the time until the well is last left it is C / Z(h^2), between the two, for the way from
    /// there to `free` takes Z(h (1 - h)) / C (transition path theory; E and Vanden-Eijnden,
    /// doi:10.1007/s10955-005-9003-9).
    pub in_well: f64,
}

impl Loosening {
    /// Out of the well below half the depth of the bond at `bound`, at `kt` (J), to
    /// `free_distance`.
    ///
    /// # Errors
    /// As [`rates()`].
    pub fn new(problem: &Problem, bound: &Configuration, kt: f64) -> Result<Self, RatesError> {
        let bond = Basin {
            at: *bound,
            below: half_bond(problem, bound),
        };
        let settings = RateSettings::new(kt, vec![bond], problem.space.free_distance);
        let found = rates(problem, &settings)?;
        let finest = found.finest();
        let rate: f64 = finest.rates[0].iter().sum();
        let bounds = found.bounds.as_ref().map(|bounds| bounds.leaving[0]);
        Ok(Self {
            rate,
            bounds: bounds.unwrap_or([0.0, f64::INFINITY]),
            in_well: rate * (finest.occupation[0] / found.inside[0]).max(1.0),
        })
    }

    /// All of them times a diffusion coefficient (m^2/s): 1/s.
    #[must_use]
    pub fn times(self, diffusion: f64) -> Self {
        Self {
            rate: self.rate * diffusion,
            bounds: self.bounds.map(|bound| bound * diffusion),
            in_well: self.in_well * diffusion,
        }
    }
}

/// Unknowns at which meshes are fine enough: what is asked, or half as many again as the first has.
pub(super) fn enough(asked: usize, first: usize) -> usize {
    asked.max(first + first / 2)
}
