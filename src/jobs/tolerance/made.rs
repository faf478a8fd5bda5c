//! Tiles as they are made: magnets drawn about their nominal values.
//!
//! For each draw and each magnet of either tile, independently:
//!
//! - *strength*: the moment times `1 + F (sqrt(B) z0 + sqrt(1 - B) z)`, at least 0; z0 is common to
//!   all magnets of the draw, B is the share of the variance in common (`--batch`);
//! - *place*: a shift by `L z` along the face and by another `L z` across it;
//! - *turn*: a turn by `A z` about the magnet's centre, in the tiles' plane;
//! - *flip*: with the chance P its poles are exchanged.
//!
//! For each face with magnets, independently: *gap*, a layer of `L |z| / 2`, so that two touching
//! faces are apart by the sum of two layers, `0.8 L` on average. It is computed as magnets that lie
//! deeper in their face by the layer.
//!
//! All z are normal with mean 0 and variance 1. A magnet never sticks out of its face: one that a
//! shift or a turn would push beyond the surface ends at the surface, as it does against a mould.
//! The same random numbers are used whatever the sizes of the errors.

use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::request::MakingErrors;
use physics::configuration::wrap_angle;
use physics::dynamics::normal;
use physics::tile::{Magnet, Pair, Tile};

/// How a magnet of a draw differs from the nominal one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Its moment over the nominal one; not negative.
    pub strength: f64,
    /// Its relative error: the part that all magnets of the draw have in common, and its own.
    pub strengths: [f64; 2],
    /// Whether its poles are exchanged.
    pub is_flipped: bool,
    /// The shift (m) by the error of its place, in the tile's frame.
    pub place: Vector2<f64>,
    /// The turn (rad).
    pub turn: f64,
    /// The shift (m) that keeps the turned magnet behind its surface.
    pub pushed: Vector2<f64>,
    /// The shift (m) by the layer on its face.
    pub layer: Vector2<f64>,
}

impl Change {
    /// No change.
    pub const NONE: Self = Self {
        strength: 1.0,
        strengths: [0.0; 2],
        is_flipped: false,
        place: Vector2::new(0.0, 0.0),
        turn: 0.0,
        pushed: Vector2::new(0.0, 0.0),
        layer: Vector2::new(0.0, 0.0),
    };

    /// The shift of its centre (m), in the tile's frame.
    pub fn shift(&self) -> Vector2<f64> {
        self.place + self.pushed + self.layer
    }

    /// The factor of the moment, negative with exchanged poles.
    pub fn factor(&self) -> f64 {
        match self.is_flipped {
            true => -self.strength,
            false => self.strength,
        }
    }

    /// The magnet as it is made.
    fn of(&self, magnet: &Magnet) -> Magnet {
        let made = Magnet {
            position: magnet.position + self.shift(),
            angle: wrap_angle(magnet.angle + self.turn),
            // A magnet without a moment has no direction.
            moment: (magnet.moment * self.strength).max(f64::MIN_POSITIVE),
            ..magnet.clone()
        };
        match self.is_flipped {
            true => made.reversed(),
            false => made,
        }
    }
}

/// The changes of a draw: of the magnets of the fixed tile, and of the moving one.
pub type Draw = [Vec<Change>; 2];

/// What is drawn from: the magnets with the room in front of them.
pub struct Maker<'a> {
    pair: &'a Pair,
    making: MakingErrors,
    seed: u64,
    seats: [Vec<Seat>; 2],
}

/// The seat of a magnet.
struct Seat {
    /// The outward normal of its face.
    normal: Vector2<f64>,
    /// The outline about its centre (m).
    outline: Vec<Vector2<f64>>,
    /// The distance (m) from its outermost point to the surface.
    room: f64,
    face: usize,
}

/// Points this close (m) to the outermost one are as far out.
const AS_FAR: f64 = 1e-6;

