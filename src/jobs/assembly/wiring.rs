//! Which faces bind which: the words that a tile set needs.
//!
//! On each axis the glues of east (north) faces bind those of west (south) faces. Where each of
//! some glues on the one side binds each of some on the other they are one bond, and one word; a
//! glue that binds nothing needs none, and its faces stay empty.

use super::{SIDES, TileSet};
use physics::order::Order;

/// An axis along which tiles meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Axis {
    /// East faces meet west faces.
    Horizontal,
    /// North faces meet south faces.
    Vertical,
}

impl Axis {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Horizontal, Self::Vertical];

    /// The sides (places in [`SIDES`]) that carry the word and its mate.
    pub fn sides(self) -> [usize; 2] {
        match self {
            Self::Horizontal => [1, 3],
            Self::Vertical => [0, 2],
        }
    }
}

/// Glues that hold each other along an axis, with what carries their word.
#[derive(Clone, Debug, PartialEq)]
pub struct Bond {
    /// Along which axis.
    pub axis: Axis,
    /// In Gse.
    pub strength: f64,
    /// The glues of faces that carry the word, and of those that carry its mate.
    pub glues: [Vec<usize>; 2],
}

/// All bonds of a tile set.
#[derive(Clone, Debug, PartialEq)]
pub struct Wiring {
    /// The bonds, by their first glue.
    pub bonds: Vec<Bond>,
    /// By side and glue.
    by_face: [Vec<Option<usize>>; 4],
}

/// Why no word can stand for a glue.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WiringError {
    /// Glues that hold each other in part.
    #[error(
        "the glue `{first}` of {side} faces and `{second}` of those that they meet are bound to the \
         same others, but not alike to each other ({strength} in place of {other}): one word and its \
         mate cannot do that. Give them glues of their own"
    )]
    Mixed {
        /// A glue with the word.
        first: String,
        /// A glue with its mate.
        second: String,
        /// Which faces.
        side: &'static str,
        /// What they hold with.
        strength: f64,
        /// What the others hold with.
        other: f64,
    },
    /// None at all.
    #[error(
        "no two of its tiles bind: give its glues strengths, under `bonds` or as `binding strengths`"
    )]
    None,
}

impl Wiring {
    /// The strength (in Gse) of the weakest bond.
    pub fn least_strength(&self) -> f64 {
        let strengths = self.bonds.iter().map(|bond| bond.strength);
        strengths.fold(f64::INFINITY, f64::min)
    }

    /// The bonds of a set.
    ///
    /// # Errors
    /// Where there are none, or glues that words cannot stand for.
    pub fn new(set: &TileSet) -> Result<Self, WiringError> {
        let n = set.glues.len();
        let strengths = set.strengths();
        let mut wiring = Self {
            bonds: Vec::new(),
            by_face: std::array::from_fn(|_| vec![None; n]),
        };
        for axis in Axis::ALL {
            let used = axis.sides().map(|side| {
                let used =
                    |glue: &usize| set.tiles.iter().any(|tile| tile.glues[side] == Some(*glue));
                (0..n).filter(used).collect::<Vec<usize>>()
            });
            let mut open = used.clone();
            while let Some(first) = open[0].first().copied() {
                let mut glues = [vec![first], Vec::new()];
                loop {
                    let before = glues.clone();
                    for (from, to) in [(0, 1), (1, 0)] {
                        let holds = |glue: &usize| {
                            glues[from]
                                .iter()
                                .any(|other| strengths[*other][*glue] > 0.0)
                        };
                        let more: Vec<usize> = used[to].iter().copied().filter(holds).collect();
                        for glue in more {
                            if !glues[to].contains(&glue) {
                                glues[to].push(glue);
                            }
                        }
                    }
                    if glues == before {
                        break;
                    }
                }
                open[0].retain(|glue| !glues[0].contains(glue));
                if glues[1].is_empty() {
                    continue;
                }
                wiring.bonds.push(bond(set, axis, glues, &strengths)?);
            }
        }
        wiring
            .bonds
            .order_by_key(|bond| (bond.glues[0].iter().min().copied(), bond.axis));
        for (number, bond) in wiring.bonds.iter().enumerate() {
            for (side, glues) in bond.axis.sides().into_iter().zip(&bond.glues) {
                for glue in glues {
                    wiring.by_face[side][*glue] = Some(number);
                }
            }
        }
        match wiring.bonds.is_empty() {
            true => Err(WiringError::None),
            false => Ok(wiring),
        }
    }

    /// The bond of a face of a tile, if it carries anything.
    pub fn of(&self, set: &TileSet, tile: usize, side: usize) -> Option<usize> {
        self.by_face[side][set.tiles[tile].glues[side]?]
    }

    /// How many words of each strength are needed, the strongest first.
    pub fn demand(&self) -> Vec<(f64, usize)> {
        let mut strengths: Vec<f64> = self.bonds.iter().map(|bond| bond.strength).collect();
        strengths.order_by(|a, b| b.total_cmp(a));
        let mut demand: Vec<(f64, usize)> = Vec::new();
        for strength in strengths {
            match demand.last_mut() {
                Some((last, count)) if *last == strength => *count += 1,
                _ => demand.push((strength, 1)),
            }
        }
        demand
    }
}

fn bond(
    set: &TileSet,
    axis: Axis,
    mut glues: [Vec<usize>; 2],
    strengths: &[Vec<f64>],
) -> Result<Bond, WiringError> {
    glues.iter_mut().for_each(|glues| glues.sort_unstable());
    let pairs = || {
        glues[0]
            .iter()
            .flat_map(|a| glues[1].iter().map(|b| (*a, *b)))
    };
    let strength = pairs().map(|(a, b)| strengths[a][b]).fold(0.0, f64::max);
    if let Some((a, b)) = pairs().find(|(a, b)| strengths[*a][*b] != strength) {
        return Err(WiringError::Mixed {
            first: set.glues[a].name.clone(),
            second: set.glues[b].name.clone(),
            side: SIDES[axis.sides()[0]],
            strength: strengths[a][b],
            other: strength,
        });
    }
    Ok(Bond {
        axis,
        strength,
        glues,
    })
}
