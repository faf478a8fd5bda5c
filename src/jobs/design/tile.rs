//! The sections `[fixed]` and `[moving]`, or `[tile]` for both: their faces, and which faces mate.

use super::DesignError;
use super::base::{self, Base};
use super::error::Result;
use super::face::{FaceContent, FaceEntry, find_face};
use super::magnet::MagnetKeys;
use super::quantity;
use super::reader::{Entry, Section, all};
use super::shield::ShieldKeys;
use super::tolerance::{Lengths, distinguished, nearly_equal};
use physics::potential::shielding::Shield;

/// The two tiles' names, in the order in which they are stored.
pub(super) const TILES: [&str; 2] = ["fixed", "moving"];

/// The name of a tile that is both.
pub(super) const ONE_TILE: &str = "tile";

/// The keys of `[fixed]`, `[moving]` and `[tile]`.
pub(super) const TILE_KEYS: [&str; 8] = [
    "side",
    "sides",
    "vertices",
    "outline",
    "thickness",
    "mass",
    "faces",
    "shield",
];

/// The entries of one tile.
pub(super) struct TileEntry<'a> {
    /// `fixed`, `moving` or `tile`.
    pub name: &'static str,
    pub section: Section<'a>,
    pub base: Base,
    /// m.
    pub thickness: f64,
    /// The entry of the mass, and its value (kg).
    pub mass: Option<(Entry<'a>, f64)>,
    faces: Vec<FaceEntry<'a>>,
}

impl<'a> TileEntry<'a> {
    pub fn read(name: &'static str, section: Section<'a>, faces_name: &'a str) -> Result<Self> {
        section.allow(&TILE_KEYS);
        let base = base::read(&section);
        let thickness = thickness(&section);
        let mass = mass(&section);
        let base = base?;
        let faces = match section.section("faces", faces_name)? {
            Some(faces) => face_entries(&faces, &base)?,
            None => vec![FaceEntry::new(None, None)?; base.faces.len()],
        };
        Ok(Self {
            name,
            section,
            base,
            // Faulty ones are reported and never used.
            thickness: thickness.unwrap_or(0.0),
            mass: mass.ok(),
            faces,
        })
    }
}

fn thickness(section: &Section) -> Result<f64> {
    let help = "give the thickness of the tile: thickness = 0.013 (m)";
    let entry = section.require("thickness", help)?;
    entry.number(quantity::TILE_THICKNESS)
}

fn mass<'a>(section: &Section<'a>) -> Result<(Entry<'a>, f64)> {
    let entry = section.require("mass", "give the mass of the tile: mass = 0.1 (kg)")?;
    Ok((entry, entry.number(quantity::MASS)?))
}

impl<'a> TileEntry<'a> {
    /// The `mates` entry of a face, if it has one.
    pub fn mates_of(&self, face: usize) -> Option<Entry<'a>> {
        self.faces[face].mates()
    }

    /// The shield of each face; `lower` are the keys for all tiles.
    pub fn shields(&self, lower: ShieldKeys) -> Result<Vec<Option<Shield>>> {
        let keys = self.shield_keys(lower)?;
        keys.iter()
            .zip(&self.base.faces)
            .map(|(keys, face)| keys.shield(&self.section, self.name, &face.name))
            .collect()
    }

    /// All shield keys of each face.
    pub fn shield_keys(&self, lower: ShieldKeys) -> Result<Vec<ShieldKeys>> {
        let lower = ShieldKeys::read(&self.section, "a tile's `shield`")?.over(lower);
        self.faces
            .iter()
            .map(|face| Ok(face.shield_keys()?.over(lower)))
            .collect()
    }
}

