//! Where tiles are when a run begins.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::crowd::Crowd;
use super::mover::Mover;
use super::neighbours::Neighbours;
use crate::configuration::{Configuration, wrap_angle};
use crate::contact::TOUCH;
use crate::dynamics::{Motion, thermal_velocity};

/// Tiles placed at random are at least so far from each other and from the rim, as a share of the
/// smallest one's circumradius.
const ROOM: f64 = 1.0 / 150.0;
/// Places tried for a tile, before the others are moved about.
const TRIES: usize = 2_000;
/// How often they are, and how many steps each makes every time, of up to this share of its
/// circumradius, and as many radians.
const SHUFFLES: usize = 500;
const WANDERED: usize = 5;
const STRIDE: f64 = 0.3;

/// Most squares along a side of the table by which tiles are looked up.
const MOST_SQUARES: f64 = 1e3;

/// A tile's kind and where it is.
type Place = (usize, Configuration);

/// Why a run cannot begin.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StartError {
    /// Their area alone is too large.
    #[error("{tiles} tiles of {area:.3} m2 together do not fit on a table of {table:.3} m2")]
    TooMany {
        /// How many.
        tiles: usize,
        /// What they cover (m^2).
        area: f64,
        /// The table (m^2).
        table: f64,
    },
    /// No place was found.
    #[error(
        "no free place was found for tile {tile} of {tiles}, wherever the others went: tiles at random places \
         block each other before a table is full; here they would cover {share:.2} of it"
    )]
    NoRoom {
        /// Its number, from 0.
        tile: usize,
        /// Of how many.
        tiles: usize,
        /// Coverage of all tiles.
        share: f64,
    },
    /// Two of the tiles given.
    #[error("tiles {first} and {second} overlap by {depth:.3e} m")]
    Overlap {
        /// Its number, from 0.
        first: usize,
        /// The other's.
        second: usize,
        /// How deep (m).
        depth: f64,
    },
    /// One of the tiles given.
    #[error("tile {tile} reaches {beyond:.3e} m beyond the rim")]
    BeyondRim {
        /// Its number, from 0.
        tile: usize,
        /// How far (m).
        beyond: f64,
    },
}

/// The clearance (m) of two tiles, or any number above `enough` where it is more.
fn clearance(crowd: &Crowd, [a, b]: [(usize, Configuration); 2], enough: f64) -> f64 {
    let (couple, swapped) = crowd.couple(a.0, b.0);
    let [first, second] = if swapped { [&b, &a] } else { [&a, &b] };
    let apart = (a.1.position() - b.1.position()).norm() - couple.radii();
    if apart > enough {
        return apart;
    }
    let q = super::pair::relative(&first.1, &second.1);
    let bound = couple.contact.clearance_bound(&q);
    if bound > enough {
        return bound;
    }
    couple.contact.clearance(&q)
}

/// So many tiles of each kind, at places and in orientations drawn evenly from those where they are
/// free of the tiles before; at rest, or where kT (J) is given with velocities of that temperature.
///
/// # Errors
/// Where there is no room.
pub fn at_random(
    crowd: &Crowd,
    counts: &[usize],
    kt: Option<f64>,
    rng: &mut ChaCha8Rng,
) -> Result<Vec<Mover>, StartError> {
    let tiles: usize = counts.iter().sum();
    let of_kind = counts.iter().zip(&crowd.kinds);
    let area: f64 = of_kind
        .map(|(count, kind)| *count as f64 * kind.tile.outline.area())
        .sum();
    let table = crowd.area();
    if area > table {
        return Err(StartError::TooMany { tiles, area, table });
    }
    // One of each kind in turn, so that no kind has the best places.
    let most = counts.iter().copied().max().unwrap_or(0);
    let turns = (0..most).flat_map(|turn| (0..counts.len()).map(move |kind| (turn, kind)));
    let mut placed = Placed::new(crowd);
    for (_, kind) in turns.filter(|(turn, kind)| *turn < counts[*kind]) {
        let mut rounds = 0..SHUFFLES;
        let q = loop {
            if let Some(q) = free_place(&placed, kind, rng) {
                break q;
            }
            // Those that are there block each other's gaps: they make room by wandering.
            if rounds.next().is_none() {
                return Err(StartError::NoRoom {
                    tile: placed.tiles.len(),
                    tiles,
                    share: area / table,
                });
            }
            shuffle(&mut placed, rng);
        };
        placed.add((kind, q));
    }
    let mut placed = placed.tiles;
    placed.sort_by_key(|(kind, _)| *kind);
    let mover = |(kind, configuration): (usize, Configuration)| {
        let velocity = match kt {
            Some(kt) => thermal_velocity(&crowd.kinds[kind].body, kt, rng),
            None => Vector3::zeros(),
        };
        let motion = Motion {
            configuration,
            velocity,
        };
        Mover::new(crowd, kind, &motion)
    };
    Ok(placed.into_iter().map(mover).collect())
}

/// Tiles that have a place, and by squares of the table who is where.
struct Placed<'a> {
    crowd: &'a Crowd,
    tiles: Vec<Place>,
    /// How far apart they are at least (m).
    room: f64,
    /// Squares along x and y, at least as wide as tiles reach to each other.
    squares: [usize; 2],
    /// The tiles whose reference points lie in each.
    there: Vec<Vec<usize>>,
}

