//! The Coulomb energy of two upright rectangular charge sheets, at any angle to each other.
//!
//! # Geometry
//! Both sheets stand upright on the tiles' plane and are centred on it: sheet i is the segment of
//! width `w_i` in the plane times the heights `-c_i/2 ..= c_i/2`. Coordinates are those of the
//! first sheet: it lies on `-w_1/2 <= x <= w_1/2`, `h = 0`; the second one's centre is at
//! `(x, h)` and it points along `(cos gamma, sin gamma)`. All lengths are in metres, and all
//! charge densities 1, so energies are integrals of `1 / distance` over both sheets (m^3).
//!
//! # The integrals
//! **Heights.** With p the distance in the plane, the function
//! `f(p, z) = z asinh(z / p) - sqrt(p^2 + z^2)` has `f_zz = 1 / sqrt(p^2 + z^2)`, so
//!
//! ```text
//! g(p) = int int dz1 dz2 / sqrt(p^2 + (z1 - z2)^2) = 2 [ f(p, (c1+c2)/2) - f(p, |c1-c2|/2) ].
//! ```
//!
//! **Along the first sheet.** With `r^2 = s^2 + h^2 + z^2`, the function
//!
//! ```text
//! K(s, h, z) = s z asinh(z / sqrt(s^2 + h^2)) + (z^2 - h^2)/2 asinh(s / sqrt(h^2 + z^2))
//!              - z h atan(s z / (h r)) - s r / 2
//! ```
//!
//! has `K_s = f(sqrt(s^2 + h^2), z)` and `K(0) = 0`, so the potential of the first sheet,
//! integrated over the heights of the second, is
//! `Phi(x, h) = 2 [K]` between `s = x - w_1/2` and `x + w_1/2` and between the two heights z; and
//! `K_h = -h asinh(s / sqrt(h^2 + z^2)) - z atan(s z / (h r))`.
//! (The same integrals, for parallel sheets, are in Akoun and Yonnet, *3D analytical calculation
//! of the forces exerted between two cuboidal magnets*, doi:10.1109/TMAG.1984.1063554.)
//!
//! **Along the second sheet** the energy `E = int Phi dt` has no closed form at a general angle
//! and is left to Gauss quadrature. Phi is continuous with its first derivatives everywhere but
//! on the first sheet and its edges, and analytic elsewhere, so the rule is split where those
//! edges project onto the second sheet, and graded towards them.
//!
//! **The gradient** needs the moments 0 and 1 (in t) of `Phi_x` and `Phi_h` along the second sheet.
//! Those of `Phi_x = g(p_-) - g(p_+)`, with `p_-+` the distances from the first sheet's two edges,
//! have closed forms: the zeroth is the second sheet's potential at those edges and the first uses
//! `N(p, z) = z p^2/2 asinh(z / p) + z^2 r / 2 - r^3 / 3`, for which `N_p = p f(p, z)`. Where the
//! angle is large, those of `Phi_h` follow from `d Phi / dt = cos(gamma) Phi_x + sin(gamma) Phi_h`,
//! integrated. If the sheets are nearly parallel they are computed at the quadrature's nodes,
//! except for the part that is discontinuous at the first sheet's edges: `atan(s z / (h r)) -
//! atan(s / h)` is analytic at `p = 0`, and the remaining angle, `theta = arg(s + i h)` between the
//! edges, has moments in closed form along a line ([`angle_moments`]). So the quadrature never has
//! a discontinuous integrand.
//!
//! # Edges
//! The energy is finite and continuous everywhere, contact and overlap included. The gradient is
//! finite too, but jumps where one sheet passes through the other; touching sheets get the limit
//! from the side on which the second block's body lies.

use crate::potential::simd::lanes::Lanes;

/// Added to squared distances (m^2) so that products like `h^2 ln h` are 0, not NaN, at h = 0.
const TINY: f64 = 1e-30;

