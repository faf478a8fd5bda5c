//! The manifest of a sweep: all its inputs, and the points that follow from them.

use std::collections::HashSet;

use serde::{Deserialize, Serialize};
use serde_json::json;
use sha2::{Digest, Sha256};
use toml::Table;

use super::error::{MOST_POINTS, PlanError};
use super::point::SweepPoint;
use super::source::DesignSource;
use super::vary::{Axis, Value, number};
use super::{document, drawings};
use crate::comparison::Thoroughness;
use crate::design::Design;
use crate::memory;
use physics::parallel;

/// Characters of a point's name: 128 bits in hexadecimal.
const NAME: usize = 32;

/// A sweep: designs, varied keys, and settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Version of tilebind.
    pub tilebind: String,
    /// The designs; their names are distinct.
    pub designs: Vec<DesignSource>,
    /// The varied keys; the first varies slowest.
    pub axes: Vec<Axis>,
    /// The settings of all points.
    pub settings: Thoroughness,
    /// The seed of every point, as of `analyse` and `compare`: with the same random numbers, far
    /// starts among them, points differ by their designs and less by chance.
    pub seed: u64,
    /// The point that all others are compared with, see [`Plan::against`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub baseline: Option<String>,
}

impl Plan {
    /// Plans a sweep over designs.
    ///
    /// # Errors
    /// If a design is invalid, a key cannot be varied or is varied twice, there are too many
    /// points, or none is possible. A key that the design does not have counts as a mistake if none
    /// of its values gives a possible design.
    pub fn of(
        designs: Vec<DesignSource>,
        axes: Vec<Axis>,
        settings: Thoroughness,
        seed: u64,
    ) -> Result<Self, PlanError> {
        let plan = Self::new(designs, axes, settings, seed)?;
        plan.check_count()?;
        plan.check_keys()?;
        plan.check_possible()?;
        Ok(plan)
    }

    /// Plans a search over designs, in which axes may be ranges. Whether any point is possible is
    /// not checked.
    ///
    /// # Errors
    /// As [`Plan::of`].
    pub fn between(
        designs: Vec<DesignSource>,
        axes: Vec<Axis>,
        settings: Thoroughness,
        seed: u64,
    ) -> Result<Self, PlanError> {
        let plan = Self::new(designs, axes, settings, seed)?;
        plan.check_keys()?;
        Ok(plan)
    }

    fn new(
        mut designs: Vec<DesignSource>,
        axes: Vec<Axis>,
        settings: Thoroughness,
        seed: u64,
    ) -> Result<Self, PlanError> {
        for design in &mut designs {
            design.hold_drawings(&axes);
        }
        let plan = Self {
            tilebind: env!("CARGO_PKG_VERSION").to_owned(),
            designs,
            axes,
            settings,
            seed,
            baseline: None,
        };
        plan.check()?;
        Ok(plan)
    }

    /// The same, with all points compared with one: the first point of a design by its name, or the
    /// one with given values (`depth=0`, or `depth=0,width=0.1`; the last part of a key's path
    /// suffices).
    ///
    /// # Errors
    /// If there is no such point.
    pub fn against(self, baseline: &str) -> Result<Self, PlanError> {
        let plan = Self {
            baseline: Some(baseline.to_owned()),
            ..self
        };
        let points = plan.points();
        if plan.baseline_of(&points).is_some() {
            return Ok(plan);
        }
        let axes = plan.axes.iter();
        let values = axes.map(|axis| format!("{}={}", axis.name(), axis.values[0]));
        let example = values.collect::<Vec<_>>().join(",");
        Err(PlanError::NoBaseline(baseline.to_owned(), example))
    }

    /// The index of the baseline point, if one is named.
    pub fn baseline_of(&self, points: &[SweepPoint]) -> Option<usize> {
        let parts: Vec<&str> = self.baseline.as_ref()?.split(',').map(str::trim).collect();
        let is_meant = |point: &&SweepPoint| {
            parts.iter().all(|part| match part.split_once('=') {
                None => self.designs[point.design].name == *part,
                Some((key, value)) => self.axes.iter().zip(&point.values).any(|(axis, own)| {
                    let (key, value) = (key.trim(), value.trim());
                    let same = own.number().zip(number(value)).is_some_and(|(a, b)| a == b);
                    (axis.key == key || axis.name() == key) && (same || own.to_string() == value)
                }),
            })
        };
        Some(points.iter().find(is_meant)?.index)
    }

