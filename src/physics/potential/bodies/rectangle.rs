//! The potential of a uniformly charged rectangle, at real and complex positions.

use super::complex::{C, LEAST, ln, sqrt};

/// The integral V of `1 / r` (m) over a rectangle with half sides a and b (m), at x, y along its
/// sides from its centre and h above it (m); its derivatives by the three.
///
/// V is the sum over the four corners, with `u = +-a - x`, `v = +-b - y`, `r^2 = u^2 + v^2 + h^2`, and
/// the signs' product before each, of
///
/// ```text
/// F(u, v, h) = u ln((v + r) / d) + v ln((u + r) / e) - h w
/// d = sqrt(u^2 + h^2),   e = sqrt(v^2 + h^2),   exp(i w) = (h r + i u v) / (d e)
/// dF/du = ln((v + r) / d),   dF/dv = ln((u + r) / e),   dF/dh = -w
/// ```
///
/// (w is `atan(u v / (h r))`; d and e cancel in the sum, but keep the logarithms away from their
/// branch at complex places.) Source: Durand, *Electrostatique* (1964), volume 1, for real places.
/// Special cases: at the rectangle dV/dh jumps by 4 pi, and V is even in h; at its sides the
/// derivatives grow like the logarithm of the distance.
///
/// At complex places it is continued as [`super::disc::potential`] is.
pub fn potential([a, b]: [f64; 2], [x, y, h]: [C; 3]) -> (C, [C; 3]) {
    let under = if h.re < 0.0 { -1.0 } else { 1.0 };
    let h = C::new((h.re * under).max(LEAST), h.im * under);
    let (mut value, mut slopes) = (C::default(), [C::default(); 3]);
    for sides in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
        let (u, v) = (-x + sides[0] * a, -y + sides[1] * b);
        let r = sqrt(u * u + v * v + h * h);
        let (d, e) = (sqrt(u * u + h * h), sqrt(v * v + h * h));
        let angle = angle(h * r, C::i() * u * v, d * e);
        let slope = [logarithm(v, r, d), logarithm(u, r, e), -angle];
        let sign = sides[0] * sides[1];
        value += (u * slope[0] + v * slope[1] + h * slope[2]) * sign;
        slopes[0] -= slope[0] * sign;
        slopes[1] -= slope[1] * sign;
        slopes[2] += slope[2] * (sign * under);
    }
    (value, slopes)
}

/// `ln((v + r) / d)` where `r^2 = v^2 + d^2`; the larger of `r + v` and `r - v` is taken.
fn logarithm(v: C, r: C, d: C) -> C {
    let large = if v.re < 0.0 { r - v } else { r + v };
    let ln = if d == C::default() {
        C::default()
    } else {
        ln(large / d)
    };
    if v.re < 0.0 { -ln } else { ln }
}

/// `-i ln((a + b) / c)` where `a^2 - b^2 = c^2`; the larger of `a + b` and `a - b` is taken.
fn angle(a: C, b: C, c: C) -> C {
    let [more, less] = [a + b, a - b];
    if more.norm_sqr() < less.norm_sqr() {
        ln(less / c) * C::i()
    } else {
        ln(more / c) * -C::i()
    }
}
