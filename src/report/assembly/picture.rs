//! A picture of the growth without errors, tile by tile.

use std::collections::BTreeSet;

use plotters::style::RGBColor;

use crate::document::rows;
use crate::plots::composition::{Composition, Panel};
use crate::plots::heat;
use crate::plots::key::{Sign, key as explained};
use crate::plots::{Figure, PictureError, Sheet};
use jobs::assembly::{Assembly, TileSet};

/// Colours distinguishable with colour blindness (Okabe and Ito), and two greys.
const COLOURS: [&str; 8] = [
    "#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#999999",
];
/// Pixels along the longer side, and the least width, in which the key has room.
const SIDES: [f64; 2] = [640.0, 360.0];
/// Greatest side of a tile, and space around them all (pixels).
const MOST_CELL: f64 = 105.0;
const SPACE: f64 = 22.0;
/// With more kinds of tiles than this, the key has one entry per colour, with the kinds of that
/// colour.
const MOST_NAMED: usize = 16;
/// Largest number of letters of such names.
const LETTERS: [usize; 2] = [16, 36];

/// Kinds of tiles with their colours, where a block of tiles is one kind; and the kind of every
/// tile.
fn kinds(set: &TileSet) -> (Vec<(&str, String)>, Vec<usize>) {
    let mut kinds: Vec<(&str, String)> = Vec::new();
    let mut of_tile = Vec::new();
    for tile in &set.tiles {
        let name = tile.name.split('/').next().unwrap_or_default();
        let known = kinds.iter().position(|kind| kind.0 == name);
        of_tile.push(known.unwrap_or(kinds.len()));
        if known.is_none() {
            let is_hex = |it: &str| it.len() == 6 && it.bytes().all(|c| c.is_ascii_hexdigit());
            let own = tile.color.as_deref();
            let own = own.filter(|it| it.strip_prefix('#').is_some_and(is_hex));
            let colour = own.unwrap_or(COLOURS[kinds.len() % COLOURS.len()]);
            kinds.push((name, colour.to_owned()));
        }
    }
    (kinds, of_tile)
}

/// The entries of the key: colours and names.
fn key(kinds: &[(&str, String)]) -> Vec<(String, String)> {
    let clip = |name: &str, most: usize| -> String { name.chars().take(most).collect() };
    if kinds.len() <= MOST_NAMED {
        let one = |(name, colour): &(&str, String)| (colour.clone(), clip(name, LETTERS[0]));
        return kinds.iter().map(one).collect();
    }
    let mut colours: Vec<&String> = kinds.iter().map(|kind| &kind.1).collect();
    let mut seen = BTreeSet::new();
    colours.retain(|colour| seen.insert(*colour));
    let named = |colour: &String| {
        let names: Vec<&str> = kinds
            .iter()
            .filter(|kind| kind.1 == *colour)
            .map(|kind| kind.0)
            .collect();
        let mut text = clip(names[0], LETTERS[0]);
        let mut shown = 1;
        for name in &names[1..] {
            if text.chars().count() + name.chars().count() + 2 > LETTERS[1] {
                break;
            }
            text = format!("{text}, {name}");
            shown += 1;
        }
        match names.len() - shown {
            0 => text,
            more => format!("{text} and {more} more"),
        }
    };
    let one = |colour: &&String| ((*colour).clone(), named(colour));
    colours.iter().take(2 * MOST_NAMED).map(one).collect()
}

/// A colour as tile sets name it, such as `#0072B2`.
fn colour(hex: &str) -> [u8; 3] {
    [1, 3, 5].map(|k| u8::from_str_radix(&hex[k..k + 2], 16).unwrap_or(0))
}

/// Draws the picture.
pub(super) fn grown(
    assembly: &Assembly,
    title: &str,
    sheet: &Sheet,
) -> Result<Figure, PictureError> {
    let (set, grown) = (&assembly.built.set, &assembly.built.grown);
    let [low, high] = grown.extent();
    let [columns, lines] = [high.0 - low.0, high.1 - low.1].map(|last| f64::from(last + 1));
    let (kinds, of_tile) = kinds(set);
    let cell = move |width: f64| {
        let most = (SIDES[0] / columns.max(lines)).min(MOST_CELL);
        most.min((width - 2.0 * SPACE) / columns)
    };
    let width = (cell(SIDES[0] + 2.0 * SPACE) * columns).max(SIDES[1] - 2.0 * SPACE) + 2.0 * SPACE;
    let height = move |width| cell(width) * lines + SPACE;
    let panel = Panel::alone(height, |canvas, [left, top, right, _]| {
        let side = cell(right - left);
        for ((x, y), tile) in &grown.tiles {
            let left = left + SPACE + f64::from(x - low.0) * side;
            let top = top + f64::from(high.1 - y) * side;
            let place = [left, top, left + 0.94 * side, top + 0.94 * side];
            let (name, hex) = &kinds[of_tile[*tile]];
            heat::cell(canvas, place, colour(hex), name);
        }
    });
    let names = key(&kinds).into_iter();
    let names = names.map(|(hex, name)| {
        let [r, g, b] = colour(&hex);
        (Sign::Block(RGBColor(r, g, b)), name)
    });
    let names = names.filter(|_| kinds.len() > 1);
    let numbers = rows(&grown.tiles)
        .data("x", |it| it.0.0)
        .data("y", |it| it.0.1)
        .data("tile", |it| set.tiles[*it.1].name.clone());
    let composition = Composition {
        name: "grown".to_owned(),
        title: title.to_owned(),
        width,
        panels: vec![panel],
        keys: vec![explained(names)],
        ..Composition::default()
    };
    Figure::new(&composition, sheet, numbers.table("grown").csv())
}
