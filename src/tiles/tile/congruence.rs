//! Tiles and faces that are equal to the tolerances of making.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use super::{Face, Magnet, Tile};
use crate::configuration::{Configuration, wrap_angle};

/// The resolution of cutters and printers (m).
const RESOLVED: f64 = 50e-6;
/// The share of a face's length that two faces may differ by in any case.
const SHARE: f64 = 1e-3;
/// Largest relative difference of the moments of equal magnets: a grade states them to some per
/// cent, a pull to two digits.
const MOMENT: f64 = 0.01;
/// Largest difference of the directions of equal magnets (rad).
const DIRECTION: f64 = 2e-3;

/// By how much (m) faces of this length (m) may differ and still be made equal.
pub fn allowed(length: f64) -> f64 {
    RESOLVED.min(SHARE * length)
}

/// By how much (m) the points of two equal tiles may differ.
fn allowed_of(tile: &Tile) -> f64 {
    let lengths = tile.faces.iter().map(Face::length);
    allowed(lengths.fold(f64::INFINITY, f64::min))
}

/// The map from the first tile's frame to the second's that lays the first onto the second: their
/// outlines and magnets coincide to the tolerances of making. Of several maps it is the one that
/// turns least. `None` if the tiles differ.
pub fn congruence(one: &Tile, other: &Tile) -> Option<Configuration> {
    let within = allowed_of(one).min(allowed_of(other));
    let [a, b] = [one, other].map(|tile| tile.outline.vertices());
    if a.len() != b.len() || one.magnets.len() != other.magnets.len() {
        return None;
    }
    let maps = (0..b.len()).filter_map(|shift| laid_onto(one, other, shift, within));
    let fitting = maps.filter(|map| {
        let magnets = one.magnets.iter();
        let mut laid = magnets.map(|magnet| moved(magnet, map));
        laid.all(|magnet| other.magnets.iter().any(|it| same(&magnet, it, within)))
    });
    let map = fitting.min_by_key(|map| OrderedFloat(map.theta.abs()))?;
    let size = one.outline.circumradius();
    let is_no_move = map.position().norm() <= within && map.theta.abs() * size <= within;
    Some(match is_no_move {
        true => Configuration::new(0.0, 0.0, 0.0),
        false => map,
    })
}

/// The map that lays each vertex of a tile onto the one of another that is `shift` places further.
fn laid_onto(one: &Tile, other: &Tile, shift: usize, within: f64) -> Option<Configuration> {
    let [a, b] = [one, other].map(|tile| tile.outline.vertices());
    let [from, to] = [one, other].map(|tile| tile.outline.centroid());
    let n = a.len();
    let farthest = (0..n).max_by_key(|&i| OrderedFloat((a[i] - from).norm()))?;
    let angle = |v: Vector2<f64>| libm::atan2(v.y, v.x);
    let turn = angle(b[(farthest + shift) % n] - to) - angle(a[farthest] - from);
    let turned = Configuration::new(0.0, 0.0, wrap_angle(turn));
    let place = to - turned.transform(from);
    let map = Configuration::new(place.x, place.y, turned.theta);
    (0..n)
        .all(|i| (map.transform(a[i]) - b[(i + shift) % n]).norm() <= within)
        .then_some(map)
}

/// Whether two faces are drawn alike and carry the same magnets, in their own frames.
pub fn faces_are_alike((a, i): (&Tile, usize), (b, j): (&Tile, usize)) -> bool {
    let [one, other] = [&a.faces[i], &b.faces[j]];
    let within = allowed(one.length().min(other.length()));
    if (one.length() - other.length()).abs() > within {
        return false;
    }
    let lines = [line(a, one), line(b, other)];
    let is_near = |(p, q): (&Vector2<f64>, &Vector2<f64>)| (p - q).norm() <= within;
    if lines[0].len() != lines[1].len() || !lines[0].iter().zip(&lines[1]).all(is_near) {
        return false;
    }
    let [own, others] = [carried(a, i), carried(b, j)];
    own.len() == others.len()
        && own
            .iter()
            .all(|magnet| others.iter().any(|it| same(magnet, it, within)))
}

/// The outline along a face, in the face's frame: the vertices from the one nearest to its first
/// corner to the one nearest to its second.
fn line(tile: &Tile, face: &Face) -> Vec<Vector2<f64>> {
    let vertices = tile.outline.vertices();
    let n = vertices.len();
    let nearest = |p: Vector2<f64>| {
        (0..n)
            .min_by_key(|&i| OrderedFloat((vertices[i] - p).norm()))
            .unwrap_or(0)
    };
    let (from, to) = (nearest(face.start), nearest(face.end));
    let frame = face.frame();
    (0..=(to + n - from) % n)
        .map(|k| frame.inverse_transform(vertices[(from + k) % n]))
        .collect()
}

/// The magnets by which a face binds, in the face's frame.
fn carried(tile: &Tile, face: usize) -> Vec<Magnet> {
    let frame = tile.faces[face].frame().inverse();
    let own = near_face(tile, face);
    own.into_iter().map(|it| moved(it, &frame)).collect()
}

/// The magnets by which a face binds: its own or, if it has none, those of other faces within
/// their own size of its base line, such as beads in the corners.
pub fn near_face(tile: &Tile, face: usize) -> Vec<&Magnet> {
    let own: Vec<&Magnet> = tile.magnets.iter().filter(|it| it.face == face).collect();
    if !own.is_empty() {
        return own;
    }
    let Some(Face { start, end, .. }) = tile.faces.get(face) else {
        return own;
    };
    let distance = |p: Vector2<f64>| {
        let along = (p - start).dot(&(end - start)) / (end - start).norm_squared();
        (start + (end - start) * along.clamp(0.0, 1.0) - p).norm()
    };
    let is_near = |it: &&Magnet| distance(it.position) <= libm::hypot(it.size[0], it.size[1]);
    tile.magnets.iter().filter(is_near).collect()
}

fn moved(magnet: &Magnet, map: &Configuration) -> Magnet {
    Magnet {
        position: map.transform(magnet.position),
        angle: wrap_angle(magnet.angle + map.theta),
        ..magnet.clone()
    }
}

/// Whether two magnets of tiles in the same frame are equal, except for the face that carries them.
fn same(a: &Magnet, b: &Magnet, within: f64) -> bool {
    (a.position - b.position).norm() <= within
        && a.form == b.form
        && (a.is_round() || turned_by(a, b) <= DIRECTION)
        && (a.moment - b.moment).abs() <= MOMENT * a.moment.max(b.moment)
        && (0..3).all(|k| (a.size[k] - b.size[k]).abs() <= within)
}

/// The angle (rad) between two magnets; an upright block looks the same after half a turn.
fn turned_by(a: &Magnet, b: &Magnet) -> f64 {
    let turn = wrap_angle(a.angle - b.angle).abs();
    match a.form.stands {
        Some(_) => turn.min(std::f64::consts::PI - turn),
        None => turn,
    }
}
