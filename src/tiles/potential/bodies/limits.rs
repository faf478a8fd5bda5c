//! Bounds of the derivatives of a pair's energy where the magnets are close to each other.
//!
//! Let P be the area of a face of the second magnet, l the length of the rim of one of the first, of charge
//! density 1, and V its potential.
//!
//! * Along the face the derivative of V is that of a charge on the rim, at most `int dl / r`; across it,
//!   the solid angle, at most `2 pi`. Over all of P the integral of `1 / r` is at most that over a
//!   disc of the same area about the point, `2 sqrt(pi P)`, so that the force on it is at most
//!   `2 pi P + 2 l sqrt(pi P)`.
//! * A second derivative of V of which one direction is along the face is at most `E = int dl / r^2`, and
//!   so is, by the Laplace equation, the one across it; in any direction it is at most `2 E`. Over P,
//!   where `r >= D`, the integral of `1 / r^2` is at most that of the least of it and `1 / D^2` over
//!   a disc of the same area, `pi + pi ln(P / (pi D^2))`, or `P / D^2` if that is less.
//!
//! * As `A <= l^2 / (4 pi)` for a face of area A, the energy of two faces is at most `P 2 sqrt(pi A) <= P l`. Of the
//!   four pairs of faces two have either sign.
//!
//! An acceleration adds its product with the bound of the force. The second derivative is infinite
//! (logarithmically) where rims of faces meet.

use std::f64::consts::PI;

use super::Body;
use crate::tile::magnet::Shape;

/// Two magnets of moments 1 A m^2, in units of `mu0 / (4 pi)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyLimits {
    /// Four times the product of the charge densities for moments of 1 (1/m^6).
    densities: f64,
    /// The length (m) of the first one's rims.
    rim: f64,
    /// The area (m^2) of the second one's faces.
    area: f64,
}

/// The length (m) of the rim of a magnet's faces, and their area (m^2).
fn face(body: &Body) -> [f64; 2] {
    let [a, b, c] = body.size;
    let sides = if body.stands { [a, b] } else { [b, c] };
    match body.shape {
        Shape::Disc => [PI * sides[0], PI / 4.0 * sides[0] * sides[0]],
        Shape::Block => [2.0 * (sides[0] + sides[1]), sides[0] * sides[1]],
    }
}

impl BodyLimits {
    pub fn new(first: &Body, second: &Body) -> Self {
        Self {
            densities: 4.0 / (first.volume() * second.volume()),
            rim: face(first)[0],
            area: face(second)[1],
        }
    }

    /// The bound of the second derivative along a motion in which no point of the second magnet is
    /// faster than 1 and it turns at most at the rate `turn` (1/m), if the faces are at least
    /// `distance` (m) apart.
    pub fn curvature(&self, turn: f64, distance: f64) -> f64 {
        let ratio = self.area / (PI * distance * distance);
        let spread = if ratio > 1.0 {
            PI + PI * libm::log(ratio)
        } else {
            PI * ratio
        };
        self.densities * 2.0 * self.rim * spread + turn * self.slope()
    }

    /// The bound of the derivative along such a motion.
    pub fn slope(&self) -> f64 {
        let force = 2.0 * PI * self.area + 2.0 * self.rim * (PI * self.area).sqrt();
        self.densities * force
    }

    /// The bound of the energy.
    pub fn energy(&self) -> f64 {
        0.5 * self.densities * self.area * self.rim
    }
}
