//! Certified bounds for the barriers of an inventory.

mod joined;

use std::time::{Duration, Instant};

use crate::analysis::Settings;
use crate::configuration::Configuration;
use crate::design::Design;
use crate::landscape::certificate::{Bracket, Certifier, Effort, End};
use crate::landscape::inventory::Inventory;
use crate::landscape::symmetry::Symmetry;
use crate::landscape::{Barrier, Pathway, PathwayPoint, Place, StateKind, pathway};
use crate::pipeline::{self, Observer};
use crate::potential::MagnetModel;
use crate::potential::bounds::{CellBounds, CuboidBounds, DipoleBounds, ShieldedBounds};
use crate::potential::shielding::ShieldRule;
use crate::problem::Problem;

/// Cells spent on narrowing the bounds of a small barrier further.
const MORE_CELLS: usize = 20_000;
/// Bounds are narrowed to this share of the bond's depth, and to this share of the barrier, but not
/// below that share of the bond's depth.
const SHARE_OF_BOND: f64 = 0.01;
const SHARE_OF_BARRIER: f64 = 0.05;
const LEAST_SHARE: f64 = 1e-5;
/// Energy tolerance of pathways, as a fraction of the bond's depth.
const BEND: f64 = 1e-3;
/// How much lower a chain of pathways must be than a direct one, as a fraction of the bond's depth.
const LEAST_GAIN: f64 = 1e-6;
/// States whose energies differ by less than this share are as deep as each other.
const SAME_ENERGY: f64 = 1e-6;

/// Why barriers have no certified bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Uncertified {
    #[error("no time was given to the certificate")]
    NoTime,
    #[error("bounds over cells are not known for blocks with shields; for dipoles they are")]
    ShieldedBlocks,
    #[error("the energy jumps where the nearest-face rule changes faces")]
    NearestFace,
}

/// The bounds over cells of a design's energy.
///
/// # Errors
/// Where no such bounds are known for the way its magnets are modelled.
pub fn bounds(design: &Design) -> Result<Box<dyn CellBounds>, Uncertified> {
    let (fixed, moving, shields) = (&design.fixed, &design.moving, &design.shields);
    match design.model {
        _ if shields.rule == ShieldRule::NearestFace => Err(Uncertified::NearestFace),
        MagnetModel::Dipole if shields.is_none() => Ok(Box::new(DipoleBounds::new(fixed, moving))),
        MagnetModel::Dipole => Ok(Box::new(ShieldedBounds::new(fixed, moving, shields))),
        MagnetModel::Cuboid if shields.is_none() => Ok(Box::new(CuboidBounds::new(fixed, moving))),
        MagnetModel::Cuboid => Err(Uncertified::ShieldedBlocks),
    }
}

/// Brackets every barrier of an inventory between two bounds that hold for the model, and takes
/// over pathways of the certificate that lie lower. Where the bound state has no way to `free`, a
/// proof is tried that there is none. Returns the number of cells assessed.
///
/// The bounds are narrowed to `settings.tolerance`, or to a hundredth of the bond and a twentieth of
/// the barrier, whichever is less; after `settings.certify_seconds` in all, the
/// bounds known by then are kept, so that only results within the limit are the same on every
/// machine.
///
/// # Errors
/// Where nothing is certified; the inventory is then left as it is.
pub fn certify(
    design: &Design,
    problem: &Problem,
    symmetries: &[Symmetry],
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
    let mut certifier = Certifier::new(bounds.as_ref(), problem.contact.as_ref(), &problem.space);
    let since = Instant::now();
    inventory.barriers.extend(missing_way_out(inventory));
    let count = inventory.barriers.len();
    let passes: &[Pass] = match settings.tolerance {
        Some(tolerance) => &[(settings.certify_cells, &move |_| tolerance)],
        None => &[
            (settings.certify_cells, &|_| SHARE_OF_BOND * depth),
            (MORE_CELLS.min(settings.certify_cells), &|barrier| {
                narrow_width(barrier, depth)
            }),
        ],
    };
    for (pass, (cells, width)) in passes.iter().enumerate() {
        for number in 0..count {
            observer.part("certificate", pass * count + number, passes.len() * count);
            let barrier = &inventory.barriers[number];
            if !inventory.is_claimed(barrier, settings.claims) {
                continue;
            }
            let effort = Effort {
                tolerance: width(barrier),
                cells: *cells,
                time: Some(limit.saturating_sub(since.elapsed())),
            };
            if is_as_narrow(barrier, effort.tolerance) {
                continue;
            }
            if let Some(bracket) = bracket(&mut certifier, inventory, barrier, &effort) {
                let barrier = &mut inventory.barriers[number];
                take_over(problem, barrier, &bracket, BEND * depth);
            }
        }
        joined::take_over_chains(&problem.space, inventory, LEAST_GAIN * depth);
    }
    certify_escapes(inventory, LEAST_GAIN * depth);
    inventory.copy_escapes(problem, symmetries);
    Ok(certifier.assessed())
}

