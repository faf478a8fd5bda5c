//! Sets of tiles, as engines for tile assembly know them.

/// A tile of a set.
#[derive(Clone, Debug, PartialEq)]
pub struct TileType {
    /// Its name; for the engines, nameless tiles have their numbers from 1 as names.
    pub name: String,
    /// Glues, as indices of [`TileSet::glues`], in the order of [`super::SIDES`]; `None` for a face that
    /// binds nothing.
    pub glues: [Option<usize>; 4],
    /// Its share of the tiles on the table, relative to a usual tile.
    pub stoic: f64,
    /// Its colour, as the engines name it.
    pub color: Option<String>,
}

impl TileType {
    /// A tile with the usual share and no colour.
    pub fn new(name: impl Into<String>, glues: [Option<usize>; 4]) -> Self {
        Self {
            name: name.into(),
            glues,
            stoic: 1.0,
            color: None,
        }
    }
}

/// A glue.
#[derive(Clone, Debug, PartialEq)]
pub struct Glue {
    /// Its name.
    pub name: String,
    /// The strength with which it binds itself, in Gse.
    pub strength: f64,
}

/// A tile set of the tile assembly models.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TileSet {
    /// Its name.
    pub name: String,
    /// Its tiles.
    pub tiles: Vec<TileType>,
    /// Its glues.
    pub glues: Vec<Glue>,
    /// Pairs of different glues, with the strength with which they bind each other, in Gse.
    pub links: Vec<(usize, usize, f64)>,
    /// Seed tiles: row (from the north), column (from the west), tile.
    pub seed: Vec<(usize, usize, usize)>,
    /// Rows and columns of the canvas.
    pub size: Option<[usize; 2]>,
    /// The least strength that holds a tile.
    pub tau: Option<f64>,
    /// Gse in kT.
    pub gse: Option<f64>,
    /// Gmc in kT.
    pub gmc: Option<f64>,
    /// Ignored keys of its file, which only control the engine.
    pub passed_over: Vec<String>,
}

/// Largest number of tiles, and of glues.
pub const MOST: usize = 4096;
