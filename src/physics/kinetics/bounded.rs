//! Bounds of rates, and what is proved of them.

use super::certify::narrowed;
use super::field::Field;
use super::mesh::Nodes;
use super::places::{DEEP, Places};
use super::proof::{self, Capacity, Set};
use super::rates::{Basin, MeshRates, RateSettings, RatesError};
use crate::configuration::Configuration;
use crate::problem::Problem;

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

/// What a mesh with bounds says, these, and what is proved on it.
pub(super) type Certified = (Option<MeshRates>, Option<RateBounds>, Vec<Option<Leaving>>);

/// What the finest of meshes that begin at contact says, and its bounds, if there are any. Energies
/// are counted from `ground` (J), and `beyond` is the occupation of the table outside the mesh.
pub(super) fn bounded(
    problem: &Problem,
    settings: &RateSettings,
    [ground, beyond]: [f64; 2],
) -> Result<Option<Certified>, RatesError> {
    let seeds: Vec<Configuration> = settings.basins.iter().map(|basin| basin.at).collect();
    let fitted = Field::fitted(problem, settings.kt, settings.free_at, ground, &seeds);
    let (Some(certify), Some(mut field)) = (settings.certify, fitted) else {
        return Ok(None);
    };
    let mut all = narrowed(&mut field, &certify, |field| {
        let places = Places::new(field, settings)?;
        let nodes = Nodes::new(&field.mesh);
        Ok::<_, RatesError>(Some(places.bounds(field, &nodes, beyond)?))
    })?;
    let count = settings.basins.len() + 1;
    let proved = proved(&mut field, settings);
    Ok(all.pop().map(|step| {
        let rates = step.bounds[count..].chunks(count);
        let bounds = RateBounds {
            leaving: step.bounds[..count].to_vec(),
            rates: rates.map(<[_]>::to_vec).collect(),
        };
        (step.rates, Some(bounds), proved)
    }))
}

/// What can be proved of how each basin is left, where that is asked for. Basins reach as high as on
/// the mesh where they are reached, and below their limits where they are left.
fn proved(field: &mut Field, settings: &RateSettings) -> Vec<Option<Leaving>> {
    let Some(asked) = settings.certify.and_then(|certify| certify.proof()) else {
        return Vec::new();
    };
    let deep = field.level() - DEEP * field.kt;
    let end = |basin: &Basin| Set {
        at: basin.at,
        below: basin.below.max(deep),
        wide: basin.below.max(deep),
    };
    let basins = settings.basins.iter().enumerate();
    basins
        .map(|(own, basin)| {
            let first = Set {
                below: basin.below,
                ..end(basin)
            };
            let others = settings.basins.iter().enumerate();
            let others = others.filter(|(other, _)| *other != own);
            let sets: Vec<Set> = [first]
                .into_iter()
                .chain(others.map(|(_, other)| end(other)))
                .collect();
            Some(Leaving {
                capacity: proof::capacity(field, &sets, asked)?,
                end_below: end(basin).below,
            })
        })
        .collect()
}
