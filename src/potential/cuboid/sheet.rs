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
//! **The gradient** needs the moments 0 and 1 (in t) of `Phi_x` and `Phi_h` along the second
//! sheet. Those of `Phi_x = g(p_-) - g(p_+)`, with `p_-+` the distances from the first sheet's two
//! edges, are closed: the zeroth is the second sheet's potential at those edges and the first
//! uses `N(p, z) = z p^2/2 asinh(z / p) + z^2 r / 2 - r^3 / 3`, for which `N_p = p f(p, z)`. Those
//! of `Phi_h` take the quadrature's nodes where the sheets are nearly parallel; where the angle
//! is large they follow from `d Phi / dt = cos(gamma) Phi_x + sin(gamma) Phi_h`, integrated.
//! So no integrand with a singularity is ever left to quadrature.
//!
//! # Edges
//! The energy is finite and continuous everywhere, contact and overlap included. The gradient is
//! finite too, but jumps where one sheet passes through the other; `side` says on which side of
//! the first sheet the second one's body lies, and touching sheets get that side's limit.

use super::elementary::{angle, ln_ratio};
use super::quadrature::{Corner, Fineness, Panels, Rules};
use crate::potential::batch::lanes::{Lanes, MAX_WIDTH};

/// Added to squared distances so that products like `h^2 ln h` are 0, not NaN, at h = 0.
const TINY: f64 = 1e-290;

/// Below this share of the width a distance from the sheet counts as touching.
const TOUCHING: f64 = 1e-10;

/// The panels for the energy.
pub const ENERGY: Fineness = Fineness {
    finest: 0.125,
    eight: EIGHT,
    sixteen: SIXTEEN,
};

/// The panels for the gradient, whose integrand has a step near the first sheet's edges.
pub const GRADIENT: Fineness = Fineness {
    finest: 0.02,
    eight: EIGHT,
    sixteen: SIXTEEN,
};

// cosh(6 / (n - 1.5)) for n = 8 and 16 nodes: rho^(-2n) is then exp(-12) / rho^3, which the
// weakness of the singularities (of the kind s^2 ln s) brings to some 1e-8.
const EIGHT: f64 = 1.457_0;
const SIXTEEN: f64 = 1.086_9;

/// The second sheet as seen from the first, and both sizes.
#[derive(Clone, Copy, Debug)]
pub struct SheetPair {
    /// Widths in the plane (m).
    pub widths: [f64; 2],
    /// Half the sum and half the difference of the heights (m).
    pub heights: [f64; 2],
    /// Centre of the second sheet in the first one's coordinates (m).
    pub x: f64,
    pub h: f64,
    /// Direction of the second sheet.
    pub cos: f64,
    pub sin: f64,
    /// The sign of h where the second sheet's body lies.
    pub side: f64,
}

/// E (m^3) and its derivatives by x and h (m^2) and by the angle gamma about the second sheet's
/// centre (m^3).
#[derive(Clone, Copy, Debug, Default)]
pub struct SheetEnergy {
    pub energy: f64,
    pub by_x: f64,
    pub by_h: f64,
    pub by_angle: f64,
}

/// Phi / 2 and Phi_h / 2 where s runs from `s[0]` to `s[1]` (`s[0] < s[1]`).
#[inline(always)]
fn potential<L: Lanes>(l: L, s: [L::F; 2], h: L::F, heights: [f64; 2]) -> (L::F, L::F) {
    let zero = l.splat(0.0);
    let above = l.select(h, h, l.sub(zero, h));
    let hh = l.mul_add(h, h, l.splat(TINY));
    let (k1, slope1) = at_height(l, s, above, hh, heights[0]);
    let (k0, slope0) = if heights[1] > 0.0 {
        at_height(l, s, above, hh, heights[1])
    } else {
        in_plane(l, s, above, hh)
    };
    let slope = l.sub(slope1, slope0);
    (l.sub(k1, k0), l.select(h, slope, l.sub(zero, slope)))
}

/// `ln (s2 + r2) / (s1 + r1)`, with `s + r = edge / (r - s)` where s is negative.
#[inline(always)]
fn log<L: Lanes>(l: L, s: [L::F; 2], r: [L::F; 2], edge: L::F) -> L::F {
    let one = l.splat(1.0);
    let over = l.mul(
        l.select(s[0], one, l.sub(r[0], s[0])),
        l.select(s[1], l.add(s[1], r[1]), edge),
    );
    let under = l.mul(
        l.select(s[0], l.add(s[0], r[0]), edge),
        l.select(s[1], one, l.sub(r[1], s[1])),
    );
    ln_ratio(l, over, under)
}