impl<'a> Placed<'a> {
    fn new(crowd: &'a Crowd) -> Self {
        let radii = crowd.kinds.iter().map(|it| it.tile.outline.circumradius());
        let room = ROOM * radii.clone().fold(f64::INFINITY, f64::min);
        let widest = 2.0 * radii.fold(0.0, f64::max) + room;
        let squares = crowd
            .half_size
            .map(|half| (2.0 * half / widest).floor().clamp(1.0, MOST_SQUARES) as usize);
        Self {
            crowd,
            tiles: Vec::new(),
            room,
            squares,
            there: vec![Vec::new(); squares[0] * squares[1]],
        }
    }

    /// The square along x and y that a point lies in.
    fn square(&self, q: &Configuration) -> [usize; 2] {
        [0, 1].map(|axis| {
            let (half, count) = (self.crowd.half_size[axis], self.squares[axis]);
            let share = (q.position()[axis] + half) / (2.0 * half);
            (share * count as f64).clamp(0.0, count as f64 - 1.0) as usize
        })
    }

    fn in_square(&mut self, q: &Configuration) -> &mut Vec<usize> {
        let [column, row] = self.square(q);
        &mut self.there[row * self.squares[0] + column]
    }

    fn add(&mut self, (kind, q): Place) {
        let tile = self.tiles.len();
        self.in_square(&q).push(tile);
        self.tiles.push((kind, q));
    }

    fn shift(&mut self, tile: usize, to: Configuration) {
        let from = self.tiles[tile].1;
        self.in_square(&from).retain(|other| *other != tile);
        self.in_square(&to).push(tile);
        self.tiles[tile].1 = to;
    }

    /// Whether a tile would be on the table there and clear of all others but one.
    fn is_free(&self, (kind, q): Place, but: Option<usize>) -> bool {
        let motion = Motion {
            configuration: q,
            velocity: Vector3::zeros(),
        };
        if Mover::new(self.crowd, kind, &motion).beyond(self.crowd) > -self.room {
            return false;
        }
        let [columns, rows] = [0, 1].map(|axis| {
            let at = self.square(&q)[axis];
            at.saturating_sub(1)..(at + 2).min(self.squares[axis])
        });
        let squares = rows.flat_map(|row| columns.clone().map(move |column| (row, column)));
        let others = squares.flat_map(|(row, column)| &self.there[row * self.squares[0] + column]);
        others.filter(|other| Some(**other) != but).all(|other| {
            clearance(self.crowd, [(kind, q), self.tiles[*other]], self.room) >= self.room
        })
    }
}

fn free_place(placed: &Placed, kind: usize, rng: &mut ChaCha8Rng) -> Option<Configuration> {
    (0..TRIES).find_map(|_| {
        crate::interruption::check();
        let mut even = |half: f64| half * (2.0 * rng.random::<f64>() - 1.0);
        let [x, y] = placed.crowd.half_size;
        let q = Configuration::new(even(x), even(y), wrap_angle(even(0.5 * TAU)));
        placed.is_free((kind, q), None).then_some(q)
    })
}

/// Moves each tile in turn a little at random, where that leaves it free: all that is kept of where it was
/// is that tiles do not overlap.
fn shuffle(placed: &mut Placed, rng: &mut ChaCha8Rng) {
    for _ in 0..WANDERED {
        for tile in 0..placed.tiles.len() {
            crate::interruption::check();
            let (kind, q) = placed.tiles[tile];
            let mut even = || 2.0 * rng.random::<f64>() - 1.0;
            let outline = &placed.crowd.kinds[kind].tile.outline;
            let reach = STRIDE * outline.circumradius();
            let step = Vector3::new(even() * reach, even() * reach, even() * STRIDE);
            let moved = q.moved(step);
            let moved = Configuration::new(moved.x, moved.y, wrap_angle(moved.theta));
            if placed.is_free((kind, moved), Some(tile)) {
                placed.shift(tile, moved);
            }
        }
    }
}

/// Whether tiles are free of each other and on the table.
///
/// # Errors
/// Where they are not.
pub fn check(crowd: &Crowd, movers: &[Mover], walls: bool) -> Result<(), StartError> {
    let place = |mover: &Mover| {
        let q = super::pair::configuration(crowd, mover);
        (mover.kind, q)
    };
    for (tile, mover) in movers.iter().enumerate() {
        let beyond = mover.beyond(crowd);
        if walls && beyond > TOUCH {
            return Err(StartError::BeyondRim { tile, beyond });
        }
    }
    let places: Vec<_> = movers.iter().map(place).collect();
    let positions: Vec<_> = places.iter().map(|it| it.1.position()).collect();
    let widest = crowd.kinds.iter().map(|it| it.tile.outline.circumradius());
    let widest = 2.0 * widest.fold(0.0, f64::max);
    let mut worst = (TOUCH, None);
    for &[first, second] in Neighbours::default().within(widest, &positions) {
        let depth = -clearance(crowd, [places[first], places[second]], 0.0);
        if depth > worst.0 {
            let overlap = StartError::Overlap {
                first,
                second,
                depth,
            };
            worst = (depth, Some(overlap));
        }
    }
    worst.1.map_or(Ok(()), Err)
}
