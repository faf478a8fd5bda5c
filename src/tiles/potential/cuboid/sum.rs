//! The sum over all pairs of blocks at one configuration.

use std::ops::Range;

use nalgebra::{Complex, Vector2, Vector3};

use super::block::{BlockPair, PairEnergy};
use super::far::{self, Group, Pairs, STEPS, Sums};
use super::multipole::{Coefficients, TERMS};
use super::panel::{self, Near};
use super::table::{self, Field};
use super::{CuboidPotential, Far};
use crate::configuration::Configuration;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};
use crate::units::MU0_OVER_4PI;

/// The energy at a configuration, and its gradient if requested (otherwise zero).
pub struct Sum<'a, const SLOPE: bool> {
    pub potential: &'a CuboidPotential,
    pub q: &'a Configuration,
}

impl<const SLOPE: bool> Task for Sum<'_, SLOPE> {
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

impl<const SLOPE: bool> Sum<'_, SLOPE> {
    /// The sum over all pairs of groups.
    #[inline(always)]
    fn over_groups<L: Lanes>(&self, l: L, rotation: Complex<f64>) -> (f64, Vector3<f64>) {
        let [all_fixed, all_moving] = [&self.potential.fixed_groups, &self.potential.moving_groups];
        let mut strongest = Strongest::new(l);
        for moving in all_moving {
            for fixed in all_fixed {
                self.find_strongest(l, &Members::all([fixed, moving]), rotation, &mut strongest);
            }
        }
        let context = (rotation, strongest.value(l));
        let mut sums = Sums::zero(l);
        let (mut known, mut near) = (Known::none(), Vec::new());
        let (mut energy, mut gradient) = (0.0, Vector3::zeros());
        for moving in all_moving {
            for fixed in all_fixed {
                let members = Members::all([fixed, moving]);
                self.add_far(l, &members, context, &mut known, &mut sums, &mut near);
                let groups = [fixed, moving];
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
        field: &Field,
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
                    let some = Members::one([fixed, moving], j);
                    self.find_strongest(l, &some, rotation, &mut strongest);
                }
                patches.push((arm, patch));
            }
        }
        let context = (rotation, strongest.value(l));
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
                    let some = Members::one([fixed, moving], j);
                    self.add_far(l, &some, context, &mut known, &mut sums, &mut near);
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

/// A group of fixed blocks, and some blocks of a group of moving ones.
struct Members<'a> {
    fixed: &'a Group,
    moving: &'a Group,
    range: Range<usize>,
}

