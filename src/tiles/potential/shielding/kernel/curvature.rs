//! Bounds of the second and third derivatives.

use super::jet::{Jet, factors};
use super::{COINCIDING, Columns, Magnet, Vectors, Way, dot};
use crate::configuration::Configuration;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};
use crate::units::MU0_OVER_4PI;

/// The sums over all pairs of `|w| |u''| + 2 |w'| |u'| + |w''| |u|` (J/m^2) and of the same of the
/// third derivative (J/m^3; of point dipoles) along motions in which no magnet is faster than 1 and
/// none turns at more than the rate `turn` (1/m), with bounds of the derivatives of energies u and
/// factors w within `reach` (m). Infinite if magnets may coincide.
pub(in crate::potential) struct Curvature<'a> {
    pub fixed: &'a Columns,
    pub moving: &'a [Magnet],
    pub q: &'a Configuration,
    pub turn: f64,
    pub reach: f64,
    /// Bounds of |u|, |u'| and |u''| of blocks, indexed like the pairs' energies; `None` for point
    /// dipoles.
    pub pairs: Option<&'a [Vec<f64>; 3]>,
}

impl Task for Curvature<'_> {
    type Output = [f64; 2];

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> [f64; 2] {
        let rotation = self.q.rotation();
        let mut sums = [l.splat(0.0); 2];
        let turn = l.splat(self.turn);
        for (j, magnet) in self.moving.iter().enumerate() {
            let second = Vectors::splat(l, &magnet.moved(self.q, &rotation));
            for from in (0..self.fixed.len()).step_by(WIDTH) {
                let first = Vectors::load(l, self.fixed, from);
                let way = Way::new(l, &first, &second);
                let r = l.sub(way.distance, l.splat(self.reach));
                if l.least(r) <= COINCIDING {
                    return [f64::INFINITY; 2];
                }
                let inverse = l.reciprocal(r);
                let u = match self.pairs {
                    None => dipole_limits(l, &first, &second, turn, inverse),
                    Some([energy, slope, bend]) => {
                        let at = j * self.fixed.len() + from;
                        [
                            l.load(&energy[at..]),
                            l.load(&slope[at..]),
                            l.load(&bend[at..]),
                            l.splat(0.0),
                        ]
                    }
                };
                let around = Around {
                    reach: l.splat(self.reach),
                    turn,
                    r,
                    inverse,
                };
                let (_, w) = pair_limits(l, &first, &second, &way, &around);
                let [.., second, third] = product(l, w, u);
                sums = [l.add(sums[0], second), l.add(sums[1], third)];
            }
        }
        sums.map(|sum| l.sum(sum))
    }
}

/// The factor of two magnets, and its bounds on a motion near their places.
#[inline(always)]
pub(super) fn pair_limits<L: Lanes>(
    l: L,
    first: &Vectors<L::F>,
    second: &Vectors<L::F>,
    way: &Way<L::F>,
    around: &Around<L::F>,
) -> (Jet<L::F>, DerivativeLimits<L::F>) {
    let ([a, b], [steep_a, steep_b]) = factors(l, first, second, way);
    let (here_a, here_b) = (l.abs(a.0[0]), l.abs(b.0[0]));
    let of_a = factor_limits(l, first.shield, around, steep_a, here_a);
    let of_b = factor_limits(l, second.shield, around, steep_b, here_b);
    (a.times(l, &b), product(l, of_a, of_b))
}

/// Bounds of the magnitudes of a quantity and of its first three derivatives along a motion.
pub(super) type DerivativeLimits<F> = [F; 4];

/// The bounds of a product, by Leibniz' rule.
#[inline(always)]
pub(super) fn product<L: Lanes>(
    l: L,
    f: DerivativeLimits<L::F>,
    g: DerivativeLimits<L::F>,
) -> DerivativeLimits<L::F> {
    let (two, three) = (l.splat(2.0), l.splat(3.0));
    let second = l.mul_add(f[0], g[2], l.mul(f[2], g[0]));
    let third = l.mul_add(f[0], g[3], l.mul(f[3], g[0]));
    let crossed = l.mul_add(f[1], g[2], l.mul(f[2], g[1]));
    [
        l.mul(f[0], g[0]),
        l.mul_add(f[0], g[1], l.mul(f[1], g[0])),
        l.mul_add(l.mul(two, f[1]), g[1], second),
        l.mul_add(three, crossed, third),
    ]
}

