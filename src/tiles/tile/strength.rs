//! The strength of a magnet.

use std::f64::consts::PI;

use super::demagnetising::{complete_elliptic, working_point};
use super::grade::Grade;
use super::magnet::Shape;
use crate::units::MU0;

/// The strength of a magnet, in one of several units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// Magnetic moment (A m^2).
    Moment(f64),
    /// Remanence Br of the uniformly magnetised block (T).
    Remanence(f64),
    /// Field at the centre of the block's pole face (T).
    SurfaceField(f64),
    /// The grade: its usual remanence, at the working point of the magnet by itself.
    Grade(Grade),
    /// Force (N) to pull the block's pole face off a thick steel plate.
    Pull(f64),
}

/// The stated pull of a magnet divided by the force of the ideal magnet on ideal steel, by its shape:
/// what was found, with a margin for as many magnets as were not looked at.
///
/// - plates and blocks: seven of N38 from 10 x 4 x 1.5 to 42 x 20 x 5 mm, magnetised through the last
///   (dhit.pl): 0.95, 1.00, 1.08, 0.74, 0.82, 0.93 and 1.00;
/// - bars, whose pole face is more than four times as long as wide, or shorter than the magnet: 1.5 x
///   1/4 x 1/4 in of 1.26 T (quickfield.com, block and ferromagnet): 0.65;
/// - discs up to half as high as wide: 3/16 x 1/32 in of 1.28 T (quickfield.com, permanent magnet
///   force): 0.93; 1/2 x 1/8 in of up to 1.32 T (D82, magpylib issue 829): 0.84;
/// - higher discs: 3 x 3 mm of N48 (ahmagnet.com): 0.67.
pub fn pull_spread(shape: Shape, [l, a, b]: [f64; 3]) -> PullSpread {
    let (long, short) = (a.max(b), a.min(b));
    let (name, range) = match shape {
        Shape::Block if long > 4.0 * short || l > short => ("bars", [0.55, 1.1]),
        Shape::Block => ("blocks", [0.65, 1.15]),
        Shape::Disc if l > 0.5 * a => ("high discs", [0.55, 1.1]),
        Shape::Disc => ("flat discs", [0.7, 1.1]),
    };
    PullSpread { name, range }
}

/// The range of stated pulls over ideal ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PullSpread {
    /// The magnets, in the plural.
    pub name: &'static str,
    /// The least and the largest ratio.
    pub range: [f64; 2],
}

impl Strength {
    /// The moment (A m^2) of a magnet of `size` (m; along its axis first): `m = Br V / mu0`, with
    /// Br from [`surface_field_share`] if the field at the pole face is given.
    pub fn moment(self, shape: Shape, size: [f64; 3]) -> f64 {
        let volume = shape.volume(size);
        match self {
            Self::Moment(moment) => moment,
            Self::Remanence(remanence) => remanence * volume / MU0,
            Self::SurfaceField(field) => field / surface_field_share(shape, size) * volume / MU0,
            Self::Grade(grade) => grade.remanence[1] * working_point(shape, size) * volume / MU0,
            Self::Pull(force) => (force / pull(shape, size, 1.0)).sqrt() * volume / MU0,
        }
    }
}

/// B0 / Br: the field at the centre of the pole face of a uniformly magnetised block, as a fraction
/// of its remanence.
///
/// The two pole faces (a by b, the length l apart) are sheets of magnetic charge; on its axis the
/// field of a charged rectangle is proportional to its solid angle, 2 pi at the sheet and `4 atan(a
/// b / (2 l sqrt(4 l^2 + a^2 + b^2)))` at the distance l. The near sheet's field minus the far
/// sheet's is
///
/// ```text
/// B0 / Br = 1/2 - (1/pi) atan(a b / (2 l sqrt(4 l^2 + a^2 + b^2)))
/// ```
///
/// and for a disc of radius R, whose far face has the solid angle `2 pi (1 - l / sqrt(l^2 + R^2))`,
/// `l / (2 sqrt(l^2 + R^2))`.
///
/// Source: charge model, Furlani, *Permanent Magnet and Electromechanical Devices* (2001), section
/// 4.2; solid angle of a rectangle, Khadjavi, J. Opt. Soc. Am. 58 (1968) 1417. Limits: a long bar
/// has 1/2, a thin plate tends to 0 as `(2/pi) l sqrt(1/a^2 + 1/b^2)`.
pub fn surface_field_share(shape: Shape, [l, a, b]: [f64; 3]) -> f64 {
    if shape == Shape::Disc {
        return l / (2.0 * libm::hypot(l, a / 2.0));
    }
    // atan(1 / x) = pi/2 - atan(x): no difference of nearly equal numbers for a thin plate.
    libm::atan(2.0 * l * (4.0 * l * l + a * a + b * b).sqrt() / (a * b)) / PI
}

