//! Pairs that are not apart enough for their series.

use nalgebra::Vector2;

use super::faces::{FaceLimits, distances};
use super::rims::Rims;
use super::{AN_ENERGY, EXACT, GRAZING, LOST, Left, Pair, ROOM, SHARED, Sum};
use crate::potential::bodies::{Body, Single};
use crate::potential::bounds::apart::Apart;
use crate::potential::far::PairEnergy;
use crate::potential::simd::Level;
use crate::tile::magnet::Shape;
use crate::units::MU0_OVER_4PI;

/// The largest and the smallest step of differences, as a share of the reach.
const STEPS: [f64; 2] = [1.0 / 16.0, 1.0 / 16384.0];
/// A form of second order takes four times as long as one of first order; it is used if its remainder is
/// this much smaller.
const WORTH: f64 = 0.6;
/// A form of third order takes twice as long as one of second order; it is used if what it leaves, with the share
/// above, is this much smaller.
const WORTH_THIRD: f64 = 0.6;

/// The same of one whose derivatives are known without differences, for discs this part of their radius apart.
const WORTH_DERIVED: f64 = 0.9;
const DERIVED_FROM: f64 = 0.02;
/// The errors of these discs' energies, as a share of those of touching magnets, and of their first, second and third
/// derivatives, as shares of their limits.
const DERIVED: [f64; 4] = [1e-9, 2e-8, 1e-6, 1e-5];

/// Limits of the derivatives of two magnets' energy by the places of the second one's points, and X (J/m^2).
#[derive(Clone, Copy, Debug)]
struct Limits {
    first: f64,
    second: f64,
    /// Along a motion through the cell (J), and for a unit of motion (J/m^3, J/m^4).
    third: [f64; 2],
    fourth: [f64; 2],
    x: f64,
}

impl Limits {
    /// Of the third and the fourth derivative by time along a motion: points move by at most v (m) and turn by
    /// w (rad), all of them at most a lever (m) from the point about which they turn; `which` as in `third`.
    ///
    /// Their accelerations are at most `b = lever w^2`. Of the fourth derivative, that of third order in two
    /// speeds and one of these is at most `third b / v + X w^2 v^2`.
    fn along(&self, which: usize, [v, w, lever]: [f64; 3]) -> [f64; 2] {
        let [first, second, x] = [self.first, self.second, self.x];
        let (third, fourth) = (self.third[which], self.fourth[which]);
        let bend = lever * w * w;
        if !third.is_finite() {
            return [third, f64::INFINITY];
        }
        [
            third + 3.0 * second * v * bend + first * bend * w,
            fourth
                + 6.0 * (third / v * bend + x * w * w * v * v)
                + second * bend * (3.0 * bend + 4.0 * v * w)
                + first * bend * w * w,
        ]
    }
}

/// What forms of higher order leave of a near pair's energy.
#[derive(Clone, Copy, Debug)]
struct Spreads {
    /// The reach (m) of the cell.
    reach: f64,
    /// The remainders of second and of third order (J).
    third: f64,
    fourth: f64,
    /// The third and the fourth derivative for a unit of motion (J/m^3, J/m^4).
    units: [f64; 2],
    /// What energies err, and what slopes err over the cell (J).
    error: f64,
    slopes: f64,
}

impl Spreads {
    /// What a form of second order leaves (J), and the step of its differences as a share of the reach: longer
    /// steps err by their third derivatives, shorter ones by the errors of slopes; the best are where both are
    /// equal.
    fn second_order(&self) -> [f64; 2] {
        let by_length = 0.5 * self.units[0] * self.reach.powi(3);
        let step = (self.slopes / by_length).sqrt().clamp(STEPS[1], STEPS[0]);
        let differences = by_length * step + self.slopes / step;
        [self.third + differences + self.error, step]
    }

