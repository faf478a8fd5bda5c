//! Sweeps as documents: tables of all points, and the terminal text.

use serde_json::{Map, Value as Json, json};

use super::pictures::drawings;
use crate::assessments::{capture_settings, checked, merge, numbers, quantities};
use crate::document::{Cell, Document, Entries, PagePart, Table, rows};
use crate::page::Charts;
use crate::points::FinishedSweep;
use jobs::sweep::{Outcome, Progress, SweepPoint};

/// Largest number of reasons in the summary.
const REASONS: usize = 5;

impl FinishedSweep<'_> {
    /// The document of the sweep.
    pub fn document(&self) -> Document<'_> {
        let plan = self.plan;
        let names: Vec<&str> = plan.designs.iter().map(|d| d.name.as_str()).collect();
        let keys: Vec<&str> = plan.axes.iter().map(|axis| axis.key.as_str()).collect();
        let counts = counts(&self.progress());
        let designs = (0..self.outcomes.len()).filter_map(|index| self.assessment(index));
        let refused = self.points.iter().filter_map(|point| {
            let reason = self.reason(point.index)?;
            Some(format!("  {}: {reason}", self.called(point)))
        });
        let refused: Vec<String> = refused.collect();
        let more = refused.len().saturating_sub(REASONS);
        let more = (more > 0).then(|| format!("  and {more} more, see sweep.csv"));
        let beside = self.designs();
        let beside = beside.map(|(name, text)| (name, text.as_bytes().to_vec()));
        Document {
            title: format!("{}: sweep of {}", names.join(", "), keys.join(", ")),
            answer: self.answer().unwrap_or_else(|| counts.clone()),
            entries: self.entries(),
            part: Some(PagePart::Charts(Charts::new(self))),
            pictures: drawings(self),
            notes: [counts]
                .into_iter()
                .chain(refused.into_iter().take(REASONS))
                .chain(more)
                .chain(checked(designs))
                .collect(),
            beside: beside.collect(),
            origin: format!("seed {}; plan.json has all settings", plan.seed),
            ..Document::default()
        }
    }

    // One line an entry.
    #[rustfmt::skip]
    fn entries(&self) -> Entries {
        let plan = self.plan;
        let designs = plan.designs.iter().map(|source| json!({"name": source.name, "sha256": source.sha256}));
        Entries::default()
            .data("tilebind", &plan.tilebind[..])
            .data("designs", designs.collect::<Json>())
            .data("axes", &plan.axes)
            .data("settings", &plan.settings)
            .data("capture_range", capture_settings())
            .data("seed", plan.seed)
            .data("counts", self.progress())
            .data("baseline", plan.baseline_of(&self.points))
            .data("points", self.points.iter().map(|point| self.entry(point)).collect::<Json>())
            .fact("", "points", counts(&self.progress())).in_view()
            .table(self.numbers())
            .table(self.listed())
    }

    pub(super) fn entry(&self, point: &SweepPoint) -> Json {
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

    /// One row per point: the varied keys (in the notation of the design file, in SI units), the
    /// figures with their bounds, and the reason for impossible designs.
    pub fn numbers(&self) -> Table {
        let points = self.points.iter();
        let mut all = rows(points.map(|point| (point, self.assessment(point.index))))
            .data("index", |(point, _)| point.index)
            .data("design", |(point, _)| {
                self.plan.designs[point.design].name.clone()
            });
        for (k, axis) in self.plan.axes.iter().enumerate() {
            let is_number = axis.numbers().is_some();
            let value = move |(point, _): &(&SweepPoint, _)| -> Cell {
                let value = &point.values[k];
                let number = value.number().filter(|_| is_number);
                number.map_or_else(|| value.to_string().into(), Into::into)
            };
            all = all.data(axis.key.clone(), value);
        }
        let outcome = |point: &SweepPoint| &self.outcomes[point.index];
        let all = all
            .data("status", |(point, _)| status(outcome(point)))
            .data("reason", |(point, _)| {
                self.reason(point.index).map(str::to_owned)
            })
            .data("model", |(_, one)| one.map(|one| one.model.clone()))
            .data("point", |(point, _)| point.name.clone());
        numbers(all, |(_, one)| *one).table("sweep").in_csv("sweep")
    }

    /// The designs of points by their files.
    pub fn designs(&self) -> impl Iterator<Item = (String, &str)> {
        let points = self.points.iter();
        points.filter_map(|point| Some((self.design_file(point)?, point.text()?)))
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
