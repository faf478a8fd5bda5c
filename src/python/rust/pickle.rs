//! Results as bytes (MessagePack) and back, exact to the last bit; readable only by the same
//! version of tilebind.

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::fault;

/// A value with the version that wrote it.
pub fn dump<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyBytes>> {
    let bytes = rmp_serde::to_vec_named(&(env!("CARGO_PKG_VERSION"), value)).map_err(fault::run)?;
    Ok(PyBytes::new(py, &bytes))
}

/// The value that [`dump`] wrote.
pub fn load<T: DeserializeOwned>(bytes: &[u8]) -> PyResult<T> {
    let version: Option<(String, serde::de::IgnoredAny)> = rmp_serde::from_slice(bytes).ok();
    let here = env!("CARGO_PKG_VERSION");
    match version {
        Some((version, _)) if version == here => {}
        Some((version, _)) => {
            return Err(fault::value(format!(
                "this was pickled by tilebind {version}, this is {here}: compute it again"
            )));
        }
        None => return Err(fault::value("these bytes are not a tilebind result")),
    }
    let (_, value): (String, T) = rmp_serde::from_slice(bytes)
        .map_err(|error| fault::value(format!("these bytes are not such a result: {error}")))?;
    Ok(value)
}
