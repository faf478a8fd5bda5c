//! Workshop files: the sheet, and the drawings for the cutter.
//!
//! `plan` draws the parts, and `stacked` the glue-up of layers.

mod plan;
mod stacked;

use serde_json::json;

use crate::document::{Document, Drawing, Entries, Entry, Table, entries, rows};
use crate::files::{Files, PAGE, REPORT};
use crate::plots::glance;
use crate::tiles::grams;
use jobs::design::Design;
use jobs::inspection::Inspection;
use jobs::output::Command;
use jobs::workshop::{Filled, Made, MadeTile, Placed, Pocket, Sheet, grade};
use physics::tile::Magnet;
use physics::tile::magnet::Shape;
use plan::Plan;

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
        "fixed-layer-#.dxf",
        "fixed-layer-#.svg",
        "moving-layer-#.dxf",
        "moving-layer-#.svg",
        "glue-up.svg",
        "nested-#.dxf",
        "nested-#.svg",
        "nested.csv",
        "check.svg",
        "sheet.md",
    ],
    pictures: &["tiles"],
};

/// The names of the tiles.
const NAMES: [&str; 2] = ["fixed", "moving"];

/// Distance (m) between the drawings of the page for checks, and height of its text.
const GAP: f64 = 0.015;
const TEXT: f64 = 0.004;

/// The document of the workshop files; its text is the sheet.
pub fn document<'a>(design: &'a Design, made: &Made) -> Document<'a> {
    let making = &made.making;
    let count = match made.magnets.iter().map(|(_, count)| count).sum() {
        1 => "1 magnet".to_owned(),
        many => format!("{many} magnets"),
    };
    let tiles = match made.counts {
        [1, 1] => "Two tiles".to_owned(),
        [fixed, moving] => format!("{fixed} fixed and {moving} moving tiles"),
    };
    let [fixed, moving] = &made.tiles;
    let (facts, said) = shopping(made);
    let mut document = Document {
        title: format!("{}: to be made", design.name),
        answer: format!(
            "{tiles} with {count}, to scale in mm, as `.dxf` and `.svg`. Layers, in the order of \
             work: ENGRAVE, CUT_INSIDE, CUT_OUTSIDE. Lines are the cutter's centre line: they \
             include a kerf of {} mm. Pockets are {} mm larger than their magnets on every side. \
             Tiles are seen from above. Pockets are counted counter-clockwise along each face. N \
             is a north pole that points out of the face; U is a north pole up. The arrow on a \
             tile points towards its face {}.",
            plain(making.kerf),
            plain(making.clearance),
            design.pair.fixed.faces[0].name
        ),
        entries: entries(design)
            .data("settings", settings(made))
            .and(facts)
            .table(magnets(&made.magnets))
            .more(nested(made).map(Entry::Table))
            .table(steps("fixed", fixed))
            .table(steps("moving", moving)),
        pictures: vec![Drawing::new("Outward pole of each magnet", |sheet| {
            glance::draw(design, &Inspection::new(design), sheet)
        })],
        notes: vec![said, CHECK.to_owned()],
        origin: "magnets in the order with the least repulsion".to_owned(),
        ..Document::default()
    };
    let sheet = document.markdown();
    document.beside = drawings(design, made);
    document
        .beside
        .insert("sheet.md".to_owned(), sheet.into_bytes());
    document
}

/// How to check the tiles after gluing.
const CHECK: &str = "To check the glued tiles, print check.svg at full size (100 %), lay each tile \
    on it, and compare every pole with a marked magnet. Then hold the two faces together: a pocket \
    that repels the one it faces holds a magnet the wrong way round.";

fn settings(made: &Made) -> serde_json::Value {
    let making = &made.making;
    json!({
        "kerf_m": making.kerf,
        "clearance_m": making.clearance,
        "copies": made.counts,
        "sheet_m": making.sheet(),
        "spacing_m": making.spacing,
        "layers_m": making.layers.as_ref().map(|layers| &layers.0),
    })
}

