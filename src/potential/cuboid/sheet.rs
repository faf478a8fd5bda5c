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

use super::quadrature::{MAX_NODES, ellipse, rule};

/// Added to squared distances so that products like `h^2 ln h` are 0, not NaN, at h = 0.
const TINY: f64 = 1e-290;

/// Below this share of the width a distance from the sheet counts as touching.
const TOUCHING: f64 = 1e-10;

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

/// Phi / 2 and Phi_h / 2 at (x, h) of a sheet of width `w`.
#[inline]
fn potential(w: f64, heights: [f64; 2], x: f64, h: f64) -> (f64, f64) {
    let (u1, v1) = at_height(x - w / 2.0, x + w / 2.0, h, heights[0]);
    let (u0, v0) = at_height(x - w / 2.0, x + w / 2.0, h, heights[1]);
    (u1 - u0, v1 - v0)
}

/// K and K_h between s1 and s2 (s1 < s2).
#[inline]
fn at_height(s1: f64, s2: f64, h: f64, z: f64) -> (f64, f64) {
    let zz = z * z;
    let hh = h * h + TINY;
    let (p1, p2) = (s1 * s1 + hh, s2 * s2 + hh);
    let (r1, r2) = ((p1 + zz).sqrt(), (p2 + zz).sqrt());
    // ln (s2 + r2) / (s1 + r1), with s + r = (h^2 + z^2) / (r - s) where s is negative.
    let (a1, b1) = if s1 > 0.0 {
        (1.0, s1 + r1)
    } else {
        (r1 - s1, hh + zz)
    };
    let (a2, b2) = if s2 > 0.0 {
        (s2 + r2, 1.0)
    } else {
        (hh + zz, r2 - s2)
    };
    let log = ((a1 / b1) * (a2 / b2)).ln();
    let mut k = -0.5 * hh * log - 0.5 * (s2 * r2 - s1 * r1);
    let mut k_h = -h * log;
    if z > 0.0 {
        let angle = (s2 * z).atan2(h.abs() * r2) - (s1 * z).atan2(h.abs() * r1);
        let rise = s2 * (z / p2.sqrt()).asinh() - s1 * (z / p1.sqrt()).asinh();
        k += z * rise + 0.5 * zz * log - z * h.abs() * angle;
        k_h -= z * angle.copysign(angle * h);
    }
    (k, k_h)
}

/// f (m) at the distance p and its first moment N (m^3), at height z.
#[inline]
fn distance_kernels(p: f64, z: f64) -> f64 {
    let pp = p * p + TINY;
    let r = (pp + z * z).sqrt();
    let rise = if z > 0.0 {
        (z / pp.sqrt()).asinh()
    } else {
        0.0
    };
    0.5 * z * pp * rise + 0.5 * z * z * r - r * r * r / 3.0
}

impl SheetPair {
    /// The energy alone (m^3).
    pub fn energy(&self) -> f64 {
        let mut sum = 0.0;
        self.for_each_node(|_, weight, x, h| {
            sum += weight * potential(self.widths[0], self.heights, x, h).0;
        });
        2.0 * sum
    }

    /// The energy and its derivatives.
    pub fn energy_and_gradient(&self) -> SheetEnergy {
        let (mut energy, mut h0, mut h1) = (0.0, 0.0, 0.0);
        self.for_each_node(|t, weight, x, h| {
            let (phi, slope) = potential(self.widths[0], self.heights, x, h);
            energy += 2.0 * weight * phi;
            h0 += 2.0 * weight * slope;
            h1 += 2.0 * weight * slope * t;
        });
        let (x0, x1) = self.moments_along_x();
        if self.sin.abs() > std::f64::consts::FRAC_1_SQRT_2 {
            let half = self.widths[1] / 2.0;
            let end = |t: f64| {
                2.0 * potential(
                    self.widths[0],
                    self.heights,
                    self.x + t * self.cos,
                    self.h + t * self.sin,
                )
                .0
            };
            let (start, stop) = (end(-half), end(half));
            h0 = ((stop - start) - self.cos * x0) / self.sin;
            h1 = (half * (stop + start) - energy - self.cos * x1) / self.sin;
        }
        SheetEnergy {
            energy,
            by_x: x0,
            by_h: h0,
            by_angle: self.cos * h1 - self.sin * x1,
        }
    }

