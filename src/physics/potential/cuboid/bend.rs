//! A bound of the energy's fourth derivative along a motion, over all pairs of blocks.

use nalgebra::Complex;

use super::far::{Group, Pairs};
use super::{CuboidPotential, Meeting};
use crate::configuration::Configuration;
use crate::potential::motion;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};

/// The bound (J/m^4) along motions that move no point of the moving blocks by more than `reach`
/// (m), as [`motion`] derives it. Infinite if blocks may come as close as the sum of their radii.
pub struct FourthDerivative<'a> {
    pub potential: &'a CuboidPotential,
    pub q: &'a Configuration,
    pub reach: f64,
}

impl Task for FourthDerivative<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> f64 {
        let (sin, cos) = libm::sincos(self.q.theta);
        let rotation = Complex::new(cos, sin);
        let terms = motion::fourth_derivative(self.potential.lever.turn());
        let mut bound = 0.0;
        let ([all_fixed, all_moving], meetings) = self.potential.meetings(self.q, Some(self.reach));
        for Meeting { groups, replaced } in meetings.iter() {
            let [fixed, moving] = [&all_fixed[groups[0]], &all_moving[groups[1]]];
            if let Some((moments, distance)) = replaced {
                let limits = &self.potential.far[fixed.size][moving.size].limits;
                bound += motion::bound(&terms, moments * limits.dipole(), *distance);
                continue;
            }
            match self.of_groups(l, [fixed, moving], rotation, &terms) {
                Some(share) => bound += share,
                None => return f64::INFINITY,
            }
        }
        bound
    }
}

impl FourthDerivative<'_> {
    /// The contribution of two groups, unless two of their blocks may come too close.
    #[inline(always)]
    fn of_groups<L: Lanes>(
        &self,
        l: L,
        [fixed, moving]: [&Group; 2],
        rotation: Complex<f64>,
        terms: &[f64; 5],
    ) -> Option<f64> {
        let (far, turn, centre) = self.potential.facing([fixed, moving], self.q, rotation);
        let mut sum = l.splat(0.0);
        let radii = l.splat(far.radii);
        let lost = l.splat(far.radii + self.reach);
        for j in 0..moving.count {
            let place = centre + turn * Complex::new(moving.x[j], moving.y[j]);
            for from in (0..fixed.x.len()).step_by(WIDTH) {
                let pairs = Pairs::new(l, fixed, from, place, moving.moment[j]);
                let distance = l.sub(l.mul(pairs.rr, pairs.inverse), lost);
                if l.least(l.sub(distance, radii)) < 0.0 {
                    return None;
                }
                let inverse = l.reciprocal(distance);
                let mut series = l.splat(0.0);
                for term in terms {
                    series = l.mul_add(series, inverse, l.splat(*term));
                }
                let cube = l.mul(inverse, l.mul(inverse, inverse));
                sum = l.mul_add(l.mul(l.abs(pairs.moments), cube), series, sum);
            }
        }
        Some(l.sum(sum) * far.limits.dipole())
    }
}
