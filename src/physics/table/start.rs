//! Where tiles are when a run begins.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::crowd::Crowd;
use super::mover::Mover;
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
    let mut placed: Vec<Place> = Vec::new();
    for (_, kind) in turns.filter(|(turn, kind)| *turn < counts[*kind]) {
        let mut rounds = 0..SHUFFLES;
        let q = loop {
            if let Some(q) = free_place(crowd, kind, &placed, rng) {
                break q;
            }
            // Those that are there block each other's gaps: they make room by wandering.
            if rounds.next().is_none() {
                return Err(StartError::NoRoom {
                    tile: placed.len(),
                    tiles,
                    share: area / table,
                });
            }
            shuffle(crowd, &mut placed, rng);
        };
        placed.push((kind, q));
    }
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

fn free_place(
    crowd: &Crowd,
    kind: usize,
    placed: &[Place],
    rng: &mut ChaCha8Rng,
) -> Option<Configuration> {
    (0..TRIES).find_map(|_| {
        crate::interruption::check();
        let mut even = |half: f64| half * (2.0 * rng.random::<f64>() - 1.0);
        let [x, y] = crowd.half_size;
        let q = Configuration::new(even(x), even(y), wrap_angle(even(0.5 * TAU)));
        is_free(crowd, (kind, q), placed.iter()).then_some(q)
    })
}

/// Moves each tile in turn a little at random, where that leaves it free: all that is kept of where it was
/// is that tiles do not overlap.
fn shuffle(crowd: &Crowd, placed: &mut [Place], rng: &mut ChaCha8Rng) {
    for _ in 0..WANDERED {
        for tile in 0..placed.len() {
            crate::interruption::check();
            let (kind, q) = placed[tile];
            let mut even = || 2.0 * rng.random::<f64>() - 1.0;
            let reach = STRIDE * crowd.kinds[kind].tile.outline.circumradius();
            let step = Vector3::new(even() * reach, even() * reach, even() * STRIDE);
            let moved = q.moved(step);
            let moved = Configuration::new(moved.x, moved.y, wrap_angle(moved.theta));
            let others = placed.iter().enumerate();
            let others = others.filter(|(other, _)| *other != tile).map(|(_, it)| it);
            if is_free(crowd, (kind, moved), others) {
                placed[tile].1 = moved;
            }
        }
    }
}

/// Whether a tile is on the table and clear of others.
fn is_free<'a>(
    crowd: &Crowd,
    (kind, q): Place,
    mut others: impl Iterator<Item = &'a Place>,
) -> bool {
    let motion = Motion {
        configuration: q,
        velocity: Vector3::zeros(),
    };
    let radii = crowd.kinds.iter().map(|it| it.tile.outline.circumradius());
    let room = ROOM * radii.fold(f64::INFINITY, f64::min);
    Mover::new(crowd, kind, &motion).beyond(crowd) <= -room
        && others.all(|other| clearance(crowd, [(kind, q), *other], room) >= room)
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
    // Sorted along x, so that few are compared.
    let places: Vec<_> = movers.iter().map(place).collect();
    let widest = crowd.kinds.iter().map(|it| it.tile.outline.circumradius());
    let widest = 2.0 * widest.fold(0.0, f64::max);
    let mut order: Vec<usize> = (0..movers.len()).collect();
    order.sort_by(|&i, &j| places[i].1.x.total_cmp(&places[j].1.x).then(i.cmp(&j)));
    let mut worst: Option<StartError> = None;
    for (k, &i) in order.iter().enumerate() {
        for &j in &order[k + 1..] {
            if places[j].1.x - places[i].1.x > widest {
                break;
            }
            let depth = -clearance(crowd, [places[i], places[j]], 0.0);
            let deepest = match &worst {
                Some(StartError::Overlap { depth, .. }) => *depth,
                _ => TOUCH,
            };
            if depth > deepest {
                worst = Some(StartError::Overlap {
                    first: i.min(j),
                    second: i.max(j),
                    depth,
                });
            }
        }
    }
    worst.map_or(Ok(()), Err)
}
