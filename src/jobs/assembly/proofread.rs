//! Blocks of K x K tiles in place of tiles.
//!
//! Winfree and Bekbolatov, *Proofreading tile sets: error correction for algorithmic self-assembly*
//! (DNA9, 2003): each glue becomes K glues and each tile a block that glues of its own hold
//! together, so that an error has to happen K times before it stays. Where a glue alone holds a tile
//! (strength tau) it does so in the first of the K rows or columns, and the block's own glues there
//! are as strong: along that row or column the block grows, and the others follow with two bonds.

use super::{Axis, TileSet, TileType};

/// The set of blocks; of K = 1 the set itself.
pub fn blocks(set: &TileSet, k: usize) -> TileSet {
    if k < 2 {
        return set.clone();
    }
    let tau = set.tau();
    let strengths = set.strengths();
    let mut out = TileSet {
        name: format!("{}-{k}x{k}", set.name),
        seed: Vec::new(),
        size: set.size.map(|size| size.map(|n| n * k)),
        ..TileSet {
            tiles: Vec::new(),
            glues: Vec::new(),
            links: Vec::new(),
            ..set.clone()
        }
    };
    let weak = tau / 2.0;
    let part = |strength: f64, row: usize| {
        if row == 0 {
            strength
        } else {
            strength.min(weak)
        }
    };
    let outer = |glue: usize, row: usize| format!("{}.{row}", set.glues[glue].name);
    for glue in 0..set.glues.len() {
        for row in 0..k {
            out.glue(&outer(glue, row), part(set.glues[glue].strength, row));
        }
    }
    for (a, b, strength) in &set.links {
        out.links
            .extend((0..k).map(|row| (a * k + row, b * k + row, part(*strength, row))));
    }
    for (number, tile) in set.tiles.iter().enumerate() {
        // A glue's hold on whatever it binds.
        let is_strong = |axis: Axis| {
            let glues = axis.sides().into_iter().filter_map(|side| tile.glues[side]);
            let most = |glue: usize| strengths[glue].iter().copied().fold(0.0, f64::max);
            glues.map(most).fold(0.0, f64::max) >= tau
        };
        let strong = Axis::ALL.map(is_strong);
        let seeded = set.seed.iter().any(|(_, _, seed)| *seed == number);
        for y in 0..k {
            for x in 0..k {
                let mut inner = |axis: Axis, x: usize, y: usize| {
                    let (way, along, row) = match axis {
                        Axis::Horizontal => ("h", x, y),
                        Axis::Vertical => ("v", y, x),
                    };
                    let strength = match row == 0 && (strong[axis as usize] || seeded) {
                        true => tau,
                        false => weak,
                    };
                    Some(out.glue(&format!("{}/{way}{along}.{row}", tile.name), strength))
                };
                let last = k - 1;
                let face = |side: usize, row: usize| tile.glues[side].map(|glue| glue * k + row);
                let glues = [
                    if y == last {
                        face(0, x)
                    } else {
                        inner(Axis::Vertical, x, y)
                    },
                    if x == last {
                        face(1, y)
                    } else {
                        inner(Axis::Horizontal, x, y)
                    },
                    if y == 0 {
                        face(2, x)
                    } else {
                        inner(Axis::Vertical, x, y - 1)
                    },
                    if x == 0 {
                        face(3, y)
                    } else {
                        inner(Axis::Horizontal, x - 1, y)
                    },
                ];
                out.tiles.push(TileType {
                    name: format!("{}/{x}.{y}", tile.name),
                    glues,
                    stoic: tile.stoic,
                    color: tile.color.clone(),
                });
            }
        }
    }
    for (row, column, tile) in set.seed.iter().take(1) {
        out.seed.push((row * k + k - 1, column * k, tile * k * k));
    }
    out
}
