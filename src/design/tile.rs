//! The sections `[fixed]` and `[moving]`: from their keys to tiles.

use nalgebra::Vector2;

use super::DesignError;
use super::base::{self, Base};
use super::error::Span;
use super::face::{FaceContent, FaceEntry, Pattern, find_face};
use super::magnet::{ListedMagnet, MagnetKeys, impossible, missing_key};
use super::quantity::{self, four_digits};
use super::reader::{Entry, Result, Section};
use crate::tile::assembly::{FaceLine, FitTooLarge, Ring, assemble, face_edges, surface_height};
use crate::tile::barcode::Pole;
use crate::tile::outline::{Outline, OutlineError};
use crate::tile::{Face, Magnet, Tile};

/// The two tiles' names, in the order in which they are stored.
pub(super) const TILES: [&str; 2] = ["fixed", "moving"];

const TILE_KEYS: [&str; 7] = [
    "side",
    "sides",
    "vertices",
    "thickness",
    "mass",
    "faces",
    "shield",
];

/// What the file says of one tile.
pub(super) struct TileEntry<'a> {
    pub section: Section<'a>,
    pub base: Base,
    faces: Vec<FaceEntry<'a>>,
}

impl<'a> TileEntry<'a> {
    pub fn read(section: Section<'a>, faces_name: &'a str) -> Result<Self> {
        section.allow(&TILE_KEYS)?;
        if let Some(shield) = section.get("shield") {
            return Err(super::shield::refused(&shield));
        }
        let base = base::read(&section)?;
        let faces = match section.section("faces", faces_name)? {
            Some(faces) => face_entries(&faces, &base)?,
            None => vec![FaceEntry::new(None, None)?; base.faces.len()],
        };
        Ok(Self {
            section,
            base,
            faces,
        })
    }
}

/// Sorts the entries of `[*.faces]` by the faces that they speak of.
fn face_entries<'a>(section: &Section<'a>, base: &Base) -> Result<Vec<FaceEntry<'a>>> {
    let mut known = vec!["all"];
    known.extend(base.names.iter().flatten().map(String::as_str));
    section.allow(&known)?;
    let all = section.section("all", "`all`")?;
    let entries: Vec<Entry<'a>> = section.entries();
    base.names
        .iter()
        .map(|names| {
            let named: Vec<_> = entries
                .iter()
                .filter(|entry| names.iter().any(|name| name == entry.key))
                .collect();
            if let [first, second, ..] = named.as_slice() {
                return Err(second.key_error(
                    format!("`{}` and `{}` are the same face", first.key, second.key),
                    "keep one of the two",
                ));
            }
            let own = named
                .first()
                .map(|entry| entry.section(entry.key))
                .transpose()?;
            FaceEntry::new(own, all)
        })
        .collect()
}

/// The content of every face of both tiles; mates are followed to the face that they copy.
pub(super) fn resolve(tiles: &[TileEntry; 2], keys: MagnetKeys) -> Result<[Vec<FaceContent>; 2]> {
    let contents = |tile: usize| {
        (0..tiles[tile].faces.len())
            .map(|face| resolve_face(tiles, keys, (tile, face), &mut Vec::new()))
            .collect::<Result<Vec<_>>>()
    };
    Ok([contents(0)?, contents(1)?])
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
        return entry.content(base.length(), keys, tiles[tile].section.span());
    };
    let other = 1 - tile;
    let partner = find_face(&tiles[other].base.names, &mates, TILES[other])?;
    on_the_way.push((tile, face));
    if on_the_way.contains(&(other, partner)) {
        return Err(mates.error(
            format!(
                "{} mates {}, which in the end mates {} again",
                name(tiles, (tile, face)),
                name(tiles, (other, partner)),
                name(tiles, (tile, face))
            ),
            "give one of these faces a code and a profile of its own",
        ));
    }
    let partner_length = tiles[other].base.faces[partner].length();
    if !same_length(base.length(), partner_length) {
        return Err(mates.error(
            format!(
                "a face of {} m cannot mate a face of {} m",
                four_digits(base.length()),
                four_digits(partner_length)
            ),
            "mates need faces of equal length",
        ));
    }
    let partner = resolve_face(tiles, keys, (other, partner), on_the_way)?;
    entry.mate_of(&partner, &mates)
}

fn name(tiles: &[TileEntry; 2], (tile, face): (usize, usize)) -> String {
    format!("{}.{}", TILES[tile], tiles[tile].base.faces[face].name)
}

