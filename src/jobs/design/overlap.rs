//! Impossible placements: magnets that overlap each other or leave the tile.

use ordered_float::OrderedFloat;

use super::DesignError;
use super::blocks::{ROUNDING, block, excess, sticks_out};
use super::build::BuiltTile;
use super::error::Result;
use super::inset;
use super::quantity::four_digits;
use super::reader::Section;
use super::tile::TileEntry;
use physics::contact::{Placement, separation};
use physics::tile::Magnet;
use physics::tile::assembly::face_edges;

/// Rejects magnets that overlap or stick out of their tile.
///
/// A block in a straight face never leaves the tile, but on a curved or slanted line a corner of
/// its outer pole face may break through the surface although the block as a whole is inside the
/// tile. A millimetre of inset fixes this and no energy depends on it, so it is returned as a
/// warning, one for each face. A tile without any magnet also gives a warning.
pub(super) fn check_magnets(
    entries: &[TileEntry; 2],
    built: &[BuiltTile; 2],
) -> Result<Vec<DesignError>> {
    for tile in [0, 1] {
        outside(&entries[tile].section, built, tile);
        overlaps(&entries[tile], &built[tile]);
    }
    entries[0].section.source.faults.check()?;
    let doubts = [0, 1].map(|tile| doubts(&entries[tile], built, tile));
    Ok(doubts.into_iter().flatten().collect())
}

/// Notes the first magnet of each face that sticks out of its tile.
fn outside(section: &Section, built: &[BuiltTile; 2], tile: usize) {
    let BuiltTile { tile: it, .. } = &built[tile];
    for (face, name) in it.faces.iter().map(|face| &face.name).enumerate() {
        let mut of_face = (0..it.magnets.len()).filter(|&i| it.magnets[i].face == face);
        let Some(i) = of_face.find(|&i| sticks_out(&built[tile], &it.magnets[i])) else {
            continue;
        };
        let placing = &built[tile].placings[i];
        let help = inset::fix(built, placing.inset).unwrap_or_else(|| {
            "move it away from corners and steps, use a smaller magnet, or change `inset`"
                .to_owned()
        });
        let message = format!("a magnet of face {name} sticks out of the tile");
        section.source.error(placing.span, message, help);
    }
}

/// Notes the first two magnets of each two faces that overlap.
fn overlaps(entry: &TileEntry, built: &BuiltTile) {
    let magnets = &built.tile.magnets;
    let blocks: Vec<_> = magnets.iter().map(block).collect();
    // The index of a magnet on its face, counter-clockwise from 1.
    let name = |i: usize| {
        let face = magnets[i].face;
        let number = magnets[..=i].iter().filter(|m| m.face == face).count();
        format!("magnet {number} of face {}", built.tile.faces[face].name)
    };
    let mut told = Vec::new();
    for i in 0..magnets.len() {
        for j in 0..i {
            let depth = -separation(&blocks[i], &blocks[j], &Placement::none());
            let faces = (magnets[i].face, magnets[j].face);
            if depth <= ROUNDING || told.contains(&faces) {
                continue;
            }
            told.push(faces);
            let message = format!(
                "in the {} tile {} overlaps {} by {} mm",
                entry.name,
                name(i),
                name(j),
                four_digits(depth * 1e3)
            );
            let more = (depth * 1e4 - 1e-6).ceil() / 10.0;
            let help = advice(built, [i, j], more);
            let span = built.placings[i].span;
            entry.section.source.error(span, message, help);
        }
    }
}

/// How to separate two magnets that overlap, by this many millimetres.
fn advice(built: &BuiltTile, [i, j]: [usize; 2], more: f64) -> String {
    let [first, second] = [i, j].map(|k| &built.tile.magnets[k]);
    if first.face == second.face {
        return format!(
            "space them out by {more} mm or more (`pitch`, `at`), or use smaller magnets (`size`)"
        );
    }
    // Magnets of two faces are apart if both are nearer to the middles of their faces.
    let inwards = |magnet: &Magnet| {
        let face = &built.tile.faces[magnet.face];
        let s = (magnet.position - face.middle()).dot(&face.tangent());
        let by = (1e-3 * more).min(s.abs());
        let moved = Magnet {
            position: magnet.position - face.tangent() * by.copysign(s),
            ..magnet.clone()
        };
        (s.abs(), moved)
    };
    let [(s, a), (_, b)] = [inwards(first), inwards(second)];
    if separation(&block(&a), &block(&b), &Placement::none()) >= -ROUNDING {
        let percent = (more / s - 1e-6).ceil() / 10.0;
        return format!(
            "move them {more} mm or more away from the corner, towards the middles of their faces: a \
             `pitch` at least {percent:.1} % smaller, or `at`; or use smaller magnets (`size`)"
        );
    }
    format!(
        "the faces are too near to each other: use magnets at least {more} mm thinner (`size`), a \
         smaller `inset`, or a larger tile"
    )
}

fn doubts(entry: &TileEntry, built: &[BuiltTile; 2], tile: usize) -> Vec<DesignError> {
    let it = &built[tile];
    if it.tile.magnets.is_empty() {
        let name = entry.name;
        let message = format!("the {name} tile has no magnets, so the energy is zero");
        let help = "give one of its faces a code";
        return vec![
            entry
                .section
                .source
                .doubt(entry.section.span, message, help),
        ];
    }
    let faces = 0..it.tile.faces.len();
    faces
        .filter_map(|face| breakthrough(&entry.section, built, (tile, face)))
        .collect()
}

/// The warning for the magnet of a face that breaks through its surface farthest, if one does.
fn breakthrough(
    section: &Section,
    both: &[BuiltTile; 2],
    (tile, number): (usize, usize),
) -> Option<DesignError> {
    let built = &both[tile];
    let face = &built.tile.faces[number];
    let edges = face_edges(&built.ring, face, number);
    let magnets = built.tile.magnets.iter().enumerate();
    let (i, excess) = magnets
        .filter(|(_, magnet)| magnet.face == number)
        .map(|(i, magnet)| (i, excess(&edges, face, magnet)))
        .max_by_key(|(_, excess)| OrderedFloat(*excess))?;
    (excess > ROUNDING).then(|| {
        let placing = &built.placings[i];
        section.source.doubt(
            placing.span,
            format!(
                "a corner of a magnet of face {} breaks through the surface, by {} mm",
                face.name,
                four_digits(excess * 1e3)
            ),
            inset::fix(both, placing.inset)
                .unwrap_or_else(|| format!("raise `inset` by {} m", four_digits(excess + 5e-7))),
        )
    })
}
