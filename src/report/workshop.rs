//! Workshop files: the sheet, and the drawings for the cutter.
//!
//! Lengths in files are in mm. In DXF there are closed polylines on the layers OUTLINE and POCKETS,
//! letters on POLES; arcs are arcs, by their bulges. In SVG a user unit is a millimetre, and arcs are
//! the `A` of paths.

use std::fmt::Write;

use nalgebra::Vector2;
use serde_json::json;

use crate::document::{Document, Drawing, Table, entries, rows};
use crate::dxf::{Dxf, Layer};
use crate::files::{PAGE, REPORT};
use crate::plots::glance;
use crate::tiles::grams;
use jobs::design::Design;
use jobs::inspection::Inspection;
use jobs::output::Command;
use jobs::workshop::{Corner, Filled, Made, MadeTile, Part, Pocket, grade};
use physics::tile::Magnet;
use physics::tile::magnet::Shape;

/// The files of the command.
pub const FILES: Command = Command {
    name: "make",
    files: &[
        REPORT,
        PAGE,
        "magnets.csv",
        "order.csv",
        "fixed.dxf",
        "fixed.svg",
        "moving.dxf",
        "moving.svg",
        "sheet.md",
    ],
    pictures: &["tiles"],
};

/// White space around an SVG drawing (mm).
const MARGIN: f64 = 5.0;

/// The document of the workshop files; its text is the sheet.
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
            "Two tiles with {count}, to scale in mm: `fixed` and `moving` as `.dxf` (layers \
             OUTLINE, POCKETS, POLES) and `.svg`. Lines are the cutter's centre line: they \
             include a kerf of {} mm. Pockets are {} mm larger than their magnets on every side.",
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
        pictures: vec![Drawing::new("Outward pole of each magnet", |sheet| {
            glance::draw(design, &Inspection::new(design), sheet)
        })],
        origin: "magnets in the order with the least repulsion".to_owned(),
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
    let told = |magnet: &Magnet| {
        let size = magnet.axis_first().map(plain);
        match magnet.form.shape {
            Shape::Block => format!("{}, magnetised along the first", size.join(" x ")),
            Shape::Disc => format!("discs, {} across and {} high", size[1], size[0]),
        }
    };
    rows(magnets)
        .column("number", "number", "", |(_, count)| *count)
        .column("size_m", "size (mm)", "along the moment first", |(magnet, _)| json!(magnet.axis_first())).without_csv()
            .viewed(move |(magnet, _)| told(magnet))
        .column("length_m", "", "", |(magnet, _)| magnet.axis_first()[0]).in_csv()
        .column("width_m", "", "", |(magnet, _)| magnet.axis_first()[1]).in_csv()
        .column("height_m", "", "", |(magnet, _)| magnet.axis_first()[2]).in_csv()
        .column("remanence_T", "remanence", "", |(magnet, _)| magnet.remanence())
        .column("nearest", "closest standard grade", "", |(magnet, _)| nearest(magnet.remanence()))
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

/// The magnets of a tile in the order of insertion.
// One line a column.
#[rustfmt::skip]
fn steps(name: &'static str, tile: &MadeTile) -> Table {
    let pocket = |it: &(usize, &Filled)| tile.part.pockets[it.1.pocket].clone();
    let open = |pocket: &Pocket| match (pocket.is_open(), pocket.crowded() > 0.0) {
        (true, true) => " (open, close)",
        (true, false) => " (open)",
        (false, true) => " (close)",
        (false, false) => "",
    };
    let told = move |it: &(usize, &Filled)| format!("{}{}", pocket(it).name, open(&pocket(it)));
    let depths = tile.part.pockets.iter().map(|pocket| plain(pocket.depth));
    let mut depths: Vec<String> = depths.collect();
    depths.sort();
    depths.dedup();
    // The most that is wanting, rounded up to tenths of a millimetre.
    let most = |wanting: fn(&Pocket) -> f64| {
        let most = tile.part.pockets.iter().map(wanting).fold(0.0, f64::max);
        (most > 0.0).then(|| plain((most * 1e4 - 1e-6).ceil() / 1e4))
    };
    let thin = most(Pocket::wanting).map(|more| format!(
        "; pockets marked open reach the rim or leave a wall below 0.5 mm: cut them through \
         the rim and fasten the magnets level with it, or raise `inset` by {more} mm, on slopes by more",
    ));
    let close = most(Pocket::crowded).map(|more| format!(
        "; pockets marked close overlap or leave a wall below 0.5 mm between them: space the \
         magnets out by {more} mm (`pitch`, `at`), or use a smaller --clearance",
    ));
    let [thin, close] = [thin, close].map(Option::unwrap_or_default);
    rows((1..).zip(&tile.steps))
        .column("tile", "", "", move |_| name).in_csv()
        .column("step", "step", "", |(step, _)| *step)
        .column("pocket", "pocket", "its face, and the magnet's number on it, counter-clockwise", move |it| pocket(it).name).viewed(told)
        .column("pole", "pole", "N or S out of the face; U north up, D south up", move |it| pocket(it).pole.letter().to_string())
        .column("push_N", "during insertion", "largest repulsion", |(_, it)| it.push).viewed(|(_, it)| advice(it))
        .column("wall_m", "", "", move |it| pocket(it).wall)
        .column("between_m", "", "", move |it| pocket(it).between)
        .column("depth_m", "", "", move |it| pocket(it).depth)
        .table(name)
        .in_file("order")
        .titled(
            format!("The {name} tile"),
            format!(
                "{} mm thick; pockets {} mm deep hold the magnets at mid-thickness: insert them \
                 from above, in this order{thin}{close}",
                plain(tile.part.thickness),
                depths.join(" or ")
            ),
        )
}

fn advice(filled: &Filled) -> String {
    match filled.is_to_be_held {
        true => format!(
            "repelled by {}: hold it until the glue is set",
            grams(filled.push)
        ),
        false => "stays in place".to_owned(),
    }
}

/// Millimetres to a micrometre.
fn mm(metres: f64) -> String {
    format!("{:.3}", 1e3 * metres + 0.0).replace("-0.000", "0.000")
}

/// The same without trailing zeros.
fn plain(metres: f64) -> String {
    let text = mm(metres);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The layers of a drawing, with distinct colours.
const LAYERS: [Layer; 3] = [("OUTLINE", 7), ("POCKETS", 1), ("POLES", 5)];

/// The lines as DXF.
fn dxf(part: &Part) -> String {
    let [(outline, _), (pockets, _), (poles, _)] = LAYERS;
    let mut dxf = Dxf::new(&LAYERS);
    dxf.closed_line(outline, &part.outline);
    for pocket in &part.pockets {
        dxf.closed_line(pockets, &pocket.corners);
    }
    for pocket in &part.pockets {
        for (pole, middle, height) in pocket.letters() {
            dxf.text(poles, middle, height, &pole.to_string());
        }
    }
    dxf.finish()
}

/// The lines as SVG, seen from above: y upwards becomes downwards.
fn svg(part: &Part) -> String {
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
                // Counter-clockwise remains so on paper, where y points down.
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
            path(&pocket.corners)
        );
        for (pole, middle, height) in pocket.letters() {
            let at = place(&middle);
            let (x, y) = at.split_once(' ').unwrap_or_default();
            let size = number(1e3 * height);
            let _ = writeln!(
                text,
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" fill=\"#0072B2\" \
                 text-anchor=\"middle\" dominant-baseline=\"central\">{pole}</text>"
            );
        }
    }
    text + "</svg>\n"
}

/// The smallest and the largest x and y (m) of a closed line.
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
