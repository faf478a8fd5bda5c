//! The rotations that map a tile onto itself.

use std::f64::consts::TAU;

use nalgebra::{Rotation2, Vector2};
use ordered_float::OrderedFloat;

use super::{Face, Magnet, Tile};
use crate::configuration::wrap_angle;
use crate::order::Order;

/// How closely, relative to the tile's size, its moments and a full turn, the turned tile must
/// agree with the original.
const TOLERANCE: f64 = 1e-9;

/// All angles (rad, in [0, 2 pi), ascending) by which the tile can be turned about its reference
/// point so that its outline and its magnets (positions, directions, moments, sizes) coincide with
/// themselves. The first is 0.
pub fn rotations(tile: &Tile) -> Vec<f64> {
    let vertices = tile.outline.vertices();
    let mut angles: Vec<f64> = (1..vertices.len())
        .filter_map(|shift| turn_of_outline(vertices, shift, tile.outline.circumradius()))
        .filter(|&angle| maps_magnets(tile, angle))
        .collect();
    angles.push(0.0);
    angles.order_by(f64::total_cmp);
    angles
}

/// The angle in (0, 2 pi) that maps each vertex onto the one `shift` places further, if there is
/// one.
fn turn_of_outline(vertices: &[Vector2<f64>], shift: usize, scale: f64) -> Option<f64> {
    let n = vertices.len();
    let farthest = (0..n).max_by_key(|&i| OrderedFloat(vertices[i].norm()))?;
    let (from, to) = (vertices[farthest], vertices[(farthest + shift) % n]);
    let angle = (libm::atan2(to.y, to.x) - libm::atan2(from.y, from.x)).rem_euclid(TAU);
    let rotation = Rotation2::new(angle);
    (0..n)
        .all(|i| (rotation * vertices[i] - vertices[(i + shift) % n]).norm() <= TOLERANCE * scale)
        .then_some(angle)
}

fn maps_magnets(tile: &Tile, angle: f64) -> bool {
    let rotation = Rotation2::new(angle);
    let scale = tile.outline.circumradius();
    tile.magnets.iter().all(|magnet| {
        let turned = Magnet {
            position: rotation * magnet.position,
            angle: magnet.angle + angle,
            ..magnet.clone()
        };
        tile.magnets.iter().any(|other| same(&turned, other, scale))
    })
}

/// For each face, the face onto which a turn of [`rotations`] maps it with all its magnets; `None`
/// if one of the faces is not mapped onto a face. Faces may differ although outlines agree: one
/// side of an outline may be two faces in line.
pub fn turned_faces(tile: &Tile, angle: f64) -> Option<Vec<usize>> {
    let rotation = Rotation2::new(angle);
    let scale = tile.outline.circumradius();
    let near = |a: Vector2<f64>, b: Vector2<f64>| (rotation * a - b).norm() <= TOLERANCE * scale;
    let images: Vec<usize> = tile
        .faces
        .iter()
        .map(|face| {
            let image = |other: &Face| near(face.start, other.start) && near(face.end, other.end);
            tile.faces.iter().position(image)
        })
        .collect::<Option<_>>()?;
    let keeps_face = |magnet: &Magnet| {
        tile.magnets
            .iter()
            .any(|other| near(magnet.position, other.position) && other.face == images[magnet.face])
    };
    tile.magnets.iter().all(keeps_face).then_some(images)
}

fn same(a: &Magnet, b: &Magnet, scale: f64) -> bool {
    (a.position - b.position).norm() <= TOLERANCE * scale
        && a.form == b.form
        && wrap_angle(a.angle - b.angle).abs() <= TOLERANCE * TAU
        && (a.moment - b.moment).abs() <= TOLERANCE * a.moment.max(b.moment)
        && (0..3).all(|k| (a.size[k] - b.size[k]).abs() <= TOLERANCE * a.size[k].max(b.size[k]))
}
