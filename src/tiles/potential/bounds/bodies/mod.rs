//! Bounds of the interaction energy of magnets of any form over a cell: discs that lie, and upright
//! blocks.
//!
//! **Far pairs**, beyond three times the sum of the half diagonals and four times the magnet's reach,
//! have value and gradient of their multipole series, and the Hessian and the third-order remainder of
//! the dipoles at their centres (see [`far`]). The second-order remainder of the difference between
//! the two decreases like `r^-7`.
//!
//! **Near pairs** have the tightest of these:
//!
//! * the form of second order, with value and gradient of the exact energy at the cell's centre and a
//!   Hessian from differences of the gradient over a step h. Its remainder is that of uniform
//!   distributions of dipoles (see [`series`], and closer [`Apart`]), or from the K of pairs of faces (see
//!   [`faces`]), with the speed v of the fastest point, the turn w, and the magnet's distance a from the point about which
//!   it turns: `(K3 v^3 + 3 K2 v a w^2 + K1 a w^3) / 6`. The differences err by `h / 2` times the third
//!   derivatives: at most by `h / 2 v^2` times their bound for a unit of motion.
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

mod faces;
mod far;
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
use faces::{Face, distances, sides};
use series::SeriesBounds;

/// Pairs are far beyond this many times the sum of their half diagonals, and the magnet's reach.
const CLOSE: f64 = 3.0;
const NEAR: f64 = 4.0;
/// The largest and the smallest step of differences, as a share of the reach.
const STEPS: [f64; 2] = [1.0 / 16.0, 1.0 / 16384.0];
/// A form of second order takes four times as long as one of first order; it is used if its remainder is
/// this much smaller.
const WORTH: f64 = 0.6;
/// The errors of energies and of their slopes, as a share of what they may be, and of what is lost of
/// the faces' own, as a share of those of touching magnets: where rims graze faces, within a part of
/// the radius, elliptic integrals lose digits.
const EXACT: f64 = 2e-9;
const LOST: f64 = 1e-11;
const GRAZING: (f64, f64) = (0.25, 1e-6);
/// Room for rounding of the bounds.
const ROOM: f64 = 1.0 + 1e-9;

/// Units of work for a cell, for a far pair, for a near pair, and for an exact energy: more than they take, as
/// the list of states of eight sectors with discs is charged 180 core-seconds for 1.8 million cells in 34.
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
    /// The radius (m) of the circle about it in the tiles' plane.
    radius: f64,
    /// Half its diagonal (m), and the mean square distance of its points from its centre (m^2).
    half: f64,
    square: f64,
}

impl Enclosed {
    fn new(magnet: &Magnet, tile: &Tile, kind: usize) -> Self {
        let body = Body::from(magnet);
        let face = Face::new(&body);
        let density = magnet.moment / body.volume();
        let [half, square] = far::extent(&body);
        Self {
            face,
            kind,
            depth: depth(magnet, tile),
            // Two faces, whose charges of unlike signs only lower the energy.
            own: density * (2.0 * MU0_OVER_4PI * face.own()).sqrt(),
            density,
            radius: body.radius(),
            half,
            square,
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
                let halves = [one, other].map(|body| far::extent(body)[0]);
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

    fn add(&self, out: &mut Enclosure, cell: &Cell, single: &Single) {
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
        let left = match single.far.filter(|_| pair.is_far()) {
            Some(energy) => {
                out.work += A_PAIR;
                pair.far(&energy, &mut out.form)
            }
            None => {
                out.work += A_NEAR_PAIR;
                pair.near(out)
            }
        };
        out.low -= left.spread;
        out.high += left.spread;
        out.slope += left.slope;
    }
}

impl CellBounds for BodyBounds {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let mut out = Enclosure {
            work: A_CELL,
            ..Enclosure::default()
        };
        self.potential
            .for_each_single(&cell.centre, self.skipped, |single| {
                self.add(&mut out, cell, single);
            });
        out
    }

    fn work(&self) -> u64 {
        let pairs = self.fixed.len() * self.moving.len();
        A_CELL + A_PAIR * pairs as u64 + 2 * (A_NEAR_PAIR + AN_ENERGY)
    }
}

/// How far (J) an energy may be from its form, and the slope of an [`Enclosure`].
#[derive(Clone, Copy, Debug)]
struct Left {
    spread: f64,
    slope: f64,
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

