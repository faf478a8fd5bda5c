//! The potential of a uniformly charged disc, at real and complex positions.

use std::f64::consts::{FRAC_PI_2, PI};

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
    Place::new(l, radius, s, h).potential(l)
}

/// The potential with its derivatives up to the third.
#[derive(Clone, Copy, Debug)]
pub struct Derived<F> {
    /// V (m), as in [`potential`].
    pub value: Z<F>,
    /// By h and s.
    pub first: [Z<F>; 2],
    /// By h h, h s and s s (1/m).
    pub second: [Z<F>; 3],
    /// By h h h, h h s, h s s and s s s (1/m^2).
    pub third: [Z<F>; 4],
}

/// The potential of a disc of a radius (m) at the distance s from its axis and the height h (m), and its
/// derivatives.
///
/// With d the distance from a point of the rim, seen from the axis at the angle psi from s, `dV/ds = -R int
/// cos psi / d dpsi`, and `d2V/dh2 = R int (R - s cos psi) / d^3 dpsi` is the field of a current around the rim. Their
/// derivatives hold the integrals of `cos^j psi / d^3` for j up to 2 and of `cos^j psi / d^5` for j up to 3, see
/// [`Powers`].
#[inline(always)]
pub fn derived<L: Lanes>(l: L, radius: f64, s: Z<L::F>, h: Z<L::F>) -> Derived<L::F> {
    let place = Place::new(l, radius, s, h);
    let (value, [outwards, upwards]) = place.potential(l);
    let Place { h, far, signs, .. } = place;
    let Powers { cubes, fifths } = Powers::new(l, &place);
    let cube = l.z_mul(l.z_mul(far, far), far);
    let fifth = l.z_times(l.z_mul(l.z_mul(cube, far), far), l.splat(-3.0));
    let four = l.splat(4.0 * radius);
    let inside = place.inside(l, cubes[0], cubes[1]);
    let more_inside = place.inside(l, fifths[0], fifths[1]);
    let along = place.along(l, cubes[1], cubes[2]);
    let more_along = place.along(l, fifths[1], fifths[2]);
    let hh = l.z_mul(cube, inside);
    let hs = l.z_mul(l.z_mul(cube, h), cubes[1]);
    let ss = l.z_mul(cube, along);
    let hhh = l.z_mul(l.z_mul(fifth, h), more_inside);
    let hss = l.z_mul(l.z_mul(fifth, h), more_along);
    let both = place.along(l, more_inside, place.inside(l, fifths[1], fifths[2]));
    let twice = place.along(l, more_along, place.along(l, fifths[2], fifths[3]));
    let bent = l.z_mul(cube, cubes[1]);
    let hhs = l.z_sub(l.z_mul(fifth, both), bent);
    let sss = l.z_add(l.z_mul(fifth, twice), bent);
    let (inwards, under) = (l.mul(signs[0], four), l.mul(signs[1], four));
    let turned = l.mul(inwards, signs[1]);
    Derived {
        value,
        first: [upwards, outwards],
        second: [
            l.z_times(hh, four),
            l.z_times(hs, turned),
            l.z_times(ss, four),
        ],
        third: [
            l.z_times(hhh, under),
            l.z_times(hhs, inwards),
            l.z_times(hss, under),
            l.z_times(sss, inwards),
        ],
    }
}

/// A place by a disc, and the elliptic integrals there.
struct Place<F> {
    radius: f64,
    /// The distance from its axis and the height (m), with real parts that are not negative.
    s: Z<F>,
    h: Z<F>,
    /// The signs that they had.
    signs: [F; 2],
    /// The square of the distance (m) from the nearest point of the rim, and one by that from the farthest.
    near: Z<F>,
    far: Z<F>,
    /// `(R - s) / (R + s)`.
    q: Z<F>,
    all: Complete<F>,
}

