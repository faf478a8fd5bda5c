//! The jobs that take a design.

use std::time::Instant;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use tilebind::budget::Ended;
use tilebind::calibration;
use tilebind::docking::{self, loosening, released};
use tilebind::pipeline;
use tilebind::query;
use tilebind::rates;
use tilebind::report;
use tilebind::table::{About, Request, compared, table as put};
use tilebind::workshop::{Made, Making};
use tilebind::yields::yields;

use super::Design;
use crate::analysis::Analysis;
use crate::dock::{self, Docking};
use crate::poses::pose;
use crate::request::{request, request_with};
use crate::{convert, job, shown, table};

#[pymethods]
impl Design {
    /// The main job: states, traps, barriers with their proofs, pathways.
    ///
    /// Parameters
    /// ----------
    /// seed : int, optional
    ///     Of all random numbers.
    /// milestones, neighbours : int, optional
    ///     Of the roadmap.
    /// boltzmann, thermal_energy : float, optional
    ///     Energies (J) by which milestones are accepted and transitions weighed.
    /// settled : float, optional
    ///     A barrier is settled when it moves by less than this fraction.
    /// far_starts : int, optional
    ///     Starts from which capture shares are counted.
    /// kinds : int, optional
    ///     Kinds of states that are looked at closely, the deepest; all by default.
    /// repeats : int, optional
    ///     Runs, each with the next seed, whose spread is reported.
    /// tolerance : float, optional
    ///     Width (J) to which certified bounds are narrowed.
    /// certify_work, complete_work : float, optional
    ///     Work given to the bounds of barriers, and to the proof that no state is missing, as what
    ///     takes about so many seconds of a core; it is counted. 0 for none.
    /// certify_seconds, complete_seconds : float, optional
    ///     Time (s) by the clock after which they are left as they are, so that another run may
    ///     differ; no limit by default, 0 for none.
    /// complete_below, complete_escape : float, optional
    ///     Shares of the bond's depth: traps below the one that need more than the other to leave
    ///     are to be listed.
    /// dynamics_runs : int, optional
    ///     Moving tiles that check each barrier.
    /// progress : bool, optional
    ///     A tqdm bar; by default where somebody would see it.
    ///
    /// Returns
    /// -------
    /// Analysis
    ///
    /// Notes
    /// -----
    /// The defaults are those of ``tilebind analyse``, and so are the results, byte by byte. Of very
    /// many magnets they are less, so that a result comes within minutes.
    /// Ctrl-C stops it within a second.
    #[pyo3(signature = (*, progress = None, **settings))]
    fn analyse(
        slf: Py<Self>,
        py: Python<'_>,
        progress: Option<bool>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Analysis> {
        let content = slf.get().content.clone();
        let settings = request::<pipeline::Request>(settings)?.settings(&content.design);
        job::check_memory(settings.milestones, settings.neighbours)?;
        let start = Instant::now();
        let found = job::run(py, progress, |told| {
            pipeline::analyse(&content.design, &settings, told)
        })?;
        let wall_s = start.elapsed().as_secs_f64();
        Ok(Analysis::new(slf, found, wall_s))
    }

    /// One barrier, between certified bounds: the lowest possible value of the highest energy on the
    /// way, over all free ways.
    ///
    /// Parameters
    /// ----------
    /// start : array_like
    ///     Pose (3,) at which the way starts (m, m, rad).
    /// end : array_like or "free", optional
    ///     Pose at which it ends; "free" for anywhere with the tiles far apart.
    /// tolerance : float, optional
    ///     Width (J) to which the bounds are narrowed; a hundredth of the bond's depth by default.
    /// certify_work : float, optional
    ///     Work given to them, as what takes about so many seconds of a core; 0 for no bounds.
    /// certify_seconds : float, optional
    ///     Time (s) by the clock after which they are left as they are, so that another run may
    ///     differ; no limit by default, 0 for no bounds.
    /// milestones, seed : int, optional
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
        let query = request::<query::Request>(Some(&settings))?.query(design);
        job::check_memory(query.settings.milestones, None)?;
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

    /// Send the moving tile towards the fixed one many times; see :func:`tilebind.dock`.
    #[pyo3(signature = (*, progress = None, **settings))]
    fn dock(
        slf: Py<Self>,
        py: Python<'_>,
        progress: Option<bool>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Docking> {
        dock::dock(py, slf, progress, settings)
    }

    /// Where a shaken tile that is let go ends, and how soon: overdamped motion at kT.
    ///
    /// Parameters
    /// ----------
    /// start : array_like
    ///     Pose (3,) at which it is let go (m, m, rad).
    /// kt : float
    ///     Effective energy of the shaking (J).
    /// drag : float, optional
    ///     Drag rate (1/s): the drag is this times the mass.
    /// basin_energy : float, optional
    ///     The tile is bound where its energy (J) is lower, in the basin of the bond or of one of
    ///     its copies; half the bond's by default.
    /// free_at : float, optional
    ///     It is free where the centres are so far apart (m).
    /// certify : float, optional
    ///     Refine until the bounds of the mean exit time are apart by this share at most; 0.1 by
    ///     default, as far as it comes within seconds.
    /// check : int, optional
    ///     Let so many rigid bodies with inertia go at the start, too.
    /// restitution : float, optional
    ///     Share of the approach velocity that a knock of these gives back; 1 by default.
    /// seed : int, optional
    ///     Of these.
    /// prove : bool, optional
    ///     Prove how often tiles set out from the well about the start, and bounds of the mean time
    ///     until they are at an end: for tiles that are convex about their centres of mass, of dipoles.
    ///
    /// Returns
    /// -------
    /// dict
    ///     As ``tilebind rates --start --json``: `mean_exit_s` and `mean_exit_bounds_s`, `exits`
    ///     (shares that are first bound and free), `diffusion_m2_s`, `proved` (None where nothing
    ///     is), `mesh` (how far the two finest meshes differ).
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
        let posed = (&self.content.design, &**self.content.problem(None));
        let (found, check) = job::answer(py, Some(false), |_| asked.exit(posed, start))?;
        let document = report::rates::exit_document(posed.0, &found, check.as_ref());
        shown::report(py, &document)
    }

    /// How many pairs are bound after a time on a shaken table, and at which shaking most are.
    ///
    /// Parameters
    /// ----------
    /// kt : sequence of float
    ///     Effective energies of the shakings that are compared (J).
    /// tiles : int
    ///     Tiles on the table, half of either kind.
    /// time : float
    ///     How long the table is shaken (s).
    /// coverage : float, optional
    ///     Share of the table that tiles cover.
    /// runs : int, optional
    ///     Docking runs for each shaking, from which attachments are counted.
    /// duration : float, optional
    ///     How long each lasts (s).
    /// rates : str, optional
    ///     Where attachment rates come from: "docking" runs, or "overdamped" motion.
    /// drag, restitution : float, optional
    ///     Drag rate (1/s), and the share of the approach velocity that a knock gives back.
    /// simulations : int, optional
    ///     Runs of the exact simulation by which the numbers are checked; 0 for none.
    /// seed : int, optional
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
        let (design, question) = (&self.content.design, request_with(py, settings, "kt", kt)?);
        let found = job::answer(py, progress, |told| yields(design, &question, told))?;
        shown::report(py, &report::yields::document(design, &question, &found))
    }