impl<'a> Members<'a> {
    fn all([fixed, moving]: [&'a Group; 2]) -> Self {
        Self {
            fixed,
            moving,
            range: 0..moving.count,
        }
    }

    fn one([fixed, moving]: [&'a Group; 2], j: usize) -> Self {
        Self {
            fixed,
            moving,
            range: j..j + 1,
        }
    }
}

/// The pair of blocks with the greatest `|m1 m2| / r^3`: the smallest of its powers -2/3, in lanes.
struct Strongest<F>(F);

impl<F: Copy> Strongest<F> {
    #[inline(always)]
    fn new<L: Lanes<F = F>>(l: L) -> Self {
        Self(l.splat(f64::MAX))
    }

    /// `|m1 m2| / r^3` (A^2 m).
    #[inline(always)]
    fn value<L: Lanes<F = F>>(self, l: L) -> f64 {
        let least = l.least(self.0);
        1.0 / (least * least.sqrt())
    }
}

/// How many vectors of pairs are placed before they are summed, so that a processor has some of
/// them to work on while it waits for others.
const AHEAD: usize = 4;

/// A vector of pairs of two groups.
#[derive(Clone, Copy)]
struct Row<F> {
    pairs: Pairs<F>,
    /// The least squared distance (m^2).
    least: f64,
    /// The place of the first fixed block in its group, and of the moving one.
    at: [usize; 2],
}

impl<F: Copy> Row<F> {
    /// Lists the pairs closer than this squared distance (m^2) instead of counting them.
    #[inline(always)]
    fn leave_out<L: Lanes<F = F>>(&mut self, l: L, near: f64, list: &mut Vec<[usize; 2]>) {
        let mut squares = [0.0; WIDTH];
        l.store(self.pairs.rr, &mut squares);
        self.least = f64::MAX;
        for (lane, square) in squares.into_iter().enumerate() {
            if square < near {
                list.push([self.at[0] + lane, self.at[1]]);
            } else {
                self.least = self.least.min(square);
            }
        }
        let outside = l.sub(self.pairs.rr, l.splat(near));
        self.pairs.inverse = l.select(outside, self.pairs.inverse, l.splat(0.0));
    }
}

/// Coefficients of the far form that are computed, for two groups and those of the same kinds.
struct Known {
    coefficients: Coefficients,
    terms: usize,
    sizes: [usize; 2],
    axes: [Complex<f64>; 2],
}

impl Known {
    fn none() -> Self {
        Self {
            coefficients: Coefficients::NONE,
            terms: 0,
            sizes: [0; 2],
            axes: [Complex::new(0.0, 0.0); 2],
        }
    }

    /// Forgets what does not apply to these groups.
    fn look_at(&mut self, groups: [&Group; 2]) {
        let (sizes, axes) = (groups.map(|it| it.size), groups.map(|it| it.axis));
        if sizes != self.sizes || axes != self.axes {
            self.terms = 0;
            (self.sizes, self.axes) = (sizes, axes);
        }
    }
}

impl<const SLOPE: bool> Sum<'_, SLOPE> {
    /// Takes the pairs of two groups into account.
    #[inline(always)]
    fn find_strongest<L: Lanes>(
        &self,
        l: L,
        Members {
            fixed,
            moving,
            range,
        }: &Members,
        rotation: Complex<f64>,
        strongest: &mut Strongest<L::F>,
    ) {
        let (_, turn, centre) = self.potential.facing([fixed, moving], self.q, rotation);
        for j in range.clone() {
            let place = centre + turn * Complex::new(moving.x[j], moving.y[j]);
            let (x, y) = (l.splat(place.re), l.splat(place.im));
            let weakness = l.splat(moving.weakness[j]);
            for from in (0..fixed.x.len()).step_by(WIDTH) {
                let dx = l.sub(x, l.load(&fixed.x[from..]));
                let dy = l.sub(y, l.load(&fixed.y[from..]));
                let square = l.mul_add(dx, dx, l.mul(dy, dy));
                let weakness = l.mul(weakness, l.load(&fixed.weakness[from..]));
                strongest.0 = l.min(strongest.0, l.mul(square, weakness));
            }
        }
    }

    /// Adds the pairs of two groups that are far enough apart, and lists the others by their
    /// indices in the groups.
    #[inline(always)]
    fn add_far<L: Lanes>(
        &self,
        l: L,
        Members {
            fixed,
            moving,
            range,
        }: &Members,
        (rotation, strongest): (Complex<f64>, f64),
        known: &mut Known,
        total: &mut Sums<L::F>,
        near_pairs: &mut Vec<[usize; 2]>,
    ) {
        let (far, turn, centre) = self.potential.facing([fixed, moving], self.q, rotation);
        let steps = far.steps(strongest / (fixed.strongest * moving.strongest));
        // Pole faces never reach farther than for a single pair.
        let near = steps[STEPS.len() - 1].min(far.near());
        let mut sums = Sums::zero(l);
        known.look_at([fixed, moving]);
        let mut rows = [None; AHEAD];
        let (mut j, mut from) = (range.start, 0);
        let mut left = range.len() * (fixed.x.len() / WIDTH);
        while left > 0 {
            let count = left.min(AHEAD);
            left -= count;
            for row in &mut rows[..count] {
                let arm = turn * Complex::new(moving.x[j], moving.y[j]);
                let mut pairs = Pairs::new(l, fixed, from, centre + arm, moving.moment[j]);
                pairs.arm = arm;
                let least = l.least(pairs.rr);
                let at = [from, j];
                *row = Some(Row { pairs, least, at });
                from += WIDTH;
                if from == fixed.x.len() {
                    (j, from) = (j + 1, 0);
                }
            }
            for row in rows[..count].iter_mut().flatten() {
                if row.least < near {
                    row.leave_out(l, near, near_pairs);
                }
                let terms = Far::terms(steps, row.least);
                let coefficients = &mut known.coefficients;
                if known.terms < terms {
                    far.series
                        .evaluate::<L, SLOPE>(l, turn, known.terms..terms, coefficients);
                    known.terms = terms;
                }
                far::add_terms::<L, SLOPE>(l, terms, coefficients, &row.pairs, &mut sums);
            }
        }
        total.add::<L, SLOPE>(l, &sums, fixed.axis);
    }

    /// The pairs of the blocks with these indices in two groups, by their pole faces.
    fn near(
        &self,
        [fixed, moving]: [&Group; 2],
        rotation: Complex<f64>,
        pairs: &[[usize; 2]],
    ) -> (f64, Vector3<f64>) {
        let centre = self.q.position();
        let pair = |&[i, j]: &[usize; 2]| {
            let first = fixed.block(&self.potential.fixed, i);
            let second = moving.block(&self.potential.moving, j);
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
        let mut coefficients = Coefficients::NONE;
        for moving in &self.potential.moving_groups {
            for fixed in &self.potential.fixed_groups {
                let (far, turn, centre) =
                    self.potential
                        .facing([fixed, moving], self.q, Complex::new(cos, sin));
                far.series
                    .evaluate::<L, SLOPE>(l, turn, 0..TERMS, &mut coefficients);
                for (j, &second) in moving.members.iter().enumerate() {
                    let place = centre + turn * Complex::new(moving.x[j], moving.y[j]);
                    for from in (0..fixed.x.len()).step_by(WIDTH) {
                        let pairs = Pairs::new(l, fixed, from, place, moving.moment[j]);
                        let mut sums = Sums::zero(l);
                        let terms = Far::terms(&far.squares, l.least(pairs.rr));
                        far::add_terms::<L, SLOPE>(l, terms, &coefficients, &pairs, &mut sums);
                        let lanes = fixed.members.len().min(from + WIDTH) - from;
                        let out = Lane::split(l, &sums, pairs.rr, fixed.axis);
                        for (&first, lane) in fixed.members[from..].iter().zip(&out[..lanes]) {
                            let at = second * self.potential.fixed.len() + first;
                            self.out[at] = if lane.square < far.near() {
                                let moving = &self.potential.moving[second].block;
                                let moved = moving.moved(cos, sin, self.q.position());
                                let fixed = &self.potential.fixed[first].block;
                                panel::near::<SLOPE>(self.potential.level, fixed, &moved)
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
    ) -> [Self; WIDTH] {
        let mut columns = [[0.0; WIDTH]; 5];
        let [x, y, turn] = sums.gradient;
        for (column, values) in columns.iter_mut().zip([sums.energy, x, y, turn, squares]) {
            l.store(values, column);
        }
        let scale = -MU0_OVER_4PI;
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
