//! The shielding factors of pairs of magnets.

use super::{Vectors, Way, dot};
use crate::potential::simd::lanes::Lanes;

/// A factor g and its derivatives by the distance (1/m) and by cos(alpha): see
/// `Shield::factor`.
#[inline(always)]
fn factor<L: Lanes, const SLOPE: bool>(
    l: L,
    shield: [L::F; 4],
    distance: L::F,
    cosine: L::F,
) -> [L::F; 3] {
    let [attenuation, length, width, gain] = shield;
    let (zero, one) = (l.splat(0.0), l.splat(1.0));
    let ratio = l.mul(distance, length);
    let share = l.div(one, l.mul_add(ratio, ratio, one));
    let loss = l.mul(attenuation, share);
    let eta = l.sub(one, loss);
    let gap = l.sub(gain, eta);
    let [front, slope] = logistic(l, l.mul(cosine, width));
    let value = l.mul_add(gap, front, eta);
    if !SLOPE {
        return [value, zero, zero];
    }
    let eta_slope = l.mul(
        l.mul(l.splat(2.0), loss),
        l.mul(l.mul(ratio, length), share),
    );
    [
        value,
        l.mul(eta_slope, l.sub(one, front)),
        l.mul(l.mul(gap, slope), width),
    ]
}

/// The factor of pairs, its gradient by the second magnets' places (1/m) and its derivative by
/// their angles: see `pair_factor` of the plain formulas.
#[inline(always)]
pub(super) fn pair_factor<L: Lanes, const SLOPE: bool>(
    l: L,
    first: &Vectors<L::F>,
    second: &Vectors<L::F>,
    way: &Way<L::F>,
) -> [L::F; 4] {
    let zero = l.splat(0.0);
    let d = way.direction;
    let (n1, n2) = (
        first.normal,
        [l.sub(zero, second.normal[0]), l.sub(zero, second.normal[1])],
    );
    let (c1, c2) = (dot(l, n1, d), dot(l, n2, d));
    let [a, a_distance, a_cosine] = factor::<L, SLOPE>(l, first.shield, way.distance, c1);
    let [b, b_distance, b_cosine] = factor::<L, SLOPE>(l, second.shield, way.distance, c2);
    let value = l.mul(a, b);
    if !SLOPE {
        return [value, zero, zero, zero];
    }
    // By the distance, and by the two cosines, whose gradients are (n - d c) / r.
    let by_distance = l.mul_add(a_distance, b, l.mul(b_distance, a));
    let by_first = l.mul(l.mul(a_cosine, b), way.inverse);
    let by_second = l.mul(l.mul(b_cosine, a), way.inverse);
    let along = l.mul_add(by_first, c1, l.mul(by_second, c2));
    let along = l.sub(by_distance, along);
    let x = l.mul_add(by_first, n1[0], l.mul(by_second, n2[0]));
    let y = l.mul_add(by_first, n1[1], l.mul(by_second, n2[1]));
    // A turn of the second magnet turns -n2 to its left.
    let turned = [l.sub(zero, n2[1]), n2[0]];
    [
        value,
        l.mul_add(along, d[0], x),
        l.mul_add(along, d[1], y),
        l.mul(l.mul(a, b_cosine), dot(l, turned, d)),
    ]
}

/// Halvings of the exponential's argument.
const HALVINGS: usize = 7;

/// Larger arguments of the logistic function count as infinite.
const LARGEST: f64 = 60.0;

/// `S(t) = 1 / (1 + exp(-t))` and its derivative, to 3e-14.
///
/// `exp(-|t|)` is the 128th power of `exp(-|t| / 128)`, whose Taylor series of degree 12 is
/// accurate to 1e-14 or better unless the power is practically 0.
#[inline(always)]
pub(super) fn logistic<L: Lanes>(l: L, t: L::F) -> [L::F; 2] {
    let one = l.splat(1.0);
    let size = l.min(l.abs(t), l.splat(LARGEST));
    let x = l.mul(size, l.splat(-1.0 / (1 << HALVINGS) as f64));
    let mut e = one;
    for k in (1..=12).rev() {
        e = l.mul_add(l.mul(e, x), l.splat(1.0 / f64::from(k)), one);
    }
    for _ in 0..HALVINGS {
        e = l.mul(e, e);
    }
    let share = l.div(one, l.add(one, e));
    let tail = l.mul(e, share);
    [l.select(t, share, tail), l.mul(share, tail)]
}
