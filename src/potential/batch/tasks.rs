//! Which numbers go in which lanes.

use nalgebra::Vector3;

use super::field::{Frame, Shares, field};
use super::lanes::{Lanes, MAX_ANGLE, Task};
use super::{DipolePotential, finite};
use crate::configuration::Configuration;

/// The most lanes any instruction set has.
const MAX_WIDTH: usize = 8;

/// The same angle, in the range of the vectors' sine and cosine.
#[inline(always)]
fn in_range(theta: f64) -> f64 {
    if theta.abs() <= MAX_ANGLE {
        theta
    } else {
        let (sin, cos) = theta.sin_cos();
        sin.atan2(cos)
    }
}

/// Up to `L::WIDTH` configurations, one in each lane; the last one fills the rest.
#[inline(always)]
fn frame_of<L: Lanes>(l: L, qs: &[Configuration]) -> Frame<L::F> {
    let mut columns = [[0.0; MAX_WIDTH]; 3];
    for lane in 0..L::WIDTH {
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

/// Adds the lanes, or whatever stands in their place, halves first.
#[inline(always)]
fn fold<T: Copy>(width: usize, values: &mut [T; MAX_WIDTH], add: impl Fn(T, T) -> T) -> T {
    let mut width = width / 2;
    while width > 0 {
        for i in 0..width {
            values[i] = add(values[i], values[i + width]);
        }
        width /= 2;
    }
    values[0]
}

/// One configuration, the moving dipoles in the lanes.
pub struct One<'a, const SLOPE: bool> {
    pub potential: &'a DipolePotential,
    pub q: &'a Configuration,
}

impl<const SLOPE: bool> One<'_, SLOPE> {
    #[inline(always)]
    fn block<L: Lanes, const N: usize>(
        &self,
        l: L,
        frame: &Frame<L::F>,
        first: usize,
        shares: &mut Shares<L::F>,
    ) {
        let moving = &self.potential.moving;
        let at = |values: &[f64], k: usize| l.load(&values[first + k * L::WIDTH..]);
        let mut place = [[l.splat(0.0); 2]; N];
        for (k, place) in place.iter_mut().enumerate() {
            *place = frame.place(l, [at(&moving.x, k), at(&moving.y, k)]);
        }
        let fields = field::<L, N, SLOPE>(l, &self.potential.fixed, place);
        for (k, (place, field)) in place.iter().zip(&fields).enumerate() {
            let moment = [at(&moving.moment_x, k), at(&moving.moment_y, k)];
            shares.gather::<L, SLOPE>(l, frame, moment, *place, field);
        }
    }
}

impl<const SLOPE: bool> Task for One<'_, SLOPE> {
    type Output = (f64, Vector3<f64>);

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let frame = frame_of(l, std::slice::from_ref(self.q));
        let mut shares = Shares::zero(l);
        let length = self.potential.moving.x.len();
        let mut first = 0;
        while first + 2 * L::WIDTH <= length {
            self.block::<L, 2>(l, &frame, first, &mut shares);
            first += 2 * L::WIDTH;
        }
        if first < length {
            self.block::<L, 1>(l, &frame, first, &mut shares);
        }
        let sums = shares.to_array().map(|lanes| {
            let mut values = [0.0; MAX_WIDTH];
            l.store(lanes, &mut values);
            l.splat(fold(L::WIDTH, &mut values, |a, b| a + b))
        });
        let (energy, gradient) = Shares::from_array(sums).finish(l, &frame);
        let first = |lanes| {
            let mut values = [0.0; MAX_WIDTH];
            l.store(lanes, &mut values);
            values[0]
        };
        finite(first(energy), Vector3::from(gradient.map(first)))
    }
}

/// Many configurations, one in each lane; `put` takes a configuration's place, energy and
/// gradient.
pub struct Many<'a, P, const SLOPE: bool> {
    pub potential: &'a DipolePotential,
    pub qs: &'a [Configuration],
    pub put: P,
}

