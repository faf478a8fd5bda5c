//! Certified bounds for the barriers of an inventory.

use std::time::{Duration, Instant};

use crate::analysis::Settings;
use crate::configuration::Configuration;
use crate::design::Design;
use crate::landscape::certificate::{Bracket, Certifier, Effort, End};
use crate::landscape::inventory::Inventory;
use crate::landscape::{Barrier, Place, StateKind, pathway};
use crate::pipeline::{self, Observer};
use crate::potential::MagnetModel;
use crate::potential::bounds::{CellBounds, DipoleBounds};
use crate::problem::Problem;

/// Cells spent on one barrier at most, so that a hard one leaves time for the others.
const MOST_CELLS: usize = 1_000_000;
/// Energy tolerance of pathways, as a fraction of the bond's depth.
const BEND: f64 = 1e-3;

/// Why barriers have no certified bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Uncertified {
    #[error("no time was given to the certificate")]
    NoTime,
    #[error("bounds over cells are known for point dipoles, not for blocks")]
    Blocks,
    #[error("bounds over cells are not known for magnets with shields")]
    Shields,
}

/// The bounds over cells of a design's energy.
///
/// # Errors
/// Where no such bounds are known for the way its magnets are modelled.
pub fn bounds(design: &Design) -> Result<Box<dyn CellBounds>, Uncertified> {
    match design.model {
        _ if !design.shields.is_none() => Err(Uncertified::Shields),
        MagnetModel::Dipole => Ok(Box::new(DipoleBounds::new(&design.fixed, &design.moving))),
        MagnetModel::Cuboid => Err(Uncertified::Blocks),
    }
}

/// Brackets every barrier of an inventory between two bounds that hold for the model, and takes
/// over pathways of the certificate that lie lower. Where the bound state has no way to `free`, a
/// proof is tried that there is none. Returns the number of cells assessed.
///
/// The bounds are narrowed to `settings.tolerance`; after `settings.certify_seconds` in all, the
/// bounds known by then are kept, so that only results within the limit are the same on every
/// machine.
///
/// # Errors
/// Where nothing is certified; the inventory is then left as it is.
pub fn certify(
    design: &Design,
    problem: &Problem,
    inventory: &mut Inventory,
    settings: &Settings,
    observer: &dyn Observer,
) -> Result<usize, Uncertified> {
    let bounds = bounds(design)?;
    let limit = Duration::from_secs_f64(settings.certify_seconds.clamp(0.0, 1e9));
    if limit.is_zero() {
        return Err(Uncertified::NoTime);
    }
    let depth = pipeline::energy_scale(design, problem);
    let tolerance = settings.tolerance.unwrap_or(0.01 * depth);
    let mut certifier = Certifier::new(bounds.as_ref(), problem.contact.as_ref(), &problem.space);
    let since = Instant::now();
    inventory.barriers.extend(missing_way_out(inventory));
    let count = inventory.barriers.len();
    for number in 0..count {
        observer.part("certificate", number, count);
        let barrier = &mut inventory.barriers[number];
        let Place::State(from) = barrier.from else {
            continue;
        };
        let to = match barrier.to {
            Place::State(to) => End::At(inventory.states[to].configuration),
            Place::Free => End::Free,
        };
        let known: Vec<Configuration> = barrier.pathway.iter().map(|p| p.configuration).collect();
        let effort = Effort {
            tolerance,
            cells: MOST_CELLS,
            time: Some(limit.saturating_sub(since.elapsed())),
        };
        let start = inventory.states[from].configuration;
        if let Ok(bracket) = certifier.bracket(&start, &to, &known, &effort) {
            take_over(problem, barrier, &bracket, BEND * depth);
        }
    }
    spread_to_escapes(inventory);
    Ok(certifier.assessed())
}

/// The barrier from the bound state to `free`, where no way was found: with no pathway yet, and
/// infinite.
fn missing_way_out(inventory: &Inventory) -> Option<Barrier> {
    let bound = inventory
        .states
        .first()
        .filter(|state| state.kind == StateKind::Bound)?;
    let place = Place::State(bound.id);
    if inventory
        .barriers
        .iter()
        .any(|b| b.from == place && b.to == Place::Free)
    {
        return None;
    }
    Some(Barrier {
        from: place,
        to: Place::Free,
        saddle_energy: f64::INFINITY,
        saddle: bound.configuration,
        lower: None,
        upper: None,
        caged: false,
        from_energy: bound.energy,
        to_energy: 0.0,
        spread: None,
        pathway: Vec::new(),
    })
}

fn take_over(problem: &Problem, barrier: &mut Barrier, bracket: &Bracket, bend: f64) {
    barrier.lower = bracket.lower.is_finite().then_some(bracket.lower);
    barrier.upper = bracket.upper;
    barrier.caged = bracket.caged;
    // In place of a pathway that could not be proved the certificate's own may lie higher.
    let lower = |upper: f64| upper < barrier.saddle_energy;
    if !bracket.improved || !bracket.upper.is_some_and(lower) {
        return;
    }
    let pathway = pathway::of_configurations(problem, &bracket.pathway, bend);
    if let Some(highest) = pathway::highest_point(&pathway).copied() {
        barrier.saddle_energy = highest.energy;
        barrier.saddle = highest.configuration;
        barrier.pathway = pathway;
    }
}

/// Gives the bounds of a class's escape to the escapes of all its states, and a lower pathway to
/// the escape of its first.
fn spread_to_escapes(inventory: &mut Inventory) {
    for id in 0..inventory.states.len() {
        let class = inventory.states[id].class;
        let Some(to) = inventory.escapes[class].as_ref().map(|escape| escape.to) else {
            continue;
        };
        let certified = inventory
            .barriers
            .iter()
            .find(|barrier| barrier.from == Place::State(class) && barrier.to == to);
        if let (Some(certified), Some(escape)) = (certified, &mut inventory.escapes[id]) {
            if id == class {
                *escape = certified.clone();
            } else {
                escape.lower = certified.lower;
                escape.upper = certified.upper;
            }
        }
    }
}
