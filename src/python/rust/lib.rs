//! The Python package: its classes and functions, each a thin wrapper of the library.
//!
//! - [`design`] - a pair of tiles, with the jobs that take one; [`poses`] - energies of many
//!   configurations;
//! - [`analysis`], [`comparison`], [`sweep`], [`search`], [`dock`], [`words`], [`assembly`], [`tolerance`], [`verification`] -
//!   the results of jobs;
//! - [`request`] - options as keyword arguments; [`job`] - long work: progress, ctrl-C, faults;
//! - [`shown`] - display of results; [`table`] - structured arrays; [`convert`] - conversion of
//!   Python values to values of a design file;
//! - [`fault`] - exceptions; [`pickle`] - results as bytes.

mod analysis;
mod assembly;
mod comparison;
mod convert;
mod design;
mod dock;
mod fault;
mod job;
mod pickle;
mod poses;
mod request;
mod search;
mod shown;
mod sweep;
mod table;
mod tolerance;
mod verification;
mod words;

use pyo3::exceptions::PyImportError;
use pyo3::prelude::*;
use tilebind::potential::simd::Level;

#[pymodule]
fn _tilebind(module: &Bound<'_, PyModule>) -> PyResult<()> {
    Level::chosen().map_err(PyImportError::new_err)?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<design::Design>()?;
    module.add_class::<analysis::Analysis>()?;
    module.add_class::<comparison::Comparison>()?;
    module.add_class::<search::Search>()?;
    module.add_class::<sweep::Sweep>()?;
    module.add_class::<dock::Docking>()?;
    module.add_function(wrap_pyfunction!(comparison::compare, module)?)?;
    module.add_function(wrap_pyfunction!(search::search, module)?)?;
    module.add_function(wrap_pyfunction!(sweep::sweep, module)?)?;
    module.add_function(wrap_pyfunction!(dock::dock, module)?)?;
    module.add_function(wrap_pyfunction!(words::words, module)?)?;
    module.add_function(wrap_pyfunction!(words::crosstalk, module)?)?;
    module.add_function(wrap_pyfunction!(assembly::assemble, module)?)?;
    module.add_function(wrap_pyfunction!(tolerance::tolerance, module)?)?;
    module.add_function(wrap_pyfunction!(verification::verify, module)?)
}
