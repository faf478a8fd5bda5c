//! Tile sets in rgrow's format: YAML, of which JSON is a part.
//!
//! Keys are those of rgrow 0.23 (`tiles` with `name`, `edges` clockwise from the north, `stoic`,
//! `color`; `bonds`; `glues`; `seed` as row, column, tile; `size`, `tau`, `Gse`, `Gmc`), with
//! `options`, `params` or `xgrowargs` for a part of them. A glue that no bond names has strength 1;
//! the glue 0 means no glue. Keys that only control the engine are ignored with a note; any other
//! key, and a canvas that cannot be a table, are faults.

use std::fmt::Write;
use std::ops::RangeInclusive;

use super::yaml::{FORM, Node, TextSource};
use super::{ENERGIES, MOST, SHARES, STRENGTHS, TileSet, TileType, in_range};
use crate::design::{DesignError, nearest_help};

const HALVES: &str = "write the two halves as tiles that share a strong glue";

/// Reads a set; its name is left empty.
///
/// # Errors
/// If the text is not a valid set.
pub fn read(text: &str, file: &str) -> Result<TileSet, DesignError> {
    let source = TextSource { text, file };
    let mut parts = Parts::default();
    parts.gather(source, &source.tree()?, &MORE)?;
    parts.set(source)
}

/// Keys that are read, keys of nested mappings, and keys of tiles and of bonds.
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
/// Keys of both engines that only control the engine.
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

/// The entries of a file, wherever they occur.
#[derive(Default)]
struct Parts {
    tiles: Vec<Node>,
    bonds: Vec<Node>,
    glues: Vec<Node>,
    seed: Option<Node>,
    size: Option<Node>,
    numbers: [Option<f64>; 3],
    passed_over: Vec<String>,
}

/// Names of the numbers.
const NUMBERS: [[&str; 2]; 3] = [["tau", "threshold"], ["gse", "Gse"], ["gmc", "Gmc"]];

impl Parts {
    /// Collects the entries of a mapping and of those under `more` keys, which take precedence.
    fn gather(
        &mut self,
        source: TextSource,
        node: &Node,
        more: &[&str],
    ) -> Result<(), DesignError> {
        let entries = source.entries(node, "a tile set")?;
        for names in NUMBERS {
            let mut both = entries.iter().filter(|entry| names.contains(&entry.1));
            if let (Some(_), Some((key, ..))) = (both.next(), both.next()) {
                let message = format!("`{}` and `{}` are the same", names[0], names[1]);
                return Err(source.wrong(key, message, "remove one"));
            }
        }
        for (key, name, value) in &entries {
            let number = NUMBERS.iter().position(|names| names.contains(name));
            match *name {
                name if more.contains(&name) => {}
                name if !READ.contains(&name) && !STEERING.contains(&name) => {
                    let known = [&READ[..], more, &STEERING].concat();
                    return Err(unknown(source, key, name, &known));
                }
                _ if value.is_null() => {}
                "tiles" => self.tiles.extend_from_slice(list(source, value)?),
                "bonds" => self.bonds.extend_from_slice(list(source, value)?),
                "glues" => self.glues.extend_from_slice(list(source, value)?),
                "seed" => self.seed = Some((*value).clone()),
                "size" => self.size = Some((*value).clone()),
                "hdoubletiles" | "doubletiles" | "vdoubletiles" => {
                    if !list(source, value)?.is_empty() {
                        let message = "it has double tiles, which square magnetic tiles cannot \
                            represent";
                        return Err(source.wrong(key, message, HALVES));
                    }
                }
                name => match number {
                    Some(at) => self.numbers[at] = Some(within(source, value, name, &ENERGIES)?),
                    None => self.steer(source, name, value)?,
                },
            }
        }
        for (_, name, value) in entries {
            if more.contains(&name) && !value.is_null() {
                self.gather(source, value, &[])?;
            }
        }
        Ok(())
    }

