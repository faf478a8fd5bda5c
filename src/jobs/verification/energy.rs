//! The energy of two tiles' magnets along a straight motion: point dipoles, and blocks and discs as
//! pairs of charged faces, of discs that stand by their distance alone.
//!
//! Written without the potentials of this crate, by other formulas where there are any: dipoles in
//! interval arithmetic from the definition; faces by closed forms of some of the four integrals over two
//! of them and adaptive quadrature of the others, which is estimated, not bounded.

use super::charges;
use super::distance::{Rim, clearance, placed};
use super::faces::{ChargedFace, Outline};
use super::given::{Magnet, Pose, Shield, Tile, Tiles};
use super::interval::{Interval, Jet};
use super::radial::Radial;

/// mu0 / 4 pi (T m / A).
const MU0_OVER_4PI: f64 = 1e-7;

/// How magnets are modelled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Model {
    Dipoles,
    Bodies,
}

/// The magnets of two tiles.
pub(super) struct Magnets {
    model: Model,
    fixed: Vec<ShieldedMagnet>,
    moving: Vec<ShieldedMagnet>,
    /// Energies of discs that stand, by the kinds of both.
    radial: Vec<([Disc; 2], Radial)>,
    /// The middles (m) of both tiles' faces, if only the nearest two act.
    middles: Option<[Vec<[f64; 2]>; 2]>,
}

/// Midpoints of faces are equally near if their distances differ by less than this share of the least
/// and of a metre: poses in files have ten digits.
const EQUAL: f64 = 1e-9;

/// What rounding leaves (m) where discs touch.
pub(super) const TOUCH: f64 = 1e-9;

/// Moment (A m^2) and sizes (m) of a disc that stands.
type Disc = [f64; 3];

/// A magnet with the shield behind it.
struct ShieldedMagnet {
    position: [f64; 2],
    /// Along x, y and z (A m^2).
    moment: [f64; 3],
    angle: f64,
    size: [f64; 3],
    outline: Outline,
    stands: bool,
    /// The number of its face.
    face: usize,
    /// Distance (m) from its centre to its farthest corner in the plane.
    radius: f64,
    shield: Option<(Shield, [f64; 2])>,
    /// The area that it covers, seen from above.
    rim: Rim,
}

/// A straight motion from one pose to another, the shorter way round.
#[derive(Clone, Copy)]
pub(super) struct StraightMotion {
    from: Pose,
    to: Pose,
}

impl StraightMotion {
    pub fn new(from: Pose, to: Pose) -> Self {
        let turn = to[2] - from[2];
        let turn = turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round();
        let to = [to[0], to[1], from[2] + turn];
        Self { from, to }
    }

    pub fn at(&self, t: f64) -> Pose {
        std::array::from_fn(|k| self.from[k] + t * (self.to[k] - self.from[k]))
    }

    fn along(&self, t: Interval) -> [Jet; 3] {
        std::array::from_fn(|k| Jet::linear(self.from[k], self.to[k], t))
    }
}

type Flat = [Jet; 2];

fn dot(a: &[Jet], b: &[Jet]) -> Jet {
    a.iter()
        .zip(b)
        .fold(Jet::of(0.0), |sum, (a, b)| sum + *a * *b)
}

fn minus(a: Flat, b: Flat) -> Flat {
    [a[0] - b[0], a[1] - b[1]]
}

fn turned([x, y]: Flat, [sine, cosine]: [Jet; 2]) -> Flat {
    [cosine * x - sine * y, sine * x + cosine * y]
}

