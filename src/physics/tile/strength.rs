//! How strong a magnet is.

use std::f64::consts::PI;

use crate::units::MU0;

/// How strong a magnet is; one of the three ways to say it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// Magnetic moment (A m^2).
    Moment(f64),
    /// Remanence Br of the uniformly magnetised block (T).
    Remanence(f64),
    /// Field at the centre of the block's pole face (T).
    SurfaceField(f64),
}

impl Strength {
    /// The moment (A m^2) of a block of `size` (m; along its axis first): `m = Br V / mu0`, with
    /// Br from [`surface_field_share`] where the field at the pole face is what is known.
    pub fn moment(self, size: [f64; 3]) -> f64 {
        let volume: f64 = size.iter().product();
        match self {
            Self::Moment(moment) => moment,
            Self::Remanence(remanence) => remanence * volume / MU0,
            Self::SurfaceField(field) => field / surface_field_share(size) * volume / MU0,
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
