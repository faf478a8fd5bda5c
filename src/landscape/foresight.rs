//! Predicts how an overdamped motion continues to turn from how it has turned so far.

use arrayvec::ArrayVec;
use nalgebra::Vector3;

use super::constrained::{Heading, length};
use tiles::configuration::Configuration;
use tiles::problem::Problem;

/// Number of headings that a motion is extrapolated from, including the one at its current place.
const HEADINGS: usize = 3;

/// The headings of a motion at places that it left while the contacts pressed on were the same, the
/// last one first, with the lengths of the steps (m, mass metric) from there.
#[derive(Debug, Default)]
pub(super) struct Past(ArrayVec<(Heading, f64), { HEADINGS - 1 }>);

/// A predicted step.
pub(super) struct Foretold {
    /// The heading that the step follows from start to end.
    pub heading: Heading,
    /// The direction that the motion would have at the step's end.
    at_end: Vector3<f64>,
    /// Lateral error of the step's end, as a fraction of its length, per unit error of the
    /// direction at its end.
    share: f64,
    /// The order of the lateral error in the step's length.
    pub order: i32,
}

impl Past {
    /// Forgets all headings.
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

    /// Whether the pressed contacts are still the same.
    fn goes_on(&self, heading: &Heading) -> bool {
        let last = self.0.first();
        last.is_some_and(|(last, _)| last.pressed == heading.pressed)
    }

    /// A step of this size (m) on from a place with this heading: the method of Adams and Bashforth
    /// with variable step lengths, of third order once enough headings are known (Hairer, Norsett
    /// and Wanner, *Solving Ordinary Differential Equations I*, section III.5).
    ///
    /// The direction is extrapolated by the polynomial through the known ones (Newton's
    /// differences). The difference between the direction found at the end and the polynomial there
    /// gives the term of the next degree, and with it the lateral error of the step.
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
    /// Distance (m, mass metric) between the end of a step of this size and the motion that has
    /// this heading there.
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

    /// Directions that are polynomials of the arc length are followed exactly up to the degree that
    /// the known ones determine; for one degree more, the error is predicted.
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
        pressed.pressed.push(tiles::contact::Touch {
            edge_of: tiles::contact::EdgeOf::Fixed,
            edge: 0,
            vertex: 0,
        });
        let foretold = past.foretell(&pressed, 0.1);
        assert_eq!((foretold.order, foretold.heading), (2, pressed));
    }
}
