//! The assignment of numbers to lanes.

use std::ops::Range;

use nalgebra::Vector3;

use super::DipolePotential;
use super::field::{FieldDipole, Frame, Shares, field, pair_of};
use crate::configuration::Configuration;
use crate::potential::finite;
use crate::potential::groups::walk::{Leeway, Walk};
use crate::potential::simd::lanes::{Lanes, MAX_ANGLE, Task, WIDTH};

/// The same angle, in the range of the vectors' sine and cosine.
#[inline(always)]
fn in_range(theta: f64) -> f64 {
    #[cold]
    fn reduced(theta: f64) -> f64 {
        libm::atan2(libm::sin(theta), libm::cos(theta))
    }
    if theta.abs() <= MAX_ANGLE {
        theta
    } else {
        reduced(theta)
    }
}

/// One configuration in all lanes.
#[inline(always)]
pub fn frame_of_one<L: Lanes>(l: L, q: &Configuration) -> Frame<L::F> {
    let (sin, cos) = l.sin_cos(l.splat(in_range(q.theta)));
    Frame {
        cos,
        sin,
        x: l.splat(q.x),
        y: l.splat(q.y),
    }
}

/// Up to [`WIDTH`] configurations, one in each lane; the last one fills the rest.
#[inline(always)]
fn frame_of_many<L: Lanes>(l: L, qs: &[Configuration]) -> Frame<L::F> {
    let mut columns = [[0.0; WIDTH]; 3];
    for lane in 0..WIDTH {
        let q = &qs[lane.min(qs.len() - 1)];
        columns[0][lane] = q.x;
        columns[1][lane] = q.y;
        columns[2][lane] = in_range(q.theta);
    }
    let (sin, cos) = l.sin_cos(l.load(&columns[2]));
    Frame {
        cos,
        sin,
        x: l.load(&columns[0]),
        y: l.load(&columns[1]),
    }
}

/// One configuration, the moving dipoles in the lanes.
pub struct One<'a, const SLOPE: bool> {
    pub potential: &'a DipolePotential,
    pub q: &'a Configuration,
}

impl<const SLOPE: bool> One<'_, SLOPE> {
    /// The sums of some moving dipoles, in whole vectors, with some of the fixed ones.
    #[inline(always)]
    fn meet<L: Lanes>(
        &self,
        l: L,
        frame: &Frame<L::F>,
        sources: &[FieldDipole],
        moving: Range<usize>,
        shares: &mut Shares<L::F>,
    ) {
        let mut first = moving.start;
        while L::AT_ONCE == 2 && first + 2 * WIDTH <= moving.end {
            self.block::<L, 2>(l, frame, sources, first, shares);
            first += 2 * WIDTH;
        }
        while first < moving.end {
            self.block::<L, 1>(l, frame, sources, first, shares);
            first += WIDTH;
        }
    }

    /// The sums of `N` vectors of moving dipoles from the dipole `first` on, with some of the fixed
    /// ones.
    #[inline(always)]
    fn block<L: Lanes, const N: usize>(
        &self,
        l: L,
        frame: &Frame<L::F>,
        sources: &[FieldDipole],
        first: usize,
        shares: &mut Shares<L::F>,
    ) {
        let moving = &self.potential.moving;
        let mut places = [[l.splat(0.0); 2]; N];
        for (k, place) in places.iter_mut().enumerate() {
            let i = first + k * WIDTH;
            *place = frame.place(l, [l.load(&moving.x[i..]), l.load(&moving.y[i..])]);
        }
        let fields = field::<L, N, SLOPE>(l, sources, &places);
        for k in 0..N {
            let i = first + k * WIDTH;
            let moment = [l.load(&moving.moment_x[i..]), l.load(&moving.moment_y[i..])];
            shares.gather::<L, SLOPE>(l, frame, moment, places[k], &fields[k]);
        }
    }
}

