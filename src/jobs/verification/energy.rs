//! The energy of two tiles' magnets along a straight motion: point dipoles, and blocks as pairs of
//! charged faces.
//!
//! Written without the potentials of this crate, by other formulas where there are any: dipoles in
//! interval arithmetic from the definition; blocks by a closed form of three of the four integrals
//! over two pole faces and adaptive quadrature of the last, which is estimated, not bounded.

use super::blocks::{self, Sheet};
use super::given::{Magnet, Pose, Shield, Tile, Tiles};
use super::interval::{Interval, Jet};

/// mu0 / 4 pi (T m / A).
const MU0_OVER_4PI: f64 = 1e-7;

/// How magnets are modelled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Model {
    Dipoles,
    Blocks,
}

/// The magnets of two tiles.
pub(super) struct Magnets {
    model: Model,
    fixed: Vec<Source>,
    moving: Vec<Source>,
}

/// A magnet with the shield behind it.
struct Source {
    position: [f64; 2],
    /// Along x, y and z (A m^2).
    moment: [f64; 3],
    angle: f64,
    size: [f64; 3],
    /// Distance (m) from its centre to its farthest corner in the plane.
    radius: f64,
    shield: Option<(Shield, [f64; 2])>,
}

/// A straight motion from one pose to another, the shorter way round.
#[derive(Clone, Copy)]
pub(super) struct Motion {
    from: Pose,
    to: Pose,
}

impl Motion {
    pub fn new(from: Pose, to: Pose) -> Self {
        let turn = to[2] - from[2];
        let turn = turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round();
        let to = [to[0], to[1], from[2] + turn];
        Self { from, to }
    }

