//! Builds a tile from the contents of its faces.

use super::DesignError;
use super::error::{Result, Span};
use super::face::FaceContent;
use super::placement::{magnet, placed};
use super::profile::depth_of;
use super::quantity::{four_digits, rounded_down};
use super::tile::TileEntry;
use physics::bisection::bisected;
use physics::tile::assembly::{FaceLine, FitTooLarge, Ring, assemble, face_edges};
use physics::tile::outline::{Outline, OutlineError};
use physics::tile::profile::SHALLOWEST;
use physics::tile::strength::Strength;
use physics::tile::{Magnet, Tile};

/// A tile, with the place in the file of each of its magnets.
pub(super) struct BuiltTile {
    pub tile: Tile,
    /// The outline with the face that each edge belongs to.
    pub ring: Ring,
    pub placings: Vec<Placing>,
}

/// The place in the file of a magnet.
pub(super) struct Placing {
    pub span: Span,
    /// Its distance behind the surface (m).
    pub inset: f64,
    /// Its strength as stated in the file.
    pub strength: Option<Strength>,
}

/// Builds a tile from the contents of its faces.
pub(super) fn build(entry: &TileEntry, contents: &[FaceContent]) -> Result<BuiltTile> {
    let faces = &entry.base.faces;
    let thickness = entry.thickness;
    let (ring, outline) = outline(entry, contents)?;
    let mass = check_mass(entry, outline.area() * thickness);
    let mut magnets = Vec::new();
    let mut placings = Vec::new();
    for (number, content) in contents.iter().enumerate() {
        let face = (number, &faces[number]);
        let edges = face_edges(&ring, face.1, number);
        let listed = placed(entry, content, face.1.length());
        for listed in listed.unwrap_or_default() {
            let magnet = magnet(entry, face, &edges, &listed);
            if let Ok(magnet) = magnet.and_then(|magnet| fits_in(entry, magnet, listed.span)) {
                magnets.push(magnet);
                placings.push(Placing {
                    span: listed.span,
                    inset: listed.keys.inset.unwrap_or(0.0),
                    strength: listed.keys.strength,
                });
            }
        }
    }
    entry.section.source.faults.check()?;
    let tile = Tile {
        outline,
        faces: faces.clone(),
        magnets,
        mass: mass?,
        thickness,
    };
    Ok(BuiltTile {
        tile,
        ring,
        placings,
    })
}

/// Refuses a magnet that is thicker than its tile.
fn fits_in(entry: &TileEntry, magnet: Magnet, span: Span) -> Result<Magnet> {
    if magnet.size[2] <= entry.thickness {
        return Ok(magnet);
    }
    let [magnet, tile] = [magnet.size[2], entry.thickness].map(|it| four_digits(1e3 * it));
    let message = format!("magnets {magnet} mm thick stick out of a tile {tile} mm thick");
    let source = entry.section.source;
    let help = format!(
        "make the tiles {magnet} mm thick or more (`thickness`), or use flatter magnets: the third number of \
         `size` is along the tile's thickness; for an upright magnet it is the one along its axis, for a disc \
         the diameter"
    );
    // Once for all magnets.
    match source.faults.named(&message) {
        Some(told) => Err(told),
        None => Err(source.error(span, message, help)),
    }
}

/// Density (kg/m^3) of the densest material, osmium.
const HIGHEST_DENSITY: f64 = 22_590.0;

/// Checks that the tile's mass (kg) does not make it denser than any material.
fn check_mass(entry: &TileEntry, volume: f64) -> Result<f64> {
    let (entry, mass) = entry
        .mass
        .ok_or_else(|| entry.section.error("no mass", ""))?;
    if mass > HIGHEST_DENSITY * volume {
        return Err(entry.error(
            format!(
                "`mass` = {mass} kg makes the tile denser than any material ({} kg/m^3): did you \
                 mean {} ({mass} g)?",
                four_digits(mass / volume),
                mass / 1000.0
            ),
            "masses are in kilograms",
        ));
    }
    Ok(mass)
}

/// Largest number of points of an outline: each is compared with every other.
const MOST_POINTS: usize = 10_000;

fn lines(contents: &[FaceContent]) -> Vec<FaceLine> {
    let line = |content: &FaceContent| FaceLine {
        polyline: content.polyline.clone(),
        arcs: content.arcs.clone(),
        fit: content.fit,
    };
    contents.iter().map(line).collect()
}

fn outline(entry: &TileEntry, contents: &[FaceContent]) -> Result<(Ring, Outline)> {
    let ring = assemble(&entry.base.faces, &lines(contents)).map_err(|FitTooLarge(face)| {
        entry.section.source.error(
            contents[face].fit_span,
            format!(
                "face {} cannot be drawn back by {} m: part of its line would vanish",
                entry.base.faces[face].name, contents[face].fit
            ),
            "reduce `fit`, or enlarge the details of the profile",
        )
    })?;
    let points = ring.points.len();
    if points > MOST_POINTS {
        return Err(entry.section.error(
            format!("the tile's outline has {points} points, more than {MOST_POINTS}"),
            "draw its faces with fewer points, or with fewer teeth",
        ));
    }
    match Outline::new(ring.points.clone()) {
        Ok(outline) => {
            let outline = outline.with_arcs(&ring.points, &ring.arcs);
            Ok((ring, outline))
        }
        Err(error) => Err(mend_outline(entry, contents, &ring, &error)),
    }
}

/// The fault of profiles that do not form a valid outline, at the profile to change.
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
            // The face with a profile is at fault, not its flat neighbour.
            let (culprit, other) = match contents[a].polyline.is_empty() {
                true => (b, a),
                false => (a, b),
            };
            let (message, help) = match a == b {
                true => (
                    format!("the profile of face {} crosses or touches itself", name(a)),
                    "list its points in their order along the line",
                ),
                false => (
                    format!(
                        "the profile of face {} crosses or touches face {}",
                        name(culprit),
                        name(other)
                    ),
                    "make it less deep, or move it away from the corners",
                ),
            };
            let help = match largest_depth(entry, contents, culprit) {
                Some(depth) => {
                    format!(
                        "make it less deep: `depth` can be at most {depth} m here (absolute \
                        value)"
                    )
                }
                None => help.to_owned(),
            };
            entry
                .section
                .source
                .error(contents[culprit].line_span, message, help)
        }
        _ => entry.section.error(
            format!("the profiles leave no outline: {error}"),
            "make the profiles less deep",
        ),
    }
}

/// The largest depth (m) that the profile of a face can have next to the others, rounded down;
/// `None` if no depth is valid.
fn largest_depth(entry: &TileEntry, contents: &[FaceContent], face: usize) -> Option<f64> {
    let mut profile = contents[face].profile.clone()?;
    let depth = *depth_of(&mut profile)?;
    let mut possible = |size: f64| {
        if let Some(changed) = depth_of(&mut profile) {
            *changed = size.copysign(depth);
        }
        let line = profile.polyline().ok();
        line.is_some_and(|line| {
            let mut lines = lines(contents);
            lines[face].polyline = line;
            lines[face].arcs.clear();
            let ring = assemble(&entry.base.faces, &lines);
            ring.is_ok_and(|ring| Outline::new(ring.points).is_ok())
        })
    };
    if !possible(0.0) {
        return None;
    }
    let [right, _] = bisected(0.0, depth.abs(), 24, &mut possible);
    let rounded = rounded_down(right);
    (right > SHALLOWEST * depth.abs() && possible(rounded)).then_some(rounded)
}
