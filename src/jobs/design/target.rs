//! The section `[target]`: which faces are meant to bind, and where that puts the moving tile.

use nalgebra::Vector2;

use super::error::{DesignError, Result};
use super::face::find_face;
use super::quantity::four_digits;
use super::reader::{Entry, Section};
use super::tile::{TILES, TileEntry, same_length};
use physics::configuration::Configuration;
use physics::contact::Contact;
use physics::tile::outline::cross;
use physics::tile::{Face, Tile};

/// The target as the file gives it.
pub(super) struct Target<'a> {
    /// Face of the fixed tile, face of the moving tile.
    pub faces: (usize, usize),
    moving: Entry<'a>,
}

const HELP: &str =
    "name the two faces that are meant to bind: [target] fixed = \"east\", moving = \"west\"";

pub(super) fn read<'a>(root: &Section<'a>, tiles: &[TileEntry; 2]) -> Result<Target<'a>> {
    let section = root.require("target", HELP)?.section("[target]")?;
    section.allow(&TILES);
    let face = |i: usize| {
        let entry = section.require(TILES[i], HELP)?;
        let face = find_face(&tiles[i].base.names, &entry, TILES[i])?;
        Ok::<_, DesignError>((entry, face))
    };
    let [fixed, moving] = [0, 1].map(|i| face(i));
    let ((_, fixed), (entry, moving)) = (fixed?, moving?);
    let lengths = [(0, fixed), (1, moving)].map(|(i, face)| tiles[i].base.faces[face].length());
    section.source.faults.check_guesses()?;
    if !same_length(lengths[0], lengths[1]) {
        return Err(entry.error(
            format!(
                "the target faces cannot coincide: they are {} m and {} m long",
                four_digits(lengths[0]),
                four_digits(lengths[1])
            ),
            "choose two faces of equal length",
        ));
    }
    Ok(Target {
        faces: (fixed, moving),
        moving: entry,
    })
}

impl Target<'_> {
    /// The configuration in which the two base lines coincide, face to face.
    pub fn configuration(&self, fixed: &Tile, moving: &Tile) -> Result<Configuration> {
        let bound = face_to_face(&fixed.faces[self.faces.0], &moving.faces[self.faces.1]);
        let contact = Contact::new(&fixed.outline, &moving.outline);
        let depth = -contact.clearance(&bound);
        if depth > contact.touch() {
            return Err(self.moving.error(
                format!(
                    "the target faces cannot coincide: there the tiles overlap by {} mm",
                    four_digits(depth * 1e3)
                ),
                format!(
                    "make the moving face the complement of the fixed one: {} = {{ mates = \"{}\" }} under [moving.faces]",
                    moving.faces[self.faces.1].name, fixed.faces[self.faces.0].name
                ),
            ));
        }
        Ok(bound)
    }
}

/// Where the moving tile is when its face lies on the fixed tile's, the other way round.
fn face_to_face(fixed: &Face, moving: &Face) -> Configuration {
    let (to, from) = (-fixed.normal(), moving.normal());
    let theta = libm::atan2(clean(cross(from, to)), clean(from.dot(&to)));
    let turned = Configuration::new(0.0, 0.0, theta).transform(moving.middle());
    let position: Vector2<f64> = fixed.middle() - turned;
    Configuration::new(clean(position.x), clean(position.y), theta)
}

/// Zero for what is zero but for rounding, so that squares meet at exact right angles; never -0.
fn clean(x: f64) -> f64 {
    if x.abs() < 1e-15 { 0.0 } else { x }
}
