//! The energy of two close discs that lie, with its derivatives up to the third.
//!
//! As in [`line`](super::line) the second disc's faces are lines of charge along its axis at imaginary heights: of
//! a face on the side s = +-1, at `P = w2 + lambda u2`, where w2 is its centre, u2 its direction and `lambda = s L / 2 + i
//! t`. Moved by d and turned by beta it is at `P + d + lambda (u' beta - u2 beta^2 / 2 - u' beta^3 / 6)`, with u' the
//! direction turned by a right angle. So all derivatives are contractions of those of the first one's
//! potential by the place, integrated over t with powers of lambda.

use nalgebra::{Complex, Vector2};

use super::Body;
use super::complex::{Complexes, Z};
use super::disc::{self, Derived};
use super::face::ChargedFace;
use super::line::{USUAL, angles, columns};
use super::near::{pole_places, strength, upright};
use crate::potential::far::derivatives::Derivatives;
use crate::potential::far::{PairEnergy, complex};
use crate::potential::simd::Level;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};

/// Approximate relative error of the integrals.
const LOST: f64 = 1e-11;

/// The energy and its derivatives by the second one's place and turn.
pub fn derived(first: &Body, second: &Body) -> (PairEnergy, Derivatives) {
    let axis = complex(first.direction);
    let turn = complex(second.direction) * axis.conj();
    let [one, other] = [first, second].map(upright);
    let [from, radius] = [first, second].map(|body| body.size[1] / 2.0);
    let mut nodes = Vec::with_capacity(USUAL);
    for placed in pole_places(first, second) {
        let [own, moved] = placed.centres;
        let at = |face: &ChargedFace, centre| ChargedFace { centre, ..*face };
        let way = complex((moved - own).xy()) * axis.conj();
        let level = placed.offset.dot(&second.direction);
        angles(
            LOST,
            &at(&other, moved),
            radius,
            &at(&one, own),
            |phi, weight| {
                nodes.push([phi, weight * placed.share, way.re, way.im, level]);
            },
        );
    }
    let line = Line {
        radii: [from, radius],
        turn,
        nodes: &nodes,
    };
    Level::best()
        .run(line)
        .derivatives(strength(first, second), axis, turn)
}

/// The lines of charge, in the frame of the first disc: x along its axis.
struct Line<'a> {
    radii: [f64; 2],
    /// The direction of the second one.
    turn: Complex<f64>,
    /// Angles phi, of `t = R cos phi`, their weights, the way (m) from the middle of the first one's face, x and y, and
    /// s L / 2 (m).
    nodes: &'a [[f64; 5]],
}

/// The integrals over all lines, of the derivatives by x and y (those by x alone first), times powers of lambda.
struct Moments {
    value: f64,
    first: [[f64; 2]; 2],
    second: [[f64; 3]; 3],
    third: [[f64; 4]; 4],
}

impl Task for Line<'_> {
    type Output = Moments;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Moments {
        let zero = l.splat(0.0);
        let mut value = zero;
        let (mut first, mut second, mut third) = ([[zero; 2]; 2], [[zero; 3]; 3], [[zero; 4]; 4]);
        for nodes in self.nodes.chunks(WIDTH) {
            let [phi, weight, x, y, level] = columns(nodes);
            let (sin, cos) = l.sin_cos(l.load(&phi));
            let t = l.mul(cos, l.splat(self.radii[1]));
            let half = l.mul(sin, l.splat(self.radii[1]));
            let weight = l.mul(l.mul(half, half), l.mul(l.load(&weight), l.splat(2.0)));
            let h = Z {
                re: l.load(&x),
                im: l.mul(t, l.splat(self.turn.re)),
            };
            let s = Z {
                re: l.load(&y),
                im: l.mul(t, l.splat(self.turn.im)),
            };
            let of: Derived<L::F> = disc::derived(l, self.radii[0], s, h);
            let lambda = Z {
                re: l.load(&level),
                im: t,
            };
            value = l.mul_add(weight, of.value.re, value);
            let mut power = Z {
                re: weight,
                im: zero,
            };
            for k in 0..4 {
                if k < 2 {
                    add(l, &mut first[k], power, &of.first);
                }
                if k < 3 {
                    add(l, &mut second[k], power, &of.second);
                }
                add(l, &mut third[k], power, &of.third);
                power = l.z_mul(power, lambda);
            }
        }
        Moments {
            value: l.sum(value),
            first: sums(l, first),
            second: sums(l, second),
            third: sums(l, third),
        }
    }
}

/// Adds the real parts of products with a complex number.
#[inline(always)]
fn add<L: Lanes, const N: usize>(l: L, sums: &mut [L::F; N], by: Z<L::F>, all: &[Z<L::F>; N]) {
    for i in 0..N {
        sums[i] = l.neg_mul_add(by.im, all[i].im, l.mul_add(by.re, all[i].re, sums[i]));
    }
}

/// The sums over the lanes.
#[inline(always)]
fn sums<L: Lanes, const N: usize>(l: L, all: [[L::F; N]; N]) -> [[f64; N]; N] {
    let mut sums = [[0.0; N]; N];
    for k in 0..N {
        for i in 0..N {
            sums[k][i] = l.sum(all[k][i]);
        }
    }
    sums
}

