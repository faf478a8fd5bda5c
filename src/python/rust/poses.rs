//! Functions of many configurations at once: arrays in, arrays out.

use numpy::{
    AllowTypeChange, PyArray1, PyArrayLike1, PyArrayLikeDyn, PyArrayMethods, PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyMemoryError, PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyInt, PyList, PyTuple};
use rayon::prelude::*;
use tilebind::potential::Potential;
use tilebind::{Configuration, interruption, memory};

use crate::{convert, fault, job};

/// Poses from users: anything that NumPy can convert to an array (..., 3) of x (m), y (m) and theta
/// (rad).
pub struct Poses<'py>(PyArrayLikeDyn<'py, f64, AllowTypeChange>);

impl<'py> std::ops::Deref for Poses<'py> {
    type Target = PyArrayLikeDyn<'py, f64, AllowTypeChange>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<'a, 'py> FromPyObject<'a, 'py> for Poses<'py> {
    type Error = PyErr;

    fn extract(value: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        check_numbers(&value)?;
        let array = value.extract();
        Ok(Self(array.map_err(|error| not_numbers(value.py(), error))?))
    }
}

/// Refuses what NumPy would turn into numbers although it has none: text, bytes, times, truth values, complex
/// numbers, objects that are no numbers, and arrays with masked entries, whose values are not meant.
fn check_numbers(value: &Bound<'_, PyAny>) -> PyResult<()> {
    check_within(value, DEEPEST)
}

/// Lists are looked at item by item: among numbers, NumPy takes truth values for numbers and forgets masks.
fn check_within(value: &Bound<'_, PyAny>, depth: usize) -> PyResult<()> {
    if value.is_exact_instance_of::<PyFloat>() || value.is_exact_instance_of::<PyInt>() {
        return Ok(());
    }
    if !value.is_instance_of::<PyList>() && !value.is_instance_of::<PyTuple>() {
        return check_array(value);
    }
    let Some(depth) = depth.checked_sub(1) else {
        return Err(fault::value("poses have too many levels of lists"));
    };
    value.py().check_signals()?;
    for item in value.try_iter()? {
        check_within(&item?, depth)?;
    }
    Ok(())
}

/// The same for what is no list: an array, or a single number.
fn check_array(value: &Bound<'_, PyAny>) -> PyResult<()> {
    let none = |what: &str| {
        Err(fault::value(format!(
            "{what} no poses: x (m), y (m) and theta (rad) are numbers"
        )))
    };
    if value.is_instance_of::<PyBool>() {
        return none("truth values are");
    }
    if convert::is_text_or_bytes(value) {
        return none("text and bytes are");
    }
    let numpy = value.py().import("numpy")?;
    let array = numpy.call_method1("asarray", (value,));
    let array = array.map_err(|error| not_numbers(value.py(), error))?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    match &kind[..] {
        "f" | "i" | "u" => {}
        "S" | "U" => return none("text and bytes are"),
        "M" | "m" => return none("dates and times are"),
        "b" => return none("truth values are"),
        "c" => return none("complex numbers are"),
        "O" => {
            let numbers = value.py().import("numbers")?;
            for item in array.getattr("flat")?.try_iter()? {
                if !is_number(&item?, &numbers)? {
                    return none("objects that are not real numbers are");
                }
            }
        }
        _ => return none("records are"),
    }
    match convert::is_masked(value)? {
        true => Err(fault::value(
            "masked entries are no poses: leave them out, or fill them (numpy.ma.filled(poses, numpy.nan))",
        )),
        false => Ok(()),
    }
}

/// Whether an object is a real number, by Python's module of kinds of numbers.
fn is_number(item: &Bound<'_, PyAny>, numbers: &Bound<'_, PyModule>) -> PyResult<bool> {
    let is_any = item.is_instance(&numbers.getattr("Number")?)?;
    // Decimal numbers are numbers, but not Real.
    let is_complex = item.is_instance(&numbers.getattr("Complex")?)?
        && !item.is_instance(&numbers.getattr("Real")?)?;
    Ok(is_any && !is_complex && !item.is_instance_of::<PyBool>())
}

/// The error of NumPy that has found no numbers, in our words; others as they are.
fn not_numbers(py: Python<'_>, error: PyErr) -> PyErr {
    let is_of_values = error.is_instance_of::<PyValueError>(py)
        || error.is_instance_of::<PyTypeError>(py)
        || error.is_instance_of::<PyOverflowError>(py);
    match is_of_values {
        true => fault::value(format!(
            "poses are an array (n, 3) of x (m), y (m) and theta (rad): {}",
            error.value(py)
        )),
        false => error,
    }
}

/// Deepest nesting of lists, that of NumPy's axes.
const DEEPEST: usize = 64;
/// Numbers of a pose beyond this (m, rad) count as infinite, since their powers would be.
const FARTHEST: f64 = 1e30;
/// Up to this number of poses, neither threads nor releasing the interpreter's lock pay off.
const FEW: usize = 64;
/// From this number on, threads pay off.
const MANY: usize = 2048;
/// Number of poses per task.
const BATCH: usize = 512;

/// `WIDTH` numbers for each pose, computed by `kernel` for several poses at a time. NaN if a pose
/// is not finite.
pub fn numbers<'py, const WIDTH: usize>(
    py: Python<'py>,
    poses: &Poses<'py>,
    kernel: impl Fn(&[Configuration], &mut [[f64; WIDTH]]) + Sync,
) -> PyResult<Bound<'py, PyAny>> {
    let shape = outer_shape(poses)?;
    let found = evaluate(py, poses, [f64::NAN; WIDTH], kernel)?;
    if WIDTH == 1 && shape.is_empty() {
        let one: f64 = found.iter().flatten().sum();
        return Ok(one.into_pyobject(py)?.into_any());
    }
    let mut shape = shape;
    if WIDTH > 1 {
        shape.push(WIDTH);
    }
    // The same memory as one slice of numbers.
    let array = PyArray1::from_vec(py, found.into_flattened());
    if shape.len() == 1 {
        return Ok(array.into_any());
    }
    Ok(array.reshape(shape)?.into_any())
}

