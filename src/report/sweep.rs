//! Sweeps: tables of all points, and what the terminal is told.

use std::fmt::Write;

use serde_json::{Map, Value as Json, json};

use super::assessments::{capture_settings, cells, columns, merge, quantities};
use super::comparison::checked;
use super::csv::table;
use super::json;
use super::plots::curve_names::said;
use jobs::comparison::Assessment;
use jobs::sweep::{Outcome, Plan, Point, Progress, Store};

/// The folder of the designs of points.
pub const DESIGNS: &str = "designs";
/// Of more points the designs are not written.
const MOST_DESIGNS: usize = 400;
/// Reasons that the summary gives.
const REASONS: usize = 5;

/// A finished sweep.
#[derive(Clone, Debug)]
pub struct Sweep<'a> {
    /// What was asked.
    pub plan: &'a Plan,
    /// The points of the plan, in order.
    pub points: Vec<Point>,
    /// What came of each point.
    pub outcomes: Vec<Outcome>,
}

impl<'a> Sweep<'a> {
    /// Reads what came of each point.
    ///
    /// # Errors
    /// How far the sweep is, where points are missing.
    pub fn read(plan: &'a Plan, store: &Store) -> Result<Self, Progress> {
        let points = plan.points();
        let found: Vec<Option<Outcome>> = points.iter().map(|point| store.load(point)).collect();
        let progress = Progress::new(found.iter().map(Option::as_ref));
        if progress.missing > 0 {
            return Err(progress);
        }
        Ok(Self {
            plan,
            points,
            outcomes: found.into_iter().flatten().collect(),
        })
    }

    /// How many points are done, impossible, failed and missing.
    pub fn progress(&self) -> Progress {
        Progress::new(self.outcomes.iter().map(Some))
    }

    /// The assessment of a point, if its design is possible.
    pub fn assessment(&self, index: usize) -> Option<&Assessment> {
        match &self.outcomes[index] {
            Outcome::Done { result } => Some(result),
            Outcome::Impossible { .. } | Outcome::Failed { .. } => None,
        }
    }

    /// Why a point has no assessment.
    pub fn reason(&self, index: usize) -> Option<&str> {
        reason(&self.outcomes[index])
    }

    /// One line a point: the varied keys (as the design file has them, in SI units), the figures
    /// with their bounds, and for impossible designs the reason.
    pub fn csv(&self) -> String {
        let figures = columns();
        let mut head = ["index", "design"].map(str::to_owned).to_vec();
        head.extend(self.plan.axes.iter().map(|axis| axis.key.clone()));
        head.extend(["status", "reason", "model", "point"].map(str::to_owned));
        head.extend(figures.iter().cloned());
        let rows = self.points.iter().map(|point| {
            let outcome = &self.outcomes[point.index];
            let result = self.assessment(point.index);
            let mut row = vec![
                point.index.to_string(),
                self.plan.designs[point.design].name.clone(),
            ];
            row.extend(point.values.iter().map(ToString::to_string));
            row.extend([
                status(outcome).to_owned(),
                reason(outcome).unwrap_or_default().to_owned(),
                result.map(|r| r.model.clone()).unwrap_or_default(),
                point.name.clone(),
            ]);
            row.extend(result.map_or_else(|| vec![String::new(); figures.len()], cells));
            row
        });
        table(head, rows)
    }

    /// Everything, with what reproduces it.
    pub fn json(&self) -> String {
        let points: Vec<Json> = self.points.iter().map(|point| self.entry(point)).collect();
        let designs: Vec<Json> = self
            .plan
            .designs
            .iter()
            .map(|source| json!({"name": source.name, "sha256": source.sha256}))
            .collect();
        json::text(&json!({
            "tilebind": self.plan.tilebind,
            "designs": designs,
            "axes": self.plan.axes,
            "settings": self.plan.settings,
            "capture_range": capture_settings(),
            "seed": self.plan.seed,
            "counts": self.progress(),
            "baseline": self.plan.baseline_of(&self.points),
            "points": points,
        }))
    }

