//! One barrier, asked for.

use numpy::{AllowTypeChange, PyArrayLike1};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use tilebind::Configuration;
use tilebind::budget::Ended;
use tilebind::design::Design;
use tilebind::query::{self, Query, QueryError, Request};

use crate::request::request;
use crate::{convert, fault, job, table};

/// One pose.
pub fn pose(value: &Bound<'_, PyAny>) -> PyResult<Configuration> {
    let numbers: PyArrayLike1<'_, f64, AllowTypeChange> = value
        .extract()
        .map_err(|_| fault::value("a pose is three numbers: x (m), y (m) and theta (rad)"))?;
    let numbers = numbers.as_array().to_vec();
    match numbers[..] {
        [x, y, theta] if numbers.iter().all(|number| number.is_finite()) => {
            Ok(Configuration::from([x, y, theta]))
        }
        _ => Err(fault::value(format!(
            "a pose is three finite numbers, x (m), y (m) and theta (rad), not {numbers:?}"
        ))),
    }
}

/// What is asked.
pub fn query(
    py: Python<'_>,
    [start, end]: [Option<&Bound<'_, PyAny>>; 2],
    given: Option<&Bound<'_, PyDict>>,
    design: &tilebind::Design,
) -> PyResult<Query> {
    let given = given.cloned().unwrap_or_else(|| PyDict::new(py));
    let start = start.ok_or_else(|| fault::value("a way needs a start"))?;
    given.set_item("from", pose(start)?.to_array().to_vec())?;
    match end {
        Some(end) if !end.is_instance_of::<PyString>() => {
            given.set_item("to", pose(end)?.to_array().to_vec())?;
        }
        Some(end) => given.set_item("to", end)?,
        None => given.set_item("to", "free")?,
    }
    Ok(request::<Request>(Some(&given))?.query(design))
}

/// The answer, as a named tuple.
pub fn ask<'py>(
    py: Python<'py>,
    design: &Design,
    query: &Query,
    progress: Option<bool>,
) -> PyResult<Bound<'py, PyAny>> {
    let answer = job::run(py, progress, |told| query::barrier(design, query, told))?;
    let answer = answer.map_err(|error| match error {
        QueryError::NoWay => fault::run(error),
        _ => fault::value(error),
    })?;
    let barrier = &answer.barrier;
    let fields = PyDict::new(py);
    fields.set_item("lower", barrier.bounds.lower)?;
    fields.set_item("upper", barrier.bounds.upper)?;
    fields.set_item("path", table::pathway(py, &barrier.pathway)?)?;
    fields.set_item("saddle_energy", barrier.saddle_energy)?;
    let saddle = barrier.saddle.to_array().to_vec();
    fields.set_item("saddle_pose", table::grid(py, saddle, vec![3])?)?;
    fields.set_item("forward", barrier.forward())?;
    fields.set_item("reverse", barrier.reverse())?;
    fields.set_item("caged", barrier.bounds.caged)?;
    let why = answer.uncertified.map(|why| why.to_string());
    fields.set_item("uncertified", why)?;
    fields.set_item("ended_by", answer.ended.map(Ended::name))?;
    convert::named(py, "Barrier", &fields)
}
