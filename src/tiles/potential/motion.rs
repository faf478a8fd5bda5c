//! Bounds of the derivatives of a pair's energy along a motion, by the pair's distance.
//!
//! Let the second of two point dipoles move for a time t along a straight motion of its tile, at a
//! speed of at most 1 m/s, while the tile turns at the rate w; such a motion has at most `w = 1 /
//! lever`. With `K = mu0 m1 m2 / (4 pi)` and r the dipoles' distance:
//!
//! * The energy is `K` times a second directional derivative of `1 / r`, whose n-th directional
//!   derivatives are at most `n! / r^(n+1)`. So a displacement of length d changes it by no more
//!   than the series of `2 K / (r - d)^3`, term by term.
//! * A turn moves the dipole along a circle of radius a, `a w <= 1`; its displacement is no more
//!   than `d(t) = t + w t^2 / 2 + w^2 t^3 / 6 + ...`, and the turn of the moment is bounded by the
//!   series of `e^(w t)`, both again term by term.
//!
//! Thus the n-th derivative at t = 0 is at most that of `2 K e^(w t) / (r - d(t))^3`:
//!
//! ```text
//! |U''|   <= K / r^3 [24 / r^2 + 18 w / r + 2 w^2]                                       (J/m^2)
//! |U''''| <= K / r^3 [720 / r^4 + 1200 w / r^3 + 600 w^2 / r^2 + 90 w^3 / r + 2 w^4]     (J/m^4)
//! ```
//!
//! For blocks, which are uniform distributions of dipoles, they hold with r the smallest distance
//! of the two. They are infinite at r = 0.

/// The bracket of the second derivative's bound as a polynomial in `1 / r`, the coefficient of the
/// highest power first; `turn` is w (1/m).
pub fn second_derivative(turn: f64) -> [f64; 3] {
    [24.0, 18.0 * turn, 2.0 * turn.powi(2)]
}

/// The same for the fourth derivative's bound.
pub fn fourth_derivative(turn: f64) -> [f64; 5] {
    [
        720.0,
        1200.0 * turn,
        600.0 * turn.powi(2),
        90.0 * turn.powi(3),
        2.0 * turn.powi(4),
    ]
}

/// The bound `k / r^3` times the polynomial (J/m^n) at a distance r (m); infinite where r is not
/// positive.
pub fn bound(terms: &[f64], k: f64, r: f64) -> f64 {
    if r <= 0.0 {
        return f64::INFINITY;
    }
    let polynomial = terms.iter().fold(0.0, |sum, term| sum / r + term);
    k / r.powi(3) * polynomial
}
