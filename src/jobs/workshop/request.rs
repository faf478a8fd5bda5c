//! The options of the workshop files.

use super::error::PartError;
use crate::request::{self, options};

/// Largest kerf and clearance (m): larger ones were meant in millimetres.
const LONGEST: f64 = 0.01;

/// The usual gap between magnet and pocket on each side (m).
pub const CLEARANCE: f64 = 1e-4;

options! {
    /// The options of the workshop files.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Request {
        /// Width of the cut (m), or with a unit
        ///
        /// Outlines are offset outwards by half of it.
        pub kerf: f64 = value("M", small).or("0"),

        /// Gap between magnet and pocket on each side (m), or with a unit
        pub clearance: f64 = value("M", small).or("0.1 mm"),

        /// Copies of each kind of tile, nested on sheets
        pub copies: Option<usize> = value("N", copies).conflicts(&["count"]),

        /// Copies of the fixed tile and of the moving one, nested on sheets
        ///
        /// One number if both tiles are equal; of several designs or a tile set one for each kind of tile.
        pub count: Option<Counts> = value("N,M", counts),

        /// Size of a sheet of material: "600x400 mm" [default: 600x400 mm, if there are copies]
        pub sheet: Option<SheetSize> = value("SIZE", sheet),

        /// Gap between parts on a sheet, and to its edges (m), or with a unit
        pub spacing: f64 = value("M", small).or("2 mm"),

        /// Thickness of the layers of which a tile is glued, lowest first: "4 mm,4 mm"
        ///
        /// One part and file for each: pockets are cut through the layers that hold the magnets, and the
        /// others are lids.
        pub layers: Option<Layers> = value("M,M", layers),
    }
}

/// Numbers of copies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counts(pub Vec<usize>);

/// The size of a sheet (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetSize(pub [f64; 2]);

/// Thicknesses (m), lowest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Layers(pub Vec<f64>);

/// Largest number of copies.
const MOST_COPIES: usize = 10_000;
/// The usual sheet (m).
const USUAL_SHEET: [f64; 2] = [0.6, 0.4];

fn copies(text: &str) -> Result<usize, String> {
    let count = request::count(text)?;
    let few = count <= MOST_COPIES;
    few.then_some(count)
        .ok_or_else(|| format!("at most {MOST_COPIES} copies"))
}

fn counts(text: &str) -> Result<Counts, String> {
    let numbers: Option<Vec<usize>> = text
        .split(',')
        .map(|one| request::count_or_none(one.trim()).ok())
        .collect();
    let total = |it: &Vec<usize>| {
        it.iter()
            .fold(0, |all: usize, &one| all.saturating_add(one))
    };
    let numbers = numbers.filter(|it| (1..=MOST_COPIES).contains(&total(it)));
    numbers.map(Counts).ok_or_else(|| {
        format!("the number of each kind of tile is needed, such as 6,6: 1 to {MOST_COPIES} in all")
    })
}

fn sheet(text: &str) -> Result<SheetSize, String> {
    let wrong = || "a size is width x height with a unit, such as \"600x400 mm\"".to_owned();
    let text = text.replace(['X', '\u{d7}', '*'], "x");
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let (width, height) = (width.trim(), height.trim());
    let unit = height.trim_start_matches(|c: char| c.is_ascii_digit() || ".eE+- ".contains(c));
    // The width has its own unit, or that of the height.
    let own = width.ends_with(|c: char| c.is_alphabetic() || c == '"');
    let width = if own {
        width.to_owned()
    } else {
        format!("{width} {unit}")
    };
    let width = request::length(width.trim()).map_err(|_| wrong())?;
    let height = request::length(height).map_err(|_| wrong())?;
    match width.max(height) <= LARGEST_SHEET {
        true => Ok(SheetSize([width, height])),
        false => Err(format!(
            "a sheet is at most {LARGEST_SHEET} m long; {}",
            wrong()
        )),
    }
}

/// Longest side of a sheet (m): longer ones were meant in millimetres.
const LARGEST_SHEET: f64 = 20.0;

fn layers(text: &str) -> Result<Layers, String> {
    let each: Result<Vec<f64>, String> = text
        .split(',')
        .map(|one| request::length(one.trim()))
        .collect();
    each.map(Layers).map_err(|_| {
        "thicknesses with units are needed, lowest layer first: \"4 mm,4 mm\"".to_owned()
    })
}

/// A length of a few millimetres at most.
fn small(text: &str) -> Result<f64, String> {
    match request::length_or_none(text)? {
        length if length > LONGEST => {
            let most = format!("it can be at most {} mm", 1e3 * LONGEST);
            let is_plain = text.trim().parse::<f64>().is_ok();
            Err(match is_plain && length <= 1e3 * LONGEST {
                true => format!("{most}; lengths are in m: in millimetres write \"{length} mm\""),
                false => most,
            })
        }
        length => Ok(length),
    }
}

impl Request {
    /// Whether parts are to be nested on sheets.
    pub(super) fn are_copies(&self) -> bool {
        self.copies.is_some() || self.count.is_some() || self.sheet.is_some()
    }

    /// The size of a sheet (m).
    pub fn sheet(&self) -> [f64; 2] {
        self.sheet.map_or(USUAL_SHEET, |size| size.0)
    }

    /// The number of copies of each kind of tile, whose names and usual numbers are given.
    ///
    /// # Errors
    /// If `--count` states another number of kinds.
    pub(super) fn counts(&self, kinds: &[(&str, usize)]) -> Result<Vec<usize>, PartError> {
        let usual = kinds.iter().map(|(_, usual)| self.copies.unwrap_or(*usual));
        let Some(Counts(counts)) = &self.count else {
            return Ok(usual.collect());
        };
        if counts.len() == kinds.len() {
            return Ok(counts.clone());
        }
        // Of the fixed and of the moving tile, which are equal.
        if let ([_], [fixed, moving]) = (kinds, &counts[..]) {
            return Ok(vec![fixed + moving]);
        }
        let names: Vec<&str> = kinds.iter().map(|kind| kind.0).collect();
        let example = vec!["6"; kinds.len()].join(",");
        Err(PartError::Sheet(match kinds.len() {
            1 => "all tiles are of one kind: give one number, such as --count 6".to_owned(),
            many => format!(
                "there are {many} kinds of tiles ({}): give {many} numbers, such as --count {example}",
                names.join(", ")
            ),
        }))
    }
}
