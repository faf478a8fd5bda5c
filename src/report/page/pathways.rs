//! The pathways and trajectories that a page animates.

use serde::Serialize;

use super::numbers::{finite, fixed, rounded};
use crate::columns::{Link, Table, rows};
use crate::csv;
use crate::plots::Scene;
use physics::dynamics::Snapshot;
use physics::landscape::{Barrier, Pathway, PathwayCost, Place};
use physics::problem::Problem;

/// Largest number of pathways on a page.
const MOST: usize = 24;

/// A pathway or a trajectory to animate.
#[derive(Clone, Debug, Serialize)]
pub struct Played {
    name: String,
    /// Whether its parameter is the time (s) rather than the length along it, and points have a
    /// kinetic energy.
    timed: bool,
    /// Ids of the states at its ends; null for tiles far apart.
    ends: [Option<usize>; 2],
    /// Proved bounds of its highest energy (J), where they are drawn.
    bounds: Option<[f64; 2]>,
    /// The same above its start (J), as people read them.
    climbs: Option<[f64; 2]>,
    /// The cost by which it is the best.
    by: &'static str,
    /// The sum of all climbs on it (J), and its length (m).
    work: f64,
    length: f64,
    /// Its start and end; `None` for a trajectory.
    #[serde(skip)]
    places: Option<[Place; 2]>,
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
                [snapshot.time, q.x, q.y, q.theta, clearance].map(fixed);
            let [potential, kinetic] =
                [snapshot.potential, snapshot.kinetic].map(|e| rounded(e, 4));
            [t, x, y, theta, potential, clearance, kinetic]
        });
        Self {
            name,
            timed: true,
            ends: [None; 2],
            bounds: None,
            climbs: None,
            by: "",
            work: 0.0,
            length: 0.0,
            places: None,
            points: points.collect(),
        }
    }

    /// A pathway with the cost by which it is the best.
    fn of_pathway(
        name: String,
        [from, to]: [Place; 2],
        by: &'static str,
        pathway: &Pathway,
    ) -> Self {
        let state = |place| match place {
            Place::State(id) => Some(id),
            Place::Free => None,
        };
        let climbs = pathway
            .windows(2)
            .map(|pair| pair[1].energy - pair[0].energy);
        let ends = pathway.first().zip(pathway.last());
        Self {
            name,
            timed: false,
            ends: [from, to].map(state),
            bounds: None,
            climbs: None,
            by,
            work: rounded(climbs.filter(|climb| *climb > 0.0).sum(), 6),
            length: ends.map_or(0.0, |(first, last)| fixed(last.s - first.s)),
            places: Some([from, to]),
            points: points(pathway),
        }
    }

    /// Whether it is the path over a barrier.
    pub fn is_over(&self, barrier: &Barrier) -> bool {
        self.by == LOWEST && self.places == Some([barrier.from, barrier.to])
    }

    /// Its highest energy relative to its start (J).
    fn climb(&self) -> f64 {
        let energies = self.points.iter().map(|point| point[4]);
        let highest = energies.fold(f64::NEG_INFINITY, f64::max);
        highest - self.points.first().map_or(highest, |point| point[4])
    }
}

/// The names of the costs.
const LOWEST: &str = "lowest maximum energy";
const LEAST_WORK: &str = "least work";
const MOST_PROBABLE: &str = "most probable";

/// The animated paths between the bond, the deepest trap and `free`, with their costs.
pub fn table(played: &[Played]) -> Table {
    let others = played.iter().filter(|way| way.by != LOWEST);
    let ends: Vec<Place> = others.flat_map(|way| way.places).flatten().collect();
    let between = |way: &Played| {
        way.places
            .is_some_and(|at| at.iter().all(|p| ends.contains(p)))
    };
    let shown: Vec<usize> = (0..played.len()).filter(|&k| between(&played[k])).collect();
    rows(shown.iter().map(|&k| &played[k]))
        .shown("way", "start and end", |way| {
            way.name.split(',').next().unwrap_or_default().to_owned()
        })
        .shown("criterion", "", |way| way.by)
        .column("_J", "barrier", "maximum energy above the start", |way| {
            way.climb()
        })
        .digits(4)
        .column("_J", "work", "sum of all climbs", |way| way.work)
        .digits(4)
        .column("_m", "length", "length of the path", |way| way.length)
        .table("")
        .in_view()
        .on_page()
        .titled(
            "Ways",
            "Between the bond, the deepest trap and free. A path with a low barrier can be long \
             or climb often; other paths take the least work, or are most probable at the thermal \
             energy. Click a row to play its path.",
        )
        .linked(shown.iter().map(|&k| Some(Link::Way(k))))
}

/// The path into the bond, the lowest path out of each class of states, and other barriers, as far
/// as there is room; then the paths between the bond, the deepest trap and `free` that are the best
/// by other costs.
pub fn played(scene: &Scene) -> Vec<Played> {
    let bond = scene.catalogue.bound_state.map(Place::State);
    let docking = scene.docking().zip(bond).map(|(pathway, bond)| {
        let name = format!("docking: free to {}", scene.name_of(bond));
        Played::of_pathway(name, [Place::Free, bond], LOWEST, &pathway)
    });
    let mut known = Vec::new();
    let barriers = scene.main_escapes().into_iter().chain(scene.barriers());
    let others = barriers.filter_map(|barrier| {
        let ends = [barrier.from, barrier.to];
        if barrier.pathway.len() < 2 || known.contains(&ends) {
            return None;
        }
        known.push(ends);
        let read = |(lower, upper)| Some([finite(lower, 6)?, finite(upper, 6)?]);
        Some(Played {
            bounds: barrier.bounds.both().and_then(read),
            climbs: barrier.certified().and_then(read),
            ..Played::of_pathway(between(scene, ends), ends, LOWEST, &barrier.pathway)
        })
    });
    let mut played: Vec<Played> = docking.into_iter().chain(others).take(MOST).collect();
    let alternatives = scene.catalogue.alternatives.iter();
    played.extend(alternatives.filter(|way| way.pathway.len() > 1).map(|way| {
        let ends = [way.from, way.to];
        let by = match way.by {
            PathwayCost::Work => LEAST_WORK,
            PathwayCost::Probability => MOST_PROBABLE,
        };
        let name = format!("{}, {by}", between(scene, ends));
        Played::of_pathway(name, ends, by, &way.pathway)
    }));
    played
}

fn between(scene: &Scene, [from, to]: [Place; 2]) -> String {
    format!("{} to {}", scene.name_of(from), scene.name_of(to))
}

fn points(pathway: &Pathway) -> Vec<[f64; 7]> {
    csv::thinned(pathway, csv::SEEN)
        .iter()
        .map(|point| {
            let q = point.configuration;
            let [s, x, y, theta, clearance] =
                [point.s, q.x, q.y, q.theta, point.clearance.max(0.0)].map(fixed);
            [s, x, y, theta, rounded(point.energy, 6), clearance, 0.0]
        })
        .collect()
}
