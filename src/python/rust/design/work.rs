//! The jobs that take a design.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use tilebind::budget::Ended;
use tilebind::calibration;
use tilebind::docking::{self, loosening, released};
use tilebind::query;
use tilebind::rates;
use tilebind::report;
use tilebind::table::{About, Request, compared, table as put};
use tilebind::workshop::{self, Made, Subject};
use tilebind::yields;

use super::Design;
use crate::poses::pose;
use crate::request::{request, request_with};
use crate::{convert, job, shown, table};

#[pymethods]
impl Design {
    /// Compute one barrier with certified bounds: the lowest maximum energy over all
    /// collision-free paths.
    ///
    /// Parameters
    /// ----------
    /// start : array_like
    ///     Initial pose (3,) (m, m, rad).
    /// end : array_like or "free", optional
    ///     Final pose; "free" for anywhere with the tiles far apart.
    #[doc = include_str!("../keywords/barrier.txt")]
    /// progress : bool, optional
    ///
    /// Returns
    /// -------
    /// Barrier
    ///     A named tuple: `lower`, `upper` (J, bounds of the saddle's energy), `path` (structured
    ///     array), `saddle_energy` (J), `saddle_pose`, `forward`, `reverse` (J), `caged`,
    ///     `uncertified`, `ended_by` ("work" or "clock" where one of these ended the narrowing).
    #[pyo3(signature = (start, end = None, *, progress = None, **settings))]
    fn barrier<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: Option<&Bound<'py, PyAny>>,
        progress: Option<bool>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let settings = settings.map_or_else(|| Ok(PyDict::new(py)), |given| given.copy())?;
        settings.set_item("from", pose(start)?.to_array().to_vec())?;
        match end {
            Some(end) if !end.is_instance_of::<PyString>() => {
                settings.set_item("to", pose(end)?.to_array().to_vec())?;
            }
            Some(end) => settings.set_item("to", end)?,
            None => settings.set_item("to", "free")?,
        }
        let design = &self.content.design;
        let asked = request::<query::Request>(Some(&settings))?;
        let query = job::run(py, Some(false), |told| asked.seated(design, told))?;
        job::check_memory(query.analysis(design).check_memory())?;
        let answer = job::answer(py, progress, |told| query::barrier(design, &query, told))?;
        let barrier = &answer.barrier;
        let fields = PyDict::new(py);
        fields.set_item("lower", barrier.bounds.lower)?;
        fields.set_item("upper", barrier.bounds.upper)?;
        fields.set_item("path", table::pathway(py, &barrier.pathway)?)?;
        fields.set_item("saddle_energy", barrier.saddle_energy)?;
        let saddle = barrier.saddle.to_array().to_vec();
        fields.set_item("saddle_pose", table::grid(py, saddle, vec![3])?)?;
        fields.set_item("forward", barrier.forward())?;
        fields.set_item("reverse", barrier.reverse())?;
        fields.set_item("caged", barrier.bounds.caged)?;
        let why = answer.uncertified.map(|why| why.to_string());
        fields.set_item("uncertified", why)?;
        fields.set_item("ended_by", answer.ended.map(Ended::name))?;
        convert::named(py, "Barrier", &fields)
    }

    /// Compute where and how soon a shaken tile ends after its release: overdamped motion
    /// at kT.
    ///
    /// Parameters
    /// ----------
    /// start : array_like
    ///     Initial pose (3,) (m, m, rad).
    #[doc = include_str!("../keywords/exits.txt")]
    ///
    /// Returns
    /// -------
    /// dict
    ///     As ``tilebind rates --start --json``: ``mean_exit_s`` and its estimated
    ///     relative error ``mean_exit_error``, ``exits`` (probabilities of bound first and free first), ``diffusion_m2_s``,
    ///     ``mesh`` (difference between the two finest meshes).
    #[pyo3(signature = (start, **settings))]
    fn exits<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let start = pose(start)?;
        let place = start.to_array().to_vec();
        let asked: rates::Request = request_with(py, settings, "start", place)?;
        job::check_memory(asked.check_memory(job::threads()))?;
        let posed = (&self.content.design, &**self.content.problem(None));
        let (found, check) = job::answer(py, Some(false), |told| asked.exit(posed, start, told))?;
        let document = report::rates::exit_document(posed.0, &found, check.as_ref());
        shown::report(py, &document)
    }

    /// Compute how many pairs are bound after a time on a shaken table, and which shaking
    /// binds most.
    ///
    /// Parameters
    /// ----------
    #[doc = include_str!("../keywords/yields.txt")]
    /// progress : bool, optional
    ///
    /// Returns
    /// -------
    /// dict
    ///     As ``tilebind yield --json``.
    #[pyo3(signature = (kt, *, progress = None, **settings))]
    fn yields<'py>(
        &self,
        py: Python<'py>,
        kt: Bound<'py, PyAny>,
        progress: Option<bool>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked: yields::Request = request_with(py, settings, "kt", kt)?;
        job::check_memory(asked.check_memory(job::threads()))?;
        let design = &self.content.design;
        let found = job::answer(py, progress, |told| yields::yields(design, &asked, told))?;
        shown::report(py, &report::yields::document(design, &asked, &found))
    }

    /// Simulate many tiles on one table, with contact, friction and drives; count bonds and traps.
    ///
    /// Parameters
    /// ----------
    #[doc = include_str!("../keywords/table.txt")]
    /// start : str or os.PathLike, optional
    ///     Instead of `count`: a CSV file of the initial tiles, with the columns `tile`, `kind`
    ///     ("fixed" or "moving"; not needed for a design of one kind), `x`, `y`, `theta`, `vx`, `vy`,
    ///     `omega` (m, rad, m/s, rad/s).
    /// progress : bool, optional
    ///
    /// Returns
    /// -------
    /// dict
    ///     As ``tilebind table --json``.
    // The implementation of calling `table`.
    #[pyo3(signature = (time, *, start = None, progress = None, **settings))]
    fn _on_table<'py>(
        &self,
        py: Python<'py>,
        time: Bound<'py, PyAny>,
        start: Option<std::path::PathBuf>,
        progress: Option<bool>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (design, asked) = (
            &self.content.design,
            request_with(py, settings, "time", time)?,
        );
        let asked: Request = asked;
        let text = start.as_deref().map(text_of).transpose()?;
        let found = job::answer(py, progress, |told| {
            let designs = std::slice::from_ref(design);
            let (about, mut crowd) = About::of_designs(designs)?;
            let text = text.as_deref().map(|text| ("start", text));
            let start = asked.start((&about, &crowd), text, told)?;
            crowd.goal = asked.goal((&about, &crowd), &start, told)?;
            asked.check()?;
            let found = put((&about, crowd), &asked, start, &[], told);
            let found = found.map_err(|error| error.to_string())?;
            let beside = compared((&about, designs), &asked, &found, told);
            Ok::<_, String>((about, found, beside))
        })?;
        let (about, found, beside) = found;
        let document = report::table::document(&about, &found, &asked, beside.as_ref());
        shown::report(py, &document)
    }

    /// Workshop files for both tiles: outlines with pockets, to scale, and a magnet sheet. Equal tiles
    /// are drawn once, as `tile.dxf`.
    ///
    /// Parameters
    /// ----------
    #[doc = include_str!("../keywords/make.txt")]
    ///
    /// Returns
    /// -------
    /// dict of str to bytes
    ///     File names and contents: DXF and SVG in mm, a sheet in Markdown.
    #[pyo3(signature = (**settings))]
    fn make<'py>(
        &self,
        py: Python<'py>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (design, making) = (
            &self.content.design,
            request::<workshop::Request>(settings)?,
        );
        let subject = Subject::of_design(design);
        let made = job::answer(py, Some(false), |_| Made::new(&subject, &making))?;
        let document = report::workshop::document(Some(design), &subject, &made);
        convert::files(py, document.beside)
    }

    /// Fit the constants of soft-iron shields to measured forces or energies.
    ///
    /// Parameters
    /// ----------
    /// table : pandas.DataFrame, str or os.PathLike
    ///     The measurements or a CSV file of them: `x_m`, `y_m`, `theta_rad`, `iron` (1 with the
    ///     shields in place, 0 without) and at least one of `energy_J`, `force_x_N`, `force_y_N`,
    ///     `torque_Nm`.
    /// hold_out : int, optional
    ///     Hold out one in this many rows from the fit of shields; 5 by default.
    ///
    /// Returns
    /// -------
    /// dict
    ///     The constants with their errors, and how well they predict the held-out rows.
    #[pyo3(signature = (table, *, hold_out = None))]
    fn calibrate<'py>(
        &self,
        py: Python<'py>,
        table: &Bound<'py, PyAny>,
        hold_out: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked: calibration::ForcesRequest = request_with(py, None, "hold_out", hold_out)?;
        let (design, text) = (&self.content.design, text(table)?);
        let found = job::answer(py, Some(false), |_| asked.of_forces(design, &text))?;
        shown::report(py, &report::calibration::document(design, &found))
    }

    /// Fit the magnets' remanence to forces over the gap of the target faces.
    ///
    /// Parameters
    /// ----------
    /// table : pandas.DataFrame, str or os.PathLike
    ///     The readings or a CSV file of them: the gap between the target faces and the force
    ///     that pulls them straight apart or pushes them together, in columns named with their
    ///     unit, such as `gap_mm` and `force_g`.
    ///
    /// Returns
    /// -------
    /// dict
    ///     As ``tilebind calibrate --gaps --json``: `remanence_T`, `interval_T`, `gap_offset_m`,
    ///     `misfit_rms`, `fits` and the readings with the fitted forces.
    fn calibrate_gaps<'py>(
        &self,
        py: Python<'py>,
        table: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (design, text) = (&self.content.design, text(table)?);
        let found = calibration::Fitted::of_gaps(design, &text);
        let found = job::answer(py, Some(false), |_| found)?;
        shown::report(py, &report::calibration::document(design, &found))
    }

    /// Fit the effective energy kT of the shaking to observed pairs.
    ///
    /// Parameters
    /// ----------
    /// table : pandas.DataFrame, str or os.PathLike
    ///     The measurements or a CSV file: `bound_s` and `apart_s`, intervals (s) during which
    ///     a pair was bound and apart, with unfinished intervals prefixed by `>`; or
    ///     `distance_m`, independent distances (m) between the reference points of a pair.
    #[doc = include_str!("../keywords/calibrate_bonds.txt")]
    ///
    /// Returns
    /// -------
    /// dict
    ///     As ``tilebind calibrate --bonds --json``.
    #[pyo3(signature = (table, **settings))]
    fn calibrate_bonds<'py>(
        &self,
        py: Python<'py>,
        table: &Bound<'py, PyAny>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked: calibration::PairsRequest = request(settings)?;
        let (design, text) = (&self.content.design, text(table)?);
        let found = job::answer(py, Some(false), |told| asked.of_pairs(design, &text, told))?;
        shown::report(py, &report::calibration::document(design, &found))
    }

    /// Start many times bound, with a thermal velocity, and measure the detachment rate
    /// under shaking.
    ///
    /// Parameters
    /// ----------
    /// shaking : float
    ///     Effective energy kT of random shaking (J).
    /// overdamped : bool, optional
    ///     Also compute the overdamped rate at the same kT and drag.
    /// progress : bool, optional
    /// **settings
    ///     As for :func:`tilebind.dock`; those of the start are ignored.
    ///
    /// Returns
    /// -------
    /// dict
    ///     As ``tilebind dock --from-bond --json``.
    #[pyo3(signature = (*, shaking, overdamped = false, progress = None, **settings))]
    fn releases<'py>(
        &self,
        py: Python<'py>,
        shaking: Bound<'py, PyAny>,
        overdamped: bool,
        progress: Option<bool>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked: docking::Request = request_with(py, settings, "shaking", shaking)?;
        crate::fault::positive("shaking", asked.shaking)?;
        job::check_memory(asked.check_memory())?;
        if overdamped {
            job::check_memory(docking::check_memory(job::threads()))?;
        }
        let (design, problem) = (&self.content.design, &**self.content.problem(None));
        let settings = asked.settings(&design.pair);
        let beside = overdamped
            .then(|| job::answer(py, progress, |told| loosening(design, &settings, told)));
        let found = job::answer(py, progress, |told| released(problem, &settings, told))?;
        let beside = beside.transpose()?;
        let document = report::release::document(design, &settings, &found, beside);
        shown::report(py, &document)
    }
}

/// A table as CSV: of a frame, or of the file of that name.
fn text(table: &Bound<'_, PyAny>) -> PyResult<String> {
    if table.hasattr("to_csv")? {
        let keywords = PyDict::new(table.py());
        keywords.set_item("index", false)?;
        return table.call_method("to_csv", (), Some(&keywords))?.extract();
    }
    let path: std::path::PathBuf = table.extract()?;
    text_of(&path)
}

/// The text of a table's file in any supported encoding.
fn text_of(path: &std::path::Path) -> PyResult<String> {
    let text = tilebind::text::read(path)?;
    Ok(tilebind::text::with_commas(&text).into_owned())
}
