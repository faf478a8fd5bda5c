//! The tiles on a table: those of a design, or of a tile set.

use std::collections::BTreeMap;
use std::path::Path;

use super::crowds::Named;
use super::{Request, of_assembly, of_designs};
use crate::Refused;
use crate::assembly::{self, growth::Site, kinetic::Growth};
use crate::design::{Design, MagnetModel};
use crate::request::Options;
use physics::observer::Silent;
use physics::table::Crowd;

/// The share of the table covered by the tiles of a set.
const COVERAGE: f64 = 0.3;
/// The kT (J) for choosing a set's words if tiles are not shaken.
const USUAL_KT: f64 = 5e-3;

/// The origin of the tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct About {
    /// The name of the design or the set.
    pub name: String,
    /// The designs' names, with the checksums of their files; empty for a tile set.
    pub designs: Vec<(String, String)>,
    /// The kinds of the designs' tiles.
    pub named: Named,
    /// The model of the magnets.
    pub model: MagnetModel,
    /// For a tile set, the target assembly: tiles by place.
    pub pattern: Option<BTreeMap<Site, usize>>,
    /// For a tile set, its growth from a seed as `tilebind assemble` simulates it.
    pub growth: Option<Growth>,
}

impl About {
    /// The tiles of one or more designs.
    ///
    /// # Errors
    /// As [`of_designs`], or if two designs have the same name.
    pub fn of_designs(designs: &[Design]) -> Result<(Self, Crowd), String> {
        let (crowd, named) = of_designs(designs)?;
        let names: Vec<&str> = designs.iter().map(|it| it.name.as_str()).collect();
        let twice = |name: &&&str| names.iter().filter(|it| it == name).count() > 1;
        if let Some(twice) = names.iter().find(twice) {
            return Err(format!(
                "two designs are called `{twice}`: give one of them another `name`"
            ));
        }
        let about = Self {
            name: names.join(" and "),
            designs: designs
                .iter()
                .map(|it| (it.name.clone(), it.sha256.clone()))
                .collect(),
            model: designs[0].interaction.model,
            named,
            pattern: None,
            growth: None,
        };
        Ok((about, crowd))
    }

    /// The tiles of a set or of a lattice of the given size, with the words that `tilebind assemble` finds for it, on a square table
    /// with a coverage of three tenths.
    ///
    /// # Errors
    /// If the set cannot be read, or there are no words for it.
    pub fn of_set(
        file: &Path,
        request: &Request,
        model: Option<MagnetModel>,
        lattice: Option<[usize; 2]>,
    ) -> Result<(Self, Crowd), Refused> {
        let kt = request.shaking.unwrap_or(USUAL_KT);
        let asked = assembly::Request {
            kt: Some(kt),
            coverage: COVERAGE,
            seed: request.seed,
            model,
            lattice,
            ..assembly::Request::with_defaults()
        };
        let set = asked.tile_set(file)?;
        let assembly = asked.build(&set, None, None, &Silent)?;
        let stage = &assembly.words.stage;
        let tile = &stage.pair.fixed.outline;
        let tiles = request.count.iter().sum::<usize>().max(1);
        let side = (tiles as f64 * tile.area() / COVERAGE).sqrt();
        let side = side.max(5.0 * tile.circumradius());
        let about = Self {
            name: set.name.clone(),
            designs: Vec::new(),
            named: Named::default(),
            model: stage.interaction.model,
            pattern: Some(assembly.built.grown.tiles.clone()),
            growth: assembly.growing.as_ref().map(|growing| growing.growth),
        };
        Ok((about, of_assembly(&assembly, [side; 2])?))
    }
}
