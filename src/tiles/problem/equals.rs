//! The contacts that are equal to the intended one.

use nalgebra::Vector2;

use super::Problem;
use crate::configuration::Configuration;
use crate::potential::shielding::{Shield, Shields};
use crate::tile::congruence::{allowed, congruence, faces_are_alike, near_face};
use crate::tile::{Pair, Tile};

/// A map of configurations onto ones with an equal contact: `left q right`, or `left q^-1 right` if
/// the tiles exchange their places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equal {
    exchanges: bool,
    left: Configuration,
    right: Configuration,
}

impl Equal {
    /// The exchange of two equal tiles, the first of which `map` lays onto the second.
    fn exchange(map: &Configuration) -> Self {
        Self {
            exchanges: true,
            left: map.inverse(),
            right: map.inverse(),
        }
    }

    /// The map that only exchanges the tiles' places.
    pub const SWAP: Self = Self {
        exchanges: true,
        left: Configuration::new(0.0, 0.0, 0.0),
        right: Configuration::new(0.0, 0.0, 0.0),
    };

    /// The configuration that this one is mapped onto.
    pub fn apply(&self, q: &Configuration) -> Configuration {
        let q = if self.exchanges { q.inverse() } else { *q };
        self.left.compose(&q).compose(&self.right)
    }

    /// The images of a point of the fixed tile and of one of the moving tile: again one of the fixed
    /// tile and one of the moving tile, as far from each other in the image of any configuration as
    /// the points are in it.
    pub fn of_points(&self, [a, b]: [Vector2<f64>; 2]) -> [Vector2<f64>; 2] {
        match self.exchanges {
            true => [self.left.transform(b), self.right.inverse_transform(a)],
            false => [self.left.transform(a), self.right.inverse_transform(b)],
        }
    }
}

/// A contact equal to the intended one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bond {
    /// Its configuration.
    pub pose: Configuration,
    /// The map of the intended one onto it.
    pub map: Equal,
}

/// The map that exchanges the tiles of a pair, if they are equal, and so are their shields.
pub(super) fn exchange(pair: &Pair, shields: &Shields) -> Option<Equal> {
    if pair.only {
        return None;
    }
    let map = congruence(&pair.fixed, &pair.moving)?;
    let are_shielded_alike = || {
        let shield = |of: &[Option<Shield>], face: usize| of.get(face).copied().flatten();
        let image = |face: usize| image_of(&pair.fixed, face, &pair.moving, &map);
        (0..pair.fixed.faces.len()).all(|face| {
            image(face)
                .is_some_and(|image| shield(&shields.fixed, face) == shield(&shields.moving, image))
        })
    };
    (shields.is_none() || are_shielded_alike()).then(|| Equal::exchange(&map))
}

/// The face of a tile onto which a map lays a face of another.
fn image_of(one: &Tile, face: usize, other: &Tile, map: &Configuration) -> Option<usize> {
    let face = &one.faces[face];
    let within = allowed(face.length());
    let [start, end] = [face.start, face.end].map(|p| map.transform(p));
    other
        .faces
        .iter()
        .position(|it| (it.start - start).norm() <= within && (it.end - end).norm() <= within)
}

/// The contacts equal to the intended one, which is the first: by turns of the tiles onto
/// themselves, by exchange of equal tiles, and of other faces that are drawn like the target faces
/// and carry the same magnets, at the same offset.
pub(super) fn bonds(problem: &Problem) -> Vec<Bond> {
    let Some(pair) = problem.pair.as_deref() else {
        return Vec::new();
    };
    let mut maps: Vec<Equal> = Vec::new();
    for exchange in std::iter::once(None).chain(problem.exchange.map(Some)) {
        for turn in &problem.symmetries {
            let left = Configuration::new(0.0, 0.0, turn.fixed);
            let right = Configuration::new(0.0, 0.0, -turn.moving);
            maps.push(match exchange {
                None => Equal {
                    exchanges: false,
                    left,
                    right,
                },
                Some(exchange) => Equal {
                    exchanges: true,
                    left: left.compose(&exchange.left),
                    right: exchange.right.compose(&right),
                },
            });
        }
    }
    let mut found: Vec<Bond> = Vec::new();
    let within = problem.scaled(SAME);
    let mut add = |map: Equal, is_sure: bool| {
        let pose = map.apply(&pair.bound);
        let is_known = |bond: &Bond| problem.space.distance(&bond.pose, &pose) <= within;
        if !found.iter().any(is_known) && (is_sure || is_possible(problem, &pose)) {
            found.push(Bond { pose, map });
        }
    };
    maps.into_iter().for_each(|map| add(map, true));
    if !pair.only {
        of_faces(pair, [&pair.fixed, &pair.moving])
            .into_iter()
            .for_each(|map| add(map, false));
    }
    found
}

/// Configurations closer than this (m, for the paper's tile) are the same contact.
const SAME: f64 = 1e-3;

/// Whether tiles meet there without overlap, except for what cutters do not resolve.
fn is_possible(problem: &Problem, q: &Configuration) -> bool {
    let Some(pair) = problem.pair.as_deref() else {
        return true;
    };
    problem.space.contains(q) && problem.clearance(q) >= -allowed(pair.target_face().length())
}

/// The maps from the target of a pair to the contacts of two tiles, which may be other ones than the
/// pair's, in which faces meet that are drawn like the target faces and carry the same magnets.
pub fn of_faces(pair: &Pair, tiles: [&Tile; 2]) -> Vec<Equal> {
    let own = [(&pair.fixed, pair.target.0), (&pair.moving, pair.target.1)];
    if own
        .iter()
        .any(|(tile, face)| near_face(tile, *face).is_empty())
    {
        return Vec::new();
    }
    let like = |tile: usize, target: usize| -> Vec<Configuration> {
        let faces = (0..tiles[tile].faces.len())
            .filter(|&face| faces_are_alike((tiles[tile], face), own[target]));
        faces.map(|face| tiles[tile].faces[face].frame()).collect()
    };
    // A pose is the frame of the fixed face, that of the moving face in it, and back to the tile.
    let back = own.map(|(tile, face)| tile.faces[face].frame().inverse());
    let mut maps = Vec::new();
    for exchanges in [false, true] {
        let [first, second] = if exchanges { [1, 0] } else { [0, 1] };
        let partners = like(1, second);
        for frame in like(0, first) {
            maps.extend(partners.iter().map(|partner| Equal {
                exchanges,
                left: frame.compose(&back[first]),
                right: partner.compose(&back[second]).inverse(),
            }));
        }
    }
    maps
}
