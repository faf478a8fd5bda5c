//! Rates between basins: the wells of states, and tiles far apart.

pub(super) mod corridor;
pub mod distance;
mod errors;
pub mod exit;
mod field;
mod links;
pub mod map;
mod narrow;
mod places;
mod results;
mod rim;
mod sets;

use std::f64::consts::{PI, TAU};

use self::corridor::PathToFree;
use self::field::{DIVIDED, Earlier, MeshField};
use self::links::links;
use self::map::Map;
use self::places::Places;
pub use self::results::{Basin, MeshRates, RateSettings, Rates, RatesError};
use self::results::{DEEPEST, MESHES, enough, half_bond};
use crate::kinetics::mesh::{Nodes, Unsolved};
use tiles::configuration::Configuration;
use tiles::problem::Problem;

/// The rates between basins and `free`.
///
/// # Errors
/// If the places are not separate, or a linear system cannot be solved.
pub fn rates(problem: &Problem, settings: &RateSettings) -> Result<Rates, RatesError> {
    rates_on(problem, settings, |_| ())
}

/// The same; `on_mesh` gets the rates on each mesh as soon as they are known, coarse meshes first.
///
/// # Errors
/// As [`rates()`].
pub fn rates_on(
    problem: &Problem,
    settings: &RateSettings,
    on_mesh: impl Fn(&MeshRates),
) -> Result<Rates, RatesError> {
    let RateSettings { kt, free_at, .. } = *settings;
    let area = problem.space.half_size.map(|half| 2.0 * half);
    let outside = area[0] * area[1] - PI * free_at * free_at;
    let is_beyond = |basin: &Basin| libm::hypot(basin.at.x, basin.at.y) >= free_at;
    if outside <= 0.0 || settings.basins.iter().any(is_beyond) {
        return Err(RatesError::NoFree(free_at));
    }
    let seeds: Vec<Configuration> = settings.basins.iter().map(|basin| basin.at).collect();
    let ground = settings.ground(problem);
    if -ground > DEEPEST * kt {
        return Err(RatesError::Cold(kt, -ground / kt));
    }
    let all_seeds = with_images(problem, &seeds);
    let mut field = MeshField::new(
        problem,
        (kt, settings.both_move),
        free_at,
        ground,
        &all_seeds,
    );
    let ways: Vec<PathToFree> = seeds.iter().map(|seed| field.open_way(seed)).collect();
    let blocked = field.blocked(&seeds);
    field.settle(&all_seeds, &seeds);
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
        // If no flow remains, its error is unknown.
        let error = match left.is_empty() {
            true => f64::INFINITY,
            false => errors.largest,
        };
        let mut shares = errors.shares;
        let unknowns = found.unknowns;
        let found = MeshRates {
            error,
            of_rims: errors.of_rims,
            ..found
        };
        // Basins that share cells are not told apart yet.
        if places.shared.is_empty() {
            on_mesh(&found);
        }
        meshes.push(found);
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
            let links = links(&ways, &places.closed, &blocked);
            return Ok(Rates {
                meshes,
                map,
                inside,
                ways,
                links,
            });
        }
        for &(cell, _) in &places.shared {
            shares[cell] = f64::MAX.sqrt();
        }
        grows = field.refine(&shares, DIVIDED);
        earlier = Some((nodes, functions));
    }
}

/// Configurations together with those that the exchange of equal tiles maps them onto.
fn with_images(problem: &Problem, seeds: &[Configuration]) -> Vec<Configuration> {
    let exchange = problem.exchange.iter();
    let images = exchange.flat_map(|map| seeds.iter().map(|seed| map.apply(seed)));
    seeds.iter().copied().chain(images).collect()
}

/// The rates at which tiles leave a bond for good in overdamped motion, divided by D (1/m^2) unless
/// stated otherwise. With C the flow from the bond to free tiles and h the committor:
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loosening {
    /// C / Z(h), relative to the time until tiles are free.
    pub rate: f64,
    /// C / Z(well), relative to the time in the well alone.
    ///
    /// Relative to the time until the well is last left the rate is C / Z(h^2), between the two,
    /// since the path from there to `free` takes Z(h (1 - h)) / C (transition path theory; E and
    /// Vanden-Eijnden, doi:10.1007/s10955-005-9003-9).
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
        Ok(Self {
            rate,
            in_well: rate * (finest.occupation[0] / found.inside[0]).max(1.0),
        })
    }

    /// All of them times a diffusion coefficient (m^2/s): 1/s.
    #[must_use]
    pub fn times(self, diffusion: f64) -> Self {
        Self {
            rate: self.rate * diffusion,
            in_well: self.in_well * diffusion,
        }
    }
}