    /// The same of a form of third order, but for its own terms of third order. With D the fourth derivative and
    /// h the step, third derivatives err by `D h / 3`, but for that by x, y and the turn, by `D h`; and second ones
    /// by `D h^2 / 6`: over a cell together by less than `0.4 D h v^3 (1 + h / (2 v))`.
    fn third_order(&self) -> [f64; 2] {
        let by_length = 0.4 * self.units[1] * self.reach.powi(4);
        let step = libm::cbrt(2.0 * self.slopes / by_length).clamp(STEPS[1], STEPS[0]);
        let differences =
            by_length * step * (1.0 + step / 2.0) + self.slopes * (1.0 + 1.0 / step) / step;
        [self.fourth + differences + self.error, step]
    }
}

impl Pair<'_> {
    /// Limits of all faces' derivatives if those that are `apart` (m) in the tiles' plane are at least that
    /// far apart.
    fn limits(&self, distances: &[[f64; 2]; 4], apart: impl Fn(f64) -> f64) -> Limits {
        let [first, second] = self.magnets;
        let strength = MU0_OVER_4PI * first.density * second.density * ROOM;
        let (v, w) = (self.reach(), self.cell.half[2]);
        let rims = Rims::of(&self.single.first, &self.single.second);
        // The speed of the middle of its faces, and the turn.
        let motion = [self.centre_reach() + w * second.deep, w];
        let unit = [second.deep / second.radius, 1.0 / second.radius];
        let mut sums = [0.0; 7];
        for (k, &[aside, height]) in distances.iter().enumerate() {
            let distance = match (apart(aside), height) {
                (apart, 0.0) => apart,
                (apart, height) => libm::hypot(apart.max(0.0), height),
            };
            let FaceLimits {
                first: k1,
                second: k2,
                third,
                fourth,
                x,
                y,
            } = first.face.limits(&second.face, distance);
            let mut third = [third * v.powi(3), third];
            let mut fourth = [fourth * v.powi(4), fourth];
            if let Some(rims) = rims.filter(|_| distance > 0.0) {
                let [k, l] = rims.limits(k, [distance, v]);
                for (at, [v, w]) in [motion, unit].into_iter().enumerate() {
                    third[at] = third[at].min((k * v + 3.0 * x * w) * v * v);
                    fourth[at] = fourth[at].min((l * v + 4.0 * y * w) * v * v * v);
                }
            }
            let all = [k1, k2, third[0], third[1], fourth[0], fourth[1], x];
            for (sum, limit) in sums.iter_mut().zip(all) {
                *sum += strength * limit;
            }
        }
        let [first, second, third, third_unit, fourth, fourth_unit, x] = sums;
        Limits {
            first,
            second,
            third: [third, third_unit],
            fourth: [fourth, fourth_unit],
            x,
        }
    }

    /// Adds the tightest form, of a pair that is not apart enough for its series; returns what is left.
    pub(super) fn near(&self, out: &mut Sum) -> Left {
        let Single { first, second, .. } = self.single;
        let (v, w) = (self.reach(), self.cell.half[2]);
        let (lever, radius) = (self.lever(), self.magnets[1].radius);
        // What exact energies and their slopes err.
        let distances = distances(first, second);
        let closest = distances.map(|[aside, height]| aside.max(height));
        let closest = closest.into_iter().fold(f64::INFINITY, f64::min);
        let (lost, slopes) = match closest < GRAZING.0 * radius {
            true => (GRAZING.1, GRAZING.1),
            false => (LOST, EXACT),
        };
        if v == 0.0 {
            out.work += AN_ENERGY;
            let still = self.single.still();
            self.add_linear(&still, out);
            return Left::default().and(self.error(still.energy.abs(), lost));
        }
        let apart = Apart::of(Level::best(), [first, second], [v, w]);
        let most = apart.map_or(f64::INFINITY, |apart| apart.energy);
        let most = most.min(self.touching()) * ROOM;
        let error = self.error(most, lost);

        let aside = |aside: f64| {
            let on_the_way = (aside - v).max((aside + self.depths - v) / 2.0);
            // The farthest place of differences is that by both of two steps.
            on_the_way.min(aside - 1.5 * STEPS[0] * v)
        };
        let limits = self.limits(&distances, aside);
        let [k1, k2] = [limits.first, limits.second];
        let arc = k1 * lever * w * w * w / 6.0;
        let [third, fourth] = limits.along(0, [v, w, lever]);
        let spreads = Spreads {
            reach: v,
            third: apart.map_or(third / 6.0, |apart| apart.remainder.min(third / 6.0)),
            fourth: fourth / 24.0,
            units: limits.along(1, [1.0, 1.0 / radius, radius]),
            error,
            slopes: 2.0 * slopes * k1 * v,
        };
        let is_derived = self.are_lying_discs() && closest >= DERIVED_FROM * radius;
        let ([second_order, step], [third_order, long_step], worth_third) = match is_derived {
            false => (spreads.second_order(), spreads.third_order(), WORTH_THIRD),
            true => {
                let [value, slope, second, bend] = DERIVED;
                let errors = [self.error(most, value), slope * k1 * v, second * k2 * v * v];
                let errors = errors.iter().sum::<f64>() + bend * third;
                (
                    [f64::INFINITY; 2],
                    [spreads.fourth + errors, 0.0],
                    WORTH_DERIVED,
                )
            }
        };
        let bent = 0.5 * (k2 * v * v + k1 * radius * w * w);
        let first_order = bent + arc + error;
        let steepest = apart.map_or(k1 * v, |apart| apart.slope.min(k1 * v));
        let value = steepest + error;
        let others = second_order.min(first_order).min(value);
        if most <= others.min(third_order) {
            return Left {
                spread: most,
                slope: steepest,
            };
        }
        if third_order + SHARED * spreads.third < worth_third * others {
            match is_derived {
                true => self.add_derived(out),
                false => self.add_third_order(long_step * v, out),
            }
            return Left {
                spread: third_order,
                slope: 4.0 * third_order,
            };
        }
        if second_order < WORTH * first_order.min(value) {
            self.add_second_order(step * v, out);
            return Left {
                spread: second_order,
                slope: 3.0 * spreads.third + 2.0 * (second_order - spreads.third),
            };
        }
        let still = self.single.still();
        out.work += AN_ENERGY;
        if first_order <= value {
            let form = self.in_cell(&still, [0.0; 6]);
            out.form = out.form.minus(-1.0, &form);
            return Left {
                spread: first_order,
                slope: 2.0 * (bent + error) + 3.0 * arc,
            };
        }
        // Off the first magnet, if the faces may meet.
        let meet = distances
            .iter()
            .any(|[aside, height]| *height == 0.0 && *aside <= self.slack_of_meeting());
        let (energy, value) = match meet {
            false => (still.energy, value),
            true => (self.moved_off(v).energy, steepest + k1 * v + error),
        };
        if value >= most {
            return Left {
                spread: most,
                slope: steepest,
            };
        }
        out.form.value += energy;
        Left {
            spread: value,
            slope: steepest,
        }
    }

    fn are_lying_discs(&self) -> bool {
        let Single { first, second, .. } = self.single;
        [first, second]
            .iter()
            .all(|it| it.shape == Shape::Disc && !it.stands)
    }

    /// Faces closer than this (m) count as meeting.
    fn slack_of_meeting(&self) -> f64 {
        1e-6 * self.magnets[1].radius
    }

    /// The energy with the second magnet moved off by a distance (m), in the direction in which the faces
    /// get the farthest apart.
    fn moved_off(&self, by: f64) -> PairEnergy {
        let Single { first, second, .. } = self.single;
        let between = second.position - first.position;
        let ways = [first.direction, second.direction, between];
        let ways = ways.into_iter().flat_map(|way| [way, -way]);
        let ways = ways.filter_map(|way| way.try_normalize(0.0));
        let nearest = |way: &Vector2<f64>| {
            let there = Body {
                position: second.position + way * by,
                ..*second
            };
            let all = distances(first, &there).map(|[aside, _]| aside);
            all.into_iter().fold(f64::INFINITY, f64::min)
        };
        let best = ways.max_by(|a, b| nearest(a).total_cmp(&nearest(b)));
        let [moved] = self.single.moved([best.unwrap_or_default() * by], 0.0);
        moved
    }
}
