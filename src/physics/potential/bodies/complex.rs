//! Square roots and logarithms of complex numbers, with the same bits on every machine.

use nalgebra::Complex;

pub type C = Complex<f64>;

/// The smallest height over a face's plane: a point in the plane is treated as right above it, and
/// complex heights have a side.
pub const LEAST: f64 = 1e-150;

/// The square root with a real part that is not negative.
pub fn sqrt(z: C) -> C {
    let length = (z.re * z.re + z.im * z.im).sqrt();
    let large = ((length + z.re.abs()) / 2.0).sqrt();
    if large == 0.0 {
        return C::new(0.0, 0.0);
    }
    let small = z.im / (2.0 * large);
    if z.re >= 0.0 {
        C::new(large, small)
    } else {
        C::new(small.abs(), large.copysign(z.im))
    }
}

/// The logarithm with an imaginary part from -pi to pi.
pub fn ln(z: C) -> C {
    C::new(libm::log(z.norm_sqr()) / 2.0, libm::atan2(z.im, z.re))
}
