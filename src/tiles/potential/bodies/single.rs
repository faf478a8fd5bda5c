//! The pairs of two tiles' magnets one by one, as bounds over cells need them.

use nalgebra::{Complex, Vector2};

use super::complex::Z;
use super::near::exact;
use super::series::{Coefficients, Sums};
use super::{Body, BodyPotential, Group, Pairs};
use crate::configuration::Configuration;
use crate::potential::cuboid::block::PairEnergy;
use crate::potential::simd::Level;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};
use crate::units::MU0_OVER_4PI;

/// Two magnets that both lie or both stand.
pub(in crate::potential) struct Single<'a> {
    /// Their numbers in the two tiles.
    pub numbers: [usize; 2],
    pub first: Body,
    pub second: Body,
    /// Their energy, if they are so far apart that the series has it.
    pub far: Option<PairEnergy>,
    pairs: &'a Pairs,
}

impl Single<'_> {
    /// The energy with the second magnet moved (m) and turned about its centre (rad).
    pub fn moved(&self, way: Vector2<f64>, turn: f64) -> PairEnergy {
        let (sin, cos) = libm::sincos(turn);
        let direction = self.second.direction;
        let second = Body {
            position: self.second.position + way,
            direction: Vector2::new(
                cos * direction.x - sin * direction.y,
                sin * direction.x + cos * direction.y,
            ),
            ..self.second
        };
        if !self
            .pairs
            .is_far((second.position - self.first.position).norm_squared())
        {
            return exact(&self.first, &second);
        }
        let (mut found, mut known) = (None, Coefficients::NONE);
        Level::best().run(Far {
            first: &self.first,
            second: &second,
            froms: &[self.first.position],
            pairs: self.pairs,
            known: &mut known,
            each: &mut |_, energy| found = energy,
        });
        let energy = found.unwrap_or_default();
        scaled(&energy, self.first.moment * self.second.moment)
    }
}

fn scaled(energy: &PairEnergy, by: f64) -> PairEnergy {
    PairEnergy {
        energy: energy.energy * by,
        gradient: energy.gradient * by,
        slope: energy.slope * by,
    }
}

impl Pairs {
    fn is_far(&self, square: f64) -> bool {
        self.squares.last().is_some_and(|least| square >= *least)
    }
}

impl BodyPotential {
    /// Calls `each` with every pair of magnets that both lie or both stand, except those that
    /// `skipped` says.
    pub(in crate::potential) fn for_each_single(
        &self,
        q: &Configuration,
        skipped: impl Fn(&Body, &Body) -> bool,
        mut each: impl FnMut(&Single),
    ) {
        self.for_each(q, |first, second, turned, pairs| {
            if skipped(&first.like, turned) {
                return;
            }
            let mut known = Coefficients::NONE;
            let froms: Vec<_> = first.members.iter().map(|(place, _)| place).collect();
            for (j, (place, m2)) in second.members.iter().enumerate() {
                let moved = Body {
                    position: q.transform(place),
                    moment: m2,
                    ..*turned
                };
                let mut found = |i: usize, energy: Option<PairEnergy>| {
                    let (from, m1) = first.members.at(i);
                    let own = Body {
                        position: from,
                        moment: m1,
                        ..first.like
                    };
                    each(&Single {
                        numbers: [number(first, i), number(second, j)],
                        first: own,
                        second: moved,
                        far: energy.map(|energy| scaled(&energy, m1 * m2)),
                        pairs,
                    });
                };
                Level::best().run(Far {
                    first: &first.like,
                    second: &moved,
                    froms: &froms,
                    pairs,
                    known: &mut known,
                    each: &mut found,
                });
            }
        });
    }
}

fn number(group: &Group, member: usize) -> usize {
    group.members.numbers[member]
}

/// The energies for moments of 1 A m^2 of like magnets at some places (m) and another one, `None` of those
/// that are too close for the series.
struct Far<'a> {
    first: &'a Body,
    second: &'a Body,
    froms: &'a [Vector2<f64>],
    pairs: &'a Pairs,
    known: &'a mut Coefficients,
    each: &'a mut dyn FnMut(usize, Option<PairEnergy>),
}

impl Task for Far<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let (axis, turned) = (self.first.direction, self.second.direction);
        let beta = Complex::new(axis.dot(&turned), axis.perp(&turned));
        for (chunk, froms) in self.froms.chunks(WIDTH).enumerate() {
            let (mut re, mut im, mut square) = ([1.0; WIDTH], [0.0; WIDTH], [1.0; WIDTH]);
            let mut terms = 0;
            for (lane, from) in froms.iter().enumerate() {
                let way = self.second.position - from;
                let r2 = way.norm_squared();
                if self.pairs.is_far(r2) {
                    (re[lane], im[lane], square[lane]) = (axis.dot(&way), axis.perp(&way), r2);
                    let enough = self.pairs.squares.iter().position(|least| r2 >= *least);
                    terms = terms.max(enough.map_or(self.pairs.squares.len(), |k| k + 1));
                }
            }
            self.pairs.series.complete::<true>(self.known, beta, terms);
            let way = Z {
                re: l.load(&re),
                im: l.load(&im),
            };
            let r2 = l.load(&square);
            let Sums {
                energy,
                radial,
                angular,
                turn,
            } = self.known.sum::<L, true>(l, terms, way, r2);
            let fx = l.neg_mul_add(way.im, angular, l.mul(way.re, radial));
            let fy = l.mul_add(way.re, angular, l.mul(way.im, radial));
            let mut all = [[0.0; WIDTH]; 4];
            for (to, from) in all
                .iter_mut()
                .zip([energy, l.div(fx, r2), l.div(fy, r2), turn])
            {
                l.store(from, to);
            }
            for (lane, from) in froms.iter().enumerate() {
                let is_far = self
                    .pairs
                    .is_far((self.second.position - from).norm_squared());
                let [energy, x, y, slope] = all.map(|it| -MU0_OVER_4PI * it[lane]);
                let found = PairEnergy {
                    energy,
                    gradient: axis * x + Vector2::new(-axis.y, axis.x) * y,
                    slope,
                };
                (self.each)(chunk * WIDTH + lane, is_far.then_some(found));
            }
        }
    }
}