/// K and K_h between the two s at the height z > 0, for h >= 0.
#[inline(always)]
fn at_height<L: Lanes>(l: L, s: [L::F; 2], h: L::F, hh: L::F, height: f64) -> (L::F, L::F) {
    let (z, zz) = (l.splat(height), l.splat(height * height));
    let edge = l.add(hh, zz);
    let p = [
        l.sqrt(l.mul_add(s[0], s[0], hh)),
        l.sqrt(l.mul_add(s[1], s[1], hh)),
    ];
    let r = [
        l.sqrt(l.mul_add(s[0], s[0], edge)),
        l.sqrt(l.mul_add(s[1], s[1], edge)),
    ];
    let log = log(l, s, r, edge);
    let rise = l.mul(s[1], ln_ratio(l, l.add(r[1], z), p[1]));
    let rise = l.neg_mul_add(s[0], ln_ratio(l, l.add(r[0], z), p[0]), rise);
    // The difference of two angles, by the product of (h r2, s2 z) and (h r1, -s1 z).
    let (a1, a2) = (l.mul(h, r[0]), l.mul(h, r[1]));
    let (b1, b2) = (l.mul(s[0], z), l.mul(s[1], z));
    let angle = angle(
        l,
        l.mul_add(a1, a2, l.mul(b1, b2)),
        l.neg_mul_add(b1, a2, l.mul(b2, a1)),
    );
    let slope = l.sub(l.splat(0.0), l.mul_add(h, log, l.mul(z, angle)));
    let half = l.mul_add(l.sub(zz, hh), log, l.mul(s[0], r[0]));
    let half = l.neg_mul_add(s[1], r[1], half);
    let k = l.mul_add(half, l.splat(0.5), l.mul(z, rise));
    (l.neg_mul_add(l.mul(z, h), angle, k), slope)
}

/// K and K_h between the two s at the height 0, for h >= 0.
#[inline(always)]
fn in_plane<L: Lanes>(l: L, s: [L::F; 2], h: L::F, hh: L::F) -> (L::F, L::F) {
    let p = [
        l.sqrt(l.mul_add(s[0], s[0], hh)),
        l.sqrt(l.mul_add(s[1], s[1], hh)),
    ];
    let log = log(l, s, p, hh);
    let twice = l.neg_mul_add(s[1], p[1], l.mul(s[0], p[0]));
    let twice = l.neg_mul_add(hh, log, twice);
    (
        l.mul(twice, l.splat(0.5)),
        l.sub(l.splat(0.0), l.mul(h, log)),
    )
}

/// N / 2 (m^3) at the squared distance `pp`, between the two heights.
#[inline(always)]
fn first_moment<L: Lanes>(l: L, pp: L::F, heights: [f64; 2]) -> L::F {
    let pp = l.add(pp, l.splat(TINY));
    let mut sum = l.splat(0.0);
    for (sign, height) in [(0.5, heights[0]), (-0.5, heights[1])] {
        let (z, zz) = (l.splat(height), l.splat(height * height));
        let rr = l.add(pp, zz);
        let r = l.sqrt(rr);
        let rise = l.mul(z, ln_ratio(l, l.add(r, z), l.sqrt(pp)));
        let cubic = l.mul(r, l.neg_mul_add(rr, l.splat(2.0 / 3.0), zz));
        sum = l.mul_add(l.mul_add(pp, rise, cubic), l.splat(sign), sum);
    }
    sum
}

/// The quadrature's sums over the second sheet: of Phi, Phi_h and t Phi_h, all halved.
#[derive(Clone, Copy)]
struct Sums<F> {
    phi: F,
    slope: F,
    turn: F,
}

impl SheetPair {
    /// The energy alone (m^3).
    #[inline(always)]
    pub fn energy<L: Lanes>(&self, l: L, fineness: Fineness) -> f64 {
        2.0 * l.sum(self.sums::<L, false>(l, fineness).phi)
    }

