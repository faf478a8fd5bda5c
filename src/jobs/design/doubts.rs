//! Warnings: entries that are usable but may be meant otherwise.

use super::DesignError;
use super::build::BuiltTile;
use super::face::FaceContent;
use super::quantity::{self, four_digits};
use super::reader::Section;
use super::tile::{TileEntry, nearly_mates};
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

/// Densities (kg/m^3) of tiles that occur: from foam to brass. Plastic foam has 20 or more, and the paper's
/// hollow tile 42.
const DENSITIES: [f64; 2] = [20.0, 9e3];
/// Density (kg/m^3) of the lightest magnets, of ferrite.
const LIGHTEST_MAGNETS: f64 = 4.5e3;

/// Warns of tiles that are lighter or heavier than any usual material, or lighter than their magnets.
pub(super) fn masses(entries: &[TileEntry; 2], built: &[BuiltTile; 2]) -> Vec<DesignError> {
    let each = entries.iter().zip(built);
    let doubts = each.filter_map(|(entry, built)| implausible(entry, &built.tile));
    doubts.collect()
}

fn implausible(entry: &TileEntry, tile: &Tile) -> Option<DesignError> {
    let (key, mass) = entry.mass.as_ref()?;
    let volume = tile.outline.area() * tile.thickness;
    let density = mass / volume;
    let volumes = tile.magnets.iter().map(|it| it.form.shape.volume(it.size));
    let magnets: f64 = LIGHTEST_MAGNETS * volumes.sum::<f64>();
    let grams = |mass: f64| four_digits(1e3 * mass);
    let usual = |density: f64| grams(density * volume);
    let per_volume = four_digits(density / 1e3);
    let message = match () {
        () if *mass < magnets => format!(
            "the {} tile weighs {} g, less than its magnets (about {} g)",
            entry.name,
            grams(*mass),
            grams(magnets)
        ),
        () if density < DENSITIES[0] => format!(
            "the {} tile weighs {} g: {per_volume} g/cm3, lighter than foam",
            entry.name,
            grams(*mass)
        ),
        () if density > DENSITIES[1] => format!(
            "the {} tile weighs {} g: {per_volume} g/cm3, heavier than brass",
            entry.name,
            grams(*mass)
        ),
        () => return None,
    };
    Some(entry.section.source.doubt(
        key.span(),
        message,
        format!(
            "a full tile of plywood would weigh {} g, one of acrylic {} g; masses are in kg, or write \"20 gram\"",
            usual(600.0),
            usual(1190.0)
        ),
    ))
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
