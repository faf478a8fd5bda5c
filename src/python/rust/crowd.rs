//! Many tiles on a table.

use pyo3::prelude::*;
use tilebind::design::Design;
use tilebind::report::table::document;
use tilebind::table::{Request, of_design, table};

use crate::{convert, fault, job};

/// What a table of many tiles comes to. `start` is the text of a table of tiles at the start.
pub fn table_of<'py>(
    py: Python<'py>,
    design: &Design,
    request: &Request,
    start: Option<&str>,
    progress: Option<bool>,
) -> PyResult<Bound<'py, PyAny>> {
    request.check().map_err(fault::value)?;
    let found = job::run(py, progress, |told| {
        let crowd = of_design(design).map_err(|error| error.to_string())?;
        let start = request.start(&crowd, start.map(|text| ("start", text)))?;
        table(crowd, request, &start, told).map_err(|error| error.to_string())
    })?;
    let found = found.map_err(fault::value)?;
    convert::json(py, &document(design, &found, request.seed).report())
}
