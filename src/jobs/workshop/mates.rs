//! Which pockets face each other where tiles bind.

use std::f64::consts::PI;

use nalgebra::Vector2;

use crate::design::Design;
use physics::tile::magnet::Standing;
use physics::tile::{Pair, Tile};

/// The farthest that facing magnets of a bond are apart, in lengths of the larger one.
const FACING: f64 = 3.0;

/// Two pockets that face each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct FacingPockets {
    /// The kind of each tile, and the index of its magnet.
    pub pockets: [(usize, usize); 2],
    /// The share of the bond that is left if the first or the second magnet is the wrong way round,
    /// if it was computed.
    pub left_if_wrong: Option<[f64; 2]>,
}

impl FacingPockets {
    /// The same with other numbers of the kinds.
    pub(super) fn of(self, kinds: &[usize]) -> Self {
        Self {
            pockets: self.pockets.map(|(kind, magnet)| (kinds[kind], magnet)),
            ..self
        }
    }

    /// The same with the shares of the bond that are left.
    pub(super) fn examined(self, design: &Design) -> Self {
        let pair = &design.pair;
        let energy = |fixed: &Tile, moving: &Tile| {
            let energy = design.interaction.between(fixed, moving);
            energy.potential.energy(&pair.bound)
        };
        let bond = energy(&pair.fixed, &pair.moving);
        let [(_, own), (_, other)] = self.pockets;
        let left = [
            energy(&turned(&pair.fixed, own), &pair.moving),
            energy(&pair.fixed, &turned(&pair.moving, other)),
        ];
        Self {
            left_if_wrong: (bond < 0.0).then(|| left.map(|energy| energy / bond)),
            ..self
        }
    }
}

/// A tile with one of its magnets the wrong way round.
fn turned(tile: &Tile, magnet: usize) -> Tile {
    let mut tile = tile.clone();
    let wrong = &mut tile.magnets[magnet];
    match &mut wrong.form.stands {
        Some(standing) => {
            *standing = match standing {
                Standing::Up => Standing::Down,
                Standing::Down => Standing::Up,
            }
        }
        None => wrong.angle += PI,
    }
    tile
}

/// The pockets that face each other in the bond of two tiles, which are of the given kinds: each is
/// the nearest one to the other.
pub(super) fn meetings(pair: &Pair, kinds: [usize; 2]) -> Vec<FacingPockets> {
    let tiles = [&pair.fixed, &pair.moving];
    let places: [Vec<Vector2<f64>>; 2] = [
        pair.fixed.magnets.iter().map(|it| it.position).collect(),
        (pair.moving.magnets.iter())
            .map(|it| pair.bound.transform(it.position))
            .collect(),
    ];
    let nearest = |tile: usize, own: usize| {
        let from = places[tile][own];
        let others = places[1 - tile].iter().enumerate();
        let nearest = others.min_by(|a, b| (a.1 - from).norm().total_cmp(&(b.1 - from).norm()));
        nearest.map(|(other, place)| (other, (place - from).norm()))
    };
    let facing = |own: usize| {
        let (other, far) = nearest(0, own)?;
        let [a, b, _] = tiles[0].magnets[own].size;
        let [c, d, _] = tiles[1].magnets[other].size;
        let is_mutual = nearest(1, other).is_some_and(|back| back.0 == own);
        let is_near = far <= FACING * a.max(b).max(c).max(d);
        (is_mutual && is_near).then_some(FacingPockets {
            pockets: [(kinds[0], own), (kinds[1], other)],
            left_if_wrong: None,
        })
    };
    (0..places[0].len()).filter_map(facing).collect()
}
