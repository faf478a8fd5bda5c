//! What shaken tiles do: exits from a pose, how strongly bond and traps hold, what is yielded.

use pyo3::prelude::*;
use tilebind::Analysis;
use tilebind::bond::held;
use tilebind::design::Design;
use tilebind::kinetics::bond::Shaking;
use tilebind::kinetics::exit::ExitError;
use tilebind::kinetics::rates::RatesError;
use tilebind::landscape::Catalogue;
use tilebind::problem::Problem;
use tilebind::rates;
use tilebind::report::bond::document as bond_document;
use tilebind::report::rates::{document as rates_document, exit_document};
use tilebind::report::yields::document;
use tilebind::yields::{Question, yields};

use crate::{barrier, convert, fault, job};

fn check(asked: &rates::Question, design: &Design, problem: &Problem) -> PyResult<()> {
    if let Some(why) = asked.refused(design, problem) {
        return Err(fault::value(why));
    }
    Ok(())
}

/// Mean exit time and exits of a tile that is let go at a pose.
pub fn exits<'py>(
    py: Python<'py>,
    (design, problem): (&Design, &Problem),
    start: &Bound<'py, PyAny>,
    asked: &rates::Question,
) -> PyResult<Bound<'py, PyAny>> {
    check(asked, design, problem)?;
    let start = barrier::pose(start)?;
    let found = job::quietly(py, || asked.exit((design, problem), start))?;
    let found = found.map_err(|error| match error {
        ExitError::Unsolved(_) => fault::run(error),
        _ => fault::value(error),
    })?;
    convert::json(py, &exit_document(design, &found, None).report())
}

/// Rates between the bond, the deepest traps and free.
pub fn rates<'py>(
    py: Python<'py>,
    (design, analysis): (&Design, &Analysis),
    asked: &rates::Question,
    traps: usize,
) -> PyResult<Bound<'py, PyAny>> {
    check(asked, design, &analysis.problem)?;
    let found = job::quietly(py, || asked.rates(design, analysis, traps, false))?;
    let found = found.map_err(|error| match error {
        RatesError::Unsolved(_) => fault::run(error),
        _ => fault::value(error),
    })?;
    let document = rates_document(design, &found, analysis.settings.seed);
    convert::json(py, &document.report())
}

/// Depths, docking costs and ln K of the bond and the traps of an analysis.
pub fn bond<'py>(
    py: Python<'py>,
    design: &Design,
    found: (&Problem, &Catalogue),
    shaking: Shaking,
) -> PyResult<Bound<'py, PyAny>> {
    fault::positive("kt", Some(shaking.kt))?;
    fault::fraction("coverage", shaking.coverage)?;
    let held = job::quietly(py, || held(design, found, shaking, false))?;
    let held = held.map_err(fault::run)?;
    convert::json(py, &bond_document(design, &held).report())
}

/// What a shaken table yields.
pub fn yielded<'py>(
    py: Python<'py>,
    design: &Design,
    question: &Question,
    progress: Option<bool>,
) -> PyResult<Bound<'py, PyAny>> {
    let found = job::run(py, progress, |told| yields(design, question, told))?;
    let found = found.map_err(|error| match error.is_of_the_question() {
        true => fault::value(error),
        false => fault::run(error),
    })?;
    convert::json(py, &document(design, question, &found).report())
}