    /// Many tiles on one table: what calling `table` does.
    #[pyo3(signature = (time, *, start = None, progress = None, **settings))]
    fn _on_table<'py>(
        &self,
        py: Python<'py>,
        time: f64,
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
            let (about, crowd) = About::of_designs(designs)?;
            let text = text.as_deref().map(|text| ("start", text));
            let start = asked.start((&about, &crowd), text)?;
            asked.check()?;
            let found = put((&about, crowd), &asked, &start, told);
            let found = found.map_err(|error| error.to_string())?;
            let beside = compared(designs, &asked, &found, told);
            Ok::<_, String>((about, found, beside))
        })?;
        let (about, found, beside) = found;
        let document = report::table::document(&about, &found, &asked, beside.as_ref());
        shown::report(py, &document)
    }

    /// Files to make both tiles by: outlines with pockets, to scale, and a sheet for the magnets.
    ///
    /// Parameters
    /// ----------
    /// kerf : float, optional
    ///     Width of the cut (m); lines run half of it outside the parts.
    /// clearance : float, optional
    ///     By how much pockets are larger than their magnets on every side (m).
    ///
    /// Returns
    /// -------
    /// dict of str to bytes
    ///     By their names: DXF and SVG in mm, a sheet in Markdown.
    #[pyo3(signature = (**settings))]
    fn make<'py>(
        &self,
        py: Python<'py>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (design, making) = (&self.content.design, request::<Making>(settings)?);
        let made = job::answer(py, Some(false), |_| Made::new(design, &making))?;
        convert::files(py, report::workshop::document(design, &made).beside)
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
    ///     Of so many rows one is held out of the fit.
    ///
    /// Returns
    /// -------
    /// dict
    ///     The constants with their errors, and how well they tell what was held out.
    #[pyo3(signature = (table, *, hold_out = None))]
    fn calibrate<'py>(
        &self,
        py: Python<'py>,
        table: &Bound<'py, PyAny>,
        hold_out: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked: calibration::Request = request_with(py, None, "hold_out", hold_out)?;
        let (design, text) = (&self.content.design, text(table)?);
        let found = job::answer(py, Some(false), |_| asked.of_forces(design, &text))?;
        shown::report(py, &report::calibration::document(design, &found))
    }

    /// Fit the effective energy kT of a shaking to pairs that bind and part.
    ///
    /// Parameters
    /// ----------
    /// table : pandas.DataFrame, str or os.PathLike
    ///     The measurements or a CSV file of them: `bound_s` and `apart_s`, intervals for which
    ///     a pair was bound, and for which it was apart (s), with a `>` before those that still
    ///     lasted when watching ended; or `distance_m`, how far apart
    ///     the reference points of a pair were, each time long after the last (m).
    /// area : float, optional
    ///     Area that a pair had for itself (m^2); the design's table by default. Of intervals only.
    /// within : float, optional
    ///     Distances up to which they count (m); where tiles are free by default.
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
        let asked: calibration::Request = request(settings)?;
        let (design, text) = (&self.content.design, text(table)?);
        let found = job::answer(py, Some(false), |told| asked.of_pairs(design, &text, told))?;
        shown::report(py, &report::calibration::document(design, &found))
    }

    /// Start bound, with a thermal velocity, many times: the rate of detachment under shaking.
    ///
    /// Parameters
    /// ----------
    /// shaking : float
    ///     Effective energy kT (J) of a random force.
    /// overdamped : bool, optional
    ///     Tell the rate of overdamped motion at the same kT and drag beside it.
    /// progress : bool, optional
    /// **settings
    ///     As of :func:`tilebind.dock`; those of starts do not matter.
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
        let (design, problem) = (&self.content.design, &**self.content.problem(None));
        let settings = asked.settings(&design.pair);
        let beside = overdamped.then(|| {
            let posed = (design, problem);
            job::answer(py, progress, |told| loosening(posed, &settings, told))
        });
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

/// A table's file, whatever program saved it.
fn text_of(path: &std::path::Path) -> PyResult<String> {
    let text = tilebind::text::read(path)?;
    Ok(tilebind::text::with_commas(&text).into_owned())
}
