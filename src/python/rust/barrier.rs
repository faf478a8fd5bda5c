//! One barrier, asked for.

use numpy::{AllowTypeChange, PyArrayLike1};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use tilebind::budget::Ended;
use tilebind::design::Design;
use tilebind::landscape::certificate::End;
use tilebind::query::{self, Query, QueryError};
use tilebind::{Configuration, Settings};

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
    [start, end]: [Option<&Bound<'_, PyAny>>; 2],
    tolerance: Option<f64>,
    [certify_work, certify_seconds]: [Option<f64>; 2],
    milestones: Option<usize>,
    seed: Option<u64>,
    design: &tilebind::Design,
) -> PyResult<Query> {
    let default = Settings::of([design]);
    let to = match end {
        None => End::Free,
        Some(end) if end.is_instance_of::<PyString>() => match end.extract::<String>()?.as_str() {
            "free" => End::Free,
            word => return Err(fault::value(format!("end = {word:?}: a pose, or \"free\""))),
        },
        Some(end) => End::At(pose(end)?),
    };
    let from = match start {
        Some(start) => pose(start)?,
        None => return Err(fault::value("a way needs a start")),
    };
    let usual = Settings::default().certify;
    let milestones = milestones.unwrap_or(default.milestones);
    fault::positive("tolerance", tolerance)?;
    fault::not_negative("certify_work", certify_work)?;
    fault::not_negative("certify_seconds", certify_seconds)?;
    fault::count("milestones", milestones)?;
    Ok(Query {
        from,
        to,
        settings: Settings {
            seed: seed.unwrap_or(default.seed),
            milestones,
            most_kinds: None,
            certify: usual.or(certify_work, certify_seconds, usual),
            ..default
        },
        tolerance,
    })
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
