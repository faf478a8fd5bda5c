//! What grows without errors, drawn tile by tile.

use std::collections::BTreeSet;
use std::fmt::Write;

use super::Assembly;
use jobs::assembly::TileSet;

/// Colours that colour-blind people tell apart (Okabe and Ito), and two greys.
const COLOURS: [&str; 8] = [
    "#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#999999",
];
/// Pixels along the longer side.
const SIDE: f64 = 640.0;
/// Of more kinds of tiles the key names colours, with the kinds that have them.
const MOST_NAMED: usize = 16;
/// Letters of such names at most.
const LETTERS: [usize; 2] = [16, 36];

/// Kinds of tiles, blocks of tiles as one, and their colours; and the kind of every tile.
fn kinds(set: &TileSet) -> (Vec<(&str, String)>, Vec<usize>) {
    let mut kinds: Vec<(&str, String)> = Vec::new();
    let mut of_tile = Vec::new();
    for tile in &set.tiles {
        let name = tile.name.split('/').next().unwrap_or_default();
        let known = kinds.iter().position(|kind| kind.0 == name);
        of_tile.push(known.unwrap_or(kinds.len()));
        if known.is_none() {
            let own = tile.color.as_deref().filter(|it| {
                it.len() == 7
                    && it.starts_with('#')
                    && it[1..].bytes().all(|c| c.is_ascii_hexdigit())
            });
            let colour = own.unwrap_or(COLOURS[kinds.len() % COLOURS.len()]);
            kinds.push((name, colour.to_owned()));
        }
    }
    (kinds, of_tile)
}

/// Colours and what the key says of them.
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

/// The picture, as an SVG document.
pub(super) fn grown(assembly: &Assembly) -> String {
    let (set, grown) = (&assembly.built.set, &assembly.built.grown);
    let [low, high] = grown.extent();
    let (columns, rows) = (f64::from(high.0 - low.0 + 1), f64::from(high.1 - low.1 + 1));
    let cell = (SIDE / columns.max(rows)).min(40.0);
    let (kinds, of_tile) = kinds(set);
    let key = key(&kinds);
    let letters = key.iter().map(|it| it.1.chars().count()).max();
    let (width, height) = (
        cell * columns + 50.0 + 7.5 * letters.unwrap_or(0) as f64,
        (cell * rows).max(26.0 * key.len() as f64 + 16.0),
    );
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
         viewBox=\"0 0 {width:.2} {height:.2}\" font-family=\"Noto Sans, Helvetica, Arial, \
         sans-serif\" font-size=\"13\">\n"
    );
    for ((x, y), tile) in &grown.tiles {
        let (left, top) = (f64::from(x - low.0) * cell, f64::from(high.1 - y) * cell);
        let _ = writeln!(
            text,
            "<rect x=\"{left:.2}\" y=\"{top:.2}\" width=\"{:.2}\" height=\"{:.2}\" fill=\"{}\"/>",
            cell * 0.94,
            cell * 0.94,
            kinds[of_tile[*tile]].1
        );
    }
    let left = cell * columns + 14.0;
    for (number, (colour, name)) in key.iter().enumerate() {
        let top = 8.0 + 26.0 * number as f64;
        let name = name.replace('&', "&amp;").replace('<', "&lt;");
        let _ = writeln!(
            text,
            "<rect x=\"{left:.2}\" y=\"{top:.2}\" width=\"16\" height=\"16\" fill=\"{colour}\"/>\
             <text x=\"{:.2}\" y=\"{:.2}\" fill=\"#222222\">{name}</text>",
            left + 24.0,
            top + 13.0
        );
    }
    text + "</svg>\n"
}
