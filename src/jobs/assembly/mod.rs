//! Tile sets whose glues are words of magnets.
//!
//! Models of tile assembly (Winfree's kTAM, and the abstract model aTAM) have square tiles with a
//! glue on each face, a matrix of strengths between glues, and two energies in kT: Gse, the depth
//! of a bond of strength 1, and Gmc, the cost for a tile to dock. Here every glue becomes a word of
//! magnets and every strength an energy of two faces. The resulting files run unchanged in the
//! engines `xgrow` and `rgrow`, which simulate the growth.
//!
//! kTAM tiles do not rotate, magnetic ones do. So a glue on the west-east axis and the same glue on
//! the south-north axis are two [`wiring::Bond`]s with a word each: the east or north face of one
//! tile carries the word, the west or south face of the other its mate.
//!
//! - [`TileSet`] - tiles, glues, strengths, seed; [`rgrow`], [`xgrow`] - the engines' file formats;
//! - [`wiring`] - which faces bind which, and the words needed for that;
//! - [`lattice`], [`square`] - generated sets; [`proofread`] - blocks in place of tiles;
//! - [`growth`] - growth without errors; [`kinetic`] - growth with errors;
//! - [`Request`] - the options; [`choice`] - words for a set, and their assignment; [`matrix`] -
//!   their energies; [`rests`] - the contributions of the other faces; [`slides`] - slid contacts,
//!   which engines ignore;
//! - [`built`] - the set at one kT and one coverage of the table; [`Assembly`] - the complete
//!   result; [`designs`] - the designs of every two tiles that meet.

mod assembled;
mod assignment;
pub mod axis;
pub mod built;
pub mod choice;
mod depths;
pub mod designs;
pub mod growth;
pub mod kinetic;
pub mod lattice;
pub mod matrix;
pub mod proofread;
mod request;
pub mod rests;
pub mod rgrow;
mod search;
pub mod slides;
pub mod square;
mod tile_set;
pub mod wiring;
pub mod xgrow;
mod yaml;

#[cfg(test)]
mod tests;

use std::collections::HashSet;
use std::ops::RangeInclusive;
use std::path::Path;

use crate::design::{DesignError, FilePlace};
use crate::text::{check_visible, is_invisible};

pub use assembled::{Assembly, Growing};
pub use axis::{MeetingAxis, SIDES};
pub use built::Built;
pub use request::Request;
pub use tile_set::{Glue, MOST, TileSet, TileType};
pub use wiring::Wiring;

/// Ranges of a strength, of an energy in kT and of tau, and of a share, which can also be 0.
const STRENGTHS: RangeInclusive<f64> = -1e6..=1e6;
const ENERGIES: RangeInclusive<f64> = 0.0..=1e6;
const SHARES: RangeInclusive<f64> = 1e-6..=1e6;
/// Where the tau of a set comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tau {
    /// Its file states it.
    Stated,
    /// It follows from Gmc / Gse of its file.
    OfEnergies,
    /// The file states neither: the usual 2.
    Assumed,
}

/// Largest number of rows and columns of a canvas.
const MOST_CANVAS: usize = 65_536;

impl TileSet {
    /// Reads a file: YAML or JSON of rgrow, or `.tiles` of xgrow, whatever its name.
    ///
    /// # Errors
    /// If the file cannot be read or is not a tile set.
    pub fn load(path: &Path) -> Result<Self, DesignError> {
        let file = path.display().to_string();
        let text = crate::design::read_text(path).map_err(|error| {
            let message = format!("cannot read the tile set: {error}");
            let help = "check the path; shipped tile sets are in shapes/assemblies/";
            DesignError::new(&file, None, message, help)
        })?;
        Self::parse(&text, &file)
    }

