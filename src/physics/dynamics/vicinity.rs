//! The contacts that a tile may make within its next step.

use nalgebra::{Vector2, Vector3};

use super::body::Phase;
use super::simulation::Simulation;
use crate::configuration::Configuration;
use crate::contact::{ContactPoint, NearPairs, TurnsWith};

/// Smallest search distance (m) for contact points: far larger than any overlap.
const LEAST_MARGIN: f64 = 1e-4;

/// Number of contact ranges by which pairs are searched farther than needed, so that they are
/// searched less often.
const AHEAD: f64 = 4.0;

/// The possible contacts of a step.
pub(super) enum Ahead {
    /// The points that may come into contact.
    Contact(Vec<ContactPoint>),
    /// None: no point of the tile touches anything before it has moved by this distance (m).
    Room(f64),
}

/// The pairs of edges and corners within a distance (m) of each other at a configuration, valid
/// until the tile may have reached others.
pub(super) struct Vicinity {
    pairs: NearPairs,
    distance: f64,
    place: Vector3<f64>,
}

impl Vicinity {
    /// With no pairs yet.
    pub fn new() -> Self {
        Self {
            pairs: NearPairs::default(),
            distance: f64::NEG_INFINITY,
            place: Vector3::zeros(),
        }
    }

    /// The possible contacts of a step in which no point of the tile moves farther than `way` (m)
    /// without contact.
    pub fn ahead(&mut self, simulation: &Simulation, phase: &Phase, way: f64) -> Ahead {
        let least =
            |points: &[ContactPoint], seen| points.iter().map(|p| p.gap).fold(seen, f64::min);
        let margin = (simulation.gathering() * way).max(simulation.problem.scaled(LEAST_MARGIN));
        let points = self.points(simulation, phase, margin);
        if least(&points, margin) <= way {
            return Ahead::Contact(points);
        }
        if !points.is_empty() {
            return Ahead::Room(least(&points, margin));
        }
        let seen = margin.max(3.0 * simulation.settings.contact_range);
        Ahead::Room(least(&self.points(simulation, phase, seen), seen))
    }

    /// The points of contact within a margin (m).
    fn points(&mut self, simulation: &Simulation, phase: &Phase, margin: f64) -> Vec<ContactPoint> {
        let Some(contact) = &simulation.problem.contact else {
            return Vec::new();
        };
        let needed = 1.5 * margin;
        let moved = simulation.fastest(&(phase.place - self.place));
        let q = simulation.body.configuration(&phase.place);
        if self.distance - moved < needed {
            self.distance = needed + AHEAD * simulation.settings.contact_range;
            self.place = phase.place;
            self.pairs = contact.near(&q, self.distance);
        }
        let mut points = contact.points(&q, margin, &self.pairs);
        at_rim(simulation, &q, margin, &mut points);
        points
    }
}

/// Adds the corners of the tile within a margin (m) of the rim.
fn at_rim(simulation: &Simulation, q: &Configuration, margin: f64, points: &mut Vec<ContactPoint>) {
    let Some(half) = simulation.rim() else {
        return;
    };
    if simulation.rim_clearance(q) > margin {
        return;
    }
    for corner in simulation.corners(q) {
        for (axis, half) in half.into_iter().enumerate() {
            let gap = half - corner[axis].abs();
            if gap <= margin {
                let mut normal = Vector2::zeros();
                normal[axis] = -corner[axis].signum();
                points.push(ContactPoint {
                    on_moving: corner,
                    normal,
                    gap,
                    turns_with: TurnsWith::Behind,
                });
            }
        }
    }
}
