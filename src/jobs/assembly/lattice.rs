//! Lattices: a different tile at every place, or the same tile at all places.

use super::{TileSet, TileType};

/// Largest number of tiles of a lattice.
pub const MOST_TILES: usize = 1024;

/// Rows and columns written as `3x4`.
///
/// # Errors
/// If the text is not a size, or the lattice is too large.
pub fn size(text: &str) -> Result<[usize; 2], String> {
    let read = || {
        let (rows, columns) = text.split_once(['x', 'X', ','])?;
        let size: [usize; 2] = [rows.trim().parse().ok()?, columns.trim().parse().ok()?];
        let tiles = size[0].checked_mul(size[1])?;
        (2..=MOST_TILES).contains(&tiles).then_some(size)
    };
    read().ok_or_else(|| {
        format!("a lattice is ROWSxCOLUMNS, such as 3x3, of 2 to {MOST_TILES} tiles")
    })
}

/// The number of words that a lattice of `rows` by `columns` different tiles needs: `m (n - 1) + n
/// (m - 1)`, one for every two neighbours.
pub fn words(rows: usize, columns: usize) -> usize {
    rows * (columns - 1) + columns * (rows - 1)
}

/// The lattice in which every tile has its own place: each glue is used once. One bond holds a tile
/// (tau 1).
pub fn unique([rows, columns]: [usize; 2]) -> TileSet {
    let mut set = TileSet {
        name: format!("lattice-{rows}x{columns}"),
        tau: Some(1.0),
        size: Some([rows + 4, columns + 4]),
        seed: vec![(2, 2, 0)],
        ..TileSet::default()
    };
    for row in 0..rows {
        for column in 0..columns {
            let name = |what: &str, row: usize, column: usize| format!("{what}{row}-{column}");
            let glues = [
                (row > 0).then(|| name("v", row, column)),
                (column + 1 < columns).then(|| name("h", row, column + 1)),
                (row + 1 < rows).then(|| name("v", row + 1, column)),
                (column > 0).then(|| name("h", row, column)),
            ];
            let glues = glues.map(|name| name.map(|name| set.glue(&name, 1.0)));
            set.tiles.push(TileType::new(name("t", row, column), glues));
        }
    }
    set
}

/// The lattice of a single kind of tile, on a canvas with the given rows and columns.
pub fn homogeneous([rows, columns]: [usize; 2]) -> TileSet {
    let mut set = TileSet {
        name: "homogeneous".to_owned(),
        tau: Some(1.0),
        size: Some([rows + 4, columns + 4]),
        seed: vec![(2 + rows / 2, 2 + columns / 2, 0)],
        ..TileSet::default()
    };
    let [v, h] = ["v", "h"].map(|name| Some(set.glue(name, 1.0)));
    set.tiles.push(TileType::new("t", [v, h, v, h]));
    set
}
