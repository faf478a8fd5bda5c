//! Bounds of the interaction energy of magnets of any form over a cell: discs that lie, and upright
//! blocks.
//!
//! **Pairs apart**, by somewhat more than the sum of their half diagonals, have the form of third order of
//! their multipole series (see [`far`] and [`series`]). Terms of third order are added up, and what the linear
//! form nearest to them leaves ([`cubic`]) counts once for all pairs: much of it cancels.
//!
//! **Near pairs** have the tightest of these:
//!
//! * the form of second order, with value and gradient of the exact energy at the cell's centre and a
//!   Hessian from differences of the gradient over a step h. Its remainder is that of uniform
//!   distributions of dipoles (see [`series`], and closer [`Apart`]), or from the K of pairs of faces (see
//!   [`faces`], and [`rims`]), with the speed v of the fastest point, the turn w, and the magnet's distance a from the
//!   point about which it turns: `(K3 v^3 + 3 K2 v a w^2 + K1 a w^3) / 6`. The differences err by `h / 2` times the
//!   third derivatives: at most by `h / 2 v^2` times their bound for a unit of motion.
//! * the form of third order, with differences to both sides, and a remainder from K4 likewise (see [`Limits`]).
//! * the form of first order in the magnet's own place and turn, s its radius: `(K2 v^2 + K1 s w^2) / 2
//!   + K1 a w^3 / 6`, where the last term is what the form leaves out of the way along an arc.
//! * its value: `K1 v`, also where faces touch.
//! * `2 K <d^-3>` of [`Apart`], or the energies of the faces' charges with copies of themselves (Cauchy
//!   and Schwarz).
//!
//! Faces are as close as at the centre less the way of the fastest point. As they stay behind the
//! surfaces of their tiles, in a free configuration they are as far apart as both are deep, and on the
//! way there at least half as far as the sum of both bounds: `(D + depths - v) / 2`. Where the faces may
//! meet at the centre itself, the value is that of the second magnet moved off by v.
//!
//! **Slopes.** A remainder of the order n changes along a motion by the fraction s of the cell by at most
//! n s times itself, as elsewhere; a value alone by `K1 v s`.

mod cubic;
mod faces;
mod far;
mod forms;
mod rims;
mod series;

use nalgebra::Vector2;

use super::apart::Apart;
use super::near::SLACK;
use super::{CellBounds, Enclosure};
use crate::cell::{Cell, Quadratic};
use crate::potential::bodies::{Body, Single};
use crate::potential::cuboid::limits::segment_distance;
use crate::potential::far::PairEnergy;
use crate::potential::kinds::number_of;
use crate::potential::simd::Level;
use crate::potential::{BodyPotential, MagnetModel};
use crate::scale::Scale;
use crate::tile::{Magnet, Tile};
use crate::units::MU0_OVER_4PI;
use cubic::Cubic;
use faces::{Face, FaceLimits, distances, sides};
use rims::Rims;
use series::{OfSeries, SeriesBounds};

/// The largest and the smallest step of differences, as a share of the reach.
const STEPS: [f64; 2] = [1.0 / 16.0, 1.0 / 16384.0];
/// The form of third order is used if what it leaves and this share of the remainder of third order is less than
/// others leave: of the latter, that much is left by all pairs together.
const SHARED: f64 = 0.25;
/// A form of second order takes four times as long as one of first order; it is used if its remainder is
/// this much smaller.
const WORTH: f64 = 0.6;
/// A form of third order takes twice as long as one of second order; it is used if what it leaves, with the share
/// above, is this much smaller.
const WORTH_THIRD: f64 = 0.6;
/// The errors of energies and of their slopes, as a share of what they may be, and of what is lost of
/// the faces' own, as a share of those of touching magnets: where rims graze faces, within a part of
/// the radius, elliptic integrals lose digits.
const EXACT: f64 = 2e-9;
const LOST: f64 = 1e-11;
const GRAZING: (f64, f64) = (0.25, 1e-6);
/// Room for rounding of the bounds.
const ROOM: f64 = 1.0 + 1e-9;

/// Units of work for a cell, for a term of a pair's series, for a near pair, and for an exact energy.
const A_CELL: u64 = 200;
const A_PAIR: u64 = 12;
const A_NEAR_PAIR: u64 = 150;
const AN_ENERGY: u64 = 800;

/// Cell bounds of the interaction energy of two tiles' magnets of any form.
pub struct BodyBounds {
    potential: BodyPotential,
    fixed: Vec<Enclosed>,
    moving: Vec<Enclosed>,
    /// By the kinds of the fixed and the moving magnet; `None` for pairs that others bound.
    series: Vec<Vec<Option<SeriesBounds>>>,
    /// Pairs that others bound.
    skipped: fn(&Body, &Body) -> bool,
    /// How much (m) magnets may overlap in configurations that count as free.
    slack: f64,
}