/// Phi / 2 and |Phi_h| / 2 (m^2, m), without its sign, at the distance `h` from the line of a
/// sheet, where s runs from `s[0]` to `s[1]` (`s[0] < s[1]`): the sign is the opposite of that of
/// h.
#[inline(always)]
pub fn potential<L: Lanes>(l: L, s: [L::F; 2], h: L::F, heights: [f64; 2]) -> (L::F, L::F) {
    let [upper, lower] = both_heights(l, s, h, heights);
    (l.sub(upper.k, lower.k), l.sub(upper.slope, lower.slope))
}

/// The angle (rad), without its sign, that a sheet's segment subtends at the distance `h` from its
/// line, where s runs from `s[0]` to `s[1]` (`s[0] < s[1]`).
#[inline(always)]
pub fn subtended<L: Lanes>(l: L, s: [L::F; 2], h: L::F) -> L::F {
    let above = l.abs(h);
    let along = l.mul_add(h, h, l.mul(s[0], s[1]));
    l.angle(along, l.mul(above, l.sub(s[1], s[0])))
}

/// Phi and its derivatives by x and h, all halved (m^2, m and 1).
#[derive(Clone, Copy)]
pub struct Expansion<F> {
    pub value: F,
    pub x: F,
    pub h: F,
    pub xx: F,
    pub xh: F,
    pub hh: F,
}

/// The halved derivatives of Phi up to the second. At h = 0 they are the limits from h > 0.
///
/// With p and r the distances of an end of the sheet at the heights 0 and z, and the differences
/// between the two heights and the two ends taken,
/// `Phi_x / 2 = [f(p, z)]`, `Phi_xx / 2 = -[s r / p^2]`, `Phi_xh / 2 = -[h r / p^2]`, and as
/// `1 / r` is harmonic, `(Phi_xx + Phi_hh) / 2 = -[asinh(s / sqrt(h^2 + z^2))]`.
#[inline(always)]
pub fn expansion<L: Lanes>(l: L, s: [L::F; 2], h: L::F, heights: [f64; 2]) -> Expansion<L::F> {
    let [upper, lower] = both_heights(l, s, h, heights);
    let zero = l.splat(0.0);
    let slope = l.sub(upper.slope, lower.slope);
    let hh = l.mul_add(h, h, l.splat(TINY));
    let start = l.div(l.sub(upper.r[0], lower.r[0]), l.mul_add(s[0], s[0], hh));
    let end = l.div(l.sub(upper.r[1], lower.r[1]), l.mul_add(s[1], s[1], hh));
    let xx = l.neg_mul_add(s[1], end, l.mul(s[0], start));
    Expansion {
        value: l.sub(upper.k, lower.k),
        x: l.sub(l.sub(upper.f[1], lower.f[1]), l.sub(upper.f[0], lower.f[0])),
        h: l.select(h, l.sub(zero, slope), slope),
        xx,
        xh: l.mul(h, l.sub(start, end)),
        hh: l.sub(l.sub(lower.log, upper.log), xx),
    }
}

/// The terms of the height z, between two ends of a sheet.
#[derive(Clone, Copy)]
struct AtHeight<F> {
    /// K and -K_h, for h >= 0.
    k: F,
    slope: F,
    /// `asinh(s / sqrt(h^2 + z^2))`.
    log: F,
    /// `f = K_s` and r at each end.
    f: [F; 2],
    r: [F; 2],
}

/// The terms at the greater and at the smaller height.
#[inline(always)]
fn both_heights<L: Lanes>(l: L, s: [L::F; 2], h: L::F, heights: [f64; 2]) -> [AtHeight<L::F>; 2] {
    let above = l.abs(h);
    let hh = l.mul_add(h, h, l.splat(TINY));
    let upper = at_height(l, s, above, hh, heights[0]);
    let lower = if heights[1] > 0.0 {
        at_height(l, s, above, hh, heights[1])
    } else {
        in_plane(l, s, above, hh)
    };
    [upper, lower]
}

