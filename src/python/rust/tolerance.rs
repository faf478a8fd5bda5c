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
#[doc = include_str!("keywords/tolerance.txt")]
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
