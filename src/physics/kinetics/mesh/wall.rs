//! The inner boundary of a chart: the distance at which contact ends in each direction.

use nalgebra::{Matrix3, Vector2, Vector3};

use crate::configuration::Configuration;
use crate::contact::Contact;
use crate::problem::Problem;

/// Step (rad) for the differences that give the wall's slopes.
const STEP: f64 = 1e-6;
/// Smallest lever (m) of contact along phi: below it walls are parallel to rays within rounding.
const LEAST_LEVER: f64 = 1e-3;

/// The least distance of the centres, over (phi, theta).
#[derive(Clone)]
pub(in crate::kinetics) enum Wall {
    /// A constant (m); configurations outside may be blocked.
    Circle(f64),
    /// A constant (m), with nothing blocked outside.
    Open(f64),
    /// The distance of tiles in contact, outside which nothing is blocked.
    Contact(Box<Contact>),
}

/// The configurations at one (phi, theta), from the wall outwards.
#[derive(Clone, Copy, Debug)]
pub(in crate::kinetics) struct Ray {
    /// phi and theta (rad).
    at: [f64; 2],
    /// Where it begins: g (m).
    wall: f64,
    /// Its length (m).
    pub length: f64,
    /// Slopes of g by phi and theta (m).
    slopes: [f64; 2],
}

impl Wall {
    /// Contact, if requested and if every ray leaves it once and for all; the circle (m) otherwise.
    pub fn new(problem: &Problem, circle: f64, fitted: bool) -> Self {
        let Some(contact) = &problem.contact else {
            return Self::Open(circle);
        };
        match fitted && contact.least_lever() > contact.scaled(LEAST_LEVER) {
            true => Self::Contact(Box::new(contact.clone())),
            false => Self::Circle(circle),
        }
    }

    fn begins(&self, [phi, theta]: [f64; 2]) -> f64 {
        match self {
            Self::Circle(radius) | Self::Open(radius) => *radius,
            Self::Contact(contact) => {
                let (sin, cos) = libm::sincos(phi);
                let centred = Configuration::new(0.0, 0.0, theta);
                contact
                    .landing(&centred, Vector2::new(cos, sin))
                    .unwrap_or(0.0)
            }
        }
    }

    /// The configurations at two s on a ray out to a radius (m).
    pub fn places(&self, at: [f64; 2], radius: f64, s: [f64; 2]) -> [Configuration; 2] {
        let wall = self.begins(at);
        let (sin, cos) = libm::sincos(at[0]);
        s.map(|s| {
            let r = wall + s * (radius - wall);
            Configuration::new(r * cos, r * sin, at[1])
        })
    }

    /// The ray out to a radius (m).
    pub fn ray(&self, at: [f64; 2], radius: f64) -> Ray {
        let wall = self.begins(at);
        let slopes = match self {
            Self::Circle(_) | Self::Open(_) => [0.0; 2],
            Self::Contact(_) => std::array::from_fn(|i| {
                let beside = |step: f64| {
                    let mut at = at;
                    at[i] += step;
                    self.begins(at)
                };
                (beside(STEP) - beside(-STEP)) / (2.0 * STEP)
            }),
        };
        Ray {
            at,
            wall,
            length: radius - wall,
            slopes,
        }
    }
}

impl Ray {
    /// The distance of the centres (m) at s.
    pub fn radius(&self, s: f64) -> f64 {
        self.wall + s * self.length
    }

    /// s at a distance of the centres (m), no less than 0.
    pub fn part(&self, radius: f64) -> f64 {
        ((radius - self.wall) / self.length).max(0.0)
    }

    /// The configuration at s.
    pub fn configuration(&self, s: f64) -> Configuration {
        let (r, [phi, theta]) = (self.radius(s), self.at);
        Configuration::new(r * libm::cos(phi), r * libm::sin(phi), theta)
    }

    /// From the directions of x, y and theta to those along the ray, across it and of theta.
    pub fn upright(&self) -> Matrix3<f64> {
        let (sin, cos) = libm::sincos(self.at[0]);
        Matrix3::new(cos, sin, 0.0, -sin, cos, 0.0, 0.0, 0.0, 1.0)
    }

    /// The volume element by (s, phi, theta) (m^2).
    pub fn volume(&self, s: f64) -> f64 {
        self.radius(s) * self.length
    }

    /// Gradients by (x, y, theta) of s, phi and theta, as columns.
    pub fn gradients(&self, s: f64) -> Matrix3<f64> {
        let r = self.radius(s);
        let (sin, cos) = libm::sincos(self.at[0]);
        let outwards = Vector3::new(cos, sin, 0.0);
        let around = Vector3::new(-sin, cos, 0.0) / r;
        let turning = Vector3::z();
        // g grows along phi and theta: there s shrinks.
        let shrinks = around * self.slopes[0] + turning * self.slopes[1];
        let along = (outwards - shrinks * (1.0 - s)) / self.length;
        Matrix3::from_columns(&[along, around, turning])
    }
}
