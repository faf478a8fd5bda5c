//! Tile sets as xgrow reads them: `.tiles`.
//!
//! `num tile types`, `num binding types`, names of the latter if they have some, tiles as
//! `{north east south west}[share](colour)`, strengths, `g(a,b)=x` between different glues, then
//! arguments a line each. `%` begins a comment.

use std::fmt::Write;

use super::{Glue, TileSet, TileType};
use crate::design::{DesignError, Place};

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
        let place = Place::of(self.text, self.at..self.at + 1);
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

    /// What stands here up to one of some characters.
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
            self.wrong(format!("`{found}` is no number"), FORM)
        })
    }
}

const FORM: &str = "a .tiles file has: num tile types=, num binding types=, tile edges={{n e s w} \
                    ...}, binding strengths={...}, then g(a,b)=x and arguments";
const ENDS: [char; 5] = [' ', '\t', '\n', '\r', '}'];

/// Reads a set; its name is left empty.
///
/// # Errors
/// Where the text is no such set.
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
            set.glues[at].strength = scan.number()?;
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
            ("0" | "null", _) => None,
            (_, Ok(number)) if number <= set.glues.len() => Some(number - 1),
            _ if by_name.is_some() => by_name,
            _ => {
                scan.at = start;
                let message = format!("there is no glue `{name}`");
                return Err(scan.wrong(message, "raise the number of binding types, or name it"));
            }
        };
    }
    scan.expect("}")?;
    let mut tile = TileType::new(number.to_string(), glues);
    if scan.takes("[") {
        tile.stoic = scan.number()?;
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

/// A line after the strengths; what only steers the engine is passed over.
fn argument(scan: &mut Scanner, set: &mut TileSet) -> Result<(), DesignError> {
    if scan.takes("g(") {
        let a: usize = scan.number()?;
        scan.expect(",")?;
        let b: usize = scan.number()?;
        scan.expect(")=")?;
        let strength: f64 = scan.number()?;
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
    for double in ["doubletile=", "vdoubletile="] {
        if scan.rest().starts_with(double) {
            let help = "write the two halves as tiles that share a strong glue";
            return Err(scan.wrong("double tiles are no magnetic squares".to_owned(), help));
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
        set.tau = Some(scan.number()?);
    } else if scan.takes("Gse=") {
        set.gse = Some(scan.number()?);
    } else if scan.takes("Gmc=") {
        set.gmc = Some(scan.number()?);
    } else {
        scan.until(&['\n']);
    }
    Ok(())
}

/// The text of a set, with `remarks` as comments above it. Names of tiles are comments: not every
/// reader takes them.
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
    let is_name = |glue: &Glue| !glue.name.starts_with(|c: char| c.is_ascii_digit());
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
    // As in rgrow's files: pieces may part.
    text += "fission\n";
    for (key, value) in [("Gse", set.gse), ("Gmc", set.gmc)] {
        if let Some(value) = value {
            let _ = writeln!(text, "{key}={value:?}");
        }
    }
    text
}
