//! Checks of followed states: exact energies, and full searches.

use super::made::{Draw, Maker};
use super::{Drawn, Request, Study, working};
use crate::design::Design;
use crate::pipeline;
use ordered_float::OrderedFloat;
use physics::configuration::Configuration;
use physics::landscape::minimum::{self, descend};
use physics::landscape::{Proportion, stationary};
use physics::observer::{Observer, Silent};
use physics::parallel;
use physics::problem::Problem;
use std::sync::Arc;

/// Number of draws whose bond and deepest trap are minimised with exact energies.
const EXACT: usize = 40;
/// Draws analysed anew on each thread before those done are told.
const CHECKS_A_THREAD: usize = 4;
/// A state of a draw this close (m, metric of the space, for the paper's tile) to a contact that
/// counts as the bond is one.
pub(super) const SAME_BOND: f64 = 5e-3;

/// Followed energies beside exact ones of the same draws.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exact {
    /// The number of draws.
    pub draws: usize,
    /// Root mean square and largest relative error of the bond's energy.
    pub bond: [f64; 2],
    /// The same of the deepest trap's; `None` without traps.
    pub trap: Option<[f64; 2]>,
}

/// Draws that were analysed anew, with a search of their own states.
#[derive(Clone, Debug, PartialEq)]
pub struct Anew {
    /// The share of them that works.
    pub works: Proportion,
    /// The share of the same draws that works by followed states.
    pub followed: Proportion,
    /// The number of draws on which both agree.
    pub agree: usize,
    /// Largest relative difference of the bond's energy, and of the deepest trap's, where the new search has one.
    pub differences: [f64; 2],
}

/// The design of a draw.
fn design(study: &Study, maker: &Maker, draw: &Draw) -> Design {
    Design {
        pair: Arc::new(maker.pair(draw)),
        ..study.design.clone()
    }
}

/// The energy (J) of a draw where a motion from a configuration comes to rest.
fn at_rest(problem: &Problem, q: &Configuration) -> f64 {
    if let Some(found) = stationary::minimum(problem, q) {
        return found.point.energy;
    }
    match descend(problem, q).outcome {
        minimum::Outcome::Minimum(found) => found.point.energy,
        _ => problem.energy(q),
    }
}

/// Minimises bond and deepest trap of the first draws with exact energies.
pub(super) fn exact(study: &Study, maker: &Maker, draws: &[Draw], outcomes: &[Drawn]) -> Exact {
    let count = draws.len().min(EXACT);
    let errors = parallel::map(0..count, |k| {
        let problem = design(study, maker, &draws[k]).problem();
        let (followed, relative) = (&outcomes[k], |a: f64, b: f64| (a - b) / b.abs());
        let bond = at_rest(&problem, &study.bond.expansion.q);
        let trap = followed.which.zip(followed.trap).map(|(which, trap)| {
            relative(trap, at_rest(&problem, &study.traps[which].expansion.q))
        });
        (relative(followed.bond, bond), trap)
    });
    let summary = |errors: Vec<f64>| {
        let square = errors.iter().map(|it| it * it).sum::<f64>() / errors.len() as f64;
        let largest = errors.iter().map(|it| it.abs()).fold(0.0, f64::max);
        [square.sqrt(), largest]
    };
    let traps: Vec<f64> = errors.iter().filter_map(|it| it.1).collect();
    Exact {
        draws: count,
        bond: summary(errors.iter().map(|it| it.0).collect()),
        trap: (!traps.is_empty()).then(|| summary(traps)),
    }
}

/// Analyses the first draws anew; `None` if none is requested.
pub(super) fn anew(
    study: &Study,
    maker: &Maker,
    draws: &[Draw],
    outcomes: &[Drawn],
    (request, least): (&Request, f64),
    observer: &dyn Observer,
) -> Option<Anew> {
    let count = draws.len().min(request.checks);
    if count == 0 {
        return None;
    }
    let settings = pipeline::Request::without_proofs(request.seed);
    observer.stage("check", 0.9);
    let batch = CHECKS_A_THREAD * parallel::threads();
    let tell = |done| observer.part("checks (fewer: --checks)", done, count);
    let found = parallel::map_in_batches(0..count, batch, tell, |k| {
        let design = design(study, maker, &draws[k]);
        let analysis = pipeline::analyse(&design, &settings, &Silent);
        let (nominal, within) = (study.problem, study.problem.scaled(SAME_BOND));
        let own = design.pair.bound;
        let states = &analysis.catalogue.states;
        let deepest = |holds: &dyn Fn(&Configuration) -> bool| {
            let energies = states.iter().filter(|it| holds(&it.configuration));
            energies
                .map(|it| it.energy)
                .min_by_key(|it| OrderedFloat(*it))
        };
        let bond = deepest(&|q| nominal.space.distance(q, &own) < within);
        let trap = deepest(&|q| nominal.distance_to_bond(q) >= within);
        Drawn {
            // Without a minimum at the contact, there is no bond.
            bond: bond.unwrap_or(0.0),
            trap,
            ..outcomes[k]
        }
    });
    let followed = &outcomes[..count];
    let both = || followed.iter().zip(&found);
    let largest = |of: &dyn Fn(&Drawn) -> f64| {
        let known = both().filter(|(_, b)| of(b) != 0.0);
        let relative = known.map(|(a, b)| ((of(a) - of(b)) / of(b)).abs());
        relative.fold(0.0, f64::max)
    };
    Some(Anew {
        works: working(&found, least),
        followed: working(followed, least),
        agree: both()
            .filter(|(a, b)| a.works(least) == b.works(least))
            .count(),
        differences: [
            largest(&|it| it.bond),
            largest(&|it| it.trap.unwrap_or(0.0)),
        ],
    })
}