impl<const SLOPE: bool> Task for One<'_, SLOPE> {
    type Output = (f64, Vector3<f64>);

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let frame = frame_of_one(l, self.q);
        let mut shares = Shares::zero(l);
        let (sources, all) = (&self.potential.sources, 0..self.potential.moving.x.len());
        match &self.potential.many {
            None => self.meet(l, &frame, sources, all, &mut shares),
            Some(many) => {
                let [fixed, moving] = &many.groups;
                for meeting in Walk::new([fixed, moving], self.q, Leeway::default()) {
                    let sources = &sources[meeting.fixed];
                    self.meet(l, &frame, sources, meeting.moving, &mut shares);
                }
            }
        }
        summed(l, &frame, shares)
    }
}

/// The energy of one configuration and its gradient, summed over the lanes.
#[inline(always)]
pub fn summed<L: Lanes>(l: L, frame: &Frame<L::F>, shares: Shares<L::F>) -> (f64, Vector3<f64>) {
    let mut sums = shares.to_array();
    for sum in &mut sums {
        *sum = l.splat(l.sum(*sum));
    }
    let (energy, slope) = Shares::from_array(sums).finish(l, frame);
    let slope = Vector3::new(l.first(slope[0]), l.first(slope[1]), l.first(slope[2]));
    finite(l.first(energy), slope)
}

/// Many configurations, one in each lane; `put` takes a configuration's place, energy and
/// gradient.
pub struct InLanes<'a, P, const SLOPE: bool> {
    pub potential: &'a DipolePotential,
    pub qs: &'a [Configuration],
    pub put: P,
}

impl<P, const SLOPE: bool> InLanes<'_, P, SLOPE> {
    /// The sums of `N` moving dipoles from `first` on.
    #[inline(always)]
    fn some<L: Lanes, const N: usize>(
        &self,
        l: L,
        frame: &Frame<L::F>,
        first: usize,
        shares: &mut [Shares<L::F>],
    ) {
        let moving = &self.potential.moving;
        let mut places = [[l.splat(0.0); 2]; N];
        for (k, place) in places.iter_mut().enumerate() {
            let i = first + k;
            *place = frame.place(l, pair_of(l, [moving.x[i], moving.y[i]]));
        }
        let fields = field::<L, N, SLOPE>(l, &self.potential.sources, &places);
        for (k, shares) in shares.iter_mut().enumerate().take(N) {
            let i = first + k;
            let moment = pair_of(l, [moving.moment_x[i], moving.moment_y[i]]);
            shares.gather::<L, SLOPE>(l, frame, moment, places[k], &fields[k]);
        }
    }

    /// The sums of all moving dipoles, added in the order of [`One`]: first those that it has in
    /// the same lane, then by halves.
    #[inline(always)]
    fn all<L: Lanes>(&self, l: L, frame: &Frame<L::F>) -> Shares<L::F> {
        let count = self.potential.moving.count;
        let mut shares = [Shares::zero(l); WIDTH];
        for lane in (0..WIDTH.min(count)).step_by(L::AT_ONCE) {
            for first in (lane..count).step_by(WIDTH) {
                let shares = &mut shares[lane..];
                match L::AT_ONCE {
                    1 => self.some::<L, 1>(l, frame, first, shares),
                    _ => self.some::<L, 2>(l, frame, first, shares),
                }
            }
        }
        let mut width = WIDTH / 2;
        while width > 0 {
            for i in 0..width {
                shares[i] = shares[i].add(l, shares[i + width]);
            }
            width /= 2;
        }
        shares[0]
    }
}

impl<P, const SLOPE: bool> Task for InLanes<'_, P, SLOPE>
where
    P: FnMut(usize, f64, Vector3<f64>),
{
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, l: L) {
        for (block, qs) in self.qs.chunks(WIDTH).enumerate() {
            let frame = frame_of_many(l, qs);
            let (energy, slope) = self.all(l, &frame).finish(l, &frame);
            let mut columns = [[0.0; WIDTH]; 4];
            l.store(energy, &mut columns[0]);
            if SLOPE {
                l.store(slope[0], &mut columns[1]);
                l.store(slope[1], &mut columns[2]);
                l.store(slope[2], &mut columns[3]);
            }
            let [energy, x, y, turn] = &columns;
            for lane in 0..qs.len() {
                let slope = Vector3::new(x[lane], y[lane], turn[lane]);
                let (energy, slope) = finite(energy[lane], slope);
                (self.put)(block * WIDTH + lane, energy, slope);
            }
        }
    }
}
