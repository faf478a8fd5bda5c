//! Files for the workshop: lines as DXF and SVG to scale, and a sheet to work by.
//!
//! Lengths are in mm. DXF is R12 in ASCII, which every program reads: closed polylines on the layers
//! OUTLINE and POCKETS, letters on POLES. In SVG a user unit is a millimetre.

use std::fmt::Write;

use nalgebra::Vector2;

use super::files::Files;
use super::inspection::GRAM;
use super::markdown::markdown_table;
use jobs::design::Design;
use jobs::workshop::{Making, Part, PartError, Pocket, grade, order};
use physics::tile::barcode::Pole;
use physics::tile::{Magnet, Tile};
use physics::units::si;

/// Density of neodymium magnets (kg/m^3).
const DENSITY: f64 = 7500.0;
/// Standard gravity (m/s^2).
const GRAVITY: f64 = 9.806_65;
/// White space around an SVG drawing (mm).
const MARGIN: f64 = 5.0;

/// All files of a design by name.
///
/// # Errors
/// Where the cut is too wide for the design.
pub fn files(design: &Design, making: &Making) -> Result<Files, PartError> {
    let mut files = Files::new();
    let tiles = [
        ("fixed", &design.pair.fixed),
        ("moving", &design.pair.moving),
    ];
    let mut parts = Vec::new();
    for (name, tile) in tiles {
        let part = Part::new(tile, making)?;
        files.insert(format!("{name}.dxf"), dxf(&part).into_bytes());
        files.insert(format!("{name}.svg"), svg(&part).into_bytes());
        parts.push((name, tile, part));
    }
    files.insert(
        "sheet.md".to_owned(),
        sheet(design, making, &parts).into_bytes(),
    );
    Ok(files)
}

/// Millimetres to a micrometre.
fn mm(metres: f64) -> String {
    format!("{:.3}", 1e3 * metres + 0.0).replace("-0.000", "0.000")
}

/// The same without zeros at the end.
fn plain(metres: f64) -> String {
    let text = mm(metres);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn letter(pole: Pole) -> &'static str {
    match pole {
        Pole::North => "N",
        Pole::South => "S",
    }
}

/// The lines as DXF.
pub fn dxf(part: &Part) -> String {
    let mut text = String::new();
    let mut pair = |code: u32, value: &str| {
        let _ = writeln!(text, "{code:>3}\n{value}");
    };
    pair(999, "tilebind, lengths in mm");
    for (code, value) in [
        (0, "SECTION"),
        (2, "HEADER"),
        (9, "$ACADVER"),
        (1, "AC1009"),
    ] {
        pair(code, value);
    }
    pair(0, "ENDSEC");
    pair(0, "SECTION");
    pair(2, "ENTITIES");
    let pockets = part
        .pockets
        .iter()
        .map(|pocket| (&pocket.corners[..], "POCKETS"));
    for (corners, layer) in std::iter::once((&part.outline[..], "OUTLINE")).chain(pockets) {
        for (code, value) in [(0, "POLYLINE"), (8, layer), (66, "1"), (70, "1")] {
            pair(code, value);
        }
        for corner in corners {
            pair(0, "VERTEX");
            pair(8, layer);
            pair(10, &mm(corner.x));
            pair(20, &mm(corner.y));
        }
        pair(0, "SEQEND");
        pair(8, layer);
    }
    for pocket in &part.pockets {
        for (pole, side) in [("N", 0.5), ("S", -0.5)] {
            let at = pocket.middle + pocket.north * side;
            pair(0, "TEXT");
            pair(8, "POLES");
            pair(10, &mm(at.x));
            pair(20, &mm(at.y));
            pair(40, &mm(pocket.north.norm() * 0.6));
            pair(1, pole);
        }
    }
    pair(0, "ENDSEC");
    pair(0, "EOF");
    text
}

/// The lines as SVG, y upwards turned downwards as seen from above.
pub fn svg(part: &Part) -> String {
    let corners = || part.outline.iter();
    let bound = |fold: fn(f64, f64) -> f64, start: f64| {
        let fold = |axis: usize| corners().map(|p| 1e3 * p[axis]).fold(start, fold);
        [fold(0), fold(1)]
    };
    let (low, high) = (
        bound(f64::min, f64::INFINITY),
        bound(f64::max, f64::NEG_INFINITY),
    );
    let size = [0, 1].map(|k| high[k] - low[k] + 2.0 * MARGIN);
    let place = |p: &Vector2<f64>| {
        let at = [1e3 * p.x - low[0] + MARGIN, high[1] - 1e3 * p.y + MARGIN];
        at.map(|x| format!("{x:.3}"))
    };
    let path = |points: &[Vector2<f64>]| {
        let points: Vec<String> = points.iter().map(|p| place(p).join(" ")).collect();
        format!("M{}Z", points.join("L"))
    };
    let [width, height] = size.map(|x| format!("{x:.3}"));
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{height}mm\" \
         viewBox=\"0 0 {width} {height}\" fill=\"none\" stroke-width=\"0.1\">\n\
         <path id=\"outline\" stroke=\"#000000\" d=\"{}\"/>\n",
        path(&part.outline)
    );
    for pocket in &part.pockets {
        let _ = writeln!(
            text,
            "<path stroke=\"#D55E00\" d=\"{}\"/>",
            path(&pocket.corners)
        );
        for (pole, side) in [("N", 0.5), ("S", -0.5)] {
            let [x, y] = place(&(pocket.middle + pocket.north * side));
            let size = 600.0 * pocket.north.norm();
            let _ = writeln!(
                text,
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{size:.2}\" fill=\"#0072B2\" \
                 text-anchor=\"middle\" dominant-baseline=\"central\">{pole}</text>"
            );
        }
    }
    text + "</svg>\n"
}

