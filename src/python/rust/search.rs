//! Searches: the best of the designs that varied keys give.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::{Mutex, PoisonError};

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping, PyString};
use tilebind::comparison;
use tilebind::report::sweep::Searched;
use tilebind::request::of_keywords;
use tilebind::search::{Request as Aims, Search as Sought, SearchError, SearchResult};
use tilebind::sweep::{Axis, Outcome, Plan, SweepPoint, run as work_on};

use crate::design::Design;
use crate::job::Told;
use crate::request::request;
use crate::shown::{self, Reduced};
use crate::sweep::{axis, design_of};
use crate::{convert, fault, job, pickle, table};

/// A text, or several.
#[derive(FromPyObject)]
pub enum Texts {
    /// One.
    #[pyo3(transparent)]
    One(String),
    /// Several.
    #[pyo3(transparent)]
    Several(Vec<String>),
}

fn all(texts: Option<Texts>) -> Vec<String> {
    match texts {
        Some(Texts::One(text)) => vec![text],
        Some(Texts::Several(texts)) => texts,
        None => Vec::new(),
    }
}

/// Search for the best of the designs that varied keys give, with certified bounds.
///
/// Parameters
/// ----------
/// designs : Design or sequence of Design
///     Several are shapes among which it chooses.
/// vary : Mapping
///     By dotted path of the key: a range as text, ``{"magnet.inset": "0 mm:5 mm"}``, of which
///     it takes any number, or the values among which it chooses.
#[doc = include_str!("keywords/search.txt")]
/// progress : bool, optional
///
/// Returns
/// -------
/// Search
///     Results are those of ``tilebind sweep --maximise``.
///
/// Examples
/// --------
/// >>> found = tilebind.search(design, {"magnet.inset": "0:0.005"}, maximise="selectivity",
/// ...                         subject="bond_depth > 20 mJ")
/// >>> print(found.best.text)
#[pyfunction]
#[pyo3(signature = (
    designs, vary, *, maximise = None, minimise = None, subject = None, points = None,
    progress = None, **settings
))]
// Its keywords.
#[allow(clippy::too_many_arguments)]
pub fn search(
    py: Python<'_>,
    designs: &Bound<'_, PyAny>,
    vary: &Bound<'_, PyMapping>,
    maximise: Option<Texts>,
    minimise: Option<Texts>,
    subject: Option<Texts>,
    points: Option<&Bound<'_, PyAny>>,
    progress: Option<bool>,
    settings: Option<&Bound<'_, PyDict>>,
) -> PyResult<Search> {
    let designs: Vec<Py<Design>> = match designs.extract() {
        Ok(one) => vec![one],
        Err(_) => designs.extract()?,
    };
    let contents = designs.iter().map(|one| &one.get().content);
    let designs = contents.map(|content| (content.source.clone(), content.design.clone()));
    let range = |(key, values): (Bound<'_, PyAny>, Bound<'_, PyAny>)| -> PyResult<Axis> {
        match values.cast::<PyString>() {
            Ok(text) => format!("{key}={text}").parse().map_err(fault::value),
            Err(_) => axis((key, values)),
        }
    };
    let items = vary.items()?;
    let axes = items.iter().map(|item| range(item.extract()?));
    let axes = axes.collect::<PyResult<Vec<_>>>()?;
    let points = points.map(convert::whole).transpose()?;
    let given = [
        ("maximise", all(maximise)),
        ("minimise", all(minimise)),
        ("subject", all(subject)),
        ("points", points.iter().map(ToString::to_string).collect()),
    ];
    let given = given.map(|(key, values)| (key.to_owned(), values));
    let aim: Aims = of_keywords(given).map_err(fault::value)?;
    let aim = aim.aim().map_err(fault::value)?;
    let aim =
        aim.ok_or_else(|| fault::value("give maximise or minimise, such as \"selectivity\""))?;
    let assessments = request::<comparison::Request>(settings)?;
    let search = Sought::asked(&assessments, designs.collect(), axes, aim).map_err(fault::of)?;
    job::check_memory(search.plan.check_memory(job::threads()))?;
    let known = Mutex::new(BTreeMap::new());
    let found = job::run(py, progress, |told| work(&search, &known, told))?;
    let outcomes = known.into_inner().unwrap_or_else(PoisonError::into_inner);
    Search::new(search, found, outcomes)
}

/// Outcomes by the names of points.
type Known = BTreeMap<String, Outcome>;