/// The bounds of the energy of dipoles at a distance of at least 1 / `inverse` (m), with a speed of
/// the magnets of at most 1 and a rate of turn of at most `turn` (1/m): with `G_n = (n + 2)!
/// r^-(n+3)`, the n-th derivative is the sum of products of G_n with powers of the rate given for
/// the Taylor form of bare dipoles ([`crate::potential::bounds`]). Accelerations are at most
/// `turn`, their changes at most its square.
#[inline(always)]
pub(super) fn dipole_limits<L: Lanes>(
    l: L,
    first: &Vectors<L::F>,
    second: &Vectors<L::F>,
    turn: L::F,
    inverse: L::F,
) -> DerivativeLimits<L::F> {
    let squares = l.mul(
        dot(l, first.moment, first.moment),
        dot(l, second.moment, second.moment),
    );
    let k = l.mul(l.splat(MU0_OVER_4PI), l.sqrt(squares));
    let cube = l.mul(k, l.mul(inverse, l.mul(inverse, inverse)));
    let two = l.splat(2.0);
    let energy = l.mul(two, cube);
    let slope = l.mul_add(l.splat(6.0), inverse, l.mul(two, turn));
    let bend = l.mul_add(l.splat(24.0), inverse, l.mul(l.splat(18.0), turn));
    let bend = l.mul_add(bend, inverse, l.mul(l.mul(two, turn), turn));
    // 120 / r^3 + 144 turn / r^2 + 42 turn^2 / r + 2 turn^3
    let third = l.mul_add(l.splat(120.0), inverse, l.mul(l.splat(144.0), turn));
    let turn2 = l.mul(turn, turn);
    let third = l.mul_add(third, inverse, l.mul(l.splat(42.0), turn2));
    let third = l.mul_add(third, inverse, l.mul(l.mul(two, turn), turn2));
    [
        energy,
        l.mul(cube, slope),
        l.mul(cube, bend),
        l.mul(cube, third),
    ]
}

/// A motion for which bounds hold: the magnets move by at most `reach` (m), stay at least `r` (m)
/// apart (its reciprocal is `inverse`), are no faster than 1, and turn at most at the rate `turn`
/// (1/m).
#[derive(Clone, Copy)]
pub(super) struct Around<F> {
    pub reach: F,
    pub turn: F,
    pub r: F,
    pub inverse: F,
}

