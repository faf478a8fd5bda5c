//! A magnet's own demagnetising field, and the working point at which it leaves the magnet.
//!
//! Inside a magnet of polarisation J its own poles make the field H = -N J / mu0, on average over its
//! volume. A magnet of remanence Br and recoil permeability mu then has
//!
//! `J = Br + (mu - 1) mu0 H = Br / (1 + N (mu - 1))`.
//!
//! At mu = 1.05 a long magnet (N = 0) keeps Br, a cube or a cylinder as high as wide (N = 0.33 and
//! 0.31) has 0.984 of it, a thin plate (N = 1) 0.952; forces are the square of that. Fields of other
//! magnets change J by as little again: attraction strengthens, repulsion weakens both.

use std::f64::consts::PI;

use super::magnet::Shape;

/// The recoil permeability of sintered neodymium, samarium cobalt and hard ferrite: makers state 1.03
/// to 1.10.
pub const RECOIL: f64 = 1.05;

/// Measured polarisations over the nominal remanence: seven published sets of forces and fields are
/// fitted best by shares in this range (`results/validation`).
pub const MEASURED: [f64; 2] = [0.90, 0.97];

/// The polarisation of a magnet by itself over its remanence; `size` (m), along its axis first.
pub fn working_point(shape: Shape, size: [f64; 3]) -> f64 {
    1.0 / (1.0 + factor(shape, size) * (RECOIL - 1.0))
}

/// The demagnetising factor N along the axis, averaged over the volume: 0 for a long magnet, 1 for a
/// thin plate; `size` (m), along its axis first. Between factors of 1e-3 and 1e3 of height to width
/// it is exact to 1e-6.
pub fn factor(shape: Shape, [height, across, through]: [f64; 3]) -> f64 {
    let factor = match shape {
        Shape::Disc => of_cylinder(height / across),
        Shape::Block => of_block([across, through, height].map(|it| 0.5 * it)),
    };
    factor.clamp(0.0, 1.0)
}

/// The factor of a cylinder whose height is p times its diameter:
///
/// `1 - 4 / (3 pi p) (sqrt(1 + p^2) [p^2 K(m) + (1 - p^2) E(m)] - 1)`, `m = 1 / (1 + p^2)`,
///
/// K and E the complete elliptic integrals of parameter m. Source: Joseph, J. Appl. Phys. 37 (1966)
/// 4639. Limits: `4 / (3 pi p)` for a long cylinder, 1 for a thin disc.
fn of_cylinder(p: f64) -> f64 {
    let m = 1.0 / (1.0 + p * p);
    let (k, less) = complete_elliptic((1.0 - m).sqrt(), m);
    let e = k * (1.0 - less);
    let bracket = (1.0 + p * p).sqrt() * (p * p * k + (1.0 - p * p) * e) - 1.0;
    1.0 - 4.0 / (3.0 * PI * p) * bracket
}

/// K(m), and `(K - E) / K = sum 2^(n-1) c_n^2` by the means of a_0 = 1 and `b` = b_0 = sqrt(1 - m), arithmetic
/// and geometric, `c_n^2 = a_n^2 - b_n^2`.
pub(super) fn complete_elliptic(mut b: f64, m: f64) -> (f64, f64) {
    // After six all digits agree, except for discs that nearly touch.
    const MEANS: usize = 12;
    let (mut a, mut sum, mut power) = (1.0, 0.5 * m, 1.0);
    for _ in 0..MEANS {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        sum += power * c * c;
        power *= 2.0;
    }
    (PI / (2.0 * a), sum)
}

/// The factor along c of a block of half sides a, b and c. Source: Aharoni, J. Appl. Phys. 83 (1998)
/// 3432, equation 1.
fn of_block([a, b, c]: [f64; 3]) -> f64 {
    let (ab, bc, ac) = (libm::hypot(a, b), libm::hypot(b, c), libm::hypot(a, c));
    let r = libm::hypot(ab, c);
    // ln((x + y) / (x - y)) = 2 artanh(y / x)
    let log = |x: f64, y: f64| 2.0 * libm::atanh(y / x);
    let cube = |x: f64| x * x * x;
    let terms = [
        -(b * b - c * c) / (2.0 * b * c) * log(r, a),
        -(a * a - c * c) / (2.0 * a * c) * log(r, b),
        b / (2.0 * c) * log(ab, a),
        a / (2.0 * c) * log(ab, b),
        -c / (2.0 * a) * log(bc, b),
        -c / (2.0 * b) * log(ac, a),
        2.0 * libm::atan(a * b / (c * r)),
        (cube(a) + cube(b) - 2.0 * cube(c)) / (3.0 * a * b * c),
        (a * a + b * b - 2.0 * c * c) * r / (3.0 * a * b * c),
        c / (a * b) * (ac + bc),
        -(cube(ab) + cube(bc) + cube(ac)) / (3.0 * a * b * c),
    ];
    terms.iter().sum::<f64>() / PI
}