fn work(search: &Sought, known: &Mutex<Known>, told: &Told) -> Result<SearchResult, SearchError> {
    let all = || known.lock().unwrap_or_else(PoisonError::into_inner);
    let count = search.aim.points + search.most_proofs();
    told.tell(0.0, format!("{count} analyses"));
    let found = search.run(|plan: &Plan, points: &[SweepPoint]| {
        let Ok(()) = work_on(plan, points, job::threads(), |point, outcome| {
            all().insert(point.name.clone(), outcome.clone());
            let done = all().len();
            let text = format!("{done} of at most {count} analyses");
            told.tell(done as f64 / count as f64, text);
            Ok::<(), Infallible>(())
        });
        Ok::<_, Infallible>(outcomes(&all(), points))
    });
    let Ok(found) = found;
    found
}

fn outcomes(known: &Known, points: &[SweepPoint]) -> Result<Vec<Outcome>, usize> {
    let found = points.iter().map(|point| known.get(&point.name).cloned());
    found.collect::<Option<Vec<_>>>().ok_or(points.len())
}

/// Results of a search. Immutable.
#[pyclass(frozen, module = "tilebind")]
pub struct Search {
    search: Sought,
    found: SearchResult,
    known: Known,
}

impl Search {
    fn new(
        search: Sought,
        found: Result<SearchResult, SearchError>,
        known: Known,
    ) -> PyResult<Self> {
        match found {
            Ok(found) => Ok(Self {
                search,
                found,
                known,
            }),
            Err(SearchError::NonePossible(error)) => Err(fault::of(error)),
            Err(SearchError::Unfinished(..)) => Err(fault::value("the search is not finished")),
        }
    }

    fn searched(&self) -> Searched<'_> {
        Searched::new(&self.search, &self.found)
    }

    fn of_point(&self, py: Python<'_>, index: usize) -> PyResult<Design> {
        let tried = &self.found.tried;
        let point = tried.get(index).ok_or_else(|| {
            pyo3::exceptions::PyIndexError::new_err(format!("there are {} points", tried.len()))
        })?;
        design_of(py, &self.search.plan, &point.point)
    }
}

#[pymethods]
impl Search {
    /// Design or None : The best design; None if nothing satisfies the conditions, and with two
    /// objectives.
    #[getter]
    fn best(&self, py: Python<'_>) -> PyResult<Option<Design>> {
        let best = self.searched().best();
        best.map(|best| self.of_point(py, best)).transpose()
    }

    /// list of int : The numbers of the points of the front, the best in the first objective first;
    /// the best point alone with one objective.
    #[getter]
    fn front(&self) -> Vec<usize> {
        self.searched().front
    }

    /// numpy.ndarray : One row per point that was tried, structured, for ``pandas.DataFrame``, as
    /// :attr:`Sweep.table`.
    #[getter]
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table::array(py, &self.searched().sweep().numbers())
    }

    /// dict : All results and settings, as in ``report.json``: ``best`` with its bounds, its
    /// conditions, the points that are not proved worse and the sensitivity to each key and to two at once.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        shown::report(py, &self.searched().document())
    }

    /// A short summary of the results.
    ///
    /// Returns
    /// -------
    /// str
    fn summary(&self) -> String {
        self.searched().document().text(Some(100))
    }

    /// The design of a point.
    ///
    /// Parameters
    /// ----------
    /// index : int
    ///     The point's number.
    ///
    /// Returns
    /// -------
    /// Design
    fn design(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = convert::whole)] index: usize,
    ) -> PyResult<Design> {
        self.of_point(py, index)
    }

    /// The course of the search, and the front of two objectives, as SVG documents.
    ///
    /// Returns
    /// -------
    /// list of str
    fn svg(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        shown::pictures(py, &self.searched().document())
    }

    /// The page of the search.
    ///
    /// Returns
    /// -------
    /// str
    fn report_html(&self, py: Python<'_>) -> PyResult<String> {
        shown::page(py, &self.searched().document(), "")
    }

    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        shown::notebook(py, self.summary(), self.svg(py)?)
    }

    fn __len__(&self) -> usize {
        self.found.tried.len()
    }

    fn __repr__(&self) -> String {
        let objectives = self.search.aim.objectives.iter().map(ToString::to_string);
        let (count, objectives) = (self.found.tried.len(), objectives.collect::<Vec<_>>());
        format!(
            "<tilebind.Search of {count} points for the {}>",
            objectives.join(" and ")
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let Self { search, known, .. } = slf.get();
        shown::reduced(slf, &(search, known))
    }

    #[staticmethod]
    fn _restore(bytes: &[u8]) -> PyResult<Self> {
        let (search, known): (Sought, Known) = pickle::load(bytes)?;
        let Ok(found) = search.run(|_, points| Ok::<_, Infallible>(outcomes(&known, points)));
        Self::new(search, found, known)
    }
}
