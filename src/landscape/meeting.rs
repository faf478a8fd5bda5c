//! The faces that touch and the magnets that face each other in a configuration.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use tiles::configuration::Configuration;
use tiles::contact::{Contact, EdgeOf, Touch};
use tiles::potential::dipole::{dipoles, pair};
use tiles::tile::outline::distance_to_segment;
use tiles::tile::{Outline, Tile};
use tiles::units::MU0_OVER_4PI;

/// Gaps below this (m) count as touching.
const TOUCHING: f64 = 1e-6;
/// Magnet pairs count where their energy is at least this fraction of the strongest pair's.
const COUNTED: f64 = 0.1;

/// The pairs (face of the fixed tile, face of the moving tile) that touch, sorted.
pub fn touching_faces(
    contact: &Contact,
    fixed: &Tile,
    moving: &Tile,
    q: &Configuration,
) -> Vec<(usize, usize)> {
    let mut faces: Vec<(usize, usize)> = contact
        .constraints(q, contact.scaled(TOUCHING))
        .iter()
        .map(|constraint| {
            let Touch {
                edge_of,
                edge,
                vertex,
            } = constraint.touch;
            let identity = Configuration::new(0.0, 0.0, 0.0);
            match edge_of {
                EdgeOf::Fixed => (
                    face_of_edge(fixed, edge),
                    face_of_vertex(moving, vertex, q, fixed.outline.normals()[edge]),
                ),
                EdgeOf::Moving => {
                    let normal = q.rotation() * moving.outline.normals()[edge];
                    (
                        face_of_vertex(fixed, vertex, &identity, normal),
                        face_of_edge(moving, edge),
                    )
                }
            }
        })
        .collect();
    faces.sort_unstable();
    faces.dedup();
    faces
}

/// The face whose base line is closest to the middle of an edge.
fn face_of_edge(tile: &Tile, edge: usize) -> usize {
    let (a, b) = tile.outline.edge(edge);
    let middle = (a + b) / 2.0;
    let distance = |i: usize| distance_to_segment(middle, tile.faces[i].start, tile.faces[i].end);
    (0..tile.faces.len())
        .min_by_key(|&i| OrderedFloat(distance(i)))
        .unwrap_or(0)
}

/// The face of the edge at a vertex that faces an edge of the other tile, given by its normal,
/// most squarely.
fn face_of_vertex(tile: &Tile, vertex: usize, pose: &Configuration, normal: Vector2<f64>) -> usize {
    let outline: &Outline = &tile.outline;
    let n = outline.vertices().len();
    let facing = |edge: usize| (pose.rotation() * outline.normals()[edge]).dot(&normal);
    let (before, after) = ((vertex + n - 1) % n, vertex);
    face_of_edge(
        tile,
        if facing(before) <= facing(after) {
            before
        } else {
            after
        },
    )
}

/// How many magnet pairs attract and how many repel, of those whose dipole energy is at least a
/// tenth of the strongest pair's.
pub fn magnet_pairs(fixed: &Tile, moving: &Tile, q: &Configuration) -> (usize, usize) {
    let rotation = q.rotation();
    let of_fixed = dipoles(&fixed.magnets);
    let mut strongest = 0.0f64;
    let mut energies: Vec<f64> = Vec::new();
    for second in dipoles(&moving.magnets) {
        let position = q.transform(second.position);
        let moment = rotation * second.moment;
        for first in &of_fixed {
            let way = position - first.position;
            // No more than twice the moments' product over the cube of the distance.
            let most = 2.0 * MU0_OVER_4PI * (first.moment.norm() * moment.norm());
            if most < COUNTED * strongest * way.norm().powi(3) {
                continue;
            }
            let energy = pair(first.moment, moment, way).0;
            strongest = strongest.max(energy.abs());
            energies.push(energy);
        }
    }
    let count = |sign: f64| {
        energies
            .iter()
            .filter(|u| sign * **u >= COUNTED * strongest && **u != 0.0)
            .count()
    };
    (count(-1.0), count(1.0))
}
