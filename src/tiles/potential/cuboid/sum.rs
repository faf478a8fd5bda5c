//! The sum over all pairs of blocks at one configuration.

use std::cell::RefCell;

use nalgebra::{Complex, Vector3};

use super::block::BlockPair;
use super::panel::{self, Near};
use super::table::{self, BlockField};
use super::{CuboidPotential, member};
use crate::configuration::Configuration;
use crate::potential::far::PairEnergy;
use crate::potential::far::group::Group;
use crate::potential::far::rows::{Known, Strongest};
use crate::potential::far::terms::Sums;
use crate::potential::simd::lanes::{Lanes, Task};
use crate::units::MU0_OVER_4PI;

/// The energy at a configuration, and its gradient if requested (otherwise zero).
pub struct BlockSum<'a, const SLOPE: bool> {
    pub potential: &'a CuboidPotential,
    pub q: &'a Configuration,
}

impl<const SLOPE: bool> Task for BlockSum<'_, SLOPE> {
    type Output = (f64, Vector3<f64>);

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let (sin, cos) = libm::sincos(self.q.theta);
        let rotation = Complex::new(cos, sin);
        match &self.potential.field {
            Some(field) if field.holds(self.q) => self.in_field(l, field, rotation),
            _ => self.over_groups(l, rotation),
        }
    }
}

impl<const SLOPE: bool> BlockSum<'_, SLOPE> {
    /// The sum over all pairs of groups.
    #[inline(always)]
    fn over_groups<L: Lanes>(&self, l: L, rotation: Complex<f64>) -> (f64, Vector3<f64>) {
        let [all_fixed, all_moving] = [&self.potential.fixed_groups, &self.potential.moving_groups];
        let mut strongest = Strongest::new(l);
        for moving in all_moving {
            for fixed in all_fixed {
                self.potential
                    .facing([fixed, moving], self.q, rotation)
                    .find_strongest(l, 0..moving.count, &mut strongest);
            }
        }
        let strongest = strongest.value(l);
        let mut sums = Sums::zero(l);
        let (mut known, mut near) = (Known::none(), Vec::new());
        let (mut energy, mut gradient) = (0.0, Vector3::zeros());
        for moving in all_moving {
            for fixed in all_fixed {
                let groups = [fixed, moving];
                self.potential
                    .facing(groups, self.q, rotation)
                    .add_far::<L, SLOPE>(
                        l,
                        0..moving.count,
                        strongest,
                        &mut known,
                        &mut sums,
                        &mut near,
                    );
                self.add_near(groups, rotation, &mut near, (&mut energy, &mut gradient));
            }
        }
        self.add_sums(l, &sums, -MU0_OVER_4PI, &mut energy, &mut gradient);
        (energy, gradient)
    }

    /// The sum over the moving blocks, in the tabulated field of the fixed ones.
    #[inline(always)]
    fn in_field<L: Lanes>(
        &self,
        l: L,
        field: &BlockField,
        rotation: Complex<f64>,
    ) -> (f64, Vector3<f64>) {
        let [all_fixed, all_moving] = [&self.potential.fixed_groups, &self.potential.moving_groups];
        let centre = Complex::new(self.q.x, self.q.y);
        let (mut patches, mut strongest) = (Vec::new(), Strongest::new(l));
        for moving in all_moving {
            for j in 0..moving.count {
                let arm = moving.axis * rotation * Complex::new(moving.x[j], moving.y[j]);
                let patch = field.at(moving.size, centre + arm, all_fixed);
                for (_, fixed) in &patch.near {
                    self.potential
                        .facing([fixed, moving], self.q, rotation)
                        .find_strongest(l, j..j + 1, &mut strongest);
                }
                patches.push((arm, patch));
            }
        }
        let strongest = strongest.value(l);
        let (mut sums, mut far) = (Sums::zero(l), Sums::zero(l));
        let (mut known, mut near) = (Known::none(), Vec::new());
        let (mut energy, mut gradient) = (0.0, Vector3::zeros());
        let mut lists = vec![Vec::new(); all_fixed.len()];
        let mut patches = patches.into_iter();
        for moving in all_moving {
            let faces = field.faces(l, moving.size, moving.axis * rotation);
            for (j, (arm, patch)) in (0..moving.count).zip(&mut patches) {
                let block = (centre + arm, arm, moving.moment[j]);
                table::add::<L, SLOPE>(l, patch, &faces, block, &mut far);
                for (number, fixed) in &patch.near {
                    self.potential
                        .facing([fixed, moving], self.q, rotation)
                        .add_far::<L, SLOPE>(
                            l,
                            j..j + 1,
                            strongest,
                            &mut known,
                            &mut sums,
                            &mut near,
                        );
                    let near = near
                        .drain(..)
                        .map(|[i, j]: [usize; 2]| [fixed.members[i], j]);
                    lists[*number].extend(near);
                }
            }
            for (fixed, list) in all_fixed.iter().zip(&mut lists) {
                let groups = [fixed, moving];
                self.add_near(groups, rotation, list, (&mut energy, &mut gradient));
            }
        }
        self.add_sums(l, &far, 1.0, &mut energy, &mut gradient);
        self.add_sums(l, &sums, -MU0_OVER_4PI, &mut energy, &mut gradient);
        (energy, gradient)
    }

    /// Adds the sum over near pairs of two groups, and empties their list.
    #[inline(always)]
    fn add_near(
        &self,
        groups: [&Group; 2],
        rotation: Complex<f64>,
        pairs: &mut Vec<[usize; 2]>,
        (energy, gradient): (&mut f64, &mut Vector3<f64>),
    ) {
        if pairs.is_empty() {
            return;
        }
        let sum = self.near(groups, rotation, pairs);
        *energy += sum.0;
        *gradient += sum.1;
        pairs.clear();
    }

    /// Adds sums in units of `scale`.
    #[inline(always)]
    fn add_sums<L: Lanes>(
        &self,
        l: L,
        sums: &Sums<L::F>,
        scale: f64,
        energy: &mut f64,
        gradient: &mut Vector3<f64>,
    ) {
        *energy += scale * l.sum(sums.energy);
        if SLOPE {
            let [x, y, turn] = sums.gradient;
            *gradient += Vector3::new(l.sum(x), l.sum(y), l.sum(turn)) * scale;
        }
    }
}

