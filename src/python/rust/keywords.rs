//! Keyword arguments that have defaults, taken one by one.

use std::cell::RefCell;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The keyword arguments of a call.
pub struct Keywords<'a, 'py> {
    given: Option<&'a Bound<'py, PyDict>>,
    known: RefCell<Vec<&'static str>>,
}

impl<'a, 'py> Keywords<'a, 'py> {
    /// Those that were given, if any.
    pub fn new(given: Option<&'a Bound<'py, PyDict>>) -> Self {
        Self {
            given,
            known: RefCell::default(),
        }
    }

    /// An argument, or what it is where it is not given, or `None`.
    pub fn or<T: FromPyObjectOwned<'py>>(&self, name: &'static str, default: T) -> PyResult<T> {
        Ok(self.get(name)?.unwrap_or(default))
    }

    /// An argument, if it is given and not `None`.
    pub fn get<T: FromPyObjectOwned<'py>>(&self, name: &'static str) -> PyResult<Option<T>> {
        self.known.borrow_mut().push(name);
        let Some(given) = self.given else {
            return Ok(None);
        };
        let value = given.get_item(name)?.filter(|value| !value.is_none());
        let Some(value) = value else { return Ok(None) };
        value.extract::<T>().map(Some).map_err(|error| {
            let error: PyErr = error.into();
            PyTypeError::new_err(format!("{name}: {error}"))
        })
    }

    /// Refuses what is not known.
    pub fn finish(self) -> PyResult<()> {
        let known = self.known.into_inner();
        for name in self.given.map(|given| given.keys()).into_iter().flatten() {
            let name: String = name.extract()?;
            if !known.contains(&name.as_str()) {
                return Err(PyTypeError::new_err(format!(
                    "there is no argument {name:?}; known: {}",
                    known.join(", ")
                )));
            }
        }
        Ok(())
    }
}
