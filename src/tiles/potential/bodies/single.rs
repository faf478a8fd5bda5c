//! The pairs of two tiles' magnets one by one, as bounds over cells need them.

use std::cell::{Cell, RefCell};

use nalgebra::{Complex, Vector2};

use super::lying_discs;
use super::near::exact;
use super::{Alike, Body, BodyPotential, Pairs};
use crate::configuration::Configuration;
use crate::potential::far::derivatives::{AngleDerivatives, AtPlace, Derivatives};
use crate::potential::far::rows::{Facing, Known, Lane, Several};
use crate::potential::far::{PairEnergy, complex};
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
    shared: &'a SharedSeries,
}

/// What the pairs of two groups share: the coefficients of their series at the angle between them, with more
/// derivatives of these, and those at another angle.
struct SharedSeries {
    still: RefCell<Known>,
    derivatives: RefCell<AngleDerivatives>,
    turned: RefCell<Known>,
}

impl SharedSeries {
    fn none() -> Self {
        Self {
            still: RefCell::new(Known::none()),
            derivatives: RefCell::new(AngleDerivatives::none()),
            turned: RefCell::new(Known::none()),
        }
    }
}

/// What was computed last of a potential, at a turn (rad) of its moving tile. Cells that follow each other
/// often share it.
struct Last {
    potential: u64,
    theta: f64,
    groups: Vec<SharedSeries>,
}

thread_local! {
    static LAST: Cell<Option<Last>> = const { Cell::new(None) };
}

impl Last {
    /// At this turn.
    fn take(potential: &BodyPotential, theta: f64) -> Self {
        let last = LAST.take().filter(|it| it.potential == potential.number);
        let mut last = last.unwrap_or_else(|| Self {
            potential: potential.number,
            theta,
            groups: potential
                .of_groups()
                .map(|_| SharedSeries::none())
                .collect(),
        });
        if last.theta.to_bits() != theta.to_bits() {
            last.theta = theta;
            for shared in &mut last.groups {
                shared.still.get_mut().forget();
                shared.derivatives.get_mut().forget();
            }
        }
        last
    }
}

impl Single<'_> {
    /// The energy.
    pub fn still(&self) -> PairEnergy {
        match self.is_far {
            true => self.series,
            false => self.pairs.near(&self.first, &self.second),
        }
    }

    /// The energies with the second magnet moved in several ways (m), and turned about its centre (rad).
    pub fn moved<const N: usize>(&self, ways: [Vector2<f64>; N], turn: f64) -> [PairEnergy; N] {
        let (sin, cos) = libm::sincos(turn);
        let second = self.second.moved([cos, sin], Vector2::zeros());
        let places = ways.map(|way| self.second.position + way);
        let ways = places.map(|place| place - self.first.position);
        let far = &self.pairs.far;
        if ways.iter().all(|way| way.norm_squared() >= far.near()) {
            let SharedSeries { still, turned, .. } = self.shared;
            let mut known = match turn == 0.0 {
                true => still.borrow_mut(),
                false => turned.borrow_mut(),
            };
            if turn != 0.0 {
                known.forget();
            }
            return Level::best().run(Several {
                form: far,
                known: &mut known,
                axes: [self.first.direction, second.direction].map(complex),
                moments: self.first.moment * self.second.moment,
                ways: ways.map(complex),
            });
        }
        places.map(|position| exact(&self.first, &Body { position, ..second }))
    }

    /// The energy with its derivatives up to the third, of two discs that lie.
    pub fn derived(&self) -> (PairEnergy, Derivatives) {
        lying_discs::derived(&self.first, &self.second)
    }

    /// Second derivatives of this many terms of the series, and the third ones if requested, else zeros.
    pub fn derivatives<const THIRD: bool>(&self, terms: usize) -> Derivatives {
        Level::best().run(AtPlace::<THIRD> {
            series: &self.pairs.far.series,
            known: &mut self.shared.still.borrow_mut(),
            derivatives: &mut self.shared.derivatives.borrow_mut(),
            terms,
            axes: [self.first.direction, self.second.direction].map(complex),
            way: complex(self.second.position - self.first.position),
            moments: self.first.moment * self.second.moment,
        })
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
        let (sin, cos) = libm::sincos(q.theta);
        let last = Last::take(self, q.theta);
        for (([first, second], pairs), shared) in self.of_groups().zip(&last.groups) {
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
                    shared,
                });
            };
            let groups = [&first.members, &second.members];
            Level::best().run(Far {
                facing: Facing::new(&pairs.far, groups, q, Complex::new(cos, sin)),
                known: &shared.still,
                each: &mut found,
            });
        }
        LAST.set(Some(last));
    }
}

/// The energies of all pairs of two groups, see [`Facing::for_each`].
struct Far<'a> {
    facing: Facing<'a>,
    known: &'a RefCell<Known>,
    each: &'a mut dyn FnMut([usize; 2], &Lane),
}

impl Task for Far<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        self.facing.for_each::<L, true>(l, self.known, self.each);
    }
}
