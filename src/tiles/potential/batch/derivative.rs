//! Bounds of the energy's derivatives along motions, with the dipoles of one tile in the SIMD
//! lanes.

use nalgebra::Vector2;

use super::bundle::Bundle;
use super::field::{BATCH, Frame};
use super::tasks::frame_of_one;
use super::{DipolePotential, Many};
use crate::configuration::Configuration;
use crate::potential::patches::dipoles::{POWERS, Spread};
use crate::potential::patches::square::NEAR;
use crate::potential::simd::lanes::{Arithmetic, Lanes, Task, WIDTH};
use crate::units::MU0_OVER_4PI;

/// The sum over all pairs of `K / r^3` times a polynomial in `1 / r`, with r the pair's distance
/// minus `reach`; infinite if an r is not more than `least`.
pub struct DerivativeBound<'a, const TERMS: usize> {
    pub potential: &'a DipolePotential,
    pub q: &'a Configuration,
    pub reach: f64,
    /// Not negative (m).
    pub least: f64,
    /// The polynomial's coefficients, highest power first.
    pub terms: [f64; TERMS],
}

impl<const TERMS: usize> Task for DerivativeBound<'_, TERMS> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> f64 {
        let frame = frame_of_one(l, self.q);
        let mut sums = Sums::none(l);
        let end = self.potential.moving.x.len();
        let mut first = 0;
        while L::AT_ONCE == 2 && first + 2 * WIDTH <= end {
            self.block::<L, 2>(l, &frame, first, &mut sums);
            first += 2 * WIDTH;
        }
        while first < end {
            self.block::<L, 1>(l, &frame, first, &mut sums);
            first += WIDTH;
        }
        sums.finish(l, self.least)
    }
}

/// The sums over pairs.
struct Sums<F> {
    bound: F,
    /// The smallest distance minus the reach (m).
    nearest: F,
}

impl<F: Copy> Sums<F> {
    #[inline(always)]
    fn none<L: Lanes<F = F>>(l: L) -> Self {
        Self {
            bound: l.splat(0.0),
            nearest: l.splat(f64::INFINITY),
        }
    }

    #[inline(always)]
    fn finish<L: Lanes<F = F>>(&self, l: L, least: f64) -> f64 {
        let bound = l.sum(self.bound);
        if bound.is_finite() && l.least(self.nearest) > least {
            bound
        } else {
            f64::INFINITY
        }
    }
}

/// `r^-3` times the polynomial for the displacement d shortened by the reach, and the distance r.
#[inline(always)]
fn bound<A: Arithmetic>(a: A, terms: &[f64], d: [A::F; 2], reach: f64) -> (A::F, A::F) {
    let r2 = a.mul_add(d[0], d[0], a.mul(d[1], d[1]));
    let distance = a.mul(r2, a.reciprocal_sqrt(r2));
    let r = a.sub(distance, a.splat(reach));
    let w1 = a.reciprocal(r);
    let mut p = a.splat(terms[0]);
    for term in &terms[1..] {
        p = a.mul_add(p, w1, a.splat(*term));
    }
    (a.mul(a.mul(w1, a.mul(w1, w1)), p), r)
}

impl<const TERMS: usize> DerivativeBound<'_, TERMS> {
    /// The pairs of `N` vectors of moving dipoles from the dipole `first` on.
    #[inline(always)]
    fn block<L: Lanes, const N: usize>(
        &self,
        l: L,
        frame: &Frame<L::F>,
        first: usize,
        sums: &mut Sums<L::F>,
    ) {
        let b = Bundle::<L, N, BATCH>(l);
        let moving = &self.potential.moving;
        let (mut x, mut y) = ([l.splat(0.0); N], [l.splat(0.0); N]);
        for (k, (x, y)) in x.iter_mut().zip(&mut y).enumerate() {
            let i = first + k * WIDTH;
            [*x, *y] = frame.place(l, [l.load(&moving.x[i..]), l.load(&moving.y[i..])]);
        }
        let mut shares = [l.splat(0.0); N];
        for pair in self.potential.sources.as_chunks::<BATCH>().0 {
            let dx = b.sub(
                [x; BATCH],
                b.rows([pair[0].position[0], pair[1].position[0]]),
            );
            let dy = b.sub(
                [y; BATCH],
                b.rows([pair[0].position[1], pair[1].position[1]]),
            );
            let (p, r) = bound(b, &self.terms, [dx, dy], self.reach);
            for j in 0..BATCH {
                let magnitude = l.splat(pair[j].magnitude);
                for k in 0..N {
                    sums.nearest = l.min(r[j][k], sums.nearest);
                    shares[k] = l.mul_add(p[j][k], magnitude, shares[k]);
                }
            }
        }
        for (k, share) in shares.iter().enumerate() {
            let magnitude = l.load(&moving.magnitude[first + k * WIDTH..]);
            sums.bound = l.mul_add(*share, magnitude, sums.bound);
        }
    }
}