/// What to buy besides magnets, as figures and as a sentence.
fn shopping(made: &Made) -> (Entries, String) {
    let lengths = made.tiles.iter().zip(made.counts).map(|(tile, copies)| {
        let stack = tile.stack.as_ref();
        let layers = stack.map_or(vec![true], |stack| {
            stack.layers.iter().map(|it| it.1).collect()
        });
        let lengths = layers
            .into_iter()
            .map(|is_cut| tile.part.cut_length(is_cut));
        copies as f64 * lengths.sum::<f64>()
    });
    let cut = lengths.sum::<f64>();
    let facts = Entries::default().fact("cut_length_m", "length of all cuts", cut);
    let mut said = format!("All cuts together are {cut:.2} m long.");
    if made.sheets.is_empty() {
        return (facts, said);
    }
    let size = made.making.sheet();
    let area = size[0] * size[1] * made.sheets.len() as f64;
    let mut kinds: Vec<(f64, usize)> = Vec::new();
    for sheet in &made.sheets {
        match kinds.last_mut() {
            Some(kind) if kind.0 == sheet.thickness => kind.1 += 1,
            _ => kinds.push((sheet.thickness, 1)),
        }
    }
    let kind = |&(thick, count): &(f64, usize)| {
        let [wide, high, thick] = [size[0], size[1], thick].map(plain);
        format!("{count} of {wide} x {high} x {thick} mm")
    };
    let kinds: Vec<String> = kinds.iter().map(kind).collect();
    said += &format!(
        " Sheets of material: {}, {area:.2} m2 in all.",
        kinds.join(", ")
    );
    let facts = facts
        .fact("sheets", "sheets of material", made.sheets.len())
        .fact("sheet_area_m2", "area of all sheets", area);
    (facts, said)
}

/// The places of all parts on sheets, if there are any.
// One line a column.
#[rustfmt::skip]
fn nested(made: &Made) -> Option<Table> {
    let all = (1..).zip(&made.sheets).flat_map(|(number, sheet)| sheet.parts.iter().map(move |part| (number, sheet, part)));
    let all: Vec<(usize, &Sheet, &Placed)> = all.collect();
    let table = rows(all)
        .column("sheet", "sheet", "nested-1 and so on", |it| it.0)
        .column("thickness_m", "material", "", |it| it.1.thickness)
        .column("tile", "tile", "", |it| NAMES[it.2.tile])
        .column("number", "number", "as engraved", |it| it.2.number)
        .column("layer", "layer", "1 is the lowest", |it| it.2.layer.map(|layer| layer + 1))
        .column("x_m", "x", "lower left corner of the part", |it| it.2.corner[0])
        .column("y_m", "y", "", |it| it.2.corner[1])
        .column("turned", "turned", "by a quarter turn", |it| if it.2.turned { "yes" } else { "no" })
        .table("nested")
        .in_file("nested")
        .titled("Parts on sheets", "");
    (!made.sheets.is_empty()).then_some(table)
}

/// All drawings.
fn drawings(design: &Design, made: &Made) -> Files {
    let mut files = Files::new();
    let mut add = |name: String, plan: &Plan, frame| {
        files.insert(format!("{name}.dxf"), plan.dxf().into_bytes());
        files.insert(format!("{name}.svg"), plan.svg(frame).into_bytes());
    };
    for (name, tile) in NAMES.into_iter().zip(&made.tiles) {
        add(name.to_owned(), &Plan::new(&tile.part, "", true), None);
        for (k, layer) in tile.stack.iter().flat_map(|stack| (1..).zip(&stack.layers)) {
            add(
                format!("{name}-layer-{k}"),
                &Plan::new(&tile.part, "", layer.1),
                None,
            );
        }
    }
    for (k, sheet) in (1..).zip(&made.sheets) {
        let mut plan = Plan::default();
        for part in &sheet.parts {
            let tile = &made.tiles[part.tile];
            let stack = tile.stack.as_ref().zip(part.layer);
            let with_pockets = stack.is_none_or(|(stack, layer)| stack.layers[layer].1);
            let drawn = Plan::new(&tile.part, &part.number.to_string(), with_pockets);
            plan.append(drawn.placed(part.corner, part.turned));
        }
        add(
            format!("nested-{k}"),
            &plan,
            Some([[0.0; 2], made.making.sheet()]),
        );
    }
    if let [Some(fixed), Some(moving)] = [0, 1].map(|k| made.tiles[k].stack.as_ref()) {
        let magnets = [&design.pair.fixed, &design.pair.moving].map(stacked::thickest);
        let drawing = stacked::draw([fixed, moving], magnets);
        files.insert("glue-up.svg".to_owned(), drawing.into_bytes());
    }
    files.insert("check.svg".to_owned(), check(made).into_bytes());
    files
}

