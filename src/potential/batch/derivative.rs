//! Bounds of the energy's derivatives along motions, the moving dipoles in the lanes.

use std::ops::Range;

use super::DipolePotential;
use super::bundle::Bundle;
use super::field::{Frame, Source, TOGETHER};
use super::lanes::{Arithmetic, Lanes, MAX_WIDTH, Task};
use super::tasks::{frame_of_one, walk};
use crate::configuration::Configuration;
use crate::potential::groups::tree::{LOST_OF_BOUNDS, Purpose};
use crate::potential::groups::walk::Leeway;
use crate::potential::motion;
use crate::potential::parts::Part;
use crate::units::MU0_OVER_4PI;

/// The sum over all pairs of `K / r^3` times a polynomial in `1 / r`, with r the pair's distance
/// less `reach`; infinite where an r is not positive.
pub struct DerivativeBound<'a, const TERMS: usize> {
    pub potential: &'a DipolePotential,
    pub q: &'a Configuration,
    pub reach: f64,
    /// The polynomial's coefficients, that of the highest power first.
    pub terms: [f64; TERMS],
    /// Of a potential with groups some pairs of them only.
    pub parts: Option<&'a [Part]>,
}

impl<const TERMS: usize> Task for DerivativeBound<'_, TERMS> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> f64 {
        let frame = frame_of_one(l, self.q);
        let mut sums = Sums {
            bound: l.splat(0.0),
            nearest: l.splat(f64::INFINITY),
        };
        let (sources, all) = (&self.potential.sources, 0..self.potential.moving.x.len());
        let mut lost = 0.0;
        match &self.potential.groups {
            None => self.meet(l, &frame, sources, all, &mut sums),
            Some([fixed, moving]) => {
                let leeway = Leeway {
                    travel: self.reach,
                    purpose: Purpose::Bound,
                    ..Leeway::default()
                };
                for meeting in walk(self.parts, [fixed, moving], self.q, leeway) {
                    let sources = &sources[meeting.fixed];
                    self.meet(l, &frame, sources, meeting.moving, &mut sums);
                    if meeting.replaced > 0.0 {
                        let k = LOST_OF_BOUNDS * MU0_OVER_4PI * meeting.replaced;
                        lost += motion::bound(&self.terms, k, meeting.distance);
                    }
                }
            }
        }

        let mut nearest = [f64::INFINITY; MAX_WIDTH];
        l.store(sums.nearest, &mut nearest);
        let bound = l.sum(sums.bound) + lost;
        if bound.is_finite() && nearest.iter().all(|r| *r > 0.0) {
            bound
        } else {
            f64::INFINITY
        }
    }
}

/// What the pairs are summed to.
struct Sums<F> {
    bound: F,
    /// The smallest distance less the reach (m).
    nearest: F,
}

impl<const TERMS: usize> DerivativeBound<'_, TERMS> {
    /// The pairs of some moving dipoles, whole vectors of them, with some of the fixed ones.
    #[inline(always)]
    fn meet<L: Lanes>(
        &self,
        l: L,
        frame: &Frame<L::F>,
        sources: &[Source],
        moving: Range<usize>,
        sums: &mut Sums<L::F>,
    ) {
        let mut first = moving.start;
        while first + 2 * L::WIDTH <= moving.end {
            self.block::<L, 2>(l, frame, sources, first, sums);
            first += 2 * L::WIDTH;
        }
        if first < moving.end {
            self.block::<L, 1>(l, frame, sources, first, sums);
        }
    }

    /// The pairs of `N` vectors of moving dipoles from the dipole `first` on.
    #[inline(always)]
    fn block<L: Lanes, const N: usize>(
        &self,
        l: L,
        frame: &Frame<L::F>,
        sources: &[Source],
        first: usize,
        sums: &mut Sums<L::F>,
    ) {
        let b = Bundle::<L, N, TOGETHER>(l);
        let moving = &self.potential.moving;
        let (mut x, mut y) = ([l.splat(0.0); N], [l.splat(0.0); N]);
        for (k, (x, y)) in x.iter_mut().zip(&mut y).enumerate() {
            let i = first + k * L::WIDTH;
            [*x, *y] = frame.place(l, [l.load(&moving.x[i..]), l.load(&moving.y[i..])]);
        }
        let mut shares = [l.splat(0.0); N];
        for pair in sources.as_chunks::<TOGETHER>().0 {
            let dx = b.sub(
                [x; TOGETHER],
                b.rows([pair[0].position[0], pair[1].position[0]]),
            );
            let dy = b.sub(
                [y; TOGETHER],
                b.rows([pair[0].position[1], pair[1].position[1]]),
            );
            let r2 = b.mul_add(dx, dx, b.mul(dy, dy));
            let distance = b.mul(r2, b.reciprocal_sqrt(r2));
            let r = b.sub(distance, b.splat(self.reach));
            let w1 = b.reciprocal(r);
            let mut p = b.splat(self.terms[0]);
            for term in &self.terms[1..] {
                p = b.mul_add(p, w1, b.splat(*term));
            }
            let p = b.mul(b.mul(w1, b.mul(w1, w1)), p);
            for j in 0..TOGETHER {
                let magnitude = l.splat(pair[j].magnitude);
                for k in 0..N {
                    sums.nearest = l.min(r[j][k], sums.nearest);
                    shares[k] = l.mul_add(p[j][k], magnitude, shares[k]);
                }
            }
        }
        for (k, share) in shares.iter().enumerate() {
            let magnitude = l.load(&moving.magnitude[first + k * L::WIDTH..]);
            sums.bound = l.mul_add(*share, magnitude, sums.bound);
        }
    }
}
