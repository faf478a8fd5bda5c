//! Magnets where none can be: in one another, or out of the tile.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use super::DesignError;
use super::build::BuiltTile;
use super::quantity::four_digits;
use super::reader::{Result, Section};
use super::tile::TileEntry;
use crate::contact::{Placement, separation};
use crate::tile::assembly::{face_edges, surface_height};
use crate::tile::outline::ConvexPart;
use crate::tile::{Face, Magnet};

/// Depth (m) up to which blocks may overlap or stick out: rounding.
const ROUNDING: f64 = 1e-9;

/// Refuses magnets that overlap or stick out of the tile.
///
/// A block in a straight face never leaves the tile, but on a curved or slanted line a corner of
/// its outer pole face may break through the surface while the block as a whole sits in the tile.
/// That is a matter of a millimetre of inset and changes no energy, so it is returned as a
/// warning, one for each face. So is a tile without any magnet.
pub(super) fn check_magnets(entry: &TileEntry, built: &BuiltTile) -> Result<Vec<DesignError>> {
    let section = &entry.section;
    let magnets = &built.tile.magnets;
    let blocks: Vec<_> = magnets
        .iter()
        .map(|magnet| ConvexPart::new(magnet.corners().to_vec()))
        .collect();
    let name = |i: usize| &built.tile.faces[magnets[i].face].name;
    for (i, magnet) in magnets.iter().enumerate() {
        if sticks_out(built, magnet) {
            return Err(section.error_at(
                built.magnet_spans[i],
                format!("a magnet of face {} sticks out of the tile", name(i)),
                "raise `inset`, move it away from corners and steps, or take a smaller magnet",
            ));
        }
        if let Some(j) =
            (0..i).find(|&j| separation(&blocks[i], &blocks[j], &Placement::none()) < -ROUNDING)
        {
            return Err(section.error_at(
                built.magnet_spans[i],
                format!(
                    "a magnet of face {} overlaps one of face {}",
                    name(i),
                    name(j)
                ),
                "space them out (`pitch`, `at`), or take smaller magnets (`size`)",
            ));
        }
    }
    if magnets.is_empty() {
        let message = format!(
            "the {} tile has no magnet, so that the energy is zero",
            entry.name
        );
        return Ok(vec![section.error(message, "give one of its faces a code")]);
    }
    let faces = 0..built.tile.faces.len();
    Ok(faces
        .filter_map(|face| breakthrough(section, built, face))
        .collect())
}

/// Whether a block's centre, a corner of its inner half, or a corner beyond the ends of its face
/// lies outside the tile.
fn sticks_out(built: &BuiltTile, magnet: &Magnet) -> bool {
    let face = &built.tile.faces[magnet.face];
    let beyond_its_face = |p: &Vector2<f64>| {
        (p - face.middle()).dot(&face.tangent()).abs() > face.length() / 2.0 + ROUNDING
    };
    let in_the_inner_half =
        |p: &Vector2<f64>| (p - magnet.position).dot(&face.normal()) <= ROUNDING;
    magnet
        .corners()
        .into_iter()
        .filter(|p| beyond_its_face(p) || in_the_inner_half(p))
        .chain([magnet.position])
        .any(|p| built.tile.outline.signed_distance(p) > ROUNDING)
}

/// The warning for the magnet of a face that breaks through its surface farthest, if one does.
fn breakthrough(section: &Section, built: &BuiltTile, number: usize) -> Option<DesignError> {
    let face = &built.tile.faces[number];
    let edges = face_edges(&built.ring, face, number);
    let (i, excess) = built
        .tile
        .magnets
        .iter()
        .enumerate()
        .filter(|(_, magnet)| magnet.face == number)
        .map(|(i, magnet)| (i, excess(&edges, face, magnet)))
        .max_by_key(|(_, excess)| OrderedFloat(*excess))?;
    (excess > ROUNDING).then(|| {
        section.error_at(
            built.magnet_spans[i],
            format!(
                "a corner of a magnet of face {} breaks through the surface, by {} mm",
                face.name,
                four_digits(excess * 1e3)
            ),
            format!("raise `inset` by {} m", four_digits(excess)),
        )
    })
}

/// By how much (m, along the face's normal) the highest corner of a block overtops the lowest
/// surface over the block's width.
fn excess(edges: &[[[f64; 2]; 2]], face: &Face, magnet: &Magnet) -> f64 {
    let local = magnet.corners().map(|p| {
        let d = p - face.middle();
        [d.dot(&face.tangent()), d.dot(&face.normal())]
    });
    let fold =
        |k: usize, start: f64, f: fn(f64, f64) -> f64| local.iter().map(|p| p[k]).fold(start, f);
    let (low, high) = (
        fold(0, f64::INFINITY, f64::min),
        fold(0, f64::NEG_INFINITY, f64::max),
    );
    let corners_between = edges
        .iter()
        .map(|[a, _]| a[0])
        .filter(|s| (low..=high).contains(s));
    let lowest = corners_between
        .chain([low, high])
        .filter_map(|s| surface_height(edges, s))
        .fold(f64::INFINITY, f64::min);
    fold(1, f64::NEG_INFINITY, f64::max) - lowest
}
