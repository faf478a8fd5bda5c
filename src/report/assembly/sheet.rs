//! The workshop sheet.

use crate::document::rows;
use crate::markdown::markdown_table;
use jobs::assembly::{Assembly, MeetingAxis, TileType};
use physics::tile::magnet::Shape;
use physics::units::si;

/// The sheet: which magnets on which face of which tile, and how many of each.
pub(super) fn sheet(assembly: &Assembly) -> String {
    let built = &assembly.built;
    let set = &built.set;
    let counts = assembly.counts();
    let magnet = assembly.magnet();
    let [length, width, thickness] = magnet.axis_first().map(|x| (1e5 * x).round() / 100.0);
    let bought = match magnet.form.shape {
        Shape::Block => {
            format!("of {length} x {width} x {thickness} mm (magnetised along the first")
        }
        Shape::Disc => format!("(discs of {width} mm and {length} mm high"),
    };
    let letters = match magnet.form.stands {
        Some(_) => "U for a north pole up, D for a south pole up",
        None => "N for a north pole out, S for a south pole",
    };
    let magnets = |tile: usize| -> usize {
        let faces = (0..4).filter_map(|side| built.face(tile, side));
        let magnets = faces.map(|face| built.matrix.code(face).magnets() as usize);
        magnets.sum()
    };
    let tiles: usize = counts.iter().sum();
    let all = counts.iter().enumerate();
    let all: usize = all.map(|(tile, count)| count * magnets(tile)).sum();
    let text = format!(
        "# {}: to be made\n\n{tiles} tiles with {all} magnets {bought}, {} each){}.\n\nTiles are \
         squares of {}, seen from above. A code is read counter-clockwise along its face: \
         {letters}, . for an empty position. Positions are {} apart, and the middle of the code \
         is in the middle of the face. `tilebind make` draws the tiles of any file in `designs/` \
         for a laser cutter.\n\n## Tiles\n\n",
        set.name,
        si(magnet.moment, "A m2", 4),
        match assembly.growing.is_none() || built.grown.complete {
            true => "",
            false => ", of which the assembly can need more; these are the first",
        },
        si(assembly.words.stage.pair.fixed.faces[0].length(), "m", 4),
        si(assembly.words.stage.pitch.unwrap_or_default(), "m", 4),
    );
    let face = |side| {
        move |(number, _): &(usize, &TileType)| match built.face(*number, side) {
            Some(face) => format!("{} {}", assembly.face(face), built.matrix.code(face)),
            None => "empty".to_owned(),
        }
    };
    let tiles = rows(set.tiles.iter().enumerate())
        .shown("tile", "", |it: &(usize, &TileType)| it.1.name.clone())
        .shown("how many", "", |it| counts[it.0])
        .shown("magnets per tile", "", |it| magnets(it.0))
        .shown("north", "", face(0))
        .shown("east", "", face(1))
        .shown("south", "", face(2))
        .shown("west", "", face(3));
    let code = |word: usize| built.matrix.words[word];
    let axis = |axis: MeetingAxis| match axis {
        MeetingAxis::Horizontal => "word east, mate west",
        MeetingAxis::Vertical => "word north, mate south",
    };
    let words = rows(built.wiring.bonds.iter().enumerate())
        .shown("word", "", |it| assembly.face(it.0))
        .shown("code", "", |it| code(it.0).to_string())
        .shown("mate", "", |it| code(it.0).mate().to_string())
        .shown("axis", "", |it| axis(it.1.axis))
        .shown("bond", "", |it| si(built.matrix.bond(it.0), "J", 4));
    let [tiles, words] = [tiles.table("tiles"), words.table("words")];
    let [tiles, words] = [tiles, words].map(|table| markdown_table(&table.texts()));
    text + &tiles + "\n## Words\n\n" + &words
}
