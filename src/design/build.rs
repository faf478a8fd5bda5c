//! From the contents of its faces to a tile.

use super::DesignError;
use super::error::Span;
use super::face::FaceContent;
use super::placement::{magnet, placed};
use super::quantity::{self, four_digits};
use super::reader::{Result, Section};
use super::tile::TileEntry;
use crate::tile::Tile;
use crate::tile::assembly::{FaceLine, FitTooLarge, Ring, assemble, face_edges};
use crate::tile::outline::{Outline, OutlineError};

/// A tile, and for each of its magnets the place in the file that puts it there.
pub(super) struct BuiltTile {
    pub tile: Tile,
    /// The outline with the face that each edge belongs to.
    pub ring: Ring,
    pub magnet_spans: Vec<Span>,
}

/// Puts a tile together from the contents of its faces.
pub(super) fn build(entry: &TileEntry, contents: &[FaceContent]) -> Result<BuiltTile> {
    let faces = &entry.base.faces;
    let thickness = thickness(&entry.section)?;
    let (ring, outline) = outline(entry, contents)?;
    let mass = mass(&entry.section, outline.area() * thickness)?;
    let mut magnets = Vec::new();
    let mut magnet_spans = Vec::new();
    for (number, content) in contents.iter().enumerate() {
        let edges = face_edges(&ring, &faces[number], number);
        for listed in placed(entry, content, faces[number].length())? {
            let magnet = magnet(entry, (number, &faces[number]), &edges, &listed)?;
            if magnet.size[2] > thickness {
                return Err(entry.section.error_at(
                    listed.span,
                    format!(
                        "a magnet {} m thick sticks out of a tile {thickness} m thick",
                        magnet.size[2]
                    ),
                    "the third number of a magnet's size runs through the tile's thickness",
                ));
            }
            magnets.push(magnet);
            magnet_spans.push(listed.span);
        }
    }
    let tile = Tile {
        outline,
        faces: faces.clone(),
        magnets,
        mass,
        thickness,
    };
    Ok(BuiltTile {
        tile,
        ring,
        magnet_spans,
    })
}

fn thickness(section: &Section) -> Result<f64> {
    section
        .require(
            "thickness",
            "say how thick the tile is: thickness = 0.013 (m)",
        )?
        .number(quantity::TILE_THICKNESS)
}

/// Density (kg/m^3) of the densest material there is, osmium.
const HIGHEST_DENSITY: f64 = 22_590.0;

fn mass(section: &Section, volume: f64) -> Result<f64> {
    let entry = section.require("mass", "say how heavy the tile is: mass = 0.1 (kg)")?;
    let mass = entry.number(quantity::MASS)?;
    if mass > HIGHEST_DENSITY * volume {
        return Err(entry.error(
            format!(
                "`mass` = {mass} kg makes the tile denser than any material ({} kg/m^3): did you mean {} ({mass} g)?",
                four_digits(mass / volume),
                mass / 1000.0
            ),
            "masses are in kilograms",
        ));
    }
    Ok(mass)
}

fn outline(entry: &TileEntry, contents: &[FaceContent]) -> Result<(Ring, Outline)> {
    let lines: Vec<_> = contents
        .iter()
        .map(|content| FaceLine {
            polyline: content.polyline.clone(),
            fit: content.fit,
        })
        .collect();
    let ring = assemble(&entry.base.faces, &lines).map_err(|FitTooLarge(face)| {
        entry.section.error_at(
            contents[face].fit_span,
            format!(
                "face {} cannot be drawn back by {} m: part of its line would vanish",
                entry.base.faces[face].name, contents[face].fit
            ),
            "make `fit` smaller, or the profile's details larger",
        )
    })?;
    match Outline::new(ring.points.clone()) {
        Ok(outline) => Ok((ring, outline)),
        Err(error) => Err(mend_outline(entry, contents, &ring, &error)),
    }
}

/// Profiles that make no outline, as a fault of the profile that is to be changed.
fn mend_outline(
    entry: &TileEntry,
    contents: &[FaceContent],
    ring: &Ring,
    error: &OutlineError,
) -> DesignError {
    let name = |face: usize| &entry.base.faces[face].name;
    match *error {
        OutlineError::SelfCrossing(i, j) => {
            let (a, b) = (ring.faces[i], ring.faces[j]);
            // The face with a profile is the culprit, not its flat neighbour.
            let (culprit, other) = if contents[a].polyline.is_empty() {
                (b, a)
            } else {
                (a, b)
            };
            let (message, help) = if a == b {
                (
                    format!("the profile of face {} crosses or touches itself", name(a)),
                    "list its points in their order along the line",
                )
            } else {
                (
                    format!(
                        "the profile of face {} crosses or touches face {}",
                        name(culprit),
                        name(other)
                    ),
                    "make it less deep, or keep it farther from the corners",
                )
            };
            entry
                .section
                .error_at(contents[culprit].line_span, message, help)
        }
        _ => entry.section.error(
            format!("the profiles leave no outline: {error}"),
            "make the profiles less deep",
        ),
    }
}
