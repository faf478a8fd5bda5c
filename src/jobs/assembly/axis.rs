//! The sides of tiles, and the axes along which sides meet.

/// North, east, south and west: the order of a tile's glues.
pub const SIDES: [&str; 4] = ["north", "east", "south", "west"];

/// Two tiles that meet in an assembly: along an axis the first lies west or south of the second.
pub type Met = (usize, MeetingAxis, usize);

/// An axis along which tiles meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MeetingAxis {
    /// East faces meet west faces.
    Horizontal,
    /// North faces meet south faces.
    Vertical,
}

impl MeetingAxis {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Horizontal, Self::Vertical];

    /// The sides (indices in [`SIDES`]) that carry the word and its mate.
    pub fn sides(self) -> [usize; 2] {
        match self {
            Self::Horizontal => [1, 3],
            Self::Vertical => [0, 2],
        }
    }
}
