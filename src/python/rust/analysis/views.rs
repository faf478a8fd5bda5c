//! Text, pages and pictures of an analysis.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::output::{Output, OutputError};
use tilebind::report::analysis::{self, Extent};
use tilebind::report::plots::Sheet;

use super::Analysis;
use crate::{fault, job, shown};

/// The pictures by their names.
const PICTURES: [&str; 7] = [
    "map",
    "approach",
    "profiles",
    "docking",
    "models",
    "disconnectivity",
    "disconnectivity-linear",
];

#[pymethods]
impl Analysis {
    /// A picture of the analysis as an SVG document.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     "map", "approach", "profiles", "docking", "models", "disconnectivity" or
    ///     "disconnectivity-linear".
    ///
    /// Returns
    /// -------
    /// str
    ///     Empty if there is nothing to draw.
    fn svg(&self, py: Python<'_>, name: &str) -> PyResult<String> {
        if !PICTURES.contains(&name) {
            return Err(fault::value(format!(
                "there is no picture {name:?}; there are: {}",
                PICTURES.join(", ")
            )));
        }
        let mut drawn = self.pictures(py, &[name])?;
        Ok(drawn.pop().unwrap_or_default())
    }

    /// A short summary of the results.
    ///
    /// Returns
    /// -------
    /// str
    fn summary(&self) -> String {
        const COLUMNS: usize = 100;
        self.document(Extent::Compact, &self.scene())
            .text(Some(COLUMNS))
    }

    /// An interactive HTML page with the landscape, animated pathways and sortable tables.
    ///
    /// Returns
    /// -------
    /// str
    ///     Self-contained HTML.
    fn report_html(&self, py: Python<'_>) -> PyResult<String> {
        let scene = self.scene();
        let document = self.document(Extent::Full, &scene);
        shown::page(py, &document, &self.command())
    }

    /// The text of ``report.json``, byte for byte as ``tilebind analyse`` writes it, except
    /// for the machine-dependent ``timing``.
    ///
    /// Returns
    /// -------
    /// str
    pub(super) fn report_json(&self) -> String {
        analysis::report(&self.content.design, &self.found, true, self.wall_s).report()
    }

    /// Write all files of ``tilebind analyse``, or none of them. They replace those of an
    /// earlier analysis; any other file in the way is an error.
    ///
    /// Parameters
    /// ----------
    /// folder : str or os.PathLike
    ///     Created if missing.
    /// compact : bool, optional
    ///     Omit the page, PNG pictures and pathways of symmetric copies.
    /// command : str, optional
    ///     The command line to show on the page.
    /// force : bool, optional
    ///     Replace existing files, whoever wrote them; never the design file and its drawings.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If a file is in the way; the message names it and gives a fix.
    /// OSError
    ///     If the file system refuses; all files are then unchanged.
    #[pyo3(signature = (folder, *, compact = false, command = None, force = false))]
    fn write(
        &self,
        py: Python<'_>,
        folder: std::path::PathBuf,
        compact: bool,
        command: Option<String>,
        force: bool,
    ) -> PyResult<()> {
        let extent = match compact {
            true => Extent::Compact,
            false => Extent::Full,
        };
        let command = command.unwrap_or_else(|| self.command());
        let inputs = self.content.source.files();
        let output = Output::folder(&analysis::FILES, &folder)
            .reading(inputs)
            .forced(force);
        output
            .check(|name| extent.may_hold(name))
            .map_err(not_written)?;
        let scene = self.scene();
        let (files, drawn) = job::quietly(py, || {
            let document = self.document(extent, &scene);
            analysis::files(&document, extent, &Sheet::SCREEN, &command)
        })?;
        output.write(&files).map_err(not_written)?;
        drawn.map_err(fault::run)
    }

    /// Draw the lowest energy around the fixed tile, with the states.
    ///
    /// Parameters
    /// ----------
    /// ax : matplotlib.axes.Axes, optional
    ///     Where to draw; the current axes by default.
    /// **style
    ///     For ``Axes.pcolormesh``.
    ///
    /// Returns
    /// -------
    /// matplotlib.axes.Axes
    #[pyo3(signature = (ax = None, **style))]
    fn plot_map<'py>(
        slf: &Bound<'py, Self>,
        ax: Option<Bound<'py, PyAny>>,
        style: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        shown::plotted(slf.py(), "plot_map", (slf, ax), style)
    }

    /// Draw the energy along a pathway.
    ///
    /// Parameters
    /// ----------
    /// start, end : int or str, optional
    ///     As for :meth:`pathway`; from the first state to free by default.
    /// ax : matplotlib.axes.Axes, optional
    /// **style
    ///     For ``Axes.plot``.
    ///
    /// Returns
    /// -------
    /// matplotlib.axes.Axes
    #[pyo3(signature = (start = None, end = None, ax = None, **style))]
    fn plot_profile<'py>(
        slf: &Bound<'py, Self>,
        start: Option<Bound<'py, PyAny>>,
        end: Option<Bound<'py, PyAny>>,
        ax: Option<Bound<'py, PyAny>>,
        style: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        shown::plotted(slf.py(), "plot_profile", (slf, start, end, ax), style)
    }

    /// Draw the energies at which kinds of states merge.
    ///
    /// Parameters
    /// ----------
    /// ax : matplotlib.axes.Axes, optional
    /// **style
    ///     For ``Axes.plot``.
    ///
    /// Returns
    /// -------
    /// matplotlib.axes.Axes
    #[pyo3(signature = (ax = None, **style))]
    fn plot_disconnectivity<'py>(
        slf: &Bound<'py, Self>,
        ax: Option<Bound<'py, PyAny>>,
        style: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        shown::plotted(slf.py(), "plot_disconnectivity", (slf, ax), style)
    }

    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let pictures = self.pictures(py, &["map", "disconnectivity"])?;
        shown::notebook(py, self.summary(), pictures)
    }

    fn __repr__(&self) -> String {
        let catalogue = &self.found.catalogue;
        format!(
            "<tilebind.Analysis {:?}, {} states in {} kinds, {} barriers>",
            self.content.design.name,
            catalogue.states.len(),
            catalogue.kinds().count(),
            catalogue.barriers.len()
        )
    }
}

fn not_written(error: OutputError) -> PyErr {
    match error {
        OutputError::Refused(message) => fault::value(message.replace("--force", "force=True")),
        error => pyo3::exceptions::PyOSError::new_err(error.to_string()),
    }
}