    /// Reads a tile set from the text of its file.
    ///
    /// # Errors
    /// If it is none.
    pub fn parse(text: &str, file: &str) -> Result<Self, DesignError> {
        // Some editors begin a file with a byte-order mark.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut set = match text.contains("tile edges=") && text.contains("num tile types=") {
            true => xgrow::read(text, file)?,
            false => rgrow::read(text, file)?,
        };
        let stem = Path::new(file).file_stem();
        let name = stem.map_or(file.into(), |stem| stem.to_string_lossy());
        // The name appears in comments of the written files.
        set.name = name.replace(is_invisible, "\u{fffd}");
        set.check(text, file)?;
        Ok(set)
    }

    /// All strengths at once, by glue and glue.
    pub fn strengths(&self) -> Vec<Vec<f64>> {
        let n = self.glues.len();
        let mut table = vec![vec![0.0; n]; n];
        for (a, b, strength) in &self.links {
            table[*a][*b] = *strength;
            table[*b][*a] = *strength;
        }
        for (a, glue) in self.glues.iter().enumerate() {
            table[a][a] = glue.strength;
        }
        table
    }

    /// The same with 0 in place of repulsion, for xgrow. It computes the rate of a free place from
    /// the tiles that would be bound there, but then also chooses among those that would be
    /// repelled (`calc_rates` and `choose_cell` in its grow.c). If there is one, a tile later in
    /// the list never docks, and growth stops.
    pub fn without_repulsion(&self) -> Self {
        let mut set = self.clone();
        set.links.retain(|link| link.2 > 0.0);
        for glue in &mut set.glues {
            glue.strength = glue.strength.max(0.0);
        }
        set
    }

    /// The least strength that holds a tile, and where it comes from.
    pub fn tau_from(&self) -> (f64, Tau) {
        match (self.tau, self.gse, self.gmc) {
            (Some(tau), ..) => (tau, Tau::Stated),
            // Bonds of strength b hold a tile if b Gse is above Gmc; a ratio just above a whole
            // number is one that was meant to be at the limit.
            (None, Some(gse), Some(gmc)) if gse > 0.0 => {
                ((gmc / gse - 0.1).ceil().max(1.0), Tau::OfEnergies)
            }
            _ => (2.0, Tau::Assumed),
        }
    }

    /// The least strength that holds a tile.
    pub fn tau(&self) -> f64 {
        self.tau_from().0
    }

    /// The number of each tile for a set that is laid by hand: its shares if all are whole numbers,
    /// otherwise one of each.
    pub fn laid(&self) -> Vec<usize> {
        let shares = self.tiles.iter().map(|tile| tile.stoic);
        let whole = shares.clone().all(|share| share == share.round());
        shares
            .map(|share| if whole { share as usize } else { 1 })
            .collect()
    }

    /// The index of the glue with this name, which is added if it is new.
    pub fn glue(&mut self, name: &str, strength: f64) -> usize {
        let known = self.glues.iter().position(|glue| glue.name == name);
        known.unwrap_or_else(|| {
            let name = name.to_owned();
            self.glues.push(Glue { name, strength });
            self.glues.len() - 1
        })
    }

    /// Checks a set whose syntax is correct.
    fn check(&self, text: &str, file: &str) -> Result<(), DesignError> {
        let wrong = |needle: &str, message: String, help: &str| {
            Err(fault(text, file, needle, message, help))
        };
        if self.tiles.is_empty() {
            return wrong("", "it has no tiles".to_owned(), "list them under `tiles`");
        }
        if self.tiles.len() > MOST || self.glues.len() > MOST {
            let message = format!("it has more than {MOST} tiles or glues");
            return wrong("", message, "split the set");
        }
        let glues = self.glues.iter().map(|glue| &glue.name);
        let tiles = self.tiles.iter().map(|tile| &tile.name);
        let mut names = glues.clone().chain(tiles.clone());
        if let Some((name, told)) = names.find_map(|name| {
            let told = check_visible(name, |_| false);
            told.err().map(|told| (name, told))
        }) {
            return wrong("", format!("the name {name:?} {told}"), "delete it");
        }
        let mut seen = HashSet::new();
        if let Some(name) = glues.clone().find(|name| !seen.insert(*name)) {
            let message = format!("the glue `{name}` is defined twice");
            return wrong(name, message, "give every glue its own name");
        }
        let mut seen = HashSet::new();
        if let Some(name) = tiles.clone().find(|name| !seen.insert(*name)) {
            let message = format!("the tile `{name}` is defined twice");
            return wrong(name, message, "give every tile its own name");
        }
        for tile in &self.tiles {
            let ends = |c: char| is_invisible(c) || ")%".contains(c);
            if let Some(color) = tile.color.as_ref().filter(|color| color.contains(ends)) {
                let message = format!("the tile `{}` has the colour {color:?}", tile.name);
                return wrong(&tile.name, message, "use an X11 colour: red, or #ff0000");
            }
        }
        if self.tiles.iter().all(|tile| tile.stoic == 0.0) {
            let message = "all of its tiles have a share of 0, so the table is empty".to_owned();
            return wrong(
                "stoic",
                message,
                "give at least one tile a share (stoic) above 0",
            );
        }
        if let Some(size) = self
            .size
            .filter(|size| size.iter().any(|n| !(1..=MOST_CANVAS).contains(n)))
        {
            let message =
                format!("its canvas has {size:?} rows and columns, not 1 to {MOST_CANVAS}");
            return wrong("size", message, "write size: [32, 32]");
        }
        let mut places = HashSet::new();
        for (row, column, tile) in &self.seed {
            if !places.insert((row, column)) {
                let message = format!("two seeds are at {row}, {column}");
                return wrong("seed", message, "remove one");
            }
            if (*row).max(*column) >= MOST_CANVAS {
                let message =
                    format!("the seed at {row}, {column} is too far out: at most {MOST_CANVAS}");
                return wrong(
                    "seed",
                    message,
                    "write seed: [row, column, tile] with smaller numbers",
                );
            }
            let [rows, columns] = self.size.unwrap_or([MOST_CANVAS; 2]);
            if *tile >= self.tiles.len() || *row >= rows || *column >= columns {
                let message = format!("the seed at {row}, {column} is not a tile on the canvas");
                return wrong("seed", message, "write seed: [row, column, tile]");
            }
        }
        Ok(())
    }
}

/// A number if it is in its range; otherwise what is wrong with `what`, and the fix.
fn in_range(what: &str, number: f64, range: &RangeInclusive<f64>) -> Result<f64, (String, String)> {
    if range.contains(&number) {
        return Ok(number);
    }
    let describe = |number: &f64| format!("{number:?}").trim_end_matches(".0").to_owned();
    let [number, least, most] = [&number, range.start(), range.end()].map(describe);
    Err((
        format!("{what} is {number}, not from {least} to {most}"),
        format!("write a number from {least} to {most}, such as 1"),
    ))
}

/// A fault at the position where a text assigns the name `needle`, or first contains it.
pub(crate) fn fault(
    text: &str,
    file: &str,
    needle: &str,
    message: String,
    help: &str,
) -> DesignError {
    let named = |before: &str, after: &str| {
        let at = text.find(&format!("{before}{needle}{after}"))?;
        Some(at + before.len())
    };
    let at = match needle {
        "" => None,
        _ => named("name: ", ",")
            .or_else(|| named("name: \"", "\""))
            .or_else(|| named("\"name\": \"", "\""))
            .or_else(|| text.find(needle)),
    };
    let place = at.map(|at| FilePlace::of(text, at..at + needle.len()));
    DesignError::new(file, place, message, help)
}