    /// Rejects empty and ambiguous plans.
    pub(crate) fn check(&self) -> Result<(), PlanError> {
        let malformed = |message: String| Err(PlanError::Malformed(message));
        if self.designs.is_empty() {
            return malformed("it has no design".to_owned());
        }
        if let Some(axis) = self.axes.iter().find(|axis| axis.values.is_empty()) {
            return malformed(format!("`{}` has no values", axis.key));
        }
        let is_range = |axis: &&Axis| axis.is_range;
        let is_wrong = |axis: &&Axis| !matches!(axis.numbers().as_deref(), Some([a, b]) if a < b);
        if let Some(axis) = self.axes.iter().filter(is_range).find(is_wrong) {
            return malformed(format!("`{}` has no range", axis.key));
        }
        let mut seen = HashSet::new();
        let mut names = self.designs.iter().map(|design| &design.name);
        if let Some(name) = names.find(|name| !seen.insert(*name)) {
            return Err(PlanError::SameName(name.clone()));
        }
        let mut seen = HashSet::new();
        let mut keys = self.axes.iter().map(|axis| &axis.key);
        if let Some(key) = keys.find(|key| !seen.insert(*key)) {
            return Err(PlanError::Twice(key.clone()));
        }
        match self.settings.check() {
            Err(error) => malformed(error.to_string()),
            Ok(()) => Ok(()),
        }
    }

    /// Rejects ranges, which have no points of their own, and too many points.
    fn check_count(&self) -> Result<(), PlanError> {
        if let Some(range) = self.axes.iter().find(|axis| axis.is_range) {
            let ends: Vec<String> = range.values.iter().map(Value::to_string).collect();
            return Err(PlanError::NoCount(range.key.clone(), ends.join(":")));
        }
        let lengths = self.axes.iter().map(|axis| axis.values.len() as u128);
        let count = lengths.fold(self.designs.len() as u128, u128::saturating_mul);
        match count <= MOST_POINTS as u128 {
            true => Ok(()),
            false => Err(PlanError::TooMany(count)),
        }
    }

    /// The manifest's text. It also lists the points, for people and schedulers.
    pub fn to_text(&self) -> String {
        let points: Vec<_> = self
            .points()
            .into_iter()
            .map(|point| {
                json!({
                    "index": point.index, "point": point.name, "seed": self.seed,
                    "design": self.designs[point.design].name, "values": point.values,
                })
            })
            .collect();
        let mut all = json!(self);
        if let Some(object) = all.as_object_mut() {
            object.insert("points".to_owned(), points.into());
        }
        // Plain values with string keys can always be serialised.
        serde_json::to_string_pretty(&all).unwrap_or_default() + "\n"
    }

    /// Reads a manifest.
    ///
    /// # Errors
    /// If the text is not a manifest, is from another version, or has no or too many points.
    pub fn parse(text: &str) -> Result<Self, PlanError> {
        let plan: Self =
            serde_json::from_str(text).map_err(|error| PlanError::Malformed(error.to_string()))?;
        plan.check_version()?;
        plan.check()?;
        plan.check_count()?;
        Ok(plan)
    }

    /// Rejects manifests of other versions.
    pub(crate) fn check_version(&self) -> Result<(), PlanError> {
        match self.tilebind == env!("CARGO_PKG_VERSION") {
            true => Ok(()),
            false => Err(PlanError::Version(self.tilebind.clone())),
        }
    }

    /// The number of points.
    pub fn count(&self) -> usize {
        self.designs.len() * self.grid()
    }

    /// The memory for the points that are computed at the same time on a number of threads, as a
    /// message if it is large.
    ///
    /// # Errors
    /// If the machine does not have enough memory.
    pub fn check_memory(&self, threads: usize) -> Result<Option<String>, String> {
        let is_search = self.axes.iter().any(|axis| axis.is_range);
        let most = if is_search { threads } else { self.count() };
        let (survey, at_once) = (&self.settings.survey, threads.min(most));
        memory::check_starts(survey.far_starts.unwrap_or(0), at_once)?;
        memory::check(survey.milestones.unwrap_or(0), survey.neighbours, at_once)
    }

    /// The number of points of each design.
    fn grid(&self) -> usize {
        self.axes.iter().map(|axis| axis.values.len()).product()
    }

    /// All points, in order.
    pub fn points(&self) -> Vec<SweepPoint> {
        self.each(|point| point)
    }

