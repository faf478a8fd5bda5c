//! The main job and what it finds.

use std::sync::Arc;
use std::time::Instant;

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyString};
use serde::{Deserialize, Serialize};
use tilebind::dynamics::check::BarrierCheck;
use tilebind::kinetics::bond::Shaking;
use tilebind::landscape::map::{EnergyMap, Window};
use tilebind::landscape::{Barrier, Completeness, Inventory, Place, Uncaptured, Uncertified};
use tilebind::landscape::{CompletenessSettings, pathway};
use tilebind::pipeline::{self, Counts, Stage};
use tilebind::report::columns::{self, Output, StateRow};
use tilebind::report::json::Report;
use tilebind::report::page::Page;
use tilebind::report::plots::{self, Scene, Sheet};
use tilebind::report::writer::{self, Contents, Extent};
use tilebind::report::{summary, writer::FOLDERS};
use tilebind::roadmap::RoadmapSettings;
use tilebind::sweep::Source;
use tilebind::{Analysis as Found, Configuration, Settings};

use crate::design::{Content, Design};
use crate::keywords::Keywords;
use crate::table::{self, FREE};
use crate::{convert, fault, job, kinetics, pickle};

/// The library's settings.
fn settings(given: Option<&Bound<'_, PyDict>>) -> PyResult<Settings> {
    let given = Keywords::new(given);
    let default = Settings::default();
    let complete = default.completeness;
    let settings = Settings {
        seed: given.or("seed", default.seed)?,
        milestones: given.or("milestones", default.milestones)?,
        neighbours: given.get("neighbours")?,
        boltzmann: given.get("boltzmann")?,
        thermal_energy: given.get("thermal_energy")?,
        settled: given.or("settled", default.settled)?,
        far_starts: given.or("far_starts", default.far_starts)?,
        repeats: given.or("repeats", default.repeats)?,
        tolerance: given.get("tolerance")?,
        certify_seconds: given.or("certify_seconds", default.certify_seconds)?,
        certify_cells: given.or("certify_cells", default.certify_cells)?,
        completeness: CompletenessSettings {
            seconds: given.or("complete_seconds", complete.seconds)?,
            cells: given.or("complete_cells", complete.cells)?,
            below: given.or("complete_below", complete.below)?,
            escape: given.or("complete_escape", complete.escape)?,
        },
        dynamics_runs: given.or("dynamics_runs", default.dynamics_runs)?,
        ..default
    };
    given.finish()?;
    fault::count("milestones", settings.milestones)?;
    fault::count("neighbours", settings.neighbours.unwrap_or(1))?;
    fault::count("repeats", settings.repeats)?;
    fault::positive("boltzmann", settings.boltzmann)?;
    fault::positive("thermal_energy", settings.thermal_energy)?;
    fault::positive("tolerance", settings.tolerance)?;
    fault::fraction("settled", settings.settled)?;
    fault::fraction("complete_below", settings.completeness.below)?;
    fault::fraction("complete_escape", settings.completeness.escape)?;
    fault::not_negative("certify_seconds", settings.certify_seconds)?;
    fault::not_negative("complete_seconds", settings.completeness.seconds)?;
    job::check_memory(settings.milestones, settings.neighbours)?;
    Ok(settings)
}

/// The main job.
pub fn analyse(
    py: Python<'_>,
    design: Py<Design>,
    given: Option<&Bound<'_, PyDict>>,
    progress: Option<bool>,
) -> PyResult<Analysis> {
    let settings = settings(given)?;
    let content = design.get().content.clone();
    let start = Instant::now();
    let found = job::run(py, progress, |told| {
        pipeline::analyse(&content.design, &settings, told)
    })?;
    Ok(Analysis {
        design,
        content,
        found,
        wall_s: start.elapsed().as_secs_f64(),
    })
}