/// Groups no larger than this fraction of their distance are evaluated as one.
const SMALL: f64 = 1.0 / 16.0;

/// A bound of the same sum for a moving tile that lies within reach of the table of the fixed one's
/// field. Infinite also where the motion is too long for the table.
pub struct TabulatedBound<'a, const TERMS: usize> {
    pub bound: DerivativeBound<'a, TERMS>,
    pub many: &'a Many,
}

impl<const TERMS: usize> Task for TabulatedBound<'_, TERMS> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> f64 {
        let DerivativeBound { potential, q, .. } = self.bound;
        let moving = &potential.moving;
        let sight = self.many.sight(q);
        let [fixed, groups] = sight.groups;
        let mut sums = Sums::none(l);
        let mut far = 0.0;
        let mut open = vec![0];
        while let Some(number) = open.pop() {
            let group = &groups[number];
            let radius = libm::hypot(group.half[0], group.half[1]);
            let (place, reach) = (sight.place(group.centre), self.bound.reach + radius);
            let is_small = radius <= SMALL * sight.distance(&fixed[0], group);
            let whole = is_small.then(|| self.many.patches.around(place.into(), reach));
            if let Some(Some(spread)) = whole {
                let magnitude = MU0_OVER_4PI.sqrt() * group.magnitude;
                far += self.add(l, spread, (place.into(), reach, magnitude), &mut sums);
            } else if let Some(parts) = group.parts {
                open.extend(parts);
            } else {
                for i in group.own.clone() {
                    let magnitude = moving.magnitude[i];
                    if magnitude == 0.0 {
                        continue;
                    }
                    let place = sight.place(Vector2::new(moving.x[i], moving.y[i]));
                    let one = (place.into(), self.bound.reach, magnitude);
                    let Some(spread) = self.many.patches.around(one.0, one.1) else {
                        return f64::INFINITY;
                    };
                    far += self.add(l, spread, one, &mut sums);
                }
            }
        }
        far + sums.finish(l, self.bound.least)
    }
}

impl<const TERMS: usize> TabulatedBound<'_, TERMS> {
    /// For dipoles of some magnitude at a place that move no farther than their reach, adds the
    /// terms of near dipoles and returns those of the others.
    #[inline(always)]
    fn add<L: Lanes>(
        &self,
        l: L,
        spread: &Spread,
        (place, reach, magnitude): ([f64; 2], f64, f64),
        sums: &mut Sums<L::F>,
    ) -> f64 {
        for near in &spread.near {
            for first in (0..NEAR).step_by(WIDTH) {
                let [x, y] = &near.position;
                let dx = l.sub(l.splat(place[0]), l.load(&x[first..]));
                let dy = l.sub(l.splat(place[1]), l.load(&y[first..]));
                let (p, r) = bound(l, &self.bound.terms, [dx, dy], reach);
                let product = l.mul(l.load(&near.magnitude[first..]), l.splat(magnitude));
                sums.nearest = l.min(r, sums.nearest);
                sums.bound = l.mul_add(p, product, sums.bound);
            }
        }
        let far = spread.far(place, reach);
        let terms = self.bound.terms.iter().zip(&far[POWERS - TERMS..]);
        magnitude * terms.map(|(term, sum)| term * sum).sum::<f64>()
    }
}
