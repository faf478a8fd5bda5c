//! What grows without errors, drawn tile by tile.

use std::fmt::Write;

use super::Assembly;

/// Colours that colour-blind people tell apart (Okabe and Ito), and two greys.
const COLOURS: [&str; 8] = [
    "#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#999999",
];
/// Pixels along the longer side.
const SIDE: f64 = 640.0;
/// Sets of more tiles have no key.
const MOST_NAMED: usize = 16;

/// The picture, as an SVG document.
pub(super) fn grown(assembly: &Assembly) -> String {
    let (set, grown) = (&assembly.built.set, &assembly.built.grown);
    let [low, high] = grown.extent();
    let (columns, rows) = (f64::from(high.0 - low.0 + 1), f64::from(high.1 - low.1 + 1));
    let cell = (SIDE / columns.max(rows)).min(40.0);
    let named = set.tiles.len() <= MOST_NAMED;
    let key = if named {
        26.0 * set.tiles.len() as f64 + 16.0
    } else {
        0.0
    };
    let (width, height) = (
        cell * columns + if named { 170.0 } else { 0.0 },
        (cell * rows).max(key),
    );
    let colour = |tile: usize| {
        let own = set.tiles[tile].color.as_deref().filter(|it| {
            it.len() == 7 && it.starts_with('#') && it[1..].bytes().all(|c| c.is_ascii_hexdigit())
        });
        own.unwrap_or(COLOURS[tile % COLOURS.len()]).to_owned()
    };
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
            colour(*tile)
        );
    }
    if named {
        let left = cell * columns + 14.0;
        for (number, tile) in set.tiles.iter().enumerate() {
            let top = 8.0 + 26.0 * number as f64;
            let name: String = tile.name.chars().take(16).collect();
            let name = name.replace('&', "&amp;").replace('<', "&lt;");
            let _ = writeln!(
                text,
                "<rect x=\"{left:.2}\" y=\"{top:.2}\" width=\"16\" height=\"16\" fill=\"{}\"/><text \
                 x=\"{:.2}\" y=\"{:.2}\" fill=\"#222222\">{name}</text>",
                colour(number),
                left + 24.0,
                top + 13.0
            );
        }
    }
    text + "</svg>\n"
}
