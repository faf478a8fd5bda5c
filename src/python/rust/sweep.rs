//! Designs made from one by varying its keys.

use std::convert::Infallible;
use std::sync::atomic::{AtomicUsize, Ordering};

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyMapping};
use tilebind::report::plots::Sheet;
use tilebind::report::sweep::Sweep as Swept;
use tilebind::sweep::{Axis, Outcome, Plan, Value, run as work_on};

use crate::comparison;
use crate::design::Design;
use crate::job::Told;
use crate::{convert, fault, job, pickle, table};

/// A key's values.
fn axis((key, values): (Bound<'_, PyAny>, Bound<'_, PyAny>)) -> PyResult<Axis> {
    let key: String = key.extract()?;
    let one = |value: Bound<'_, PyAny>| match convert::toml(&value)? {
        toml::Value::Boolean(truth) => Ok(Value::Truth(truth)),
        toml::Value::Integer(whole) => Ok(Value::Whole(whole)),
        toml::Value::Float(number) => Ok(Value::Number(number)),
        toml::Value::String(text) => Ok(Value::Text(text)),
        other => Err(fault::value(format!(
            "{key}: a value is a number, a text or a truth, not {other}"
        ))),
    };
    let values = values.try_iter()?.map(|value| one(value?));
    let values = values.collect::<PyResult<Vec<_>>>()?;
    Ok(Axis { key, values })
}

/// Vary keys of a design and assess every design that comes of it.
///
/// Parameters
/// ----------
/// design : Design
/// vary : Mapping
///     Dotted path of a key to its values, ``{"magnet.pitch": np.linspace(0.03, 0.05, 5)}``; several
///     keys make a grid, of which the first varies slowest.
/// milestones, neighbours, settled, far_starts, kinds, tolerance, certify_cells,
/// complete_cells, dynamics_runs, seed
///     As for :func:`compare`.
/// progress : bool, optional
///
/// Returns
/// -------
/// Sweep
///     The results of a point are those of ``tilebind sweep``: they depend neither on the other
///     points nor on the number of threads.
#[pyfunction]
#[pyo3(signature = (design, vary, *, progress = None, **settings))]
pub fn sweep(
    py: Python<'_>,
    design: &Bound<'_, Design>,
    vary: &Bound<'_, PyMapping>,
    progress: Option<bool>,
    settings: Option<&Bound<'_, PyDict>>,
) -> PyResult<Sweep> {
    let content = &design.get().content;
    let (settings, seed) = comparison::settings(settings, [&content.design])?;
    let items = vary.items()?;
    let axes = items.iter().map(|item| axis(item.extract()?));
    let axes = axes.collect::<PyResult<Vec<_>>>()?;
    let source = content.source.clone();
    let plan = Plan::of(vec![source], axes, settings, seed).map_err(fault::value)?;
    let outcomes = job::run(py, progress, |told| worked(&plan, told))?;
    Ok(Sweep { plan, outcomes })
}

/// What comes of each point.
fn worked(plan: &Plan, told: &Told) -> Vec<Outcome> {
    let points = plan.points();
    let found = std::sync::Mutex::new(std::collections::HashMap::new());
    let done = AtomicUsize::new(0);
    told.tell(0.0, format!("{} points", points.len()));
    let kept: Result<(), Infallible> = work_on(plan, &points, job::threads(), |point, outcome| {
        let done = 1 + done.fetch_add(1, Ordering::Relaxed);
        let text = format!("{done} of {} points", points.len());
        told.tell(done as f64 / points.len() as f64, text);
        let mut found = found
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        found.insert(point.name.clone(), outcome.clone());
        Ok(())
    });
    let Ok(()) = kept;
    let found = found
        .into_inner()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    let missing = || Outcome::Failed {
        reason: "it was not worked on".to_owned(),
    };
    let outcomes = points.iter().map(|point| found.get(&point.name).cloned());
    outcomes
        .map(|outcome| outcome.unwrap_or_else(missing))
        .collect()
}

/// Many designs made from one. It never changes.
#[pyclass(frozen, module = "tilebind")]
pub struct Sweep {
    plan: Plan,
    outcomes: Vec<Outcome>,
}

impl Sweep {
    fn swept(&self) -> Swept<'_> {
        Swept {
            plan: &self.plan,
            points: self.plan.points(),
            outcomes: self.outcomes.clone(),
        }
    }
}

#[pymethods]
impl Sweep {
    /// numpy.ndarray : One row a point, structured, for ``pandas.DataFrame``: the varied keys,
    /// `status` ("done", "impossible" or "failed"), `reason`, every figure with its bounds.
    #[getter]
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table::structured(py, table::of_table(&self.swept().numbers()))
    }

    /// dict : Everything, with what reproduces it, as ``report.json`` has it.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        convert::json(py, &self.swept().document().report())
    }

    /// What came of it.
    ///
    /// Returns
    /// -------
    /// str
    fn summary(&self) -> String {
        self.swept().document().text(Some(100))
    }

    /// The design of a point.
    ///
    /// Parameters
    /// ----------
    /// index : int
    ///     The point's number.
    ///
    /// Returns
    /// -------
    /// Design
    fn design(&self, py: Python<'_>, index: usize) -> PyResult<Design> {
        let points = self.plan.points();
        let point = points.get(index).ok_or_else(|| {
            pyo3::exceptions::PyIndexError::new_err(format!("there are {} points", points.len()))
        })?;
        let source = &self.plan.designs[point.design];
        let mut source = source.clone();
        for (axis, value) in self.plan.axes.iter().zip(&point.values) {
            source = source.with(&axis.key, value.toml()).map_err(fault::value)?;
        }
        Design::of_source(py, source)
    }

    /// Curves over one varied number, maps over two, as SVG documents.
    ///
    /// Returns
    /// -------
    /// list of str
    fn svg(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let swept = self.swept();
        let drawn = job::quietly(py, || swept.document().figures(&Sheet::SCREEN))?;
        let drawn = drawn.map_err(fault::run)?;
        Ok(drawn
            .iter()
            .flatten()
            .map(|figure| figure.svg().to_owned())
            .collect())
    }

    /// The page of the sweep.
    ///
    /// Returns
    /// -------
    /// str
    fn report_html(&self, py: Python<'_>) -> PyResult<String> {
        let swept = self.swept();
        let html = job::quietly(py, || swept.document().html(""))?;
        html.map_err(fault::run)
    }

    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let html = py.import("tilebind._html")?;
        html.call_method1("page", (self.summary(), self.svg(py)?))
    }

    fn __len__(&self) -> usize {
        self.outcomes.len()
    }

    fn __repr__(&self) -> String {
        let keys: Vec<_> = self
            .plan
            .axes
            .iter()
            .map(|axis| axis.key.as_str())
            .collect();
        let count = self.outcomes.len();
        format!(
            "<tilebind.Sweep of {count} points over {}>",
            keys.join(", ")
        )
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let restore = slf.get_type().getattr("_restore")?;
        let Self { plan, outcomes } = slf.get();
        Ok((restore, (pickle::dump(slf.py(), &(plan, outcomes))?,)))
    }

    #[staticmethod]
    fn _restore(bytes: &[u8]) -> PyResult<Self> {
        let (plan, outcomes) = pickle::load(bytes)?;
        Ok(Self { plan, outcomes })
    }
}
