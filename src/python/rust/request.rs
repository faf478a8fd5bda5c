//! Requests from keyword arguments: the options of the program, with their limits and defaults.

use clap::Args;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyString};
use tilebind::request::{Misused, of_keywords};

/// A request from keyword arguments; `None` means the default.
pub fn request<R: Args>(given: Option<&Bound<'_, PyDict>>) -> PyResult<R> {
    let mut words = Vec::new();
    for (key, value) in given.into_iter().flatten() {
        words.push((key.extract()?, values(&value)?));
    }
    of_keywords(words).map_err(|error| match error {
        Misused::Unknown(..) => PyTypeError::new_err(error.to_string()),
        Misused::Wrong(message) => PyValueError::new_err(message),
    })
}

/// The same with a positional argument.
pub fn request_with<'py, R: Args>(
    py: Python<'py>,
    given: Option<&Bound<'py, PyDict>>,
    key: &str,
    value: impl IntoPyObject<'py>,
) -> PyResult<R> {
    let all = given.map_or_else(|| Ok(PyDict::new(py)), |given| given.copy())?;
    all.set_item(key, value)?;
    request(Some(&all))
}

/// The values of an argument as on a command line: the items of a list separated by commas; a list
/// of lists as repeated options.
fn values(value: &Bound<'_, PyAny>) -> PyResult<Vec<String>> {
    if value.is_none() {
        return Ok(Vec::new());
    }
    if let Ok(truth) = value.cast::<PyBool>() {
        return Ok(truth.is_true().then(String::new).into_iter().collect());
    }
    if let Some(word) = word(value) {
        return Ok(vec![word]);
    }
    let items: Vec<Bound<'_, PyAny>> = value.try_iter()?.collect::<PyResult<_>>()?;
    let words: Option<Vec<String>> = items.iter().map(word).collect();
    match words {
        Some(words) => Ok(vec![words.join(",")]),
        None => Ok(items
            .iter()
            .map(values)
            .collect::<PyResult<Vec<_>>>()?
            .concat()),
    }
}

/// A text or a number as it is typed.
fn word(value: &Bound<'_, PyAny>) -> Option<String> {
    if let Ok(text) = value.cast::<PyString>() {
        return text.extract().ok();
    }
    if let Ok(whole) = value.extract::<i128>() {
        return Some(whole.to_string());
    }
    value.extract::<f64>().ok().map(|number| number.to_string())
}
