//! Between a design and the workshop: files to make tiles by, and constants from measurements.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::calibration::bonds::PairTimes;
use tilebind::calibration::distances::PairDistances;
use tilebind::calibration::{self, Specimen};
use tilebind::design::Design;
use tilebind::kinetics::Hold;
use tilebind::observer::Silent;
use tilebind::workshop::Making;
use tilebind::{Settings, pipeline, report};

use crate::{convert, fault, job};

/// Lengths above this are meant in millimetres (m).
const LONGEST: f64 = 0.01;

/// The files for the workshop by their names.
pub fn files<'py>(
    py: Python<'py>,
    design: &Design,
    making: &Making,
) -> PyResult<Bound<'py, PyDict>> {
    for (name, length) in [("kerf", making.kerf), ("clearance", making.clearance)] {
        if !(0.0..=LONGEST).contains(&length) {
            return Err(fault::value(format!(
                "{name} = {length} m: from 0 to {LONGEST} m"
            )));
        }
    }
    let files = py.detach(|| report::workshop::files(design, making));
    convert::files(py, files.map_err(fault::value)?)
}

/// A calibration from a table of measurements.
pub fn calibrated<'py>(
    py: Python<'py>,
    design: &Design,
    table: &Bound<'py, PyAny>,
    hold_out: usize,
) -> PyResult<Bound<'py, PyAny>> {
    if !(2..=usize::from(u16::MAX)).contains(&hold_out) {
        return Err(fault::value(format!("hold_out = {hold_out}: at least 2")));
    }
    let rows = calibration::read_rows(&text(table)?).map_err(fault::value)?;
    let found = job::quietly(py, || {
        let (specimen, settings) = Specimen::of(design, hold_out);
        calibration::calibrate(&specimen, &rows, &settings)
    })?;
    let found = found.map_err(fault::value)?;
    convert::json(py, &report::calibration::shields(design, &found).report())
}

/// The kT at which pairs bind and part as in a table of intervals.
pub fn kt_of_bonds<'py>(
    py: Python<'py>,
    design: &Design,
    table: &Bound<'py, PyAny>,
    area: Option<f64>,
    within: Option<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    fault::positive("area", area)?;
    fault::positive("within", within)?;
    let text = text(table)?;
    if PairDistances::is_named_in(&text) {
        let read = PairDistances::read(&text).map_err(fault::value)?;
        let within = within.unwrap_or(design.space().free_distance);
        let found = job::quietly(py, || {
            read.fit(&design.problem(), &design.pair.bound, within)
                .map(|found| report::calibration::distances(design, &found).report())
        })?;
        return convert::json(py, &found.map_err(fault::value)?);
    }
    let times = PairTimes::read(&text).map_err(fault::value)?;
    let area = area.unwrap_or(design.table[0] * design.table[1]);
    let found = job::quietly(py, || {
        let settings = Settings::without_proofs(Settings::default().seed);
        let analysis = pipeline::analyse(design, &settings, &Silent);
        let bond = Hold::bond(&analysis.problem, &analysis.catalogue);
        bond.map(|bond| report::calibration::intervals(design, &times, &bond, area).report())
    })?;
    convert::json(py, &found.map_err(fault::run)?)
}

/// A table as CSV: of a frame, or of the file of that name.
fn text(table: &Bound<'_, PyAny>) -> PyResult<String> {
    if table.hasattr("to_csv")? {
        let keywords = PyDict::new(table.py());
        keywords.set_item("index", false)?;
        return table.call_method("to_csv", (), Some(&keywords))?.extract();
    }
    let path: std::path::PathBuf = table.extract()?;
    Ok(std::fs::read_to_string(path)?)
}