/// Whether two lengths are the same but for rounding.
pub(super) fn same_length(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.max(b)
}

/// A tile, and for each of its magnets the place in the file that puts it there.
pub(super) struct BuiltTile {
    pub tile: Tile,
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
    Ok(BuiltTile { tile, magnet_spans })
}

fn thickness(section: &Section) -> Result<f64> {
    section
        .require(
            "thickness",
            "say how thick the tile is: thickness = 0.013 (m)",
        )?
        .number(quantity::TILE_THICKNESS)
}

/// Density (kg/m^3) of the densest stuff there is, osmium.
const HIGHEST_DENSITY: f64 = 22_590.0;

fn mass(section: &Section, volume: f64) -> Result<f64> {
    let entry = section.require("mass", "say how heavy the tile is: mass = 0.1 (kg)")?;
    let mass = entry.number(quantity::MASS)?;
    if mass > HIGHEST_DENSITY * volume {
        return Err(entry.error(
            format!(
                "`mass` = {mass} kg makes the tile denser than any stuff ({} kg/m^3): did you mean {} ({mass} g)?",
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
            contents[face].line_span,
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

/// The magnets of a face with all that they take from the keys above them.
fn placed(entry: &TileEntry, content: &FaceContent, length: f64) -> Result<Vec<ListedMagnet>> {
    match &content.pattern {
        Pattern::List(magnets) => Ok(magnets
            .iter()
            .map(|magnet| ListedMagnet {
                keys: magnet.keys.over(content.keys),
                ..*magnet
            })
            .collect()),
        Pattern::Code(code, spans) => {
            let pitch = match content.keys.pitch {
                Some(pitch) => pitch,
                None if code.len() < 2 => 0.0,
                None => {
                    return Err(missing_key("pitch", |message, help| {
                        entry.section.error_at(content.pattern_span, message, help)
                    }));
                }
            };
            let wide = content.keys.size.map_or(0.0, |size| size[1]);
            let needed = code.len().saturating_sub(1) as f64 * pitch + wide;
            if needed > length * (1.0 + 1e-12) {
                return Err(entry.section.error_at(
                    content.pattern_span,
                    format!(
                        "the code {code} is {} m long, its face {} m",
                        four_digits(needed),
                        four_digits(length)
                    ),
                    format!(
                        "at a pitch of {pitch} m there is room for {} magnets",
                        ((length - wide) / pitch).floor().max(-1.0) + 1.0
                    ),
                ));
            }
            Ok(code
                .places(pitch)
                .map(|(k, at, pole)| ListedMagnet {
                    at,
                    pole,
                    keys: content.keys,
                    span: spans[k],
                })
                .collect())
        }
    }
}

/// A magnet in the tile's frame: its outermost point `inset` behind the surface at its s.
fn magnet(
    entry: &TileEntry,
    (number, face): (usize, &Face),
    edges: &[[[f64; 2]; 2]],
    listed: &ListedMagnet,
) -> Result<Magnet> {
    let error = |message: String, help: String| entry.section.error_at(listed.span, message, help);
    let (size, moment) = listed.keys.block().map_err(|key| missing_key(key, error))?;
    if let Some((message, help)) = impossible(size, moment) {
        return Err(error(message, help));
    }
    let Some(surface) = surface_height(edges, listed.at) else {
        return Err(error(
            format!(
                "a magnet at s = {} sits beyond the end of face {}",
                four_digits(listed.at),
                face.name
            ),
            format!(
                "s runs from {} to {} m",
                four_digits(-face.length() / 2.0),
                four_digits(face.length() / 2.0)
            ),
        ));
    };
    let axis = listed.keys.axis.unwrap_or(0.0);
    // How far the block reaches from its centre towards the surface.
    let reach = (size[0] * axis.cos().abs() + size[1] * axis.sin().abs()) / 2.0;
    let height = surface - listed.keys.inset.unwrap_or(0.0) - reach;
    let outward = match listed.pole {
        Pole::North => face.normal(),
        Pole::South => -face.normal(),
    };
    Ok(Magnet {
        position: face.point(listed.at, height),
        angle: direction(outward, axis),
        moment,
        size,
        face: number,
    })
}

/// The angle (rad) of a vector turned by `turn`.
fn direction(vector: Vector2<f64>, turn: f64) -> f64 {
    // Adding zero turns -0 into 0, so that west is pi and never -pi.
    crate::configuration::wrap_angle((vector.y + 0.0).atan2(vector.x + 0.0) + turn)
}