    /// The energy, by panels as fine as `energy`, and its derivatives, by those of `gradient`.
    #[inline(always)]
    pub fn energy_and_gradient<L: Lanes>(
        &self,
        l: L,
        energy: Fineness,
        gradient: Fineness,
    ) -> SheetEnergy {
        let energy = self.energy(l, energy);
        let ends = self.closed_forms(l);
        let [x0, x1] = ends.moments;
        let (h0, h1);
        if self.sin.abs() > std::f64::consts::FRAC_1_SQRT_2 {
            let (start, stop) = (ends.phi[0], ends.phi[1]);
            let half = self.widths[1] / 2.0;
            h0 = ((stop - start) - self.cos * x0) / self.sin;
            h1 = (half * (stop + start) - energy - self.cos * x1) / self.sin;
        } else {
            let sums = self.sums::<L, true>(l, gradient);
            h0 = 2.0 * l.sum(sums.slope);
            h1 = 2.0 * l.sum(sums.turn);
        }
        SheetEnergy {
            energy,
            by_x: x0,
            by_h: h0,
            by_angle: self.cos * h1 - self.sin * x1,
        }
    }

    /// Where the first sheet's edge at `sign w_1 / 2` projects onto the second sheet's line, and
    /// its distance from that line.
    #[inline(always)]
    fn corner(&self, sign: f64) -> Corner {
        let (dx, dh) = (sign * self.widths[0] / 2.0 - self.x, -self.h);
        (
            dx * self.cos + dh * self.sin,
            (dh * self.cos - dx * self.sin).abs(),
        )
    }

    #[inline(always)]
    fn sums<L: Lanes, const SLOPE: bool>(&self, l: L, fineness: Fineness) -> Sums<L::F> {
        let corners = [self.corner(-1.0), self.corner(1.0)];
        let rules = Rules::get();
        let mut sums = Sums {
            phi: l.splat(0.0),
            slope: l.splat(0.0),
            turn: l.splat(0.0),
        };
        for (start, end, eight) in Panels::new(self.widths[1] / 2.0, corners, fineness) {
            let (nodes, weights): (&[f64], &[f64]) = if eight {
                (&rules.eight[0], &rules.eight[1])
            } else {
                (&rules.sixteen[0], &rules.sixteen[1])
            };
            let (middle, half) = (l.splat((start + end) / 2.0), l.splat((end - start) / 2.0));
            let mut from = 0;
            while from < nodes.len() {
                let t = l.mul_add(half, l.load(&nodes[from..]), middle);
                let weight = l.mul(half, l.load(&weights[from..]));
                self.add_node::<L, SLOPE>(l, t, weight, &mut sums);
                from += L::WIDTH;
            }
        }
        sums
    }

    #[inline(always)]
    fn add_node<L: Lanes, const SLOPE: bool>(
        &self,
        l: L,
        t: L::F,
        weight: L::F,
        sums: &mut Sums<L::F>,
    ) {
        let x = l.mul_add(t, l.splat(self.cos), l.splat(self.x));
        let h = l.mul_add(t, l.splat(self.sin), l.splat(self.h));
        let touching = TOUCHING * self.widths[0];
        let above = l.select(h, h, l.sub(l.splat(0.0), h));
        let clear = l.sub(above, l.splat(touching));
        let h = l.select(clear, h, l.splat(touching * self.side));
        let half = l.splat(self.widths[0] / 2.0);
        let (phi, slope) = potential(l, [l.sub(x, half), l.add(x, half)], h, self.heights);
        sums.phi = l.mul_add(weight, phi, sums.phi);
        if SLOPE {
            let weighted = l.mul(weight, slope);
            sums.slope = l.add(sums.slope, weighted);
            sums.turn = l.mul_add(weighted, t, sums.turn);
        }
    }

