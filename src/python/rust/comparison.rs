//! Comparisons of designs.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::comparison::quantity::QUANTITIES;
use tilebind::comparison::{Assessment, Quantity, Request, assess_all};
use tilebind::report::comparison::Comparison as Compared;

use crate::design::Design;
use crate::request::request;
use crate::shown::{self, Reduced};
use crate::{fault, job, pickle, table};

fn quantity(key: &str) -> PyResult<&'static Quantity> {
    let known = || QUANTITIES.iter().map(|one| one.key).collect::<Vec<_>>();
    QUANTITIES
        .iter()
        .find(|one| one.key == key)
        .ok_or_else(|| fault::value(format!("by = {key:?}: known are {}", known().join(", "))))
}

/// Compare designs: bond, traps, barriers with bounds, capture range.
///
/// Parameters
/// ----------
/// designs : sequence of Design
/// by : str, optional
///     Figure to rank by, "selectivity" by default; largest first.
#[doc = include_str!("keywords/compare.txt")]
/// progress : bool, optional
///
/// Returns
/// -------
/// Comparison
#[pyfunction]
#[pyo3(signature = (designs, *, by = "selectivity", progress = None, **settings))]
pub fn compare(
    py: Python<'_>,
    designs: Vec<Py<Design>>,
    by: &str,
    progress: Option<bool>,
    settings: Option<&Bound<'_, PyDict>>,
) -> PyResult<Comparison> {
    let by = quantity(by)?;
    if designs.is_empty() {
        return Err(fault::value("there is no design to compare"));
    }
    let contents: Vec<_> = designs.iter().map(|one| &one.get().content).collect();
    let designs = || contents.iter().map(|content| &content.design);
    let asked = request::<Request>(settings)?;
    let asked = Request {
        thoroughness: asked.thoroughness.of(designs()),
        ..asked
    };
    let ranking = asked.thoroughness.check_ranking(by);
    ranking.map_err(|error| fault::value(error.to_string()))?;
    job::check_memory(asked.thoroughness.analysis(asked.seed).check_memory())?;
    let found = job::run(py, progress, |told| assess_all(designs(), &asked, told))?;
    Ok(Comparison(Compared::new(&found, by, asked.thoroughness)))
}

/// A comparison of designs, best first. Immutable.
#[pyclass(frozen, module = "tilebind")]
pub struct Comparison(Compared);

#[pymethods]
impl Comparison {
    /// numpy.ndarray : One row per design, best first, structured, for
    /// ``pandas.DataFrame``: every figure with its bounds; names contain the units.
    #[getter]
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table::array(py, &self.0.table())
    }

    /// dict : All results and settings, as in ``report.json``.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        shown::report(py, &self.0.document())
    }

    /// The tables and the certified orders as text.
    ///
    /// Returns
    /// -------
    /// str
    fn summary(&self) -> String {
        self.0.document().text(Some(100))
    }

    /// The summary as Markdown.
    ///
    /// Returns
    /// -------
    /// str
    fn markdown(&self) -> String {
        self.0.document().markdown()
    }

    /// The picture of the ranking, an SVG document.
    ///
    /// Returns
    /// -------
    /// str
    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        Ok(shown::pictures(py, &self.0.document())?.concat())
    }

    /// The page of the comparison.
    ///
    /// Returns
    /// -------
    /// str
    fn report_html(&self, py: Python<'_>) -> PyResult<String> {
        shown::page(py, &self.0.document(), "")
    }

    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        shown::notebook(py, self.summary(), vec![self.svg(py)?])
    }

    fn __len__(&self) -> usize {
        self.0.designs.len()
    }

    fn __repr__(&self) -> String {
        let (count, by) = (self.0.designs.len(), self.0.by.label);
        format!("<tilebind.Comparison of {count} designs by {by}>")
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let Compared {
            designs,
            by,
            settings,
        } = &slf.get().0;
        shown::reduced(slf, &(designs, by.key, settings))
    }

    #[staticmethod]
    fn _restore(bytes: &[u8]) -> PyResult<Self> {
        let (designs, by, settings): (Vec<Assessment>, String, _) = pickle::load(bytes)?;
        Ok(Self(Compared {
            designs,
            by: quantity(&by)?,
            settings,
        }))
    }
}
