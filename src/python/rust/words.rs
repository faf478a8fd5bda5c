//! Sets of barcodes that bind their mates and nothing else.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::design::{MagnetModel, WordSet};
use tilebind::report::{crosstalk as crosstalk_report, words as report};
use tilebind::word_sets::{CrosstalkRequest, Request};

use crate::design::Design;
use crate::request::request;
use crate::{convert, fault, job};

/// Find sets of barcodes that bind their mates and nothing else.
///
/// Parameters
/// ----------
/// design : Design, optional
///     Its target face gives magnets and pitch; the paper's tile by default.
#[doc = include_str!("keywords/words.txt")]
/// progress : bool, optional
///
/// Returns
/// -------
/// dict
///     As ``tilebind words --json``: `words`, `count`, `upper_bound`, `proved`, `gap`, `bond_J`,
///     `worst`; with `continuous` also `positions_m`.
#[pyfunction]
#[pyo3(signature = (length = None, *, design = None, progress = None, **asked))]
pub fn words<'py>(
    py: Python<'py>,
    length: Option<&Bound<'py, PyAny>>,
    design: Option<Py<Design>>,
    progress: Option<bool>,
    asked: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let asked = asked.map_or_else(|| Ok(PyDict::new(py)), |asked| asked.copy())?;
    asked.set_item("length", length)?;
    let asked: Request = request(Some(&asked))?;
    let design = design.map(|design| design.get().content.clone());
    let found = job::run(py, progress, |told| {
        told.tell(0.0, "words".to_owned());
        asked.search(design.as_ref().map(|content| &content.design))
    })?;
    let found = found.map_err(|why| fault::refused(py, &why))?;
    convert::json(py, &report::document(&found).report())
}

/// Find the strongest attraction between every two words of a set, mates included, over
/// all poses.
///
/// Parameters
/// ----------
/// words : sequence of str or Mapping
///     The words, without their mates, or a whole set with the keys of its file.
#[doc = include_str!("keywords/crosstalk.txt")]
/// progress : bool, optional
///
/// Returns
/// -------
/// dict
///     As ``tilebind crosstalk --json``: `words`, `strongest_J`, `lower_J`, `poses`.
#[pyfunction]
#[pyo3(signature = (words, *, progress = None, **asked))]
pub fn crosstalk<'py>(
    py: Python<'py>,
    words: &Bound<'py, PyAny>,
    progress: Option<bool>,
    asked: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let asked: CrosstalkRequest = request(asked)?;
    let (set, _) = word_set(py, words, asked.model)?;
    let found = job::run(py, progress, |told| asked.crosstalk(&set, told))?;
    let found = found.map_err(|why| fault::refused(py, &why))?;
    convert::json(py, &crosstalk_report::document(&set, &found).report())
}

/// A set of words and its file, from a list of them or the keys of the file.
pub fn word_set(
    py: Python<'_>,
    words: &Bound<'_, PyAny>,
    model: Option<MagnetModel>,
) -> PyResult<(WordSet, String)> {
    let table = match convert::toml(words)? {
        toml::Value::Table(table) => table,
        list => toml::Table::from_iter([("words".to_owned(), list)]),
    };
    let text = table.to_string();
    let set = WordSet::parse(&text, "words.toml", model);
    Ok((set.map_err(|error| fault::design(py, &error))?, text))
}
