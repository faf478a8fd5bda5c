//! Exceptions: what is wrong and how to fix it.

use std::ffi::CString;
use std::fmt::Display;
use std::io::ErrorKind;
use std::path::Path;

use pyo3::exceptions::{PyFileNotFoundError, PyRuntimeError, PyRuntimeWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use tilebind::request::Unanswered;
use tilebind::{Refused, design};

/// The exception `tilebind.DesignError` of a fault, with its place and its fix.
pub fn design(py: Python<'_>, fault: &design::DesignError) -> PyErr {
    exception(py, fault).map_or_else(|error| error, PyErr::from_value)
}

/// A fault without a place in a file.
pub fn of_design(py: Python<'_>, file: &str, message: String, help: &str) -> PyErr {
    design(py, &design::DesignError::new(file, None, message, help))
}

/// The exception of a refused job: a `ValueError`, or `tilebind.DesignError` for a file.
pub fn refused(py: Python<'_>, why: &Refused) -> PyErr {
    match why {
        Refused::File(fault) => design(py, fault),
        Refused::Asked(message) => value(message),
    }
}

fn exception<'py>(py: Python<'py>, fault: &design::DesignError) -> PyResult<Bound<'py, PyAny>> {
    let also = fault.also.iter().map(|one| exception(py, one));
    let also = PyTuple::new(py, also.collect::<PyResult<Vec<_>>>()?)?;
    let place = fault.place.as_ref();
    let more = PyDict::new(py);
    more.set_item("file", &fault.file)?;
    more.set_item("line", place.map(|place| place.line))?;
    more.set_item("column", place.map(|place| place.column))?;
    more.set_item("message", &fault.message)?;
    more.set_item("fix", &fault.help)?;
    more.set_item("also", also)?;
    let class = py.import("tilebind._errors")?.getattr("DesignError")?;
    class.call((fault.to_string(),), Some(&more))
}

/// The exception of a job without a result: a `ValueError` if the request has none.
pub fn of(error: impl Unanswered) -> PyErr {
    match error.is_of_the_question() {
        true => value(error.to_string().replace("--", "")),
        false => run(error),
    }
}

/// A `FileNotFoundError` if there is no such file.
pub fn if_missing(path: &Path) -> PyResult<()> {
    match path.metadata() {
        Err(error) if error.kind() == ErrorKind::NotFound => {
            let (code, text) = (error.raw_os_error(), "No such file or directory");
            let file = path.display().to_string();
            Err(PyFileNotFoundError::new_err((code, text, file)))
        }
        _ => Ok(()),
    }
}

/// A `ValueError`.
pub fn value(message: impl Display) -> PyErr {
    PyValueError::new_err(message.to_string())
}

/// A `RuntimeError`: the work failed.
pub fn run(message: impl Display) -> PyErr {
    PyRuntimeError::new_err(message.to_string())
}

/// A `RuntimeWarning`: there is a result nevertheless.
pub fn warn(py: Python<'_>, message: impl Display) -> PyResult<()> {
    let text = CString::new(message.to_string())?;
    PyErr::warn(py, &py.get_type::<PyRuntimeWarning>(), &text, 1)
}

/// A `ValueError` unless a number is positive (and finite).
pub fn positive(name: &str, number: Option<f64>) -> PyResult<()> {
    match number {
        Some(number) if !(number > 0.0 && number.is_finite()) => {
            Err(value(format!("{name} must be above 0, not {number}")))
        }
        _ => Ok(()),
    }
}
