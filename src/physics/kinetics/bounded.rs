//! Bounds of rates, and what is proved of them.

use super::certify::narrowed;
use super::field::Field;
use super::mesh::Nodes;
use super::places::Places;
use super::proof::{self, Set};
use super::results::{Basin, Leaving, MeshRates, RateBounds, RateSettings, RatesError};
use crate::configuration::Configuration;
use crate::problem::Problem;

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
    let deep = field.deep();
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
