//! The difference between the energies of blocks and of point dipoles, far apart.

use nalgebra::{Complex, Vector3};

use super::CuboidPotential;
use crate::configuration::Configuration;
use crate::potential::far::group::Group;
use crate::potential::far::multipole::{Coefficients, index};
use crate::potential::far::rows::Facing;
use crate::potential::far::terms::{Pairs, Sums, add_terms};
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};
use crate::units::MU0_OVER_4PI;

/// The multipole series without its first term, the point dipole, and its gradient (J), over the
/// pairs that a mask selects. Accurate to 1e-9 of `mu0 m1 m2 / (4 pi r^3)` per pair for pairs at
/// least the [hand-over](CuboidPotential::hand_over) distance apart.
pub(in crate::potential) struct Correction<'a> {
    pub potential: &'a CuboidPotential,
    pub q: &'a Configuration,
    /// 1 for each pair to be summed and 0 for the others; the pair of the fixed tile's block i and
    /// the moving tile's block j has the index `i * stride + j`.
    pub weights: &'a [f64],
    pub stride: usize,
}

impl Task for Correction<'_> {
    type Output = (f64, Vector3<f64>);

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let (sin, cos) = libm::sincos(self.q.theta);
        let mut total = Sums::zero(l);
        let mut coefficients = Coefficients::NONE;
        for moving in &self.potential.moving_groups {
            for fixed in &self.potential.fixed_groups {
                let Facing {
                    form, turn, centre, ..
                } = self
                    .potential
                    .facing([fixed, moving], self.q, Complex::new(cos, sin));
                let mut sums = Sums::zero(l);
                let mut known = 0;
                for (j, &second) in moving.members.iter().enumerate() {
                    let arm = turn * Complex::new(moving.x[j], moving.y[j]);
                    let place = centre + arm;
                    for from in (0..fixed.x.len()).step_by(WIDTH) {
                        let mask = self.mask(fixed, from, second);
                        if mask.iter().all(|weight| *weight == 0.0) {
                            continue;
                        }
                        let mask = l.load(&mask);
                        let mut pairs = Pairs::new(l, fixed, from, place, moving.moment[j]);
                        pairs.arm = arm;
                        // Omitted pairs must neither add anything nor require terms.
                        let counts = l.sub(mask, l.splat(0.5));
                        pairs.inverse = l.select(counts, pairs.inverse, l.splat(0.0));
                        let least = l.least(l.select(counts, pairs.rr, l.splat(f64::MAX)));
                        let terms = form.terms(&form.squares, least);
                        if known < terms {
                            form.series.evaluate::<L, true>(
                                l,
                                turn,
                                known..terms,
                                &mut coefficients,
                            );
                            without_dipole(&mut coefficients);
                            known = terms;
                        }
                        add_terms::<L, true>(l, terms, &coefficients, &pairs, &mut sums);
                    }
                }
                total.add::<L, true>(l, &sums, fixed.axis);
            }
        }
        let scale = -MU0_OVER_4PI;
        let [x, y, turn] = total.gradient;
        let gradient = Vector3::new(l.sum(x), l.sum(y), l.sum(turn)) * scale;
        (l.sum(total.energy) * scale, gradient)
    }
}

#[inline(always)]
fn without_dipole(coefficients: &mut Coefficients) {
    for at in 0..index(1, 0) {
        coefficients.re[at] = 0.0;
        coefficients.im[at] = 0.0;
        coefficients.turn_re[at] = 0.0;
        coefficients.turn_im[at] = 0.0;
        coefficients.slope_re[at] = 0.0;
        coefficients.slope_im[at] = 0.0;
    }
}

impl Correction<'_> {
    /// The weights of a vector of fixed blocks with the moving block `second`.
    #[inline(always)]
    fn mask(&self, fixed: &Group, from: usize, second: usize) -> [f64; WIDTH] {
        let mut mask = [0.0; WIDTH];
        for (weight, &first) in mask.iter_mut().zip(&fixed.members[from..]) {
            *weight = self.weights[first * self.stride + second];
        }
        mask
    }
}
