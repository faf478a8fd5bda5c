//! Tile sets in xgrow's format, `.tiles`.
//!
//! `num tile types`, `num binding types`, names of the latter if present, tiles as `{north east
//! south west}[share](colour)`, strengths, `g(a,b)=x` between different glues, then one argument
//! per line. `%` begins a comment.

use std::fmt::Write;
use std::ops::RangeInclusive;

use super::{ENERGIES, Glue, SHARES, STRENGTHS, TileSet, TileType, in_range};
use crate::design::{DesignError, FilePlace, nearest_help};

struct Scanner<'a> {
    text: &'a str,
    file: &'a str,
    at: usize,
}

impl<'a> Scanner<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn skip(&mut self) {
        loop {
            let rest = self.rest();
            self.at += rest.len() - rest.trim_start().len();
            if !self.rest().starts_with('%') {
                return;
            }
            self.at += self.rest().find('\n').unwrap_or(self.rest().len());
        }
    }

    fn wrong(&self, message: String, help: &str) -> DesignError {
        let place = FilePlace::of(self.text, self.at..self.at + 1);
        DesignError::new(self.file, Some(place), message, help)
    }

    fn takes(&mut self, word: &str) -> bool {
        self.skip();
        let there = self.rest().starts_with(word);
        self.at += if there { word.len() } else { 0 };
        there
    }

    fn expect(&mut self, word: &str) -> Result<(), DesignError> {
        match self.takes(word) {
            true => Ok(()),
            false => Err(self.wrong(format!("`{word}` is missing here"), FORM)),
        }
    }

    /// The text from here up to one of the given characters.
    fn until(&mut self, ends: &[char]) -> &'a str {
        self.skip();
        let rest = self.rest();
        let found = &rest[..rest.find(ends).unwrap_or(rest.len())];
        self.at += found.len();
        found
    }

    fn number<T: std::str::FromStr>(&mut self) -> Result<T, DesignError> {
        self.skip();
        let start = self.at;
        let found = self.until(&[' ', '\t', '\n', '\r', '}', ']', ')', ',', '%']);
        found.parse().map_err(|_| {
            self.at = start;
            self.wrong(format!("`{found}` is not a number"), FORM)
        })
    }

    /// A number in a range; messages call it `what`.
    fn within(&mut self, what: &str, range: &RangeInclusive<f64>) -> Result<f64, DesignError> {
        self.skip();
        let start = self.at;
        let found = self.number()?;
        in_range(what, found, range).map_err(|(message, help)| {
            self.at = start;
            self.wrong(message, &help)
        })
    }

    /// A tile's share: 0, or in its range.
    fn share(&mut self) -> Result<f64, DesignError> {
        self.skip();
        let start = self.at;
        if self.number::<f64>()? == 0.0 {
            return Ok(0.0);
        }
        self.at = start;
        self.within("the share", &SHARES)
    }
}

const FORM: &str = "a .tiles file has: num tile types=, num binding types=, tile edges={{n e s w} \
                    ...}, binding strengths={...}, then g(a,b)=x and arguments";
const ENDS: [char; 5] = [' ', '\t', '\n', '\r', '}'];

/// Reads a set; its name is left empty.
///
/// # Errors
/// If the text is not a valid set.
pub fn read(text: &str, file: &str) -> Result<TileSet, DesignError> {
    let mut scan = Scanner { text, file, at: 0 };
    let mut set = TileSet::default();
    if scan.takes("tile edges matches") {
        scan.until(&['\n']);
    }
    scan.expect("num tile types=")?;
    let tiles: usize = scan.number()?;
    scan.expect("num binding types=")?;
    let glues: usize = scan.number()?;
    if tiles > super::MOST || glues > super::MOST {
        let message = format!("it has more than {} tiles or glues", super::MOST);
        return Err(scan.wrong(message, "split the set"));
    }
    let glue = |number: usize| Glue {
        name: number.to_string(),
        strength: 1.0,
    };
    set.glues = (1..=glues).map(glue).collect();
    if scan.takes("binding type names=") {
        scan.expect("{")?;
        for glue in &mut set.glues {
            glue.name = scan.until(&ENDS).to_owned();
        }
        scan.expect("}")?;
    }
    scan.expect("tile edges=")?;
    scan.expect("{")?;
    for number in 1..=tiles {
        let tile = tile(&mut scan, &set, number)?;
        set.tiles.push(tile);
    }
    scan.expect("}")?;
    if scan.takes("binding strengths=") {
        scan.expect("{")?;
        for at in 0..glues {
            set.glues[at].strength = scan.within("the strength", &STRENGTHS)?;
        }
        scan.expect("}")?;
    }
    loop {
        scan.skip();
        if scan.rest().is_empty() {
            return Ok(set);
        }
        argument(&mut scan, &mut set)?;
    }
}

