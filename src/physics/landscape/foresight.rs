//! Predicts how an overdamped motion continues to turn from how it has turned so far.

use arrayvec::ArrayVec;
use nalgebra::Vector3;

use super::constrained::{Heading, length};
use crate::configuration::Configuration;
use crate::problem::Problem;

/// Headings that a motion is extrapolated from, the one at the place it has come to included.
const HEADINGS: usize = 3;

/// The headings of a motion at places that it left while the contacts pressed on were the same, the
/// last one first, with the lengths of the steps (m, mass metric) from there.
#[derive(Debug, Default)]
pub(super) struct Past(ArrayVec<(Heading, f64), { HEADINGS - 1 }>);

/// A step foretold.
pub(super) struct Foretold {
    /// What the step is to follow from its start to its end.
    pub heading: Heading,
    /// The direction that the motion would have at the step's end.
    at_end: Vector3<f64>,
    /// The step ends so much of its length beside the motion for each unit that the direction at its end
    /// is off.
    share: f64,
    /// The power of its length with which a step strays.
    pub order: i32,
}

impl Past {
    /// Nothing is known.
    pub fn forget(&mut self) {
        self.0.clear();
    }

    /// Adds a place left by a step of this size (m) with this heading.
    pub fn add(&mut self, heading: Heading, size: f64) {
        if !self.goes_on(&heading) {
            self.forget();
        } else if self.0.is_full() {
            self.0.pop();
        }
        self.0.insert(0, (heading, size));
    }

    /// Whether the contacts pressed on still are the same.
    fn goes_on(&self, heading: &Heading) -> bool {
        let last = self.0.first();
        last.is_some_and(|(last, _)| last.pressed == heading.pressed)
    }

    /// A step of this size (m) on from a place with this heading: the method of Adams and Bashforth
    /// for steps of any lengths, of third order where so much is known (Hairer, Norsett and Wanner,
    /// *Solving Ordinary Differential Equations I*, section III.5).
    ///
    /// The direction is extrapolated by the polynomial through those known (Newton's differences). What
    /// the direction found at the end differs by from the polynomial there makes one of a degree more
    /// of it, which tells how far the step strays.
    pub fn foretell(&self, along: &Heading, size: f64) -> Foretold {
        let past = if self.goes_on(along) {
            &self.0[..]
        } else {
            &[]
        };
        let h = size;
        let direction = along.direction;
        let mut heading = along.clone();
        let (at_end, share) = match past {
            [] => (direction, 0.5),
            [(before, a)] => {
                let turn = (direction - before.direction) / *a;
                heading.direction += turn * (h / 2.0);
                let mean = h * (h / 3.0 + a / 2.0);
                (direction + turn * h, mean / (h * (h + a)))
            }
            [(before, a), (earlier, b), ..] => {
                let turn = (direction - before.direction) / *a;
                let bend = (turn - (before.direction - earlier.direction) / *b) / (a + b);
                heading.direction += turn * (h / 2.0) + bend * (h * (h / 3.0 + a / 2.0));
                let mean = h * (h * h / 4.0 + (2.0 * a + b) * h / 3.0 + a * (a + b) / 2.0);
                (
                    direction + turn * h + bend * (h * (h + a)),
                    mean / (h * (h + a) * (h + a + b)),
                )
            }
        };
        Foretold {
            heading,
            at_end,
            share,
            order: past.len() as i32 + 2,
        }
    }
}

impl Foretold {
    /// How far (m, mass metric) a step of this size from a place ends beside the motion that has this
    /// heading at the end.
    pub fn strays(&self, problem: &Problem, from: &Configuration, to: &Heading, size: f64) -> f64 {
        let metric = problem.mass_metric(from.theta);
        let error = (to.direction - self.at_end) * self.share;
        let beside = error - to.direction * to.direction.dot(&(metric * error));
        size * length(&beside, &metric)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heading(direction: Vector3<f64>) -> Heading {
        Heading {
            direction,
            held: Vector3::zeros(),
            pressed: Vec::new(),
        }
    }

    /// Directions that change as polynomials of the way are followed exactly up to the degree that the
    /// known ones determine; of one degree more, the error is told.
    #[test]
    fn polynomials_are_followed_and_the_next_degree_is_told() {
        let places = [-0.7, -0.3, 0.0];
        let size = 0.9;
        for known in 1..=HEADINGS {
            for degree in 0..=known as i32 {
                let at = |s: f64| Vector3::new(1.0, s.powi(degree), 0.0);
                let mut past = Past::default();
                for pair in places[HEADINGS - known..].windows(2) {
                    past.add(heading(at(pair[0])), pair[1] - pair[0]);
                }
                let foretold = past.foretell(&heading(at(0.0)), size);
                assert_eq!(foretold.order, known as i32 + 1);
                let mean = size.powi(degree) / f64::from(degree + 1);
                let error = mean - foretold.heading.direction.y;
                let told = (at(size).y - foretold.at_end.y) * foretold.share;
                assert!(
                    (error - told).abs() < 1e-14,
                    "{known} {degree}: {error} {told}"
                );
                assert_eq!(degree < known as i32, error.abs() < 1e-14);
            }
        }
    }

    #[test]
    fn other_contacts_are_another_motion() {
        let mut past = Past::default();
        past.add(heading(Vector3::new(0.0, 1.0, 0.0)), 0.1);
        let mut pressed = heading(Vector3::new(1.0, 0.0, 0.0));
        pressed.pressed.push(crate::contact::Touch {
            edge_of: crate::contact::EdgeOf::Fixed,
            edge: 0,
            vertex: 0,
        });
        let foretold = past.foretell(&pressed, 0.1);
        assert_eq!((foretold.order, foretold.heading), (2, pressed));
    }
}
