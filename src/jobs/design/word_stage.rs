//! The entries of a file of words, and the two tiles that carry the words.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;

use serde::Deserialize;

use super::word_places::MagnetAt;
use super::{Design, DesignError, MagnetModel};
use physics::tile::{Magnet, Tile};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Entries {
    #[allow(dead_code)]
    pub name: Option<String>,
    #[allow(dead_code)]
    pub description: Option<String>,
    pub words: Option<Vec<String>>,
    #[serde(default)]
    pub magnet: MagnetEntry,
    #[serde(default)]
    pub tile: TileEntry,
    #[serde(default)]
    pub potential: PotentialEntry,
    #[serde(default)]
    pub faces: BTreeMap<String, FaceEntry>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MagnetEntry {
    pub size: Option<[f64; 3]>,
    pub remanence: Option<f64>,
    pub moment: Option<f64>,
    pub surface_field: Option<f64>,
    pub pitch: Option<f64>,
    pub inset: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TileEntry {
    pub side: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PotentialEntry {
    pub model: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FaceEntry {
    pub code: Option<String>,
    pub magnets: Option<Vec<MagnetAt>>,
}

/// The paper's magnets.
pub(super) const PITCH: f64 = 0.040;
pub(super) const SIZE: [f64; 3] = [0.010, 0.010, 0.003];

/// Two tiles of a side (m) with a magnet at each place (m) of their target faces.
pub(super) fn stage(
    entries: &Entries,
    side: f64,
    model: Option<MagnetModel>,
    places: &[f64],
    name: &str,
) -> Result<Design, DesignError> {
    let design = stage_text(entries, side, model);
    // What is wrong with magnets or tile is told of the design made of them.
    let mut stage = Design::parse(&design, name).map_err(|found| DesignError {
        place: None,
        ..found
    })?;
    let (fixed, moving) = stage.pair.target;
    let pair = Arc::make_mut(&mut stage.pair);
    fill(&mut pair.fixed, fixed, places);
    fill(&mut pair.moving, moving, places);
    Ok(stage)
}

/// Puts a magnet like the one in a face's middle at every place (m): slots may be narrower than
/// magnets.
fn fill(tile: &mut Tile, face: usize, places: &[f64]) {
    let Some(middle) = tile.magnets.first().cloned() else {
        return;
    };
    let along = tile.faces[face].tangent();
    let magnet = |at: &f64| Magnet {
        position: middle.position + along * *at,
        ..middle.clone()
    };
    tile.magnets = places.iter().map(magnet).collect();
}

/// The design of two tiles with a magnet in the middle of their target faces.
fn stage_text(entries: &Entries, side: f64, model: Option<MagnetModel>) -> String {
    let magnet = &entries.magnet;
    let pitch = magnet.pitch.unwrap_or(PITCH);
    let size = magnet.size.unwrap_or(SIZE);
    let strength = match (magnet.remanence, magnet.moment, magnet.surface_field) {
        (None, None, None) => "remanence = 1.2".to_owned(),
        (remanence, moment, surface) => {
            let keys = [
                ("remanence", remanence),
                ("moment", moment),
                ("surface_field", surface),
            ];
            let lines = keys
                .iter()
                .filter_map(|(key, value)| Some(format!("{key} = {:?}", (*value)?)));
            lines.collect::<Vec<_>>().join("\n")
        }
    };
    let model = match (model, &entries.potential.model) {
        (Some(model), _) => model.name().to_owned(),
        (None, Some(model)) => model.replace(['"', '\\', '\n'], " "),
        (None, None) => MagnetModel::default().name().to_owned(),
    };
    let table = 8.0 * side.abs();
    let mut text = format!(
        "name = \"words\"\n[table]\nsize = [{table:?}, {table:?}]\n[magnet]\nsize = [{:?}, {:?}, \
         {:?}]\n{strength}\npitch = {pitch:?}\ninset = {:?}\n",
        size[0],
        size[1],
        size[2],
        magnet.inset.unwrap_or(0.0)
    );
    for (tile, face) in [("fixed", "east"), ("moving", "west")] {
        let _ = write!(
            text,
            "[{tile}]\nside = {side:?}\nthickness = 0.013\nmass = 0.1\n[{tile}.faces]\n{face} = {{ \
             code = \"N\" }}\n"
        );
    }
    let _ = write!(
        text,
        "[target]\nfixed = \"east\"\nmoving = \"west\"\n[potential]\nmodel = \"{model}\"\n"
    );
    text
}
