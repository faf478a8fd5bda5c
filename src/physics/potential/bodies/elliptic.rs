//! Complete elliptic integrals of complex arguments.

use std::f64::consts::FRAC_PI_2;

use super::complex::{C, sqrt};

/// Three integrals over phi from 0 to pi/2, with `D = sqrt(cos^2 phi + kc^2 sin^2 phi)`.
#[derive(Clone, Copy, Debug)]
pub struct Complete {
    /// The integral of `1 / D`: the first kind, K.
    pub first: C,
    /// The integral of `(sin^2 phi - cos^2 phi) / D`.
    pub tilted: C,
    /// The integral of `1 / ((cos^2 phi + q^2 sin^2 phi) D)`: the third kind.
    pub third: C,
}

/// The smallest complementary modulus, which replaces smaller ones: at 0, K is infinite.
const LEAST: f64 = 1e-150;

impl Complete {
    /// By the complementary modulus `kc` and by `q`, continued from where both are positive to all
    /// `kc` but the negative real axis, and to all `q` but where `q = -kc`.
    ///
    /// Bulirsch's algorithm, Numer. Math. 13 (1969) 305: of means, arithmetic and geometric, which
    /// agree to all digits after five or six steps. Each geometric mean is that root which is closer
    /// to the arithmetic one (Cox, *The arithmetic-geometric mean of Gauss*, Enseign. Math. 30 (1984)
    /// 275), and q enters as itself, not as its square, so that no branch is left.
    pub fn new(kc: C, q: C) -> Self {
        let one = C::new(1.0, 0.0);
        let mut k = if kc.norm_sqr() < LEAST * LEAST {
            C::new(LEAST, 0.0)
        } else {
            kc
        };
        let (mut e, mut m) = (k, one);
        let mut all = [[one, one, one], [-one, one, one], [one, one / q, q]];
        loop {
            for [a, b, p] in &mut all {
                let (inverse, before) = (one / *p, *a);
                *a += *b * inverse;
                let g = e * inverse;
                *b = (before * g + *b) * 2.0;
                *p += g;
            }
            let before = m;
            m += k;
            if (before - k).norm_sqr() <= 1e-16 * before.norm_sqr() {
                break;
            }
            let root = sqrt(e);
            let closer = if (root * m.conj()).re < 0.0 {
                -root
            } else {
                root
            };
            k = closer * 2.0;
            e = k * m;
        }
        let [first, tilted, third] = all.map(|[a, b, p]| (a * m + b) / (m * (m + p)) * FRAC_PI_2);
        Self {
            first,
            tilted,
            third,
        }
    }
}