fn tile(scan: &mut Scanner, set: &TileSet, number: usize) -> Result<TileType, DesignError> {
    scan.expect("{")?;
    let mut glues = [None; 4];
    for glue in &mut glues {
        scan.skip();
        let start = scan.at;
        let name = scan.until(&ENDS);
        let by_name = set.glues.iter().position(|glue| glue.name == name);
        *glue = match (name, name.parse::<usize>()) {
            ("null", _) | (_, Ok(0)) => None,
            (_, Ok(number)) if number <= set.glues.len() => Some(number - 1),
            _ if by_name.is_some() => by_name,
            _ => {
                scan.at = start;
                let message = format!("there is no glue `{name}`");
                return Err(scan.wrong(
                    message,
                    "increase the number of binding types, or define \
                    the glue",
                ));
            }
        };
    }
    scan.expect("}")?;
    let mut tile = TileType::new(number.to_string(), glues);
    if scan.takes("[") {
        tile.stoic = scan.share()?;
        scan.expect("]")?;
    }
    let mut named = |open: &str, close: char| -> Result<Option<String>, DesignError> {
        if !scan.takes(open) {
            return Ok(None);
        }
        let found = scan.until(&[close]).trim().to_owned();
        scan.expect(&close.to_string())?;
        Ok(Some(found))
    };
    tile.color = named("(", ')')?;
    tile.name = named("<", '>')?.unwrap_or(tile.name);
    Ok(tile)
}

/// Lines that require something that magnetic squares on a table cannot do, or that refer to other
/// files.
const REFUSED: [(&str, &str, &str); 6] = [
    ("doubletile=", DOUBLE, HALVES),
    ("vdoubletile=", DOUBLE, HALVES),
    (
        "periodic",
        "its canvas is periodic, but a table has edges",
        "remove the line, and give a size large enough for the assembly",
    ),
    (
        "importfile",
        "its seed is in another file",
        "write the first tile as seed=row,column,tile (or seeds as a list, in YAML)",
    ),
    (
        "stripe=",
        "it begins with stripes of tiles",
        "write the first tile as seed=row,column,tile (or seeds as a list, in YAML)",
    ),
    (
        "stoic=",
        "it changes the share of a tile",
        "write the share after the tile: {1 2 1 2}[0.5]",
    ),
];
const DOUBLE: &str = "square magnetic tiles cannot represent double tiles";
const HALVES: &str = "write the two halves as tiles that share a strong glue";

/// Lines that only control the engine.
const STEERING: [&str; 64] = [
    "block",
    "update_rate",
    "rand",
    "k",
    "tmax",
    "emax",
    "smax",
    "smin",
    "fsmax",
    "mmax",
    "fission",
    "no_fission",
    "chunk_fission",
    "wander",
    "pause",
    "window",
    "font",
    "tracefile",
    "datafile",
    "arrayfile",
    "exportfile",
    "largeflakedatafile",
    "movie",
    "movieformat",
    "import_offset",
    "importoffset",
    "addflakes",
    "tinybox",
    "untiltiles",
    "untiltilescount",
    "min_strength",
    "error_radius",
    "repair_unique",
    "repair_unique_T",
    "clean_X",
    "clean_cycles",
    "fill_X",
    "fill_cycles",
    "blast_rate",
    "blast_rate_alpha",
    "blast_rate_beta",
    "blast_rate_gamma",
    "zero_bonds",
    "no_zero_bonds",
    "Gfc",
    "Gas",
    "Gam",
    "Gae",
    "Gah",
    "Gao",
    "Gseh",
    "Gmch",
    "Ghyd",
    "anneal",
    "linan",
    "testing",
    "pulse",
    "present",
    "tmp",
    "fluxes",
    "-nw",
    "-rv",
    "nw",
    "rv",
];
/// Lines that this module writes itself.
const OWN: [&str; 1] = ["fission"];

