//! Docking: what becomes of tiles that are sent towards each other.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use tilebind::docking::Request;
use tilebind::dynamics::docking::{
    self, Docking as Found, DockingError, DockingMap, DockingSettings, Trap,
};
use tilebind::landscape::Proportion;
use tilebind::report::docking as report;
use tilebind::report::document::Document;
use tilebind::report::plots::Sheet;
use tilebind::report::release;

use crate::design::{Content, Design};
use crate::request::request;
use crate::table::{self, Named, Values};
use crate::{convert, fault, job, pickle};

fn settings(given: Option<&Bound<'_, PyDict>>) -> PyResult<DockingSettings> {
    Ok(request::<Request>(given)?.settings())
}

/// Send the moving tile towards the fixed one many times and count how it ends.
///
/// Parameters
/// ----------
/// design : Design
/// runs : int, optional
///     Trajectories, 2000 by default.
/// seed : int, optional
/// duration : float, optional
///     Of each, in s.
/// drag, friction, restitution : float, optional
///     Drag rate (1/s), Coulomb's coefficient, share of the approach velocity that a knock gives
///     back.
/// no_walls : bool, optional
///     Let tiles leave the table.
/// shaking : float, optional
///     Effective energy kT (J) of a random force.
/// fan : sequence, optional
///     Of (x, y, energy, width) in m, m, J and m, and perhaps the share by which it swings and how
///     often a second.
/// threshold : float, optional
///     Distance (m) within which magnets match.
/// distance, speed : tuple of float, optional
///     Lowest and highest at the start (m, m/s).
/// direction, orientation, aim, spin : float, optional
///     Widths of the starts (rad, rad, rad, rad/s).
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
    docked(py, design, settings, progress)
}

/// The same of a design's method.
pub fn docked(
    py: Python<'_>,
    design: Py<Design>,
    given: Option<&Bound<'_, PyDict>>,
    progress: Option<bool>,
) -> PyResult<Docking> {
    let settings = settings(given)?;
    let content = design.get().content.clone();
    let found = run(py, progress, settings.runs, |step| {
        docking::dock(content.problem(None), &settings, step)
    })?;
    Ok(Docking { found, content })
}

/// Trajectories that start bound, and when they part.
pub fn released<'py>(
    py: Python<'py>,
    content: &Content,
    shaking: f64,
    given: Option<&Bound<'_, PyDict>>,
    progress: Option<bool>,
) -> PyResult<Bound<'py, PyAny>> {
    fault::positive("shaking", Some(shaking))?;
    let given = given.cloned().unwrap_or_else(|| PyDict::new(py));
    given.set_item("shaking", shaking)?;
    let settings = settings(Some(&given))?;
    let found = run(py, progress, settings.runs, |step| {
        docking::releases(content.problem(None), &settings, step)
    })?;
    convert::json(
        py,
        &release::document(&content.design, &settings, &found, None).report(),
    )
}

/// Many trajectories, with word of how many have ended.
fn run<T: Send>(
    py: Python<'_>,
    progress: Option<bool>,
    runs: usize,
    work: impl FnOnce(&(dyn Fn() + Sync)) -> Result<T, DockingError> + Send,
) -> PyResult<T> {
    let found = job::run(py, progress, |told| {
        let ended = AtomicUsize::new(0);
        let step = || {
            let ended = 1 + ended.fetch_add(1, Ordering::Relaxed);
            let text = format!("{ended} of {runs} trajectories");
            told.tell(ended as f64 / runs as f64, text);
        };
        work(&step)
    })?;
    found.map_err(fault::value)
}

/// How tiles ended that were sent towards each other. It never changes.
#[pyclass(frozen, module = "tilebind")]
pub struct Docking {
    content: Arc<Content>,
    found: Found,
}

impl Docking {
    fn map(&self) -> DockingMap {
        DockingMap::new(&self.found, report::CELLS)
    }

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
    /// Share : Of the runs that ended bound, with its 95 % interval.
    #[getter]
    fn bound<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        share(py, &self.found.bound)
    }

    /// Share : Of those that ended in a trap.
    #[getter]
    fn trapped<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        share(py, &self.found.trapped)
    }

    /// Share : Of those that ended otherwise.
    #[getter]
    fn free<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        share(py, &self.found.free)
    }

    /// numpy.ndarray : One row a trajectory, structured: start, end ("bound", "misbound", "free"),
    /// number of the trap, time to bind.
    #[getter]
    fn runs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table::structured(py, table::of_table(&report::runs(&self.found)))
    }

    /// numpy.ndarray : The traps, structured, the one with most trajectories first: pose,
    /// `energy_J`, `share` with its 95 % interval.
    #[getter]
    fn traps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let traps = &self.found.traps;
        let real = |name: &str, of: fn(&Trap) -> f64| -> Named {
            (
                name.to_owned(),
                Values::Real(traps.iter().map(of).collect()),
            )
        };
        let columns = vec![
            real("x_m", |trap| trap.configuration.x),
            real("y_m", |trap| trap.configuration.y),
            real("theta_rad", |trap| trap.configuration.theta),
            real("energy_J", |trap| trap.energy),
            real("share", |trap| trap.caught.share()),
            real("share_low", |trap| trap.caught.low),
            real("share_high", |trap| trap.caught.high),
        ];
        table::structured(py, columns)
    }

    /// numpy.ndarray : The chance of a match over orientation and speed at the start, structured.
    #[getter]
    fn chances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table::structured(py, table::of_table(&report::chances(&self.map())))
    }

    /// One trajectory, point by point.
    ///
    /// Parameters
    /// ----------
    /// index : int
    ///     Its number.
    /// interval : float, optional
    ///     Time (s) between two points of free flight, at most.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Structured: `time_s`, pose, velocities, `potential_J`, `kinetic_J`.
    #[pyo3(signature = (index, *, interval = 0.02))]
    fn trajectory<'py>(
        &self,
        py: Python<'py>,
        index: usize,
        interval: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let count = self.found.runs.len();
        if index >= count {
            return Err(pyo3::exceptions::PyIndexError::new_err(format!(
                "the {count} trajectories are numbered from 0"
            )));
        }
        fault::positive("interval", Some(interval))?;
        let snapshots = job::quietly(py, || {
            let problem = self.content.problem(None);
            docking::trajectory(problem, &self.found.settings, index, interval)
        })?;
        let snapshots = snapshots.map_err(fault::value)?;
        table::structured(py, table::of_table(&report::trajectory(&snapshots)))
    }

    /// dict : Everything, as ``report.json`` has it.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        convert::json(py, &self.document().report())
    }

    /// What came of it, in a few lines.
    ///
    /// Returns
    /// -------
    /// str
    fn summary(&self) -> String {
        self.document().text(None)
    }

    /// The chances of a match over orientation and speed, an SVG document.
    ///
    /// Returns
    /// -------
    /// str
    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        let drawn = job::quietly(py, || {
            report::picture(&self.content.design, &self.found, &Sheet::SCREEN)
        })?;
        Ok(drawn.map_err(fault::run)?.svg().to_owned())
    }

    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let html = py.import("tilebind._html")?;
        html.call_method1("page", (self.summary(), vec![self.svg(py)?]))
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

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let restore = slf.get_type().getattr("_restore")?;
        let Self { content, found } = slf.get();
        let bytes = pickle::dump(slf.py(), &(&content.source, found))?;
        Ok((restore, (bytes,)))
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
