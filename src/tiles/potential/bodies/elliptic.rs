//! Complete elliptic integrals of complex arguments.

use std::f64::consts::FRAC_PI_2;

use super::complex::{Complexes, Z};
use crate::potential::simd::lanes::Lanes;

/// Three integrals over phi from 0 to pi/2, with `D = sqrt(cos^2 phi + kc^2 sin^2 phi)`.
#[derive(Clone, Copy, Debug)]
pub struct Complete<F> {
    /// The integral of `1 / D`: the first kind, K.
    pub first: Z<F>,
    /// The integral of `(sin^2 phi - cos^2 phi) / D`.
    pub tilted: Z<F>,
    /// The integral of `1 / ((cos^2 phi + q^2 sin^2 phi) D)`, the third kind, by q or, where that loses
    /// digits, by -q.
    pub third: Z<F>,
    /// 1 if it is by q, -1 if by -q.
    pub side: F,
}

/// The smallest complementary modulus and the smallest q, which replace smaller ones: at 0, K and the
/// third kind are infinite.
const LEAST: [f64; 2] = [1e-150, LEAST_TILT];
/// The smallest q. A product of q and the third kind, which is finite at 0, needs this q in both.
pub const LEAST_TILT: f64 = 1e-60;
/// More steps of the algorithm than any modulus takes.
const MOST_STEPS: usize = 40;

impl<F: Copy> Complete<F> {
    /// By the complementary modulus `kc` and by `q`, continued from where both are positive to all
    /// `kc` but the negative real axis, and to all `q` but where `q = -kc`.
    ///
    /// Bulirsch's algorithm, Numer. Math. 13 (1969) 305: of means, arithmetic and geometric, which
    /// agree to all digits after five or six steps. Each geometric mean is that root which is closer
    /// to the arithmetic one (Cox, *The arithmetic-geometric mean of Gauss*, Enseign. Math. 30 (1984)
    /// 275), and q enters as itself, not as its square, so that no branch is left. The third kind's p tends
    /// to the mean m or to -m, where the integral is lost in `m + p`, and infinite at `q = -kc`; as p and
    /// b are odd in q, both belong to -q after a change of sign.
    #[inline(always)]
    pub fn new<L: Lanes<F = F>>(l: L, kc: Z<F>, q: Z<F>) -> Self {
        let one = l.z_splat(1.0, 0.0);
        let (mut k, q) = (at_least(l, kc, LEAST[0]), at_least(l, q, LEAST[1]));
        let (mut e, mut m) = (k, one);
        // Numerators a and b, and the p that the first two have in common and that of the third.
        let mut a = [one, l.z_splat(-1.0, 0.0), one];
        let mut b = [one, one, l.z_inverse(q)];
        let mut p = [one, q];
        let two = l.splat(2.0);
        for _ in 0..MOST_STEPS {
            let inverse = [l.z_inverse(p[0]), l.z_inverse(p[1])];
            let g = [l.z_mul(e, inverse[0]), l.z_mul(e, inverse[1])];
            for i in 0..3 {
                let (inverse, g, before) = (inverse[i / 2], g[i / 2], a[i]);
                a[i] = l.z_mul_add(b[i], inverse, before);
                b[i] = l.z_times(l.z_mul_add(before, g, b[i]), two);
            }
            p = [l.z_add(p[0], g[0]), l.z_add(p[1], g[1])];
            let apart = l.z_norm(l.z_sub(m, k));
            let allowed = l.mul(l.z_norm(m), l.splat(1e-16));
            m = l.z_add(m, k);
            if l.least(l.sub(allowed, apart)) >= 0.0 {
                break;
            }
            let root = l.z_times(l.z_sqrt(e), two);
            let closer = l.mul_add(root.im, m.im, l.mul(root.re, m.re));
            k = l.z_times(root, l.sign(closer));
            e = l.z_mul(k, m);
        }
        let side = l.sign(l.mul_add(p[1].im, m.im, l.mul(p[1].re, m.re)));
        let (b2, p1) = (l.z_times(b[2], side), l.z_times(p[1], side));
        Self {
            first: integral(l, m, [a[0], b[0], p[0]]),
            tilted: integral(l, m, [a[1], b[1], p[0]]),
            third: integral(l, m, [a[2], b2, p1]),
            side,
        }
    }
}

/// The integral whose numerators are a and b at the end, when both means are m.
#[inline(always)]
fn integral<L: Lanes>(l: L, m: Z<L::F>, [a, b, p]: [Z<L::F>; 3]) -> Z<L::F> {
    let under = l.z_mul(m, l.z_add(m, p));
    let ratio = l.z_div(l.z_mul_add(a, m, b), under);
    l.z_times(ratio, l.splat(FRAC_PI_2))
}

/// A number, or the least one where it is smaller in magnitude.
#[inline(always)]
pub fn at_least<L: Lanes>(l: L, a: Z<L::F>, least: f64) -> Z<L::F> {
    let enough = l.sub(l.z_norm(a), l.splat(least * least));
    l.z_select(enough, a, l.z_splat(least, 0.0))
}
