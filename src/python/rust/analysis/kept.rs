//! Analyses in pickles.

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::{Deserialize, Serialize};
use tilebind::budget::Ended;
use tilebind::dynamics::check::BarrierCheck;
use tilebind::landscape::{Catalogue, Completeness, Uncaptured, Uncertified};
use tilebind::pipeline::{Counts, Stage};
use tilebind::roadmap::RoadmapSettings;
use tilebind::sweep::Source;
use tilebind::{Analysis as Found, Configuration, Settings};

use super::Analysis;
use crate::design::Design;
use crate::pickle;

/// All of an analysis that is not the design.
#[derive(Serialize, Deserialize)]
struct Kept {
    source: Source,
    settings: Settings,
    roadmap: RoadmapSettings,
    bound: (Configuration, f64),
    catalogue: Catalogue,
    completeness: Result<Completeness, Uncertified>,
    uncaptured: Uncaptured,
    ring: [f64; 2],
    uncertified: Option<Uncertified>,
    certificate_ended: Option<Ended>,
    dynamics: Option<Vec<BarrierCheck>>,
    counts: Counts,
    stages: Vec<Stage>,
    wall_s: f64,
}

#[pymethods]
impl Analysis {
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
            catalogue: found.catalogue.clone(),
            completeness: found.completeness.clone(),
            uncaptured: found.uncaptured,
            ring: found.ring,
            uncertified: found.uncertified,
            certificate_ended: found.certificate_ended,
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
            catalogue: kept.catalogue,
            completeness: kept.completeness,
            uncaptured: kept.uncaptured,
            ring: kept.ring,
            uncertified: kept.uncertified,
            certificate_ended: kept.certificate_ended,
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