    fn entry(&self, point: &Point) -> Json {
        let values: Map<String, Json> = self
            .plan
            .axes
            .iter()
            .zip(&point.values)
            .map(|(axis, value)| (axis.key.clone(), json!(value)))
            .collect();
        let mut entry = json!({
            "index": point.index,
            "design": self.plan.designs[point.design].name,
            "values": values,
            "point": point.name,
        });
        let outcome = &self.outcomes[point.index];
        merge(&mut entry, json!(outcome));
        if let Some(assessment) = self.assessment(point.index) {
            merge(&mut entry, json!({"quantities": quantities(assessment)}));
        }
        entry
    }

    /// What came of it, for the terminal.
    pub fn summary(&self, columns: Option<usize>) -> String {
        let mut out = self.answer() + &self.table(columns);
        out += &counts(&self.progress());
        out.push('\n');
        let refused: Vec<(&Point, &str)> = self
            .points
            .iter()
            .filter_map(|point| Some((point, reason(&self.outcomes[point.index])?)))
            .collect();
        for (point, reason) in refused.iter().take(REASONS) {
            let _ = writeln!(out, "  {}: {reason}", self.called(point));
        }
        if refused.len() > REASONS {
            let more = refused.len() - REASONS;
            let _ = writeln!(out, "  and {more} more, see sweep.csv");
        }
        let designs = (0..self.outcomes.len()).filter_map(|index| self.assessment(index));
        out + &checked(designs)
    }

    /// The file of a point's design beside the results; `None` where it is impossible, or needs
    /// drawings, which lie elsewhere.
    pub fn design_file(&self, point: &Point) -> Option<String> {
        let needs_drawings = !self.plan.designs[point.design].drawings.is_empty();
        let possible = self.assessment(point.index).is_some() && point.text().is_some();
        let few = self.points.len() <= MOST_DESIGNS;
        (possible && few && !needs_drawings).then(|| format!("{DESIGNS}/{}.toml", point.name))
    }

    /// The designs of points by their files.
    pub fn designs(&self) -> impl Iterator<Item = (String, &str)> {
        let points = self.points.iter();
        points.filter_map(|point| Some((self.design_file(point)?, point.text()?)))
    }

    /// A point by its values: `depth = 5 mm, model = dipole`; with several designs, or where nothing
    /// is varied, by its design first.
    pub fn called(&self, point: &Point) -> String {
        let design = &self.plan.designs[point.design].name;
        let named = self.plan.designs.len() > 1 || self.plan.axes.is_empty();
        let values = self.plan.axes.iter().zip(&point.values);
        let values = values.map(|(axis, value)| {
            let name = axis.name();
            format!("{name} = {}", said(name, value))
        });
        let parts = named.then(|| design.clone()).into_iter().chain(values);
        parts.collect::<Vec<_>>().join(", ")
    }

    /// The point that all are set against, if one was named and could be assessed.
    pub fn baseline(&self) -> Option<usize> {
        let index = self.plan.baseline_of(&self.points)?;
        self.assessment(index).map(|_| index)
    }
}

/// `11 points: 10 done, 1 impossible`.
pub fn counts(progress: &Progress) -> String {
    let kinds = [
        (progress.done, "done"),
        (progress.impossible, "impossible"),
        (progress.failed, "failed"),
        (progress.missing, "missing"),
    ];
    let kinds: Vec<String> = kinds
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, kind)| format!("{count} {kind}"))
        .collect();
    format!("{} points: {}", progress.points, kinds.join(", "))
}

fn status(outcome: &Outcome) -> &'static str {
    match outcome {
        Outcome::Done { .. } => "done",
        Outcome::Impossible { .. } => "impossible",
        Outcome::Failed { .. } => "failed",
    }
}

fn reason(outcome: &Outcome) -> Option<&str> {
    match outcome {
        Outcome::Done { .. } => None,
        Outcome::Impossible { reason } | Outcome::Failed { reason } => Some(reason),
    }
}
