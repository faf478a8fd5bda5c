//! The sheet for the workshop.

use crate::markdown::markdown_table;
use jobs::assembly::{Assembly, Axis};
use physics::units::si;

/// Which magnets on which face of which tile, and how many of each.
pub(super) fn sheet(assembly: &Assembly) -> String {
    let built = assembly.built;
    let (set, grown) = (&built.set, &built.grown);
    let counts = grown.counts(set.tiles.len());
    let magnet = assembly.magnet();
    let [length, width, thickness] = magnet.size.map(|x| (1e5 * x).round() / 100.0);
    let magnets = |tile: usize| -> usize {
        let faces = (0..4).filter_map(|side| built.face(tile, side));
        faces
            .map(|face| built.matrix.code(face).magnets() as usize)
            .sum()
    };
    let tiles: usize = counts.iter().sum();
    let all: usize = counts
        .iter()
        .enumerate()
        .map(|(tile, count)| count * magnets(tile))
        .sum();
    let mut text = format!(
        "# {}: to be made\n\n{tiles} tiles with {all} magnets of {length} x {width} x {thickness} mm \
         (magnetised along the first, {} each){}.\n\nTiles are squares of {} seen from above; a code is \
         read counter-clockwise along its face, N for a north pole out, S for a south pole, . for an \
         empty place, places {} apart, the middle of the code in the middle of the face. `tilebind make` \
         draws the tiles of any file in `designs/` for a cutter.\n\n## Tiles\n\n",
        set.name,
        si(magnet.moment, "A m2", 4),
        if grown.complete {
            ""
        } else {
            ", of which the assembly can have more: these are the first"
        },
        si(assembly.words.stage.pair.fixed.faces[0].length(), "m", 4),
        si(assembly.words.stage.pitch.unwrap_or_default(), "m", 4),
    );
    let head = [
        "tile",
        "how many",
        "magnets each",
        "north",
        "east",
        "south",
        "west",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for (number, tile) in set.tiles.iter().enumerate() {
        let face = |side| match built.face(number, side) {
            Some(face) => format!("{} {}", assembly.face(face), built.matrix.code(face)),
            None => "empty".to_owned(),
        };
        let mut row = vec![
            tile.name.clone(),
            counts[number].to_string(),
            magnets(number).to_string(),
        ];
        row.extend((0..4).map(face));
        rows.push(row);
    }
    text += &markdown_table(&rows);
    text += "\n## Words\n\n";
    let head = ["word", "code", "mate", "axis", "bond"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for (word, bond) in built.wiring.bonds.iter().enumerate() {
        let code = built.matrix.words[word];
        rows.push(vec![
            assembly.face(word),
            code.to_string(),
            code.mate().to_string(),
            match bond.axis {
                Axis::Horizontal => "word east, mate west",
                Axis::Vertical => "word north, mate south",
            }
            .to_owned(),
            si(built.matrix.bond(word), "J", 4),
        ]);
    }
    text + &markdown_table(&rows)
}
