//! The sum over the pairs of two groups by their series, in vectors; pairs that are too close are listed.

use std::cell::RefCell;
use std::ops::Range;

use nalgebra::{Complex, Vector2};

use super::group::Group;
use super::multipole::{Coefficients, Multipole};
use super::terms::{Pairs, STEPS, Sums, add_terms};
use super::{FarForm, PairEnergy};
use crate::configuration::Configuration;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};
use crate::units::MU0_OVER_4PI;

/// Two groups at a configuration, in the frame whose x axis is the direction of the fixed ones.
pub struct Facing<'a> {
    pub form: &'a FarForm,
    /// Of the fixed and of the moving tile.
    pub groups: [&'a Group; 2],
    /// e^(i times the angle from the fixed ones' direction to that of the moving ones).
    pub turn: Complex<f64>,
    /// The moving tile's place (m).
    pub centre: Complex<f64>,
}

impl<'a> Facing<'a> {
    /// At a configuration with this rotation.
    #[inline(always)]
    pub fn new(
        form: &'a FarForm,
        groups: [&'a Group; 2],
        q: &Configuration,
        rotation: Complex<f64>,
    ) -> Self {
        let into = groups[0].axis.conj();
        Self {
            form,
            groups,
            turn: groups[1].axis * rotation * into,
            centre: Complex::new(q.x, q.y) * into,
        }
    }
}

/// The pair of magnets with the greatest `|m1 m2| / r^3`: the smallest of its powers -2/3, in lanes.
pub struct Strongest<F>(F);

impl<F: Copy> Strongest<F> {
    #[inline(always)]
    pub fn new<L: Lanes<F = F>>(l: L) -> Self {
        Self(l.splat(f64::MAX))
    }

