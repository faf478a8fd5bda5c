//! The jobs that take a design.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::workshop::Making;

use super::Design;
use crate::analysis::{self, Analysis};
use crate::request::request;
use crate::{barrier, crowd, dock, kinetics, workshop};

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
        analysis::analyse(py, slf, settings, progress)
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
        let query = barrier::query(py, [Some(start), end], settings, &self.content.design)?;
        barrier::ask(py, &self.content.design, &query, progress)
    }

    /// Send the moving tile towards the fixed one many times; see :func:`tilebind.dock`.
    #[pyo3(signature = (*, progress = None, **settings))]
    fn dock(
        slf: Py<Self>,
        py: Python<'_>,
        progress: Option<bool>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<dock::Docking> {
        dock::docked(py, slf, settings, progress)
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
        let asked = request(settings)?;
        let posed = (&self.content.design, &**self.content.problem(None));
        kinetics::exits(py, posed, start, &asked)
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
        settings: Option<Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let settings = settings.unwrap_or_else(|| PyDict::new(py));
        settings.set_item("kt", kt)?;
        let question = request(Some(&settings))?;
        kinetics::yielded(py, &self.content.design, &question, progress)
    }

    /// Many tiles on one table, with contact, friction and drives, and what they hold.
    ///
    /// Parameters
    /// ----------
    /// time : float
    ///     How long each run lasts (s).
    /// count : sequence of int, optional
    ///     Tiles of the fixed tile's kind and of the moving one's, at random places.
    /// start : str or os.PathLike, optional
    ///     In place of `count`: a CSV file of the tiles at the start, with the columns `tile`, `kind`
    ///     ("fixed" or "moving"), `x`, `y`, `theta`, `vx`, `vy`, `omega` (m, rad, m/s, rad/s).
    /// runs : int, optional
    /// shaking : float, optional
    ///     Effective energy kT (J) of shaking.
    /// correlation : float, optional
    ///     Its correlation time (s): that between two random kicks.
    /// orbital : tuple of float, optional
    ///     The table goes round in a circle: radius (m) and rounds a second (Hz).
    /// fan : sequence, optional
    ///     Of (x, y, energy, width) in m, m, J and m, and perhaps the share by which it swings and how
    ///     often a second.
    /// drag, friction, restitution : float, optional
    ///     Drag rate (1/s), Coulomb's coefficient, share of the approach velocity that a knock gives
    ///     back.
    /// step : float, optional
    ///     Longest step (s).
    /// frames : float, optional
    ///     Time (s) between two moments whose places are kept.
    /// seed : int, optional
    /// progress : bool, optional
    ///
    /// Returns
    /// -------
    /// dict
    ///     As ``tilebind table --json``.
    #[pyo3(signature = (time, *, start = None, progress = None, **settings))]
    fn table<'py>(
        &self,
        py: Python<'py>,
        time: f64,
        start: Option<std::path::PathBuf>,
        progress: Option<bool>,
        settings: Option<Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let settings = settings.unwrap_or_else(|| PyDict::new(py));
        settings.set_item("time", time)?;
        let asked = request(Some(&settings))?;
        let start = start.map(std::fs::read_to_string).transpose()?;
        crowd::table_of(py, &self.content.design, &asked, start.as_deref(), progress)
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
    #[pyo3(signature = (*, kerf = 0.0, clearance = 1e-4))]
    fn make<'py>(
        &self,
        py: Python<'py>,
        kerf: f64,
        clearance: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        workshop::files(py, &self.content.design, &Making { kerf, clearance })
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
    #[pyo3(signature = (table, *, hold_out = 5))]
    fn calibrate<'py>(
        &self,
        py: Python<'py>,
        table: &Bound<'py, PyAny>,
        hold_out: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        workshop::calibrated(py, &self.content.design, table, hold_out)
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
    #[pyo3(signature = (table, *, area = None, within = None))]
    fn calibrate_bonds<'py>(
        &self,
        py: Python<'py>,
        table: &Bound<'py, PyAny>,
        area: Option<f64>,
        within: Option<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        workshop::kt_of_bonds(py, &self.content.design, table, area, within)
    }

    /// Start bound, with a thermal velocity, many times: the rate of detachment under shaking.
    ///
    /// Parameters
    /// ----------
    /// shaking : float
    ///     Effective energy kT (J) of a random force.
    /// progress : bool, optional
    /// **settings
    ///     As of :func:`tilebind.dock`; those of starts do not matter.
    ///
    /// Returns
    /// -------
    /// dict
    ///     As ``tilebind dock --from-bond --json``.
    #[pyo3(signature = (*, shaking, progress = None, **settings))]
    fn releases<'py>(
        &self,
        py: Python<'py>,
        shaking: f64,
        progress: Option<bool>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        dock::released(py, &self.content, shaking, settings, progress)
    }
}
