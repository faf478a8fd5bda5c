//! Checks of results folders.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::{PyAny, PyTuple};
use tilebind::report::verification::document;
use tilebind::verification::verify as check;

use crate::{convert, fault, job};

/// Check the results of analyses with other code than made them.
///
/// Energies and clearances are computed again from the tiles in `report.json`; bounds, counts
/// and pathways are checked against each other, and bounds of one design in several folders
/// must overlap.
///
/// Parameters
/// ----------
/// *folders : str or os.PathLike
///     Results folders of ``tilebind analyse``.
/// progress : bool, optional
///
/// Returns
/// -------
/// dict
///     As ``tilebind verify --json``: `verified` (False if anything is contradicted),
///     `checks`, `contradictions`, `unchecked`.
#[pyfunction]
#[pyo3(signature = (*folders, progress = None))]
pub fn verify<'py>(
    py: Python<'py>,
    folders: &Bound<'py, PyTuple>,
    progress: Option<bool>,
) -> PyResult<Bound<'py, PyAny>> {
    let folders: Vec<PathBuf> = folders.extract::<Vec<PathBuf>>()?;
    let found = job::run(py, progress, |told| check(&folders, told))?;
    let found = found.map_err(|why| fault::refused(py, &why))?;
    convert::json(py, &document(&found).report())
}