impl ShieldedMagnet {
    fn new(tile: &Tile, magnet: &Magnet) -> Option<Self> {
        let (sine, cosine) = (libm::sin(magnet.angle), libm::cos(magnet.angle));
        let m = magnet.moment;
        let face = tile.faces.get(magnet.face)?;
        let [l, w, _] = magnet.size_m;
        let outline = match &magnet.shape[..] {
            "block" => Outline::Rectangle,
            "disc" => Outline::Disc,
            _ => return None,
        };
        let stands = magnet.up.is_some();
        let [x, y] = magnet.position_m;
        let corners = match outline {
            Outline::Disc if stands => {
                let turns = (0..64).map(|k| std::f64::consts::TAU / 64.0 * f64::from(k));
                turns
                    .map(|it| [0.5 * l * libm::cos(it), 0.5 * l * libm::sin(it)])
                    .collect()
            }
            _ => [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]
                .map(|[u, v]| [0.5 * u * l, 0.5 * v * w])
                .to_vec(),
        };
        Some(Self {
            position: magnet.position_m,
            moment: match magnet.up {
                Some(up) => [0.0, 0.0, up * m],
                None => [m * cosine, m * sine, 0.0],
            },
            angle: magnet.angle,
            size: magnet.size_m,
            outline,
            stands,
            face: magnet.face,
            radius: match outline {
                Outline::Disc if stands => 0.5 * l,
                _ => 0.5 * libm::hypot(l, w),
            },
            shield: face.shield.map(|shield| (shield, face.normal)),
            rim: Rim::new(placed(&corners, [x, y, magnet.angle])),
        })
    }

    /// Its place, its moment and the normal of its face on a tile at a pose.
    fn still(&self, [x, y, theta]: Pose) -> Still {
        let (sine, cosine) = (libm::sin(theta), libm::cos(theta));
        let turned = |p: [f64; 2]| [cosine * p[0] - sine * p[1], sine * p[0] + cosine * p[1]];
        let [a, b] = turned(self.position);
        let [mx, my] = turned([self.moment[0], self.moment[1]]);
        Still {
            place: [x + a, y + b],
            moment: [mx, my, self.moment[2]],
            shield: self.shield.map(|(shield, normal)| (shield, turned(normal))),
        }
    }

    /// Its place, its moment and the normal of its face on a tile that is turned and moved.
    fn moved(&self, turn: [Jet; 2], by: Flat) -> Placed {
        let constant = |v: [f64; 2]| turned(v.map(Jet::of), turn);
        let [x, y] = constant(self.position);
        let [mx, my] = constant([self.moment[0], self.moment[1]]);
        Placed {
            place: [x + by[0], y + by[1]],
            axis: constant([libm::cos(self.angle), libm::sin(self.angle)]),
            moment: [mx, my, Jet::of(self.moment[2])],
            shield: self
                .shield
                .map(|(shield, normal)| (shield, constant(normal))),
        }
    }

    /// Where its pieces are from its centre, as many along it as across it: anywhere in each. Of discs, too,
    /// halves and quarters are equal.
    fn places(&self, placed: &Placed, pieces: u8) -> Vec<Flat> {
        let axis = placed.axis;
        let side = [Jet::of(0.0) - axis[1], axis[0]];
        let offset = |k: u8, size: f64| {
            let edge = |k: u8| size * (f64::from(k) / f64::from(pieces) - 0.5);
            Jet::within(Interval::new(edge(k), edge(k + 1)))
        };
        let [l, w, _] = self.size;
        let all = (0..pieces).flat_map(|i| (0..pieces).map(move |j| (i, j)));
        all.map(|(i, j)| [0, 1].map(|k| offset(i, l) * axis[k] + offset(j, w) * side[k]))
            .collect()
    }

    /// The magnitude of its moment (A m^2).
    fn strength(&self) -> f64 {
        let [x, y, z] = self.moment;
        (x * x + y * y + z * z).sqrt()
    }

    /// Its kind, if it is a disc that stands.
    fn disc(&self) -> Option<Disc> {
        let is_one = self.stands && self.outline == Outline::Disc;
        is_one.then_some([self.moment[2], self.size[0], self.size[2]])
    }