/// Cells spent on a barrier at most, and the width (J) that its bounds are to have.
type Pass<'a> = (usize, &'a dyn Fn(&Barrier) -> f64);

fn bracket(
    certifier: &mut Certifier,
    inventory: &Inventory,
    barrier: &Barrier,
    effort: &Effort,
) -> Option<Bracket> {
    let Place::State(from) = barrier.from else {
        return None;
    };
    let start = inventory.states[from].configuration;
    let to = match barrier.to {
        Place::State(to) => End::At(inventory.states[to].configuration),
        Place::Free => End::Free,
    };
    let known: Vec<Configuration> = barrier.pathway.iter().map(|p| p.configuration).collect();
    certifier.bracket(&start, &to, &known, effort).ok()
}

/// Whether the bounds that a barrier has need no narrowing.
fn is_as_narrow(barrier: &Barrier, width: f64) -> bool {
    let bounds = barrier.lower.zip(barrier.upper);
    barrier.caged || bounds.is_some_and(|(lower, upper)| upper - lower <= width)
}

/// Width (J) that tells something of a barrier much smaller than the bond, too.
fn narrow_width(barrier: &Barrier, depth: f64) -> f64 {
    let of_barrier = (SHARE_OF_BARRIER * barrier.forward()).max(LEAST_SHARE * depth);
    of_barrier.min(SHARE_OF_BOND * depth)
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
    let lower = bracket.lower.is_finite().then_some(bracket.lower);
    barrier.lower = either(barrier.lower, lower, f64::max);
    barrier.upper = either(barrier.upper, bracket.upper, f64::min);
    barrier.caged = bracket.caged;
    // In place of a pathway that could not be proved the certificate's own may lie higher.
    let lower = |upper: f64| upper < barrier.saddle_energy;
    if !bracket.improved || !bracket.upper.is_some_and(lower) {
        return;
    }
    // The certificate's own leads through the middles of its cells.
    let upper = bracket.upper.unwrap_or(f64::INFINITY);
    let direct = pathway::shortened(problem, &bracket.pathway, upper, 0.1 * bend);
    for points in [&direct, &bracket.pathway] {
        let pathway = pathway::of_configurations(problem, points, bend);
        let highest = pathway::highest_point(&pathway).copied();
        if let Some(highest) = highest.filter(|highest| highest.energy <= upper) {
            lead_along(barrier, pathway, &highest);
            return;
        }
    }
}

/// Gives a barrier another pathway with its highest point.
fn lead_along(barrier: &mut Barrier, pathway: Pathway, highest: &PathwayPoint) {
    barrier.saddle_energy = highest.energy;
    barrier.saddle = highest.configuration;
    barrier.pathway = pathway;
}

/// The better of two bounds, of which either may be missing.
pub(crate) fn either(
    a: Option<f64>,
    b: Option<f64>,
    better: impl Fn(f64, f64) -> f64,
) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(better(a, b)),
        _ => a.or(b),
    }
}

/// Gives the escapes of the first state of each class the certified barriers that they stand for;
/// or, where the certificate found one lower by more than `gain` (J), another barrier from there to
/// `free` or to a lower state.
fn certify_escapes(inventory: &mut Inventory, gain: f64) {
    let barriers = &inventory.barriers;
    for escape in inventory.escapes.iter_mut().flatten() {
        let below = escape.from_energy - SAME_ENERGY * escape.from_energy.abs();
        let (from, to) = (escape.from, escape.to);
        let leads_down = |barrier: &&Barrier| {
            let is_lower = barrier.to == Place::Free || barrier.to_energy < below;
            barrier.from == from && is_lower && !barrier.pathway.is_empty()
        };
        let certified = barriers.iter().find(|b| b.from == from && b.to == to);
        let lowest = barriers
            .iter()
            .filter(leads_down)
            .min_by(|a, b| a.saddle_energy.total_cmp(&b.saddle_energy));
        let known = certified.map_or(escape.saddle_energy, |b| b.saddle_energy);
        let lowest = lowest.filter(|b| b.saddle_energy < known - gain);
        if let Some(barrier) = lowest.or(certified) {
            *escape = barrier.clone();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::joined::tests::{barrier, state};
    use super::*;

    #[test]
    fn an_escape_is_the_lowest_certified_way_down() {
        let to_free = barrier(0, None, 5.0);
        let to_lower = Barrier {
            to_energy: -2.0,
            ..barrier(0, Some(1), 3.0)
        };
        let to_higher = Barrier {
            to_energy: -0.5,
            ..barrier(0, Some(2), 1.0)
        };
        let mut inventory = Inventory {
            states: (0..3).map(state).collect(),
            escapes: vec![Some(to_free.clone()), None, None],
            barriers: vec![to_free, to_lower.clone(), to_higher],
            alternatives: Vec::new(),
            bound_state: None,
            shallow: 0,
        };
        certify_escapes(&mut inventory, 1e-6);
        assert_eq!(inventory.escapes[0], Some(to_lower));
    }
}
