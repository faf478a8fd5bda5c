//! The turns that map a tile onto itself.

use std::f64::consts::TAU;

use nalgebra::{Rotation2, Vector2};
use ordered_float::OrderedFloat;

use super::{Face, Magnet, Tile};
use crate::configuration::wrap_angle;

/// How closely, relative to the tile's size, its moments and a full turn, the turned tile must
/// agree with the tile.
const TOLERANCE: f64 = 1e-9;

/// All angles (rad, in [0, 2 pi), ascending) by which the tile can be turned about its reference
/// point so that its outline and its magnets (positions, directions, moments, sizes) come to lie
/// on themselves. The first is 0.
pub fn rotations(tile: &Tile) -> Vec<f64> {
    let vertices = tile.outline.vertices();
    let mut angles: Vec<f64> = (1..vertices.len())
        .filter_map(|shift| turn_of_outline(vertices, shift, tile.outline.circumradius()))
        .filter(|&angle| maps_magnets(tile, angle))
        .collect();
    angles.push(0.0);
    angles.sort_by(f64::total_cmp);
    angles
}

/// The angle in (0, 2 pi) that turns each vertex into the one `shift` places on, if there is one.
fn turn_of_outline(vertices: &[Vector2<f64>], shift: usize, scale: f64) -> Option<f64> {
    let n = vertices.len();
    let farthest = (0..n).max_by_key(|&i| OrderedFloat(vertices[i].norm()))?;
    let (from, to) = (vertices[farthest], vertices[(farthest + shift) % n]);
    let angle = (to.y.atan2(to.x) - from.y.atan2(from.x)).rem_euclid(TAU);
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
/// where one of the faces does not come to lie on a face. Faces may differ though outlines agree:
/// one side of an outline may be two faces in line.
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
        && wrap_angle(a.angle - b.angle).abs() <= TOLERANCE * TAU
        && (a.moment - b.moment).abs() <= TOLERANCE * a.moment.max(b.moment)
        && (0..3).all(|k| (a.size[k] - b.size[k]).abs() <= TOLERANCE * a.size[k].max(b.size[k]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tile::Outline;
    use std::f64::consts::PI;

    /// A square of side 2 with magnets at the middle of the given faces, pole out or in.
    fn tile(magnets: &[(usize, f64)]) -> Tile {
        let corners = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
        Tile {
            outline: Outline::new(corners.map(|[x, y]| Vector2::new(x, y)).to_vec()).unwrap(),
            faces: Vec::new(),
            magnets: magnets
                .iter()
                .map(|&(face, moment)| {
                    let normal = face as f64 * PI / 2.0;
                    Magnet {
                        position: Vector2::new(normal.cos(), normal.sin()) * 0.9,
                        angle: wrap_angle(normal + if moment < 0.0 { PI } else { 0.0 }),
                        moment: moment.abs(),
                        size: [0.1, 0.1, 0.1],
                        face,
                    }
                })
                .collect(),
            mass: 1.0,
            thickness: 0.1,
        }
    }

    fn quarters(tile: &Tile) -> Vec<i64> {
        rotations(tile)
            .iter()
            .map(|angle| {
                let quarters = angle / (PI / 2.0);
                assert!((quarters - quarters.round()).abs() < 1e-12);
                quarters.round() as i64
            })
            .collect()
    }

    #[test]
    fn a_bare_square_has_four_turns() {
        assert_eq!(quarters(&tile(&[])), [0, 1, 2, 3]);
    }

    #[test]
    fn equal_magnets_on_every_face_keep_all_four() {
        let all = [(0, 1.0), (1, 1.0), (2, 1.0), (3, 1.0)];
        assert_eq!(quarters(&tile(&all)), [0, 1, 2, 3]);
    }

    #[test]
    fn magnets_break_the_symmetry_by_place_pole_and_moment() {
        assert_eq!(quarters(&tile(&[(0, 1.0)])), [0]);
        assert_eq!(quarters(&tile(&[(0, 1.0), (2, 1.0)])), [0, 2]);
        assert_eq!(quarters(&tile(&[(0, 1.0), (2, -1.0)])), [0]);
        let alternating = [(0, 1.0), (1, -1.0), (2, 1.0), (3, -1.0)];
        assert_eq!(quarters(&tile(&alternating)), [0, 2]);
        assert_eq!(quarters(&tile(&[(0, 1.0), (2, 1.001)])), [0]);
    }

    #[test]
    fn faces_are_turned_onto_faces() {
        let mut square = tile(&[(0, 1.0), (1, 1.0), (2, 1.0), (3, 1.0)]);
        let corners = square.outline.vertices().to_vec();
        square.faces = (0..4)
            .map(|i| Face {
                name: i.to_string(),
                start: corners[i],
                end: corners[(i + 1) % 4],
            })
            .collect();
        assert_eq!(turned_faces(&square, PI / 2.0), Some(vec![1, 2, 3, 0]));
        let mut other = square.clone();
        other.magnets[1].face = 2;
        assert_eq!(turned_faces(&other, PI / 2.0), None);
        square.faces[0].end.y = 0.5;
        assert_eq!(turned_faces(&square, PI / 2.0), None);
    }

    #[test]
    fn a_square_off_its_reference_point_has_none() {
        let mut tile = tile(&[]);
        let corners = [[3.0, -1.0], [3.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
        tile.outline = Outline::new(corners.map(|[x, y]| Vector2::new(x, y)).to_vec()).unwrap();
        assert_eq!(rotations(&tile), [0.0]);
    }
}
