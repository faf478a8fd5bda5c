//! How strong a magnet is.

use std::f64::consts::PI;

use super::grade::Grade;
use crate::units::MU0;

/// How strong a magnet is; one of the ways to say it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// Magnetic moment (A m^2).
    Moment(f64),
    /// Remanence Br of the uniformly magnetised block (T).
    Remanence(f64),
    /// Field at the centre of the block's pole face (T).
    SurfaceField(f64),
    /// What it is sold as.
    Grade(Grade),
    /// Force (N) that draws the block's pole face off a thick steel plate.
    Pull(f64),
}

/// What a seller states as the pull of a block of N38, over the force of the ideal block on ideal
/// steel: of seven blocks from 10 x 4 x 1.5 to 42 x 20 x 5 mm, magnetised through the last (dhit.pl),
/// 0.95, 1.00, 1.08, 0.74, 0.82, 0.93 and 1.00. Thin plates and small blocks lose most to their
/// coating and to what is rough or thin of the steel.
pub const PULL_SPREAD: [f64; 2] = [0.74, 1.08];

impl Strength {
    /// The moment (A m^2) of a block of `size` (m; along its axis first): `m = Br V / mu0`, with
    /// Br from [`surface_field_share`] where the field at the pole face is what is known.
    pub fn moment(self, size: [f64; 3]) -> f64 {
        let volume: f64 = size.iter().product();
        match self {
            Self::Moment(moment) => moment,
            Self::Remanence(remanence) => remanence * volume / MU0,
            Self::SurfaceField(field) => field / surface_field_share(size) * volume / MU0,
            Self::Grade(grade) => grade.remanence[1] * volume / MU0,
            Self::Pull(force) => (force / pull(size, 1.0)).sqrt() * volume / MU0,
        }
    }
}

/// B0 / Br: the field at the centre of the pole face of a uniformly magnetised block, as a share
/// of its remanence.
///
/// The two pole faces (a by b, the length l apart) are sheets of magnetic charge; on its axis a
/// charged rectangle gives a field in proportion to the solid angle that it fills, 2 pi right at
/// the sheet and `4 atan(a b / (2 l sqrt(4 l^2 + a^2 + b^2)))` at the distance l. The near sheet's
/// field less the far sheet's is
///
/// ```text
/// B0 / Br = 1/2 - (1/pi) atan(a b / (2 l sqrt(4 l^2 + a^2 + b^2)))
/// ```
///
/// Source: charge model, Furlani, *Permanent Magnet and Electromechanical Devices* (2001),
/// section 4.2; solid angle of a rectangle, Khadjavi, J. Opt. Soc. Am. 58 (1968) 1417.
/// Edges: a long bar has 1/2, a thin plate tends to 0 as `(2/pi) l sqrt(1/a^2 + 1/b^2)`.
pub fn surface_field_share([l, a, b]: [f64; 3]) -> f64 {
    // atan(1 / x) = pi/2 - atan(x): no difference of nearly equal numbers for a thin plate.
    libm::atan(2.0 * l * (4.0 * l * l + a * a + b * b).sqrt() / (a * b)) / PI
}

/// The force (N) that draws the pole face of a block of `size` (m; along its axis first) and of
/// remanence `remanence` (T) off a thick plate of steel.
///
/// The plate, of a permeability without bound, acts as the block's mirror image: a block like it,
/// pole to pole. Every pole face (a by b, of charge density Br / mu0) is drawn by the image's two,
/// l apart:
///
/// ```text
/// F = Br^2 / (4 pi mu0) [g(0) - 2 g(l) + g(2 l)]
/// g(d) = 4 [ab atan(ab / (d r)) - bd (asinh(b / d) - asinh(b / p)) - ad (asinh(a / d) - asinh(a / q))
///           + d (q + p - r - d)],  p = sqrt(a^2 + d^2), q = sqrt(b^2 + d^2), r = sqrt(a^2 + b^2 + d^2)
/// ```
///
/// where `g(d)` is the integral of d / R^3 over both of two faces d apart, `g(0) = 2 pi a b`.
///
/// Source: charge model and image, Furlani, *Permanent Magnet and Electromechanical Devices* (2001),
/// sections 3.4 and 4.2. Edges: a long bar tends to `Br^2 a b / (2 mu0)`; a real plate that is not
/// saturated draws a few per cent less, for the block's permeability is 1.05.
pub fn pull(size: [f64; 3], remanence: f64) -> f64 {
    let [l, a, b] = size;
    let faces = 2.0 * PI * a * b - 2.0 * facing(a, b, l) + facing(a, b, 2.0 * l);
    remanence * remanence / (4.0 * PI * MU0) * faces
}

/// The integral of d / R^3 over both of two rectangles a by b (m), d apart and square to each other
/// (m^2).
fn facing(a: f64, b: f64, d: f64) -> f64 {
    let (p, q) = (libm::hypot(a, d), libm::hypot(b, d));
    let r = libm::hypot(p, b);
    let side = |b: f64, p: f64| b * d * (libm::asinh(b / d) - libm::asinh(b / p));
    4.0 * (a * b * libm::atan(a * b / (d * r)) - side(b, p) - side(a, q) + d * (p + q - r - d))
}