impl Moments {
    /// The energy and its derivatives, with the factor of the integrals (J/m^3) and the first magnet's axis; `turn` is
    /// the second one's direction in its frame.
    fn derivatives(
        &self,
        strength: f64,
        axis: Complex<f64>,
        turn: Complex<f64>,
    ) -> (PairEnergy, Derivatives) {
        let new = |re: f64, im: f64| Complex::new(re, im) * strength;
        // By w = x + i y and its conjugate c.
        let w = self.first.map(|[x, y]| new(x, -y) / 2.0);
        let ww = self
            .second
            .map(|[xx, xy, yy]| new(xx - yy, -2.0 * xy) / 4.0);
        let wc = self.second.map(|[xx, _, yy]| strength * (xx + yy) / 4.0);
        let www = self
            .third
            .map(|[xxx, xxy, xyy, yyy]| new(xxx - 3.0 * xyy, yyy - 3.0 * xxy) / 8.0);
        let wwc = self
            .third
            .map(|[xxx, xxy, xyy, yyy]| new(xxx + xyy, -xxy - yyy) / 8.0);
        let side = turn * Complex::i();
        let square = side * side;
        let back = axis.conj();
        let gradient = 2.0 * w[0].conj() * axis;
        let slope = 2.0 * (w[1] * side).re;
        let energy = PairEnergy {
            energy: strength * self.value,
            gradient: Vector2::new(gradient.re, gradient.im),
            slope,
        };
        let wtt = www[2] * square + 2.0 * wwc[2] + (wwc[2] * square).conj()
            - ww[1] * turn
            - wc[1] * turn.conj();
        let ttt = 2.0 * (www[3] * square * side).re + 6.0 * (wwc[3] * side).re
            - 6.0 * (ww[2] * side * turn).re
            - slope;
        let derivatives = Derivatives {
            ww: ww[0] * back * back,
            wc: wc[0],
            wt: (ww[1] * side + wc[1] * side.conj()) * back,
            tt: 2.0 * (ww[2] * square).re + 2.0 * wc[2] - 2.0 * (w[1] * turn).re,
            www: www[0] * back * back * back,
            wwc: wwc[0] * back,
            wwt: (www[1] * side + wwc[1] * side.conj()) * back * back,
            wct: 2.0 * (wwc[1] * side).re,
            wtt: wtt * back,
            ttt,
        };
        (energy, derivatives)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::near::exact;
    use super::*;
    use crate::potential::cuboid::limits::{pole_faces, segment_distance};
    use crate::potential::far::derivatives::tests::off_differences;
    use crate::tile::magnet::Shape;

    fn disc(position: Vector2<f64>, turn: f64) -> Body {
        Body {
            position,
            direction: Vector2::new(libm::cos(turn), libm::sin(turn)),
            moment: 1.3,
            size: [0.003, 0.006, 0.006],
            shape: Shape::Disc,
            stands: false,
        }
    }

    /// On one axis, nearly so, and anywhere, turned or not, a fiftieth of the radius to its double apart: as shares of
    /// all derivatives of an order, with what differences err.
    #[test]
    fn derivatives_are_those_of_exact_energies() {
        let (mut count, mut worst) = (0, [0.0f64; 5]);
        for k in 0..1500u32 {
            let even = |by: f64| 2.0 * (by * f64::from(k)).fract() - 1.0;
            let first = disc(Vector2::new(0.001, -0.002), 2.0 * even(0.37));
            let gap = 6e-5 * libm::pow(100.0, 0.5 + 0.5 * even(0.618));
            let aside = [0.0, 1e-7, 1e-4, 1e-3, 0.01][k as usize % 5] * even(0.41);
            let bent = [0.0, 1e-6, 0.05, 3.0][k as usize / 5 % 4] * even(0.73);
            let axis = first.direction;
            let across = Vector2::new(-axis.y, axis.x);
            let angle = libm::atan2(axis.y, axis.x) + bent;
            let second = disc(
                first.position + axis * (0.003 + gap) + across * aside,
                angle,
            );
            let [own, others] = [&first, &second]
                .map(|it| pole_faces(it.position, it.direction, [it.size[0], it.size[1]]));
            let all = own
                .iter()
                .flat_map(|a| others.map(|b| segment_distance(*a, b)));
            let apart = all.fold(f64::INFINITY, f64::min);
            if apart < 6e-5 {
                continue;
            }
            count += 1;
            let (energy, found) = derived(&first, &second);
            let exact = exact(&first, &second);
            let radius = second.radius();
            let slope = energy.gradient.norm() + energy.slope.abs() / radius;
            let second_order = found.ww.norm()
                + found.wc.abs()
                + found.wt.norm() / radius
                + found.tt.abs() / radius.powi(2);
            let third_order = found.www.norm()
                + found.wwc.norm()
                + (found.wwt.norm() + found.wct.abs()) / radius
                + found.wtt.norm() / radius.powi(2)
                + found.ttt.abs() / radius.powi(3);
            let steps = [0.01, 0.01 / radius].map(|it| it * apart.min(0.003));
            // In units of 1 J and of the radius.
            let off = off_differences(&found, [&first, &second], steps, [1.0, radius]);
            let touching = strength(&first, &second) * 2.0 * PI * radius.powi(3);
            let most =
                |all: &[f64], power| all.iter().fold(0.0f64, |a, b| a.max(*b)) / radius.powi(power);
            for (worst, off) in worst.iter_mut().zip([
                (energy.energy - exact.energy).abs() / touching,
                (energy.gradient - exact.gradient).norm() / slope,
                (energy.slope - exact.slope).abs() / radius / slope,
                most(&off[..4], 2) / second_order,
                most(&off[4..], 3) / third_order,
            ]) {
                *worst = worst.max(off);
            }
        }
        assert!(count > 1000, "{count}");
        let is_right = [2e-10, 6e-9, 6e-9, 3e-7, 2e-6];
        let is_right = worst.iter().zip(is_right).all(|(off, most)| *off < most);
        assert!(is_right, "{worst:?}");
    }
}
