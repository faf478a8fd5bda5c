//! Docking experiments.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::docking::{Request, docked};
use tilebind::dynamics::docking::{Docking as Found, DockingMap, trajectory};
use tilebind::landscape::Proportion;
use tilebind::report::docking as report;
use tilebind::report::document::{Document, rows};
use tilebind::report::plots::Sheet;

use crate::design::{Content, Design};
use crate::request::request;
use crate::shown::{self, Reduced};
use crate::{convert, fault, job, pickle, table};

/// Launch the moving tile at the fixed one many times and count the outcomes.
///
/// Parameters
/// ----------
/// design : Design
#[doc = include_str!("keywords/dock.txt")]
/// progress : bool, optional
///
/// Returns
/// -------
/// Docking
#[pyfunction]
#[pyo3(signature = (design, *, progress = None, **settings))]
pub fn dock(
    py: Python<'_>,
    design: Py<Design>,
    progress: Option<bool>,
    settings: Option<&Bound<'_, PyDict>>,
) -> PyResult<Docking> {
    let content = design.get().content.clone();
    let asked = request::<Request>(settings)?;
    job::check_memory(asked.check_memory())?;
    let settings = asked.settings(&content.design.pair);
    let found = job::answer(py, progress, |told| {
        docked(content.problem(None), &settings, told)
    })?;
    Ok(Docking { found, content })
}

#[pymethods]
impl Design {
    /// Launch the moving tile at the fixed one many times; see :func:`tilebind.dock`.
    #[pyo3(signature = (*, progress = None, **settings))]
    fn dock(
        slf: Py<Self>,
        py: Python<'_>,
        progress: Option<bool>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Docking> {
        dock(py, slf, progress, settings)
    }
}

/// Largest number of points of a trajectory, since all are kept in memory.
const MOST_POINTS: f64 = 1e7;

/// Outcomes of a docking experiment. Immutable.
#[pyclass(frozen, module = "tilebind")]
pub struct Docking {
    content: Arc<Content>,
    found: Found,
}

impl Docking {
    fn document(&self) -> Document<'_> {
        let problem = self.content.problem(None);
        report::document((&self.content.design, problem), &self.found, None)
    }
}

/// A share with its 95 % interval, as a named tuple.
fn share<'py>(py: Python<'py>, proportion: &Proportion) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    fields.set_item("value", proportion.share())?;
    fields.set_item("low", proportion.low)?;
    fields.set_item("high", proportion.high)?;
    fields.set_item("count", proportion.count)?;
    fields.set_item("of", proportion.of)?;
    convert::named(py, "Share", &fields)
}

#[pymethods]
impl Docking {
    /// Share : Fraction of runs that ended bound, with its 95 % interval.
    #[getter]
    fn bound<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        share(py, &self.found.bound)
    }

    /// Share : Fraction of runs that ended in a trap.
    #[getter]
    fn trapped<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        share(py, &self.found.trapped)
    }

    /// Share : Fraction of runs that ended free.
    #[getter]
    fn free<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        share(py, &self.found.free)
    }

    /// numpy.ndarray : One row per trajectory, structured: start, end ("bound", "misbound",
    /// "free"), number of the trap, time to bind.
    #[getter]
    fn runs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table::array(py, &report::runs(&self.found))
    }

    /// numpy.ndarray : The traps, structured, most frequent first: pose, `energy_J`,
    /// `share` with its 95 % interval.
    #[getter]
    fn traps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let traps = rows(&self.found.traps)
            .data("pose", |trap| trap.configuration)
            .data("energy_J", |trap| trap.energy)
            .data("share", |trap| trap.caught.share())
            .data("share_low", |trap| trap.caught.low)
            .data("share_high", |trap| trap.caught.high);
        table::array(py, &traps.table("traps"))
    }

    /// numpy.ndarray : The probability of a match over initial orientation and speed,
    /// structured.
    #[getter]
    fn chances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let map = DockingMap::new(&self.found, report::CELLS);
        table::array(py, &report::chances(&map))
    }

    /// One trajectory, point by point.
    ///
    /// Parameters
    /// ----------
    /// index : int
    ///     Its number, from 0.
    /// interval : float, optional
    ///     Longest time (s) between two points of free flight.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Structured: `time_s`, pose, velocities, `potential_J`, `kinetic_J`.
    #[pyo3(signature = (index, *, interval = 0.02))]
    fn trajectory<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = convert::whole)] index: usize,
        #[pyo3(from_py_with = convert::real)] interval: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let count = self.found.runs.len();
        if index >= count {
            return Err(pyo3::exceptions::PyIndexError::new_err(format!(
                "the {count} trajectories are numbered from 0"
            )));
        }
        fault::positive("interval", Some(interval))?;
        let duration = self.found.settings.duration;
        if duration / interval > MOST_POINTS {
            return Err(fault::value(format!(
                "{duration} s every {interval:e} s are more than {MOST_POINTS:e} points"
            )));
        }
        let snapshots = job::answer(py, Some(false), |_| {
            let problem = self.content.problem(None);
            trajectory(problem, &self.found.settings, index, interval)
        })?;
        table::array(py, &report::trajectory(&snapshots))
    }

    /// dict : All results, as in ``report.json``.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        shown::report(py, &self.document())
    }

    /// A short summary of the results.
    ///
    /// Returns
    /// -------
    /// str
    fn summary(&self) -> String {
        self.document().text(None)
    }

    /// The probability of a match over orientation and speed, as an SVG document.
    ///
    /// Returns
    /// -------
    /// str
    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        let drawn = shown::svg(py, || {
            let design = &self.content.design;
            Ok(vec![report::picture(design, &self.found, &Sheet::SCREEN)?])
        })?;
        Ok(drawn.concat())
    }

    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        shown::notebook(py, self.summary(), vec![self.svg(py)?])
    }

    fn __len__(&self) -> usize {
        self.found.runs.len()
    }

    fn __repr__(&self) -> String {
        let (name, bound) = (&self.content.design.name, &self.found.bound);
        format!(
            "<tilebind.Docking {name:?}, {} of {} runs bound>",
            bound.count, bound.of
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let Self { content, found } = slf.get();
        shown::reduced(slf, &(&content.source, found))
    }

    #[staticmethod]
    fn _restore(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        let (source, found) = pickle::load(bytes)?;
        let design = Design::of_source(py, source)?;
        Ok(Self {
            content: design.content.clone(),
            found,
        })
    }
}