impl<const SLOPE: bool> BlockSum<'_, SLOPE> {
    /// The pairs of the blocks with these indices in two groups, by their pole faces.
    fn near(
        &self,
        [fixed, moving]: [&Group; 2],
        rotation: Complex<f64>,
        pairs: &[[usize; 2]],
    ) -> (f64, Vector3<f64>) {
        let centre = self.q.position();
        let pair = |&[i, j]: &[usize; 2]| {
            let first = member(fixed, &self.potential.fixed, i);
            let second = member(moving, &self.potential.moving, j);
            let second = second.moved(rotation.re, rotation.im, centre);
            BlockPair::new(&first, &second, centre)
        };
        let pairs: Vec<_> = pairs.iter().map(pair).collect();
        self.potential.level.run(Near::<SLOPE>::of(&pairs))
    }
}

/// The energies of all pairs of blocks, `out[second * fixed blocks + first]`. Gradients and slopes
/// are zero unless requested.
pub struct Each<'a, const SLOPE: bool> {
    pub potential: &'a CuboidPotential,
    pub q: &'a Configuration,
    pub out: &'a mut [PairEnergy],
}

impl<const SLOPE: bool> Task for Each<'_, SLOPE> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let (sin, cos) = libm::sincos(self.q.theta);
        let potential = self.potential;
        for moving in &potential.moving_groups {
            for fixed in &potential.fixed_groups {
                let facing = potential.facing([fixed, moving], self.q, Complex::new(cos, sin));
                let known = RefCell::new(Known::none());
                facing.for_each::<L, SLOPE>(l, &known, |[i, j], lane| {
                    let (first, second) = (fixed.members[i], moving.members[j]);
                    self.out[second * potential.fixed.len() + first] =
                        if lane.square < facing.form.near() {
                            let moved = &potential.moving[second].block;
                            let moved = moved.moved(cos, sin, self.q.position());
                            let fixed = &potential.fixed[first].block;
                            panel::near::<SLOPE>(potential.level, fixed, &moved)
                        } else {
                            lane.pair
                        };
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};

    use super::*;
    use crate::potential::Potential;
    use crate::sample;

    /// Dropping terms relative to the strongest pair causes no larger error than stated, at every
    /// distance, compared with all pairs individually.
    #[test]
    fn the_sum_is_that_of_its_pairs_by_the_measure_of_the_strongest() {
        let problem = sample::paper_tile();
        let pair = problem.pair.as_ref().unwrap();
        let (fixed, moving) = (&pair.fixed.magnets, &pair.moving.magnets);
        let potential = CuboidPotential::new(fixed, moving);
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let mut farthest: f64 = 0.0;
        for k in 0..600 {
            let q = Configuration::new(
                rng.random_range(0.40..[0.45, 0.6, 1.5][k % 3]),
                rng.random_range(-0.3..0.3),
                rng.random_range(-3.1..3.1) * [0.01, 1.0][k % 2],
            );
            let pairs = potential.pairs::<true>(&q);
            let (energy, gradient) = potential.energy_and_gradient(&q);
            let rotation = q.rotation();
            let at = |j: usize| q.position() + rotation * moving[j].position;
            let mut strongest: f64 = 0.0;
            let (mut sum, mut slope) = (0.0, Vector3::zeros());
            for (number, of_pair) in pairs.iter().enumerate() {
                let (i, j) = (number % fixed.len(), number / fixed.len());
                let r = (at(j) - fixed[i].position).norm();
                let moments = (fixed[i].moment * moving[j].moment).abs();
                strongest = strongest.max(MU0_OVER_4PI * moments / r.powi(3));
                let arm = rotation * moving[j].position;
                let turn = of_pair.slope + arm.perp(&of_pair.gradient);
                sum += of_pair.energy;
                slope += Vector3::new(of_pair.gradient.x, of_pair.gradient.y, turn);
            }
            let off = (energy - sum).abs() / strongest;
            farthest = farthest.max(off);
            assert!(off < 2e-8, "{q:?}: {off}");
            // The error of a gradient is that of the energy over the shortest distance, a few
            // centimetres.
            let off = (gradient - slope).norm() / strongest;
            assert!(off < 2e-8 / 0.005, "{q:?}: {off}");
        }
        // Terms are actually dropped.
        assert!(farthest > 1e-11, "{farthest}");
    }
}
