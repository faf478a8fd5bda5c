//! The sum over the pairs of two groups of magnets, far ones in lanes.

use nalgebra::{Complex, Vector2, Vector3};

use super::complex::Z;
use super::near::exact;
use super::series::Coefficients;
use super::{Body, Group, Pairs};
use crate::configuration::Configuration;
use crate::potential::simd::Level;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};
use crate::units::MU0_OVER_4PI;

/// The place (m) of members that only fill the last vector: so far away that nothing overflows, and
/// without a moment.
const AWAY: f64 = 1e9;

/// Places (m) and moments (A m^2), filled up to whole vectors.
#[derive(Clone, Debug, Default)]
pub struct Members {
    count: usize,
    x: Vec<f64>,
    y: Vec<f64>,
    moment: Vec<f64>,
    /// Their numbers in their tile.
    pub numbers: Vec<usize>,
}

impl Members {
    pub fn push(&mut self, number: usize, place: Vector2<f64>, moment: f64) {
        if self.count == self.x.len() {
            let whole = self.count + WIDTH;
            self.x.resize(whole, AWAY);
            self.y.resize(whole, AWAY);
            self.moment.resize(whole, 0.0);
        }
        let at = self.count;
        (self.x[at], self.y[at], self.moment[at]) = (place.x, place.y, moment);
        self.numbers.push(number);
        self.count += 1;
    }

    /// The place (m) and moment (A m^2) of one.
    pub fn at(&self, i: usize) -> (Vector2<f64>, f64) {
        (Vector2::new(self.x[i], self.y[i]), self.moment[i])
    }

    /// The members themselves.
    pub fn iter(&self) -> impl Iterator<Item = (Vector2<f64>, f64)> {
        (0..self.count).map(|i| self.at(i))
    }
}

/// The sum over the pairs of two groups (J), its gradient by the moving tile's place (J/m) and turn
/// (J/rad), if requested; `turned` is the second group's magnet in its direction.
pub fn of<const SLOPE: bool>(
    groups: [&Group; 2],
    turned: &Body,
    pairs: &Pairs,
    q: &Configuration,
) -> (f64, Vector3<f64>) {
    let (sin, cos) = libm::sincos(q.theta);
    let far = Far::<SLOPE> {
        groups,
        pairs,
        turned,
        rotation: Complex::new(cos, sin),
        centre: q.position(),
        near: Vec::new(),
    };
    let (mut energy, mut gradient, near) = Level::best().run(far);
    let [first, second] = groups;
    for [i, j] in near {
        let ((from, m1), (place, m2)) = (first.members.at(i), second.members.at(j));
        let arm = Vector2::new(cos * place.x - sin * place.y, sin * place.x + cos * place.y);
        let place = arm + q.position() - from;
        let found = match &pairs.nearby {
            Some(nearby) => nearby.at(first.like.direction, place, turned.direction),
            None => {
                let other = Body {
                    position: place,
                    ..*turned
                };
                exact(&first.like, &other)
            }
        };
        let moments = m1 * m2;
        let force = found.gradient * moments;
        energy += moments * found.energy;
        let turn = moments * found.slope + arm.perp(&force);
        gradient += Vector3::new(force.x, force.y, turn);
    }
    (energy, gradient)
}

/// The pairs that are far enough apart for the series; the others are listed.
struct Far<'a, const SLOPE: bool> {
    groups: [&'a Group; 2],
    pairs: &'a Pairs,
    turned: &'a Body,
    rotation: Complex<f64>,
    centre: Vector2<f64>,
    near: Vec<[usize; 2]>,
}

impl<const SLOPE: bool> Task for Far<'_, SLOPE> {
    type Output = (f64, Vector3<f64>, Vec<[usize; 2]>);

    #[inline(always)]
    fn run<L: Lanes>(mut self, l: L) -> Self::Output {
        let [first, second] = self.groups;
        let (axis, turned) = (first.like.direction, self.turned.direction);
        let beta = Complex::new(axis.dot(&turned), axis.perp(&turned));
        let squares = &self.pairs.squares;
        let near = squares[squares.len() - 1];
        let zero = l.splat(0.0);
        let [mut energy, mut along, mut across, mut turn] = [zero; 4];
        let mut known = Coefficients::NONE;
        for j in 0..second.members.count {
            let (place, m2) = second.members.at(j);
            let arm = self.rotation * Complex::new(place.x, place.y);
            let at = arm + Complex::new(self.centre.x, self.centre.y);
            // Along and across the first group's direction.
            let lever = [
                axis.x * arm.re + axis.y * arm.im,
                axis.x * arm.im - axis.y * arm.re,
            ];
            for from in (0..first.members.x.len()).step_by(WIDTH) {
                let dx = l.sub(l.splat(at.re), l.load(&first.members.x[from..]));
                let dy = l.sub(l.splat(at.im), l.load(&first.members.y[from..]));
                let mut square = l.mul_add(dx, dx, l.mul(dy, dy));
                let mut moments = l.mul(l.load(&first.members.moment[from..]), l.splat(m2));
                let mut least = l.least(square);
                if least < near {
                    let mut all = [0.0; WIDTH];
                    l.store(square, &mut all);
                    for (lane, square) in all.iter().enumerate() {
                        if *square < near {
                            self.near.push([from + lane, j]);
                        }
                    }
                    // The near ones have no moment here and are far enough.
                    let outside = l.sub(square, l.splat(near));
                    moments = l.select(outside, moments, zero);
                    square = l.select(outside, square, l.splat(AWAY * AWAY));
                    least = l.least(square);
                }
                let enough = squares.iter().position(|from| least >= *from);
                let terms = enough.map_or(squares.len(), |k| k + 1);
                self.pairs.series.complete::<SLOPE>(&mut known, beta, terms);
                let way = Z {
                    re: l.mul_add(l.splat(axis.x), dx, l.mul(l.splat(axis.y), dy)),
                    im: l.neg_mul_add(l.splat(axis.y), dx, l.mul(l.splat(axis.x), dy)),
                };
                let sums = known.sum::<L, SLOPE>(l, terms, way, square);
                energy = l.mul_add(moments, sums.energy, energy);
                if SLOPE {
                    let share = l.div(moments, square);
                    let (radial, angular) = (l.mul(sums.radial, share), l.mul(sums.angular, share));
                    let fx = l.neg_mul_add(way.im, angular, l.mul(way.re, radial));
                    let fy = l.mul_add(way.re, angular, l.mul(way.im, radial));
                    along = l.add(along, fx);
                    across = l.add(across, fy);
                    turn = l.mul_add(moments, sums.turn, turn);
                    let torque = l.neg_mul_add(l.splat(lever[1]), fx, l.mul(l.splat(lever[0]), fy));
                    turn = l.add(turn, torque);
                }
            }
        }
        let scale = -MU0_OVER_4PI;
        let (x, y) = (l.sum(along), l.sum(across));
        let gradient = Vector3::new(
            axis.x * x - axis.y * y,
            axis.y * x + axis.x * y,
            l.sum(turn),
        );
        (scale * l.sum(energy), gradient * scale, self.near)
    }
}
