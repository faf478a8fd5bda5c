//! The potential of a uniformly charged rectangle, at real and complex positions.

use super::complex::{Complexes, LEAST, Z};
use crate::potential::simd::lanes::Lanes;

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
#[inline(always)]
pub fn potential<L: Lanes>(
    l: L,
    [a, b]: [f64; 2],
    [x, y, h]: [Z<L::F>; 3],
) -> (Z<L::F>, [Z<L::F>; 3]) {
    let under = l.sign(h.re);
    let h = l.z_times(h, under);
    let h = Z {
        re: l.max(h.re, l.splat(LEAST)),
        im: h.im,
    };
    let hh = l.z_mul(h, h);
    let zero = l.z_splat(0.0, 0.0);
    let (mut value, mut slopes) = (zero, [zero; 3]);
    for sides in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
        let u = l.z_sub(l.z_splat(sides[0] * a, 0.0), x);
        let v = l.z_sub(l.z_splat(sides[1] * b, 0.0), y);
        let (uu, vv) = (l.z_mul(u, u), l.z_mul(v, v));
        let (dd, ee) = (l.z_add(uu, hh), l.z_add(vv, hh));
        let r = l.z_sqrt(l.z_add(uu, ee));
        let (d, e) = (l.z_sqrt(dd), l.z_sqrt(ee));
        let uv = l.z_mul(u, v);
        let turned = Z {
            re: l.sub(l.splat(0.0), uv.im),
            im: uv.re,
        };
        let angle = angle(l, l.z_mul(h, r), turned, l.z_mul(d, e));
        let slope = [logarithm(l, v, r, d), logarithm(l, u, r, e)];
        let sign = l.splat(sides[0] * sides[1]);
        let sum = l.z_mul_add(u, slope[0], l.z_mul(v, slope[1]));
        let sum = l.z_sub(sum, l.z_mul(h, angle));
        value = l.z_add(value, l.z_times(sum, sign));
        slopes[0] = l.z_sub(slopes[0], l.z_times(slope[0], sign));
        slopes[1] = l.z_sub(slopes[1], l.z_times(slope[1], sign));
        slopes[2] = l.z_sub(slopes[2], l.z_times(angle, l.mul(sign, under)));
    }
    (value, slopes)
}

/// `ln((v + r) / d)` where `r^2 = v^2 + d^2`; the larger of `r + v` and `r - v` is taken.
#[inline(always)]
fn logarithm<L: Lanes>(l: L, v: Z<L::F>, r: Z<L::F>, d: Z<L::F>) -> Z<L::F> {
    let large = l.z_add(r, l.z_times(v, l.sign(v.re)));
    l.z_times(l.z_ln_ratio(large, d), l.sign(v.re))
}

/// `-i ln((a + b) / c)` where `a^2 - b^2 = c^2`; the larger of `a + b` and `a - b` is taken.
#[inline(always)]
fn angle<L: Lanes>(l: L, a: Z<L::F>, b: Z<L::F>, c: Z<L::F>) -> Z<L::F> {
    let (more, less) = (l.z_add(a, b), l.z_sub(a, b));
    let is_more = l.sub(l.z_norm(more), l.z_norm(less));
    let ln = l.z_ln_ratio(l.z_select(is_more, more, less), c);
    let sign = l.sign(is_more);
    Z {
        re: l.mul(ln.im, sign),
        im: l.mul(l.sub(l.splat(0.0), ln.re), sign),
    }
}
