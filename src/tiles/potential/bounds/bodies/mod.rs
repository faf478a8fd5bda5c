//! Bounds of the interaction energy of magnets of any form over a cell: discs that lie, and upright
//! blocks.
//!
//! **Pairs apart**, by somewhat more than the sum of their half diagonals, have a form of their multipole series (see
//! [`far`] and [`series`]): of first or second order where that leaves little beside what nearer pairs leave, else of
//! third order. Terms of third order are added up, and what the linear form nearest to them leaves ([`cubic`])
//! counts once for all pairs: much of it cancels.
//!
//! **Near pairs** at a single place have their energy. Over a cell they have the tightest of these:
//!
//! * the form of second order, with value and gradient of the exact energy at the cell's centre and a
//!   Hessian from differences of the gradient over a step h. Its remainder is that of uniform
//!   distributions of dipoles (see [`apart`](super::apart)), or from the K of pairs of faces (see
//!   [`faces`], and [`rims`]), with the speed v of the fastest point, the turn w, and the magnet's distance a from the
//!   point about which it turns: `(K3 v^3 + 3 K2 v a w^2 + K1 a w^3) / 6`. The differences err by `h / 2` times the
//!   third derivatives: at most by `h / 2 v^2` times their bound for a unit of motion.
//! * the form of third order, with a remainder from K4 likewise (see [`near`]), and differences to both sides, or of two
//!   discs that lie the derivatives themselves.
//! * the form of first order in the magnet's own place and turn, s its radius: `(K2 v^2 + K1 s w^2) / 2
//!   + K1 a w^3 / 6`, where the last term is what the form leaves out of the way along an arc.
//! * its value: `K1 v`, also where faces touch.
//! * `2 K <d^-3>` of [`apart`](super::apart), or the energies of the faces' charges with copies of themselves (Cauchy
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
mod near;
mod rims;
mod series;

use std::sync::Arc;

use nalgebra::Vector2;

use super::near::SLACK;
use super::{CellBounds, Enclosure};
use crate::cell::{Cell, Quadratic};
use crate::configuration::Configuration;
use crate::potential::bodies::{Body, BodyKind, Single};
use crate::potential::cuboid::limits::segment_distance;
use crate::potential::kinds::{Made, number_of};
use crate::potential::{BodyPotential, MagnetModel};
use crate::scale::Scale;
use crate::tile::{Magnet, Tile};
use crate::units::MU0_OVER_4PI;
use cubic::Cubic;
use faces::{PoleFace, sides};
use series::{OfSeries, SeriesBounds};

/// The form of third order is used if what it leaves and this share of the remainder of third order is less than
/// others leave: of the latter, that much is left by all pairs together.
const SHARED: f64 = 0.25;
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
const A_TERM: u64 = 12;
const A_NEAR_PAIR: u64 = 150;
const AN_ENERGY: u64 = 800;

/// The series of two kinds of magnets.
pub(super) type SeriesOfKinds = Made<[BodyKind; 2], SeriesBounds>;

/// Cell bounds of the interaction energy of two tiles' magnets of any form.
pub struct BodyBounds {
    potential: BodyPotential,
    fixed: Vec<Enclosed>,
    moving: Vec<Enclosed>,
    /// By the kinds of the fixed and the moving magnet; `None` for pairs that others bound.
    series: Vec<Vec<Option<Arc<SeriesBounds>>>>,
    /// Pairs that others bound.
    skipped: fn(&Body, &Body) -> bool,
    /// How much (m) magnets may overlap in configurations that count as free.
    slack: f64,
}

/// A magnet and its properties.
#[derive(Clone, Copy, Debug)]
struct Enclosed {
    face: PoleFace,
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
        let face = PoleFace::new(&body);
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
    pub(super) fn new(
        fixed: &Tile,
        moving: &Tile,
        skipped: fn(&Body, &Body) -> bool,
        known: &mut SeriesOfKinds,
    ) -> Self {
        let [(own, first), (others, second)] = [fixed, moving].map(enclosed);
        let mut series = |one: &Body| {
            let of = |other: &Body| {
                let kinds = [one, other].map(Body::kind);
                (one.stands == other.stands && !skipped(one, other))
                    .then(|| known.of(kinds, || SeriesBounds::new(one, other)))
            };
            second.iter().map(of).collect()
        };
        let radii = [fixed, moving].map(|tile| tile.outline.circumradius());
        Self {
            potential: BodyPotential::new(MagnetModel::Cuboid, &fixed.magnets, &moving.magnets),
            fixed: own,
            moving: others,
            series: first.iter().map(&mut series).collect(),
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
            series: self.series[self.fixed[i].kind][self.moving[j].kind].as_deref(),
            count: (self.fixed.len() * self.moving.len()) as f64,
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

    fn energy(&self, q: &Configuration) -> f64 {
        let mut energy = 0.0;
        self.potential
            .for_each_single(q, self.skipped, |single| energy += single.still().energy);
        energy
    }

    fn work(&self) -> u64 {
        let pairs = self.fixed.len() * self.moving.len();
        A_CELL + A_TERM * pairs as u64 + 2 * (A_NEAR_PAIR + AN_ENERGY)
    }
}

/// How far (J) an energy may be from its form, and the slope of an [`Enclosure`].
#[derive(Clone, Copy, Debug, Default)]
struct Left {
    spread: f64,
    slope: f64,
}

impl Left {
    /// The remainder (J) of a form of this order.
    fn of_order(order: usize, spread: f64) -> Self {
        Self {
            spread,
            slope: (order + 1) as f64 * spread,
        }
    }

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
    /// How many pairs there are.
    count: f64,
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

    /// The distance (m) of the centres.
    fn distance(&self) -> f64 {
        (self.single.second.position - self.single.first.position).norm()
    }

    /// The largest distance (m) that the cell moves the second magnet's centre.
    fn centre_reach(&self) -> f64 {
        self.cell.reach(self.arm.norm()) * ROOM
    }

    /// The bounds of the series, if the magnets stay far enough apart.
    fn by_series(&self) -> Option<OfSeries<'_>> {
        let v = self.centre_reach();
        let moved = [v, self.cell.half[2]];
        self.series?.at(self.distance() - v, moved, self.strength)
    }

    /// The largest energy (J) of the two magnets if they touch.
    fn touching(&self) -> f64 {
        let [one, other] = self.magnets;
        one.own * other.own
    }

    /// The error (J) of an exact energy of at most this much (J), and of its change by its slopes over the cell, where
    /// this share of the faces' own is lost.
    fn error(&self, most: f64, lost: f64) -> f64 {
        let grown = 1.0 + 4.0 * self.reach() / self.magnets[1].radius;
        (EXACT * most + lost * self.touching()) * grown
    }
}
