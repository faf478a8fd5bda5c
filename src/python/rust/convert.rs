//! Converts Python values to values of a design file, and JSON to Python values.

use pyo3::prelude::*;
use pyo3::types::{
    PyByteArray, PyBytes, PyDict, PyFrozenSet, PyMapping, PyMemoryView, PySet, PyString,
};
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
    check_meant(value)?;
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

/// Whether a value is text or bytes, whose items Python and NumPy take for numbers or texts of their own.
pub fn is_text_or_bytes(value: &Bound<'_, PyAny>) -> bool {
    value.is_instance_of::<PyString>() || is_bytes(value)
}

fn is_bytes(value: &Bound<'_, PyAny>) -> bool {
    value.is_instance_of::<PyBytes>()
        || value.is_instance_of::<PyByteArray>()
        || value.is_instance_of::<PyMemoryView>()
}

/// Whether a value is an array of NumPy with masked entries, whose values are not meant.
pub fn is_masked(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    let masked = value.py().import("numpy")?.getattr("ma")?;
    masked.call_method1("is_masked", (value,))?.is_truthy()
}

/// Refuses what Python would turn into numbers, or into a list, in a way that is hardly meant: bytes, times,
/// sets, which have no order, and masked entries.
///
/// # Errors
/// With what it is.
pub fn check_meant(value: &Bound<'_, PyAny>) -> PyResult<()> {
    let none = |what: &str| {
        Err(fault::value(format!(
            "{what} no numbers, texts or lists of them"
        )))
    };
    if is_bytes(value) {
        return none("bytes are");
    }
    if value.is_instance_of::<PySet>() || value.is_instance_of::<PyFrozenSet>() {
        return none("sets have no order: they are");
    }
    // What has a type of NumPy or pandas.
    let Ok(kind) = value
        .getattr("dtype")
        .and_then(|dtype| dtype.getattr("kind"))
    else {
        return Ok(());
    };
    match &kind.extract::<String>()?[..] {
        "M" | "m" => none("dates and times are"),
        "c" => none("complex numbers are"),
        "S" | "V" => none("bytes and records are"),
        _ if is_masked(value)? => none("masked entries are"),
        _ => Ok(()),
    }
}

/// A whole number from 0. Python's truth values are whole numbers, too, but hardly meant as such.
pub fn whole(value: &Bound<'_, PyAny>) -> PyResult<usize> {
    check_number(value)?;
    value.extract()
}

/// A number that is no truth value.
pub fn real(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    check_number(value)?;
    value.extract()
}

/// Refuses truth values, and what is no number at all.
pub fn check_number(value: &Bound<'_, PyAny>) -> PyResult<()> {
    check_meant(value)?;
    match value.extract::<bool>() {
        Ok(_) => Err(fault::value("truth values are no numbers")),
        Err(_) => Ok(()),
    }
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