    /// Its pole faces, on a tile at this pose, with their charges (A / m).
    fn faces(&self, pose: Pose) -> [ChargedFace; 2] {
        let [l, w, h] = self.size;
        let turn = pose[2] + self.angle;
        let axis = [libm::cos(turn), libm::sin(turn)];
        let (sine, cosine) = (libm::sin(pose[2]), libm::cos(pose[2]));
        let [x, y] = self.position;
        let centre = [
            pose[0] + cosine * x - sine * y,
            pose[1] + sine * x + cosine * y,
        ];
        let volume = match self.outline {
            Outline::Rectangle => l * w * h,
            Outline::Disc => l * w * h * std::f64::consts::FRAC_PI_4,
        };
        let [mx, my, mz] = self.moment;
        let strength = match self.stands {
            true => mz / volume,
            false => libm::hypot(mx, my) / volume,
        };
        let across = [-axis[1], axis[0]];
        [1.0, -1.0].map(|sign| {
            let charge = sign * strength;
            match self.stands {
                true => {
                    let place = (centre, Some(0.5 * sign * h));
                    ChargedFace::new(self.outline, place, axis, [0.5 * l, 0.5 * w], charge)
                }
                false => {
                    let middle = [0, 1].map(|k| centre[k] + 0.5 * sign * l * axis[k]);
                    ChargedFace::new(
                        self.outline,
                        (middle, None),
                        across,
                        [0.5 * w, 0.5 * h],
                        charge,
                    )
                }
            }
        })
    }
}

/// A magnet at a pose.
struct Still {
    place: [f64; 2],
    moment: [f64; 3],
    shield: Option<(Shield, [f64; 2])>,
}

impl Still {
    /// The factor of its shield towards a place `to` away.
    fn factor(&self, to: [f64; 2]) -> f64 {
        let Some((shield, normal)) = self.shield else {
            return 1.0;
        };
        let r = libm::hypot(to[0], to[1]);
        let ratio = r / shield.length_m;
        let behind = 1.0 - shield.attenuation / (1.0 + ratio * ratio);
        let cosine = (normal[0] * to[0] + normal[1] * to[1]) / r;
        let front = 1.0 / (1.0 + libm::exp(-cosine / shield.width));
        behind + (shield.front_gain - behind) * front
    }
}

/// A magnet anywhere on a part of a motion.
struct Placed {
    place: Flat,
    /// Along its first size.
    axis: Flat,
    moment: [Jet; 3],
    shield: Option<(Shield, Flat)>,
}

impl Placed {
    /// The factor of its shield towards a place `to` away, at the distance whose inverse is given.
    fn factor(&self, to: Flat, square: Jet, inverse: Jet) -> Jet {
        let Some((shield, normal)) = self.shield else {
            return Jet::of(1.0);
        };
        let one = Jet::of(1.0);
        let ratio = square * Jet::of(1.0 / (shield.length_m * shield.length_m));
        let behind = one - Jet::of(shield.attenuation) * (one + ratio).inverted();
        let cosine = dot(&normal, &to) * inverse;
        let front = (cosine * Jet::of(1.0 / shield.width)).logistic();
        behind + (Jet::of(shield.front_gain) - behind) * front
    }
}

impl Magnets {
    /// The magnets of two tiles.
    ///
    /// # Errors
    /// If this reader has no formula for them.
    pub fn new(tiles: &Tiles, model: &str, shields: Option<&str>) -> Result<Self, String> {
        let model = match model {
            "dipole" => Model::Dipoles,
            "cuboid" => Model::Bodies,
            other => return Err(format!("magnets as {other:?} are unknown here")),
        };
        let middles = |tile: &Tile| tile.faces.iter().map(|face| face.middle_m).collect();
        let middles = match shields {
            None | Some("smooth") => None,
            Some("nearest-face") => Some([middles(&tiles.fixed), middles(&tiles.moving)]),
            Some(other) => return Err(format!("shields by the rule {other:?} are unknown here")),
        };
        let sources = |tile: &Tile| -> Option<Vec<ShieldedMagnet>> {
            tile.magnets
                .iter()
                .map(|it| ShieldedMagnet::new(tile, it))
                .collect()
        };
        let both = sources(&tiles.fixed).zip(sources(&tiles.moving));
        let (fixed, moving) = both
            .ok_or("a magnet is on a face that the tile does not have, or of an unknown shape")?;
        let mut radial: Vec<([Disc; 2], Radial)> = Vec::new();
        if model == Model::Bodies {
            for (target, source) in fixed
                .iter()
                .flat_map(|a| moving.iter().map(move |b| (a, b)))
            {
                if let Some(kinds) = kinds(target, source)
                    && radial.iter().all(|it| it.0 != kinds)
                {
                    // About the same place.
                    let [first, second] = [target, source]
                        .map(|it| it.faces([0.0; 3]).map(|face| face.moved([0.0; 2])));
                    radial.push((kinds, Radial::new(&first, &second)));
                }
            }
        }
        Ok(Self {
            model,
            fixed,
            moving,
            radial,
            middles,
        })
    }

