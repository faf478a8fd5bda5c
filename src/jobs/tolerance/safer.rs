//! Changed designs, with the same errors: magnets deeper in their faces, closer together or farther
//! apart.
//!
//! These are re-runs with the same random numbers, whose states are minimised anew from those of the
//! design; no states are searched.

use super::anew::SAME_BOND;
use super::made::Maker;
use super::request::MakingErrors;
use super::well::Well;
use super::{Drawn, Pairs, Spread, Study, expansion, working};
use crate::design::Design;
use nalgebra::Vector2;
use physics::configuration::Configuration;
use physics::landscape::Proportion;
use physics::landscape::minimum::{self, descend};
use physics::parallel;
use physics::problem::Problem;
use physics::tile::{Magnet, Pair, Tile};
use std::sync::Arc;

/// How much deeper magnets are set, as a share of their length.
const DEEPER: [f64; 2] = [0.1, 0.2];
/// Ratios of the magnets' distances from the middle of their face.
const SPREAD: [f64; 2] = [0.95, 1.05];
/// Most draws of a re-run.
const MOST_DRAWS: usize = 400;
/// Most traps of a re-run, deepest first.
const MOST_TRAPS: usize = 40;

/// A changed design with the same errors.
#[derive(Clone, Debug, PartialEq)]
pub struct Safer {
    /// The changed key: `inset` or `pitch`.
    pub key: &'static str,
    /// By how much (m): added to the inset, or to the distance of neighbours.
    pub by: f64,
    /// The nominal pair.
    pub nominal: Drawn,
    /// The bond's energy (J).
    pub bond: Spread,
    /// The share of the draws that work.
    pub works: Proportion,
    /// The share of as many draws of the design itself.
    pub unchanged: Proportion,
}

/// Re-runs of a study with changed insets and pitches.
/// `outcomes` are the draws of the design itself.
pub(super) fn safer(
    study: &Study,
    (making, seed): (&MakingErrors, u64),
    outcomes: &[Drawn],
) -> Vec<Safer> {
    let pair = &study.design.pair;
    let sizes = [&pair.fixed, &pair.moving].map(Tile::largest_magnet);
    let size = sizes[0].max(sizes[1]);
    let pitch = study.design.pitch;
    let deeper = DEEPER.map(|share| ("inset", share * size, 1.0, share * size));
    let spread = SPREAD.map(|ratio| ("pitch", pitch.unwrap_or(0.0) * (ratio - 1.0), ratio, 0.0));
    let changes = deeper
        .into_iter()
        .chain(spread.into_iter().filter(|_| pitch.is_some()));
    let count = outcomes.len().min(MOST_DRAWS);
    let least = making.least_selectivity();
    let unchanged = working(&outcomes[..count], least);
    let rerun = |(key, by, ratio, deeper): (&'static str, f64, f64, f64)| {
        let pair = Arc::new(changed(pair, ratio, deeper)?);
        let design = Design {
            pair,
            ..study.design.clone()
        };
        let problem = design.problem();
        let study = followed(study, &design, &problem, making)?;
        let maker = Maker::new(&design.pair, making, seed);
        let (_, outcomes) = study.draw(&maker, count, &|_| ());
        let nominal = study.outcome(&expansion::unchanged(&design.pair));
        Some(Safer {
            key,
            by,
            nominal,
            bond: Spread::new(nominal.bond, outcomes.iter().map(|it| it.bond)),
            works: working(&outcomes, least),
            unchanged,
        })
    };
    changes.filter_map(rerun).collect()
}

/// A study of a changed design, with its states at rest anew from those of the design.
fn followed<'a>(
    study: &'a Study,
    design: &'a Design,
    problem: &'a Problem,
    making: &MakingErrors,
) -> Option<Study<'a>> {
    let rest = |q: &Configuration| match descend(problem, q).outcome {
        minimum::Outcome::Minimum(found) => Some(found.point.q),
        _ => None,
    };
    let pairs = Pairs::new(design, making);
    let bond = rest(&study.bond.expansion.q)?;
    let near = problem.scaled(SAME_BOND);
    let traps = &study.traps[..study.traps.len().min(MOST_TRAPS)];
    let traps = parallel::map(traps, |trap| {
        let q = rest(&trap.expansion.q)?;
        (problem.distance_to_bond(&q) >= near).then(|| Well::at(problem, &pairs, &q))
    });
    Some(Study {
        design,
        problem,
        catalogue: study.catalogue,
        bond: Well::at(problem, &pairs, &bond),
        traps: traps.into_iter().flatten().collect(),
    })
}

/// The tiles with their magnets' distances from the middle of the face in this ratio, and deeper (m);
/// `None` if magnets would leave their tile or meet.
fn changed(pair: &Pair, ratio: f64, deeper: f64) -> Option<Pair> {
    let tile = |tile: &Tile| {
        let magnets = tile.magnets.iter().map(|magnet| {
            let face = &tile.faces[magnet.face];
            let s = (magnet.position - face.middle()).dot(&face.tangent());
            let shift: Vector2<f64> = face.tangent() * (s * (ratio - 1.0)) - face.normal() * deeper;
            Magnet {
                position: magnet.position + shift,
                ..magnet.clone()
            }
        });
        let magnets: Vec<Magnet> = magnets.collect();
        let fits = |k: usize| {
            let own = tile.magnets[k].wall(&tile.outline).min(0.0);
            // Flat magnets may stand closer than their largest size, but not closer than in the design.
            let apart = magnets[..k].iter().enumerate().all(|(j, other)| {
                let reach = |it: &Magnet| it.size[0].max(it.size[1]) / 2.0;
                let distance = |all: [&Magnet; 2]| (all[0].position - all[1].position).norm();
                let now = distance([&magnets[k], other]);
                let before = distance([&tile.magnets[k], &tile.magnets[j]]);
                now >= (reach(&magnets[k]) + reach(other)).min(before)
            });
            magnets[k].wall(&tile.outline) >= own - 1e-9 && apart
        };
        let all_fit = (0..magnets.len()).all(fits);
        all_fit.then(|| Tile {
            magnets: magnets.clone(),
            ..tile.clone()
        })
    };
    Some(Pair {
        fixed: tile(&pair.fixed)?,
        moving: tile(&pair.moving)?,
        ..pair.clone()
    })
}
