//! Requests from keyword arguments: the options of the program, with their limits and defaults.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping, PyString};
use tilebind::request::{Misused, Options, of_keywords};

use crate::{convert, fault};

/// A request from keyword arguments; `None` means the default.
pub fn request<R: Options>(given: Option<&Bound<'_, PyDict>>) -> PyResult<R> {
    let mut words = Vec::new();
    for (key, value) in given.into_iter().flatten() {
        let key: String = key.extract()?;
        let values = values(&value).map_err(|error| {
            match error.is_instance_of::<PyValueError>(value.py()) {
                true => fault::value(format!("{key}: {}", error.value(value.py()))),
                false => error,
            }
        })?;
        words.push((key, values));
    }
    of_keywords(words).map_err(|error| match error {
        Misused::Unknown(..) => PyTypeError::new_err(error.to_string()),
        Misused::Wrong(message) => PyValueError::new_err(message),
    })
}

/// The same with a positional argument.
pub fn request_with<'py, R: Options>(
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
    // Those of NumPy as well.
    if let Ok(truth) = value.extract::<bool>() {
        return Ok(truth.then(String::new).into_iter().collect());
    }
    if let Some(word) = word(value)? {
        return Ok(vec![word]);
    }
    if value.is_instance_of::<PyMapping>() {
        return Err(fault::value("a dict is no value"));
    }
    let items: Vec<Bound<'_, PyAny>> = value.try_iter()?.collect::<PyResult<_>>()?;
    let words: Vec<Option<String>> = items.iter().map(word).collect::<PyResult<_>>()?;
    let words: Option<Vec<String>> = words.into_iter().collect();
    match words {
        Some(words) if words.is_empty() => Err(fault::value("an empty list has no value")),
        Some(words) => Ok(vec![words.join(",")]),
        None => Ok(items
            .iter()
            .map(values)
            .collect::<PyResult<Vec<_>>>()?
            .concat()),
    }
}

/// A text or a number as it is typed; `None` for a list.
fn word(value: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
    if let Ok(text) = value.cast::<PyString>() {
        let text: String = text.extract()?;
        return match text.is_empty() {
            true => Err(fault::value("an empty text is no value")),
            false => Ok(Some(text)),
        };
    }
    convert::check_meant(value)?;
    if value.extract::<bool>().is_ok() {
        return Err(fault::value("truth values are no numbers"));
    }
    if let Ok(whole) = value.extract::<i128>() {
        return Ok(Some(whole.to_string()));
    }
    Ok(value.extract::<f64>().ok().map(|number| number.to_string()))
}