/// The sheet, as Markdown.
fn sheet(design: &Design, making: &Making, parts: &[(&str, &Tile, Part)]) -> String {
    let mut text = format!("# {}: to be made\n\n", design.name);
    let _ = writeln!(
        text,
        "Drawings are to scale in mm: `fixed` and `moving` as `.dxf` (layers OUTLINE, POCKETS, POLES) \
         and `.svg`. They are the lines of the cutter's middle: a kerf of {} mm is allowed for, and \
         pockets are {} mm larger than their magnets on every side.\n",
        plain(making.kerf),
        plain(making.clearance)
    );
    text.push_str("## Magnets\n\n");
    text.push_str(&markdown_table(&purchases(parts)));
    for (name, tile, part) in parts {
        let _ = writeln!(
            text,
            "\n## The {name} tile\n\n{} mm thick; pockets {} mm deep hold the magnets midway. Put \
             them in from above, in this order:\n",
            plain(part.thickness),
            depths(part)
        );
        text.push_str(&markdown_table(&steps(tile, part)));
        let wanting = part.pockets.iter().map(Pocket::wanting).fold(0.0, f64::max);
        if wanting > 0.0 {
            // Up to tenths of a millimetre.
            let more = (wanting * 1e4 - 1e-6).ceil() / 1e4;
            let _ = writeln!(
                text,
                "\nPockets marked *open* reach the rim or leave a wall below 0.5 mm: cut them \
                 through it and glue the magnets flush, or raise `inset` by {} mm, on slopes by more.",
                plain(more)
            );
        }
    }
    text
}

/// The depths of a part's pockets.
fn depths(part: &Part) -> String {
    let depths = part.pockets.iter().map(|pocket| plain(pocket.depth));
    let mut depths: Vec<String> = depths.collect();
    depths.sort();
    depths.dedup();
    depths.join(" or ")
}

/// How many magnets of which kind to buy.
fn purchases(parts: &[(&str, &Tile, Part)]) -> Vec<Vec<String>> {
    let mut kinds: Vec<(&Magnet, usize)> = Vec::new();
    for magnet in parts.iter().flat_map(|(_, tile, _)| &tile.magnets) {
        let same = |known: &&mut (&Magnet, usize)| {
            known.0.size == magnet.size && (known.0.moment - magnet.moment).abs() < 1e-12
        };
        match kinds.iter_mut().find(same) {
            Some(kind) => kind.1 += 1,
            None => kinds.push((magnet, 1)),
        }
    }
    let head = [
        "number",
        "size (mm)",
        "remanence",
        "nearest in the catalogue",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(kinds.into_iter().map(|(magnet, count)| {
        let remanence = magnet.remanence();
        let size = magnet
            .size
            .map(|x| format!("{}", (1e5 * x).round() / 100.0))
            .join(" x ");
        let nearest = match grade::nearest(remanence) {
            Some((grade, own)) => format!(
                "{grade} ({own} T: forces {:+.0} %)",
                100.0 * ((own / remanence).powi(2) - 1.0)
            ),
            None if remanence < grade::sold()[0].remanence[1] => {
                "weaker than N35 (1.19 T)".to_owned()
            }
            None => "none: stronger than N52 (1.46 T)".to_owned(),
        };
        vec![
            count.to_string(),
            format!("{size}, magnetised along the first"),
            si(remanence, "T", 3),
            nearest,
        ]
    }));
    rows
}

/// The magnets of a tile in the order in which they go in.
fn steps(tile: &Tile, part: &Part) -> Vec<Vec<String>> {
    let head = ["step", "pocket", "pole outwards", "on the way in"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for face in 0..tile.faces.len() {
        let own = |i: &usize| tile.magnets[*i].face == face;
        let places: Vec<usize> = (0..tile.magnets.len()).filter(own).collect();
        let magnets: Vec<&Magnet> = places.iter().map(|&i| &tile.magnets[i]).collect();
        for step in order::order(&magnets) {
            let pocket: &Pocket = &part.pockets[places[step.magnet]];
            let weight = DENSITY * GRAVITY * magnets[step.magnet].size.iter().product::<f64>();
            let advice = match step.push {
                push if push > weight => format!(
                    "pushed out with {:.0} g: hold it until the glue is set",
                    push / GRAM
                ),
                _ => "stays by itself".to_owned(),
            };
            let open = if pocket.is_open() { " (*open*)" } else { "" };
            rows.push(vec![
                rows.len().to_string(),
                format!("{}{open}", pocket.name),
                letter(pocket.pole).to_owned(),
                advice,
            ]);
        }
    }
    rows
}