/// A magnet and its properties.
#[derive(Clone, Copy, Debug)]
struct Enclosed {
    face: Face,
    /// The number of its size and shape among those of its tile.
    kind: usize,
    /// How deep (m) it lies within its tile.
    depth: f64,
    /// The square root of the largest energy (J) that its charges may have with a copy of themselves.
    own: f64,
    /// Its charge density (A/m).
    density: f64,
    /// The radius (m) of the circle about it in the tiles' plane, and the sum of what its points are from its centre
    /// along and across its faces.
    radius: f64,
    deep: f64,
}

impl Enclosed {
    fn new(magnet: &Magnet, tile: &Tile, kind: usize) -> Self {
        let body = Body::from(magnet);
        let face = Face::new(&body);
        let density = magnet.moment / body.volume();
        Self {
            face,
            kind,
            depth: depth(magnet, tile),
            // Two faces, whose charges of unlike signs only lower the energy.
            own: density * (2.0 * MU0_OVER_4PI * face.own()).sqrt(),
            density,
            radius: body.radius(),
            deep: (body.size[0] + body.size[1]) / 2.0,
        }
    }
}

/// How deep (m) a magnet lies within its tile; negative if it sticks out.
pub(super) fn depth(magnet: &Magnet, tile: &Tile) -> f64 {
    let wall = magnet.wall(&tile.outline);
    if magnet.is_round() || wall < 0.0 {
        return wall;
    }
    let edges = (0..tile.outline.vertices().len()).map(|i| tile.outline.edge(i));
    let own = sides(&Body::from(magnet));
    let walls = edges.flat_map(|(a, b)| own.map(|side| segment_distance([a, b], side)));
    walls.fold(wall, f64::min)
}

/// A tile's magnets, and one of each size and shape.
fn enclosed(tile: &Tile) -> (Vec<Enclosed>, Vec<Body>) {
    let (mut all, mut kinds) = (Vec::new(), Vec::<Body>::new());
    for magnet in &tile.magnets {
        let body = Body::from(magnet);
        let kind = number_of(&mut kinds, |it| it.is_like(&body), |_| body);
        all.push(Enclosed::new(magnet, tile, kind));
    }
    (all, kinds)
}

impl BodyBounds {
    /// Bounds for the pairs of two tiles' magnets that both lie or both stand, but for those that are to be
    /// skipped.
    pub fn new(fixed: &Tile, moving: &Tile, skipped: fn(&Body, &Body) -> bool) -> Self {
        let [(own, first), (others, second)] = [fixed, moving].map(enclosed);
        let series = |one: &Body| {
            let of = |other: &Body| {
                let halves = [one, other].map(far::half_diagonal);
                (one.stands == other.stands && !skipped(one, other))
                    .then(|| SeriesBounds::new([one, other], halves))
            };
            second.iter().map(of).collect()
        };
        let radii = [fixed, moving].map(|tile| tile.outline.circumradius());
        Self {
            potential: BodyPotential::new(MagnetModel::Cuboid, &fixed.magnets, &moving.magnets),
            fixed: own,
            moving: others,
            series: first.iter().map(series).collect(),
            skipped,
            slack: Scale::of(radii).length(SLACK),
        }
    }

    fn add(&self, out: &mut Sum, cell: &Cell, single: &Single) {
        let [i, j] = single.numbers;
        let pair = Pair {
            magnets: [&self.fixed[i], &self.moving[j]],
            single,
            strength: (single.first.moment * single.second.moment).abs() * MU0_OVER_4PI,
            arm: single.second.position - cell.centre.position(),
            depths: self.fixed[i].depth + self.moving[j].depth - self.slack,
            series: self.series[self.fixed[i].kind][self.moving[j].kind].as_ref(),
            cell,
        };
        let left = match pair.by_series() {
            Some(bounds) => pair.apart(&bounds, out),
            None => {
                out.work += A_NEAR_PAIR;
                pair.near(out)
            }
        };
        out.left = out.left.plus(&left);
    }
}

impl CellBounds for BodyBounds {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let mut sum = Sum::default();
        self.potential
            .for_each_single(&cell.centre, self.skipped, |single| {
                self.add(&mut sum, cell, single);
            });
        let Sum {
            mut form,
            cubic,
            left,
            work,
        } = sum;
        let left = left.plus(&cubic.fold_into(&mut form, &cell.half));
        Enclosure {
            form,
            low: -left.spread,
            high: left.spread,
            slope: left.slope,
            work: A_CELL + work,
            ..Enclosure::default()
        }
    }

    fn work(&self) -> u64 {
        let pairs = self.fixed.len() * self.moving.len();
        A_CELL + A_PAIR * pairs as u64 + 2 * (A_NEAR_PAIR + AN_ENERGY)
    }
}

