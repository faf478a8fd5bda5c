//! Pairs that are far apart: series for value and gradient, dipoles for the Hessian.
//!
//! With `w = x + i y` from the first to the second dipole, at angles a and b, dipoles that lie have the
//! energy `K Re[g w^(-3/2) w*^(-3/2) + f w^(-5/2) w*^(-1/2)]`, `g = -e^(i (a - b)) / 2` and `f = -3/2
//! e^(i (a + b))`; those that stand have `g = 1` and `f = 0`. In terms of w and its conjugate all
//! derivatives are products with numbers.

use nalgebra::Complex;

use super::{CLOSE, Left, NEAR, Pair, ROOM};
use crate::cell::Quadratic;
use crate::potential::bodies::Body;
use crate::potential::far::PairEnergy;
use crate::tile::magnet::Shape;

/// The error of the series, in value and in the change by its slopes over a cell, as a fraction of `mu0
/// m1 m2 / (4 pi r^3)`.
const SERIES: f64 = 1e-7;

/// Half the diagonal (m) of a magnet, and the mean square distance of its points from its centre (m^2).
pub(super) fn extent(body: &Body) -> [f64; 2] {
    let [a, b, c] = body.size;
    let [height, width] = if body.stands { [c, a] } else { [a, b] };
    match body.shape {
        Shape::Block => [
            libm::hypot(libm::hypot(a, b), c) / 2.0,
            (a * a + b * b + c * c) / 12.0,
        ],
        Shape::Disc => [
            libm::hypot(height, width) / 2.0,
            height * height / 12.0 + width * width / 8.0,
        ],
    }
}

impl Pair<'_> {
    pub(super) fn distance(&self) -> f64 {
        (self.single.second.position - self.single.first.position).norm()
    }

    /// The largest distance (m) that the cell moves the second magnet's centre.
    pub(super) fn centre_reach(&self) -> f64 {
        self.cell.reach(self.arm.norm()) * ROOM
    }

    pub(super) fn is_far(&self) -> bool {
        let [first, second] = self.magnets;
        let least = CLOSE * (first.half + second.half) + NEAR * self.reach();
        self.distance() >= least
    }

    /// Adds the form of a pair that is far; returns what is left. Bounds of the third derivative as
    /// those of [dipoles](crate::potential::bounds::DipoleBounds).
    pub(super) fn far(&self, energy: &PairEnergy, form: &mut Quadratic) -> Left {
        *form = form.minus(-1.0, &self.in_cell(energy, self.of_dipoles()));
        let (w, lever) = (self.cell.half[2], self.arm.norm());
        let v = self.centre_reach();
        let near = 1.0 / (self.distance() - v);
        let near2 = near * near;
        let bend = lever * w * w;
        let third = 2.0 * w * w * w
            + near * 6.0 * (3.0 * w * w * v + 3.0 * w * bend + bend * w)
            + near2 * 24.0 * (3.0 * w * v * v + 3.0 * v * bend)
            + near2 * near * 120.0 * v * v * v;
        let third = self.strength * near2 * near * third / 6.0;

        let [first, second] = self.magnets;
        let radii = self.magnets[0].radius + self.magnets[1].radius;
        let lever = lever + self.magnets[1].radius;
        let v = self.reach();
        let near = 1.0 / (self.distance() - v - radii);
        let series = 216.0 * w * w
            + near * (720.0 * w * v + 120.0 * w * w * lever)
            + near * near * 720.0 * v * v;
        let share = (first.square + second.square) / 4.0;
        let spread = self.strength * share * near.powi(5) * series;
        let series = self.strength * SERIES * near.powi(3);
        let left = (third + spread) * ROOM + series;
        Left {
            spread: left,
            slope: 3.0 * left,
        }
    }

    /// The Hessian of the dipoles in the second one's place and turn.
    fn of_dipoles(&self) -> [f64; 6] {
        let (first, second) = (&self.single.first, &self.single.second);
        let way = second.position - first.position;
        let w = Complex::new(way.x, way.y);
        let [a, b] = [first.direction, second.direction].map(|it| Complex::new(it.x, it.y));
        let moments = self.strength.copysign(first.moment * second.moment);
        let (g, f) = match first.stands {
            true => (Complex::new(1.0, 0.0), Complex::new(0.0, 0.0)),
            false => (a * b.conj() * -0.5, a * b * -1.5),
        };
        let inverse = 1.0 / w.norm();
        let unit = w * inverse;
        // K r^-5, K r^-4 and K r^-3 times the phases of w to the n-th power.
        let scale = moments * inverse.powi(3);
        let [f, g] = [f * unit.conj() * unit.conj() * scale, g * scale];
        let (by_w, by_w_conj) = (unit.conj() * inverse, unit * inverse);
        let ww = (g * 3.75 + f * 8.75) * by_w * by_w;
        let cc = (g * 3.75 + f * 0.75) * by_w_conj * by_w_conj;
        let wc = (g * 2.25 + f * 1.25) * inverse * inverse;
        let i = Complex::i();
        // By the second one's angle: g turns back, f on.
        let (gt, ft) = (g * -i, f * i);
        let wt = (gt * -1.5 + ft * -2.5) * by_w;
        let ct = (gt * -1.5 + ft * -0.5) * by_w_conj;
        let tt = match first.stands {
            true => 0.0,
            false => -(g + f).re,
        };
        let turned = if first.stands { 0.0 } else { 1.0 };
        [
            (ww + wc * 2.0 + cc).re,
            (wc * 2.0 - ww - cc).re,
            tt,
            ((ww - cc) * i).re,
            (wt + ct).re * turned,
            ((wt - ct) * i).re * turned,
        ]
    }
}