/// `ln (s2 + r2) / (s1 + r1)`, with `s + r = edge / (r - s)` where s is negative.
#[inline(always)]
pub fn log<L: Lanes>(l: L, s: [L::F; 2], r: [L::F; 2], edge: L::F) -> L::F {
    let one = l.splat(1.0);
    let over = l.mul(
        l.select(s[0], one, l.sub(r[0], s[0])),
        l.select(s[1], l.add(s[1], r[1]), edge),
    );
    let under = l.mul(
        l.select(s[0], l.add(s[0], r[0]), edge),
        l.select(s[1], one, l.sub(r[1], s[1])),
    );
    l.ln_ratio(over, under)
}

/// At the height z > 0, for h >= 0.
#[inline(always)]
fn at_height<L: Lanes>(l: L, s: [L::F; 2], h: L::F, hh: L::F, height: f64) -> AtHeight<L::F> {
    let (z, zz) = (l.splat(height), l.splat(height * height));
    let edge = l.add(hh, zz);
    let p = [
        sqrt(l, l.mul_add(s[0], s[0], hh)),
        sqrt(l, l.mul_add(s[1], s[1], hh)),
    ];
    let r = [
        sqrt(l, l.mul_add(s[0], s[0], edge)),
        sqrt(l, l.mul_add(s[1], s[1], edge)),
    ];
    let log = log(l, s, r, edge);
    let rises = [
        l.ln_ratio(l.add(r[0], z), p[0]),
        l.ln_ratio(l.add(r[1], z), p[1]),
    ];
    let rise = l.neg_mul_add(s[0], rises[0], l.mul(s[1], rises[1]));
    // The difference of two angles, by the product of (h r2, s2 z) and (h r1, -s1 z).
    let (a1, a2) = (l.mul(h, r[0]), l.mul(h, r[1]));
    let (b1, b2) = (l.mul(s[0], z), l.mul(s[1], z));
    let angle = l.angle(
        l.mul_add(a1, a2, l.mul(b1, b2)),
        l.neg_mul_add(b1, a2, l.mul(b2, a1)),
    );
    let turn = l.mul(z, angle);
    let half = l.mul_add(l.sub(zz, hh), log, l.mul(s[0], r[0]));
    let half = l.neg_mul_add(s[1], r[1], half);
    let k = l.mul_add(half, l.splat(0.5), l.mul(z, rise));
    AtHeight {
        k: l.neg_mul_add(h, turn, k),
        slope: l.mul_add(h, log, turn),
        log,
        f: [
            l.sub(l.mul(z, rises[0]), r[0]),
            l.sub(l.mul(z, rises[1]), r[1]),
        ],
        r,
    }
}

/// At the height 0, for h >= 0.
#[inline(always)]
fn in_plane<L: Lanes>(l: L, s: [L::F; 2], h: L::F, hh: L::F) -> AtHeight<L::F> {
    let p = [
        sqrt(l, l.mul_add(s[0], s[0], hh)),
        sqrt(l, l.mul_add(s[1], s[1], hh)),
    ];
    let log = log(l, s, p, hh);
    let twice = l.neg_mul_add(s[1], p[1], l.mul(s[0], p[0]));
    let twice = l.neg_mul_add(hh, log, twice);
    let zero = l.splat(0.0);
    AtHeight {
        k: l.mul(twice, l.splat(0.5)),
        slope: l.mul(h, log),
        log,
        f: [l.sub(zero, p[0]), l.sub(zero, p[1])],
        r: p,
    }
}

/// Square root of a positive number.
#[inline(always)]
pub fn sqrt<L: Lanes>(l: L, a: L::F) -> L::F {
    l.mul(a, l.reciprocal_sqrt(a))
}

/// Half the first moment of g, `N(p)` between the two heights (m^3), at the squared distance `pp`.
#[inline(always)]
pub fn first_moment<L: Lanes>(l: L, pp: L::F, heights: [f64; 2]) -> L::F {
    let pp = l.add(pp, l.splat(TINY));
    let p = sqrt(l, pp);
    let upper = moment_at_height(l, pp, p, heights[0]);
    let lower = if heights[1] > 0.0 {
        moment_at_height(l, pp, p, heights[1])
    } else {
        l.mul(l.mul(p, pp), l.splat(-1.0 / 3.0))
    };
    l.sub(upper, lower)
}

