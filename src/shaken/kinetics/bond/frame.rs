//! Coordinates that make contact simple: slide, tilt and gap relative to a state.

use nalgebra::Vector2;

use landscape::constrained::constraints;
use landscape::roadmap::Point;
use tiles::configuration::Configuration;
use tiles::contact::EdgeOf;
use tiles::problem::Problem;
use tiles::tile::outline::cross;

/// Gaps below this (m) count as touching.
const TOUCHING: f64 = 1e-6;

/// The moving tile is rotated by the tilt about a pivot of its own, and the pivot shifted by the
/// slide and the gap. (x, y, theta) and (slide, gap, tilt) have the same volume element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    origin: Configuration,
    /// In the moving tile's frame (m).
    pivot: Vector2<f64>,
    /// Unit vector along which the gap opens, in the fixed tile's frame.
    normal: Vector2<f64>,
}

impl Frame {
    /// The frame of a minimum: the gap opens against the force that presses the contact, and the
    /// pivot is the middle of the contact.
    pub fn of_minimum(problem: &Problem, point: &Point) -> Self {
        let slope = point.gradient.xy();
        let places = touching(problem, &point.q);
        let held = !places.is_empty() && slope.norm() > 0.0;
        let outwards = if held { slope } else { point.q.position() };
        let normal = outwards.try_normalize(0.0).unwrap_or_else(Vector2::x);
        let along = places.iter().map(|p| cross(normal, *p));
        let middle = |ends: [f64; 2]| (ends[0] + ends[1]) / 2.0;
        let across = places.iter().map(|p| normal.dot(p));
        let pivot = match places.is_empty() {
            true => point.q.position(),
            false => turned(normal) * middle(range(along)) + normal * middle(range(across)),
        };
        Self {
            origin: point.q,
            pivot: point.q.inverse_transform(pivot),
            normal,
        }
    }

    /// The configuration at a slide (m), a tilt (rad) and a gap (m); the minimum at 0, 0, 0.
    pub fn configuration(&self, [slide, tilt]: [f64; 2], gap: f64) -> Configuration {
        let theta = self.origin.theta + tilt;
        let pivot =
            self.origin.transform(self.pivot) + turned(self.normal) * slide + self.normal * gap;
        let local = Configuration::new(0.0, 0.0, theta).transform(self.pivot);
        Configuration::from([pivot.x - local.x, pivot.y - local.y, theta])
    }

    /// Slide, tilt and gap of a configuration.
    pub fn coordinates(&self, q: &Configuration) -> ([f64; 2], f64) {
        let moved = q.transform(self.pivot) - self.origin.transform(self.pivot);
        let tilt = self.origin.step_to(q).z;
        (
            [turned(self.normal).dot(&moved), tilt],
            self.normal.dot(&moved),
        )
    }

    /// The direction in which the gap opens, in the fixed tile's frame.
    pub fn normal(&self) -> Vector2<f64> {
        self.normal
    }
}

/// A quarter turn counter-clockwise.
fn turned(v: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-v.y, v.x)
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    })
}

/// The points where vertices touch edges, in the fixed tile's frame (m).
fn touching(problem: &Problem, q: &Configuration) -> Vec<Vector2<f64>> {
    let Some(contact) = &problem.contact else {
        return Vec::new();
    };
    constraints(problem, q, problem.scaled(TOUCHING))
        .iter()
        .map(|constraint| match constraint.touch.edge_of {
            EdgeOf::Fixed => q.transform(contact.moving().vertices()[constraint.touch.vertex]),
            EdgeOf::Moving => contact.fixed().vertices()[constraint.touch.vertex],
        })
        .collect()
}