impl<P, const SLOPE: bool> Many<'_, P, SLOPE> {
    /// The shares of the moving dipoles `first` and `first + 1`.
    #[inline(always)]
    fn two<L: Lanes>(
        &self,
        l: L,
        frame: &Frame<L::F>,
        first: usize,
        shares: &mut [Shares<L::F>; 2],
    ) {
        let moving = &self.potential.moving;
        let at = |values: &[f64], k: usize| l.splat(values[first + k]);
        let place = [0, 1].map(|k| frame.place(l, [at(&moving.x, k), at(&moving.y, k)]));
        let fields = field::<L, 2, SLOPE>(l, &self.potential.fixed, place);
        for k in 0..2 {
            let moment = [at(&moving.moment_x, k), at(&moving.moment_y, k)];
            shares[k].gather::<L, SLOPE>(l, frame, moment, place[k], &fields[k]);
        }
    }
}

impl<P, const SLOPE: bool> Task for Many<'_, P, SLOPE>
where
    P: FnMut(usize, f64, Vector3<f64>),
{
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, l: L) {
        let count = self.potential.moving.count;
        for (block, qs) in self.qs.chunks(L::WIDTH).enumerate() {
            let frame = frame_of(l, qs);
            // Entry k sums the dipoles that lane k has where the dipoles are in the lanes.
            let mut shares = [Shares::zero(l); MAX_WIDTH];
            for lane in (0..L::WIDTH.min(count)).step_by(2) {
                let mut pair = [Shares::zero(l); 2];
                for first in (lane..count).step_by(L::WIDTH) {
                    self.two(l, &frame, first, &mut pair);
                }
                shares[lane..lane + 2].copy_from_slice(&pair);
            }
            let sum = fold(L::WIDTH, &mut shares, |a, b| a.add(l, b));
            let (energy, gradient) = sum.finish(l, &frame);

            let mut columns = [[0.0; MAX_WIDTH]; 4];
            l.store(energy, &mut columns[0]);
            for (column, lanes) in columns[1..].iter_mut().zip(gradient) {
                l.store(lanes, column);
            }
            for lane in 0..qs.len() {
                let [energy, x, y, turn] = columns.map(|column| column[lane]);
                let (energy, gradient) = finite(energy, Vector3::new(x, y, turn));
                (self.put)(block * L::WIDTH + lane, energy, gradient);
            }
        }
    }
}

/// [`DipolePotential::curvature_bound`], the moving dipoles in the lanes.
pub struct Curvature<'a> {
    pub potential: &'a DipolePotential,
    pub q: &'a Configuration,
    pub reach: f64,
}

impl Task for Curvature<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> f64 {
        let DipolePotential { moving, lever, .. } = self.potential;
        let frame = frame_of(l, std::slice::from_ref(self.q));
        let turn = if *lever > 0.0 { 1.0 / lever } else { 0.0 };
        let reach = l.splat(self.reach);
        let (mut sum, mut nearest) = (l.splat(0.0), l.splat(f64::INFINITY));
        for first in (0..moving.x.len()).step_by(L::WIDTH) {
            let at = |values: &[f64]| l.load(&values[first..]);
            let place = frame.place(l, [at(&moving.x), at(&moving.y)]);
            let mut share = l.splat(0.0);
            for source in &self.potential.fixed {
                let d = [
                    l.sub(place[0], l.splat(source.position[0])),
                    l.sub(place[1], l.splat(source.position[1])),
                ];
                let r2 = l.mul_add(d[0], d[0], l.mul(d[1], d[1]));
                let r = l.neg_mul_add(l.splat(1.0), reach, l.mul(r2, l.reciprocal_sqrt(r2)));
                nearest = l.min(r, nearest);
                let w1 = l.reciprocal_sqrt(l.mul(r, r));
                let w2 = l.mul(w1, w1);
                let p = l.mul_add(l.splat(24.0), w1, l.splat(18.0 * turn));
                let p = l.mul_add(p, w1, l.splat(2.0 * turn * turn));
                share = l.mul_add(l.mul(l.mul(w1, w2), p), l.splat(source.magnitude), share);
            }
            sum = l.mul_add(share, at(&moving.magnitude), sum);
        }
        let fold = |lanes, op: fn(f64, f64) -> f64| {
            let mut values = [0.0; MAX_WIDTH];
            l.store(lanes, &mut values);
            fold(L::WIDTH, &mut values, op)
        };
        let bound = fold(sum, |a, b| a + b);
        if fold(nearest, f64::min) > 0.0 && bound.is_finite() {
            bound
        } else {
            f64::INFINITY
        }
    }
}
