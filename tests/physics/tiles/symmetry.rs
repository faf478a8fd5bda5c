//! Rotations of a tile onto itself.

use std::f64::consts::PI;

use nalgebra::Vector2;
use tilebind::configuration::wrap_angle;
use tilebind::tile::symmetry::{rotations, turned_faces};
use tilebind::tile::{Face, Magnet, Outline, Tile};

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
                    form: Default::default(),
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
