//! The potential of a uniformly charged disc, at real and complex positions.

use std::f64::consts::PI;

use super::complex::{C, LEAST, sqrt};
use super::elliptic::Complete;

/// The integral V of `1 / r` (m) over a disc of a radius R (m), at the distance s from its axis and the
/// height h over it (m); its derivatives by both.
///
/// With `a^2 = (R + s)^2 + h^2`, `kc = sqrt((R - s)^2 + h^2) / a`, `q = (R - s) / (R + s)`, and K, C
/// and P the integrals of [`Complete`]:
///
/// ```text
/// dV/ds = -4 R C / a                    (the rim, by the divergence theorem)
/// dV/dh = 2 h (K + q P) / a - 2 pi      (minus the solid angle)
/// V = 4 R^2 K / a + s dV/ds + h dV/dh   (V grows like a length)
/// ```
///
/// Source: Paxton, *Solid angle calculation for a circular disk*, Rev. Sci. Instrum. 30 (1959) 254.
/// Special cases: at the disc itself dV/dh jumps by 4 pi, and V is even in h; at the rim the
/// derivatives grow like the logarithm of the distance.
///
/// At complex places, `x + i v` with x and v real, V is continued from x; see [`super::line`] for the
/// v to which that is possible.
pub fn potential(radius: f64, s: C, h: C) -> (C, [C; 2]) {
    let [inwards, under] = [s, h].map(|z| if z.re < 0.0 { -1.0 } else { 1.0 });
    let (s, h) = (s * inwards, h * under);
    let h = C::new(h.re.max(LEAST), h.im);
    let [near, far] = [s - radius, s + radius].map(|d| sqrt(d * d + h * h));
    let (kc, q) = (near / far, -(s - radius) / (s + radius));
    // There are two continuations of `q P`, one infinite at q = kc, one at q = -kc; they differ by
    // the jump of the solid angle.
    let over = (q + kc).norm_sqr() > (q - kc).norm_sqr();
    let (sign, jump) = if over { (1.0, 2.0 * PI) } else { (-1.0, 0.0) };
    let all = Complete::new(kc, q * sign);
    let outwards = -all.tilted / far * (4.0 * radius);
    let upwards = h / far * (all.first + q * all.third) * 2.0 - jump;
    let value = all.first / far * (4.0 * radius * radius) + s * outwards + h * upwards;
    (value, [outwards * inwards, upwards * under])
}
