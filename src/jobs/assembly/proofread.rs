//! Proofreading: each tile becomes a block of K x K tiles.
//!
//! Winfree and Bekbolatov, *Proofreading tile sets: error correction for algorithmic self-assembly*
//! (DNA9, 2003): each glue becomes K glues and each tile a block held together by glues of its own,
//! so that an error must occur K times before it becomes permanent. A glue that holds a tile alone
//! (strength tau) does so only in the first of the K rows or columns, and the block's own glues
//! there are as strong: the block grows along that row or column, and the others follow with two
//! bonds.

use super::{MOST, MeetingAxis, TileSet, TileType};

/// The set of blocks; for K = 1 the set itself.
///
/// # Errors
/// If it would have too many tiles.
pub fn blocks(set: &TileSet, k: usize) -> Result<TileSet, String> {
    if k < 2 {
        return Ok(set.clone());
    }
    let count = set.tiles.len() * k * k;
    if count > MOST {
        return Err(format!(
            "{} blocks of {k} x {k} are {count} tiles, more than {MOST}: use a smaller --proofread",
            set.tiles.len()
        ));
    }
    let tau = set.tau();
    let strengths = set.strengths();
    let mut out = TileSet {
        name: format!("{}-{k}x{k}", set.name),
        size: set.size.map(|size| size.map(|n| n * k)),
        tau: set.tau,
        gse: set.gse,
        gmc: set.gmc,
        ..TileSet::default()
    };
    let weak = tau / 2.0;
    let part = |strength: f64, row: usize| match row {
        0 => strength,
        _ => strength.min(weak),
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
        // The largest strength of a glue.
        let is_strong = |axis: MeetingAxis| {
            let glues = axis.sides().into_iter().filter_map(|side| tile.glues[side]);
            let most = |glue: usize| strengths[glue].iter().copied().fold(0.0, f64::max);
            glues.map(most).fold(0.0, f64::max) >= tau
        };
        let strong = MeetingAxis::ALL.map(is_strong);
        let seeded = set.seed.iter().any(|(_, _, seed)| *seed == number);
        for y in 0..k {
            for x in 0..k {
                let mut inner = |axis: MeetingAxis, x: usize, y: usize| {
                    let (way, along, row) = match axis {
                        MeetingAxis::Horizontal => ("h", x, y),
                        MeetingAxis::Vertical => ("v", y, x),
                    };
                    let strength = match row == 0 && (strong[axis as usize] || seeded) {
                        true => tau,
                        false => weak,
                    };
                    Some(out.glue(&format!("{}/{way}{along}.{row}", tile.name), strength))
                };
                let mut side =
                    |side: usize, axis: MeetingAxis, at_end: bool, x: usize, y: usize| {
                        let row = if axis == MeetingAxis::Vertical { x } else { y };
                        match at_end {
                            true => tile.glues[side].map(|glue| glue * k + row),
                            false => inner(axis, x, y),
                        }
                    };
                let glues = [
                    side(0, MeetingAxis::Vertical, y == k - 1, x, y),
                    side(1, MeetingAxis::Horizontal, x == k - 1, x, y),
                    side(2, MeetingAxis::Vertical, y == 0, x, y.wrapping_sub(1)),
                    side(3, MeetingAxis::Horizontal, x == 0, x.wrapping_sub(1), y),
                ];
                out.tiles.push(TileType {
                    name: format!("{}/{x}.{y}", tile.name),
                    glues,
                    ..tile.clone()
                });
            }
        }
    }
    for (row, column, tile) in set.seed.iter().take(1) {
        out.seed.push((row * k + k - 1, column * k, tile * k * k));
    }
    Ok(out)
}
