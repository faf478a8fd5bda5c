//! What is put on a table: the tiles of a design, or of a tile set.

use std::path::Path;

use super::{Request, of_assembly, of_design};
use crate::Refused;
use crate::assembly;
use crate::design::{Design, MagnetModel};
use crate::request::{Misused, of_keywords};
use physics::observer::Silent;
use physics::table::Crowd;

/// What tiles of a set cover of their table.
const COVERAGE: f64 = 0.3;
/// The kT (J) that a set's words are looked at with where tiles are not shaken.
const USUAL_KT: f64 = 5e-3;

/// Where tiles come from.
#[derive(Clone, Debug, PartialEq)]
pub struct About {
    /// What the design or the set is called.
    pub name: String,
    /// The checksum of the design's file.
    pub sha256: Option<String>,
    /// The model of the magnets.
    pub model: MagnetModel,
}

impl About {
    /// The tiles of a design.
    ///
    /// # Errors
    /// Where forces do not belong to energies.
    pub fn of_design(design: &Design) -> Result<(Self, Crowd), String> {
        let about = Self {
            name: design.name.clone(),
            sha256: Some(design.sha256.clone()),
            model: design.interaction.model,
        };
        let crowd = of_design(design).map_err(|error| error.to_string())?;
        Ok((about, crowd))
    }

    /// The tiles of a set, with the words that `tilebind assemble` finds for it, on a square table of
    /// which they cover three tenths.
    ///
    /// # Errors
    /// Where the set cannot be read, or there are no words for it.
    pub fn of_set(
        file: &Path,
        request: &Request,
        model: Option<MagnetModel>,
    ) -> Result<(Self, Crowd), Refused> {
        let kt = request.shaking.unwrap_or(USUAL_KT);
        let keywords = [
            ("kt", kt.to_string()),
            ("coverage", COVERAGE.to_string()),
            ("seed", request.seed.to_string()),
        ];
        let keywords = keywords.map(|(key, value)| (key.to_owned(), vec![value]));
        let asked = of_keywords(keywords).map_err(|error| match error {
            Misused::Wrong(message) => message,
            Misused::Unknown(key, _) => key,
        })?;
        let asked = assembly::Request { model, ..asked };
        let set = asked.tile_set(file)?;
        let assembly = asked.build(&set, None, None, &Silent)?;
        let stage = &assembly.words.stage;
        let tile = &stage.pair.fixed.outline;
        let tiles = request.count.iter().sum::<usize>().max(1);
        let side = (tiles as f64 * tile.area() / COVERAGE).sqrt();
        let side = side.max(5.0 * tile.circumradius());
        let about = Self {
            name: set.name.clone(),
            sha256: None,
            model: stage.interaction.model,
        };
        Ok((about, of_assembly(&assembly, [side; 2])?))
    }
}
