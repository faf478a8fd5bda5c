//! The pathways and trajectories that a page plays.

use serde::Serialize;

use super::{finite, fixed, rounded};
use crate::dynamics::Snapshot;
use crate::landscape::{Pathway, Place};
use crate::problem::Problem;
use crate::report::csv;
use crate::report::plots::Scene;

/// Most pathways of a page.
const MOST: usize = 24;

/// A pathway or a trajectory to play.
#[derive(Clone, Debug, Serialize)]
pub struct Played {
    name: String,
    /// Whether its points are told apart by the time (s), not by the length along it, and have a
    /// kinetic energy.
    timed: bool,
    /// Ids of the states at its ends; null for tiles far apart.
    ends: [Option<usize>; 2],
    /// Certified bounds of its highest energy (J).
    bounds: Option<[f64; 2]>,
    /// s (m) or t (s), x (m), y (m), theta (rad), U (J), clearance (m), kinetic energy (J).
    points: Vec<[f64; 7]>,
}

impl Played {
    /// A trajectory of moving tiles.
    pub fn of_trajectory(name: String, snapshots: &[Snapshot], problem: &Problem) -> Self {
        let points = snapshots.iter().map(|snapshot| {
            let q = snapshot.motion.configuration;
            let clearance = problem.clearance(&q).max(0.0);
            let [t, x, y, theta, clearance] =
                [snapshot.time, q.x, q.y, q.theta, clearance].map(|v| fixed(v, 5));
            let [potential, kinetic] =
                [snapshot.potential, snapshot.kinetic].map(|e| rounded(e, 4));
            [t, x, y, theta, potential, clearance, kinetic]
        });
        Self {
            name,
            timed: true,
            ends: [None; 2],
            bounds: None,
            points: points.collect(),
        }
    }
}

/// The way into the bond, the lowest way out of each class of states, and other barriers, as many
/// as there is room for.
pub fn played(scene: &Scene) -> Vec<Played> {
    let docking = scene.docking().map(|pathway| Played {
        name: "docking: free to bond A".to_owned(),
        timed: false,
        ends: [None, scene.inventory.bound_state],
        bounds: None,
        points: points(&pathway),
    });
    let mut known = Vec::new();
    let barriers = scene.main_escapes().into_iter().chain(scene.barriers());
    let others = barriers.filter_map(|barrier| {
        let ends = (barrier.from, barrier.to);
        if barrier.pathway.len() < 2 || known.contains(&ends) {
            return None;
        }
        known.push(ends);
        let [from, to] = [barrier.from, barrier.to];
        Some(Played {
            name: format!("{} to {}", scene.name_of(from), scene.name_of(to)),
            timed: false,
            ends: [from, to].map(|place| match place {
                Place::State(id) => Some(id),
                Place::Free => None,
            }),
            bounds: barrier
                .bounds
                .both()
                .and_then(|(lower, upper)| Some([finite(lower, 6)?, finite(upper, 6)?])),
            points: points(&barrier.pathway),
        })
    });
    docking.into_iter().chain(others).take(MOST).collect()
}

fn points(pathway: &Pathway) -> Vec<[f64; 7]> {
    csv::thinned(pathway, csv::SEEN)
        .iter()
        .map(|point| {
            let q = point.configuration;
            let [s, x, y, theta, clearance] =
                [point.s, q.x, q.y, q.theta, point.clearance.max(0.0)].map(|v| fixed(v, 6));
            [s, x, y, theta, rounded(point.energy, 6), clearance, 0.0]
        })
        .collect()
}
