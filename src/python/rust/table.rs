//! Structured arrays of NumPy, of which `pandas.DataFrame` makes tables. They cannot be written to.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::landscape::{Pathway, Place};
use tilebind::report::document::{Cell, Table};

/// A column by its name.
pub type Named = (String, Values);

/// The values of a column.
pub enum Values {
    /// Numbers; NaN where nothing is known.
    Real(Vec<f64>),
    /// Whole numbers.
    Whole(Vec<i64>),
    /// Texts.
    Text(Vec<String>),
    /// True or false.
    Truth(Vec<bool>),
}

impl Values {
    fn len(&self) -> usize {
        match self {
            Self::Real(values) => values.len(),
            Self::Whole(values) => values.len(),
            Self::Text(values) => values.len(),
            Self::Truth(values) => values.len(),
        }
    }

    /// What NumPy calls the type.
    fn kind(&self) -> String {
        match self {
            Self::Real(_) => "f8".to_owned(),
            Self::Whole(_) => "i8".to_owned(),
            Self::Text(values) => {
                let longest = values.iter().map(|text| text.chars().count()).max();
                format!("U{}", longest.unwrap_or(0).max(1))
            }
            Self::Truth(_) => "?".to_owned(),
        }
    }
}

/// `free` among the ids of states.
pub const FREE: i64 = -1;
/// No place at all.
const NOWHERE: i64 = -2;

/// A structured array of columns.
pub fn structured<'py>(py: Python<'py>, columns: Vec<Named>) -> PyResult<Bound<'py, PyAny>> {
    let numpy = py.import("numpy")?;
    let rows = columns.first().map_or(0, |(_, values)| values.len());
    let kinds: Vec<(&str, String)> = columns
        .iter()
        .map(|(name, values)| (name.as_str(), values.kind()))
        .collect();
    let array = numpy.call_method1("zeros", (rows, kinds))?;
    for (name, values) in columns {
        match values {
            Values::Real(values) => array.set_item(name, PyArray1::from_vec(py, values))?,
            Values::Whole(values) => array.set_item(name, PyArray1::from_vec(py, values))?,
            Values::Text(values) => array.set_item(name, values)?,
            Values::Truth(values) => array.set_item(name, PyArray1::from_vec(py, values))?,
        }
    }
    fixed(array)
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

/// The columns of a document's table: a column is of places, of whole numbers, of numbers (NaN where
/// nothing is known), true or false, or else of texts.
pub fn of_table(table: &Table) -> Vec<Named> {
    let named = table.columns().into_iter();
    named.map(|(key, cells)| (key, values(&cells))).collect()
}

fn values(cells: &[Cell]) -> Values {
    let any = |is: fn(&Cell) -> bool| cells.iter().any(is);
    if any(|cell| matches!(cell, Cell::Place(_))) {
        return Values::Whole(cells.iter().map(whole).collect());
    }
    if any(|cell| matches!(cell, Cell::Text(_))) {
        let text = |cell: &Cell| match cell {
            Cell::Text(text) => text.clone(),
            _ => String::new(),
        };
        return Values::Text(cells.iter().map(text).collect());
    }
    if any(|cell| matches!(cell, Cell::Truth(_))) {
        let truth = |cell: &Cell| matches!(cell, Cell::Truth(true));
        return Values::Truth(cells.iter().map(truth).collect());
    }
    if !cells.is_empty() && cells.iter().all(|cell| matches!(cell, Cell::Whole(_))) {
        return Values::Whole(cells.iter().map(whole).collect());
    }
    let real = |cell: &Cell| match cell {
        Cell::Number(value) if value.is_finite() => *value,
        Cell::Whole(value) => *value as f64,
        _ => f64::NAN,
    };
    Values::Real(cells.iter().map(real).collect())
}

fn whole(cell: &Cell) -> i64 {
    match cell {
        Cell::Place(Place::State(id)) => *id as i64,
        Cell::Place(Place::Free) => FREE,
        Cell::Whole(value) => *value as i64,
        _ => NOWHERE,
    }
}

/// The points of a pathway.
pub fn pathway<'py>(py: Python<'py>, pathway: &Pathway) -> PyResult<Bound<'py, PyAny>> {
    let column = |name: &str, of: fn(&tilebind::landscape::PathwayPoint) -> f64| {
        let values = pathway.iter().map(of).collect();
        (name.to_owned(), Values::Real(values))
    };
    let columns = vec![
        column("s_m", |point| point.s),
        column("x_m", |point| point.configuration.x),
        column("y_m", |point| point.configuration.y),
        column("theta_rad", |point| point.configuration.theta),
        column("energy_J", |point| point.energy),
        column("clearance_m", |point| point.clearance),
    ];
    structured(py, columns)
}

/// Columns that hold texts, whatever these look like.
const TEXTS: [&str; 9] = [
    "design", "end", "model", "name", "point", "reason", "sha256", "states", "status",
];

/// The columns of a table of comma-separated values: a column is of whole numbers, of numbers (NaN
/// where a cell is empty), true or false, or else of texts.
pub fn of_csv(text: &str) -> Vec<Named> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let names: Vec<String> = reader
        .headers()
        .map(|names| names.iter().map(str::to_owned).collect())
        .unwrap_or_default();
    let rows: Vec<csv::StringRecord> = reader.records().filter_map(Result::ok).collect();
    let named = names.into_iter().enumerate().map(|(k, name)| {
        let cells: Vec<&str> = rows.iter().map(|row| row.get(k).unwrap_or("")).collect();
        let values = of_cells(&name, &cells);
        (name, values)
    });
    named.collect()
}

fn of_cells(name: &str, cells: &[&str]) -> Values {
    let texts = || Values::Text(cells.iter().map(|&cell| cell.to_owned()).collect());
    if TEXTS.contains(&name) {
        return texts();
    }
    let whole: Option<Vec<i64>> = cells.iter().map(|cell| cell.parse().ok()).collect();
    if let Some(whole) = whole {
        return Values::Whole(whole);
    }
    let real = |cell: &&str| match *cell {
        "" => Some(f64::NAN),
        cell => cell.parse().ok(),
    };
    if let Some(real) = cells.iter().map(real).collect::<Option<Vec<f64>>>() {
        return Values::Real(real);
    }
    let truth: Option<Vec<bool>> = cells.iter().map(|cell| cell.parse().ok()).collect();
    truth.map_or_else(texts, Values::Truth)
}