/// A page to print at full size, on which the glued tiles are laid.
fn check(made: &Made) -> String {
    let mut page = Plan::default();
    let mut left = 0.0;
    for (name, tile) in NAMES.into_iter().zip(&made.tiles) {
        let plan = Plan::check(&tile.part).placed([left, 0.0], false);
        let [low, high] = plan.extent();
        page.append(plan);
        page.text(name, [(low[0] + high[0]) / 2.0, -1.5 * TEXT], TEXT);
        left = high[0] + GAP;
    }
    let [low, high] = page.extent();
    page.svg(Some([
        [low[0] - GAP, low[1] - 2.0 * GAP],
        high.map(|x| x + GAP),
    ]))
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
    let open = |pocket: &Pocket| {
        let open = pocket.is_open().then_some(if pocket.is_notch { "notch" } else { "open" });
        let words: Vec<&str> = open.into_iter().chain((pocket.crowded() > 0.0).then_some("close")).collect();
        if words.is_empty() { String::new() } else { format!(" ({})", words.join(", ")) }
    };
    let told = move |it: &(usize, &Filled)| format!("{}{}", pocket(it).name, open(&pocket(it)));
    let depths = tile.part.pockets.iter().map(|pocket| plain(pocket.depth));
    let mut depths: Vec<String> = depths.collect();
    depths.sort();
    depths.dedup();
    let part = &tile.part;
    let has = |is: fn(&Pocket) -> bool| part.pockets.iter().any(is);
    let raise = match part.deeper {
        Some(more) => format!("or raise `inset` by {} mm for a wall", plain(more)),
        None => "or give the magnets more room: no `inset` leaves a wall for all of them".to_owned(),
    };
    let notched = if has(|it| it.is_open() && it.is_notch) { format!(
        "; pockets marked notch would leave a wall below 0.5 mm: they are cut as notches of the \
         outline, so glue their magnets in from the side, {raise}",
    ) } else { String::new() };
    let open = if has(|it| it.is_open() && !it.is_notch) { format!(
        "; pockets marked open reach the rim where they cannot be a notch: {}", raise.replacen("or ", "", 1),
    ) } else { String::new() };
    let most = part.pockets.iter().map(Pocket::crowded).fold(0.0, f64::max);
    let close = if most > 0.0 { format!(
        "; pockets marked close overlap or leave a wall below 0.5 mm between them: space the \
         magnets out by {} mm (`pitch`, `at`; on two faces: away from their corner), or use a \
         smaller --clearance", plain((most * 1e4 - 1e-6).ceil() / 1e4),
    ) } else { String::new() };
    let unmarked = part.marks.pockets.iter().filter(|mark| mark.is_none()).count();
    let unmarked = match unmarked {
        0 => String::new(),
        many => format!("; {many} of its pockets have no room for an engraved mark"),
    };
    rows((1..).zip(&tile.steps))
        .column("tile", "", "", move |_| name).in_csv()
        .column("step", "step", "", |(step, _)| *step)
        .column("pocket", "pocket", "its face, and the magnet's number on it, counter-clockwise", move |it| pocket(it).name).viewed(told)
        .column("pole", "pole", "N or S out of the face; U north up, D south up", move |it| pocket(it).pole.letter().to_string())
        .column("push_N", "during insertion", "largest repulsion", |(_, it)| it.push).viewed(|(_, it)| advice(it))
        .column("meets", "faces in the bond", "the pocket of the other tile, which this one repels if one magnet of the two is the wrong way round", |(_, it)| it.meets.clone().unwrap_or_default())
        .column("wall_m", "", "", move |it| pocket(it).wall)
        .column("between_m", "", "", move |it| pocket(it).between)
        .column("depth_m", "", "", move |it| pocket(it).depth)
        .table(name)
        .in_file("order")
        .titled(
            format!("The {name} tile"),
            format!("{}{notched}{open}{close}{unmarked}", thickness(tile, &depths)),
        )
}

/// How the magnets lie in the thickness of a tile.
fn thickness(tile: &MadeTile, depths: &[String]) -> String {
    let thick = plain(tile.part.thickness);
    let Some(stack) = &tile.stack else {
        return format!(
            "{thick} mm thick; pockets {} mm deep hold the magnets at mid-thickness (a laser cuts \
             them from layers: --layers): insert them from above, in this order",
            depths.join(" or ")
        );
    };
    let layers = (1..).zip(&stack.layers).map(|(k, &(thick, is_cut))| {
        let what = if is_cut {
            "pockets are cut through"
        } else {
            "lid without pockets"
        };
        format!("layer {k}, {} mm: {what}", plain(thick))
    });
    let layers: Vec<String> = layers.collect();
    let play = match stack.play > 1e-6 {
        true => format!(
            "; pockets are {} mm higher than the thickest magnets: fill that evenly above and below",
            plain(stack.play)
        ),
        false => String::new(),
    };
    let raised = match stack.raised.abs() > 1e-6 {
        true => format!(
            "; their middle is {} mm {} the tile's: glue both tiles the same way up",
            plain(stack.raised.abs()),
            if stack.raised > 0.0 { "above" } else { "below" }
        ),
        false => String::new(),
    };
    format!(
        "{thick} mm thick, of layers from the lowest: {}{play}{raised}; glue the layers below the \
         magnets, insert these in this order, and glue the rest on top (glue-up.svg)",
        layers.join(", ")
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
