//! Designs side by side.

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use tilebind::comparison::quantity::QUANTITIES;
use tilebind::comparison::{self, Assessment, AssessmentSettings, Quantity, Request};
use tilebind::observer::Observer;
use tilebind::report::comparison::Comparison as Compared;
use tilebind::report::plots::Sheet;

use crate::design::Design;
use crate::job::Told;
use crate::request::request;
use crate::table;
use crate::{convert, fault, job, pickle};

/// How designs are assessed, and the seed.
pub fn settings<'a>(
    given: Option<&Bound<'_, PyDict>>,
    designs: impl IntoIterator<Item = &'a tilebind::Design>,
) -> PyResult<(AssessmentSettings, u64)> {
    let request = request::<Request>(given)?;
    let settings = request.settings(designs);
    job::check_memory(settings.milestones, settings.neighbours)?;
    Ok((settings, request.seed))
}

fn quantity(key: &str) -> PyResult<&'static Quantity> {
    let known = || QUANTITIES.iter().map(|one| one.key).collect::<Vec<_>>();
    QUANTITIES
        .iter()
        .find(|one| one.key == key)
        .ok_or_else(|| fault::value(format!("by = {key:?}: known are {}", known().join(", "))))
}

/// Set designs side by side: bond, traps, barriers with bounds, capture range.
///
/// Parameters
/// ----------
/// designs : sequence of Design
/// by : str, optional
///     What to rank by, "selectivity" by default; largest first.
/// milestones, neighbours, settled, far_starts, kinds, tolerance, certify_cells,
/// complete_cells, dynamics_runs, seed
///     As for :meth:`Design.analyse`, but for `certify_cells`: cells spent on the bounds of a
///     barrier at most; 0 for no bounds.
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
    let contents: Vec<_> = designs
        .iter()
        .map(|one| one.get().content.clone())
        .collect();
    let of_designs = contents.iter().map(|content| &content.design);
    let (settings, seed) = self::settings(settings, of_designs)?;
    let count = contents.len();
    let assessments = job::run(py, progress, |told| {
        let parts = contents.iter().enumerate();
        let assessed = parts.map(|(done, content)| {
            let part = Part { told, done, count };
            comparison::assess(&content.design, &settings, seed, &part)
        });
        assessed.collect::<Vec<_>>()
    })?;
    Ok(Comparison(Compared::new(&assessments, by, settings)))
}

/// The progress of one design among several.
struct Part<'a> {
    told: &'a Told,
    done: usize,
    count: usize,
}

impl Observer for Part<'_> {
    fn stage(&self, name: &'static str, share: f64) {
        let share = (self.done as f64 + share) / self.count as f64;
        let text = format!("design {} of {}: {name}", self.done + 1, self.count);
        self.told.tell(share, text);
    }
}

/// Designs side by side, best first. It never changes.
#[pyclass(frozen, module = "tilebind")]
pub struct Comparison(Compared);

#[pymethods]
impl Comparison {
    /// numpy.ndarray : One row a design, best first, structured, for ``pandas.DataFrame``: every
    /// figure with its bounds, units in the names.
    #[getter]
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table::structured(py, table::of_table(&self.0.table()))
    }

    /// dict : Everything, with what reproduces it, as ``report.json`` has it.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        convert::json(py, &self.0.document().report())
    }

    /// The tables and the proved orders as text.
    ///
    /// Returns
    /// -------
    /// str
    fn summary(&self) -> String {
        self.0.document().text(Some(100))
    }

    /// The same as Markdown.
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
    fn svg(&self) -> PyResult<String> {
        let drawn = self.0.picture(&Sheet::SCREEN).map_err(fault::run)?;
        Ok(drawn.svg().to_owned())
    }

    /// The page of the comparison.
    ///
    /// Returns
    /// -------
    /// str
    fn report_html(&self) -> PyResult<String> {
        self.0.document().html("").map_err(fault::run)
    }

    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let html = py.import("tilebind._html")?;
        html.call_method1("page", (self.summary(), vec![self.svg()?]))
    }

    fn __len__(&self) -> usize {
        self.0.designs.len()
    }

    fn __repr__(&self) -> String {
        let (count, by) = (self.0.designs.len(), self.0.by.label);
        format!("<tilebind.Comparison of {count} designs by {by}>")
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let restore = slf.get_type().getattr("_restore")?;
        let Compared {
            designs,
            by,
            settings,
        } = &slf.get().0;
        Ok((
            restore,
            (pickle::dump(slf.py(), &(designs, by.key, settings))?,),
        ))
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
