//! Warnings: entries that are usable but may be meant otherwise.

use super::DesignError;
use super::build::BuiltTile;
use super::face::FaceContent;
use super::quantity::{self, four_digits};
use super::reader::Section;
use super::tile::{TileEntry, nearly_mates};
use super::weight::Weight;
use physics::tile::Tile;

/// Warnings about a valid design: an enormous table, a fit larger than the shape's depth.
pub(super) fn find(
    root: &Section,
    entries: &[TileEntry; 2],
    contents: &[Vec<FaceContent>; 2],
    table: [f64; 2],
) -> Vec<DesignError> {
    let fits = entries.iter().zip(contents).flat_map(|(entry, contents)| {
        let faces = entry.base.faces.iter().zip(contents);
        faces.filter_map(|(face, content)| loose(entry, &face.name, content))
    });
    let doubts = enormous(root, table).into_iter().chain(fits);
    doubts.chain(nearly_mates(entries)).collect()
}

/// Warns of tiles that are lighter or heavier than any usual material, or lighter than their magnets.
pub(super) fn masses(entries: &[TileEntry; 2], built: &[BuiltTile; 2]) -> Vec<DesignError> {
    let each = entries.iter().zip(built);
    let doubts = each.filter_map(|(entry, built)| implausible(entry, &built.tile));
    doubts.collect()
}

fn implausible(entry: &TileEntry, tile: &Tile) -> Option<DesignError> {
    let (key, _) = entry.mass.as_ref()?;
    let weight = Weight::of(tile);
    let message = format!("the {} tile {}", entry.name, weight.doubt()?);
    let help = format!("{}; masses are in kg, or write \"20 gram\"", weight.usual());
    Some(entry.section.source.doubt(key.span(), message, help))
}

/// Warns of a table so large that another unit may have been meant.
fn enormous(root: &Section, table: [f64; 2]) -> Option<DesignError> {
    let [x, y] = table;
    let proposals = quantity::TABLE_SIZE.doubt(x.max(y))?;
    let size = root.section("table", "[table]").ok()??.get("size")?;
    let meant = match proposals.as_slice() {
        [] => String::new(),
        some => format!(": did you mean {}?", some.join(" or ")),
    };
    Some(size.source.doubt(
        size.span(),
        format!("the table measures {x} m by {y} m{meant}"),
        "lengths are in metres; far starts and the roadmap use the whole table",
    ))
}

/// Warns of a face drawn back by as much as its profile is deep: nothing can interlock.
fn loose(entry: &TileEntry, face: &str, content: &FaceContent) -> Option<DesignError> {
    let heights = content.polyline.iter().map(|p| p[1].abs());
    let depth = heights.fold(0.0, f64::max);
    (content.fit > 0.0 && depth > 0.0 && content.fit >= depth).then(|| {
        entry.section.source.doubt(
            content.fit_span,
            format!(
                "`fit` = {} m draws face {face} back by the full depth of its shape, {} m, so it \
                 no longer guides",
                content.fit,
                four_digits(depth)
            ),
            "a usual clearance is a few tenths of a millimetre: fit = 0.0005",
        )
    })
}
