//! The methods that all results share: their display, and their pickling.

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde::Serialize;
use tilebind::report::document::Document;
use tilebind::report::plots::{Figure, PictureError, Sheet};

use crate::{convert, fault, job, pickle};

/// A report as dictionaries and lists.
pub fn report<'py>(py: Python<'py>, document: &Document) -> PyResult<Bound<'py, PyAny>> {
    convert::json(py, &document.report())
}

/// The pictures of a document as SVG documents.
pub fn pictures(py: Python<'_>, document: &Document) -> PyResult<Vec<String>> {
    svg(py, || Ok(document.figures(&Sheet::SCREEN)?.concat()))
}

/// SVG documents of pictures, drawn without the interpreter's lock.
pub fn svg(
    py: Python<'_>,
    draw: impl FnOnce() -> Result<Vec<Figure>, PictureError> + Send,
) -> PyResult<Vec<String>> {
    let drawn = job::quietly(py, draw)?.map_err(fault::run)?;
    Ok(drawn.iter().map(|figure| figure.svg().to_owned()).collect())
}

/// The page of a document, made by a command.
pub fn page(py: Python<'_>, document: &Document, command: &str) -> PyResult<String> {
    job::quietly(py, || document.html(command))?.map_err(fault::run)
}

/// The display in a notebook: a text and pictures.
pub fn notebook(py: Python<'_>, text: String, pictures: Vec<String>) -> PyResult<Bound<'_, PyAny>> {
    let html = py.import("tilebind._html")?;
    html.call_method1("page", (text, pictures))
}

/// Calls a function that draws on axes of matplotlib, see `_plots.py`.
pub fn plotted<'py>(
    py: Python<'py>,
    name: &str,
    arguments: impl pyo3::call::PyCallArgs<'py>,
    style: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    py.import("tilebind._plots")?
        .getattr(name)?
        .call(arguments, style)
}

/// The arguments with which a class's `_restore` recreates an object.
pub type Reduced<'py> = (Bound<'py, PyAny>, (Bound<'py, PyBytes>,));

/// An object in a pickle: the function and the value that recreate it.
pub fn reduced<'py, T>(object: &Bound<'py, T>, value: &impl Serialize) -> PyResult<Reduced<'py>> {
    let restore = object.as_any().get_type().getattr("_restore")?;
    Ok((restore, (pickle::dump(object.py(), value)?,)))
}
