//! The contents of a design: names, outlines, magnets, and its inspection.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tilebind::design::Design as Whole;
use tilebind::inspection::Inspection;
use tilebind::report::document::rows;
use tilebind::report::inspection::document;

use super::Design;
use crate::{shown, table};

#[pymethods]
impl Design {
    /// str : The name of the design.
    #[getter]
    fn name(&self) -> &str {
        &self.content.design.name
    }

    /// str : The description in the design file.
    #[getter]
    fn description(&self) -> &str {
        &self.content.design.description
    }

    /// str : SHA-256 of the text, in hexadecimal.
    #[getter]
    fn sha256(&self) -> &str {
        &self.content.design.sha256
    }

    /// str : The default magnet model, "dipole" or "cuboid".
    #[getter]
    fn model(&self) -> &'static str {
        self.content.design.interaction.model.name()
    }

    /// tuple of str : Non-fatal warnings.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let warnings = self.content.design.warnings.iter();
        PyTuple::new(py, warnings.map(ToString::to_string))
    }

    /// numpy.ndarray : The pose (3,) in which the two target faces coincide (m, m, rad).
    #[getter]
    fn bound<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let bound = self.content.design.pair.bound.to_array();
        table::fixed(PyArray1::from_slice(py, &bound).into_any())
    }

    /// AirTable : Size of the air table (m) along x and y. Call it to simulate many tiles.
    #[getter]
    fn table<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let class = slf.py().import("tilebind._results")?.getattr("AirTable")?;
        class.call1((slf.get().content.design.table, slf.getattr("_on_table")?))
    }

    /// The corners of a tile's outline, counter-clockwise, in the tile's own frame.
    ///
    /// Parameters
    /// ----------
    /// tile : {"fixed", "moving"}
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     (n, 2), in m. Curves are polygons within 0.2 mm.
    fn outline<'py>(&self, py: Python<'py>, tile: &str) -> PyResult<Bound<'py, PyAny>> {
        let vertices = self.tile(tile)?.outline.vertices();
        let numbers: Vec<f64> = vertices.iter().flat_map(|v| [v.x, v.y]).collect();
        table::grid(py, numbers, vec![vertices.len(), 2])
    }

    /// The magnets of a tile, in the tile's own frame.
    ///
    /// Parameters
    /// ----------
    /// tile : {"fixed", "moving"}
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Structured: `x_m`, `y_m` (the block's centre), `angle_rad` (of the moment, from the x
    ///     axis), `moment_A_m2`, `remanence_T`, `length_m` (along the moment), `width_m`,
    ///     `height_m` (through the tile), `face` (its number).
    fn magnets<'py>(&self, py: Python<'py>, tile: &str) -> PyResult<Bound<'py, PyAny>> {
        let magnets = rows(&self.tile(tile)?.magnets)
            .data("x_m", |magnet| magnet.position.x)
            .data("y_m", |magnet| magnet.position.y)
            .data("angle_rad", |magnet| magnet.angle)
            .data("moment_A_m2", |magnet| magnet.moment)
            .data("remanence_T", |magnet| magnet.remanence())
            .data("length_m", |magnet| magnet.size[0])
            .data("width_m", |magnet| magnet.size[1])
            .data("height_m", |magnet| magnet.size[2])
            .data("face", |magnet| magnet.face);
        table::array(py, &magnets.table("magnets"))
    }

    /// A short summary of the design: bond, forces, mistakes.
    ///
    /// Returns
    /// -------
    /// str
    fn summary(&self) -> String {
        let found = Inspection::new(&self.content.design);
        document(&self.content.design, &found).text(Some(100))
    }

    /// The summary as numbers.
    ///
    /// Returns
    /// -------
    /// dict
    fn show<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let found = Inspection::new(&self.content.design);
        shown::report(py, &document(&self.content.design, &found))
    }

    /// The two bound tiles as an SVG document.
    ///
    /// Returns
    /// -------
    /// str
    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        let found = Inspection::new(&self.content.design);
        let pictures = shown::pictures(py, &document(&self.content.design, &found));
        Ok(pictures?.concat())
    }

    /// The magnets as magpylib collections, with the moving tile's path if poses are given.
    ///
    /// Parameters
    /// ----------
    /// poses : array_like, optional
    ///     (3,) or (n, 3); the bound pose by default.
    ///
    /// Returns
    /// -------
    /// tuple of magpylib.Collection
    ///     The fixed tile's and the moving tile's, each of ``Cuboid`` magnets.
    #[pyo3(signature = (poses = None))]
    fn to_magpylib<'py>(
        slf: &Bound<'py, Self>,
        poses: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let module = slf.py().import("tilebind._magpylib")?;
        module.call_method1("collections", (slf, poses))
    }

    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        shown::notebook(py, self.summary(), vec![self.svg(py)?])
    }

    fn __repr__(&self) -> String {
        let Whole {
            name, interaction, ..
        } = &self.content.design;
        format!(
            "<tilebind.Design {name:?}, {} magnets>",
            interaction.model.name()
        )
    }
}
