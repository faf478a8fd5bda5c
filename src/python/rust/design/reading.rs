//! Reads designs from files, text and dictionaries, writes them as text, and pickles them.

use std::path::PathBuf;

use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};
use tilebind::checksum::sha256;
use tilebind::design::DesignError;
use tilebind::start;
use tilebind::sweep::DesignSource;

use super::Design;
use crate::request::request;
use crate::shown::{self, Reduced};
use crate::{convert, fault, pickle};

#[pymethods]
impl Design {
    /// Read a design file.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     The TOML file. Paths of drawings are relative to it.
    ///
    /// Returns
    /// -------
    /// Design
    ///
    /// Raises
    /// ------
    /// DesignError
    ///     If the file is wrong; lists every mistake with line, column and fix.
    /// FileNotFoundError
    ///     If the file does not exist.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        fault::if_missing(&path)?;
        let read = py.detach(|| DesignSource::read(&path));
        Self::read(py, read)
    }

    /// Read a design from its text.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     TOML, as in a design file.
    /// file : str, optional
    ///     File name for error messages. Drawings are relative to it, and it is the default
    ///     name of the design.
    ///
    /// Returns
    /// -------
    /// Design
    ///
    /// Raises
    /// ------
    /// DesignError
    #[staticmethod]
    #[pyo3(signature = (text, *, file = "design.toml"))]
    fn loads(py: Python<'_>, text: &str, file: &str) -> PyResult<Self> {
        let read = py.detach(|| DesignSource::of_text(text, file));
        Self::read(py, read)
    }

    /// Make a design from nested dictionaries with the keys of a design file.
    ///
    /// Parameters
    /// ----------
    /// tables : Mapping
    ///     Such as ``{"table": {"size": [2, 2]}, "magnet": {...}, "fixed": {...}, ...}``.
    ///
    /// Returns
    /// -------
    /// Design
    ///
    /// Raises
    /// ------
    /// DesignError
    ///     Its line numbers refer to :attr:`text`, which is generated from the dictionaries.
    #[staticmethod]
    fn from_dict(py: Python<'_>, tables: &Bound<'_, PyMapping>) -> PyResult<Self> {
        let text = convert::table(tables)?.to_string();
        Self::loads(py, &text, "design.toml")
    }

    /// Make a design to start from, as ``tilebind init`` writes it.
    ///
    /// Parameters
    /// ----------
    /// name : str, optional
    #[doc = include_str!("../keywords/start.txt")]
    ///
    /// Returns
    /// -------
    /// Design
    #[staticmethod]
    #[pyo3(signature = (name = "starter", **settings))]
    fn start(py: Python<'_>, name: &str, settings: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let text = request::<start::Request>(settings)?.text(name);
        Self::loads(py, &text.map_err(fault::value)?, "design.toml")
    }

    /// The same design with a key set to another value.
    ///
    /// Parameters
    /// ----------
    /// key : str
    ///     Dotted path, such as ``"fixed.faces.east.profile.depth"``; a number is the index of
    ///     a list item, from 0. Missing tables are created.
    /// value : float, int, bool, str, list or Mapping
    ///     In SI units, or a string with a unit, ``"20 mm"``.
    ///
    /// Returns
    /// -------
    /// Design
    ///     A new design.
    ///
    /// Raises
    /// ------
    /// DesignError
    ///     If the key does not exist or the resulting design is wrong.
    fn replace(&self, py: Python<'_>, key: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let source = &self.content.source;
        let value = convert::toml(value)?;
        let asked = format!("{key} = {value}");
        let with = source.with(key, value).map_err(|reason| {
            let help = "name a key by its dotted path, such as fixed.faces.east.profile.depth";
            fault::of_design(py, &source.file, reason, help)
        })?;
        // The place refers to generated text that the user has not seen.
        let design = with.design().map_err(|found| DesignError {
            message: format!("{asked}: {}", found.message),
            place: None,
            ..found
        });
        Self::read(py, design.map(|design| (with, design)))
    }

    /// The design as nested dictionaries.
    ///
    /// Returns
    /// -------
    /// dict
    ///     The argument of :meth:`from_dict`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let source = &self.content.source;
        let tables = py
            .import("tomllib")?
            .call_method1("loads", (&source.text,))?;
        // A design without a name has that of its file.
        if !tables.contains("name")? {
            tables.set_item("name", &source.name)?;
        }
        Ok(tables)
    }

    /// str : The design as TOML.
    #[getter]
    fn text(&self) -> &str {
        &self.content.source.text
    }

    fn __eq__<'py>(&self, py: Python<'py>, other: &Bound<'py, PyAny>) -> PyResult<Py<PyAny>> {
        match other.cast::<Self>() {
            // Independent of its notation, and of where it was read from.
            Ok(other) => {
                let (one, other) = (&self.content.source, &other.get().content.source);
                let same = one.drawings == other.drawings && one.document() == other.document();
                same.into_py_any(py)
            }
            Err(_) => Ok(py.NotImplemented()),
        }
    }

    fn __hash__(&self) -> u64 {
        // The checksum is effectively random.
        let checksum = sha256(self.content.source.document().to_string());
        u64::from_str_radix(&checksum[..16], 16).unwrap_or(0)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        shown::reduced(slf, &slf.get().content.source)
    }

    #[staticmethod]
    fn _restore(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        Self::of_source(py, pickle::load(bytes)?)
    }
}
