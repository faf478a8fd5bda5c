//! Energies and factors of pairs with their derivatives up to second order.
//!
//! The variables are `s = ln r`, the direction phi of the vector from the first magnet to the
//! second, and the second magnet's turn t, in which all formulas are short. With `zeta = s + i phi`
//! this vector is `z = e^zeta`, from which the derivatives by places follow (see
//! [`Jet::by_place`]).

use super::factor::logistic;
use super::{Vectors, Way, dot};
use crate::potential::simd::lanes::Lanes;
use crate::units::MU0_OVER_4PI;

/// A value, its derivatives by s, phi and t, and its second ones by ss, phi phi, tt, s phi, s t and
/// phi t.
#[derive(Clone, Copy)]
pub(super) struct Jet<F>(pub [F; 10]);

/// The two first derivatives, and the index, of each second one.
const SECOND: [(usize, usize, usize); 6] = [
    (1, 1, 4),
    (2, 2, 5),
    (3, 3, 6),
    (1, 2, 7),
    (1, 3, 8),
    (2, 3, 9),
];

impl<F: Copy> Jet<F> {
    #[inline(always)]
    pub fn times<L: Lanes<F = F>>(&self, l: L, other: &Self) -> Self {
        let (f, g) = (&self.0, &other.0);
        let mut out = [l.mul(f[0], g[0]); 10];
        for i in 1..4 {
            out[i] = l.mul_add(f[0], g[i], l.mul(f[i], g[0]));
        }
        for (i, j, k) in SECOND {
            let mixed = l.mul_add(f[i], g[j], l.mul(f[j], g[i]));
            out[k] = l.mul_add(f[0], g[k], l.mul_add(f[k], g[0], mixed));
        }
        Self(out)
    }

    /// The value and the derivatives by the second magnet's place (x, y) and by t, in the order of
    /// [`PlaneJet`].
    ///
    /// With `w = 1 / z`: `2 d/dz = w (d_s - i d_phi)`, `4 d2/dz2 = w^2 [d_ss - d_phiphi - 2 d_s - 2 i
    /// (d_sphi - d_phi)]` and `4 d2/dz dz* = |w|^2 (d_ss + d_phiphi)`.
    #[inline(always)]
    pub fn by_place<L: Lanes<F = F>>(&self, l: L, way: &Way<F>) -> PlaneJet<F> {
        let [value, s, p, t, ss, pp, tt, sp, st, pt] = self.0;
        let [x, y] = way.direction;
        let (two, half) = (l.splat(2.0), l.splat(0.5));
        let square = l.mul(way.inverse, way.inverse);
        // d^2 of the direction d.
        let (x2, y2) = (l.neg_mul_add(y, y, l.mul(x, x)), l.mul(two, l.mul(x, y)));
        let real = l.neg_mul_add(two, s, l.sub(ss, pp));
        let imaginary = l.mul(two, l.sub(p, sp));
        // (real + i imaginary) d*^2
        let q = l.mul_add(imaginary, y2, l.mul(real, x2));
        let q_imaginary = l.neg_mul_add(real, y2, l.mul(imaginary, x2));
        let r = l.add(ss, pp);
        let halved = l.mul(half, square);
        [
            value,
            l.mul(way.inverse, l.neg_mul_add(y, p, l.mul(x, s))),
            l.mul(way.inverse, l.mul_add(x, p, l.mul(y, s))),
            t,
            l.mul(halved, l.add(r, q)),
            l.mul(halved, l.sub(r, q)),
            tt,
            l.mul(halved, l.sub(l.splat(0.0), q_imaginary)),
            l.mul(way.inverse, l.neg_mul_add(y, pt, l.mul(x, st))),
            l.mul(way.inverse, l.mul_add(x, pt, l.mul(y, st))),
        ]
    }
}

/// A value, its derivatives by x, y and t, and by xx, yy, tt, xy, xt and yt.
pub(super) type PlaneJet<F> = [F; 10];

/// The component of `b` across `a`: `a x b`.
#[inline(always)]
fn cross<L: Lanes>(l: L, a: [L::F; 2], b: [L::F; 2]) -> L::F {
    l.neg_mul_add(a[1], b[0], l.mul(a[0], b[1]))
}