    fn radial(&self, target: &ShieldedMagnet, source: &ShieldedMagnet) -> Option<&Radial> {
        let kinds = kinds(target, source)?;
        let found = self.radial.iter().find(|it| it.0 == kinds);
        found.map(|it| &it.1)
    }

    pub fn model(&self) -> Model {
        self.model
    }

    /// Whether discs overlap each other or other magnets at a pose by more than a length (m), as those that
    /// break through a surface may: a disc's axis at imaginary heights, by which analyses compute its
    /// energy, does not stand for it there. Magnets that are there cannot be.
    pub fn overlap(&self, pose: Pose, by: f64) -> bool {
        if self.model == Model::Dipoles {
            return false;
        }
        self.moving.iter().any(|source| {
            let place = source.still(pose).place;
            self.fixed.iter().any(|target| {
                let acts = source.stands == target.stands;
                let both = [source.outline, target.outline];
                let reach = source.radius + target.radius;
                let [x, y] = target.position;
                let apart = libm::hypot(place[0] - x, place[1] - y);
                acts && both.contains(&Outline::Disc)
                    && apart < reach - by
                    && (kinds(target, source).is_some()
                        || clearance(&target.rim, &source.rim, pose) < -by)
            })
        })
    }

    /// The energy (J) at a pose.
    pub fn energy(&self, pose: Pose) -> f64 {
        match self.nearest_faces(pose).first() {
            Some(faces) => self.of(pose, Some(*faces)),
            None => self.of(pose, None),
        }
    }

    /// The energy (J) at a pose; where it jumps, so that rounding decides, the one that is nearer to what
    /// is stated.
    pub fn energy_beside(&self, stated: f64, pose: Pose) -> f64 {
        let faces = self.nearest_faces(pose);
        let all = faces.into_iter().map(|it| self.of(pose, Some(it)));
        all.min_by(|a, b| (a - stated).abs().total_cmp(&(b - stated).abs()))
            .unwrap_or_else(|| self.of(pose, None))
    }

