//! A pair of tiles.

mod energies;
mod facts;
mod reading;
mod work;

use std::sync::{Arc, OnceLock};

use pyo3::prelude::*;
use tilebind::design::{Design as Whole, MagnetModel};
use tilebind::problem::Problem;
use tilebind::sweep::DesignSource;
use tilebind::tile::Tile;

use crate::fault;

/// A design with its source and its problems.
pub struct Content {
    /// Its text, with the drawings that it names.
    pub source: DesignSource,
    /// The tiles.
    pub design: Whole,
    /// The problems with magnets as dipoles and as blocks, created on first use.
    problems: [OnceLock<Arc<Problem>>; 2],
}

impl Content {
    fn new((source, design): (DesignSource, Whole)) -> Arc<Self> {
        Arc::new(Self {
            source,
            design,
            problems: Default::default(),
        })
    }

    /// The problem with the requested magnet model, by default the design's.
    pub fn problem(&self, model: Option<MagnetModel>) -> &Arc<Problem> {
        let model = model.unwrap_or(self.design.interaction.model);
        self.problems[model as usize].get_or_init(|| Arc::new(self.modelled(model).problem()))
    }

    /// The design with another magnet model.
    fn modelled(&self, model: MagnetModel) -> Whole {
        let mut design = self.design.clone();
        design.interaction.model = model;
        design
    }
}

/// A magnet model by its name.
pub fn model(name: Option<&str>) -> PyResult<Option<MagnetModel>> {
    let Some(name) = name else { return Ok(None) };
    let mut known = MagnetModel::NAMES.iter();
    match known.find(|(word, _)| *word == name) {
        Some((_, model)) => Ok(Some(*model)),
        None => Err(fault::value(format!(
            "model = {name:?}: a model is \"dipole\" or \"cuboid\""
        ))),
    }
}

/// A pair of tiles and their intended bond. Immutable: :meth:`replace` returns a new design.
///
/// Read one with :meth:`load`, :meth:`loads` or :meth:`from_dict`. Lengths are in m, angles in rad,
/// energies in J. A pose is (x, y, theta): the moving tile's reference point in the fixed tile's
/// frame and its orientation, counter-clockwise.
///
/// Examples
/// --------
/// >>> design = tilebind.Design.load("shapes/paper-tile.toml")
/// >>> design.bound
/// array([0.43, 0.  , 0.  ])
#[pyclass(frozen, module = "tilebind")]
pub struct Design {
    /// The content.
    pub content: Arc<Content>,
}

impl Design {
    pub(super) fn read(
        py: Python<'_>,
        read: Result<(DesignSource, Whole), tilebind::design::DesignError>,
    ) -> PyResult<Self> {
        read.map(|read| Self {
            content: Content::new(read),
        })
        .map_err(|error| fault::design(py, &error))
    }

    /// A design from a source.
    pub fn of_source(py: Python<'_>, source: DesignSource) -> PyResult<Self> {
        let design = source.design();
        Self::read(py, design.map(|design| (source, design)))
    }

    fn tile(&self, which: &str) -> PyResult<&Tile> {
        let pair = &self.content.design.pair;
        match which {
            "fixed" => Ok(&pair.fixed),
            "moving" => Ok(&pair.moving),
            _ => Err(fault::value(format!(
                "{which:?}: the tiles are \"fixed\" and \"moving\""
            ))),
        }
    }
}
