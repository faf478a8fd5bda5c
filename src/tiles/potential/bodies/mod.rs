//! Magnets of any form: discs, and magnets magnetised across the table, besides blocks that lie
//! flat.
//!
//! A magnet that is uniformly magnetised along its axis is equivalent to two charged faces with the
//! charge density m / V (A/m, the moment over the volume), and the energy of two magnets is the
//! Coulomb energy of the four pairs of faces:
//!
//! ```text
//! U = mu0 / (4 pi)  (m1 / V1) (m2 / V2)  sum of +- int int 1 / r dA1 dA2         (J)
//! ```
//!
//! Faces are discs or rectangles, upright (the axis lies in the tiles' plane) or flat (the axis is
//! normal to it):
//!
//! | faces | integral | by |
//! |---|---|---|
//! | a disc and any | the other's potential along the disc's axis, at imaginary heights | `line` |
//! | two flat rectangles | over both boundaries | `edges` |
//! | two upright rectangles | closed forms in lanes | [`super::cuboid`] |
//! | an upright and a flat one | none: flat faces come in pairs, north and south, at the same distance over and under the tiles' middle plane, which an upright one sees alike | |
//!
//! A disc's integral holds where the other face does not meet it. Magnets that break through their tile's
//! surface may overlap others; no magnets can be there, and the energies of discs are not those of the
//! overlapping faces.
//!
//! Beyond about three times the magnets' size the multipole series is used (`series`, `far`), with a bound of
//! 1e-9 of each pair's `mu0 m1 m2 / (4 pi r^3)` for the omitted terms. For upright point dipoles it is the
//! first term of this series, at every distance.
//!
//! Bounds of derivatives are in `limits`, the energies and bounds of single pairs in `each`; for those over whole cells see
//! [`bounds`](super::bounds), which has the pairs one by one from `single`, with second and third derivatives of discs that
//! lie from `lying_discs`, and those of upright discs and
//! dipoles, whose energy depends on their distance alone, from `radial`.

mod complex;
mod disc;
mod each;
mod edges;
mod elliptic;
mod face;
mod limits;
mod line;
mod lying_discs;
mod near;
mod nearby;
mod panels;
pub(in crate::potential) mod radial;
mod rectangle;
mod series;
mod single;
mod sum;
#[cfg(test)]
mod tests;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use nalgebra::{Vector2, Vector3};

use super::far::group::Group;
use super::far::{FarForm, PairEnergy};
use super::kinds::number_of;
use super::lever::Lever;
use super::simd::Level;
use super::{MagnetModel, Potential, finite, motion};
use crate::configuration::Configuration;
use crate::tile::Magnet;
use crate::tile::magnet::{Form, Shape};
use each::Apart;
use limits::BodyLimits;
pub(in crate::potential) use near::exact;
use nearby::Nearby;
pub(in crate::potential) use series::magnitudes_of;
#[cfg(test)]
pub(in crate::potential) use series::series as series_of;
pub(in crate::potential) use single::Single;
use sum::BodySum;

/// The fraction of a pair's `mu0 m1 m2 / (4 pi r^3)` at which the series replaces the faces, and at
/// which its terms are dropped one by one.
const HAND_OVER: f64 = 1e-9;

/// Sizes (m), shape, and whether a magnet stands.
pub(in crate::potential) type BodyKind = ([f64; 3], Shape, bool);

/// A magnet in the frame in use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Its centre (m).
    pub position: Vector2<f64>,
    /// The direction of the first of its sizes: its axis, if it lies flat.
    pub direction: Vector2<f64>,
    /// Its moment (A m^2); for an upright magnet, the upward component.
    pub moment: f64,
    /// Its sizes (m), see [`Magnet::size`].
    pub size: [f64; 3],
    /// Its shape, and whether it stands.
    pub shape: Shape,
    /// Whether its axis is normal to the tiles' plane.
    pub stands: bool,
}

impl From<&Magnet> for Body {
    fn from(magnet: &Magnet) -> Self {
        let (sin, cos) = libm::sincos(magnet.angle);
        let Form { shape, stands } = magnet.form;
        Self {
            position: magnet.position,
            direction: Vector2::new(cos, sin),
            moment: magnet.moment * stands.map_or(1.0, |up| up.sign()),
            size: magnet.size,
            shape,
            stands: stands.is_some(),
        }
    }
}

