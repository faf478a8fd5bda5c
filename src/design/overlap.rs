//! Overlaps that a design must not have: of magnets with each other and with the tile's rim.

use super::DesignError;
use super::quantity::four_digits;
use super::reader::{Result, Section};
use super::tile::BuiltTile;
use crate::contact::separation;
use crate::tile::outline::ConvexPart;

/// Depth (m) up to which blocks may overlap or stick out: rounding.
const ROUNDING: f64 = 1e-9;

/// Refuses magnets that overlap or stick out of the tile; what only breaks through the surface
/// with the corners of its outer pole face is returned as a warning.
pub(super) fn check_magnets(section: &Section, built: &BuiltTile) -> Result<Vec<DesignError>> {
    let magnets = &built.tile.magnets;
    let blocks: Vec<_> = magnets
        .iter()
        .map(|magnet| ConvexPart::new(magnet.corners().to_vec()))
        .collect();
    let face = |i: usize| &built.tile.faces[magnets[i].face].name;
    let mut warnings = Vec::new();
    for (i, magnet) in magnets.iter().enumerate() {
        let normal = built.tile.faces[magnet.face].normal();
        let height = |p: &nalgebra::Vector2<f64>| normal.dot(&(p - magnet.position));
        let outside = |p: nalgebra::Vector2<f64>| built.tile.outline.signed_distance(p) > ROUNDING;
        // The block's inner half and its middle line must lie in the tile.
        let mut inner: Vec<_> = magnet
            .corners()
            .into_iter()
            .filter(|p| height(p) <= 0.0)
            .collect();
        inner.push(magnet.position);
        if inner.into_iter().any(outside) {
            return Err(section.error_at(
                built.magnet_spans[i],
                format!("a magnet of face {} sticks out of the tile", face(i)),
                "move it inwards (`inset`), away from the corner, or take a smaller one",
            ));
        }
        if let Some(j) = (0..i).find(|&j| separation(&blocks[i], &blocks[j]) < -ROUNDING) {
            return Err(section.error_at(
                built.magnet_spans[i],
                format!(
                    "a magnet of face {} overlaps one of face {}",
                    face(i),
                    face(j)
                ),
                "space them out (`pitch`), or take smaller magnets (`size`)",
            ));
        }
        let worst = magnet
            .corners()
            .into_iter()
            .map(|p| built.tile.outline.signed_distance(p))
            .fold(0.0, f64::max);
        if worst > ROUNDING {
            warnings.push(section.error_at(
                built.magnet_spans[i],
                format!(
                    "a corner of a magnet of face {} breaks through the surface by {} mm",
                    face(i),
                    four_digits(worst * 1e3)
                ),
                "raise `inset`, or turn the magnet with the surface (`axis`)",
            ));
        }
    }
    Ok(warnings)
}