impl<F: Copy> Place<F> {
    #[inline(always)]
    fn new<L: Lanes<F = F>>(l: L, radius: f64, s: Z<F>, h: Z<F>) -> Self {
        let signs = [l.sign(s.re), l.sign(h.re)];
        let (s, h) = (l.z_times(s, signs[0]), l.z_times(h, signs[1]));
        let h = Z {
            re: l.max(h.re, l.splat(LEAST)),
            im: h.im,
        };
        let rim = l.z_splat(radius, 0.0);
        let (within, beyond) = (l.z_sub(s, rim), l.z_add(s, rim));
        let square = l.z_mul(h, h);
        let near = l.z_mul_add(within, within, square);
        let far = l.z_inverse(l.z_sqrt(l.z_mul_add(beyond, beyond, square)));
        let kc = l.z_mul(l.z_sqrt(near), far);
        let q = l.z_times(l.z_div(within, beyond), l.splat(-1.0));
        // Exactly above the rim, where `q P` is not 0.
        let q = at_least(l, q, LEAST_TILT);
        Self {
            radius,
            s,
            h,
            signs,
            near,
            far,
            q,
            all: Complete::new(l, kc, q),
        }
    }

    /// The integral of `(R - s c) f`, c = cos psi, from those of f and c f.
    #[inline(always)]
    fn inside<L: Lanes<F = F>>(&self, l: L, f: Z<F>, cf: Z<F>) -> Z<F> {
        l.z_sub(l.z_times(f, l.splat(self.radius)), l.z_mul(self.s, cf))
    }

    /// The integral of `(s - R c) f` likewise.
    #[inline(always)]
    fn along<L: Lanes<F = F>>(&self, l: L, f: Z<F>, cf: Z<F>) -> Z<F> {
        l.z_sub(l.z_mul(self.s, f), l.z_times(cf, l.splat(self.radius)))
    }

    /// The potential and its derivatives by s and h.
    #[inline(always)]
    fn potential<L: Lanes<F = F>>(&self, l: L) -> (Z<F>, [Z<F>; 2]) {
        let Self {
            radius,
            s,
            h,
            far,
            q,
            all,
            signs: [inwards, under],
            ..
        } = *self;
        // There are two continuations of `q P`, one infinite at q = kc, one at q = -kc; they differ by
        // the jump of the solid angle.
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
}

/// The integrals of `c^j / D^3` for j to 2 and of `c^j / D^5` for j to 3, as those of [`Complete`], with
/// `c = sin^2 phi - cos^2 phi` and `D^2 = p - q c`, `p = (1 + kc^2) / 2`, `q = (1 - kc^2) / 2`.
///
/// As `c = (p - D^2) / q`, each is `(p I_(n, j-1) - I_(n-2, j-1)) / q`, from K and C, and from j = 0: `I_30 = (p K - q C) /
/// kc^2`, `I_50 = (4 p I_30 - K) / (3 kc^2)`. Near the axis q is small and this loses digits; there the last of both
/// are power series in q / p (with the means of `c^2k`, `(2k - 1)!! / (2k)!!`), and the others follow from them.
struct Powers<F> {
    cubes: [Z<F>; 3],
    fifths: [Z<F>; 4],
}

/// The largest `q / p` of the series.
const SMALL: f64 = 0.1;
/// The terms of the series.
const TERMS: usize = 6;
/// The series of I_32 and of `I_53 p / q`, in `(q / p)^2`, times `p^(3/2)` and `p^(5/2)`.
const SERIES: [[f64; TERMS]; 2] = {
    let mut all = [[0.0; TERMS]; 2];
    // The coefficients of q / p to the m-th, and the means of c^2k.
    let mut own = [FRAC_PI_2; 2];
    let mut mean = 1.0;
    let mut m = 0;
    while m < 2 * TERMS {
        let even = (m / 2 * 2) as f64;
        if m % 2 == 0 {
            mean *= (even + 1.0) / (even + 2.0);
            all[0][m / 2] = own[0] * mean;
        } else {
            all[1][m / 2] = own[1] * mean * (even + 3.0) / (even + 4.0);
        }
        let next = m as f64;
        own[0] *= (1.5 + next) / (1.0 + next);
        own[1] *= (2.5 + next) / (1.0 + next);
        m += 1;
    }
    all
};

impl<F: Copy> Powers<F> {
    #[inline(always)]
    fn new<L: Lanes<F = F>>(l: L, place: &Place<F>) -> Self {
        let Place { s, near, far, .. } = *place;
        let [first, tilted] = [place.all.first, place.all.tilted];
        let square = l.z_mul(far, far);
        let inverse = l.z_inverse(l.z_mul(near, square));
        let q = l.z_times(l.z_mul(s, square), l.splat(2.0 * place.radius));
        let p = l.z_sub(l.z_splat(1.0, 0.0), q);
        let by_q = l.z_inverse(q);
        let zeroth = l.z_mul(l.z_sub(l.z_mul(p, first), l.z_mul(q, tilted)), inverse);
        let once = up(l, [p, by_q], zeroth, first);
        let cubes = [zeroth, once, up(l, [p, by_q], once, tilted)];
        let zeroth = l.z_times(l.z_mul(p, zeroth), l.splat(4.0));
        let zeroth = l.z_times(l.z_mul(l.z_sub(zeroth, first), inverse), l.splat(1.0 / 3.0));
        let once = up(l, [p, by_q], zeroth, cubes[0]);
        let twice = up(l, [p, by_q], once, cubes[1]);
        let fifths = [zeroth, once, twice, up(l, [p, by_q], twice, cubes[2])];
        let mut found = Self { cubes, fifths };
        let by_p = l.z_inverse(p);
        let ratio = l.z_mul(q, by_p);
        let is_large = l.sub(l.z_norm(ratio), l.splat(SMALL * SMALL));
        if l.least(is_large) < 0.0 {
            let near = Self::near_the_axis(l, [q, by_p, ratio], [first, tilted]);
            for j in 0..3 {
                found.cubes[j] = l.z_select(is_large, found.cubes[j], near.cubes[j]);
            }
            for j in 0..4 {
                found.fifths[j] = l.z_select(is_large, found.fifths[j], near.fifths[j]);
            }
        }
        found
    }