    /// The moments 0 and 1 in t of Phi_x along the second sheet.
    fn moments_along_x(&self) -> (f64, f64) {
        let (mut zeroth, mut first) = (0.0, 0.0);
        for sign in [-1.0, 1.0] {
            let (foot, height) = self.corner(sign);
            let phi = 2.0 * potential(self.widths[1], self.heights, -foot, height).0;
            let (start, end) = self.distances_to_ends(foot, height);
            let n = |p: f64| {
                2.0 * (distance_kernels(p, self.heights[0]) - distance_kernels(p, self.heights[1]))
            };
            zeroth -= sign * phi;
            first -= sign * (foot * phi + n(end) - n(start));
        }
        (zeroth, first)
    }

    /// Where the first sheet's edge at `sign w_1 / 2` projects onto the second sheet's line, and
    /// its distance from that line.
    fn corner(&self, sign: f64) -> (f64, f64) {
        let (dx, dh) = (sign * self.widths[0] / 2.0 - self.x, -self.h);
        (
            dx * self.cos + dh * self.sin,
            (dh * self.cos - dx * self.sin).abs(),
        )
    }

    fn distances_to_ends(&self, foot: f64, height: f64) -> (f64, f64) {
        let half = self.widths[1] / 2.0;
        ((foot + half).hypot(height), (foot - half).hypot(height))
    }

    /// Calls `visit(t, weight, x, h)` at every node of the quadrature along the second sheet.
    fn for_each_node(&self, mut visit: impl FnMut(f64, f64, f64, f64)) {
        let corners = [self.corner(-1.0), self.corner(1.0)];
        let touching = TOUCHING * self.widths[0];
        for_each_panel(self.widths[1] / 2.0, corners, |start, end, nodes| {
            let (middle, half) = ((start + end) / 2.0, (end - start) / 2.0);
            for &(node, weight) in rule(nodes) {
                let t = middle + half * node;
                let mut h = self.h + t * self.sin;
                if h.abs() < touching {
                    h = touching * self.side;
                }
                visit(t, half * weight, self.x + t * self.cos, h);
            }
        });
    }
}

/// Splits [-half, half] at the feet of the two corners and calls `visit(start, end, nodes)` for
/// panels graded towards them.
fn for_each_panel(half: f64, corners: [(f64, f64); 2], mut visit: impl FnMut(f64, f64, usize)) {
    let mut cuts = [
        corners[0].0.clamp(-half, half),
        corners[1].0.clamp(-half, half),
    ];
    if cuts[0] > cuts[1] {
        cuts.swap(0, 1);
    }
    let smallest = 1e-9 * half;
    for (start, end) in [(-half, cuts[0]), (cuts[0], cuts[1]), (cuts[1], half)] {
        if end - start > smallest {
            graded(start, end, &corners, half, &mut visit);
        }
    }
}

/// The share of a panel that grading cuts off at the end next to a corner.
const GRADING: f64 = 0.2;
/// Panels shorter than this share of the sheet's half width are not cut further.
const FINEST: f64 = 0.02;
/// The natural logarithm of the accuracy asked of a rule on a panel, halved.
const EFFORT: f64 = 9.0;

fn graded(
    start: f64,
    end: f64,
    corners: &[(f64, f64); 2],
    half: f64,
    visit: &mut impl FnMut(f64, f64, usize),
) {
    let length = end - start;
    let (mut rho, mut near_start) = (f64::INFINITY, false);
    for &(foot, height) in corners {
        let (to_start, to_end) = ((foot - start).hypot(height), (foot - end).hypot(height));
        let size = ellipse(to_start, to_end, length);
        if size < rho {
            (rho, near_start) = (size, to_start < to_end);
        }
    }
    let nodes = (EFFORT / rho.ln()).ceil() + 1.0;
    if nodes <= MAX_NODES as f64 {
        visit(start, end, nodes as usize);
    } else if length < FINEST * half {
        visit(start, end, MAX_NODES / 2);
    } else if near_start {
        let cut = start + GRADING * length;
        graded(start, cut, corners, half, visit);
        graded(cut, end, corners, half, visit);
    } else {
        let cut = end - GRADING * length;
        graded(start, cut, corners, half, visit);
        graded(cut, end, corners, half, visit);
    }
}