impl Body {
    /// The body moved by a rotation (cos, sin) and a shift.
    pub(in crate::potential) fn moved(&self, [cos, sin]: [f64; 2], shift: Vector2<f64>) -> Self {
        let turn = |v: Vector2<f64>| Vector2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y);
        Self {
            position: turn(self.position) + shift,
            direction: turn(self.direction),
            ..*self
        }
    }

    /// The radius (m) of the circle about it in the tiles' plane.
    pub(super) fn radius(&self) -> f64 {
        match (self.shape, self.stands) {
            (Shape::Disc, true) => self.size[0] / 2.0,
            _ => libm::hypot(self.size[0], self.size[1]) / 2.0,
        }
    }

    /// Its volume (m^3).
    pub(super) fn volume(&self) -> f64 {
        self.shape.volume(self.size)
    }

    /// What it shares with others that differ in place, direction and moment.
    pub(in crate::potential) fn kind(&self) -> BodyKind {
        (self.size, self.shape, self.stands)
    }

    /// Whether it differs from another one only in place, direction and moment.
    pub(in crate::potential) fn is_like(&self, other: &Self) -> bool {
        self.kind() == other.kind()
    }
}

/// The interaction energy of two sets of magnets of any form, one in each tile.
#[derive(Clone, Debug)]
pub struct BodyPotential {
    fixed: Magnets,
    moving: Magnets,
    /// For each group of the fixed tile and each of the moving one; `None` if one lies and the
    /// other stands.
    pairs: Vec<Vec<Option<Pairs>>>,
    lever: Lever,
    feature: f64,
    /// Different from that of any other potential.
    number: u64,
}

static NUMBER: AtomicU64 = AtomicU64::new(0);

/// The magnets of a tile, and groups of them.
#[derive(Clone, Debug)]
struct Magnets {
    bodies: Vec<Body>,
    groups: Vec<Alike>,
}

/// Magnets that differ only in place and moment, and by half a turn.
#[derive(Clone, Debug)]
struct Alike {
    /// With the moment 1 A m^2, at the origin.
    like: Body,
    members: Group,
}

/// Data shared by the pairs of two groups.
#[derive(Clone, Debug)]
struct Pairs {
    far: FarForm,
    /// For moments of 1 A m^2; `None` for point dipoles.
    limits: Option<BodyLimits>,
    /// The energy of near pairs, if it is interpolated.
    nearby: Option<Arc<Nearby>>,
}

/// Directions that differ by less than this (rad) count as equal.
const SAME_DIRECTION: f64 = 1e-12;

impl Magnets {
    /// Magnets by size and axis, up to its sign: each looks the same after half a turn, but for the pole of
    /// one that lies.
    fn new(magnets: &[Magnet]) -> Self {
        let bodies: Vec<_> = magnets.iter().map(Body::from).collect();
        let mut groups: Vec<Alike> = Vec::new();
        for (at, body) in bodies.iter().enumerate() {
            let is_upright_disc = body.stands && body.shape == Shape::Disc;
            let is_like = |group: &Alike| {
                let aside = group.like.direction.perp(&body.direction).abs();
                group.like.is_like(body) && (is_upright_disc || aside < SAME_DIRECTION)
            };
            let number = number_of(&mut groups, is_like, |number| {
                let like = Body {
                    position: Vector2::zeros(),
                    moment: 1.0,
                    ..*body
                };
                let members = Group::new(number, like.direction);
                Alike { like, members }
            });
            let group = &mut groups[number];
            let turned = !body.stands && group.like.direction.dot(&body.direction) < 0.0;
            let moment = if turned { -body.moment } else { body.moment };
            group.members.push(at, body.position, moment);
        }
        Self { bodies, groups }
    }

    /// The numbers, places (m) and moments (A m^2) of a group.
    fn places<'a>(
        &'a self,
        group: &'a Alike,
    ) -> impl Iterator<Item = (usize, Vector2<f64>, f64)> + Clone + 'a {
        let members = group.members.members.iter().zip(&group.members.moment);
        members.map(|(at, moment)| (*at, self.bodies[*at].position, *moment))
    }
}

impl Pairs {
    fn new(model: MagnetModel, first: &Body, second: &Body, error: f64) -> Option<Self> {
        if first.stands != second.stands {
            return None;
        }
        let far = series::series(model, first, second, error);
        let reach = far.near().sqrt();
        let is_coarse = error > HAND_OVER && reach > 0.0;
        Some(Self {
            nearby: is_coarse.then(|| Arc::new(Nearby::new(first, second, reach, error))),
            far,
            limits: (model == MagnetModel::Cuboid).then(|| BodyLimits::new(first, second)),
        })
    }

