//! Bounds of the second derivatives.

use super::{COINCIDING, Columns, Magnet, Vectors, Way, dot};
use crate::configuration::Configuration;
use crate::potential::batch::lanes::{Lanes, Task};
use crate::units::MU0_OVER_4PI;

/// The sum over all pairs of `|w| |u''| + 2 |w'| |u'| + |w''| |u|` (J/m^2) along motions in which
/// no magnet is faster than 1 and none turns at more than the rate `turn` (1/m), with bounds of the
/// derivatives of energies u and factors w within `reach` (m). Infinite where magnets may meet.
pub(in crate::potential::shielding) struct Curvature<'a> {
    pub fixed: &'a Columns,
    pub moving: &'a [Magnet],
    pub q: &'a Configuration,
    pub turn: f64,
    pub reach: f64,
    /// Bounds of |u|, |u'| and |u''| of blocks, numbered as the pairs' energies; point dipoles
    /// without.
    pub pairs: Option<&'a [Vec<f64>; 3]>,
}

impl Task for Curvature<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> f64 {
        let rotation = self.q.rotation();
        let mut sum = l.splat(0.0);
        let turn = l.splat(self.turn);
        for (j, magnet) in self.moving.iter().enumerate() {
            let second = Vectors::splat(l, &magnet.moved(self.q, &rotation));
            for from in (0..self.fixed.len()).step_by(L::WIDTH) {
                let first = Vectors::load(l, self.fixed, from);
                let way = Way::new(l, &first, &second);
                let r = l.sub(way.distance, l.splat(self.reach));
                if l.least(r) <= COINCIDING {
                    return f64::INFINITY;
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
                        ]
                    }
                };
                let [w0, w1, w2] = pair_limits(l, &first, &second, turn, r, inverse);
                let two = l.splat(2.0);
                sum = l.mul_add(w0, u[2], sum);
                sum = l.mul_add(l.mul(two, w1), u[1], sum);
                sum = l.mul_add(w2, u[0], sum);
            }
        }
        l.sum(sum)
    }
}

/// Bounds of the energy of dipoles and its first and second derivatives: see
/// `Limits::derivative`.
#[inline(always)]
pub(super) fn dipole_limits<L: Lanes>(
    l: L,
    first: &Vectors<L::F>,
    second: &Vectors<L::F>,
    turn: L::F,
    inverse: L::F,
) -> [L::F; 3] {
    let squares = l.mul(
        dot(l, first.moment, first.moment),
        dot(l, second.moment, second.moment),
    );
    let k = l.mul(l.splat(MU0_OVER_4PI), l.sqrt(squares));
    let cube = l.mul(k, l.mul(inverse, l.mul(inverse, inverse)));
    let energy = l.mul(l.splat(2.0), cube);
    let slope = l.mul_add(l.splat(6.0), inverse, l.mul(l.splat(2.0), turn));
    let bend = l.mul_add(l.splat(24.0), inverse, l.mul(l.splat(18.0), turn));
    let bend = l.mul_add(bend, inverse, l.mul(l.mul(l.splat(2.0), turn), turn));
    [energy, l.mul(cube, slope), l.mul(cube, bend)]
}

/// Bounds of the magnitudes of the factor of two magnets and of its first and second derivatives:
/// the product rule over those of either (see [`factor_limits`]).
#[inline(always)]
pub(super) fn pair_limits<L: Lanes>(
    l: L,
    first: &Vectors<L::F>,
    second: &Vectors<L::F>,
    turn: L::F,
    r: L::F,
    inverse: L::F,
) -> [L::F; 3] {
    let a = factor_limits(l, first.shield, turn, r, inverse);
    let b = factor_limits(l, second.shield, turn, r, inverse);
    let w2 = l.mul_add(a[2], b[0], l.mul(a[0], b[2]));
    [
        l.mul(a[0], b[0]),
        l.mul_add(a[1], b[0], l.mul(a[0], b[1])),
        l.mul_add(l.mul(l.splat(2.0), a[1]), b[1], w2),
    ]
}

/// Bounds of the magnitudes of g and of its first and second derivatives along a motion with a
/// speed of the magnets of at most 1, at a rate of turn of at most `turn` (1/m), while they are at
/// least `r` (m) apart.
///
/// With `x = r / l`: `|d eta / d r|` is at most the smaller of `0.65 A / l` and `2 A / (l x^3)` (the
/// largest of `2 x / (1 + x^2)^2` is 3 sqrt(3) / 8). The Hessian of eta over the plane has the
/// eigenvalues `d2 eta / d r2` and `(d eta / d r) / r`, both at most the smaller of `2 A / l^2` and
/// `6 A / (l^2 x^4)`; the magnets' acceleration, at most `turn`, adds that times the slope.
/// `|S'| <= 1/4`, `|S''| <= 1 / (6 sqrt(3))`, and with `w = 1 / r + turn` the cosine of an angle that
/// turns at most at the rate w has a second derivative of at most
/// `w^2 + 2 / r^2 + turn / r + turn^2`.
#[inline(always)]
pub(super) fn factor_limits<L: Lanes>(
    l: L,
    shield: [L::F; 4],
    turn: L::F,
    r: L::F,
    inverse: L::F,
) -> [L::F; 3] {
    let [attenuation, length, width, gain] = shield;
    let (zero, one) = (l.splat(0.0), l.splat(1.0));
    let x = l.mul(r, length);
    let x2 = l.mul(x, x);
    let share = l.div(one, l.add(one, x2));
    let excess = l.sub(gain, one);
    let excess = l.select(excess, excess, l.sub(zero, excess));
    let gap = l.mul_add(attenuation, share, excess);
    let over = l.reciprocal(x);
    let cube = l.mul(over, l.mul(over, over));
    let steep = l.min(l.mul(l.splat(2.0), cube), l.splat(0.65));
    let bent = l.min(l.mul(l.mul(l.splat(6.0), cube), over), l.splat(2.0));
    let scale = l.mul(attenuation, length);
    let slope = l.mul(scale, steep);
    let hessian = l.mul_add(l.mul(scale, length), bent, l.mul(turn, slope));
    let rate = l.add(inverse, turn);
    let rate2 = l.mul(rate, rate);
    let bend = l.mul_add(l.splat(2.0), l.mul(inverse, inverse), rate2);
    let bend = l.mul_add(turn, rate, bend);
    let quarter = l.mul(width, l.splat(0.25));
    let front1 = l.mul(rate, quarter);
    let front2 = l.mul(l.mul(rate2, l.splat(1.0 / 10.3)), l.mul(width, width));
    let front2 = l.mul_add(bend, quarter, front2);
    // The larger of 1, |G| and |1 - A|.
    let most = l.min(l.min(l.splat(-1.0), l.sub(zero, gain)), gain);
    let back = l.sub(one, attenuation);
    let most = l.min(l.min(most, l.sub(zero, back)), back);
    [
        l.sub(zero, most),
        l.mul_add(gap, front1, slope),
        l.mul_add(
            gap,
            front2,
            l.mul_add(l.mul(l.splat(2.0), slope), front1, hessian),
        ),
    ]
}