    pub fn rest(at: Pose) -> Self {
        Self { from: at, to: at }
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

impl Source {
    fn new(tile: &Tile, magnet: &Magnet) -> Option<Self> {
        let (sine, cosine) = (libm::sin(magnet.angle), libm::cos(magnet.angle));
        let m = magnet.moment;
        let face = tile.faces.get(magnet.face)?;
        let [l, w, _] = magnet.size_m;
        Some(Self {
            position: magnet.position_m,
            moment: match magnet.up {
                Some(up) => [0.0, 0.0, up * m],
                None => [m * cosine, m * sine, 0.0],
            },
            angle: magnet.angle,
            size: magnet.size_m,
            radius: 0.5 * libm::hypot(l, w),
            shield: face.shield.map(|shield| (shield, face.normal)),
        })
    }

    /// Its place, its moment and the normal of its face on a tile that is turned and moved.
    fn moved(&self, turn: [Jet; 2], by: Flat) -> Placed {
        let constant = |v: [f64; 2]| turned(v.map(Jet::of), turn);
        let [x, y] = constant(self.position);
        let [mx, my] = constant([self.moment[0], self.moment[1]]);
        Placed {
            place: [x + by[0], y + by[1]],
            moment: [mx, my, Jet::of(self.moment[2])],
            shield: self
                .shield
                .map(|(shield, normal)| (shield, constant(normal))),
        }
    }

    /// Where its pieces are from its centre, as many along it as across it: anywhere in each.
    fn places(&self, placed: &Placed, pieces: u8) -> Vec<Flat> {
        let strength = libm::hypot(self.moment[0], self.moment[1]);
        let axis = [placed.moment[0], placed.moment[1]].map(|m| m * Jet::of(1.0 / strength));
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

    /// Its pole faces, on a tile at this pose, with their charges (A / m).
    fn sheets(&self, pose: Pose) -> [Sheet; 2] {
        let [l, w, h] = self.size;
        let turn = pose[2] + self.angle;
        let axis = [libm::cos(turn), libm::sin(turn)];
        let (sine, cosine) = (libm::sin(pose[2]), libm::cos(pose[2]));
        let [x, y] = self.position;
        let centre = [
            pose[0] + cosine * x - sine * y,
            pose[1] + sine * x + cosine * y,
        ];
        let strength = libm::hypot(self.moment[0], self.moment[1]) / (l * w * h);
        [1.0, -1.0].map(|sign| {
            let at = |k: usize| centre[k] + 0.5 * sign * l * axis[k];
            Sheet {
                middle: [at(0), at(1)],
                along: [-axis[1], axis[0]],
                half: [0.5 * w, 0.5 * h],
                charge: sign * strength,
            }
        })
    }
}

struct Placed {
    place: Flat,
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
            "cuboid" => Model::Blocks,
            other => return Err(format!("magnets as {other:?} are unknown here")),
        };
        if shields.is_some_and(|rule| rule != "smooth") {
            return Err("the energy of the nearest-face rule is discontinuous".to_owned());
        }
        let magnets = || tiles.fixed.magnets.iter().chain(&tiles.moving.magnets);
        if model == Model::Blocks && magnets().any(|it| it.shape != "block" || it.up.is_some()) {
            return Err("there is no second formula for discs and upright blocks".to_owned());
        }
        let sources = |tile: &Tile| -> Option<Vec<Source>> {
            tile.magnets
                .iter()
                .map(|it| Source::new(tile, it))
                .collect()
        };
        let both = sources(&tiles.fixed).zip(sources(&tiles.moving));
        let (fixed, moving) = both.ok_or("a magnet is on a face that the tile does not have")?;
        Ok(Self {
            model,
            fixed,
            moving,
        })
    }

    pub fn model(&self) -> Model {
        self.model
    }

    /// The energy (J) at a pose.
    pub fn energy(&self, pose: Pose) -> f64 {
        match self.model {
            Model::Dipoles => self
                .along(&Motion::rest(pose), Interval::of(0.0))
                .value
                .middle(),
            Model::Blocks => self.of_blocks(pose),
        }
    }

    /// The least second derivative (J) of the energy along a motion over a part of it; minus infinity
    /// where none is known.
    pub fn least_bend(&self, motion: &Motion, part: Interval) -> f64 {
        let least = self.along(motion, part).second.low;
        if least.is_finite() {
            least
        } else {
            f64::NEG_INFINITY
        }
    }

    fn along(&self, motion: &Motion, t: Interval) -> Jet {
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
                let energy = match self.model {
                    Model::Dipoles => dipoles(place, &moving, way, Jet::of(0.0)),
                    Model::Blocks => spread([target, source], [place, &moving], way),
                };
                sum = sum + energy * factors(place, &moving, way);
            }
        }
        sum
    }

    fn of_blocks(&self, pose: Pose) -> f64 {
        let still = [0.0; 3];
        let mut sum = 0.0;
        for source in &self.moving {
            let moving = source.sheets(pose);
            for target in &self.fixed {
                let fixed = target.sheets(still);
                let energy: f64 = fixed
                    .iter()
                    .flat_map(|a| moving.iter().map(move |b| blocks::energy(a, b)))
                    .sum();
                sum += MU0_OVER_4PI * energy * factor_at(target, source, pose);
            }
        }
        sum
    }
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

fn factor_at(fixed: &Source, moving: &Source, [x, y, theta]: Pose) -> f64 {
    let turn = [Jet::of(libm::sin(theta)), Jet::of(libm::cos(theta))];
    let moving = moving.moved(turn, [Jet::of(x), Jet::of(y)]);
    let fixed = fixed.moved([Jet::of(0.0), Jet::of(1.0)], [Jet::of(0.0); 2]);
    let way = minus(moving.place, fixed.place);
    factors(&fixed, &moving, way).value.middle()
}

/// (mu0 / 4 pi) (m1 m2 / r^3 - 3 (m1 r) (m2 r) / r^5), with the square of the difference in height. Only
/// dipoles that lie in the plane may differ in it.
fn dipoles(first: &Placed, second: &Placed, way: Flat, height: Jet) -> Jet {
    let square = way[0].squared() + way[1].squared() + height;
    let across = dot(&first.moment, &second.moment) * square.over_root(3);
    let [along, other] = [&first.moment, &second.moment].map(|m| dot(&m[..2], &way));
    let along = Jet::of(3.0) * along * other * square.over_root(5);
    Jet::of(MU0_OVER_4PI) * (across - along)
}

/// Two blocks, as dipoles anywhere in them: the energy of two blocks is the mean of that of their
/// elements, wherever they do not touch. Near blocks are cut in pieces, whose places are known better.
fn spread([fixed, moving]: [&Source; 2], [first, second]: [&Placed; 2], way: Flat) -> Jet {
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
