//! The bound of the energy's curvature, the moving dipoles in the lanes.

use super::DipolePotential;
use super::bundle::Bundle;
use super::field::TOGETHER;
use super::lanes::{Arithmetic, Lanes, MAX_WIDTH, Task};
use super::tasks::frame_of_one;
use crate::configuration::Configuration;

/// The sum over all pairs of `K [24 / r^5 + 18 w / r^4 + 2 w^2 / r^3]`, with r the pair's distance
/// less `reach` and w the reciprocal of the moving dipoles' largest lever.
pub struct Curvature<'a> {
    pub potential: &'a DipolePotential,
    pub q: &'a Configuration,
    pub reach: f64,
}

impl Task for Curvature<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> f64 {
        let b = Bundle::<L, 1, TOGETHER>(l);
        let DipolePotential { moving, lever, .. } = self.potential;
        let frame = frame_of_one(l, self.q);
        let turn = if *lever > 0.0 { 1.0 / lever } else { 0.0 };
        let coefficients = [24.0, 18.0 * turn, 2.0 * turn * turn];
        let (mut sum, mut nearest) = (l.splat(0.0), l.splat(f64::INFINITY));
        for first in (0..moving.x.len()).step_by(L::WIDTH) {
            let point = [l.load(&moving.x[first..]), l.load(&moving.y[first..])];
            let [x, y] = frame.place(l, point);
            let mut share = l.splat(0.0);
            for pair in self.potential.sources.as_chunks::<TOGETHER>().0 {
                let d = [
                    b.sub([[x]; TOGETHER], b.rows(pair.map(|s| s.position[0]))),
                    b.sub([[y]; TOGETHER], b.rows(pair.map(|s| s.position[1]))),
                ];
                let r2 = b.mul_add(d[0], d[0], b.mul(d[1], d[1]));
                let r = b.sub(b.mul(r2, b.reciprocal_sqrt(r2)), b.splat(self.reach));
                let w1 = b.reciprocal_sqrt(b.mul(r, r));
                let w2 = b.mul(w1, w1);
                let p = b.mul_add(b.splat(coefficients[0]), w1, b.splat(coefficients[1]));
                let p = b.mul_add(p, w1, b.splat(coefficients[2]));
                let p = b.mul(b.mul(w1, w2), p);
                for (j, source) in pair.iter().enumerate() {
                    nearest = l.min(r[j][0], nearest);
                    share = l.mul_add(p[j][0], l.splat(source.magnitude), share);
                }
            }
            sum = l.mul_add(share, l.load(&moving.magnitude[first..]), sum);
        }
        let mut distances = [f64::INFINITY; MAX_WIDTH];
        l.store(nearest, &mut distances);
        let bound = l.sum(sum);
        if bound.is_finite() && distances.iter().all(|r| *r > 0.0) {
            bound
        } else {
            f64::INFINITY
        }
    }
}
