//! The potential of a uniformly charged disc, at real and complex positions.

use std::f64::consts::PI;

use super::complex::{Complexes, LEAST, Z};
use super::elliptic::{Complete, LEAST_TILT, at_least};
use crate::potential::simd::lanes::Lanes;

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
#[inline(always)]
pub fn potential<L: Lanes>(l: L, radius: f64, s: Z<L::F>, h: Z<L::F>) -> (Z<L::F>, [Z<L::F>; 2]) {
    let [inwards, under] = [l.sign(s.re), l.sign(h.re)];
    let (s, h) = (l.z_times(s, inwards), l.z_times(h, under));
    let h = Z {
        re: l.max(h.re, l.splat(LEAST)),
        im: h.im,
    };
    let rim = l.z_splat(radius, 0.0);
    let (within, beyond) = (l.z_sub(s, rim), l.z_add(s, rim));
    let square = l.z_mul(h, h);
    let near = l.z_sqrt(l.z_mul_add(within, within, square));
    let far = l.z_inverse(l.z_sqrt(l.z_mul_add(beyond, beyond, square)));
    let kc = l.z_mul(near, far);
    let q = l.z_times(l.z_div(within, beyond), l.splat(-1.0));
    // Exactly above the rim, where `q P` is not 0.
    let q = at_least(l, q, LEAST_TILT);
    // There are two continuations of `q P`, one infinite at q = kc, one at q = -kc; they differ by
    // the jump of the solid angle.
    let all = Complete::new(l, kc, q);
    let jump = l.select(all.side, l.splat(2.0 * PI), l.splat(0.0));
    let outwards = l.z_times(l.z_mul(all.tilted, far), l.splat(-4.0 * radius));
    let angle = l.z_mul(l.z_mul(h, far), l.z_mul_add(q, all.third, all.first));
    let upwards = Z {
        re: l.sub(l.mul(angle.re, l.splat(2.0)), jump),
        im: l.mul(angle.im, l.splat(2.0)),
    };
    let value = l.z_times(l.z_mul(all.first, far), l.splat(4.0 * radius * radius));
    let value = l.z_mul_add(s, outwards, l.z_mul_add(h, upwards, value));
    let slopes = [l.z_times(outwards, inwards), l.z_times(upwards, under)];
    (value, slopes)
}
