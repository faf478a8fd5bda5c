//! A pair of tiles.

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use numpy::PyArray1;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyMapping, PyTuple};
use tilebind::design::{Design as Whole, MagnetModel};
use tilebind::inspection::Inspection;
use tilebind::problem::Problem;
use tilebind::report::plots::{Sheet, glance};
use tilebind::report::{inspection, json};
use tilebind::sweep::Source;
use tilebind::tile::Tile;
use tilebind::words::matching::matches;
use tilebind::workshop::Making;

use crate::analysis::{self, Analysis};
use crate::barrier;
use crate::poses::{self, Poses};
use crate::table::{self, Named, Values};
use crate::{convert, dock, fault, kinetics, pickle, workshop};

/// What a design was read from, what it is, and the problems that it poses.
pub struct Content {
    /// Its text, with the drawings that it names.
    pub source: Source,
    /// The tiles.
    pub design: Whole,
    /// With its magnets as dipoles and as blocks, made when they are first asked for.
    problems: [OnceLock<Arc<Problem>>; 2],
}

impl Content {
    fn new((source, design): (Source, Whole)) -> Arc<Self> {
        Arc::new(Self {
            source,
            design,
            problems: Default::default(),
        })
    }

    /// The problem with magnets modelled as asked for, or else as the design says.
    pub fn problem(&self, model: Option<MagnetModel>) -> &Arc<Problem> {
        let model = model.unwrap_or(self.design.interaction.model);
        self.problems[model as usize].get_or_init(|| Arc::new(self.modelled(model).problem()))
    }

    /// The design with its magnets modelled otherwise.
    fn modelled(&self, model: MagnetModel) -> Whole {
        let mut design = self.design.clone();
        design.interaction.model = model;
        design
    }
}

/// A magnet model by its name.
pub fn model(name: Option<&str>) -> PyResult<Option<MagnetModel>> {
    let Some(name) = name else { return Ok(None) };
    let mut known = MagnetModel::NAMES.iter();
    match known.find(|(word, _)| *word == name) {
        Some((_, model)) => Ok(Some(*model)),
        None => Err(fault::value(format!(
            "model = {name:?}: a model is \"dipole\" or \"cuboid\""
        ))),
    }
}

/// A pair of tiles and how they are meant to bind. It never changes: :meth:`replace` gives another.
///
/// Read one with :meth:`load`, :meth:`loads` or :meth:`from_dict`. Lengths are in m, angles in rad,
/// energies in J. A pose is (x, y, theta): the moving tile's reference point in the fixed tile's
/// frame and its orientation, counter-clockwise.
///
/// Examples
/// --------
/// >>> design = tilebind.Design.load("shapes/paper-tile.toml")
/// >>> design.bound
/// array([0.43, 0.  , 0.  ])
#[pyclass(frozen, module = "tilebind")]
pub struct Design {
    /// What it is.
    pub content: Arc<Content>,
}

impl Design {
    fn read(
        py: Python<'_>,
        read: Result<(Source, Whole), tilebind::design::DesignError>,
    ) -> PyResult<Self> {
        read.map(|read| Self {
            content: Content::new(read),
        })
        .map_err(|error| fault::design(py, &error))
    }

    /// The design that was read from a source.
    pub fn of_source(py: Python<'_>, source: Source) -> PyResult<Self> {
        let design = source.design();
        Self::read(py, design.map(|design| (source, design)))
    }

    fn tile(&self, which: &str) -> PyResult<&Tile> {
        let pair = &self.content.design.pair;
        match which {
            "fixed" => Ok(&pair.fixed),
            "moving" => Ok(&pair.moving),
            _ => Err(fault::value(format!(
                "{which:?}: the tiles are \"fixed\" and \"moving\""
            ))),
        }
    }
}

