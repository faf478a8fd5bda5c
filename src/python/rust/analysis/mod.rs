//! The analysis and its results.

mod kept;
mod results;
mod views;

use std::sync::Arc;
use std::time::Instant;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use tilebind::Analysis as Found;
use tilebind::landscape::{Barrier, Place, pathway};
use tilebind::pipeline;
use tilebind::report::analysis::{Extent, document};
use tilebind::report::document::Document;
use tilebind::report::plots::{self, Scene, Sheet};

use crate::design::{Content, Design};
use crate::request::request;
use crate::table::FREE;
use crate::{convert, fault, job, shown};

/// Result of an analysis: states, traps, barriers with their bounds, pathways.
/// Immutable.
#[pyclass(frozen, module = "tilebind")]
pub struct Analysis {
    design: Py<Design>,
    content: Arc<Content>,
    found: Found,
    wall_s: f64,
}

#[pymethods]
impl Design {
    /// Find states, traps, barriers with their bounds, and pathways.
    ///
    /// Parameters
    /// ----------
    #[doc = include_str!("../keywords/analyse.txt")]
    /// progress : bool, optional
    ///     Show a tqdm progress bar; shown by default in terminals and notebooks.
    ///
    /// Returns
    /// -------
    /// Analysis
    ///
    /// Notes
    /// -----
    /// Defaults and results are those of ``tilebind analyse``, byte for byte. For very many
    /// magnets the defaults are reduced, so that a result takes minutes. Ctrl-C stops the
    /// analysis within a second.
    #[pyo3(signature = (*, progress = None, **settings))]
    fn analyse(
        slf: Py<Self>,
        py: Python<'_>,
        progress: Option<bool>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Analysis> {
        let content = slf.get().content.clone();
        let asked = request::<pipeline::Request>(settings)?.of([&content.design]);
        job::check_memory(asked.check_memory())?;
        let start = Instant::now();
        let found = job::run(py, progress, |told| {
            pipeline::analyse(&content.design, &asked, told)
        })?;
        Ok(Analysis {
            wall_s: start.elapsed().as_secs_f64(),
            design: slf,
            content,
            found,
        })
    }
}

impl Analysis {
    fn scene(&self) -> Scene<'_> {
        let design = &self.content.design;
        Scene::new(design, &self.found.problem, &self.found.catalogue)
    }

    fn document<'a>(&'a self, extent: Extent, scene: &'a Scene<'a>) -> Document<'a> {
        document(
            &self.content.design,
            &self.found,
            scene,
            extent,
            self.wall_s,
        )
    }

    /// The id of a state, or `free`.
    fn place(&self, place: &Bound<'_, PyAny>) -> PyResult<Place> {
        if place.is_instance_of::<PyString>() {
            let word: String = place.extract()?;
            if word == "free" {
                return Ok(Place::Free);
            }
            // The letter of a state, such as A or B'.
            let names = self.found.catalogue.names();
            if let Some(id) = names.iter().position(|name| *name == word) {
                return Ok(Place::State(id));
            }
            return Err(fault::value(format!(
                "{word:?}: a state is called by its id or its name ({}), or \"free\"",
                names.first().map_or("there are none", String::as_str)
            )));
        }
        convert::check_number(place)?;
        let id: i64 = place.extract()?;
        match usize::try_from(id) {
            Ok(id) if id < self.found.catalogue.states.len() => Ok(Place::State(id)),
            Err(_) if id == FREE => Ok(Place::Free),
            _ => Err(fault::value(format!(
                "there is no state {id}: there are {}, from 0",
                self.found.catalogue.states.len()
            ))),
        }
    }

    /// The path between two places, if known.
    fn way(&self, from: Place, to: Place) -> Option<tilebind::landscape::Pathway> {
        let catalogue = &self.found.catalogue;
        let known = |from: Place, to: Place| -> Option<Barrier> {
            let is_it = |barrier: &&Barrier| (barrier.from, barrier.to) == (from, to);
            let listed = catalogue.barriers.iter().find(is_it).cloned();
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

    /// The line of code that makes the same page.
    fn command(&self) -> String {
        let name = std::path::Path::new(&self.content.source.file);
        let name = name.file_name().unwrap_or_default().to_string_lossy();
        format!("tilebind analyse {name}")
    }

    /// SVG documents of the selected pictures.
    fn pictures(&self, py: Python<'_>, wanted: &[&str]) -> PyResult<Vec<String>> {
        shown::svg(py, || {
            plots::draw(&self.scene(), &Sheet::SCREEN, |name| wanted.contains(&name))
        })
    }
}