/// What the main job found: states, traps, barriers with their proofs, pathways. It never changes.
#[pyclass(frozen, module = "tilebind")]
pub struct Analysis {
    design: Py<Design>,
    content: Arc<Content>,
    found: Found,
    wall_s: f64,
}

/// All of an analysis that is not the design.
#[derive(Serialize, Deserialize)]
struct Kept {
    source: Source,
    settings: Settings,
    roadmap: RoadmapSettings,
    bound: (Configuration, f64),
    inventory: Inventory,
    completeness: Result<Completeness, Uncertified>,
    uncaptured: Uncaptured,
    ring: [f64; 2],
    uncertified: Option<Uncertified>,
    dynamics: Option<Vec<BarrierCheck>>,
    counts: Counts,
    stages: Vec<Stage>,
    wall_s: f64,
}

impl Analysis {
    fn scene(&self) -> Scene<'_> {
        let design = &self.content.design;
        Scene::new(design, &self.found.problem, &self.found.inventory)
    }

    /// The id of a state, or `free`.
    fn place(&self, place: &Bound<'_, PyAny>) -> PyResult<Place> {
        if place.is_instance_of::<PyString>() {
            let word: String = place.extract()?;
            if word == "free" {
                return Ok(Place::Free);
            }
            // What people call a state, A or B'.
            let names = self.found.inventory.names();
            if let Some(id) = names.iter().position(|name| *name == word) {
                return Ok(Place::State(id));
            }
            return Err(fault::value(format!(
                "{word:?}: a state is called by its id or its name ({}), or \"free\"",
                names.first().map_or("there are none", String::as_str)
            )));
        }
        let id: i64 = place.extract()?;
        match usize::try_from(id) {
            Ok(id) if id < self.found.inventory.states.len() => Ok(Place::State(id)),
            Err(_) if id == FREE => Ok(Place::Free),
            _ => Err(fault::value(format!(
                "there is no state {id}: there are {}, from 0",
                self.found.inventory.states.len()
            ))),
        }
    }

    /// The way between two places, if one is known.
    fn way(&self, from: Place, to: Place) -> Option<tilebind::landscape::Pathway> {
        let inventory = &self.found.inventory;
        let known = |from: Place, to: Place| -> Option<Barrier> {
            let is_it = |barrier: &&Barrier| (barrier.from, barrier.to) == (from, to);
            let listed = inventory.barriers.iter().find(is_it).cloned();
            let escape = || match from {
                Place::State(id) => self.found.escape(id).filter(|escape| escape.to == to),
                Place::Free => None,
            };
            listed.or_else(escape).filter(Barrier::has_way)
        };
        known(from, to)
            .map(|barrier| barrier.pathway)
            .or_else(|| Some(pathway::reversed(&known(to, from)?.pathway)))
    }

    /// The line that tells how the same page is made.
    fn command(&self) -> String {
        let name = std::path::Path::new(&self.content.source.file);
        let name = name.file_name().unwrap_or_default().to_string_lossy();
        format!("tilebind analyse {name}")
    }

    /// SVG documents of the pictures that are wanted.
    fn pictures(&self, py: Python<'_>, wanted: &[&str]) -> PyResult<Vec<String>> {
        let drawn = job::quietly(py, || {
            plots::draw(&self.scene(), &Sheet::SCREEN, |name| wanted.contains(&name))
        })?;
        let drawn = drawn.map_err(fault::run)?;
        Ok(drawn.iter().map(|figure| figure.svg().to_owned()).collect())
    }
}

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
    /// Design : What was analysed.
    #[getter]
    fn design(&self, py: Python<'_>) -> Py<Design> {
        self.design.clone_ref(py)
    }

    /// numpy.ndarray : The states, structured, for ``pandas.DataFrame``: `id`, `name`, `kind`
    /// ("bound" or "misbound"), `class`, `copies`, pose (`x_m`, `y_m`, `theta_rad`), `energy_J`,
    /// `escape_J` (to the nearest lower state or to free), `escape_to` (an id, -1 for free, -2 where
    /// no way is known), `caged`, shares of the far starts captured with their 95 % interval, faces
    /// in contact, energy as blocks.
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let names = self.found.inventory.names();
        let rows = StateRow::all(&self.content.design, &self.found, &names);
        let columns = columns::states(Output::Csv);
        table::structured(py, table::of_columns(&columns, &rows))
    }

    /// numpy.ndarray : The barriers, structured: `from`, `to` (ids of states, -1 for free),
    /// `saddle_energy_J` with its certified bounds `lower_J` and `upper_J` (NaN where nothing is
    /// proved), `forward_J`, `reverse_J`, the saddle's pose, `caged`, work along the pathway and its
    /// length.
    #[getter]
    fn barriers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let columns = columns::barriers(Output::Csv);
        let mut columns = table::of_columns(&columns, &self.found.inventory.barriers);
        // The files of the pathways.
        columns.retain(|(name, _)| name != "pathway");
        table::structured(py, columns)
    }

    /// numpy.ndarray : The pose (3,) in which the target faces coincide (m, m, rad).
    #[getter]
    fn bound<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table::grid(py, self.found.bound.0.to_array().to_vec(), vec![3])
    }

    /// float : The energy there (J).
    #[getter]
    fn bound_energy(&self) -> f64 {
        self.found.bound.1
    }

    /// dict : Everything that is known, as ``report.json`` has it.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        convert::json(py, &self.report_json())
    }

    /// dict : What is proved of the states that the list may lack: besides the listed ones nothing
    /// lies below `below_J` from which every way out rises by more than `escape_J`, except in the
    /// `open` regions.
    #[getter]
    fn inventory<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.report(py)?.get_item("inventory")
    }

    /// The best known way between two places.
    ///
    /// Parameters
    /// ----------
    /// start, end : int or str
    ///     The id of a state, its name ("A", "B'"), or "free" (-1 too). The end is free by default.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Structured: `s_m`, `x_m`, `y_m`, `theta_rad`, `energy_J`, `clearance_m`. From point to
    ///     point the motion is straight in x, y and theta, the shorter way round.
    ///
    /// Raises
    /// ------
    /// LookupError
    ///     Where no way was sought between the two, or none found.
    #[pyo3(signature = (start, end = None))]
    fn pathway<'py>(
        &self,
        py: Python<'py>,
        start: &Bound<'py, PyAny>,
        end: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let from = self.place(start)?;
        let to = end.map_or(Ok(Place::Free), |end| self.place(end))?;
        match self.way(from, to) {
            Some(pathway) => table::pathway(py, &pathway),
            None => Err(pyo3::exceptions::PyLookupError::new_err(
                "no way is known between the two: design.barrier(start, end) looks for one",
            )),
        }
    }

    /// The lowest energy over the orientation at each place about the fixed tile.
    ///
    /// Parameters
    /// ----------
    /// samples : int, optional
    ///     Grid points along the longer side.
    /// orientations : int, optional
    ///     Orientations tried at each of them, besides those that lay faces flush.
    ///
    /// Returns
    /// -------
    /// LandscapeMap
    ///     A named tuple: `x` (columns,), `y` (rows,) in m, `energy` (rows, columns) in J and
    ///     `theta` (rows, columns) in rad; NaN where no orientation is free.
    #[pyo3(signature = (samples = 160, orientations = 48))]
    fn landscape_map<'py>(
        &self,
        py: Python<'py>,
        samples: usize,
        orientations: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        const MOST: usize = 4096;
        if !(2..=MOST).contains(&samples) || !(1..=MOST).contains(&orientations) {
            return Err(fault::value(format!(
                "samples must be from 2 to {MOST}, orientations from 1 to {MOST}"
            )));
        }
        let half = self.scene().reach();
        let longer = half[0].max(half[1]);
        let window = Window {
            origin: Default::default(),
            angle: 0.0,
            low: half.map(|half| -half),
            high: half,
            samples: half.map(|half| ((samples as f64 * half / longer).round() as usize).max(2)),
        };
        let map = job::quietly(py, || {
            EnergyMap::new(&self.found.problem, &window, orientations)
        })?;
        let grid = map.lowest;
        let shape = vec![grid.y.len(), grid.x.len()];
        let of = |of: fn(&tilebind::landscape::map::Sample) -> f64| {
            let values = grid
                .values
                .iter()
                .map(|one| one.as_ref().map_or(f64::NAN, of));
            table::grid(py, values.collect(), shape.clone())
        };
        let fields = PyDict::new(py);
        fields.set_item("energy", of(|sample| sample.energy)?)?;
        fields.set_item("theta", of(|sample| sample.configuration.theta)?)?;
        fields.set_item("x", table::grid(py, grid.x.clone(), vec![grid.x.len()])?)?;
        fields.set_item("y", table::grid(py, grid.y.clone(), vec![grid.y.len()])?)?;
        convert::named(py, "LandscapeMap", &fields)
    }

    /// How strongly the bond and the traps hold shaken tiles.
    ///
    /// Parameters
    /// ----------
    /// kt : float
    ///     Effective energy of the shaking (J).
    /// coverage : float
    ///     Share of the table that tiles cover.
    ///
    /// Returns
    /// -------
    /// dict
    ///     `bond_kT`, `docking_cost_kT`, `ln_K`, `two_hold_one_does_not_J` and more.
    fn bond<'py>(&self, py: Python<'py>, kt: f64, coverage: f64) -> PyResult<Bound<'py, PyAny>> {
        let found = (&*self.found.problem, &self.found.inventory);
        let shaking = Shaking { kt, coverage };
        kinetics::bond(py, &self.content.design, found, shaking)
    }

    /// Which kinds of states merge at which energy.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Structured, a row for each line of the graph: `states` (the names of those that hang on
    ///     it), `energy_J` (of its foot), `copies`, `joins_at_J` (NaN for a line that joins none)
    ///     with certified bounds `lower_J` and `upper_J`.
    fn disconnectivity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let lines = plots::merge_lines(&self.scene());
        table::structured(py, table::of_csv(&lines))
    }

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
    ///     Empty where there is nothing to draw.
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

    /// What was found, in a few lines.
    ///
    /// Returns
    /// -------
    /// str
    fn summary(&self) -> String {
        const COLUMNS: usize = 100;
        let (design, found) = (&self.content.design, &self.found);
        let text = summary::summary(design, found, "", Some(COLUMNS));
        let told = |line: &&str| !line.starts_with("results in ");
        text.lines()
            .filter(told)
            .map(|line| format!("{line}\n"))
            .collect()
    }

    /// The page with the landscape to move about in, pathways that play and tables that sort.
    ///
    /// Returns
    /// -------
    /// str
    ///     HTML that needs nothing but a browser.
    fn report_html(&self, py: Python<'_>) -> PyResult<String> {
        job::quietly(py, || {
            let page = Page::of_analysis(&self.content.design, &self.found, &self.scene());
            page.made_by(&self.command()).to_html()
        })
    }

    /// The text of ``report.json``: every byte as ``tilebind analyse`` writes it, but for what
    /// depends on the machine (`timing`) and the checksums of the files beside it.
    ///
    /// Returns
    /// -------
    /// str
    fn report_json(&self) -> String {
        Report::new(&self.content.design, &self.found, self.wall_s).to_text()
    }

    /// Write all files of ``tilebind analyse``, whole or not at all.
    ///
    /// Parameters
    /// ----------
    /// folder : str or os.PathLike
    ///     Made if need be. Files that tilebind did not write are never overwritten.
    /// arrays : bool, optional
    ///     NPY files too.
    /// compact : bool, optional
    ///     Leave out the page, PNG pictures and pathways of copies.
    /// command : str, optional
    ///     The line on the page that tells how it was made.
    ///
    /// Returns
    /// -------
    /// tuple of str
    ///     Names under which files that were in the way are kept.
    #[pyo3(signature = (folder, *, arrays = false, compact = false, command = None))]
    fn write(
        &self,
        py: Python<'_>,
        folder: std::path::PathBuf,
        arrays: bool,
        compact: bool,
        command: Option<String>,
    ) -> PyResult<Vec<String>> {
        if writer::has_foreign_report(&folder) {
            return Err(fault::value(format!(
                "{} holds a report that is not of tilebind: name another folder",
                folder.display()
            )));
        }
        for inner in FOLDERS
            .iter()
            .map(|inner| folder.join(inner))
            .chain([folder.clone()])
        {
            if inner.exists() && !inner.is_dir() {
                return Err(fault::value(format!("{} is no folder", inner.display())));
            }
        }
        let contents = Contents {
            extent: if compact {
                Extent::Compact
            } else {
                Extent::Full
            },
            arrays,
            sheet: Sheet::SCREEN,
            command: command.unwrap_or_else(|| self.command()),
        };
        let start = Instant::now();
        let files = job::quietly(py, || {
            writer::files(&self.content.design, &self.found, &contents, start)
        })?;
        let files = files.map_err(fault::run)?;
        let kept = writer::write(&folder, &files)
            .map_err(|error| pyo3::exceptions::PyOSError::new_err(error.to_string()))?;
        Ok(kept.iter().map(|path| path.display().to_string()).collect())
    }

    /// Draw the lowest energy about the fixed tile with the states on it.
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
        let plots = slf.py().import("tilebind._plots")?;
        plots.getattr("plot_map")?.call((slf, ax), style)
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
        let plots = slf.py().import("tilebind._plots")?;
        plots
            .getattr("plot_profile")?
            .call((slf, start, end, ax), style)
    }

    /// Draw which kinds of states merge at which energy.
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
        let plots = slf.py().import("tilebind._plots")?;
        plots
            .getattr("plot_disconnectivity")?
            .call((slf, ax), style)
    }

    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let pictures = self.pictures(py, &["map", "disconnectivity"])?;
        let html = py.import("tilebind._html")?;
        html.call_method1("page", (self.summary(), pictures))
    }

    fn __repr__(&self) -> String {
        let inventory = &self.found.inventory;
        format!(
            "<tilebind.Analysis {:?}, {} states in {} kinds, {} barriers>",
            self.content.design.name,
            inventory.states.len(),
            inventory.kinds().count(),
            inventory.barriers.len()
        )
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let restore = slf.get_type().getattr("_restore")?;
        let this = slf.get();
        let found = &this.found;
        let kept = Kept {
            source: this.content.source.clone(),
            settings: found.settings.clone(),
            roadmap: found.roadmap,
            bound: found.bound,
            inventory: found.inventory.clone(),
            completeness: found.completeness.clone(),
            uncaptured: found.uncaptured,
            ring: found.ring,
            uncertified: found.uncertified,
            dynamics: found.dynamics.clone(),
            counts: found.counts,
            stages: found.stages.clone(),
            wall_s: this.wall_s,
        };
        Ok((restore, (pickle::dump(slf.py(), &kept)?,)))
    }

    #[staticmethod]
    fn _restore(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        let kept: Kept = pickle::load(bytes)?;
        let design = Design::of_source(py, kept.source)?;
        let content = design.content.clone();
        let found = Found {
            problem: content.problem(None).clone(),
            settings: kept.settings,
            roadmap: kept.roadmap,
            bound: kept.bound,
            inventory: kept.inventory,
            completeness: kept.completeness,
            uncaptured: kept.uncaptured,
            ring: kept.ring,
            uncertified: kept.uncertified,
            dynamics: kept.dynamics,
            counts: kept.counts,
            stages: kept.stages,
        };
        Ok(Self {
            design: Py::new(py, design)?,
            content,
            found,
            wall_s: kept.wall_s,
        })
    }
}
