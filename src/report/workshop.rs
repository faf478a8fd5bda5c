//! A design to be made: what people work by, and files for the workshop.
//!
//! Lengths in files are in mm. DXF is R12 in ASCII, which every program reads: closed polylines on the
//! layers OUTLINE and POCKETS, letters on POLES. In SVG a user unit is a millimetre.

use std::fmt::Write;

use nalgebra::Vector2;
use serde_json::json;

use crate::document::{Document, Drawing, Table, entries, rows};
use crate::plots::glance;
use crate::tiles::GRAM;
use jobs::design::Design;
use jobs::inspection::Inspection;
use jobs::workshop::{Filled, Made, MadeTile, Part, Pocket, grade};
use physics::tile::Magnet;
use physics::tile::barcode::Pole;

/// White space around an SVG drawing (mm).
const MARGIN: f64 = 5.0;

/// What it takes to make a design; its text is the sheet to work by.
pub fn document<'a>(design: &'a Design, made: &Made) -> Document<'a> {
    let making = &made.making;
    let count = match made.magnets.iter().map(|(_, count)| count).sum() {
        1 => "1 magnet".to_owned(),
        many => format!("{many} magnets"),
    };
    let [fixed, moving] = &made.tiles;
    let mut document = Document {
        title: format!("{}: to be made", design.name),
        answer: format!(
            "Two tiles with {count}, to scale in mm: `fixed` and `moving` as `.dxf` (layers OUTLINE, \
             POCKETS, POLES) and `.svg`. They are the lines of the cutter's middle: a kerf of {} mm is \
             allowed for, and pockets are {} mm larger than their magnets on every side.",
            plain(making.kerf),
            plain(making.clearance)
        ),
        entries: entries(design)
            .data(
                "settings",
                json!({ "kerf_m": making.kerf, "clearance_m": making.clearance }),
            )
            .table(magnets(&made.magnets))
            .table(steps("fixed", fixed))
            .table(steps("moving", moving)),
        pictures: vec![Drawing::new(
            "Which pole each magnet turns outwards",
            |sheet| glance::draw(design, &Inspection::new(design), sheet),
        )],
        origin: "order of the magnets: that in which the worst push is least".to_owned(),
        ..Document::default()
    };
    let sheet = document.markdown();
    document.beside = [("fixed", fixed), ("moving", moving)]
        .into_iter()
        .flat_map(|(name, tile)| {
            let (dxf, svg) = (dxf(&tile.part), svg(&tile.part));
            [(format!("{name}.dxf"), dxf), (format!("{name}.svg"), svg)]
        })
        .chain([("sheet.md".to_owned(), sheet)])
        .map(|(name, text)| (name, text.into_bytes()))
        .collect();
    document
}

/// The magnets to buy.
// One line a column.
#[rustfmt::skip]
fn magnets(magnets: &[(Magnet, usize)]) -> Table {
    let size = |magnet: &Magnet| magnet.size.map(|x| format!("{}", (1e5 * x).round() / 100.0)).join(" x ");
    rows(magnets)
        .column("number", "number", "", |(_, count)| *count)
        .column("size_m", "size (mm)", "along the moment first", |(magnet, _)| json!(magnet.size)).without_csv()
            .viewed(move |(magnet, _)| format!("{}, magnetised along the first", size(magnet)))
        .column("length_m", "", "", |(magnet, _)| magnet.size[0]).in_csv()
        .column("width_m", "", "", |(magnet, _)| magnet.size[1]).in_csv()
        .column("height_m", "", "", |(magnet, _)| magnet.size[2]).in_csv()
        .column("remanence_T", "remanence", "", |(magnet, _)| magnet.remanence())
        .column("nearest", "nearest in the catalogue", "", |(magnet, _)| nearest(magnet.remanence()))
        .table("magnets")
        .in_file("magnets")
        .titled("Magnets", "")
}

fn nearest(remanence: f64) -> String {
    match grade::nearest(remanence) {
        Some((grade, own)) => format!(
            "{grade} ({own} T: forces {:+.0} %)",
            100.0 * ((own / remanence).powi(2) - 1.0)
        ),
        None if remanence < grade::sold()[0].remanence[1] => "weaker than N35 (1.19 T)".to_owned(),
        None => "none: stronger than N52 (1.46 T)".to_owned(),
    }
}

/// The magnets of a tile in the order in which they go in.
// One line a column.
#[rustfmt::skip]
fn steps(name: &'static str, tile: &MadeTile) -> Table {
    let pocket = |it: &(usize, &Filled)| tile.part.pockets[it.1.pocket].clone();
    let open = |pocket: &Pocket| if pocket.is_open() { " (*open*)" } else { "" };
    let told = move |it: &(usize, &Filled)| format!("{}{}", pocket(it).name, open(&pocket(it)));
    let depths = tile.part.pockets.iter().map(|pocket| plain(pocket.depth));
    let mut depths: Vec<String> = depths.collect();
    depths.sort();
    depths.dedup();
    let wanting = tile.part.pockets.iter().map(Pocket::wanting).fold(0.0, f64::max);
    // Up to tenths of a millimetre.
    let more = (wanting * 1e4 - 1e-6).ceil() / 1e4;
    let thin = match wanting > 0.0 {
        true => format!(
            "; pockets marked *open* reach the rim or leave a wall below 0.5 mm: cut them through it and \
             glue the magnets flush, or raise `inset` by {} mm, on slopes by more",
            plain(more)
        ),
        false => String::new(),
    };
    rows((1..).zip(&tile.steps))
        .column("tile", "", "", move |_| name).in_csv()
        .column("step", "step", "", |(step, _)| *step)
        .column("pocket", "pocket", "its face, and which magnet of it, counter-clockwise", move |it| pocket(it).name).viewed(told)
        .column("pole", "pole outwards", "", move |it| letter(pocket(it).pole))
        .column("push_N", "on the way in", "the largest push out", |(_, it)| it.push).viewed(|(_, it)| advice(it))
        .column("wall_m", "", "", move |it| pocket(it).wall)
        .column("depth_m", "", "", move |it| pocket(it).depth)
        .table(name)
        .in_file("order")
        .titled(
            format!("The {name} tile"),
            format!(
                "{} mm thick; pockets {} mm deep hold the magnets midway: put them in from above, in \
                 this order{thin}",
                plain(tile.part.thickness),
                depths.join(" or ")
            ),
        )
}

fn advice(filled: &Filled) -> String {
    match filled.is_to_be_held {
        true => format!(
            "pushed out with {:.0} g: hold it until the glue is set",
            filled.push / GRAM
        ),
        false => "stays by itself".to_owned(),
    }
}

fn letter(pole: Pole) -> &'static str {
    match pole {
        Pole::North => "N",
        Pole::South => "S",
    }
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

/// The lines as DXF.
fn dxf(part: &Part) -> String {
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
fn svg(part: &Part) -> String {
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