/// A condition for each pose; false if a pose is not finite.
pub fn truths<'py>(
    py: Python<'py>,
    poses: &Poses<'py>,
    holds: impl Fn(&Configuration) -> bool + Sync,
) -> PyResult<Bound<'py, PyAny>> {
    let shape = outer_shape(poses)?;
    let found = evaluate(
        py,
        poses,
        false,
        |qs: &[Configuration], out: &mut [bool]| {
            for (q, held) in qs.iter().zip(out) {
                *held = holds(q);
            }
        },
    )?;
    if shape.is_empty() {
        let one = found.first().copied().unwrap_or(false);
        return Ok(one.into_pyobject(py)?.to_owned().into_any());
    }
    Ok(PyArray1::from_vec(py, found).reshape(shape)?.into_any())
}

/// The shape of an array of poses without its last axis.
fn outer_shape(poses: &Poses<'_>) -> PyResult<Vec<usize>> {
    match poses.shape() {
        [outer @ .., 3] => Ok(outer.to_vec()),
        shape => Err(fault::value(format!(
            "poses are an array (n, 3) of x (m), y (m) and theta (rad), not {shape:?}"
        ))),
    }
}

fn evaluate<T: Copy + Send + Sync>(
    py: Python<'_>,
    poses: &Poses<'_>,
    unknown: T,
    kernel: impl Fn(&[Configuration], &mut [T]) + Sync,
) -> PyResult<Vec<T>> {
    let copy: Vec<f64>;
    let numbers = match poses.as_slice() {
        Ok(numbers) if poses.is_c_contiguous() => numbers,
        _ => {
            let mut all = room(poses.len())?;
            all.extend(poses.as_array().iter());
            copy = all;
            &copy
        }
    };
    let (rows, _) = numbers.as_chunks::<3>();
    let mut out = room(rows.len())?;
    out.resize(rows.len(), unknown);
    if rows.len() <= FEW {
        some(rows, &mut out, &kernel);
    } else if rows.len() < MANY {
        py.detach(|| some(rows, &mut out, &kernel));
    } else {
        let out = &mut out;
        job::quietly(py, || {
            let parts = out.par_chunks_mut(BATCH).zip(rows.par_chunks(BATCH));
            parts.for_each(|(out, rows)| {
                interruption::check();
                some(rows, out, &kernel);
            });
        })?;
    }
    Ok(out)
}

/// Allocates room for a number of items. NumPy arrays can claim more items than memory holds, since
/// rows can be repeated.
fn room<T>(count: usize) -> PyResult<Vec<T>> {
    let bytes = count as f64 * size_of::<T>() as f64;
    let too_many = |_| PyMemoryError::new_err(format!("no memory for {:.1} GB", bytes / 1e9));
    memory::check_bytes(bytes).map_err(PyMemoryError::new_err)?;
    let mut room = Vec::new();
    room.try_reserve_exact(count).map_err(too_many)?;
    Ok(room)
}

/// Leaves `out` unchanged if a pose is not finite.
fn some<T: Copy>(rows: &[[f64; 3]], out: &mut [T], kernel: &impl Fn(&[Configuration], &mut [T])) {
    for (rows, out) in rows.chunks(BATCH).zip(out.chunks_mut(BATCH)) {
        let is_known = |row: &[f64; 3]| row.iter().all(|number| number.abs() <= FARTHEST);
        if rows.iter().all(is_known) {
            let qs: Vec<_> = rows.iter().copied().map(Configuration::from).collect();
            kernel(&qs, out);
            continue;
        }
        for (row, out) in rows.iter().zip(out) {
            if is_known(row) {
                kernel(&[Configuration::from(*row)], std::slice::from_mut(out));
            }
        }
    }
}

/// The time (s) of a potential for prepared poses on all cores.
pub fn kernel_seconds(
    py: Python<'_>,
    poses: &Poses<'_>,
    potential: &dyn Potential,
) -> PyResult<f64> {
    outer_shape(poses)?;
    let mut numbers: Vec<f64> = room(poses.len())?;
    numbers.extend(poses.as_array().iter());
    let qs: Vec<Configuration> = numbers
        .as_chunks::<3>()
        .0
        .iter()
        .map(|row| Configuration::from(*row))
        .collect();
    let mut out = vec![0.0; qs.len()];
    job::quietly(py, || {
        let start = std::time::Instant::now();
        let parts = out.par_chunks_mut(BATCH).zip(qs.par_chunks(BATCH));
        parts.for_each(|(out, qs)| potential.energies(qs, out));
        start.elapsed().as_secs_f64()
    })
}

/// One pose.
pub fn pose(value: &Bound<'_, PyAny>) -> PyResult<Configuration> {
    check_numbers(value)?;
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