/// Reads a line after the strengths; lines that only control the engine are ignored.
fn argument(scan: &mut Scanner, set: &mut TileSet) -> Result<(), DesignError> {
    if scan.takes("g(") {
        let a: usize = scan.number()?;
        scan.expect(",")?;
        let b: usize = scan.number()?;
        scan.expect(")=")?;
        let strength = scan.within("the strength", &STRENGTHS)?;
        let known = 1..=set.glues.len();
        if !known.contains(&a) || !known.contains(&b) {
            return Err(scan.wrong(format!("there is no glue {a} or no glue {b}"), FORM));
        }
        match a == b {
            true => set.glues[a - 1].strength += strength,
            false => set.links.push((a - 1, b - 1, strength)),
        }
        return Ok(());
    }
    if scan.takes("periodic=False") {
        return Ok(());
    }
    for (line, message, help) in REFUSED {
        if scan.rest().starts_with(line) {
            return Err(scan.wrong(message.to_owned(), help));
        }
    }
    if scan.takes("seed=") {
        let row = scan.number()?;
        scan.expect(",")?;
        let column = scan.number()?;
        scan.expect(",")?;
        let tile: usize = scan.number()?;
        set.seed = vec![(row, column, tile.wrapping_sub(1))];
    } else if scan.takes("size=") {
        set.size = Some([scan.number()?; 2]);
    } else if scan.takes("T=") {
        set.tau = Some(scan.within("T", &ENERGIES)?);
    } else if scan.takes("Gse=") {
        set.gse = Some(scan.within("Gse", &ENERGIES)?);
    } else if scan.takes("Gmc=") {
        set.gmc = Some(scan.within("Gmc", &ENERGIES)?);
    } else {
        let start = scan.at;
        let line = scan.until(&['\n']).trim();
        let key = line
            .split(['=', ' ', '\t', '%', '('])
            .next()
            .unwrap_or_default();
        if !STEERING.contains(&key) {
            scan.at = start;
            let message = format!("`{key}` is not an xgrow argument after the strengths");
            return Err(scan.wrong(message, &nearest_help(key, &STEERING)));
        }
        if !OWN.contains(&line) {
            set.passed_over.push(key.to_owned());
        }
    }
    Ok(())
}

/// The text of a set, with `remarks` as comments above it. Names of tiles are comments, because not
/// every reader accepts them.
pub fn write(set: &TileSet, remarks: &[String]) -> String {
    let mut text = String::new();
    for line in remarks {
        let _ = writeln!(text, "% {line}");
    }
    let _ = writeln!(
        text,
        "tile edges matches {{{{N E S W}}*}}\nnum tile types={}\nnum binding types={}",
        set.tiles.len(),
        set.glues.len()
    );
    // Names that the reader accepts unambiguously.
    let is_name = |glue: &Glue| {
        let name = &glue.name;
        let is_plain = |c: char| c.is_alphanumeric() || "*_-.".contains(c);
        name.starts_with(char::is_alphabetic) && name != "null" && name.chars().all(is_plain)
    };
    let named = set.glues.iter().all(is_name);
    if named && !set.glues.is_empty() {
        let names: Vec<&str> = set.glues.iter().map(|glue| glue.name.as_str()).collect();
        let _ = writeln!(text, "binding type names={{\n{}\n}}", names.join("\n"));
    }
    text += "tile edges={\n";
    for tile in &set.tiles {
        let glue = |glue: Option<usize>| match glue {
            None => "0".to_owned(),
            Some(at) if named => set.glues[at].name.clone(),
            Some(at) => (at + 1).to_string(),
        };
        let _ = write!(text, "{{{}}}", tile.glues.map(glue).join(" "));
        if tile.stoic != 1.0 {
            let _ = write!(text, "[{:?}]", tile.stoic);
        }
        if let Some(color) = &tile.color {
            let _ = write!(text, "({color})");
        }
        let _ = writeln!(text, " % {}", tile.name);
    }
    text += "}\nbinding strengths={\n";
    for glue in &set.glues {
        let _ = writeln!(text, "{:?}", glue.strength);
    }
    text += "}\n";
    for (a, b, strength) in &set.links {
        let _ = writeln!(text, "g({},{})={strength:?}", a + 1, b + 1);
    }
    if let [(row, column, tile)] = set.seed[..] {
        let _ = writeln!(text, "seed={row},{column},{}", tile + 1);
    }
    if let Some([rows, columns]) = set.size {
        let _ = writeln!(text, "size={}", rows.max(columns));
    }
    // As in rgrow's files: assemblies may fall apart.
    text += "fission\n";
    for (key, value) in [("Gse", set.gse), ("Gmc", set.gmc)] {
        if let Some(value) = value {
            let _ = writeln!(text, "{key}={value:?}");
        }
    }
    text
}
