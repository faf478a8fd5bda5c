//! The sum over all pairs of blocks at one configuration.

use nalgebra::{Complex, Vector2, Vector3};

use super::CuboidPotential;
use super::block::{self, BlockPair, PairEnergy};
use super::far::{self, Group, Pairs, Sums};
use super::multipole::{Coefficients, TERMS};
use super::panel::Panels;
use crate::configuration::Configuration;
use crate::potential::batch::lanes::{Lanes, MAX_WIDTH, Task};
use crate::units::MU0;

/// The energy at a configuration, and its gradient where asked for (else it is zero).
pub struct Sum<'a, const SLOPE: bool> {
    pub potential: &'a CuboidPotential,
    pub q: &'a Configuration,
}

/// How many terms are summed for pairs far apart and at middle distances.
const FEW: usize = 3;
const SOME: usize = 5;

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
                let first = &self.potential.fixed[first].block;
                let second = &self.potential.moving[second].block;
                let second = second.moved(cos, sin, self.q.position());
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
        total: &mut Sums<L::F>,
        near_pairs: &mut Vec<(usize, usize)>,
    ) {
        let far = &self.potential.far[fixed.size][moving.size];
        // Everything is in the frame whose x axis is the fixed blocks' axis.
        let into = fixed.axis.conj();
        let turn = moving.axis * rotation * into;
        let centre = Complex::new(self.q.x, self.q.y) * into;
        let mut sums = Sums::zero(l);
        far.series.evaluate::<L, SLOPE>(l, turn, FEW, coefficients);
        let mut known = FEW;
        for (j, &second) in moving.members.iter().enumerate() {
            let arm = turn * Complex::new(moving.x[j], moving.y[j]);
            let place = centre + arm;
            for from in (0..fixed.x.len()).step_by(L::WIDTH) {
                let mut pairs = Pairs::new(l, fixed, from, place, moving.moment[j]);
                pairs.arm = arm;
                let least = l.least(pairs.rr);
                if least >= far.squares[FEW] {
                    far::add::<L, FEW, SLOPE>(l, coefficients, &pairs, &mut sums);
                    continue;
                }
                let terms = if least >= far.squares[SOME] {
                    SOME
                } else {
                    TERMS
                };
                if known < terms {
                    far.series
                        .evaluate::<L, SLOPE>(l, turn, terms, coefficients);
                    known = terms;
                }
                if terms == SOME {
                    far::add::<L, SOME, SLOPE>(l, coefficients, &pairs, &mut sums);
                    continue;
                }
                if least < far.near() {
                    let near = l.splat(far.near());
                    let mut squares = [0.0; MAX_WIDTH];
                    l.store(pairs.rr, &mut squares);
                    for (lane, square) in squares[..L::WIDTH].iter().enumerate() {
                        if *square < far.near() {
                            near_pairs.push((fixed.members[from + lane], second));
                        }
                    }
                    let outside = l.sub(pairs.rr, near);
                    pairs.moments = l.select(outside, pairs.moments, l.splat(0.0));
                    pairs.rr = l.select(outside, pairs.rr, near);
                }
                far::add::<L, TERMS, SLOPE>(l, coefficients, &pairs, &mut sums);
            }
        }
        total.add::<L, SLOPE>(l, &sums, fixed.axis);
    }
}

/// The energies of all pairs of blocks one by one, `out[second * fixed blocks + first]`.
/// Gradients and slopes are zero where not asked for.
pub struct Each<'a, const SLOPE: bool> {
    pub potential: &'a CuboidPotential,
    pub q: &'a Configuration,
    pub out: &'a mut [PairEnergy],
}

impl<const SLOPE: bool> Task for Each<'_, SLOPE> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let (sin, cos) = self.q.theta.sin_cos();
        let mut coefficients = Coefficients::NONE;
        for moving in &self.potential.moving_groups {
            for fixed in &self.potential.fixed_groups {
                let far = &self.potential.far[fixed.size][moving.size];
                let into = fixed.axis.conj();
                let turn = moving.axis * Complex::new(cos, sin) * into;
                let centre = Complex::new(self.q.x, self.q.y) * into;
                far.series
                    .evaluate::<L, SLOPE>(l, turn, TERMS, &mut coefficients);
                for (j, &second) in moving.members.iter().enumerate() {
                    let place = centre + turn * Complex::new(moving.x[j], moving.y[j]);
                    for from in (0..fixed.x.len()).step_by(L::WIDTH) {
                        let pairs = Pairs::new(l, fixed, from, place, moving.moment[j]);
                        let mut sums = Sums::zero(l);
                        if l.least(pairs.rr) >= far.squares[FEW] {
                            far::add::<L, FEW, SLOPE>(l, &coefficients, &pairs, &mut sums);
                        } else {
                            far::add::<L, TERMS, SLOPE>(l, &coefficients, &pairs, &mut sums);
                        }
                        let lanes = fixed.members.len().min(from + L::WIDTH) - from;
                        let out = Lane::split(l, &sums, pairs.rr, fixed.axis);
                        for (&first, lane) in fixed.members[from..].iter().zip(&out[..lanes]) {
                            let at = second * self.potential.fixed.len() + first;
                            self.out[at] = if lane.square < far.near() {
                                let moving = &self.potential.moving[second].block;
                                let moved = moving.moved(cos, sin, self.q.position());
                                block::near::<L, SLOPE>(
                                    l,
                                    &self.potential.fixed[first].block,
                                    &moved,
                                )
                            } else {
                                lane.pair
                            };
                        }
                    }
                }
            }
        }
    }
}

/// One of several pairs, and the square of its distance (m^2).
#[derive(Clone, Copy, Default)]
struct Lane {
    pair: PairEnergy,
    square: f64,
}

impl Lane {
    #[inline(always)]
    fn split<L: Lanes>(
        l: L,
        sums: &Sums<L::F>,
        squares: L::F,
        axis: Complex<f64>,
    ) -> [Self; MAX_WIDTH] {
        let mut columns = [[0.0; MAX_WIDTH]; 5];
        let [x, y, turn] = sums.gradient;
        for (column, values) in columns.iter_mut().zip([sums.energy, x, y, turn, squares]) {
            l.store(values, column);
        }
        let scale = -MU0 / (4.0 * std::f64::consts::PI);
        std::array::from_fn(|i| {
            let gradient = axis * Complex::new(columns[1][i], columns[2][i]) * scale;
            Self {
                pair: PairEnergy {
                    energy: columns[0][i] * scale,
                    gradient: Vector2::new(gradient.re, gradient.im),
                    slope: columns[3][i] * scale,
                },
                square: columns[4][i],
            }
        })
    }
}
