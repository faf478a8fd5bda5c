//! The positions and velocities of the tiles when a run begins.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use rand::RngExt;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use super::crowd::Crowd;
use super::neighbours::Neighbours;
use crate::rigid::thermal_velocity;
use crate::rigid::{Motion, Mover, Pose};
use tiles::configuration::{Configuration, wrap_angle};
use tiles::tile::outline::Bounds;
use tiles::units::si;

/// Smallest distance of randomly placed tiles from each other and from the rim, as a share of the
/// smallest circumradius.
const ROOM: f64 = 1.0 / 150.0;
/// Positions tried for a tile before the others are moved.
const TRIES: usize = 2_000;
/// How often the others are moved; and how many steps each makes every time, of up to this share of
/// its circumradius and of a radian. Starts in rows are moved for longer.
const SHUFFLES: usize = 50;
const WANDERED: usize = 5;
const WANDERED_FROM_ROWS: usize = 150;
const STRIDE: f64 = 0.3;

/// Largest number of squares along a side of the table for looking up tiles.
const MOST_SQUARES: f64 = 1e3;

/// A tile's kind and configuration.
type Place = (usize, Configuration);

/// Why a run cannot start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StartError {
    /// The total area of the tiles is too large.
    #[error(
        "{tiles} tiles with a total area of {area:.3} m2 do not fit on a table of {table:.3} m2"
    )]
    TooMany {
        /// Number of tiles.
        tiles: usize,
        /// Their area (m^2).
        area: f64,
        /// Area of the table (m^2).
        table: f64,
    },
    /// No place was found.
    #[error(
        "no free place was found for tile {tile} of {tiles}, which cover {share:.2} of the table: they fit \
         neither one by one at random places nor in rows"
    )]
    NoRoom {
        /// Its number, from 0.
        tile: usize,
        /// Number of tiles.
        tiles: usize,
        /// Coverage of all tiles.
        share: f64,
    },
    /// Two of the given tiles overlap.
    #[error("tiles {first} and {second} overlap by {}", si(*depth, "m", 3))]
    Overlap {
        /// Its number, from 0.
        first: usize,
        /// The other's.
        second: usize,
        /// Depth of the overlap (m).
        depth: f64,
    },
    /// One of the given tiles extends beyond the rim.
    #[error("tile {tile} reaches {beyond:.3e} m beyond the rim")]
    BeyondRim {
        /// Its number, from 0.
        tile: usize,
        /// Distance beyond the rim (m).
        beyond: f64,
    },
}

/// The clearance (m) of two tiles, or any number above `enough` if it is larger.
fn clearance(crowd: &Crowd, [a, b]: [(usize, Configuration); 2], enough: f64) -> f64 {
    let (couple, swapped) = crowd.couple(a.0, b.0);
    let [first, second] = if swapped { [&b, &a] } else { [&a, &b] };
    let apart = (a.1.position() - b.1.position()).norm() - couple.radii();
    if apart > enough {
        return apart;
    }
    let q = Pose::new(first.1).to(&second.1);
    let bound = couple.contact.clearance_bound(&q);
    if bound > enough {
        return bound;
    }
    couple.contact.clearance(&q)
}

/// Places a number of tiles of each kind at random: positions and orientations are uniformly
/// distributed over those that do not overlap the earlier tiles. If tiles block each other before all
/// are placed, they start from rows instead and are moved at random. They are at rest, or have
/// velocities of the temperature kT (J) if it is given.
///
/// # Errors
/// If there is no room.
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
    // One of each kind in turn, so that no kind is preferred.
    let most = counts.iter().copied().max().unwrap_or(0);
    let turns = (0..most).flat_map(|turn| (0..counts.len()).map(move |kind| (turn, kind)));
    let kinds: Vec<usize> = turns
        .filter(|(turn, kind)| *turn < counts[*kind])
        .map(|(_, kind)| kind)
        .collect();
    let placed = one_by_one(crowd, &kinds, rng).or_else(|tile| {
        let share = area / table;
        in_rows(crowd, &kinds, rng).ok_or(StartError::NoRoom { tile, tiles, share })
    })?;
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

/// Places tiles of these kinds one by one at random, or returns the index of the first for which no
/// place is found.
fn one_by_one<'a>(
    crowd: &'a Crowd,
    kinds: &[usize],
    rng: &mut ChaCha8Rng,
) -> Result<Placed<'a>, usize> {
    let mut placed = Placed::new(crowd);
    for (tile, &kind) in kinds.iter().enumerate() {
        let mut rounds = 0..SHUFFLES;
        let q = loop {
            if let Some(q) = free_place(&placed, kind, rng) {
                break q;
            }
            // The tiles already placed block each other's gaps: random moves make room.
            rounds.next().ok_or(tile)?;
            for _ in 0..WANDERED {
                shuffle(&mut placed, STRIDE, rng);
            }
        };
        placed.add((kind, q));
    }
    Ok(placed)
}

