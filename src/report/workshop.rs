//! Files for the workshop: lines as DXF and SVG to scale, and a sheet to work by.
//!
//! Lengths are in mm. In DXF there are closed polylines on the layers OUTLINE and POCKETS, letters on
//! POLES; arcs are arcs, by their bulges. In SVG a user unit is a millimetre, and arcs are the `A` of
//! paths.

use std::fmt::Write;

use nalgebra::Vector2;

use super::dxf::{Dxf, Layer};
use super::files::Files;
use super::inspection::GRAM;
use super::markdown::markdown_table;
use jobs::design::Design;
use jobs::workshop::{Corner, Making, Part, PartError, Pocket, grade, order};
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

/// The layers of a drawing, with colours that tell them apart.
const LAYERS: [Layer; 3] = [("OUTLINE", 7), ("POCKETS", 1), ("POLES", 5)];

/// Height of letters in lengths of their magnet.
const LETTER: f64 = 0.3;

/// A pocket's rim.
fn rim(pocket: &Pocket) -> [Corner; 4] {
    pocket.corners.map(|point| Corner { point, bulge: 0.0 })
}

/// Where the letters of a pocket's poles stand.
fn letters(pocket: &Pocket) -> [(&'static str, Vector2<f64>); 2] {
    [("N", 0.5), ("S", -0.5)].map(|(pole, side)| (pole, pocket.middle + pocket.north * side))
}

/// The height of these letters (m).
fn letter_height(pocket: &Pocket) -> f64 {
    2.0 * LETTER * pocket.north.norm()
}

/// The lines as DXF.
pub fn dxf(part: &Part) -> String {
    let [(outline, _), (pockets, _), (poles, _)] = LAYERS;
    let mut dxf = Dxf::new(&LAYERS);
    dxf.closed_line(outline, &part.outline);
    for pocket in &part.pockets {
        dxf.closed_line(pockets, &rim(pocket));
    }
    for pocket in &part.pockets {
        for (pole, middle) in letters(pocket) {
            dxf.text(poles, middle, letter_height(pocket), pole);
        }
    }
    dxf.finish()
}

/// The lines as SVG, y upwards turned downwards as seen from above.
pub fn svg(part: &Part) -> String {
    let [low, high] = extent(&part.outline).map(|corner| corner.map(|x| 1e3 * x));
    let size = [0, 1].map(|k| high[k] - low[k] + 2.0 * MARGIN);
    let number = |x: f64| {
        let text = format!("{:.6}", x + 0.0);
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    let place = |p: &Vector2<f64>| {
        let at = [1e3 * p.x - low[0] + MARGIN, high[1] - 1e3 * p.y + MARGIN];
        at.map(number).join(" ")
    };
    let path = |corners: &[Corner]| {
        let mut d = format!("M{}", place(&corners[0].point));
        let nexts = corners.iter().cycle().skip(1);
        for (k, (corner, next)) in corners.iter().zip(nexts).enumerate() {
            let end = place(&next.point);
            let _ = match corner.arc(next) {
                // Counter-clockwise is so on paper too, where y runs down.
                Some((radius, large)) => {
                    let (large, sweep) = (u8::from(large), u8::from(corner.bulge < 0.0));
                    let radius = number(1e3 * radius);
                    write!(d, "A{radius} {radius} 0 {large} {sweep} {end}")
                }
                None if k + 1 == corners.len() => Ok(()),
                None => write!(d, "L{end}"),
            };
        }
        d + "Z"
    };
    let [width, height] = size.map(number);
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
            path(&rim(pocket))
        );
        for (pole, middle) in letters(pocket) {
            let at = place(&middle);
            let (x, y) = at.split_once(' ').unwrap_or_default();
            let size = number(1e3 * letter_height(pocket));
            let _ = writeln!(
                text,
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" fill=\"#0072B2\" \
                 text-anchor=\"middle\" dominant-baseline=\"central\">{pole}</text>"
            );
        }
    }
    text + "</svg>\n"
}

/// The least and the greatest x and y (m) of a closed line.
fn extent(corners: &[Corner]) -> [[f64; 2]; 2] {
    let mut points: Vec<Vector2<f64>> = Vec::new();
    for (corner, next) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        points.push(corner.point);
        points.extend(corner.turning_points(next));
    }
    let of = |fold: fn(f64, f64) -> f64, start: f64| {
        [0, 1].map(|k| points.iter().map(|p| p[k]).fold(start, fold))
    };
    [of(f64::min, f64::INFINITY), of(f64::max, f64::NEG_INFINITY)]
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
        let size = magnet.size.map(plain).join(" x ");
        let nearest = match grade::nearest(remanence) {
            Some((grade, own)) => format!(
                "{grade} ({own} T: forces {:+.0} %)",
                100.0 * ((own / remanence).powi(2) - 1.0)
            ),
            None if remanence < grade::GRADES[0].1 => "weaker than N35 (1.19 T)".to_owned(),
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
