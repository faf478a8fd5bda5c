//! The pairs of two tiles' magnets one by one, as bounds over cells need them.

use std::cell::RefCell;

use nalgebra::{Complex, Vector2};

use super::near::exact;
use super::{Alike, Body, BodyPotential, Pairs};
use crate::configuration::Configuration;
use crate::potential::far::PairEnergy;
use crate::potential::far::derivatives::{AngleDerivatives, AtPlace, Derivatives};
use crate::potential::far::rows::{Facing, Known, Lane, Several};
use crate::potential::simd::Level;
use crate::potential::simd::lanes::{Lanes, Task};

/// Two magnets that both lie or both stand.
pub(in crate::potential) struct Single<'a> {
    /// Their numbers in the two tiles.
    pub numbers: [usize; 2],
    pub first: Body,
    pub second: Body,
    /// Their energy by all terms of the series that are summed, and whether they are so far apart that it is exact.
    pub series: PairEnergy,
    pub is_far: bool,
    pairs: &'a Pairs,
    coefficients: &'a RefCell<SharedSeries>,
}

/// The coefficients of the series of two groups: at the angle between them, which all of their pairs share,
/// and at another one.
struct SharedSeries {
    still: Known,
    turned: Known,
    /// Derivatives at the former.
    derivatives: AngleDerivatives,
}

impl SharedSeries {
    fn none() -> Self {
        Self {
            still: Known::none(),
            turned: Known::none(),
            derivatives: AngleDerivatives::none(),
        }
    }

    /// Forgets what was of another angle.
    fn forget(&mut self) {
        self.still.forget();
        self.derivatives.forget();
    }
}

impl Single<'_> {
    /// The energy.
    pub fn still(&self) -> PairEnergy {
        match self.is_far {
            true => self.series,
            false => exact(&self.first, &self.second),
        }
    }

    /// The energies with the second magnet moved in several ways (m), and turned about its centre (rad).
    pub fn moved<const N: usize>(&self, ways: [Vector2<f64>; N], turn: f64) -> [PairEnergy; N] {
        let (sin, cos) = libm::sincos(turn);
        let turned = self.second.moved([cos, sin], Vector2::zeros());
        let places = ways.map(|way| self.second.position + way);
        let ways = places.map(|place| place - self.first.position);
        let far = &self.pairs.far;
        if ways.iter().all(|way| way.norm_squared() >= far.near()) {
            let SharedSeries {
                still,
                turned: other,
                ..
            } = &mut *self.coefficients.borrow_mut();
            let known = match turn == 0.0 {
                true => still,
                false => {
                    other.forget();
                    other
                }
            };
            return Level::best().run(Several {
                form: far,
                known,
                axes: [self.first.direction, turned.direction].map(complex),
                moments: self.first.moment * self.second.moment,
                ways: ways.map(complex),
            });
        }
        places.map(|position| exact(&self.first, &Body { position, ..turned }))
    }

    /// Second and third derivatives of this many terms of the series.
    pub fn derivatives(&self, terms: usize) -> Derivatives {
        let axis = complex(self.first.direction);
        let turn = complex(self.second.direction) * axis.conj();
        let known = &mut self.coefficients.borrow_mut().derivatives;
        Level::best().run(AtPlace {
            coefficients: known.up_to(&self.pairs.far.series, turn, terms),
            terms,
            axis,
            way: complex(self.second.position - self.first.position),
            moments: self.first.moment * self.second.moment,
        })
    }
}

fn complex(v: Vector2<f64>) -> Complex<f64> {
    Complex::new(v.x, v.y)
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
        let (sin, cos) = libm::sincos(q.theta);
        let coefficients = RefCell::new(SharedSeries::none());
        for ([first, second], pairs) in self.of_groups() {
            coefficients.borrow_mut().forget();
            let turned = second.like.moved([cos, sin], Vector2::zeros());
            if skipped(&first.like, &turned) {
                continue;
            }
            let body = |alike: &Alike, place: Vector2<f64>, at: usize, like: &Body| Body {
                position: place,
                moment: alike.members.moment[at],
                ..*like
            };
            let mut found = |[i, j]: [usize; 2], lane: &Lane| {
                let numbers = [first.members.members[i], second.members.members[j]];
                let from = self.fixed.bodies[numbers[0]].position;
                let place = q.transform(self.moving.bodies[numbers[1]].position);
                each(&Single {
                    numbers,
                    first: body(first, from, i, &first.like),
                    second: body(second, place, j, &turned),
                    series: lane.pair,
                    is_far: lane.square >= pairs.far.near(),
                    pairs,
                    coefficients: &coefficients,
                });
            };
            let groups = [&first.members, &second.members];
            Level::best().run(Far {
                facing: Facing::new(&pairs.far, groups, q, Complex::new(cos, sin)),
                each: &mut found,
            });
        }
    }
}

/// The energies of all pairs of two groups, see [`Facing::for_each`].
struct Far<'a> {
    facing: Facing<'a>,
    each: &'a mut dyn FnMut([usize; 2], &Lane),
}

impl Task for Far<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        self.facing.for_each::<L, true>(l, self.each);
    }
}