    /// Ignores keys that only control the engine; a canvas that cannot be a table, and a model
    /// without squares, are faults.
    fn steer(&mut self, source: TextSource, name: &str, value: &Node) -> Result<(), DesignError> {
        let text = value.text().unwrap_or_default();
        let low = text.to_lowercase();
        match name {
            "canvas_type" if !low.starts_with("square") => {
                let message = format!("its canvas is `{text}`, but a table is flat and has edges");
                let help = "remove canvas_type, or write square, with a seed and a size that fit \
                    in the plane";
                return Err(source.wrong(value, message, help));
            }
            "canvas_type" => {}
            "model" if !low.ends_with("tam") => {
                let message = format!("its model `{text}` is not for square tiles with glues");
                return Err(source.wrong(value, message, "write model: kTAM"));
            }
            // As in files written by this module.
            "fission" if text == "keep-seeded" => {}
            _ => self.passed_over.push(name.to_owned()),
        }
        Ok(())
    }

    fn set(self, source: TextSource) -> Result<TileSet, DesignError> {
        let [tau, gse, gmc] = self.numbers;
        let mut set = TileSet {
            size: self.size.map(|node| size(source, &node)).transpose()?,
            tau,
            gse,
            gmc,
            passed_over: self.passed_over,
            ..TileSet::default()
        };
        for (list, what) in [(&self.tiles, "tiles"), (&self.bonds, "bonds")] {
            if let Some(node) = list.get(MOST) {
                let message = format!("it has more than {MOST} {what}");
                return Err(source.wrong(node, message, "split the set"));
            }
        }
        for node in &self.bonds {
            bond(source, node, &mut set)?;
        }
        for node in &self.tiles {
            let tile = tile(source, node, &mut set)?;
            set.tiles.push(tile);
        }
        for node in &self.glues {
            link(source, node, &mut set)?;
        }
        if let Some(node) = &self.seed {
            let items = list(source, node)?;
            let is_one = items.first().is_some_and(|first| first.list().is_none());
            let seeds = if is_one {
                std::slice::from_ref(node)
            } else {
                items
            };
            for node in seeds {
                let seed = seed(source, node, &set)?;
                set.seed.push(seed);
            }
        }
        Ok(set)
    }
}

fn unknown(source: TextSource, key: &Node, name: &str, known: &[&str]) -> DesignError {
    let message = format!("unknown key `{name}`");
    source.wrong(key, message, &nearest_help(name, known))
}

fn list<'n>(source: TextSource, node: &'n Node) -> Result<&'n [Node], DesignError> {
    let message = "a list is needed here";
    node.list().ok_or_else(|| source.wrong(node, message, FORM))
}

fn numeral(source: TextSource, node: &Node) -> Result<f64, DesignError> {
    let message = "a finite number is needed here";
    let help = "write it as 1 or 0.5";
    node.number()
        .ok_or_else(|| source.wrong(node, message, help))
}

/// A number in a range; messages call it `what`.
fn within(
    source: TextSource,
    node: &Node,
    what: &str,
    range: &RangeInclusive<f64>,
) -> Result<f64, DesignError> {
    let found = numeral(source, node)?;
    in_range(what, found, range).map_err(|(message, help)| source.wrong(node, message, &help))
}

/// A tile's share: 0, or in its range.
fn share(source: TextSource, node: &Node) -> Result<f64, DesignError> {
    match numeral(source, node)? {
        0.0 => Ok(0.0),
        _ => within(source, node, "stoic", &SHARES),
    }
}

/// A name, or the number of a nameless one.
fn ident(source: TextSource, node: &Node) -> Result<String, DesignError> {
    let number = node.whole().map(|number| number.to_string());
    let is_other = node.number().is_some() || node.is_null();
    let name = || node.text().filter(|_| !is_other).map(str::to_owned);
    let message = "a name, or a whole number of 0 or more, is needed here";
    let help = "put a name that looks like a number in quotes";
    let found = number.or_else(name);
    found.ok_or_else(|| source.wrong(node, message, help))
}

fn size(source: TextSource, node: &Node) -> Result<[usize; 2], DesignError> {
    let square = node.whole().map(|n| [n, n]);
    let both = || match node.list()? {
        [rows, columns] => Some([rows.whole()?, columns.whole()?]),
        _ => None,
    };
    let message = "a size is one whole number, or rows and columns";
    let found = square.or_else(both);
    found.ok_or_else(|| source.wrong(node, message, "write size: [32, 32]"))
}

