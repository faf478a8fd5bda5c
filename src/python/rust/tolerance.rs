//! What errors of making do to a design.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::report::tolerance::document;
use tilebind::tolerance::Request;

use crate::design::Design;
use crate::request::request;
use crate::{job, shown};

/// Compute what errors of making do to a design: pairs of tiles drawn with them, and the share
/// that still binds as designed.
///
/// At least one error is to be stated. Lengths and angles are in m and rad, or text with a unit.
///
/// Parameters
/// ----------
/// design : Design
/// strength : float or str, optional
///     Standard deviation of the magnets' relative strength: 0.05 or "5%".
/// place : float or str, optional
///     Standard deviation of the magnets' places, along and across the face: "0.3 mm".
/// turn : float or str, optional
///     Standard deviation of the magnets' axes: "3 deg".
/// gap : float or str, optional
///     Gap left between touching faces: "0.1 mm".
/// flip : float, optional
///     Chance that a magnet is glued in with its poles exchanged.
/// batch : float, optional
///     Share of the strength's variance that all magnets of a draw have in common.
/// draws : int, optional
///     Number of drawn pairs of tiles; 1000 by default.
/// selectivity : float, optional
///     Least ratio of the bond's depth to the deepest trap's with which a pair works; 1.5 by
///     default.
/// beats : float, optional
///     Also count the draws whose deepest trap is deeper than this share of the nominal bond.
/// checks : int, optional
///     Number of draws that are analysed anew.
/// seed : int, optional
/// progress : bool, optional
///
/// Returns
/// -------
/// dict
///     As ``tilebind tolerance --json``.
#[pyfunction]
#[pyo3(signature = (design, *, progress = None, **settings))]
pub fn tolerance<'py>(
    py: Python<'py>,
    design: &Bound<'py, Design>,
    progress: Option<bool>,
    settings: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let asked: Request = request(settings)?;
    let design = &design.get().content.design;
    let found = job::answer(py, progress, |told| asked.run(design, told))?;
    shown::report(py, &document(design, &found))
}
