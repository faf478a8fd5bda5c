//! Converts Python values to values of a design file, and JSON to Python values.

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyMapping, PyString};
use toml::{Table, Value};

use crate::fault;

/// Deepest nesting of tables and lists.
const DEEPEST: usize = 32;

/// A number, a text, a list or a mapping as a value of TOML.
pub fn toml(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    within(value, DEEPEST)
}

fn within(value: &Bound<'_, PyAny>, depth: usize) -> PyResult<Value> {
    if depth == 0 {
        return Err(fault::value("the value has too many levels"));
    }
    if let Ok(truth) = value.extract::<bool>() {
        return Ok(Value::Boolean(truth));
    }
    if value.is_instance_of::<PyString>() {
        return Ok(Value::String(value.extract()?));
    }
    if let Ok(whole) = value.extract::<i64>() {
        return Ok(Value::Integer(whole));
    }
    if let Ok(mapping) = value.cast::<PyMapping>() {
        return Ok(Value::Table(table_within(mapping, depth)?));
    }
    if let Ok(number) = value.extract::<f64>() {
        return Ok(Value::Float(number));
    }
    if let Ok(items) = value.try_iter() {
        let items = items.map(|item| within(&item?, depth - 1));
        return Ok(Value::Array(items.collect::<PyResult<_>>()?));
    }
    let kind = value.get_type().name()?;
    Err(fault::value(format!(
        "a design consists of numbers, strings, booleans, lists and dicts of them, not a {kind}"
    )))
}

/// A mapping as a table of TOML.
pub fn table(mapping: &Bound<'_, PyMapping>) -> PyResult<Table> {
    table_within(mapping, DEEPEST)
}

fn table_within(mapping: &Bound<'_, PyMapping>, depth: usize) -> PyResult<Table> {
    let mut table = Table::new();
    for item in mapping.items()? {
        let (key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item.extract()?;
        table.insert(key.str()?.extract()?, within(&value, depth - 1)?);
    }
    Ok(table)
}

/// A JSON text as dictionaries and lists.
pub fn json<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (text,))
}

/// An instance of a named tuple of the package.
pub fn named<'py>(
    py: Python<'py>,
    class: &str,
    fields: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyAny>> {
    let class = py.import("tilebind._results")?.getattr(class)?;
    class.call((), Some(fields))
}

/// Files by their names.
pub fn files<N: AsRef<str>>(
    py: Python<'_>,
    files: impl IntoIterator<Item = (N, Vec<u8>)>,
) -> PyResult<Bound<'_, PyDict>> {
    let named = PyDict::new(py);
    for (name, content) in files {
        named.set_item(name.as_ref(), PyBytes::new(py, &content))?;
    }
    Ok(named)
}
