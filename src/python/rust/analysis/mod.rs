//! The main job and what it finds.

mod kept;
mod results;
mod shown;

use std::sync::Arc;
use std::time::Instant;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use tilebind::landscape::{Barrier, Place, pathway};
use tilebind::pipeline::{self, Request};
use tilebind::report::analysis::{Extent, document};
use tilebind::report::document::Document;
use tilebind::report::plots::{self, Scene, Sheet};
use tilebind::{Analysis as Found, Settings};

use crate::design::{Content, Design};
use crate::request::request;
use crate::table::FREE;
use crate::{fault, job};

/// The library's settings.
fn settings(given: Option<&Bound<'_, PyDict>>, design: &tilebind::Design) -> PyResult<Settings> {
    let settings = request::<Request>(given)?.settings(design);
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
    let content = design.get().content.clone();
    let settings = settings(given, &content.design)?;
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
            // What people call a state, A or B'.
            let names = self.found.catalogue.names();
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
            Ok(id) if id < self.found.catalogue.states.len() => Ok(Place::State(id)),
            Err(_) if id == FREE => Ok(Place::Free),
            _ => Err(fault::value(format!(
                "there is no state {id}: there are {}, from 0",
                self.found.catalogue.states.len()
            ))),
        }
    }

    /// The way between two places, if one is known.
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
