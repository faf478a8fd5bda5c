//! Point dipoles: the plain scalar formula, which is the reference for all faster ones.
//!
//! Two dipoles in the plane, with moments of magnitude `m1`, `m2` (A m^2) and directions `a`, `b`
//! (rad), `r` (m) apart, where `phi` is the direction from the first to the second:
//!
//! ```text
//! U = K / r^3 [ cos(a - b) - 3 cos(a - phi) cos(b - phi) ],    K = mu0 m1 m2 / (4 pi)   (J)
//! ```
//!
//! Source: Jackson, *Classical Electrodynamics* (3rd ed.), equations (5.56) and (5.72), restricted
//! to the plane. Equation (5.1.2) of Majumder and Reif, *Barcoded Magnetic Tiles for Programmable
//! Assemblies*, is the same energy. Their formula for the moment of a bar magnet is not used: it
//! has the unit of a flux (Wb), not of a moment. The correct moment of a block of volume V and
//! remanence Br is `m = Br V / mu0`, and that of a long bar of pole-face field B0, half length l
//! and pole radius r is `m = 2 B0 a sqrt(l^2 + r^2) / mu0` with the pole area a.
//!
//! Special cases: U decreases as `r^-3`; at r = 0 it is infinite in magnitude, and plus infinity is
//! returned. `|U| <= 2 K / r^3`, attained by dipoles in line.

use nalgebra::Vector2;

use crate::tile::Magnet;
use crate::units::MU0_OVER_4PI;

/// A point dipole in its tile's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dipole {
    /// Its position (m).
    pub position: Vector2<f64>,
    /// Its moment (A m^2).
    pub moment: Vector2<f64>,
}

impl From<&Magnet> for Dipole {
    fn from(magnet: &Magnet) -> Self {
        Self {
            position: magnet.position,
            moment: magnet.moment_vector(),
        }
    }
}

/// Pads to a multiple of `group` with copies of the last dipole without moment. (A copy is at the
/// place of a dipole, so it adds no infinite energy.)
pub(super) fn fill(dipoles: &mut Vec<Dipole>, group: usize) {
    if let Some(last) = dipoles.last().copied() {
        let moment = Vector2::zeros();
        dipoles.resize(
            dipoles.len().next_multiple_of(group),
            Dipole { moment, ..last },
        );
    }
}

/// Energy (J) of two dipoles, the force (N) on the second and the gradient of the energy in the
/// direction of the second dipole's moment (J/rad), all at the separation `r` (m) from the first
/// to the second.
///
/// With `d = r / |r|`, `m1`, `m2` the moments:
/// `U = mu0 / (4 pi |r|^3) [m1.m2 - 3 (m1.d)(m2.d)]`,
/// `F = 3 mu0 / (4 pi |r|^4) [(m1.d) m2 + (m2.d) m1 + (m1.m2) d - 5 (m1.d)(m2.d) d]`.
pub fn pair(m1: Vector2<f64>, m2: Vector2<f64>, r: Vector2<f64>) -> (f64, Vector2<f64>, f64) {
    let distance = r.norm();
    let d = r / distance;
    let (along1, along2, dot) = (m1.dot(&d), m2.dot(&d), m1.dot(&m2));
    let scale = MU0_OVER_4PI / distance.powi(3);
    let energy = scale * (dot - 3.0 * along1 * along2);
    let force =
        (m2 * along1 + m1 * along2 + d * (dot - 5.0 * along1 * along2)) * (3.0 * scale / distance);
    // Turning m2 by a small angle adds the angle times its perpendicular.
    let turned = Vector2::new(-m2.y, m2.x);
    let slope = scale * (m1.dot(&turned) - 3.0 * along1 * turned.dot(&d));
    (energy, force, slope)
}

/// The dipoles of a tile's magnets.
pub fn dipoles(magnets: &[Magnet]) -> Vec<Dipole> {
    magnets.iter().map(Dipole::from).collect()
}