impl Seat {
    fn new(tile: &Tile, magnet: &Magnet) -> Self {
        let normal = tile.faces[magnet.face].normal();
        let corners = magnet.outline();
        let outline: Vec<_> = corners.iter().map(|p| p - magnet.position).collect();
        let top = height(&outline, normal, 0.0);
        let outermost = corners
            .iter()
            .zip(&outline)
            .filter(|(_, p)| p.dot(&normal) > top - AS_FAR);
        let walls = outermost.map(|(p, _)| -tile.outline.signed_distance(*p));
        let room = walls.fold(f64::INFINITY, f64::min).max(0.0);
        Self {
            normal,
            outline,
            room,
            face: magnet.face,
        }
    }
}

/// The height (m) of the outermost point of a turned outline over its centre.
fn height(outline: &[Vector2<f64>], normal: Vector2<f64>, turn: f64) -> f64 {
    let (sin, cos) = libm::sincos(turn);
    // Turns the normal back instead of all points forth.
    let back = Vector2::new(
        cos * normal.x + sin * normal.y,
        cos * normal.y - sin * normal.x,
    );
    let heights = outline.iter().map(|p| p.dot(&back));
    heights.fold(f64::NEG_INFINITY, f64::max)
}

impl<'a> Maker<'a> {
    /// The maker of a design's tiles, with these errors.
    pub fn new(pair: &'a Pair, making: &MakingErrors, seed: u64) -> Self {
        let seats = |tile: &Tile| tile.magnets.iter().map(|it| Seat::new(tile, it)).collect();
        Self {
            pair,
            making: *making,
            seed,
            seats: [seats(&pair.fixed), seats(&pair.moving)],
        }
    }

    /// The draw of a number, the same on any number of threads.
    pub fn draw(&self, number: usize) -> Draw {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        rng.set_stream(number as u64);
        let common = normal(&mut rng);
        let [fixed, moving] = [&self.pair.fixed, &self.pair.moving].map(|tile| tile.faces.len());
        let mut layers = |faces| -> Vec<f64> { (0..faces).map(|_| normal(&mut rng)).collect() };
        let layers = [layers(fixed), layers(moving)];
        [0, 1].map(|tile| {
            let seats = self.seats[tile].iter();
            seats
                .map(|seat| self.change(seat, common, layers[tile][seat.face], &mut rng))
                .collect()
        })
    }

    fn change(&self, seat: &Seat, common: f64, layer: f64, rng: &mut ChaCha8Rng) -> Change {
        let [strength, place, turn, gap] = self.making.spreads();
        let batch = self.making.batch.unwrap_or_default();
        let own = normal(rng);
        let along = normal(rng);
        let across = normal(rng);
        let turned = normal(rng);
        let luck: f64 = rng.random();
        let normal = seat.normal;
        let tangent = Vector2::new(-normal.y, normal.x);
        let out = (place * across).min(seat.room);
        let turn = turn * turned;
        let higher = height(&seat.outline, normal, turn) - height(&seat.outline, normal, 0.0);
        let beyond = (out + higher - seat.room).max(0.0);
        let common = strength * batch.sqrt() * common;
        let own = (strength * (1.0 - batch).sqrt() * own).max(-1.0 - common);
        Change {
            strength: (1.0 + common + own).max(0.0),
            strengths: [common, own],
            is_flipped: luck < self.making.flip.unwrap_or_default(),
            place: tangent * (place * along) + normal * out,
            turn,
            pushed: -normal * beyond,
            layer: -normal * (gap * layer.abs() / 2.0),
        }
    }

    /// The tiles of a draw.
    pub fn pair(&self, draw: &Draw) -> Pair {
        made(self.pair, draw)
    }
}

/// The tiles of a pair with changed magnets. Nothing counts as equal by symmetry any more.
fn made(pair: &Pair, draw: &Draw) -> Pair {
    let tile = |tile: &Tile, changes: &[Change]| Tile {
        magnets: changes
            .iter()
            .zip(&tile.magnets)
            .map(|(change, magnet)| change.of(magnet))
            .collect(),
        ..tile.clone()
    };
    Pair {
        fixed: tile(&pair.fixed, &draw[0]),
        moving: tile(&pair.moving, &draw[1]),
        only: true,
        ..pair.clone()
    }
}
