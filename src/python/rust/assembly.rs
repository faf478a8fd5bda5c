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

/// Realise a tile set with words of magnets: input files for xgrow and rgrow, with
/// energies in units of kT.
///
/// Parameters
/// ----------
/// tiles : str or os.PathLike
///     A tile set for xgrow (``.tiles``) or rgrow (YAML, JSON); or ``"lattice"`` (every
///     tile has its own place) or ``"homogeneous"`` (all tiles are the same) with
///     ``lattice``; or ``"square"`` with ``side``.
/// words : sequence of str or Mapping, optional
///     Words for its glues, one for each axis on which a glue is used: those of :func:`words`,
///     or a whole set with the keys of its file. Searched by default.
/// design : Design, optional
///     Its target face gives magnets, pitch and side; the paper's tile by default.
#[doc = include_str!("keywords/assemble.txt")]
/// progress : bool, optional
///
/// Returns
/// -------
/// dict of str to bytes
///     File names and contents, as ``tilebind assemble`` writes them: ``assembly.yaml``
///     (rgrow), ``assembly.tiles`` (xgrow), a design for each pair that meets, sheet,
///     matrix, page, report.
///
/// Raises
/// ------
/// DesignError
///     If the tile set or the words are wrong; gives the line.
/// ValueError
///     If there are not enough words.
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
