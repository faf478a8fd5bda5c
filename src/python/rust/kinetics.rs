//! What shaken tiles do: exits from a pose, how strongly bond and traps hold, what is yielded.

use pyo3::prelude::*;
use tilebind::Analysis;
use tilebind::design::Design;
use tilebind::kinetics::bond::Shaking;
use tilebind::kinetics::exit::{ExitError, ExitSettings, exit, half_bond};
use tilebind::kinetics::rates::{RateSettings, RatesError, rates as solved};
use tilebind::kinetics::{Certify, why_unprovable};
use tilebind::landscape::Inventory;
use tilebind::problem::Problem;
use tilebind::report::bond::BondReport;
use tilebind::report::yields::document;
use tilebind::report::{json, rates as report};
use tilebind::yields::{Question, YieldError, yields};

use crate::{barrier, convert, fault, job};

/// What is asked of a tile that is let go; `None` for the program's defaults.
pub struct Asked {
    /// Effective energy of shaking (J).
    pub kt: f64,
    /// Drag rate (1/s).
    pub drag: f64,
    /// The tile is bound below this energy (J).
    pub basin_energy: Option<f64>,
    /// It is free where the centres are so far apart (m).
    pub free_at: Option<f64>,
    /// Relative distance of the bounds.
    pub certify: Option<f64>,
    /// Whether what can be proved is.
    pub prove: bool,
}

impl Asked {
    fn check(&self, design: &Design, problem: &Problem) -> PyResult<()> {
        let model = design.interaction.model;
        if self.prove
            && let Some(why) = why_unprovable(problem, model)
        {
            return Err(fault::value(why));
        }
        fault::positive("kt", Some(self.kt))?;
        fault::positive("drag", Some(self.drag))?;
        fault::positive("certify", self.certify)?;
        fault::positive("free_at", self.free_at)
    }

    fn certify(&self, usual: fn() -> Certify) -> Certify {
        let certify = self.certify.map_or_else(usual, Certify::to);
        match self.prove {
            true => certify.proved(),
            false => certify,
        }
    }

    fn free_at(&self, design: &Design) -> f64 {
        self.free_at.unwrap_or(design.space().free_distance)
    }
}

/// Mean exit time and exits of a tile that is let go at a pose.
pub fn exits<'py>(
    py: Python<'py>,
    (design, problem): (&Design, &Problem),
    start: &Bound<'py, PyAny>,
    asked: &Asked,
) -> PyResult<Bound<'py, PyAny>> {
    asked.check(design, problem)?;
    let start = barrier::pose(start)?;
    let bound = &design.pair.bound;
    let basin = asked
        .basin_energy
        .unwrap_or_else(|| half_bond(problem, bound));
    let free_at = asked.free_at(design);
    let settings = ExitSettings {
        certify: Some(asked.certify(Certify::of_exit)),
        ..ExitSettings::new(asked.kt, start, basin, free_at)
    };
    let found = job::quietly(py, || exit(problem, bound, &settings))?;
    let found = found.map_err(|error| match error {
        ExitError::Unsolved(_) => fault::run(error),
        _ => fault::value(error),
    })?;
    let motion = report::Motion::new(design, asked.kt, asked.drag);
    let entry = json::text(&report::exit_entry(&settings, &motion, &found));
    convert::json(py, &entry)
}

/// Rates between the bond, the deepest traps and free.
pub fn rates<'py>(
    py: Python<'py>,
    (design, analysis): (&Design, &Analysis),
    asked: &Asked,
    traps: usize,
) -> PyResult<Bound<'py, PyAny>> {
    asked.check(design, &analysis.problem)?;
    let places = report::Place::held(analysis, asked.kt, traps, asked.basin_energy);
    let basins = places.iter().map(report::Place::basin).collect();
    let free_at = asked.free_at(design);
    let settings = RateSettings {
        certify: Some(asked.certify(Certify::default)),
        ..RateSettings::new(asked.kt, basins, free_at)
    };
    let found = job::quietly(py, || solved(&analysis.problem, &settings))?;
    let found = found.map_err(|error| match error {
        RatesError::Unsolved(_) => fault::run(error),
        _ => fault::value(error),
    })?;
    let table = report::Table {
        design,
        asked: &settings,
        motion: &report::Motion::new(design, asked.kt, asked.drag),
        places: &places,
        found: &found,
    };
    convert::json(py, &json::text(&table.entry()))
}

/// Depths, docking costs and ln K of the bond and the traps of an analysis.
pub fn bond<'py>(
    py: Python<'py>,
    design: &Design,
    (problem, inventory): (&Problem, &Inventory),
    shaking: Shaking,
) -> PyResult<Bound<'py, PyAny>> {
    fault::positive("kt", Some(shaking.kt))?;
    fault::fraction("coverage", shaking.coverage)?;
    let entry = job::quietly(py, || {
        let report = BondReport::new(design, problem, inventory, shaking);
        report.map(|report| json::text(&report.json()))
    })?;
    convert::json(py, &entry.map_err(fault::run)?)
}

/// Most tiles on a table.
const MOST_TILES: usize = 10_000;

/// What a shaken table yields.
pub fn yielded<'py>(
    py: Python<'py>,
    design: &Design,
    question: &Question,
    progress: Option<bool>,
) -> PyResult<Bound<'py, PyAny>> {
    fault::count("kt", question.kts.len())?;
    for kt in &question.kts {
        fault::positive("kt", Some(*kt))?;
    }
    fault::positive("time", Some(question.time))?;
    fault::positive("duration", Some(question.effort.duration))?;
    fault::positive("drag", Some(question.effort.motion.drag))?;
    fault::not_negative("restitution", Some(question.effort.motion.restitution))?;
    fault::fraction("coverage", question.coverage)?;
    fault::count("runs", question.effort.runs)?;
    if !(2..=MOST_TILES).contains(&question.tiles) || question.tiles % 2 == 1 {
        return Err(fault::value(format!(
            "tiles = {}: an even number from 2 to {MOST_TILES}",
            question.tiles
        )));
    }
    let found = job::run(py, progress, |told| yields(design, question, told))?;
    let found = found.map_err(|error| match error {
        YieldError::Docking(_) | YieldError::Hot(..) | YieldError::Cold(_) | YieldError::Lost => {
            fault::value(error)
        }
        _ => fault::run(error),
    })?;
    convert::json(py, &document(design, question, &found).report())
}