/// The energy (J) of two dipoles, `k r^-3 [-1/2 cos(b - a) - 3/2 cos(a + b)]` with k = mu0 m1 m2 /
/// (4 pi) and the moments' angles a and b from the vector between them.
#[inline(always)]
pub(super) fn dipoles<L: Lanes>(
    l: L,
    first: &Vectors<L::F>,
    second: &Vectors<L::F>,
    way: &Way<L::F>,
) -> Jet<L::F> {
    let (m1, m2, d) = (first.moment, second.moment, way.direction);
    let (along1, along2) = (dot(l, m1, d), dot(l, m2, d));
    let (across1, across2) = (cross(l, d, m1), cross(l, d, m2));
    let (both, crossed) = (l.mul(along1, along2), l.mul(across1, across2));
    let cube = l.mul(way.inverse, l.mul(way.inverse, way.inverse));
    let half = l.mul(l.splat(0.5 * MU0_OVER_4PI), cube);
    let three_halves = l.mul(l.splat(1.5 * MU0_OVER_4PI), cube);
    // Cosine and sine of b - a and of a + b.
    let cos_between = l.mul(half, l.add(both, crossed));
    let sin_between = l.mul(half, l.neg_mul_add(across1, along2, l.mul(along1, across2)));
    let cos_sum = l.mul(three_halves, l.sub(both, crossed));
    let sin_sum = l.mul(
        three_halves,
        l.mul_add(along1, across2, l.mul(across1, along2)),
    );
    let (two, zero) = (l.splat(2.0), l.splat(0.0));
    let minus_three = l.splat(-3.0);
    let by_t = l.add(sin_between, sin_sum);
    let by_phi = l.mul(l.splat(-2.0), sin_sum);
    let opposite = l.add(cos_between, cos_sum);
    let value = l.sub(zero, opposite);
    Jet([
        value,
        l.mul(minus_three, value),
        by_phi,
        by_t,
        l.mul(l.splat(9.0), value),
        l.mul(l.splat(4.0), cos_sum),
        opposite,
        l.mul(minus_three, by_phi),
        l.mul(minus_three, by_t),
        l.sub(zero, l.mul(two, cos_sum)),
    ])
}

/// A factor g by s and by the angle alpha from the normal to the vector between the magnets: value,
/// s, alpha, ss, s alpha, alpha alpha. It is returned with S'.
#[inline(always)]
fn factor<L: Lanes>(
    l: L,
    shield: [L::F; 4],
    distance: L::F,
    [cosine, sine]: [L::F; 2],
) -> ([L::F; 6], L::F) {
    let [attenuation, length, width, gain] = shield;
    let (zero, one, two) = (l.splat(0.0), l.splat(1.0), l.splat(2.0));
    let ratio = l.mul(distance, length);
    let share = l.div(one, l.mul_add(ratio, ratio, one));
    let loss = l.mul(attenuation, share);
    let eta = l.sub(one, loss);
    let eta1 = l.mul(l.mul(two, loss), l.sub(one, share));
    let eta2 = l.mul(eta1, l.mul_add(l.splat(4.0), share, l.splat(-2.0)));
    let gap = l.sub(gain, eta);
    let [front, steep] = logistic(l, l.mul(cosine, width));
    let back = l.sub(one, front);
    let rate = l.mul(steep, width);
    let front1 = l.sub(zero, l.mul(rate, sine));
    let bent = l.mul(l.neg_mul_add(two, front, one), width);
    let front2 = l.mul(
        rate,
        l.neg_mul_add(one, cosine, l.mul(bent, l.mul(sine, sine))),
    );
    let jet = [
        l.mul_add(gap, front, eta),
        l.mul(eta1, back),
        l.mul(gap, front1),
        l.mul(eta2, back),
        l.sub(zero, l.mul(eta1, front1)),
        l.mul(gap, front2),
    ];
    (jet, steep)
}

/// The factors of two magnets, and S' of both.
#[inline(always)]
pub(super) fn factors<L: Lanes>(
    l: L,
    first: &Vectors<L::F>,
    second: &Vectors<L::F>,
    way: &Way<L::F>,
) -> ([Jet<L::F>; 2], [L::F; 2]) {
    let zero = l.splat(0.0);
    let d = way.direction;
    let n1 = first.normal;
    let n2 = [l.sub(zero, second.normal[0]), l.sub(zero, second.normal[1])];
    let towards1 = [dot(l, n1, d), cross(l, n1, d)];
    let towards2 = [dot(l, n2, d), cross(l, n2, d)];
    let ([g, s, a, ss, sa, aa], steep1) = factor(l, first.shield, way.distance, towards1);
    let fixed = Jet([g, s, a, zero, ss, aa, zero, sa, zero, zero]);
    let ([g, s, a, ss, sa, aa], steep2) = factor(l, second.shield, way.distance, towards2);
    // A turn of the second magnet is subtracted from alpha.
    let (ma, msa, maa) = (l.sub(zero, a), l.sub(zero, sa), l.sub(zero, aa));
    let moving = Jet([g, s, a, ma, ss, aa, aa, sa, msa, maa]);
    ([fixed, moving], [steep1, steep2])
}