    /// Applies a function to each point, in order, without storing the points: a million of them
    /// would take gigabytes.
    pub fn each<T: Send>(&self, of: impl Fn(SweepPoint) -> T + Sync) -> Vec<T> {
        let documents: Vec<Table> = self.designs.iter().map(DesignSource::document).collect();
        let settings = self.named_settings();
        parallel::map(0..self.count(), |index| {
            of(self.point(&documents, &settings, index))
        })
    }

    fn point(&self, documents: &[Table], settings: &str, index: usize) -> SweepPoint {
        let grid = self.grid();
        let (design, mut place) = (index / grid, index % grid);
        let mut values: Vec<Value> = Vec::with_capacity(self.axes.len());
        for axis in self.axes.iter().rev() {
            values.push(axis.values[place % axis.values.len()].clone());
            place /= axis.values.len();
        }
        values.reverse();
        self.with(&documents[design], settings, (index, design, values))
    }

    /// A point with given values, one for each axis.
    pub fn point_of(&self, index: usize, design: usize, values: Vec<Value>) -> SweepPoint {
        let document = self.designs[design].document();
        self.with(&document, &self.named_settings(), (index, design, values))
    }

    /// What names contain besides the design.
    fn named_settings(&self) -> String {
        json!({"settings": self.settings, "seed": self.seed}).to_string()
    }

    fn with(
        &self,
        document: &Table,
        settings: &str,
        (index, design, values): (usize, usize, Vec<Value>),
    ) -> SweepPoint {
        let mut document = document.clone();
        let mut set = self.axes.iter().zip(&values);
        let text = set
            .try_for_each(|(axis, value)| document::set(&mut document, &axis.key, value.toml()))
            .map(|()| document.to_string());
        let held = &self.designs[design].drawings;
        let drawings = drawings::named(&document).into_iter();
        let drawings = drawings.filter_map(|name| held.get_key_value(name));
        let named = text.as_ref().unwrap_or_else(|reason| reason);
        let name = self.name(settings, named, drawings);
        SweepPoint {
            index,
            name,
            design,
            values,
            text,
        }
    }

    fn name<'a>(
        &self,
        settings: &str,
        text: &str,
        drawings: impl Iterator<Item = (&'a String, &'a String)>,
    ) -> String {
        let parts = [self.tilebind.as_str(), settings, text].into_iter();
        let drawings = drawings.flat_map(|(name, drawing)| [name.as_str(), drawing]);
        let mut hash = Sha256::new();
        for part in parts.chain(drawings) {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        }
        let mut name: String = hash.finalize().iter().map(|b| format!("{b:02x}")).collect();
        name.truncate(NAME);
        name
    }

    /// The design of a point, or why it is impossible.
    pub fn design(&self, point: &SweepPoint) -> Result<Design, String> {
        let source = &self.designs[point.design];
        let text = point.text.as_ref().map_err(Clone::clone)?;
        source.parse(text).map_err(|error| error.sentence())
    }

    /// Rejects a sweep without any possible point.
    fn check_possible(&self) -> Result<(), PlanError> {
        let points = self.points();
        let mut first = None;
        for point in &points {
            match self.design(point) {
                Ok(_) => return Ok(()),
                Err(reason) => {
                    // In the order of the requested keys.
                    let values = self.axes.iter().zip(&point.values);
                    let values = values.map(|(axis, value)| format!("{} = {value}", axis.key));
                    let values: Vec<String> = values.collect();
                    first.get_or_insert_with(|| format!("{}: {reason}", values.join(", ")));
                }
            }
        }
        let reason = first.unwrap_or_default();
        Err(PlanError::NonePossible(points.len(), reason))
    }

    /// Rejects a key that the designs do not have, if none of its values gives a possible design.
    fn check_keys(&self) -> Result<(), PlanError> {
        let documents: Vec<Table> = self.designs.iter().map(DesignSource::document).collect();
        for axis in &self.axes {
            for (source, document) in self.designs.iter().zip(&documents) {
                if document::holds(document, &axis.key) {
                    continue;
                }
                let samples = axis.samples();
                let reasons: Vec<String> = samples
                    .iter()
                    .map_while(|value| source.fault(document, &axis.key, value))
                    .collect();
                if reasons.len() == samples.len() {
                    let mut reason = reasons.into_iter().next().unwrap_or_default();
                    if let Some(meant) = document::paths(document, &axis.key).first() {
                        reason = format!("it needs the full path, such as `{meant}`");
                    }
                    let path = axis.key.clone();
                    return Err(PlanError::Unknown { path, reason });
                }
            }
        }
        Ok(())
    }
}
