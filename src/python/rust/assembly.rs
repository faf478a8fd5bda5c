//! Tile sets whose glues are words.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::assembly::Request;
use tilebind::report::assembly::document;
use tilebind::report::plots::Sheet;

use crate::design::Design;
use crate::request::request;
use crate::words::word_set;
use crate::{convert, fault, job};

/// Build a tile set of words: what engines of tile assembly read, with energies in units of kT.
///
/// Parameters
/// ----------
/// tiles : str or os.PathLike
///     A tile set as xgrow (``.tiles``) or rgrow (YAML, JSON) read it; or ``"lattice"`` (every tile its
///     own place) or ``"homogeneous"`` (all the same tile) with `lattice`, ``"square"`` with `side`.
/// words : sequence of str or Mapping, optional
///     Words enough for its glues, one for each axis on which a glue is used: those of
///     :func:`words`, or a whole set with the keys of its file. Searched by default.
/// design : Design, optional
///     From whose target face magnets, pitch and side are taken; the paper's tile by default.
/// kt : float
///     Effective energy of the shaking (J).
/// coverage : float, optional
///     Share of the table that tiles cover.
/// lattice : sequence of int, optional
///     Rows and columns of a lattice.
/// side : int, optional
///     Of a counted square, in tiles.
/// proofread : int, optional
///     Blocks of so many tiles a side in place of tiles.
/// length : int, optional
///     Places of a face where words are searched; the fewest that carry them by default.
/// magnets : int, optional
///     Magnets of the strongest bonds' words, where spacing is code too.
/// gap : float, optional
///     Least gap of the words: 0.5 by default, with `length` the widest there is.
/// shape : {"none", "shared", "polar"}, optional
///     Complementary shapes of the faces.
/// pitch : float, optional
///     From place to place (m).
/// model : {"dipole", "cuboid"}, optional
///     Of the magnets; the design's by default.
/// seconds : float, optional
///     Work to spend on words, as what takes about so many seconds of a core; it is counted.
/// seed : int, optional
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
#[pyo3(signature = (tiles, words = None, *, design = None, progress = None, **asked))]
pub fn assemble<'py>(
    py: Python<'py>,
    tiles: PathBuf,
    words: Option<&Bound<'py, PyAny>>,
    design: Option<Py<Design>>,
    progress: Option<bool>,
    asked: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyDict>> {
    let asked: Request = request(asked)?;
    let refused = |why| fault::refused(py, &why);
    let tiles = asked.tile_set(&tiles).map_err(refused)?;
    let words = words.map(|words| word_set(py, words, asked.model));
    let words = words.transpose()?;
    let design = design.map(|design| design.get().content.clone());
    let design = design.as_ref().map(|content| &content.design);
    let files = job::run(py, progress, |told| {
        told.tell(0.0, "assembly".to_owned());
        let assembly = asked.build(&tiles, words, design, told)?;
        Ok(document(&assembly).files(&Sheet::SCREEN, "tilebind assemble"))
    })?;
    let (files, drawn) = files.map_err(refused)?;
    if let Err(error) = drawn {
        fault::warn(py, error)?;
    }
    convert::files(py, files)
}