/// Assigns the entries of `[*.faces]` to faces.
fn face_entries<'a>(section: &Section<'a>, base: &Base) -> Result<Vec<FaceEntry<'a>>> {
    let mut known = vec!["all"];
    known.extend(base.names.iter().flatten().map(String::as_str));
    section.allow(&known);
    let all_faces = section.section("all", "`all`")?;
    let entries = section.entries();
    all(base.names.iter().map(|names| {
        let mut named = entries
            .iter()
            .filter(|entry| names.iter().any(|name| name == entry.key));
        let first = named.next();
        if let (Some(first), Some(second)) = (first, named.next()) {
            return Err(second.key_error(
                format!("`{}` and `{}` are the same face", first.key, second.key),
                "keep one of the two",
            ));
        }
        let own = first.map(|entry| entry.section(entry.key)).transpose()?;
        FaceEntry::new(own, all_faces)
    }))
}

/// The contents of all faces of both tiles; mates are resolved to the face they copy.
pub(super) fn resolve(tiles: &[TileEntry; 2], keys: MagnetKeys) -> Result<[Vec<FaceContent>; 2]> {
    let [fixed, moving] = [0, 1].map(|tile: usize| {
        let faces = 0..tiles[tile].faces.len();
        all(faces.map(|face| resolve_face(tiles, keys, (tile, face), &mut Vec::new())))
    });
    Ok([fixed?, moving?])
}

fn resolve_face(
    tiles: &[TileEntry; 2],
    keys: MagnetKeys,
    (tile, face): (usize, usize),
    on_the_way: &mut Vec<(usize, usize)>,
) -> Result<FaceContent> {
    let entry = &tiles[tile].faces[face];
    let base = &tiles[tile].base.faces[face];
    let Some(mates) = entry.mates() else {
        let drawn = (&tiles[tile].base.lines[face], &tiles[tile].base.arcs[face]);
        return entry.content(base.length(), drawn, keys, tiles[tile].section.span);
    };
    let other = 1 - tile;
    let partner = find_face(&tiles[other].base.names, &mates, tiles[other].name)?;
    on_the_way.push((tile, face));
    if on_the_way.contains(&(other, partner)) {
        let [own, others] = [(tile, face), (other, partner)].map(|it| name(tiles, it));
        let (message, help) = match own == others {
            true => (
                format!("{own} mates itself, so nothing says what it is"),
                "give it a code that binds its own kind, such as NS or UD, or let it mate another face",
            ),
            false => (
                format!("{own} mates {others}, which in turn mates {own} again"),
                "give one of these faces its own code and profile",
            ),
        };
        return Err(mates.error(message, help));
    }
    let partner_length = tiles[other].base.faces[partner].length();
    tiles[tile].section.source.faults.check_guesses()?;
    let lengths = Lengths::of(base.length(), partner_length);
    if lengths == Lengths::Unequal {
        let [own, others] = distinguished(base.length(), partner_length);
        return Err(mates.error(
            format!("a face of {own} cannot mate a face of {others}"),
            "mates need faces of equal length",
        ));
    }
    let partner = resolve_face(tiles, keys, (other, partner), on_the_way)?;
    let mut content = entry.mate_of(&partner, &mates)?;
    if lengths == Lengths::Near {
        // The line of a longer face is cut at the end of this one.
        let end = base.length() / 2.0;
        for [s, _] in &mut content.polyline {
            *s = s.clamp(-end, end);
        }
    }
    Ok(content)
}

/// Warns of mates that are slightly longer or shorter than their partners.
pub(super) fn nearly_mates(tiles: &[TileEntry; 2]) -> Vec<DesignError> {
    let mut doubts = Vec::new();
    for (tile, entry) in tiles.iter().enumerate() {
        let other = 1 - tile;
        for (face, base) in entry.faces.iter().zip(&entry.base.faces) {
            let Some(mates) = face.mates() else { continue };
            let Ok(partner) = find_face(&tiles[other].base.names, &mates, tiles[other].name) else {
                continue;
            };
            let lengths = [base, &tiles[other].base.faces[partner]].map(|face| face.length());
            let [own, others] = lengths;
            if Lengths::of(own, others) == Lengths::Near {
                doubts.push(nearly_equal(&mates, "the mates measure", own, others));
            }
        }
    }
    doubts
}

fn name(tiles: &[TileEntry; 2], (tile, face): (usize, usize)) -> String {
    format!("{}.{}", tiles[tile].name, tiles[tile].base.faces[face].name)
}