    /// What the gradient needs beside the quadrature, from the ends of the two sheets.
    #[inline(always)]
    fn closed_forms<L: Lanes>(&self, l: L) -> ClosedForms {
        let halves = [self.widths[0] / 2.0, self.widths[1] / 2.0];
        // Four potentials: of the second sheet at the first one's edges, and the other way round.
        let mut s = [[0.0; MAX_WIDTH]; 2];
        let mut h = [1.0; MAX_WIDTH];
        let mut squares = [1.0; MAX_WIDTH];
        let mut feet = [0.0; 2];
        for (i, sign) in [-1.0, 1.0].into_iter().enumerate() {
            let (foot, height) = self.corner(sign);
            feet[i] = foot;
            s[0][i] = foot - halves[1];
            s[1][i] = foot + halves[1];
            h[i] = height;
            let t = sign * halves[1];
            let x = self.x + t * self.cos;
            s[0][2 + i] = x - halves[0];
            s[1][2 + i] = x + halves[0];
            h[2 + i] = self.h + t * self.sin;
            // Squared distances of this edge from the second sheet's start and end.
            squares[2 * i] = (foot + halves[1]).powi(2) + height * height;
            squares[2 * i + 1] = (foot - halves[1]).powi(2) + height * height;
        }
        for i in 4..MAX_WIDTH {
            s[0][i] = -1.0;
            s[1][i] = 1.0;
        }
        let (phi, _) = potential(l, [l.load(&s[0]), l.load(&s[1])], l.load(&h), self.heights);
        let n = first_moment(l, l.load(&squares), self.heights);
        let (mut phis, mut ns) = ([0.0; MAX_WIDTH], [0.0; MAX_WIDTH]);
        l.store(phi, &mut phis);
        l.store(n, &mut ns);
        ClosedForms {
            moments: [
                2.0 * (phis[0] - phis[1]),
                2.0 * (feet[0] * phis[0] + ns[1] - ns[0] - feet[1] * phis[1] - ns[3] + ns[2]),
            ],
            phi: [2.0 * phis[2], 2.0 * phis[3]],
        }
    }
}

/// The moments 0 and 1 in t of Phi_x along the second sheet, and Phi at its two ends.
struct ClosedForms {
    moments: [f64; 2],
    phi: [f64; 2],
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::potential::batch::Level;
    use crate::potential::batch::lanes::Task;
    use rand::{RngExt, SeedableRng};

    const FINE: Fineness = Fineness {
        finest: 1e-9,
        eight: 11.0,
        sixteen: 1.9,
    };

    struct Job(SheetPair, Fineness, Fineness);
    impl Task for Job {
        type Output = SheetEnergy;
        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> SheetEnergy {
            self.0.energy_and_gradient(l, self.1, self.2)
        }
    }

    #[test]
    fn explore() {
        let level = Level::best();
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let grid = std::env::var("GRID").unwrap_or_default();
        let v: Vec<f64> = grid.split(',').filter_map(|x| x.parse().ok()).collect();
        let (mut f, mut g) = (ENERGY, GRADIENT);
        if v.len() == 2 { f.finest = v[0]; g.finest = v[1]; }
        println!("{f:?} {g:?}");
        for gap in [0.0, 1e-5, 1e-4, 3e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2] {
            for tilt in [0.0, 1e-3, 0.03, 0.3, 1.2] {
                let mut worst = [0.0f64; 4];
                let mut nodes = [0; 2];
                for trial in 0..60 {
                    let angle: f64 = if trial % 2 == 0 { tilt } else { -tilt };
                    let angle = if trial % 3 == 0 { angle + std::f64::consts::PI } else { angle };
                    let (w1, w2) = (0.01, if trial % 5 == 0 { 0.01 } else { 0.007 });
                    let x = match trial % 7 { 0 => 0.0, 1 => 0.002, _ => rng.random_range(-0.012..0.012) };
                    let h = gap + 0.5 * w2 * angle.sin().abs();
                    let pair = SheetPair { widths: [w1, w2], heights: [0.003, 0.0], x, h, cos: angle.cos(), sin: angle.sin(), side: 1.0 };
                    let exact = level.run(Job(pair, FINE, FINE));
                    let got = level.run(Job(pair, f, g));
                    let force = exact.by_x.hypot(exact.by_h);
                    let off = [
                        (got.energy - exact.energy).abs() / exact.energy,
                        (got.by_x - exact.by_x).abs() / force,
                        (got.by_h - exact.by_h).abs() / force,
                        (got.by_angle - exact.by_angle).abs() / force / w1,
                    ];
                    for i in 0..4 { worst[i] = worst[i].max(off[i]); }
                    for (k, fine) in [f, g].into_iter().enumerate() {
                        let corners = [pair.corner(-1.0), pair.corner(1.0)];
                        nodes[k] += Panels::new(w2 / 2.0, corners, fine).map(|p| if p.2 { 8 } else { 16 }).sum::<usize>();
                    }
                }
                println!("gap {gap:7.0e} tilt {tilt:6.0e}: E {:.1e} Fx {:.1e} Fh {:.1e} T {:.1e}  nodes {} {}", worst[0], worst[1], worst[2], worst[3], nodes[0] / 60, nodes[1] / 60);
            }
        }
    }
}
