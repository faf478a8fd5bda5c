//! The two tiles that carry the words of a file.

use std::sync::Arc;

use super::error::{DesignError, Result};
use super::magnet::{AxisDirection, MagnetKeys, Size};
use super::{Design, MagnetModel, written};
use physics::tile::Tile;
use physics::tile::magnet::{Form, Standing};
use physics::tile::strength::Strength;
use physics::words::Bar;

/// The magnets of words: those of a file, or by default the paper's.
pub(super) fn bar(keys: MagnetKeys, model: MagnetModel) -> std::result::Result<Bar, &'static str> {
    let paper = Bar::paper();
    let keys = MagnetKeys {
        size: keys.size.or(Some(Size::Block(paper.size))),
        strength: keys.strength.or(Some(Strength::Remanence(1.2))),
        ..keys
    };
    let body = keys.body()?;
    let stands = (keys.axis == Some(AxisDirection::Up)).then_some(Standing::Up);
    Ok(Bar {
        size: body.in_plane(stands.is_some()),
        moment: body.moment,
        form: Form {
            shape: body.shape,
            stands,
        },
        inset: keys.inset.unwrap_or(0.0),
        pitch: keys.pitch.unwrap_or(paper.pitch),
        model,
    })
}

/// Two tiles of a side (m) with a magnet at each place (m) of their target faces.
pub(super) fn stage(bar: &Bar, side: f64, places: &[f64], name: &str) -> Result<Design> {
    let Bar {
        size,
        moment,
        form,
        inset,
        pitch,
        model,
    } = bar;
    let (table, model) = (8.0 * side, model.name());
    let pole = if form.stands.is_some() { 'U' } else { 'N' };
    let tile = |tile: &str, face: &str| {
        format!(
            "[{tile}]\nside = {side:?}\nthickness = 0.013\nmass = 0.1\n[{tile}.faces]\n{face} = {{ \
             code = \"{pole}\" }}\n"
        )
    };
    let text = format!(
        "name = \"words\"\n[table]\nsize = [{table:?}, {table:?}]\n[magnet]\n{}\
         moment = {moment:?}\npitch = {pitch:?}\ninset = {inset:?}\n{}{}[target]\nfixed = \"east\"\n\
         moving = \"west\"\n[potential]\nmodel = \"{model}\"\n",
        written::magnet(*form, *size),
        tile("fixed", "east"),
        tile("moving", "west")
    );
    // Faults of the magnets or the tile are reported for the design made of them.
    let mut stage = Design::parse(&text, name).map_err(|found| DesignError {
        place: None,
        ..found
    })?;
    let (fixed, moving) = stage.pair.target;
    let pair = Arc::make_mut(&mut stage.pair);
    fill(&mut pair.fixed, fixed, places);
    fill(&mut pair.moving, moving, places);
    Ok(stage)
}

/// Places a copy of a face's middle magnet at every place (m): slots may be narrower than magnets.
fn fill(tile: &mut Tile, face: usize, places: &[f64]) {
    let along = tile.faces[face].tangent();
    let magnet = |at: &f64| {
        let mut magnet = tile.magnets[0].clone();
        magnet.position += along * *at;
        magnet
    };
    tile.magnets = places.iter().map(magnet).collect();
}
