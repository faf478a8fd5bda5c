//! What a design says: names, outlines, magnets, itself at a glance.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tilebind::design::Design as Whole;
use tilebind::inspection::Inspection;
use tilebind::report::inspection;
use tilebind::report::plots::{Sheet, glance};

use super::Design;
use crate::table::{self, Named, Values};
use crate::{convert, fault};

#[pymethods]
impl Design {
    /// str : Its name.
    #[getter]
    fn name(&self) -> &str {
        &self.content.design.name
    }

    /// str : What the file says of it.
    #[getter]
    fn description(&self) -> &str {
        &self.content.design.description
    }

    /// str : SHA-256 of the text, in hexadecimal.
    #[getter]
    fn sha256(&self) -> &str {
        &self.content.design.sha256
    }

    /// str : How magnets are modelled, "dipole" or "cuboid", unless a call says otherwise.
    #[getter]
    fn model(&self) -> &'static str {
        self.content.design.interaction.model.name()
    }

    /// tuple of str : Doubts that do not keep the design from being used.
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

    /// tuple of float : Size of the air table (m) along x and along y.
    #[getter]
    fn table(&self) -> (f64, f64) {
        self.content.design.table.into()
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
        let magnets = &self.tile(tile)?.magnets;
        let real = |name: &str, of: fn(&tilebind::tile::Magnet) -> f64| -> Named {
            (
                name.to_owned(),
                Values::Real(magnets.iter().map(of).collect()),
            )
        };
        let faces = magnets.iter().map(|magnet| magnet.face as i64).collect();
        let columns = vec![
            real("x_m", |magnet| magnet.position.x),
            real("y_m", |magnet| magnet.position.y),
            real("angle_rad", |magnet| magnet.angle),
            real("moment_A_m2", |magnet| magnet.moment),
            real("remanence_T", tilebind::tile::Magnet::remanence),
            real("length_m", |magnet| magnet.size[0]),
            real("width_m", |magnet| magnet.size[1]),
            real("height_m", |magnet| magnet.size[2]),
            ("face".to_owned(), Values::Whole(faces)),
        ];
        table::structured(py, columns)
    }

    /// The design at a glance: its bond, the forces that hold it, what is wrong with it.
    ///
    /// Returns
    /// -------
    /// str
    fn summary(&self, py: Python<'_>) -> String {
        const COLUMNS: usize = 100;
        py.detach(|| {
            let design = &self.content.design;
            inspection::text(design, &Inspection::new(design), COLUMNS)
        })
    }

    /// The same as numbers.
    ///
    /// Returns
    /// -------
    /// dict
    fn show<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let design = &self.content.design;
        let shown = py.detach(|| inspection::json(design, &Inspection::new(design)).to_string());
        convert::json(py, &shown)
    }

    /// The two tiles bound, as an SVG document.
    ///
    /// Returns
    /// -------
    /// str
    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        let design = &self.content.design;
        let picture = py.detach(|| glance::draw(design, &Inspection::new(design), &Sheet::SCREEN));
        picture.map(|picture| picture.svg).map_err(fault::run)
    }

    /// The magnets as magpylib collections, and, with poses, the moving ones' path.
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
        let html = py.import("tilebind._html")?;
        html.call_method1("page", (self.summary(py), vec![self.svg(py)?]))
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
