//! Tile sets whose glues are words.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::assembly::{Built, TileSet, Wiring, proofread};
use tilebind::kinetics::bond::Shaking;
use tilebind::report::assembly::{self as report, Assembly};
use tilebind::words::Rules;

use crate::words::word_set;
use crate::{convert, fault, job};

/// Most tiles along a block's edge.
const LARGEST_BLOCK: usize = 6;

/// Build a tile set of words: what engines of tile assembly read, with energies in units of kT.
///
/// Parameters
/// ----------
/// tiles : str or os.PathLike
///     A tile set as xgrow (``.tiles``) or rgrow (YAML, JSON) read it.
/// words : sequence of str or Mapping
///     Words enough for its glues, one for each axis on which a glue is used: those of
///     :func:`words`, or a whole set with the keys of its file.
/// kt : float
///     Effective energy of the shaking (J).
/// coverage : float, optional
///     Share of the table that tiles cover.
/// proofread : int, optional
///     Blocks of so many tiles a side in place of tiles.
/// progress : bool, optional
///
/// Returns
/// -------
/// dict of str to bytes
///     By their names, as ``tilebind assemble`` writes them: `assembly.yaml` (rgrow),
///     `assembly.tiles` (xgrow), a design for each pair that meets, sheet, matrix, page, report.
///
/// Raises
/// ------
/// DesignError
///     With the line of what is wrong with the tile set or the words.
/// ValueError
///     Where the words do not suffice.
#[pyfunction]
#[pyo3(signature = (tiles, words, *, kt, coverage = 0.3, proofread = 1, progress = None))]
pub fn assemble<'py>(
    py: Python<'py>,
    tiles: PathBuf,
    words: &Bound<'py, PyAny>,
    kt: f64,
    coverage: f64,
    proofread: usize,
    progress: Option<bool>,
) -> PyResult<Bound<'py, PyDict>> {
    fault::positive("kt", Some(kt))?;
    fault::fraction("coverage", coverage)?;
    if !(1..=LARGEST_BLOCK).contains(&proofread) {
        return Err(fault::value(format!(
            "proofread = {proofread}: from 1 to {LARGEST_BLOCK} tiles a side"
        )));
    }
    let tiles = TileSet::load(&tiles).map_err(|error| fault::design(py, &error))?;
    let (words, words_toml) = word_set(py, words)?;
    let set = proofread::blocks(&tiles, proofread);
    Wiring::new(&set).map_err(fault::value)?;
    let shaking = Shaking { kt, coverage };
    let files = job::run(py, progress, |told| {
        told.tell(0.0, "assembly".to_owned());
        Built::new(&set, &words, shaking).map(|built| {
            let assembly = Assembly {
                built: &built,
                words: &words,
                words_toml,
                design: None,
                tried: Vec::new(),
                lattice: None,
                rules: Rules::default(),
                proofread,
                seed: 1,
            };
            report::files(&assembly, "tilebind assemble")
        })
    })?;
    convert::files(py, files.map_err(fault::value)?)
}
