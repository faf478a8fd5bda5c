//! Tile sets as rgrow reads them: YAML, of which JSON is a part.
//!
//! Keys are those of rgrow 0.23 (`tiles` with `name`, `edges` clockwise from the north, `stoic`,
//! `color`; `bonds`; `glues`; `seed` as row, column, tile; `size`, `tau`, `Gse`, `Gmc`), with
//! `options`, `params` or `xgrowargs` for a part of them. A glue that no bond names has strength 1;
//! the glue 0 is none. Keys that only steer the engine are passed over, and noted; any other key, and a
//! canvas that no table is, are faults.

use std::fmt::Write;

use serde::Deserialize;
use serde_yaml_ng::Value;

use super::{TileSet, TileType, fault};
use crate::design::{DesignError, Place, nearest_help};

#[derive(Clone, Deserialize)]
#[serde(untagged)]
enum Ident {
    Number(usize),
    Name(String),
}

impl Ident {
    fn text(&self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Name(name) => name.clone(),
        }
    }
}

#[derive(Deserialize)]
struct TileEntry {
    name: Option<Ident>,
    edges: Vec<Ident>,
    stoic: Option<f64>,
    color: Option<String>,
    shape: Option<String>,
}

#[derive(Deserialize)]
struct BondEntry {
    name: Ident,
    strength: f64,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum SeedEntry {
    One(usize, usize, Ident),
    Many(Vec<(usize, usize, Ident)>),
}

#[derive(Deserialize)]
#[serde(untagged)]
enum SizeEntry {
    Square(usize),
    Both([usize; 2]),
}

#[derive(Deserialize)]
struct Entries {
    #[serde(default)]
    tiles: Vec<TileEntry>,
    #[serde(default)]
    bonds: Vec<BondEntry>,
    #[serde(default)]
    glues: Vec<(Ident, Ident, f64)>,
    seed: Option<SeedEntry>,
    size: Option<SizeEntry>,
    #[serde(alias = "threshold")]
    tau: Option<f64>,
    #[serde(alias = "Gse")]
    gse: Option<f64>,
    #[serde(alias = "Gmc")]
    gmc: Option<f64>,
    #[serde(alias = "doubletiles")]
    hdoubletiles: Option<Value>,
    vdoubletiles: Option<Value>,
    #[serde(alias = "xgrowargs", alias = "params")]
    options: Option<Box<Entries>>,
}

const DOUBLE: &str = "write the two halves as tiles that share a strong glue";

/// Reads a set; its name is left empty.
///
/// # Errors
/// Where the text is no such set.
pub fn read(text: &str, file: &str) -> Result<TileSet, DesignError> {
    let wrong = |error: serde_yaml_ng::Error| {
        let at = error.location().map(|it| it.index()..it.index() + 1);
        let place = at.map(|at| Place::of(text, at));
        let message = format!("it is no tile set: {error}");
        let help = "write tiles: [{name: a, edges: [north, east, south, west]}], as rgrow has it, or \
                    a .tiles file of xgrow";
        DesignError::new(file, place, message, help)
    };
    let mut entries: Entries = serde_yaml_ng::from_str(text).map_err(wrong)?;
    let value: Value = serde_yaml_ng::from_str(text).map_err(wrong)?;
    if let Some(more) = entries.options.take() {
        entries.tiles.extend(more.tiles);
        entries.bonds.extend(more.bonds);
        entries.glues.extend(more.glues);
        entries.seed = more.seed.or(entries.seed);
        entries.size = more.size.or(entries.size);
        entries.tau = more.tau.or(entries.tau);
        entries.gse = more.gse.or(entries.gse);
        entries.gmc = more.gmc.or(entries.gmc);
        entries.hdoubletiles = more.hdoubletiles.or(entries.hdoubletiles);
        entries.vdoubletiles = more.vdoubletiles.or(entries.vdoubletiles);
    }
    let some = |tiles: &Option<Value>| {
        let none =
            |tiles: &Value| tiles.is_null() || tiles.as_sequence().is_some_and(Vec::is_empty);
        tiles.as_ref().is_some_and(|tiles| !none(tiles))
    };
    if some(&entries.hdoubletiles) || some(&entries.vdoubletiles) {
        let message = "it has double tiles, which magnetic squares are not".to_owned();
        return Err(fault(text, file, "doubletiles", message, DOUBLE));
    }
    let passed_over = check(&value, text, file)?;
    let set = made_of(entries, text, file)?;
    Ok(TileSet { passed_over, ..set })
}

/// Keys that are read; those of tiles and of bonds.
const READ: [&str; 15] = [
    "tiles",
    "bonds",
    "glues",
    "seed",
    "size",
    "tau",
    "threshold",
    "gse",
    "Gse",
    "gmc",
    "Gmc",
    "hdoubletiles",
    "doubletiles",
    "vdoubletiles",
    "canvas_type",
];
const MORE: [&str; 3] = ["options", "xgrowargs", "params"];
const OF_TILE: [&str; 5] = ["name", "edges", "stoic", "color", "shape"];
const OF_BOND: [&str; 2] = ["name", "strength"];
/// Keys of either engine that only steer it.
const STEERING: [&str; 32] = [
    "alpha",
    "smax",
    "smin",
    "fsmax",
    "tmax",
    "emax",
    "update_rate",
    "kf",
    "k_f",
    "k",
    "fission",
    "block",
    "chunk_handling",
    "chunk_size",
    "chunk_fission",
    "model",
    "start_paused",
    "tracking",
    "rand",
    "window",
    "pause",
    "wander",
    "datafile",
    "arrayfile",
    "tracefile",
    "exportfile",
    "font",
    "movie",
    "min_strength",
    "error_radius",
    "zero_bonds",
    "info",
];

/// What steers the engine only.
///
/// # Errors
/// Where there are keys that say nothing, or a canvas that is no table.
fn check(value: &Value, text: &str, file: &str) -> Result<Vec<String>, DesignError> {
    let mut steering = Vec::new();
    let name = |key: &Value| match key {
        Value::String(name) => name.clone(),
        other => format!("{other:?}"),
    };
    let known = |map: &serde_yaml_ng::Mapping, known: &[&str]| -> Result<(), DesignError> {
        let unknown = map.keys().map(name).find(|key| !known.contains(&&key[..]));
        let Some(key) = unknown else { return Ok(()) };
        let message = format!("nothing is known of the key `{key}`");
        Err(fault(text, file, &key, message, &nearest_help(&key, known)))
    };
    let Some(whole) = value.as_mapping() else {
        return Ok(steering);
    };
    let parts = MORE.iter().filter_map(|key| whole.get(*key)?.as_mapping());
    for (map, more) in [(whole, &MORE[..])]
        .into_iter()
        .chain(parts.map(|map| (map, &[][..])))
    {
        known(map, &[&READ[..], more, &STEERING].concat())?;
        for (entries, keys) in [("tiles", &OF_TILE[..]), ("bonds", &OF_BOND)] {
            let entries = map.get(entries).and_then(Value::as_sequence);
            for entry in entries.into_iter().flatten().filter_map(Value::as_mapping) {
                known(entry, keys)?;
            }
        }
        let canvas = map.get("canvas_type").and_then(Value::as_str);
        if let Some(canvas) = canvas.filter(|it| !it.to_lowercase().starts_with("square")) {
            let message = format!("its canvas is `{canvas}`, and a table is flat and has edges");
            let help = "take canvas_type away, or write square; a seed and a size that fit in the \
                        plane go with it";
            return Err(fault(text, file, "canvas_type", message, help));
        }
        let model = map.get("model").and_then(Value::as_str);
        if let Some(model) = model.filter(|it| !it.to_lowercase().ends_with("tam")) {
            let message = format!("its model `{model}` is not that of square tiles with glues");
            return Err(fault(text, file, "model", message, "write model: kTAM"));
        }
        let own = |key: &String, value: &Value| key == "fission" && value == "keep-seeded";
        let passed = map.iter().map(|(key, value)| (name(key), value));
        let passed = passed.filter(|(key, value)| STEERING.contains(&&key[..]) && !own(key, value));
        steering.extend(passed.map(|it| it.0));
    }
    Ok(steering)
}

fn made_of(entries: Entries, text: &str, file: &str) -> Result<TileSet, DesignError> {
    let mut set = TileSet {
        size: entries.size.map(|size| match size {
            SizeEntry::Square(n) => [n, n],
            SizeEntry::Both(both) => both,
        }),
        tau: entries.tau,
        gse: entries.gse,
        gmc: entries.gmc,
        ..TileSet::default()
    };
    for bond in &entries.bonds {
        let name = bond.name.text();
        if set.glues.iter().any(|glue| glue.name == name) {
            let message = format!("the bond `{name}` is there twice");
            return Err(fault(text, file, &name, message, "take one away"));
        }
        set.glue(&name, bond.strength);
    }
    for (i, tile) in entries.tiles.iter().enumerate() {
        let name = tile.name.as_ref().map_or((i + 1).to_string(), Ident::text);
        let single = tile
            .shape
            .as_deref()
            .is_none_or(|it| ["single", "Single", "s", "S"].contains(&it));
        if !single {
            let message = format!("the tile `{name}` is no single square");
            return Err(fault(text, file, &name, message, DOUBLE));
        }
        let &[n, e, s, w] = &tile.edges.iter().collect::<Vec<_>>()[..] else {
            let message = format!("the tile `{name}` has {} edges", tile.edges.len());
            let help = "a tile has four: north, east, south, west";
            return Err(fault(text, file, &name, message, help));
        };
        let glues = [n, e, s, w].map(|edge| {
            let name = edge.text();
            (name != "0").then(|| set.glue(&name, 1.0))
        });
        set.tiles.push(TileType {
            name,
            glues,
            stoic: tile.stoic.unwrap_or(1.0),
            color: tile.color.clone(),
        });
    }
    for (a, b, strength) in &entries.glues {
        let place = |ident: &Ident| {
            let name = ident.text();
            let known = set.glues.iter().position(|glue| glue.name == name);
            known.ok_or_else(|| {
                let message = format!("no tile and no bond has the glue `{name}`");
                let help = "name glues of tiles, or list it under bonds";
                fault(text, file, "glues", message, help)
            })
        };
        let (a, b) = (place(a)?, place(b)?);
        match a == b {
            true => set.glues[a].strength = *strength,
            false => set.links.push((a, b, *strength)),
        }
    }
    let seeds = match entries.seed {
        None => Vec::new(),
        Some(SeedEntry::One(row, column, tile)) => vec![(row, column, tile)],
        Some(SeedEntry::Many(many)) => many,
    };
    for (row, column, tile) in seeds {
        let by_name = |name: &String| set.tiles.iter().position(|tile| tile.name == *name);
        let tile = match &tile {
            Ident::Number(number) => number.checked_sub(1),
            Ident::Name(name) => by_name(name),
        };
        set.seed.push((row, column, tile.unwrap_or(usize::MAX)));
    }
    Ok(set)
}

/// The text of a set, with `remarks` as comments above it.
pub fn write(set: &TileSet, remarks: &[String]) -> String {
    let mut text = String::new();
    for line in remarks {
        let _ = writeln!(text, "# {line}");
    }
    let quoted = |name: &str| serde_json::Value::from(name).to_string();
    let glue = |glue: Option<usize>| glue.map_or("0".to_owned(), |at| quoted(&set.glues[at].name));
    text += "tiles:\n";
    for tile in &set.tiles {
        let edges = tile.glues.map(glue).join(", ");
        let _ = write!(text, "- {{name: {}, edges: [{edges}]", quoted(&tile.name));
        if tile.stoic != 1.0 {
            let _ = write!(text, ", stoic: {:?}", tile.stoic);
        }
        if let Some(color) = &tile.color {
            let _ = write!(text, ", color: {}", quoted(color));
        }
        text += "}\n";
    }
    text += "bonds:\n";
    for glue in &set.glues {
        let name = quoted(&glue.name);
        let _ = writeln!(text, "- {{name: {name}, strength: {:?}}}", glue.strength);
    }
    if !set.links.is_empty() {
        text += "glues:\n";
    }
    for (a, b, strength) in &set.links {
        let [a, b] = [a, b].map(|at| quoted(&set.glues[*at].name));
        let _ = writeln!(text, "- [{a}, {b}, {strength:?}]");
    }
    // Of pieces that part from each other that with the seed stays. The engines' other way, never to
    // let a tile go on which others hang, stands still where that tile is not held.
    text += "fission: keep-seeded\n";
    let numbers = [("Gse", set.gse), ("Gmc", set.gmc), ("tau", set.tau)];
    for (key, value) in numbers {
        if let Some(value) = value {
            let _ = writeln!(text, "{key}: {value:?}");
        }
    }
    if let Some([rows, columns]) = set.size {
        let _ = writeln!(text, "size: [{rows}, {columns}]");
    }
    let seed = |(row, column, tile): &(usize, usize, usize)| {
        format!("[{row}, {column}, {}]", quoted(&set.tiles[*tile].name))
    };
    match &set.seed[..] {
        [] => {}
        [one] => text += &format!("seed: {}\n", seed(one)),
        many => {
            let many: Vec<String> = many.iter().map(seed).collect();
            text += &format!("seed: [{}]\n", many.join(", "));
        }
    }
    text
}