    /// `|m1 m2| / r^3` (A^2 m).
    #[inline(always)]
    pub fn value<L: Lanes<F = F>>(self, l: L) -> f64 {
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
    /// The place of the first fixed magnet in its group, and of the moving one.
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
pub struct Known {
    coefficients: Coefficients,
    terms: usize,
    sizes: [usize; 2],
    axes: [Complex<f64>; 2],
}

impl Known {
    pub fn none() -> Self {
        Self {
            coefficients: Coefficients::NONE,
            terms: 0,
            sizes: [0; 2],
            axes: [Complex::new(0.0, 0.0); 2],
        }
    }

    /// Forgets all, as at another angle.
    pub fn forget(&mut self) {
        self.terms = 0;
    }

    /// Forgets what does not apply to these groups.
    fn look_at(&mut self, groups: [&Group; 2]) {
        let (sizes, axes) = (groups.map(|it| it.size), groups.map(|it| it.axis));
        if sizes != self.sizes || axes != self.axes {
            self.terms = 0;
            (self.sizes, self.axes) = (sizes, axes);
        }
    }

    /// The coefficients of this many terms for `turn`, to which all that are known apply.
    #[inline(always)]
    pub fn up_to<L: Lanes, const SLOPE: bool>(
        &mut self,
        l: L,
        series: &Multipole,
        turn: Complex<f64>,
        terms: usize,
    ) -> &Coefficients {
        if self.terms < terms {
            series.evaluate::<L, SLOPE>(l, turn, self.terms..terms, &mut self.coefficients);
            self.terms = terms;
        }
        &self.coefficients
    }
}

impl Facing<'_> {
    /// Takes some moving magnets' pairs into account.
    #[inline(always)]
    pub fn find_strongest<L: Lanes>(
        &self,
        l: L,
        range: Range<usize>,
        strongest: &mut Strongest<L::F>,
    ) {
        let Self {
            groups: [fixed, moving],
            turn,
            centre,
            ..
        } = self;
        for j in range {
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

    /// Adds the pairs of some moving magnets that are far enough apart, and lists the others by their
    /// indices in the groups. `strongest` is the [value](Strongest::value) of all pairs, or 0 if each pair's
    /// error is measured by itself.
    #[inline(always)]
    pub fn add_far<L: Lanes, const SLOPE: bool>(
        &self,
        l: L,
        range: Range<usize>,
        strongest: f64,
        known: &mut Known,
        total: &mut Sums<L::F>,
        near_pairs: &mut Vec<[usize; 2]>,
    ) {
        let &Self {
            form,
            groups: [fixed, moving],
            turn,
            centre,
        } = self;
        let steps = form.steps(strongest / (fixed.strongest * moving.strongest));
        // Faces never reach farther than for a single pair.
        let near = steps[STEPS.len() - 1].min(form.near());
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
                let terms = form.terms(steps, row.least);
                let coefficients = known.up_to::<L, SLOPE>(l, &form.series, turn, terms);
                add_terms::<L, SLOPE>(l, terms, coefficients, &row.pairs, &mut sums);
            }
        }
        total.add::<L, SLOPE>(l, &sums, fixed.axis);
    }

    /// Calls `each` with all pairs by their series and their indices in the groups, those first that need most terms,
    /// given what is known at the angle between both groups. Those [nearer](FarForm::near) than it reaches are wrong.
    /// Derivatives are zero unless requested.
    #[inline(always)]
    pub fn for_each<L: Lanes, const SLOPE: bool>(
        &self,
        l: L,
        known: &RefCell<Known>,
        mut each: impl FnMut([usize; 2], &Lane),
    ) {
        let &Self {
            form,
            groups: [fixed, moving],
            turn,
            ..
        } = self;
        let placed = self.by_terms();
        for some in placed.chunks(WIDTH) {
            let mut columns = [[0.0; WIDTH]; 3];
            for lane in 0..WIDTH {
                // What is left over repeats the last pair.
                let Placed { way, at: [i, j] } = some[lane.min(some.len() - 1)];
                columns[0][lane] = way.re;
                columns[1][lane] = way.im;
                columns[2][lane] = moving.moment[j] * fixed.moment[i];
            }
            let [x, y, moments] = &columns;
            let pairs = Pairs::between(l, [l.load(x), l.load(y)], l.load(moments));
            let lanes =
                form.alone::<L, SLOPE>(l, (fixed.axis, turn), &pairs, &mut known.borrow_mut());
            for (placed, found) in some.iter().zip(&lanes) {
                each(placed.at, found);
            }
        }
    }

    /// All pairs, first those that need [many terms](MANY), so that few others share a vector with them.
    fn by_terms(&self) -> Vec<Placed> {
        let [fixed, moving] = self.groups;
        let close = self.form.squares[MANY];
        let mut all = Vec::with_capacity(fixed.count * moving.count);
        let mut apart = Vec::with_capacity(fixed.count * moving.count);
        for j in 0..moving.count {
            let place = self.centre + self.turn * Complex::new(moving.x[j], moving.y[j]);
            for i in 0..fixed.count {
                let way = place - Complex::new(fixed.x[i], fixed.y[i]);
                let list = match way.norm_sqr() < close {
                    true => &mut all,
                    false => &mut apart,
                };
                list.push(Placed { way, at: [i, j] });
            }
        }
        all.append(&mut apart);
        all
    }
}

/// More than this one of [`STEPS`] are many terms.
const MANY: usize = 4;

/// A pair of two groups: the vector (m) between them, and their indices.
#[derive(Clone, Copy)]
struct Placed {
    way: Complex<f64>,
    at: [usize; 2],
}

impl FarForm {
    /// Pairs by their series, each by itself, given the direction of the first magnets and by how much the
    /// second ones are turned from it. Derivatives are zero unless requested.
    #[inline(always)]
    fn alone<L: Lanes, const SLOPE: bool>(
        &self,
        l: L,
        (axis, turn): (Complex<f64>, Complex<f64>),
        pairs: &Pairs<L::F>,
        known: &mut Known,
    ) -> [Lane; WIDTH] {
        let terms = self.terms(&self.squares, l.least(pairs.rr));
        let coefficients = known.up_to::<L, SLOPE>(l, &self.series, turn, terms);
        let mut sums = Sums::zero(l);
        add_terms::<L, SLOPE>(l, terms, coefficients, pairs, &mut sums);
        Lane::split(l, &sums, pairs.rr, axis)
    }
}

/// Two magnets by their series, the second at several places.
pub struct Several<'a, const N: usize> {
    pub form: &'a FarForm,
    /// The coefficients that are known for these directions.
    pub known: &'a mut Known,
    /// Their directions.
    pub axes: [Complex<f64>; 2],
    /// The product of their moments (A^2 m^4).
    pub moments: f64,
    /// From the first to the second (m); no more than there are lanes.
    pub ways: [Complex<f64>; N],
}

impl<const N: usize> Task for Several<'_, N> {
    type Output = [PairEnergy; N];

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let into = self.axes[0].conj();
        let ways: [_; WIDTH] = std::array::from_fn(|lane| self.ways[lane.min(N - 1)] * into);
        let r = [ways.map(|way| way.re), ways.map(|way| way.im)].map(|all| l.load(&all));
        let pairs = Pairs::between(l, r, l.splat(self.moments));
        let turned = (self.axes[0], self.axes[1] * into);
        let lanes = self.form.alone::<L, true>(l, turned, &pairs, self.known);
        std::array::from_fn(|lane| lanes[lane].pair)
    }
}

/// One of several pairs, and the square of its distance (m^2).
#[derive(Clone, Copy, Default)]
pub struct Lane {
    pub pair: PairEnergy,
    pub square: f64,
}

impl Lane {
    #[inline(always)]
    pub fn split<L: Lanes>(
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
