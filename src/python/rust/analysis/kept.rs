//! Pickling of analyses.

use pyo3::prelude::*;
use tilebind::Analysis as Found;

use super::Analysis;
use crate::design::Design;
use crate::pickle;
use crate::shown::{self, Reduced};

#[pymethods]
impl Analysis {
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let this = slf.get();
        // The problem is that of the design.
        let Found {
            problem: _,
            request,
            roadmap,
            bound,
            catalogue,
            completeness,
            uncaptured,
            ring,
            uncertified,
            certificate_ended,
            dynamics,
            counts,
            stages,
        } = &this.found;
        let asked = (&this.content.source, this.wall_s, request, roadmap);
        let landscape = (bound, catalogue, completeness, uncaptured, ring);
        let work = (uncertified, certificate_ended, dynamics, counts, stages);
        shown::reduced(slf, &(asked, landscape, work))
    }

    #[staticmethod]
    fn _restore(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        let (asked, landscape, work) = pickle::load(bytes)?;
        let (source, wall_s, request, roadmap) = asked;
        let (bound, catalogue, completeness, uncaptured, ring) = landscape;
        let (uncertified, certificate_ended, dynamics, counts, stages) = work;
        let design = Design::of_source(py, source)?;
        let found = Found {
            problem: design.content.problem(None).clone(),
            request,
            roadmap,
            bound,
            catalogue,
            completeness,
            uncaptured,
            ring,
            uncertified,
            certificate_ended,
            dynamics,
            counts,
            stages,
        };
        Ok(Self {
            content: design.content.clone(),
            design: Py::new(py, design)?,
            found,
            wall_s,
        })
    }
}
