//! Workshop files: the sheet, and the drawings for the cutter.
//!
//! `plan` draws the parts, `check` the pages on which glued tiles are laid, and `stacked` the glue-up
//! of layers.

mod check;
mod plan;
mod stacked;

use std::collections::BTreeMap;

use serde_json::json;

use crate::document::{Document, Drawing, Entries, Entry, Table, entries, rows};
use crate::files::{Files, PAGE, REPORT};
use crate::plots::glance;
use crate::tiles::{grams, weights};
use jobs::design::Design;
use jobs::inspection::Inspection;
use jobs::output::Command;
use jobs::workshop::{Filled, Made, MadeTile, Placed, Pocket, Sheet, Subject, grade};
use physics::tile::Magnet;
use physics::tile::magnet::Shape;
use physics::units::{change_with, counted};
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
        "tile.dxf",
        "tile.svg",
        "fixed-layer-#.dxf",
        "fixed-layer-#.svg",
        "moving-layer-#.dxf",
        "moving-layer-#.svg",
        "tile-layer-#.dxf",
        "tile-layer-#.svg",
        "tiles/*.dxf",
        "tiles/*.svg",
        "glue-up.svg",
        "nested-#.dxf",
        "nested-#.svg",
        "nested.csv",
        "check.svg",
        "check-#.svg",
        "sheet.md",
    ],
    pictures: &["tiles"],
};

/// The names of the tiles of a single design, whose files are not in a folder.
const NAMES: [&str; 3] = ["fixed", "moving", "tile"];
/// Largest number of kinds of tiles that are listed on a terminal.
const LISTED: usize = 4;

/// The document of the workshop files of a design, or of several kinds of tiles; its text is the
/// sheet.
pub fn document<'a>(design: Option<&'a Design>, subject: &'a Subject, made: &Made) -> Document<'a> {
    let making = &made.making;
    let tiles: usize = made.tiles.iter().map(|tile| tile.copies).sum();
    let count = counted(made.magnets.iter().map(|(_, count)| count).sum(), "magnet");
    let tiles = match &made.tiles[..] {
        [one] => format!("{} equal tiles", one.copies),
        [fixed, moving] if design.is_some() => match (fixed.copies, moving.copies) {
            (1, 1) => "Two tiles".to_owned(),
            (fixed, moving) => format!("{fixed} fixed and {moving} moving tiles"),
        },
        kinds => format!("{tiles} tiles of {} kinds", kinds.len()),
    };
    let (facts, said) = shopping(made);
    let weights = design.map_or_else(Vec::new, weights);
    let pages = check::pages(made);
    let opened = match design {
        Some(design) => entries(design),
        None => Entries::default()
            .data("tilebind", env!("CARGO_PKG_VERSION"))
            .data("name", &made.name[..]),
    };
    let picture = Drawing::new("Outward pole of each magnet", move |sheet| match design {
        Some(design) => glance::draw(design, &Inspection::new(design), sheet),
        None => glance::kinds(subject, sheet),
    });
    let mut document = Document {
        title: format!("{}: to be made", made.name),
        answer: format!(
            "{tiles} with {count}, to scale in mm, as `.dxf` and `.svg`. Layers, in the order of \
             work: ENGRAVE, CUT_INSIDE, CUT_OUTSIDE. Lines are the cutter's centre line: they \
             include a kerf of {} mm. Pockets are {} mm larger than their magnets on every side. \
             Tiles are seen from above. Pockets are counted counter-clockwise along each face. N \
             is a north pole that points out of the face; U is a north pole up. The arrow on a \
             tile points towards its face {}.",
            plain(making.kerf),
            plain(making.clearance),
            made.tiles.first().map_or("", |tile| &tile.first_face)
        ),
        entries: opened
            .data("settings", settings(made))
            .and(facts)
            .table(magnets(&made.magnets))
            .more(sheets(made).into_iter().flatten().map(Entry::Table))
            .more(made.tiles.iter().map(|tile| {
                let steps = steps(made, tile);
                Entry::Table(if made.tiles.len() > LISTED {
                    steps.on_page()
                } else {
                    steps
                })
            })),
        pictures: vec![picture],
        notes: [weights, vec![said, how_to_check(pages.len())]].concat(),
        origin: "magnets in the order with the least repulsion".to_owned(),
        ..Document::default()
    };
    let sheet = document.markdown();
    document.beside = drawings(made, pages);
    document
        .beside
        .insert("sheet.md".to_owned(), sheet.into_bytes());
    document
}