    /// K1, K2 and K3 of all faces (J/m, J/m^2, J/m^3) if those that are `apart` (m) in the tiles' plane are
    /// at least that far apart.
    fn limits(&self, distances: &[[f64; 2]; 4], apart: impl Fn(f64) -> f64) -> [f64; 3] {
        let [first, second] = self.magnets;
        let strength = MU0_OVER_4PI * first.density * second.density * ROOM;
        let mut sums = [0.0; 3];
        for &[aside, height] in distances {
            let distance = match (apart(aside), height) {
                (apart, 0.0) => apart,
                (apart, height) => libm::hypot(apart.max(0.0), height),
            };
            let limits = first.face.limits(&second.face, distance);
            for (sum, limit) in sums.iter_mut().zip(limits) {
                *sum += strength * limit;
            }
        }
        sums
    }

    /// The bounds of the series, if the magnets stay far enough apart.
    fn by_series(&self) -> Option<Apart> {
        let v = self.centre_reach();
        let moved = [v, self.cell.half[2]];
        self.series?.at(self.distance() - v, moved, self.strength)
    }

    /// Adds the tightest form, of a pair that is not far; returns what is left.
    fn near(&self, out: &mut Enclosure) -> Left {
        let Single { first, second, .. } = self.single;
        let (v, w) = (self.reach(), self.cell.half[2]);
        let (lever, radius) = (self.lever(), self.magnets[1].radius);
        let apart = self.by_series();
        let apart = apart.or_else(|| Apart::of(Level::best(), [first, second], [v, w]));
        let [one, other] = self.magnets;
        let touching = one.own * other.own;
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

        let [most_step, least_step] = STEPS;
        let aside = |aside: f64| {
            let on_the_way = (aside - v).max((aside + self.depths - v) / 2.0);
            on_the_way.min(aside - most_step * v)
        };
        let [k1, k2, k3] = self.limits(&distances, aside);
        let arc = k1 * lever * w * w * w / 6.0;
        let third = (k3 * v * v * v + 3.0 * k2 * v * lever * w * w) / 6.0 + arc;
        let third = apart.map_or(third, |apart| third.min(apart.remainder));
        // Longer steps err by their third derivatives, shorter ones by the errors of slopes: the best are
        // where both are equal.
        let unit = k3 + 3.0 * k2 / radius + k1 / (radius * radius);
        let [by_length, by_error] = [0.5 * unit * v * v * v, 2.0 * slopes * k1 * v];
        let step = (by_error / by_length).sqrt().clamp(least_step, most_step);
        let differences = by_length * step + by_error / step;
        let second_order = third + differences + error;
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
        if second_order < WORTH * first_order.min(value) && v > 0.0 {
            out.work += 4 * AN_ENERGY;
            let form = self.second_order(&still, step * v);
            out.form = out.form.minus(-1.0, &form);
            return Left {
                spread: second_order,
                slope: 3.0 * third + 2.0 * (second_order - third),
            };
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

    /// The form of second order, with differences over a step (m).
    fn second_order(&self, still: &PairEnergy, h: f64) -> Quadratic {
        let turn = h / self.magnets[1].radius;
        let change = |there: &PairEnergy, step: f64| {
            let change = (there.gradient - still.gradient) / step;
            [change.x, change.y, (there.slope - still.slope) / step]
        };
        let [x, y] = self.single.moved([Vector2::x() * h, Vector2::y() * h], 0.0);
        let [t] = self.single.moved([Vector2::zeros()], turn);
        let [x, y, t] = [change(&x, h), change(&y, h), change(&t, turn)];
        let mean = |a: f64, b: f64| (a + b) / 2.0;
        self.in_cell(
            still,
            [
                x[0],
                y[1],
                t[2],
                mean(x[1], y[0]),
                mean(x[2], t[0]),
                mean(y[2], t[1]),
            ],
        )
    }

    /// The form in the cell's coordinates, from the gradient and the Hessian in the second magnet's own
    /// place and turn.
    fn in_cell(&self, here: &PairEnergy, [xx, yy, tt, xy, xt, yt]: [f64; 6]) -> Quadratic {
        let (arm, force) = (self.arm, here.gradient);
        let across = Vector2::new(-arm.y, arm.x);
        let bent = Vector2::new(xx * across.x + xy * across.y, xy * across.x + yy * across.y);
        let turned = Vector2::new(xt, yt);
        let turning = bent + turned;
        Quadratic {
            value: here.energy,
            gradient: [force.x, force.y, force.dot(&across) + here.slope],
            hessian: [
                xx,
                yy,
                bent.dot(&across) + 2.0 * turned.dot(&across) + tt - force.dot(&arm),
                xy,
                turning.x,
                turning.y,
            ],
        }
    }
}