fn bond(source: TextSource, node: &Node, set: &mut TileSet) -> Result<(), DesignError> {
    let (mut name, mut strength) = (None, None);
    for (key, word, value) in source.entries(node, "a bond")? {
        match word {
            "name" => name = Some(ident(source, value)?),
            "strength" => strength = Some(within(source, value, word, &STRENGTHS)?),
            _ => return Err(unknown(source, key, word, &OF_BOND)),
        }
    }
    let (Some(name), Some(strength)) = (name, strength) else {
        let help = "write {name: a, strength: 1}";
        return Err(source.wrong(node, "a bond has a name and a strength", help));
    };
    if set.glues.iter().any(|glue| glue.name == name) {
        let message = format!("the bond `{name}` is defined twice");
        return Err(source.wrong(node, message, "remove one"));
    }
    set.glue(&name, strength);
    Ok(())
}

fn tile(source: TextSource, node: &Node, set: &mut TileSet) -> Result<TileType, DesignError> {
    let mut tile = TileType::new((set.tiles.len() + 1).to_string(), [None; 4]);
    let mut edges = None;
    for (key, word, value) in source.entries(node, "a tile")? {
        match word {
            _ if !OF_TILE.contains(&word) => return Err(unknown(source, key, word, &OF_TILE)),
            _ if value.is_null() => {}
            "name" => tile.name = ident(source, value)?,
            "edges" => edges = Some(value),
            "stoic" => tile.stoic = share(source, value)?,
            "color" => tile.color = Some(ident(source, value)?),
            _ => {
                let shape = value.text().unwrap_or_default();
                if !["single", "Single", "s", "S"].contains(&shape) {
                    let message = format!("the tile `{}` is not a single square", tile.name);
                    return Err(source.wrong(value, message, HALVES));
                }
            }
        }
    }
    let Some([n, e, s, w]) = edges.and_then(Node::list) else {
        let count = edges.and_then(Node::list).map_or(0, <[Node]>::len);
        let message = format!("the tile `{}` has {count} edges", tile.name);
        let help = "a tile has four: edges: [north, east, south, west]";
        return Err(source.wrong(edges.unwrap_or(node), message, help));
    };
    for (glue, edge) in tile.glues.iter_mut().zip([n, e, s, w]) {
        let name = ident(source, edge)?;
        *glue = (name != "0").then(|| set.glue(&name, 1.0));
    }
    Ok(tile)
}

/// The strength with which two glues bind each other, or one binds itself.
fn link(source: TextSource, node: &Node, set: &mut TileSet) -> Result<(), DesignError> {
    let Some([first, second, strength]) = node.list() else {
        let help = "write glues: [[a, b, 0.5]]";
        return Err(source.wrong(node, "two glues and a strength are needed", help));
    };
    let place = |node: &Node| {
        let name = ident(source, node)?;
        let known = set.glues.iter().position(|glue| glue.name == name);
        known.ok_or_else(|| {
            let message = format!("no tile or bond has the glue `{name}`");
            let help = "use a glue of a tile, or list it under bonds";
            source.wrong(node, message, help)
        })
    };
    let strength = within(source, strength, "strength", &STRENGTHS);
    let (a, b, strength) = (place(first)?, place(second)?, strength?);
    match a == b {
        true => set.glues[a].strength = strength,
        false => set.links.push((a, b, strength)),
    }
    Ok(())
}

/// Row, column and tile.
fn seed(
    source: TextSource,
    node: &Node,
    set: &TileSet,
) -> Result<(usize, usize, usize), DesignError> {
    let read = || {
        let [row, column, tile] = node.list()? else {
            return None;
        };
        let named = |name: &str| set.tiles.iter().position(|tile| tile.name == name);
        let number = match tile.whole() {
            Some(number) => number.checked_sub(1).filter(|at| *at < set.tiles.len()),
            None => named(tile.text()?),
        };
        Some((row.whole()?, column.whole()?, number?))
    };
    let message = "a seed is a row, a column and a tile of the set";
    read().ok_or_else(|| source.wrong(node, message, "write seed: [row, column, tile]"))
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
    // If an assembly falls apart, the piece with the seed stays. The engines' alternative, never to
    // detach a tile that connects others, stops growth where that tile is not bound.
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