/// `N(p, z)` at the height z.
#[inline(always)]
fn moment_at_height<L: Lanes>(l: L, pp: L::F, p: L::F, height: f64) -> L::F {
    let (z, zz) = (l.splat(height), l.splat(height * height));
    let rr = l.add(pp, zz);
    let r = sqrt(l, rr);
    let rise = l.mul(z, l.ln_ratio(l.add(r, z), p));
    let cubic = l.mul(r, l.neg_mul_add(rr, l.splat(2.0 / 3.0), zz));
    l.mul(l.mul_add(pp, rise, cubic), l.splat(0.5))
}

/// The integrals of 1 and u, along a line, times the angle `theta = arg(s + i h)` of the place u on
/// the line, seen from a sheet's end (m, m^2), without their constants.
///
/// The line's foot is at u = 0: `s + i h = (u + i d) e^(i gamma)` for a line in the direction
/// gamma, so with `p^2 = u^2 + d^2` and `theta_u = -d / p^2`
///
/// ```text
/// int theta du   = u theta + d ln p
/// int u theta du = (p^2 theta + d u) / 2
/// ```
///
/// The angle is that of |h|, between 0 and pi, times `sign`.
#[inline(always)]
pub fn angle_moments<L: Lanes>(
    l: L,
    [u, d]: [L::F; 2],
    [s, h]: [L::F; 2],
    sign: L::F,
) -> [L::F; 2] {
    let above = l.abs(h);
    let theta = l.mul(sign, l.angle(s, above));
    let pp = l.mul_add(u, u, l.mul_add(d, d, l.splat(TINY)));
    let half = l.splat(0.5);
    let ln = l.mul(l.ln_ratio(pp, l.splat(1.0)), half);
    [
        l.mul_add(u, theta, l.mul(d, ln)),
        l.mul(half, l.mul_add(pp, theta, l.mul(d, u))),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::potential::simd::Level;
    use crate::potential::simd::lanes::Task;

    /// Value and derivatives of Phi / 2 at (x, h) for a sheet of half the width 1.
    struct At([f64; 2], [f64; 2]);

    impl Task for At {
        type Output = [f64; 6];

        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> [f64; 6] {
            let Self([x, h], heights) = self;
            let ends = [l.splat(x - 1.0), l.splat(x + 1.0)];
            let phi = expansion(l, ends, l.splat(h), heights);
            [
                l.first(phi.value),
                l.first(phi.x),
                l.first(phi.h),
                l.first(phi.xx),
                l.first(phi.xh),
                l.first(phi.hh),
            ]
        }
    }

    #[test]
    fn the_derivatives_are_those_of_the_potential() {
        for level in Level::available() {
            for i in 0..200 {
                let t = f64::from(i);
                let (x, h) = (1.7 * libm::sin(0.37 * t), 0.9 * libm::cos(1.1 * t));
                let heights = [[0.4, 0.0], [0.5, 0.1]][i as usize % 2];
                let step = 1e-4;
                if h.abs() < 0.05 || (x.abs() - 1.0).abs() < 0.05 {
                    continue;
                }
                let at = |dx: f64, dh: f64| level.run(At([x + dx, h + dh], heights));
                let [_, _, _, xx, xh, hh] = at(0.0, 0.0);
                let along_x: [f64; 6] =
                    std::array::from_fn(|k| (at(step, 0.0)[k] - at(-step, 0.0)[k]) / (2.0 * step));
                let along_h: [f64; 6] =
                    std::array::from_fn(|k| (at(0.0, step)[k] - at(0.0, -step)[k]) / (2.0 * step));
                let [_, gx, gh, ..] = at(0.0, 0.0);
                for (got, expected) in [
                    (gx, along_x[0]),
                    (gh, along_h[0]),
                    (xx, along_x[1]),
                    (xh, along_h[1]),
                    (xh, along_x[2]),
                    (hh, along_h[2]),
                ] {
                    assert!(
                        (got - expected).abs() < 3e-6,
                        "{level} {x} {h}: {got} {expected}"
                    );
                }
            }
        }
    }
}