    #[inline(always)]
    fn near_the_axis<L: Lanes<F = F>>(
        l: L,
        [q, by_p, ratio]: [Z<F>; 3],
        [first, tilted]: [Z<F>; 2],
    ) -> Self {
        let scale = l.z_mul(by_p, l.z_sqrt(by_p));
        let step = l.z_mul(ratio, ratio);
        let last = l.z_mul(scale, series(l, &SERIES[0], step));
        let once = down(l, [q, by_p], last, tilted);
        let cubes = [down(l, [q, by_p], once, first), once, last];
        let last = l.z_mul(ratio, series(l, &SERIES[1], step));
        let last = l.z_mul(l.z_mul(scale, by_p), last);
        let twice = down(l, [q, by_p], last, cubes[2]);
        let once = down(l, [q, by_p], twice, cubes[1]);
        let fifths = [down(l, [q, by_p], once, cubes[0]), once, twice, last];
        Self { cubes, fifths }
    }
}

/// The integral with the next power of c, from that with its own and `before`, that with D squared.
#[inline(always)]
fn up<L: Lanes>(l: L, [p, by_q]: [Z<L::F>; 2], own: Z<L::F>, before: Z<L::F>) -> Z<L::F> {
    l.z_mul(l.z_sub(l.z_mul(p, own), before), by_q)
}

/// That with the power before, likewise.
#[inline(always)]
fn down<L: Lanes>(l: L, [q, by_p]: [Z<L::F>; 2], own: Z<L::F>, before: Z<L::F>) -> Z<L::F> {
    l.z_mul(l.z_mul_add(q, own, before), by_p)
}

#[inline(always)]
fn series<L: Lanes>(l: L, terms: &[f64; TERMS], x: Z<L::F>) -> Z<L::F> {
    let mut sum = l.z_splat(terms[TERMS - 1], 0.0);
    for term in terms[..TERMS - 1].iter().rev() {
        sum = l.z_mul_add(sum, x, l.z_splat(*term, 0.0));
    }
    sum
}