/// How far (J) an energy may be from its form, and the slope of an [`Enclosure`].
#[derive(Clone, Copy, Debug, Default)]
struct Left {
    spread: f64,
    slope: f64,
}

impl Left {
    fn plus(&self, other: &Self) -> Self {
        Self {
            spread: self.spread + other.spread,
            slope: self.slope + other.slope,
        }
    }

    /// With an error (J) of the form and its slopes over a cell.
    fn and(&self, error: f64) -> Self {
        Self {
            spread: self.spread + error,
            slope: self.slope + 2.0 * error,
        }
    }
}

/// The sum over pairs in a cell.
#[derive(Default)]
struct Sum {
    form: Quadratic,
    cubic: Cubic,
    left: Left,
    work: u64,
}

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
        if v == 0.0 || !third.is_finite() {
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

/// Two magnets, placed as at a cell's centre.
struct Pair<'a> {
    magnets: [&'a Enclosed; 2],
    single: &'a Single<'a>,
    /// `mu0 m1 m2 / (4 pi)` (J m^3).
    strength: f64,
    /// Vector (m) to the second from the point about which it turns.
    arm: Vector2<f64>,
    /// The least distance (m) of the magnets in free configurations.
    depths: f64,
    series: Option<&'a SeriesBounds>,
    cell: &'a Cell,
}

impl Pair<'_> {
    /// The largest distance (m) that the cell moves a point of the second magnet.
    fn reach(&self) -> f64 {
        self.cell.reach(self.lever()) * ROOM
    }

    /// The largest distance (m) of a point of the second magnet from the point about which it turns.
    fn lever(&self) -> f64 {
        self.arm.norm() + self.magnets[1].radius
    }

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

    /// The bounds of the series, if the magnets stay far enough apart.
    fn by_series(&self) -> Option<OfSeries> {
        let v = self.centre_reach();
        let moved = [v, self.cell.half[2]];
        self.series?.at(self.distance() - v, moved, self.strength)
    }

    /// The largest energy (J) of the two magnets if they touch.
    fn touching(&self) -> f64 {
        let [one, other] = self.magnets;
        one.own * other.own
    }

    /// The error (J) of an exact energy of at most this much (J), and of its change by its slopes over the cell.
    fn error(&self, most: f64) -> f64 {
        let grown = 1.0 + 4.0 * self.reach() / self.magnets[1].radius;
        (EXACT * most + LOST * self.touching()) * grown
    }

    /// Adds the tightest form, of a pair that is not apart enough for its series; returns what is left.
    fn near(&self, out: &mut Sum) -> Left {
        let Single { first, second, .. } = self.single;
        let (v, w) = (self.reach(), self.cell.half[2]);
        let (lever, radius) = (self.lever(), self.magnets[1].radius);
        let apart = Apart::of(Level::best(), [first, second], [v, w]);
        let touching = self.touching();
        let most = apart.map_or(f64::INFINITY, |apart| apart.energy);
        let most = most.min(touching) * ROOM;
        // What exact energies and their slopes err.
        let distances = distances(first, second);
        let closest = distances.map(|[aside, height]| aside.max(height));
        let closest = closest.into_iter().fold(f64::INFINITY, f64::min);
        let (lost, slopes) = match closest < GRAZING.0 * radius {
            true => (GRAZING.1, GRAZING.1),
            false => (LOST, EXACT),
        };
        let error = (EXACT * most + lost * touching) * (1.0 + 4.0 * v / radius);

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
        let [second_order, step] = spreads.second_order();
        let [third_order, long_step] = spreads.third_order();
        let bent = 0.5 * (k2 * v * v + k1 * radius * w * w);
        let first_order = bent + arc + error;
        let steepest = apart.map_or(k1 * v, |apart| apart.slope.min(k1 * v));
        let value = steepest + error;
        if most <= second_order.min(first_order).min(value) {
            return Left {
                spread: most,
                slope: steepest,
            };
        }
        let still = self.single.still();
        if v > 0.0 {
            let shared = SHARED * spreads.third;
            let others = second_order.min(first_order).min(value);
            if third_order + shared < WORTH_THIRD * others {
                out.work += 8 * AN_ENERGY;
                self.add_third_order(&still, long_step * v, out);
                return Left {
                    spread: third_order,
                    slope: 4.0 * third_order,
                };
            }
            if second_order < WORTH * first_order.min(value) {
                out.work += 4 * AN_ENERGY;
                self.add_second_order(&still, step * v, out);
                return Left {
                    spread: second_order,
                    slope: 3.0 * spreads.third + 2.0 * (second_order - spreads.third),
                };
            }
        }
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
