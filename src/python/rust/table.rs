//! Read-only structured NumPy arrays, of which `pandas.DataFrame` makes tables.

use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::landscape::{Pathway, Place};
use tilebind::report::document::{Cell, Table, rows};

/// `free` among the ids of states.
pub const FREE: i64 = -1;
/// No place at all.
const NOWHERE: i64 = -2;

/// A column with its name and its NumPy type.
type Named<'py> = (String, String, Bound<'py, PyAny>);

/// A structured array of a table's columns, each of places, whole numbers, numbers (NaN if not
/// known), truth values, or texts.
pub fn array<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyAny>> {
    let columns = table.columns().into_iter();
    let columns = columns.map(|(name, cells)| column(py, name, &cells));
    let columns = columns.collect::<PyResult<Vec<Named>>>()?;
    let kinds: Vec<_> = columns.iter().map(|(name, kind, _)| (name, kind)).collect();
    let zeros = py.import("numpy")?.getattr("zeros")?;
    let array = zeros.call1((table.rows.len(), kinds))?;
    for (name, _, values) in &columns {
        array.set_item(name, values)?;
    }
    fixed(array)
}

fn column<'py>(py: Python<'py>, name: String, cells: &[Cell]) -> PyResult<Named<'py>> {
    fn of<'py, T: Element>(py: Python<'py>, values: impl Iterator<Item = T>) -> Bound<'py, PyAny> {
        PyArray1::from_vec(py, values.collect()).into_any()
    }
    let any = |is: fn(&Cell) -> bool| cells.iter().any(is);
    let all_whole = !cells.is_empty() && cells.iter().all(|cell| matches!(cell, Cell::Whole(_)));
    let (kind, values) = match () {
        () if all_whole || any(|cell| matches!(cell, Cell::Place(_))) => {
            ("i8".to_owned(), of(py, cells.iter().map(whole)))
        }
        () if any(|cell| matches!(cell, Cell::Text(_))) => {
            let text = |cell: &Cell| match cell {
                Cell::Text(text) => text.clone(),
                _ => String::new(),
            };
            let texts: Vec<String> = cells.iter().map(text).collect();
            let longest = texts.iter().map(|text| text.chars().count()).max();
            let kind = format!("U{}", longest.unwrap_or(0).max(1));
            (kind, texts.into_pyobject(py)?)
        }
        () if any(|cell| matches!(cell, Cell::Truth(_))) => {
            let truth = |cell: &Cell| matches!(cell, Cell::Truth(true));
            ("?".to_owned(), of(py, cells.iter().map(truth)))
        }
        () => {
            let real = |cell: &Cell| match cell {
                Cell::Number(value) if value.is_finite() => *value,
                Cell::Whole(value) => *value as f64,
                _ => f64::NAN,
            };
            ("f8".to_owned(), of(py, cells.iter().map(real)))
        }
    };
    Ok((name, kind, values))
}

fn whole(cell: &Cell) -> i64 {
    match cell {
        Cell::Place(Place::State(id)) => *id as i64,
        Cell::Place(Place::Free) => FREE,
        Cell::Whole(value) => *value as i64,
        _ => NOWHERE,
    }
}

/// An array that cannot be written to.
pub fn fixed(array: Bound<'_, PyAny>) -> PyResult<Bound<'_, PyAny>> {
    let how = PyDict::new(array.py());
    how.set_item("write", false)?;
    array.call_method("setflags", (), Some(&how))?;
    Ok(array)
}

/// A fixed array of numbers of a shape.
pub fn grid<'py>(
    py: Python<'py>,
    values: Vec<f64>,
    shape: Vec<usize>,
) -> PyResult<Bound<'py, PyAny>> {
    fixed(PyArray1::from_vec(py, values).reshape(shape)?.into_any())
}

/// The points of a pathway.
pub fn pathway<'py>(py: Python<'py>, pathway: &Pathway) -> PyResult<Bound<'py, PyAny>> {
    let points = rows(pathway)
        .data("s_m", |point| point.s)
        .data("pose", |point| point.configuration)
        .data("energy_J", |point| point.energy)
        .data("clearance_m", |point| point.clearance);
    array(py, &points.table(""))
}

/// The columns of comma-separated values.
pub fn of_csv(text: &str) -> Table {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let names = reader.headers().cloned().unwrap_or_default();
    let mut table = rows(reader.records().filter_map(Result::ok));
    for (k, name) in names.iter().enumerate() {
        let cell = move |row: &csv::StringRecord| match row.get(k).unwrap_or("") {
            "" => Cell::Missing,
            text => match (text.parse::<i32>(), text.parse::<f64>()) {
                (Ok(whole), _) => whole.into(),
                (_, Ok(number)) => number.into(),
                _ => text.into(),
            },
        };
        table = table.data(name.to_owned(), cell);
    }
    table.table("")
}