/// Bounds of a factor g and of its first three derivatives. `steep` is S' at the magnets' places,
/// and `here` is |g| there.
///
/// With `x = r / l` and `h = (1 + x^2)^(-1/2)`, which decreases with the distance: `|d eta / d r|`
/// is `2 A x / (l (1 + x^2)^2)`, at most the smaller of `0.65 A / l` and `2 A h^3 / l` (the largest
/// of `2 x / (1 + x^2)^2` is 3 sqrt(3) / 8). The Hessian of eta over the plane has the eigenvalues
/// `d2 eta / d r2` and `(d eta / d r) / r`, both at most the smaller of `2 A / l^2` and `6 A h^4 /
/// l^2`. Its third derivative along a direction with the cosine c to the line between the magnets
/// is `c^3 d3 eta / d r3 + 3 c (1 - c^2) d ((d eta / d r) / r) / d r`, with
/// `24 x (x^2 - 1) / (1 + x^2)^4` and `-8 x / (1 + x^2)^3` for the derivatives (times A / l^3) and
/// `3 c (1 - c^2) <= 1.16`: at most the smaller of `7.1 A / l^3` and `33.3 A h^5 / l^3`. The
/// magnets' acceleration, at most `turn`, and its change, at most `turn^2`, add their products with
/// lower derivatives.
///
/// The cosine of the angle from the normal to that line has, with the angle's derivatives
///
/// ```text
/// a1 = 1 / r + turn,    a2 = 1 / r^2 + turn / r,    a3 = 2 / r^3 + 3 turn / r^2 + turn^2 / r
/// ```
///
/// (those of the imaginary part of ln z) the derivatives a1, `a1^2 + a2` and `a1^3 + 3 a1 a2 + a3`
/// at most. `|S''| <= S'` and `|S'''| <= S'`, also `S' <= 1/4`, `|S''| <= 1 / (6 sqrt(3))` and
/// `|S'''| <= 1/8`; and because of the first, S' grows at most by the factor `exp(e) <= 1 + e +
/// e^2` if its argument changes by e <= 1.
#[inline(always)]
pub(super) fn factor_limits<L: Lanes>(
    l: L,
    shield: [L::F; 4],
    around: &Around<L::F>,
    steep: L::F,
    here: L::F,
) -> DerivativeLimits<L::F> {
    let [attenuation, length, width, gain] = shield;
    let &Around { turn, inverse, .. } = around;
    let (zero, one, three) = (l.splat(0.0), l.splat(1.0), l.splat(3.0));
    let eta = eta_limits(l, attenuation, length, around);
    // |G - eta|.
    let excess = l.abs(l.sub(gain, one));
    let gap = l.add(eta[0], excess);

    let inverse2 = l.mul(inverse, inverse);
    let rate = l.add(inverse, turn);
    let rate2 = l.mul(rate, rate);
    let bend = l.mul(inverse, rate);
    let twist = l.mul(
        inverse2,
        l.mul_add(l.splat(2.0), inverse, l.mul(three, turn)),
    );
    let twist = l.mul_add(l.mul(turn, turn), inverse, twist);
    // The cosine over the width.
    let cos1 = l.mul(width, rate);
    let cos2 = l.mul(width, l.add(rate2, bend));
    let cos3 = l.mul(rate, l.mul_add(three, bend, rate2));
    let cos3 = l.mul(width, l.add(cos3, twist));
    let change = l.mul(cos1, around.reach);
    let grown = l.mul(steep, l.mul_add(change, l.add(change, one), one));
    let slope = l.select(l.sub(one, change), grown, one);
    let slope = l.min(slope, l.splat(0.25));
    let (slope2, slope3) = (l.min(slope, l.splat(0.0963)), l.min(slope, l.splat(0.125)));
    let square = l.mul(cos1, cos1);
    let front1 = l.mul(slope, cos1);
    let front2 = l.mul_add(slope2, square, l.mul(slope, cos2));
    let front3 = l.mul_add(slope, cos3, l.mul(l.mul(slope3, square), cos1));
    let front3 = l.mul_add(l.mul(l.mul(three, slope2), cos1), cos2, front3);

    // g = eta + (G - eta) S, with S and 1 - S at most 1.
    let g1 = l.mul_add(gap, front1, eta[1]);
    let g2 = l.mul_add(l.mul(l.splat(2.0), eta[1]), front1, eta[2]);
    let g3 = l.mul_add(eta[1], front2, l.mul(eta[2], front1));
    // The larger of 1, |G| and |1 - A|.
    let most = l.min(l.min(l.splat(-1.0), l.sub(zero, gain)), gain);
    let back = l.sub(one, attenuation);
    let most = l.min(l.min(most, l.sub(zero, back)), back);
    [
        l.min(l.sub(zero, most), l.mul_add(g1, around.reach, here)),
        g1,
        l.mul_add(gap, front2, g2),
        l.mul_add(gap, front3, l.mul_add(three, g3, eta[3])),
    ]
}

/// Bounds of 1 - eta and of its first three derivatives: see [`factor_limits`].
#[inline(always)]
fn eta_limits<L: Lanes>(
    l: L,
    attenuation: L::F,
    length: L::F,
    around: &Around<L::F>,
) -> DerivativeLimits<L::F> {
    let turn = around.turn;
    let x = l.mul(around.r, length);
    let h = l.reciprocal_sqrt(l.mul_add(x, x, l.splat(1.0)));
    let h2 = l.mul(h, h);
    let h3 = l.mul(h2, h);
    let steep = l.min(l.mul(l.splat(2.0), h3), l.splat(0.65));
    let bent = l.min(l.mul(l.splat(6.0), l.mul(h2, h2)), l.splat(2.0));
    let twisted = l.min(l.mul(l.splat(33.3), l.mul(h3, h2)), l.splat(7.1));
    let scale = l.mul(attenuation, length);
    let slope = l.mul(scale, steep);
    let scale = l.mul(scale, length);
    let hessian = l.mul(scale, bent);
    let third = l.mul(l.mul(scale, length), twisted);
    let accelerated = l.mul_add(l.splat(3.0), hessian, l.mul(turn, slope));
    [
        l.mul(attenuation, h2),
        slope,
        l.mul_add(turn, slope, hessian),
        l.mul_add(turn, accelerated, third),
    ]
}
