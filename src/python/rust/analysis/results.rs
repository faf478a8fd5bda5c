//! States, barriers, pathways and maps as arrays.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use tilebind::bond;
use tilebind::landscape::Place;
use tilebind::landscape::map::{EnergyMap, Window};
use tilebind::rates;
use tilebind::report;
use tilebind::report::plots;
use tilebind::report::states::{barriers, states};

use super::Analysis;
use crate::design::Design;
use crate::request::request_with;
use crate::{convert, fault, job, shown, table};

#[pymethods]
impl Analysis {
    /// Design : The analysed design.
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
        table::array(py, &states(&self.content.design, &self.found, true))
    }

    /// numpy.ndarray : The barriers, structured: `from`, `to` (ids of states, -1 for free),
    /// `saddle_energy_J` with its proved bounds `lower_J` and `upper_J` (NaN where nothing is
    /// proved), `forward_J`, `reverse_J`, the saddle's pose, `caged`, work along the pathway and its
    /// length.
    #[getter]
    fn barriers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mut barriers = barriers(&self.found.catalogue.barriers);
        // The files of the pathways.
        let files = barriers
            .heads
            .iter_mut()
            .filter(|head| head.key == "pathway");
        files.for_each(|head| head.is_csv = false);
        table::array(py, &barriers)
    }

    /// numpy.ndarray : The pose (3,) in which the target faces coincide (m, m, rad).
    #[getter]
    fn bound<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table::grid(py, self.found.bound.0.to_array().to_vec(), vec![3])
    }

    /// float : The energy at `bound` (J).
    #[getter]
    fn bound_energy(&self) -> f64 {
        self.found.bound.1
    }

    /// dict : All results, as in ``report.json``.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        convert::json(py, &self.report_json())
    }

    /// dict : What is proved about missing states: apart from the listed states, there is
    /// none below `below_J` from which every way out rises by more than `escape_J`, except
    /// in the `open` regions.
    #[getter]
    fn inventory<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.report(py)?.get_item("inventory")
    }

    /// The best known path between two states.
    ///
    /// Parameters
    /// ----------
    /// start, end : int or str
    ///     The id of a state, its name ("A", "B'"), or "free" (-1 too). The end is free by default.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Structured: `s_m`, `x_m`, `y_m`, `theta_rad`, `energy_J`, `clearance_m`. Between
    ///     points the motion is linear in x, y and theta; theta takes the shorter way round.
    ///     Tiles that turn in contact overlap there by up to a millionth of their size.
    ///
    /// Raises
    /// ------
    /// LookupError
    ///     If no path between the two was searched for, or none was found.
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
                "no path is known between the two: design.barrier(start, end) searches for one",
            )),
        }
    }

    /// The lowest energy over all orientations at each position around the fixed tile.
    ///
    /// Parameters
    /// ----------
    /// samples : int, optional
    ///     Grid points along the longer side.
    /// orientations : int, optional
    ///     Orientations tried at each point, in addition to those with flush faces.
    ///
    /// Returns
    /// -------
    /// LandscapeMap
    ///     A named tuple: `x` (columns,), `y` (rows,) in m, `energy` (rows, columns) in J and
    ///     `theta` (rows, columns) in rad; NaN where the tiles overlap in every orientation.
    #[pyo3(signature = (samples = 160, orientations = 48))]
    fn landscape_map<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = convert::whole)] samples: usize,
        #[pyo3(from_py_with = convert::whole)] orientations: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        const MOST: usize = 4096;
        if !(2..=MOST).contains(&samples) || !(1..=MOST).contains(&orientations) {
            return Err(fault::value(format!(
                "samples must be from 2 to {MOST}, orientations from 1 to {MOST}"
            )));
        }
        let half = self.found.problem.space.map_half_size();
        let ends = [half.map(|half| -half), half];
        let window = Window::new(Default::default(), 0.0, ends, samples as f64);
        let map = job::quietly(py, || {
            EnergyMap::new(&self.found.problem, &window, orientations)
        })?;
        let grid = map.lowest;
        let shape = vec![grid.y.len(), grid.x.len()];
        let of = |of: fn(&tilebind::landscape::grid::Sample) -> f64| {
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

    /// Compute how strongly the bond and the traps hold shaken tiles, with the states that
    /// ``tilebind bond`` finds with this analysis's seed, whatever its other settings.
    ///
    /// Parameters
    /// ----------
    #[doc = include_str!("../keywords/bond.txt")]
    ///
    /// Returns
    /// -------
    /// dict
    ///     `bond_kT`, `docking_cost_kT`, `ln_K`, `two_hold_one_does_not_J` and more.
    #[pyo3(signature = (kt, coverage))]
    fn bond<'py>(
        &self,
        py: Python<'py>,
        kt: Bound<'py, PyAny>,
        coverage: Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked = PyDict::new(py);
        asked.set_item("coverage", coverage)?;
        asked.set_item("seed", self.found.request.seed)?;
        let asked: bond::Request = request_with(py, Some(&asked), "kt", kt)?;
        let design = &self.content.design;
        let held = job::answer(py, Some(false), |told| asked.run(design, false, told))?;
        shown::report(py, &report::bond::document(design, &held))
    }

    /// Compute how fast shaken tiles bind, unbind and change between bond and traps:
    /// overdamped motion at kT between stated basins, those that ``tilebind rates`` finds with
    /// this analysis's seed, whatever its other settings.
    ///
    /// Parameters
    /// ----------
    #[doc = include_str!("../keywords/rates.txt")]
    ///
    /// Returns
    /// -------
    /// dict
    ///     As ``tilebind rates --json``: basins, rates with their estimated errors, occupation,
    ///     first-passage times.
    #[pyo3(signature = (kt, **settings))]
    fn rates<'py>(
        &self,
        py: Python<'py>,
        kt: Bound<'py, PyAny>,
        settings: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = match settings {
            Some(settings) => settings.copy()?,
            None => PyDict::new(py),
        };
        if !given.contains("seed")? {
            given.set_item("seed", self.found.request.seed)?;
        }
        let asked: rates::Request = request_with(py, Some(&given), "kt", kt)?;
        job::check_memory(asked.check_memory(job::threads()))?;
        job::check_memory(asked.survey().check_memory())?;
        let design = &self.content.design;
        let rates = job::answer(py, Some(false), |told| asked.rates(design, false, told))?;
        let document = report::rates::document(design, &rates, asked.seed);
        shown::report(py, &document)
    }

    /// The energies at which kinds of states merge.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Structured, one row per line of the graph: `states` (names of the states below it),
    ///     `energy_J` (of its lower end), `copies`, `joins_at_J` (NaN for a line that joins no
    ///     other) with proved bounds `lower_J` and `upper_J`.
    fn disconnectivity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table::array(py, &table::of_csv(&plots::merge_lines(&self.scene())))
    }
}