/// The force (N) to pull the pole face of a block of `size` (m; along its axis first) and of
/// remanence `remanence` (T) off a thick plate of steel.
///
/// The plate, of infinite permeability, acts like the block's mirror image: an equal block, pole to
/// pole. Every pole face (a by b, of charge density Br / mu0) is attracted by the image's two, l
/// apart:
///
/// ```text
/// F = Br^2 / (4 pi mu0) [g(0) - 2 g(l) + g(2 l)]
/// g(d) = 4 [ab atan(ab / (d r)) - bd (asinh(b / d) - asinh(b / p)) - ad (asinh(a / d) - asinh(a / q))
///           + d (q + p - r - d)],  p = sqrt(a^2 + d^2), q = sqrt(b^2 + d^2), r = sqrt(a^2 + b^2 + d^2)
/// ```
///
/// where `g(d)` is the integral of d / R^3 over both of two faces d apart, `g(0) = 2 pi a b`. Discs
/// have their own integral, with `g(0) = 2 pi` times their area.
///
/// Source: charge model and image, Furlani, *Permanent Magnet and Electromechanical Devices*
/// (2001), sections 3.4 and 4.2. Limits: a long bar tends to `Br^2 a b / (2 mu0)`; the force of a
/// real plate that is not saturated is a few per cent lower, because the block's permeability is
/// 1.05.
pub fn pull(shape: Shape, size: [f64; 3], remanence: f64) -> f64 {
    let [l, a, b] = size;
    let facing = |d: f64| match shape {
        Shape::Block => facing(a, b, d),
        Shape::Disc => coaxial(a / 2.0, d),
    };
    let faces = 2.0 * PI * shape.volume([1.0, a, b]) - 2.0 * facing(l) + facing(2.0 * l);
    remanence * remanence / (4.0 * PI * MU0) * faces
}

/// The integral of d / R^3 over both of two discs of a radius R (m) on one axis, d (m) apart (m^2):
///
/// ```text
/// 4 pi^2 R^2 int J1(k R)^2 e^(-k d) / k dk = 2 pi^2 R^2 - 2 pi d s [K(m) - E(m)]
/// s^2 = 4 R^2 + d^2,   m = 4 R^2 / s^2
/// ```
///
/// K and E the complete elliptic integrals. Source: Vokoun, Beleggia, Heller and
/// Sittner, J. Magn. Magn. Mater. 321 (2009) 3758, for the integral over Bessel functions.
fn coaxial(radius: f64, d: f64) -> f64 {
    let s = libm::hypot(2.0 * radius, d);
    let c = 2.0 * radius / s;
    let (k, less) = complete_elliptic(d / s, c * c);
    2.0 * PI * (PI * radius * radius - d * s * (k * less))
}

/// The integral of d / R^3 over both of two rectangles a by b (m), d apart and square to each other
/// (m^2).
fn facing(a: f64, b: f64, d: f64) -> f64 {
    let (p, q) = (libm::hypot(a, d), libm::hypot(b, d));
    let r = libm::hypot(p, b);
    let side = |b: f64, p: f64| b * d * (libm::asinh(b / d) - libm::asinh(b / p));
    4.0 * (a * b * libm::atan(a * b / (d * r)) - side(b, p) - side(a, q) + d * (p + q - r - d))
}
