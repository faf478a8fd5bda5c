//! Lattices: a different tile at every place, or the same tile at all places.

use super::{TileSet, TileType};

/// Largest number of tiles of a lattice.
pub const MOST_TILES: usize = 1024;

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
