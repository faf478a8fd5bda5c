//! The structure that tiles are to build.

use tiles::configuration::Configuration;

/// The structure that is to be built.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Goal {
    /// A ring of this many tiles.
    Ring(usize),
    /// A chain of this many tiles.
    Chain(usize),
    /// A full sheet of this many rows and columns.
    Sheet(usize, usize),
    /// Tiles, by kind and place, up to a motion of all of them.
    Pattern(Vec<(usize, Configuration)>),
}

impl Goal {
    /// The number of its tiles.
    pub fn tiles(&self) -> usize {
        match self {
            Self::Ring(count) | Self::Chain(count) => *count,
            Self::Sheet(rows, columns) => rows * columns,
            Self::Pattern(tiles) => tiles.len(),
        }
    }
}
