//! The designs of every two tiles that meet.

use std::collections::BTreeSet;
use std::fmt::Write;

use super::axis::{Met, SIDES};
use super::{Assembly, Request, TileSet};
use crate::Refused;
use crate::design::{Design, DesignError, WordSet, written};
use crate::text::file_stem;
use physics::observer::Observer;
use physics::tile::Tile;

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
    for (design, _) in parsed(assembly) {
        design.map_err(|error| {
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

/// The designs of every two tiles that meet, as other commands read them.
pub fn parsed(assembly: &Assembly) -> impl Iterator<Item = (Result<Design, DesignError>, Met)> {
    let named = named(assembly).into_iter();
    named.map(|(name, met)| {
        let text = design(assembly, &met, &name);
        let file = format!("designs/{name}.toml");
        (Design::parse(&text, &file), met)
    })
}

/// A tile of the set.
///
/// # Errors
/// If its magnets do not fit into it.
pub fn tile(assembly: &Assembly, number: usize) -> Result<Tile, DesignError> {
    let name = &assembly.built.set.tiles[number].name;
    let mut text = head(assembly, name, name);
    // It meets a tile without magnets: designs have two.
    for (role, number) in [("fixed", Some(number)), ("moving", None)] {
        let like = &assembly.design.unwrap_or(&assembly.words.stage).pair.fixed;
        text += &section(assembly, role, number, like);
    }
    text += "\n[target]\nfixed = \"east\"\nmoving = \"west\"\n";
    let design = Design::parse(&text, name)?;
    Ok(design.pair.fixed.clone())
}

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
    let plain = |tile: usize| file_stem(&assembly.built.set.tiles[tile].name);
    let side = SIDES[axis.sides()[0]];
    format!("{}-{side}-{}", plain(*first), plain(*second))
}

fn design(assembly: &Assembly, met: &Met, name: &str) -> String {
    let (first, axis, second) = *met;
    let stage = &assembly.words.stage;
    let like = &assembly.design.unwrap_or(stage).pair;
    let tiles = &assembly.built.set.tiles;
    let [out, back] = axis.sides().map(|side| SIDES[side]);
    let described = format!(
        "{}: the {out} face of {} meets the {back} face of {}",
        assembly.built.set.name, tiles[first].name, tiles[second].name
    );
    let mut text = head(assembly, name, &described);
    text += &section(assembly, "fixed", Some(first), &like.fixed);
    text += &section(assembly, "moving", Some(second), &like.moving);
    let _ = write!(
        text,
        "\n[target]\nfixed = \"{out}\"\nmoving = \"{back}\"\n\n[potential]\nmodel = \"{}\"\n",
        stage.interaction.model.name()
    );
    text
}

/// The beginning of a design: its name, table and magnet.
fn head(assembly: &Assembly, name: &str, described: &str) -> String {
    let stage = &assembly.words.stage;
    let like = assembly.design.unwrap_or(stage);
    let magnet = assembly.magnet();
    let quoted = |text: &str| toml::Value::from(text).to_string();
    let [wide, high] = like.table.map(|size| size.max(stage.table[0]));
    let mut text = format!(
        "name = {}\ndescription = {}\n\n[table]\nsize = [{wide:?}, {high:?}]\n\n[magnet]\n{}\
         moment = {:?}\n",
        quoted(name),
        quoted(described),
        written::magnet(magnet.form, magnet.size),
        magnet.moment
    );
    let _ = writeln!(text, "pitch = {:?}", stage.pitch.unwrap_or(magnet.size[1]));
    let inset = assembly.inset();
    if inset > 0.0 {
        let _ = writeln!(text, "inset = {inset:?}");
    }
    text
}

/// The section of one tile of the set, as thick and heavy as another one; `None` for a tile without
/// magnets.
fn section(assembly: &Assembly, role: &str, number: Option<usize>, like: &Tile) -> String {
    let tile = &assembly.words.stage.pair.fixed;
    let mut text = format!(
        "\n[{role}]\nside = {:?}\nthickness = {:?}\nmass = {:?}\n\n[{role}.faces]\n",
        tile.faces[0].length(),
        like.thickness,
        like.mass
    );
    for (side, name) in SIDES.iter().enumerate() {
        if let Some(face) = number.and_then(|number| assembly.built.face(number, side)) {
            let _ = writeln!(text, "{name} = {}", entry(assembly, face));
        }
    }
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
