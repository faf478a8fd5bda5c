//! Tiles that overlap slightly, because their poses were written with few digits, moved apart.

use nalgebra::{Matrix3, Vector2, Vector3};

use super::crowd::Crowd;
use super::mover::beyond;
use super::neighbours::Neighbours;
use crate::rigid::{Motion, Mover, Pose, Two};
use tiles::configuration::{Configuration, wrap_angle};
use tiles::tile::rounded_overlap;

/// Rounds over all pairs; tiles that are put apart may meet others.
const ROUNDS: usize = 100;
/// Largest movement of a tile, relative to the largest overlap that counts as slight; more is left to the
/// check.
const FARTHEST: f64 = 20.0;

/// Moves tiles that overlap by less than [`rounded_overlap`] apart, and tiles that extend as little
/// beyond the rim onto the table; returns the largest movement of a tile (m), 0 if none is moved.
/// Deeper overlaps are left as they are.
pub fn settle(crowd: &Crowd, movers: &mut [Mover], walls: bool) -> f64 {
    let given: Vec<Configuration> = movers.iter().map(|it| configuration(crowd, it)).collect();
    let mut places = given.clone();
    let kinds: Vec<usize> = movers.iter().map(|it| it.kind).collect();
    let positions: Vec<Vector2<f64>> = given.iter().map(Configuration::position).collect();
    let widest = crowd.kinds.iter().map(|it| it.tile.outline.circumradius());
    let tiles = crowd.kinds.iter().map(|it| rounded_overlap([&it.tile; 2]));
    let most = FARTHEST * tiles.fold(0.0, f64::max);
    let widest = 2.0 * (widest.fold(0.0, f64::max) + most);
    let mut neighbours = Neighbours::default();
    let pairs = neighbours.within(widest, &positions);
    for _ in 0..ROUNDS {
        tiles::interruption::check();
        let mut moved = false;
        for &[i, j] in pairs {
            if let Some(to) = apart(crowd, [kinds[i], kinds[j]], [places[i], places[j]]) {
                places[j] = to;
                moved = true;
            }
        }
        for (kind, place) in kinds.iter().zip(&mut places).filter(|_| walls) {
            if let Some(to) = inside(crowd, *kind, place) {
                *place = to;
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
    let mut farthest: f64 = 0.0;
    for ((mover, given), place) in movers.iter_mut().zip(&given).zip(&places) {
        let by = (place.position() - given.position()).norm();
        if place == given || by > most {
            continue;
        }
        farthest = farthest.max(by);
        let motion = Motion {
            configuration: *place,
            velocity: mover.velocity,
        };
        *mover = Mover::new(crowd, mover.kind, &motion);
    }
    farthest
}

fn configuration(crowd: &Crowd, mover: &Mover) -> Configuration {
    mover.motion(crowd).configuration
}

/// Where the second of two tiles that overlap slightly touches the first.
fn apart(crowd: &Crowd, kinds: [usize; 2], places: [Configuration; 2]) -> Option<Configuration> {
    let (couple, _) = crowd.couple(kinds[0], kinds[1]);
    // The indices of the couple's fixed and moving tile.
    let Two { first, second } = Two::of(kinds, [0, 1]);
    let fixed = Pose::new(places[first]);
    let q = fixed.to(&places[second]);
    if q.position().norm() > couple.radii() || couple.contact.is_free(&q) {
        return None;
    }
    let tiles = kinds.map(|kind| &crowd.kinds[kind].tile);
    let depth = -couple.contact.clearance(&q);
    if depth >= rounded_overlap(tiles) {
        return None;
    }
    let gyration = tiles[second].radius_of_gyration();
    let metric = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, gyration * gyration));
    let to = couple.contact.nearest_free(&q, 2.0 * depth, |_| metric)?;
    if second == 1 {
        let at = fixed.transform(to.position());
        return Some(Configuration::new(
            at.x,
            at.y,
            wrap_angle(fixed.at.theta + to.theta),
        ));
    }
    // The couple's fixed tile is moved, as seen from the other one.
    let theta = places[second].theta - to.theta;
    let turned = Configuration::new(0.0, 0.0, theta).rotation() * to.position();
    let at = places[second].position() - turned;
    Some(Configuration::new(at.x, at.y, wrap_angle(theta)))
}

/// Where a tile that extends slightly beyond the rim touches it.
fn inside(crowd: &Crowd, kind: usize, q: &Configuration) -> Option<Configuration> {
    let tile = &crowd.kinds[kind].tile;
    let beyond = beyond(&tile.outline, crowd.rim, q);
    if beyond <= 0.0 || beyond >= rounded_overlap([tile, tile]) {
        return None;
    }
    // By as much as the farthest corner needs, to each side.
    let (mut low, mut high) = (Vector2::zeros(), Vector2::zeros());
    for corner in tile.outline.vertices() {
        for (inwards, gap) in crowd.rim.sides(q.transform(*corner)) {
            let by: Vector2<f64> = inwards * (-gap).max(0.0);
            low = low.inf(&by);
            high = high.sup(&by);
        }
    }
    let by = low + high;
    Some(Configuration::new(q.x + by.x, q.y + by.y, q.theta))
}