/// Places tiles of these kinds at random places of a grid and moves them at random for long; `None` if
/// the grid has too few places.
fn in_rows<'a>(crowd: &'a Crowd, kinds: &[usize], rng: &mut ChaCha8Rng) -> Option<Placed<'a>> {
    let mut placed = Placed::new(crowd);
    let boxes: Vec<Bounds> = crowd
        .kinds
        .iter()
        .map(|kind| kind.tile.outline.hull().bounds())
        .collect();
    let count_along = |axis: usize| {
        let widths = boxes.iter().map(|it| it.high[axis] - it.low[axis]);
        let cell = widths.fold(0.0, f64::max) + 1.01 * placed.room;
        let side = 2.0 * crowd.rim.half_size()[axis] - placed.room;
        (side / cell).floor() as usize
    };
    let counts = [0, 1].map(count_along);
    let mut cells: Vec<usize> = (0..counts[0].saturating_mul(counts[1])).collect();
    if cells.len() < kinds.len() {
        return None;
    }
    cells.shuffle(rng);
    let mut cells = cells.into_iter();
    for &kind in kinds {
        let place = |cell: usize, rng: &mut ChaCha8Rng| {
            let at = [cell % counts[0], cell / counts[0]];
            let theta = if rng.random() { 0.0 } else { PI };
            let [x, y] = [0, 1].map(|axis| {
                let half = crowd.rim.half_size()[axis] - 0.5 * placed.room;
                let share = (at[axis] as f64 + 0.5) / counts[axis] as f64;
                let middle = 0.5 * (boxes[kind].low[axis] + boxes[kind].high[axis]);
                half * (2.0 * share - 1.0) - middle * libm::cos(theta)
            });
            Configuration::new(x, y, theta)
        };
        // On a round table some places of the grid lie beyond the rim.
        let q = cells.find_map(|cell| {
            let q = place(cell, rng);
            placed.is_free((kind, q), None).then_some(q)
        })?;
        placed.add((kind, q));
    }
    // Small steps, too, as there is little room.
    for _ in 0..WANDERED_FROM_ROWS {
        shuffle(&mut placed, STRIDE, rng);
        shuffle(&mut placed, 0.1 * STRIDE, rng);
    }
    Some(placed)
}

/// The placed tiles, with a grid of squares to look them up.
struct Placed<'a> {
    crowd: &'a Crowd,
    tiles: Vec<Place>,
    /// Their smallest distance (m).
    room: f64,
    /// Numbers of squares along x and y; a square is at least as wide as the range of contact.
    squares: [usize; 2],
    /// The tiles whose reference points lie in each square.
    there: Vec<Vec<usize>>,
}

impl<'a> Placed<'a> {
    fn new(crowd: &'a Crowd) -> Self {
        let radii = crowd.kinds.iter().map(|it| it.tile.outline.circumradius());
        let room = ROOM * radii.clone().fold(f64::INFINITY, f64::min);
        let widest = 2.0 * radii.fold(0.0, f64::max) + room;
        let squares = crowd
            .rim
            .half_size()
            .map(|half| (2.0 * half / widest).floor().clamp(1.0, MOST_SQUARES) as usize);
        Self {
            crowd,
            tiles: Vec::new(),
            room,
            squares,
            there: vec![Vec::new(); squares[0] * squares[1]],
        }
    }

    /// The indices along x and y of the square that contains a point.
    fn square(&self, q: &Configuration) -> [usize; 2] {
        [0, 1].map(|axis| {
            let (half, count) = (self.crowd.rim.half_size()[axis], self.squares[axis]);
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

    /// Whether a tile would be on the table and clear of all others, except one.
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
        tiles::interruption::check();
        let mut even = |half: f64| half * (2.0 * rng.random::<f64>() - 1.0);
        let [x, y] = placed.crowd.rim.half_size();
        let q = Configuration::new(even(x), even(y), wrap_angle(even(0.5 * TAU)));
        placed.is_free((kind, q), None).then_some(q)
    })
}

/// Moves each tile in turn by a random step, up to this share of its circumradius and of a radian, if it
/// stays free. The distribution of non-overlapping positions stays uniform.
fn shuffle(placed: &mut Placed, stride: f64, rng: &mut ChaCha8Rng) {
    for tile in 0..placed.tiles.len() {
        tiles::interruption::check();
        let (kind, q) = placed.tiles[tile];
        let mut even = || 2.0 * rng.random::<f64>() - 1.0;
        let outline = &placed.crowd.kinds[kind].tile.outline;
        let reach = stride * outline.circumradius();
        let step = Vector3::new(even() * reach, even() * reach, even() * stride);
        let moved = q.moved(step);
        let moved = Configuration::new(moved.x, moved.y, wrap_angle(moved.theta));
        if placed.is_free((kind, moved), Some(tile)) {
            placed.shift(tile, moved);
        }
    }
}

/// Checks that tiles do not overlap and are on the table, within what the first step puts right: a
/// frame of another run, as its file has it, is a valid start.
///
/// # Errors
/// If they are not.
pub fn check(crowd: &Crowd, movers: &[Mover], walls: bool) -> Result<(), StartError> {
    let place = |mover: &Mover| (mover.kind, mover.motion(crowd).configuration);
    let skin = crowd.margins().skin;
    for (tile, mover) in movers.iter().enumerate() {
        let beyond = mover.beyond(crowd);
        if walls && beyond > skin {
            return Err(StartError::BeyondRim { tile, beyond });
        }
    }
    let places: Vec<_> = movers.iter().map(place).collect();
    let positions: Vec<_> = places.iter().map(|it| it.1.position()).collect();
    let widest = crowd.kinds.iter().map(|it| it.tile.outline.circumradius());
    let widest = 2.0 * widest.fold(0.0, f64::max);
    let mut worst = (skin, None);
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