/// How to check the tiles after gluing.
fn how_to_check(pages: usize) -> String {
    let name = match pages {
        1 => "check.svg".to_owned(),
        2 => "check-1.svg and check-2.svg".to_owned(),
        many => format!("check-1.svg to check-{many}.svg"),
    };
    let paper = check::PAPER.map(|length| 1e3 * length);
    format!(
        "To check the glued tiles, print {name} at full size (100 %, {} x {} mm; the bar is 100 mm \
         long), lay each tile on it, and compare every pole with a marked magnet. Then hold two \
         faces together: a pocket that repels the one it faces holds a magnet the wrong way round.",
        paper[0], paper[1]
    )
}

fn settings(made: &Made) -> serde_json::Value {
    let making = &made.making;
    json!({
        "kerf_m": making.kerf,
        "clearance_m": making.clearance,
        "copies": made.tiles.iter().map(|tile| tile.copies).collect::<Vec<_>>(),
        "sheet_m": making.sheet(),
        "spacing_m": making.spacing,
        "layers_m": making.layers.as_ref().map(|layers| &layers.0),
    })
}

/// What to buy besides magnets, as figures and as a sentence.
fn shopping(made: &Made) -> (Entries, String) {
    let lengths = made.tiles.iter().map(|tile| {
        let stack = tile.stack.as_ref();
        let layers = stack.map_or(vec![true], |stack| {
            stack.layers.iter().map(|it| it.1).collect()
        });
        let lengths = layers
            .into_iter()
            .map(|is_cut| tile.part.cut_length(is_cut));
        tile.copies as f64 * lengths.sum::<f64>()
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

/// The sheets for people, and the places of all parts on them for programs, if there are any.
// One line a column.
#[rustfmt::skip]
fn sheets(made: &Made) -> Option<[Table; 2]> {
    let name = |part: &Placed| made.tiles[part.tile].name.clone();
    let all = (1..).zip(&made.sheets).flat_map(|(number, sheet)| sheet.parts.iter().map(move |part| (number, sheet, part)));
    let all: Vec<(usize, &Sheet, &Placed)> = all.collect();
    let nested = rows(all)
        .column("sheet", "sheet", "nested-1 and so on", |it| it.0)
        .column("thickness_m", "material", "", |it| it.1.thickness)
        .column("tile", "tile", "", |it| name(it.2))
        .column("number", "number", "as engraved", |it| it.2.number)
        .column("layer", "layer", "1 is the lowest", |it| it.2.layer.map(|layer| layer + 1))
        .column("x_m", "x", "lower left corner of the part", |it| it.2.corner[0])
        .column("y_m", "y", "", |it| it.2.corner[1])
        .column("turned", "turned", "by a quarter turn", |it| if it.2.turned { "yes" } else { "no" })
        .table("nested")
        .in_file("nested")
        .in_data();
    let sheets = rows((1..).zip(&made.sheets))
        .shown("sheet", "", |it: &(usize, &Sheet)| format!("nested-{}", it.0))
        .shown("material (mm)", "its thickness", |it| plain(it.1.thickness))
        .shown("parts", "with their numbers as engraved; layer 1 is the lowest", |it| parts(made, it.1))
        .table("")
        .titled("Parts on sheets", "places in nested.csv");
    let sheets = Table { is_data: false, ..sheets };
    (!made.sheets.is_empty()).then_some([sheets, nested])
}

/// The parts on a sheet: `fixed 1 to 6 (layers 1, 2), moving 1`.
fn parts(made: &Made, sheet: &Sheet) -> String {
    // Numbers are engraved only where there are several copies.
    let is_single = made.tiles.iter().all(|tile| tile.copies <= 1);
    // Tile, layers and numbers.
    let mut groups: Vec<(usize, Vec<usize>, Vec<usize>)> = Vec::new();
    let mut by_copy: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for part in &sheet.parts {
        let layers = by_copy.entry((part.tile, part.number)).or_default();
        layers.extend(part.layer.map(|layer| layer + 1));
        layers.sort_unstable();
    }
    for ((tile, number), layers) in by_copy {
        match groups.last_mut() {
            Some(last) if last.0 == tile && last.1 == layers && last.2.ends_with(&[number - 1]) => {
                last.2.push(number);
            }
            _ => groups.push((tile, layers, vec![number])),
        }
    }
    let group = |(tile, layers, numbers): &(usize, Vec<usize>, Vec<usize>)| {
        let name = &made.tiles[*tile].name;
        let numbers = match (numbers.first(), numbers.last()) {
            _ if is_single => String::new(),
            (Some(first), Some(last)) if first < last => format!(" {first} to {last}"),
            (first, _) => first.map_or(String::new(), |number| format!(" {number}")),
        };
        let layer: Vec<String> = layers.iter().map(ToString::to_string).collect();
        let layers = match layer.len() {
            0 => String::new(),
            1 => format!(" (layer {})", layer[0]),
            _ => format!(" (layers {})", layer.join(", ")),
        };
        format!("{name}{numbers}{layers}")
    };
    groups.iter().map(group).collect::<Vec<_>>().join(", ")
}

/// The files of a kind of tile are named like this.
fn stem(name: &str) -> String {
    match NAMES.contains(&name) {
        true => name.to_owned(),
        false => format!("tiles/{name}"),
    }
}

/// All drawings.
fn drawings(made: &Made, pages: Vec<String>) -> Files {
    let mut files = Files::new();
    let mut add = |name: String, plan: &Plan, frame| {
        files.insert(format!("{name}.dxf"), plan.dxf().into_bytes());
        files.insert(format!("{name}.svg"), plan.svg(frame).into_bytes());
    };
    for tile in &made.tiles {
        let name = stem(&tile.name);
        for (k, layer) in tile.stack.iter().flat_map(|stack| (1..).zip(&stack.layers)) {
            let layered = Plan::new(&tile.part, "", layer.1);
            add(format!("{name}-layer-{k}"), &layered, None);
        }
        add(name, &Plan::new(&tile.part, "", true), None);
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
    let stacks = made.tiles.iter();
    let stacks: Vec<_> = stacks
        .filter_map(|tile| Some((&tile.name[..], tile.stack.as_ref()?)))
        .collect();
    if !stacks.is_empty() {
        files.insert(
            "glue-up.svg".to_owned(),
            stacked::draw(&stacks).into_bytes(),
        );
    }
    let is_one = pages.len() == 1;
    files.extend((1..).zip(pages).map(|(number, page)| {
        let name = match is_one {
            true => "check.svg".to_owned(),
            false => format!("check-{number}.svg"),
        };
        (name, page.into_bytes())
    }));
    files
}

/// The magnets to buy.
// One line a column.
#[rustfmt::skip]
fn magnets(magnets: &[(Magnet, usize)]) -> Table {
    let describe = |magnet: &Magnet| {
        let size = magnet.axis_first().map(plain);
        match magnet.form.shape {
            Shape::Block => format!("{}, magnetised along the first", size.join(" x ")),
            Shape::Disc => format!("discs, {} across and {} high", size[1], size[0]),
        }
    };
    rows(magnets)
        .column("number", "number", "", |(_, count)| *count)
        .column("size_m", "size (mm)", "along the moment first", |(magnet, _)| json!(magnet.axis_first())).without_csv()
            .viewed(move |(magnet, _)| describe(magnet))
        .data("length_m", |(magnet, _)| magnet.axis_first()[0]).in_csv()
        .data("width_m", |(magnet, _)| magnet.axis_first()[1]).in_csv()
        .data("height_m", |(magnet, _)| magnet.axis_first()[2]).in_csv()
        .column("remanence_T", "remanence", "", |(magnet, _)| magnet.remanence())
        .column("nearest", "closest standard grade", "", |(magnet, _)| nearest(magnet.remanence()))
        .table("magnets")
        .in_file("magnets")
        .titled("Magnets", "")
}

fn nearest(remanence: f64) -> String {
    match grade::nearest(remanence) {
        Some((grade, own)) => format!(
            "{grade} ({own} T: forces {})",
            change_with((own / remanence).powi(2) - 1.0, 0)
        ),
        None if remanence < grade::sold()[0].remanence[1] => "weaker than N35 (1.19 T)".to_owned(),
        None => "none: stronger than N52 (1.46 T)".to_owned(),
    }
}

/// The magnets of a tile in the order of insertion.
// One line a column.
#[rustfmt::skip]
fn steps(made: &Made, tile: &MadeTile) -> Table {
    let name = tile.name.clone();
    let pocket = |it: &(usize, &Filled)| tile.part.pockets[it.1.pocket].clone();
    let open = |pocket: &Pocket| {
        let open = pocket.is_open().then_some(if pocket.is_notch { "notch" } else { "open" });
        let fragile = pocket.sliver.map(|_| "fragile");
        let words: Vec<&str> = open.into_iter().chain(fragile).chain((pocket.crowded() != [0.0; 2]).then_some("close")).collect();
        if words.is_empty() { String::new() } else { format!(" ({})", words.join(", ")) }
    };
    let describe = move |it: &(usize, &Filled)| format!("{}{}", pocket(it).name, open(&pocket(it)));
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
    let thinnest = part.pockets.iter().filter_map(|pocket| pocket.sliver).reduce(f64::min);
    let fragile = thinnest.map_or(String::new(), |wide| format!(
        "; beside pockets marked fragile a piece only {} mm wide is longer than wide and may break off",
        plain(wide.max(0.0)),
    ));
    let most = [0, 1].map(|k| part.pockets.iter().map(|it| it.crowded()[k]).fold(0.0, f64::max));
    let tenths = |more: f64| plain((more * 1e4 - 1e-6).ceil() / 1e4);
    let apart = match most {
        [0.0, 0.0] => None,
        [0.0, corner] => Some(format!("move the magnets beside a corner {} mm away from it (a \
            smaller `pitch`, or `at`)", tenths(corner))),
        [face, 0.0] => Some(format!("space the magnets of a face out by {} mm (a larger `pitch`, or \
            `at`)", tenths(face))),
        [face, corner] => Some(format!("space the magnets of a face out by {} mm and move those \
            beside a corner {} mm away from it (`at`), or use smaller magnets or a larger tile",
            tenths(face), tenths(corner))),
    };
    let close = apart.map_or(String::new(), |apart| format!(
        "; pockets marked close overlap or leave a wall below 0.5 mm between them: {apart}, or use \
         a smaller --clearance",
    ));
    // Names of tiles are needed only if there are several others.
    let met = |(tile, pocket): &(usize, String)| match made.tiles.len() {
        0..=2 => pocket.clone(),
        _ => format!("{} {pocket}", made.tiles[*tile].name),
    };
    let meets = |it: &Filled| it.meets.iter().map(met).collect::<Vec<_>>().join(", ");
    let unmarked = part.marks.pockets.iter().filter(|mark| mark.is_none()).count();
    let unmarked = match unmarked {
        0 => String::new(),
        1 => "; 1 of its pockets has no room for an engraved mark".to_owned(),
        many => format!("; {many} of its pockets have no room for an engraved mark"),
    };
    rows((1..).zip(&tile.steps))
        .data("tile", |_| name.clone()).in_csv()
        .column("step", "step", "", |(step, _)| *step)
        .column("pocket", "pocket", "its face, and the magnet's number on it, counter-clockwise", move |it| pocket(it).name).viewed(describe)
        .column("pole", "pole", "N or S out of the face; U north up, D south up", move |it| pocket(it).pole.letter().to_string())
        .column("push_N", "during insertion", "largest repulsion", |(_, it)| it.push).viewed(|(_, it)| advice(it))
        .column("meets", "faces in the bond", "the pocket of the other tile, which this one repels if one magnet of the two is the wrong way round", |(_, it)| meets(it))
        .column("left_if_wrong", "bond if wrong", "share of the bond that is left if this magnet is the wrong way round", |(_, it)| it.left_if_wrong).viewed(|(_, it)| it.left_if_wrong.map_or(String::new(), left))
        .data("wall_m", move |it| pocket(it).wall)
        .data("between_m", move |it| pocket(it).between())
        .data("depth_m", move |it| pocket(it).depth)
        .table(name.clone())
        .in_file("order")
        .titled(
            match &*name {
                "tile" => "Each tile".to_owned(),
                "fixed" | "moving" => format!("The {name} tile"),
                name => format!("Tile {name}"),
            },
            format!("{}{notched}{open}{fragile}{close}{unmarked}", thickness(tile, &depths)),
        )
}

/// What is left of a bond, for people.
fn left(share: f64) -> String {
    match (100.0 * share).round() {
        percent if percent > 0.0 => format!("{percent} % left"),
        percent if percent < 0.0 => "repels".to_owned(),
        _ => "none left".to_owned(),
    }
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
