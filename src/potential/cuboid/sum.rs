//! The sum over all pairs of blocks at one configuration.

use nalgebra::{Complex, Vector2, Vector3};

use super::CuboidPotential;
use super::block::BlockPair;
use super::far::{self, Group, Sums};
use super::multipole::Coefficients;
use super::panel::Panels;
use crate::configuration::Configuration;
use crate::potential::batch::lanes::{Lanes, MAX_WIDTH, Task};
use crate::units::MU0;

/// The energy at a configuration, and its gradient where asked for (else it is zero).
pub struct Sum<'a, const SLOPE: bool> {
    pub potential: &'a CuboidPotential,
    pub q: &'a Configuration,
}

/// What is summed up.
struct Total {
    energy: f64,
    gradient: Vector3<f64>,
    /// Pairs (fixed block, moving block) that are too close for the far form.
    near: Vec<(usize, usize)>,
}

impl<const SLOPE: bool> Task for Sum<'_, SLOPE> {
    type Output = (f64, Vector3<f64>);

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let (sin, cos) = self.q.theta.sin_cos();
        let mut total = Total {
            energy: 0.0,
            gradient: Vector3::zeros(),
            near: Vec::new(),
        };
        let rotation = Complex::new(cos, sin);
        let mut sums = Sums::zero(l);
        let mut coefficients = Coefficients::NONE;
        for moving in &self.potential.moving_groups {
            for fixed in &self.potential.fixed_groups {
                coefficients.terms = 0;
                self.add_groups(
                    l,
                    fixed,
                    moving,
                    rotation,
                    &mut coefficients,
                    &mut sums,
                    &mut total.near,
                );
            }
        }
        let scale = -MU0 / (4.0 * std::f64::consts::PI);
        total.energy = scale * l.sum(sums.energy);
        if SLOPE {
            let [x, y, turn] = sums.gradient;
            total.gradient = Vector3::new(l.sum(x), l.sum(y), l.sum(turn)) * scale;
        }
        if !total.near.is_empty() {
            let mut panels = Panels::default();
            for &(first, second) in &total.near {
                let first = &self.potential.fixed[first];
                let second = self.potential.moving[second].moved(cos, sin, self.q.position());
                let pair = BlockPair::new(first, &second, self.q.position());
                panels.append::<L, SLOPE>(l, &pair);
            }
            let (energy, gradient) = panels.sum::<L, SLOPE>(l);
            total.energy += energy;
            total.gradient += gradient;
        }
        (total.energy, total.gradient)
    }
}

impl<const SLOPE: bool> Sum<'_, SLOPE> {
    /// Adds the pairs of two groups that are far enough apart, and lists the others.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn add_groups<L: Lanes>(
        &self,
        l: L,
        fixed: &Group,
        moving: &Group,
        rotation: Complex<f64>,
        coefficients: &mut Coefficients,
        sums: &mut Sums<L::F>,
        near_pairs: &mut Vec<(usize, usize)>,
    ) {
        let far = &self.potential.far[fixed.size][moving.size];
        let turn = moving.axis * rotation * fixed.axis.conj();
        let axis = fixed.axis * fixed.axis;
        let near = l.splat(far.near());
        for (j, &second) in moving.members.iter().enumerate() {
            let arm = rotation * Complex::new(moving.x[j], moving.y[j]);
            let place = Vector2::new(self.q.x + arm.re, self.q.y + arm.im);
            let mut from = 0;
            while from < fixed.x.len() {
                let r = [
                    l.sub(l.splat(place.x), l.load(&fixed.x[from..])),
                    l.sub(l.splat(place.y), l.load(&fixed.y[from..])),
                ];
                let rr = l.mul_add(r[0], r[0], l.mul(r[1], r[1]));
                let mut moment = l.mul(l.load(&fixed.moment[from..]), l.splat(moving.moment[j]));
                let mut apart = rr;
                let least = l.least(rr);
                if least < far.near() {
                    let mut squares = [0.0; MAX_WIDTH];
                    l.store(rr, &mut squares);
                    for (lane, square) in squares[..L::WIDTH].iter().enumerate() {
                        if *square < far.near() {
                            near_pairs.push((fixed.members[from + lane], second));
                        }
                    }
                    let outside = l.sub(rr, near);
                    moment = l.select(outside, moment, l.splat(0.0));
                    apart = l.select(outside, rr, near);
                }
                let terms = far.terms(least);
                if terms > coefficients.terms {
                    far.series
                        .evaluate::<L, SLOPE>(l, turn, terms, coefficients);
                }
                far::add::<L, SLOPE>(l, coefficients, terms, axis, moment, r, apart, arm, sums);
                from += L::WIDTH;
            }
        }
    }
}
