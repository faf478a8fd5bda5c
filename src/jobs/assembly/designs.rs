//! The designs of every two tiles that meet.

use std::collections::BTreeSet;
use std::fmt::Write;

use super::axis::{Met, SIDES};
use super::{Assembly, Request, TileSet};
use crate::Refused;
use crate::design::{Design, DesignError, WordSet, written};
use physics::observer::Observer;

impl Request {
    /// Builds a tile set from words: from the given ones, with the text of their file, or else from
    /// a search.
    ///
    /// # Errors
    /// If there are no such words, or too few.
    pub fn build<'a>(
        &self,
        tiles: &TileSet,
        words: Option<(WordSet, String)>,
        design: Option<&'a Design>,
        observer: &dyn Observer,
    ) -> Result<Assembly<'a>, Refused> {
        let assembly = self.assembled(tiles, words, design, observer)?;
        check(&assembly)?;
        Ok(assembly)
    }
}

/// Reads the designs as other commands will.
fn check(assembly: &Assembly) -> Result<(), DesignError> {
    for (name, text) in all(assembly) {
        Design::parse(&text, &format!("designs/{name}.toml")).map_err(|error| {
            let help = format!(
                "use longer tiles (a DESIGN with a longer side), smaller magnets, or words with \
                 fewer positions; {}",
                error.help
            );
            DesignError { help, ..error }
        })?;
    }
    Ok(())
}

/// Names and texts of the designs of every two tiles that meet in the assembly.
pub fn all(assembly: &Assembly) -> impl Iterator<Item = (String, String)> {
    let named = named(assembly).into_iter();
    named.map(|(name, met)| {
        let text = design(assembly, &met, &name);
        (name, text)
    })
}

/// Longest name of a tile in the names of files (bytes).
const LONGEST_NAME: usize = 60;

/// The tiles that meet and bind each other, with the names of their designs.
pub fn named(assembly: &Assembly) -> Vec<(String, Met)> {
    let mut names = BTreeSet::new();
    let met = assembly.built.meetings.keys().copied();
    let bound = met.filter(|met| assembly.built.whole(met).is_some());
    bound
        .map(|met| {
            let plain = name(assembly, &met);
            let mut name = plain.clone();
            let mut number = 2;
            // Replacing letters that file names cannot have may make two names equal.
            while !names.insert(name.to_lowercase()) {
                name = format!("{plain}-{number}");
                number += 1;
            }
            (name, met)
        })
        .collect()
}

fn name(assembly: &Assembly, (first, axis, second): &Met) -> String {
    let tiles = &assembly.built.set.tiles;
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-';
    // File names have at most 255 bytes.
    let plain = |tile: usize| {
        // What is left are ASCII letters: a letter is a byte.
        let name = tiles[tile].name.replace(|c| !is_plain(c), "_");
        name.chars().take(LONGEST_NAME).collect::<String>()
    };
    let side = SIDES[axis.sides()[0]];
    format!("{}-{side}-{}", plain(*first), plain(*second))
}

fn design(assembly: &Assembly, met: &Met, name: &str) -> String {
    let (first, axis, second) = *met;
    let stage = &assembly.words.stage;
    let like = assembly.design.unwrap_or(stage);
    let magnet = assembly.magnet();
    let tile = &stage.pair.fixed;
    let tiles = &assembly.built.set.tiles;
    let [out, back] = axis.sides().map(|side| SIDES[side]);
    let described = format!(
        "{}: the {out} face of {} meets the {back} face of {}",
        assembly.built.set.name, tiles[first].name, tiles[second].name
    );
    let quoted = |text: &str| toml::Value::from(text).to_string();
    let [wide, high] = like.table.map(|size| size.max(stage.table[0]));
    let mut text = format!(
        "name = {}\ndescription = {}\n\n[table]\nsize = [{wide:?}, {high:?}]\n\n[magnet]\n{}\
         moment = {:?}\n",
        quoted(name),
        quoted(&described),
        written::magnet(magnet.form, magnet.size),
        magnet.moment
    );
    let _ = writeln!(text, "pitch = {:?}", stage.pitch.unwrap_or(magnet.size[1]));
    let inset = assembly.inset();
    if inset > 0.0 {
        let _ = writeln!(text, "inset = {inset:?}");
    }
    for (role, number, like) in [
        ("fixed", first, &like.pair.fixed),
        ("moving", second, &like.pair.moving),
    ] {
        let _ = write!(
            text,
            "\n[{role}]\nside = {:?}\nthickness = {:?}\nmass = {:?}\n\n[{role}.faces]\n",
            tile.faces[0].length(),
            like.thickness,
            like.mass
        );
        for (side, name) in SIDES.iter().enumerate() {
            if let Some(face) = assembly.built.face(number, side) {
                let _ = writeln!(text, "{name} = {}", entry(assembly, face));
            }
        }
    }
    let _ = write!(
        text,
        "\n[target]\nfixed = \"{out}\"\nmoving = \"{back}\"\n\n[potential]\nmodel = \"{}\"\n",
        stage.interaction.model.name()
    );
    text
}

/// The entry of a face in a design.
fn entry(assembly: &Assembly, face: usize) -> String {
    let word = assembly.built.matrix.code(face);
    if assembly.words.places.is_none() {
        return format!("{{ code = \"{word}\" }}");
    }
    let magnets = assembly.magnets(word).into_iter();
    let one = |(at, pole)| format!("{{ at = {at:?}, pole = \"{pole}\" }}");
    let magnets: Vec<String> = magnets.map(one).collect();
    format!("{{ magnets = [{}] }}", magnets.join(", "))
}
