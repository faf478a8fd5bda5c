//! The kinds of tiles that are to be made.

use super::mates::{FacingPockets, meetings};
use crate::assembly::{Assembly, designs};
use crate::design::{Design, DesignError};
use crate::text::file_stem;
use physics::tile::Tile;
use physics::tile::congruence::congruence;

/// Layers and plates whose thickness differs by less than this share are of the same material.
const SAME_THICKNESS: f64 = 1e-3;

/// A kind of tile.
#[derive(Clone, Debug)]
pub struct Kind {
    /// Its name, which is also that of its files.
    pub name: String,
    /// The tile.
    pub tile: Tile,
    /// Number of copies if no other is requested.
    pub usual: usize,
}

/// What is to be made.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The name of the design, or of the tile set.
    pub name: String,
    /// The kinds of tiles.
    pub kinds: Vec<Kind>,
    /// Which pockets face each other.
    pub(super) meetings: Vec<FacingPockets>,
}

impl Subject {
    /// The tiles of a design: `fixed` and `moving`, or `tile` if both are equal.
    pub fn of_design(design: &Design) -> Self {
        let kind = |name: &str, tile: &Tile, usual| Kind {
            name: name.to_owned(),
            tile: tile.clone(),
            usual,
        };
        let pair = &design.pair;
        let is_one = design.is_of_one_kind();
        let kinds = match is_one {
            true => vec![kind("tile", &pair.fixed, 2)],
            false => vec![
                kind("fixed", &pair.fixed, 1),
                kind("moving", &pair.moving, 1),
            ],
        };
        Self {
            name: design.name.clone(),
            kinds,
            meetings: (meetings(pair, [0, usize::from(!is_one)]).into_iter())
                .map(|meeting| meeting.examined(design))
                .collect(),
        }
    }

    /// The tiles of several designs, with the names of their designs; equal ones are one kind.
    pub fn of_designs(designs: &[Design]) -> Self {
        if let [design] = designs {
            return Self::of_design(design);
        }
        let names: Vec<&str> = designs.iter().map(|design| &design.name[..]).collect();
        let mut all = Self {
            name: names.join(" and "),
            kinds: Vec::new(),
            meetings: Vec::new(),
        };
        for design in designs {
            let own = Self::of_design(design);
            let places: Vec<usize> = own
                .kinds
                .iter()
                .map(|kind| all.place(kind, design))
                .collect();
            let meetings = own.meetings.into_iter();
            all.meetings
                .extend(meetings.map(|meeting| meeting.of(&places)));
        }
        all
    }

    /// The index of a design's kind, which is added if it is new.
    fn place(&mut self, kind: &Kind, design: &Design) -> usize {
        let tile = &kind.tile;
        let same = |known: &Kind| {
            (known.tile.thickness / tile.thickness - 1.0).abs() < SAME_THICKNESS
                && congruence(&known.tile, tile).is_some_and(|map| map.to_array() == [0.0; 3])
        };
        if let Some(known) = self.kinds.iter().position(same) {
            return known;
        }
        let name = match &kind.name[..] {
            "tile" => design.name.clone(),
            role => format!("{}-{role}", design.name),
        };
        let name = self.unused(&name);
        self.kinds.push(Kind {
            name,
            ..kind.clone()
        });
        self.kinds.len() - 1
    }

    /// The name of a new kind's files: no other has it, even where upper and lower case are the same.
    fn unused(&self, name: &str) -> String {
        let name = file_stem(name);
        let is_free = |name: &String| {
            let lower = name.to_lowercase();
            self.kinds
                .iter()
                .all(|kind| kind.name.to_lowercase() != lower)
        };
        let numbered = (2..).map(|number| format!("{name}-{number}"));
        let mut names = [name.clone()].into_iter().chain(numbered);
        names.find(is_free).unwrap_or_default()
    }

    /// The tiles of a tile set, by its names and numbers.
    ///
    /// # Errors
    /// If a tile cannot be drawn.
    pub fn of_set(assembly: &Assembly) -> Result<Self, DesignError> {
        let set = &assembly.built.set;
        let mut all = Self {
            name: set.name.clone(),
            kinds: Vec::new(),
            meetings: Vec::new(),
        };
        let counts = assembly.counts();
        for (number, (tile, usual)) in set.tiles.iter().zip(counts).enumerate() {
            let name = all.unused(&tile.name);
            let tile = designs::tile(assembly, number)?;
            all.kinds.push(Kind { name, tile, usual });
        }
        for (design, met) in designs::parsed(assembly) {
            let pair = design?.pair;
            all.meetings.extend(meetings(&pair, [met.0, met.2]));
        }
        Ok(all)
    }
}