#[pymethods]
impl Design {
    /// Read a design file.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     The TOML file. Drawings that it names lie beside it.
    ///
    /// Returns
    /// -------
    /// Design
    ///
    /// Raises
    /// ------
    /// DesignError
    ///     With line, column and mend of everything that is wrong with the file.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let read = py.detach(|| Source::read(&path));
        Self::read(py, read)
    }

    /// Read a design from its text.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     TOML, as in a design file.
    /// file : str, optional
    ///     What errors call it; it lies where the drawings lie, and the design is named after it
    ///     where it gives no name.
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
        let read = py.detach(|| Source::of_text(text, file));
        Self::read(py, read)
    }

    /// Make a design of nested dictionaries with the keys of a design file.
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
    ///     Its lines are those of :attr:`text`, which is made of the dictionaries.
    #[staticmethod]
    fn from_dict(py: Python<'_>, tables: &Bound<'_, PyMapping>) -> PyResult<Self> {
        let text = convert::table(tables)?.to_string();
        Self::loads(py, &text, "design.toml")
    }

    /// The same design with a key set to another value.
    ///
    /// Parameters
    /// ----------
    /// key : str
    ///     Dotted path, such as ``"fixed.faces.east.profile.depth"``; a number counts the items of
    ///     a list from 0. Tables on the way that are missing are made.
    /// value : float, int, bool, str, list or Mapping
    ///     In SI units, or as a text with a unit, ``"20 mm"``.
    ///
    /// Returns
    /// -------
    /// Design
    ///     This one stays as it is.
    ///
    /// Raises
    /// ------
    /// DesignError
    ///     Where the key leads nowhere or there is no such design.
    fn replace(&self, py: Python<'_>, key: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let source = &self.content.source;
        let value = convert::toml(value)?;
        let with = source.with(key, value).map_err(|reason| {
            let help = "name a key by its dotted path, such as fixed.faces.east.profile.depth";
            fault::of_design(py, &source.file, reason, help)
        })?;
        Self::of_source(py, with)
    }

    /// The design as nested dictionaries.
    ///
    /// Returns
    /// -------
    /// dict
    ///     What :meth:`from_dict` takes.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let text = &self.content.source.text;
        py.import("tomllib")?.call_method1("loads", (text,))
    }

    /// str : The design as TOML.
    #[getter]
    fn text(&self) -> &str {
        &self.content.source.text
    }

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

    /// The magnetic interaction energy.
    ///
    /// Parameters
    /// ----------
    /// poses : array_like
    ///     (..., 3): x (m), y (m), theta (rad) of the moving tile.
    /// model : {"dipole", "cuboid"}, optional
    ///     Point dipoles or uniformly magnetised blocks; the design's own by default.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     (...), in J; 0 at infinity. Given where tiles overlap, too; NaN where a pose is not
    ///     finite.
    ///
    /// Notes
    /// -----
    /// Many poses are worked on by all cores, with the interpreter's lock released.
    #[pyo3(signature = (poses, *, model = None))]
    fn energy<'py>(
        &self,
        py: Python<'py>,
        poses: Poses<'py>,
        model: Option<Cow<'_, str>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let problem = self.content.problem(self::model(model.as_deref())?);
        let potential = problem.potential();
        poses::numbers(py, &poses, |qs, out: &mut [[f64; 1]]| {
            potential.energies(qs, out.as_flattened_mut());
            for [energy] in out {
                *energy = json::positive_zero(*energy);
            }
        })
    }

    /// Force and torque on the moving tile.
    ///
    /// Parameters
    /// ----------
    /// poses : array_like
    ///     (..., 3): x (m), y (m), theta (rad).
    /// model : {"dipole", "cuboid"}, optional
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     (..., 3): Fx (N), Fy (N) and the torque about the tile's reference point (N m).
    #[pyo3(signature = (poses, *, model = None))]
    fn wrench<'py>(
        &self,
        py: Python<'py>,
        poses: Poses<'py>,
        model: Option<Cow<'_, str>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let problem = self.content.problem(self::model(model.as_deref())?);
        let potential = problem.potential();
        poses::numbers(py, &poses, |qs, out: &mut [[f64; 3]]| {
            let mut found = vec![Default::default(); qs.len()];
            potential.energies_and_gradients(qs, &mut found);
            for ((_, gradient), out) in found.iter().zip(out) {
                *out = [-gradient.x, -gradient.y, -gradient.z].map(json::positive_zero);
            }
        })
    }

    /// Distance between the two outlines.
    ///
    /// Parameters
    /// ----------
    /// poses : array_like
    ///     (..., 3): x (m), y (m), theta (rad).
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     (...), in m; 0 where they touch, negative where they overlap.
    fn clearance<'py>(&self, py: Python<'py>, poses: Poses<'py>) -> PyResult<Bound<'py, PyAny>> {
        let problem = self.content.problem(None);
        poses::numbers(py, &poses, |qs, out: &mut [[f64; 1]]| {
            for (q, [out]) in qs.iter().zip(out) {
                let clearance = problem.clearance(q);
                // Tiles that touch may overlap by a rounding error.
                let clearance = match problem.is_clear(q) {
                    true => clearance.max(0.0),
                    false => clearance,
                };
                *out = json::positive_zero(clearance);
            }
        })
    }

    /// Whether the tiles do not overlap; touching is allowed.
    ///
    /// Parameters
    /// ----------
    /// poses : array_like
    ///     (..., 3): x (m), y (m), theta (rad).
    ///
    /// Returns
    /// -------
    /// bool or numpy.ndarray
    ///     (...), false where a pose is not finite.
    fn is_free<'py>(&self, py: Python<'py>, poses: Poses<'py>) -> PyResult<Bound<'py, PyAny>> {
        let problem = self.content.problem(None);
        poses::truths(py, &poses, |q| problem.is_clear(q))
    }

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
    /// repeats : int, optional
    ///     Runs, each with the next seed, whose spread is reported.
    /// tolerance : float, optional
    ///     Width (J) to which certified bounds are narrowed.
    /// certify_seconds, complete_seconds : float, optional
    ///     Time (s) after which the bounds of barriers, and the proof that no state is missing, are
    ///     left as they are; 0 for none.
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
    /// The defaults are those of ``tilebind analyse``, and so are the results, byte by byte.
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
    /// certify_seconds : float, optional
    ///     Time (s) after which they are left as they are; 0 for no bounds.
    /// milestones, seed : int, optional
    /// progress : bool, optional
    ///
    /// Returns
    /// -------
    /// Barrier
    ///     A named tuple: `lower`, `upper` (J, bounds of the saddle's energy), `path` (structured
    ///     array), `saddle_energy` (J), `saddle_pose`, `forward`, `reverse` (J), `caged`,
    ///     `uncertified`.
    #[pyo3(signature = (start, end = None, *, tolerance = None, certify_seconds = None,
                        milestones = None, seed = None, progress = None))]
    #[allow(clippy::too_many_arguments)]
    fn barrier<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: Option<&Bound<'py, PyAny>>,
        tolerance: Option<f64>,
        certify_seconds: Option<f64>,
        milestones: Option<usize>,
        seed: Option<u64>,
        progress: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let query = barrier::query(
            [Some(start), end],
            tolerance,
            certify_seconds,
            milestones,
            seed,
        )?;
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

    /// How the two outlines, magnets aside, fit together.
    ///
    /// Parameters
    /// ----------
    /// most : int, optional
    ///     Most fits listed.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Structured, longest contact first: `x_m`, `y_m`, `theta_rad`, `contact_m`, `gap_m2`.
    #[pyo3(signature = (most = 100))]
    fn matches<'py>(&self, py: Python<'py>, most: usize) -> PyResult<Bound<'py, PyAny>> {
        let problem = self.content.problem(None).clone();
        let found = crate::job::quietly(py, move || {
            problem
                .contact
                .as_ref()
                .map(|contact| matches(contact, most))
        })?;
        let found = found.unwrap_or_default();
        let real = |name: &str, of: fn(&tilebind::words::matching::Match) -> f64| -> Named {
            (
                name.to_owned(),
                Values::Real(found.iter().map(of).collect()),
            )
        };
        let columns = vec![
            real("x_m", |one| one.pose.x),
            real("y_m", |one| one.pose.y),
            real("theta_rad", |one| one.pose.theta),
            real("contact_m", |one| one.contact),
            real("gap_m2", |one| one.gap),
        ];
        table::structured(py, columns)
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
    ///
    /// Returns
    /// -------
    /// dict
    ///     `mean_exit_s`, `exits` (shares that are first bound and free), `diffusion_m2_s`, `mesh`
    ///     (how far the two finest meshes differ).
    #[pyo3(signature = (start, *, kt, drag = 50.0, basin_energy = None, free_at = None))]
    fn exits<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        kt: f64,
        drag: f64,
        basin_energy: Option<f64>,
        free_at: Option<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked = kinetics::Asked {
            kt,
            drag,
            basin_energy,
            free_at,
        };
        let posed = (&self.content.design, &**self.content.problem(None));
        kinetics::exits(py, posed, start, &asked)
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

    /// The time (s) that the energies of poses take on all cores by themselves, for the bench.
    fn _kernel_seconds(
        &self,
        py: Python<'_>,
        poses: Poses<'_>,
        model: Option<Cow<'_, str>>,
    ) -> PyResult<f64> {
        let problem = self.content.problem(self::model(model.as_deref())?);
        poses::kernel_seconds(py, &poses, problem.potential())
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

    fn __eq__<'py>(&self, py: Python<'py>, other: &Bound<'py, PyAny>) -> PyResult<Py<PyAny>> {
        match other.cast::<Self>() {
            Ok(other) => (self.content.source == other.get().content.source).into_py_any(py),
            Err(_) => Ok(py.NotImplemented()),
        }
    }

    fn __hash__(&self) -> u64 {
        // The checksum is as good as random.
        u64::from_str_radix(&self.content.design.sha256[..16], 16).unwrap_or(0)
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let py = slf.py();
        let restore = slf.get_type().getattr("_restore")?;
        Ok((restore, (pickle::dump(py, &slf.get().content.source)?,)))
    }

    #[staticmethod]
    fn _restore(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        Self::of_source(py, pickle::load(bytes)?)
    }
}