    /// The two faces whose midpoints are nearest, first, and all that are as near; none if all act.
    fn nearest_faces(&self, [x, y, theta]: Pose) -> Vec<[usize; 2]> {
        let Some([fixed, moving]) = &self.middles else {
            return Vec::new();
        };
        let (sine, cosine) = (libm::sin(theta), libm::cos(theta));
        let mut all = Vec::new();
        for (j, p) in moving.iter().enumerate() {
            let moved = [
                x + cosine * p[0] - sine * p[1],
                y + sine * p[0] + cosine * p[1],
            ];
            for (i, q) in fixed.iter().enumerate() {
                all.push((libm::hypot(moved[0] - q[0], moved[1] - q[1]), [i, j]));
            }
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let least = all.first().map_or(0.0, |it| it.0);
        all.retain(|it| it.0 <= least + EQUAL * (1.0 + least));
        all.into_iter().map(|it| it.1).collect()
    }

    fn of(&self, pose: Pose, faces: Option<[usize; 2]>) -> f64 {
        match self.model {
            Model::Dipoles => self.of_dipoles(pose, faces),
            Model::Bodies => self.of_bodies(pose, faces),
        }
    }

    /// Whether there are bounds of the energy over parts of a motion: not where it jumps.
    fn has_bounds(&self) -> bool {
        self.middles.is_none()
    }

    /// The least second derivative (J) of the energy along a motion over a part of it; minus infinity
    /// where none is known.
    pub fn least_bend(&self, motion: &StraightMotion, part: Interval) -> f64 {
        if !self.has_bounds() {
            return f64::NEG_INFINITY;
        }
        let least = self.along(motion, part).second.low;
        if least.is_finite() {
            least
        } else {
            f64::NEG_INFINITY
        }
    }

    /// A bound of the second derivative (J) of the energy along a motion over a part of it, either way; none
    /// where magnets have shields or may touch. With the n-th derivatives of 1 / r, which are at most
    /// n! / r^(n + 1) in any directions, the energy's is at most
    ///
    /// ```text
    /// mu0 / (4 pi) m1 m2 (24 v^2 / r^5 + 6 a / r^4 + 12 v w / r^4 + 2 w^2 / r^3)
    /// ```
    ///
    /// of a magnet that moves at the speed v, turns by w and is accelerated by a, all for each whole motion.
    /// Bodies are made of elements that are as near as `r` without their radii.
    pub fn most_bend(&self, motion: &StraightMotion, part: Interval) -> Option<f64> {
        let all = || self.fixed.iter().chain(&self.moving);
        if !self.has_bounds() || all().any(|it| it.shield.is_some()) {
            return None;
        }
        let radius = |it: &ShieldedMagnet| match self.model {
            Model::Dipoles => 0.0,
            Model::Bodies => it.radius,
        };
        let [x, y, turn] = [0, 1, 2].map(|k| motion.to[k] - motion.from[k]);
        let pose = motion.at(part.middle());
        let mut sum = 0.0;
        for source in &self.moving {
            let lever = libm::hypot(source.position[0], source.position[1]) + radius(source);
            let speed = libm::hypot(x, y) + lever * turn.abs();
            let moving = source.still(pose);
            for target in &self.fixed {
                let way = [0, 1].map(|k| moving.place[k] - target.position[k]);
                let half = 0.5 * (part.high - part.low);
                let r =
                    libm::hypot(way[0], way[1]) - half * speed - radius(source) - radius(target);
                if r <= 0.0 {
                    return None;
                }
                let bend = 24.0 * speed * speed / (r * r)
                    + (6.0 * lever * turn * turn + 12.0 * speed * turn.abs()) / r
                    + 2.0 * turn * turn;
                sum += source.strength() * target.strength() * bend / (r * r * r);
            }
        }
        // More than all roundings of a sum of positive numbers.
        Some(MU0_OVER_4PI * sum * (1.0 + 1e-9))
    }

    fn along(&self, motion: &StraightMotion, t: Interval) -> Jet {
        let [x, y, theta] = motion.along(t);
        let turn = theta.sine_and_cosine();
        let still = [Jet::of(0.0), Jet::of(1.0)];
        let fixed = self.fixed.iter();
        let fixed: Vec<Placed> = fixed.map(|it| it.moved(still, [Jet::of(0.0); 2])).collect();
        let mut sum = Jet::of(0.0);
        for source in &self.moving {
            let moving = source.moved(turn, [x, y]);
            for (target, place) in self.fixed.iter().zip(&fixed) {
                let way = minus(moving.place, place.place);
                let energy = match (self.model, self.radial(target, source)) {
                    (Model::Dipoles, _) => dipoles(place, &moving, way, Jet::of(0.0)),
                    (Model::Bodies, _) if source.stands != target.stands => continue,
                    (Model::Bodies, Some(radial)) => {
                        let square = way[0].squared() + way[1].squared();
                        let energy = square.composed(radial.over(square.value));
                        Jet::of(MU0_OVER_4PI) * energy
                    }
                    (Model::Bodies, None) => spread([target, source], [place, &moving], way),
                };
                sum = sum + energy * factors(place, &moving, way);
            }
        }
        sum
    }

    fn of_dipoles(&self, pose: Pose, faces: Option<[usize; 2]>) -> f64 {
        let fixed: Vec<Still> = self.fixed.iter().map(|it| it.still([0.0; 3])).collect();
        let mut sum = 0.0;
        for source in &self.moving {
            let moving = source.still(pose);
            for (target, fixed) in self.fixed.iter().zip(&fixed) {
                if faces.is_some_and(|it| it != [target.face, source.face]) {
                    continue;
                }
                let way = [0, 1].map(|k| moving.place[k] - fixed.place[k]);
                let dot = |m: &[f64; 3]| m[0] * way[0] + m[1] * way[1];
                let square = way[0] * way[0] + way[1] * way[1];
                let inverse = 1.0 / square.sqrt();
                let across: f64 = (0..3).map(|k| fixed.moment[k] * moving.moment[k]).sum();
                let along = 3.0 * dot(&fixed.moment) * dot(&moving.moment) / square;
                let energy = MU0_OVER_4PI * (across - along) * inverse * inverse * inverse;
                sum += energy
                    * match faces {
                        Some(_) => 1.0,
                        None => fixed.factor(way) * moving.factor(way.map(|x| -x)),
                    };
            }
        }
        sum
    }

    fn of_bodies(&self, pose: Pose, faces: Option<[usize; 2]>) -> f64 {
        let fixed = self.fixed.iter().map(|it| it.faces([0.0; 3]));
        let fixed: Vec<[ChargedFace; 2]> = fixed.collect();
        let mut sum = 0.0;
        for source in &self.moving {
            let moving = source.faces(pose);
            for (target, fixed) in self.fixed.iter().zip(&fixed) {
                // Of a magnet that stands, one pole is as far from one that lies as the other.
                if source.stands != target.stands
                    || faces.is_some_and(|it| it != [target.face, source.face])
                {
                    continue;
                }
                let known = self.radial(target, source).and_then(|it| {
                    let way = [0, 1].map(|k| moving[0].middle[k] - fixed[0].middle[k]);
                    it.at(way[0] * way[0] + way[1] * way[1])
                });
                let energy = known.unwrap_or_else(|| {
                    let pairs = fixed
                        .iter()
                        .flat_map(|a| moving.iter().map(move |b| (a, b)));
                    pairs.map(|(a, b)| charges::energy(a, b)).sum()
                });
                let factor = match faces {
                    Some(_) => 1.0,
                    None => {
                        let [target, source] = [target.still([0.0; 3]), source.still(pose)];
                        let way = [0, 1].map(|k| source.place[k] - target.place[k]);
                        target.factor(way) * source.factor(way.map(|x| -x))
                    }
                };
                sum += MU0_OVER_4PI * energy * factor;
            }
        }
        sum
    }
}

/// The kinds of two discs, if both stand.
fn kinds(target: &ShieldedMagnet, source: &ShieldedMagnet) -> Option<[Disc; 2]> {
    Some([target.disc()?, source.disc()?])
}

/// The product of the two shields' factors.
fn factors(first: &Placed, second: &Placed, way: Flat) -> Jet {
    if first.shield.is_none() && second.shield.is_none() {
        return Jet::of(1.0);
    }
    let square = way[0].squared() + way[1].squared();
    let inverse = square.over_root(1);
    let back = [Jet::of(0.0) - way[0], Jet::of(0.0) - way[1]];
    first.factor(way, square, inverse) * second.factor(back, square, inverse)
}

/// (mu0 / 4 pi) (m1 m2 / r^3 - 3 (m1 r) (m2 r) / r^5), with the square of the difference in height. Dipoles
/// that differ in it both lie in the plane, or both stand.
fn dipoles(first: &Placed, second: &Placed, way: Flat, height: Jet) -> Jet {
    let square = way[0].squared() + way[1].squared() + height;
    let across = dot(&first.moment, &second.moment) * square.over_root(3);
    let [along, other] = [&first.moment, &second.moment].map(|m| dot(&m[..2], &way));
    let upwards = first.moment[2] * second.moment[2] * height;
    let along = Jet::of(3.0) * (along * other + upwards) * square.over_root(5);
    Jet::of(MU0_OVER_4PI) * (across - along)
}

/// Two magnets, as dipoles anywhere in them: the energy of two magnets is the mean of that of their
/// elements, wherever they do not touch. Near ones are cut in pieces, whose places are known better.
fn spread([fixed, moving]: [&ShieldedMagnet; 2], [first, second]: [&Placed; 2], way: Flat) -> Jet {
    let distance = (way[0].squared() + way[1].squared()).value.root().low;
    let pieces = if distance > 4.0 * (fixed.radius + moving.radius) {
        1
    } else {
        2
    };
    let (of_fixed, of_moving) = (fixed.places(first, pieces), moving.places(second, pieces));
    let height = 0.5 * (fixed.size[2] + moving.size[2]);
    let height = Jet::within(Interval::new(0.0, height * height));
    let mut sum = Jet::of(0.0);
    for here in &of_moving {
        for there in &of_fixed {
            let way = [0, 1].map(|k| way[k] + here[k] - there[k]);
            sum = sum + dipoles(first, second, way, height);
        }
    }
    sum * Jet::of(1.0 / (of_fixed.len() * of_moving.len()) as f64)
}