    /// The energy of two magnets of these groups that are near each other.
    fn near(&self, first: &Body, second: &Body) -> PairEnergy {
        let Some(nearby) = &self.nearby else {
            return exact(first, second);
        };
        let way = second.position - first.position;
        let found = nearby.at(first.direction, way, second.direction);
        let moments = first.moment * second.moment;
        PairEnergy {
            energy: moments * found.energy,
            gradient: found.gradient * moments,
            slope: moments * found.slope,
        }
    }
}

impl BodyPotential {
    /// The potential of two tiles' magnets.
    pub fn new(model: MagnetModel, fixed: &[Magnet], moving: &[Magnet]) -> Self {
        Self::within(HAND_OVER, model, fixed, moving)
    }

    /// The same, faster and with a larger error: as a fraction of `mu0 m1 m2 / (4 pi r^3)` for each pair,
    /// r its distance, or that at which pairs count as near if it is nearer. Energies of near pairs are
    /// interpolated.
    pub fn within(error: f64, model: MagnetModel, fixed: &[Magnet], moving: &[Magnet]) -> Self {
        let lever = Lever::of(moving.iter().flat_map(Magnet::corners));
        let all = fixed.iter().chain(moving);
        let sides = all.flat_map(|magnet| [magnet.size[0], magnet.size[1]]);
        let feature = sides.fold(f64::INFINITY, f64::min) / 2.0;
        let (mut fixed, moving) = (Magnets::new(fixed), Magnets::new(moving));
        for group in &mut fixed.groups {
            group.members.fill();
        }
        let of = |first: &Alike| {
            let pairs = |second: &Alike| Pairs::new(model, &first.like, &second.like, error);
            moving.groups.iter().map(pairs).collect()
        };
        Self {
            pairs: fixed.groups.iter().map(of).collect(),
            fixed,
            moving,
            lever,
            feature,
            number: NUMBER.fetch_add(1, Ordering::Relaxed),
        }
    }

    /// The pairs of groups and what they have in common, except those of a lying and an upright one.
    fn of_groups(&self) -> impl Iterator<Item = ([&Alike; 2], &Pairs)> {
        let first = self.fixed.groups.iter().zip(&self.pairs);
        first.flat_map(|(first, pairs)| {
            let second = self.moving.groups.iter().zip(pairs);
            second.filter_map(move |(second, pairs)| Some(([first, second], pairs.as_ref()?)))
        })
    }

    /// The distance (m) from which on the series is used for all pairs; 0 for dipoles.
    #[cfg(test)]
    pub(super) fn reach(&self) -> f64 {
        let pairs = self.pairs.iter().flatten().flatten();
        pairs.fold(0.0, |most: f64, pairs| most.max(pairs.far.near().sqrt()))
    }

    /// The sum over pairs (J), its gradient by the second tile's place (J/m) and turn (J/rad).
    fn sum<const SLOPE: bool>(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let (energy, gradient) = Level::best().run(BodySum::<SLOPE> { potential: self, q });
        finite(energy, gradient)
    }
}

impl Potential for BodyPotential {
    fn energy(&self, q: &Configuration) -> f64 {
        self.sum::<false>(q).0
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        self.sum::<true>(q)
    }

    /// If faces may come closer than a sixteenth of the reach, the second derivative has no bound,
    /// because it grows like the logarithm of their distance; the value returned is the bound at a
    /// sixteenth of the reach, which holds for the average over a motion of that reach.
    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64 {
        let turn = self.lever.turn();
        let pairs = self.each_apart(q, reach);
        pairs.fold(0.0, |sum, pair| sum + pair.curvature(turn, reach))
    }

    /// Known only if all magnets are farther apart than their own size.
    fn fourth_derivative_bound(&self, q: &Configuration, reach: f64) -> f64 {
        let fourth = motion::fourth_derivative(self.lever.turn());
        let bound = |pair: Apart| match pair.distance > pair.radii {
            true => motion::bound(&fourth, pair.strength, pair.distance),
            false => f64::INFINITY,
        };
        let pairs = self.each_apart(q, reach);
        pairs.fold(0.0, |sum, pair| sum + bound(pair))
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        self.lever.displacement(step)
    }

    /// Half the shortest side in the plane of any magnet.
    fn feature_length(&self) -> f64 {
        self.feature
    }

    /// The noise of [blocks](super::cuboid), which may be among them.
    fn noise(&self) -> f64 {
        1e-6
    }
}
