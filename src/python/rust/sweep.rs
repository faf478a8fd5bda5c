//! Sweeps: designs made from one by varying its keys.

use std::collections::HashMap;
use std::convert::Infallible;
use std::sync::{Mutex, PoisonError};

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};
use tilebind::report::sweep::FinishedSweep;
use tilebind::sweep::{Axis, Outcome, Plan, Request, SweepPoint, Value, run as work_on};

use crate::design::Design;
use crate::job::Told;
use crate::request::request;
use crate::shown::{self, Reduced};
use crate::{convert, fault, job, pickle, table};

/// The design of a point of a plan.
pub fn design_of(py: Python<'_>, plan: &Plan, point: &SweepPoint) -> PyResult<Design> {
    let mut source = plan.designs[point.design].clone();
    for (axis, value) in plan.axes.iter().zip(&point.values) {
        source = source.with(&axis.key, value.toml()).map_err(fault::value)?;
    }
    Design::of_source(py, source)
}

/// A key's values.
pub fn axis((key, values): (Bound<'_, PyAny>, Bound<'_, PyAny>)) -> PyResult<Axis> {
    let key: String = key.extract()?;
    let one = |value: Bound<'_, PyAny>| match convert::toml(&value)? {
        toml::Value::Boolean(truth) => Ok(Value::Truth(truth)),
        toml::Value::Integer(whole) => Ok(Value::Whole(whole)),
        toml::Value::Float(number) => Ok(Value::Number(number)),
        toml::Value::String(text) => Ok(Value::Text(text)),
        other => Err(fault::value(format!(
            "{key}: a value is a number, a string or a boolean, not {other}"
        ))),
    };
    let values = values.try_iter()?.map(|value| one(value?));
    let values = values.collect::<PyResult<Vec<_>>>()?;
    Ok(Axis::listed(key, values))
}

/// Vary keys of a design and analyse every resulting design.
///
/// Parameters
/// ----------
/// design : Design
/// vary : Mapping
///     Values by dotted path of the key, ``{"magnet.pitch": np.linspace(0.03, 0.05, 5)}``;
///     several keys make a grid, in which the first varies slowest.
#[doc = include_str!("keywords/sweep.txt")]
/// progress : bool, optional
///
/// Returns
/// -------
/// Sweep
///     Results are those of ``tilebind sweep``; a point's results do not depend on the
///     other points or the number of threads.
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
    let items = vary.items()?;
    let axes = items.iter().map(|item| axis(item.extract()?));
    let axes = axes.collect::<PyResult<Vec<_>>>()?;
    let asked = request::<Request>(settings)?;
    let designs = vec![(content.source.clone(), content.design.clone())];
    let plan = asked.plan(designs, axes).map_err(fault::of)?;
    job::check_memory(plan.check_memory(job::threads()))?;
    let (plan, outcomes) = job::run(py, progress, |told| {
        let known = Known::default();
        known.work(&plan, told);
        let work = |plan: &Plan| {
            known.work(plan, told);
            Ok::<(), Infallible>(())
        };
        let Ok((plan, _)) = asked.refined(plan, |plan| Some(known.outcomes(plan)), work);
        let outcomes = known.outcomes(&plan);
        (plan, outcomes)
    })?;
    Ok(Sweep { plan, outcomes })
}

/// The outcomes of points, by name.
#[derive(Default)]
struct Known(Mutex<HashMap<String, Outcome>>);

impl Known {
    /// Computes the points without an outcome.
    fn work(&self, plan: &Plan, told: &Told) {
        let all = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut points = plan.points();
        let count = points.len();
        points.retain(|point| !all().contains_key(&point.name));
        told.tell(0.0, format!("{count} points"));
        let Ok(()) = work_on(plan, &points, job::threads(), |point, outcome| {
            all().insert(point.name.clone(), outcome.clone());
            let done = all().len();
            let text = format!("{done} of {count} points");
            told.tell(done as f64 / count as f64, text);
            Ok::<(), Infallible>(())
        });
    }

    fn outcomes(&self, plan: &Plan) -> Vec<Outcome> {
        let all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let missing = || Outcome::Failed {
            reason: "it was not computed".to_owned(),
        };
        let points = plan.points().into_iter();
        points
            .map(|point| all.get(&point.name).cloned().unwrap_or_else(missing))
            .collect()
    }
}

/// Results of a sweep. Immutable.
#[pyclass(frozen, module = "tilebind")]
pub struct Sweep {
    plan: Plan,
    outcomes: Vec<Outcome>,
}

impl Sweep {
    fn swept(&self) -> FinishedSweep<'_> {
        FinishedSweep {
            plan: &self.plan,
            points: self.plan.points(),
            outcomes: self.outcomes.clone(),
        }
    }
}

#[pymethods]
impl Sweep {
    /// numpy.ndarray : One row per point, structured, for ``pandas.DataFrame``: the varied
    /// keys, ``status`` ("done", "impossible" or "failed"), ``reason``, every figure with
    /// its bounds.
    #[getter]
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table::array(py, &self.swept().numbers())
    }

    /// dict : All results and settings, as in ``report.json``.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        shown::report(py, &self.swept().document())
    }

    /// A short summary of the results.
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
    fn design(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = convert::whole)] index: usize,
    ) -> PyResult<Design> {
        let points = self.plan.points();
        let point = points.get(index).ok_or_else(|| {
            pyo3::exceptions::PyIndexError::new_err(format!("there are {} points", points.len()))
        })?;
        design_of(py, &self.plan, point)
    }

    /// Curves over one varied number, maps over two, as SVG documents.
    ///
    /// Returns
    /// -------
    /// list of str
    fn svg(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        shown::pictures(py, &self.swept().document())
    }

    /// The page of the sweep.
    ///
    /// Returns
    /// -------
    /// str
    fn report_html(&self, py: Python<'_>) -> PyResult<String> {
        shown::page(py, &self.swept().document(), "")
    }

    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        shown::notebook(py, self.summary(), self.svg(py)?)
    }

    fn __len__(&self) -> usize {
        self.outcomes.len()
    }

    fn __repr__(&self) -> String {
        let keys: Vec<&str> = self.plan.axes.iter().map(|axis| &axis.key[..]).collect();
        let (count, keys) = (self.outcomes.len(), keys.join(", "));
        format!("<tilebind.Sweep of {count} points over {keys}>")
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let Self { plan, outcomes } = slf.get();
        shown::reduced(slf, &(plan, outcomes))
    }

    #[staticmethod]
    fn _restore(bytes: &[u8]) -> PyResult<Self> {
        let (plan, outcomes) = pickle::load(bytes)?;
        Ok(Self { plan, outcomes })
    }
}
