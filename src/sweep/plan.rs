//! The manifest of a sweep: everything that decides it, and the points that come of it.

use std::collections::{BTreeMap, HashSet};
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::json;
use sha2::{Digest, Sha256};
use toml::Table;

use super::vary::{Axis, Value};
use super::{document, drawings};
use crate::checksum::sha256;
use crate::comparison::AssessmentSettings;
use crate::design::{Design, DesignError, file};

/// Most points of a sweep.
const MOST_POINTS: usize = 1_000_000;
/// Characters of a point's name: 128 bits in hexadecimal.
const NAME: usize = 32;
/// Characters of the name that make the seed: 48 bits, exact in every reader of JSON.
const SEED: usize = 12;

/// A sweep: designs, what is varied of them, and how they are assessed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Version of tilebind.
    pub tilebind: String,
    /// What is varied; no two have one name.
    pub designs: Vec<Source>,
    /// The first one varies slowest.
    pub axes: Vec<Axis>,
    /// How every point is assessed.
    pub settings: AssessmentSettings,
    /// Goes into every point's name, and so into its seed.
    pub seed: u64,
}

/// A design that is varied.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// Its name.
    pub name: String,
    /// Its file as it was named.
    pub file: String,
    /// SHA-256 of the file's bytes.
    pub sha256: String,
    /// The text of the file.
    pub text: String,
    /// The text of each drawing that it refers to, by its name in the design.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub drawings: BTreeMap<String, String>,
}

/// One design of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Place in the sweep, from 0.
    pub index: usize,
    /// Hash of the design, the settings and the version.
    pub name: String,
    /// Of its random numbers, from its name.
    pub seed: u64,
    /// Which of the plan's designs.
    pub design: usize,
    /// A value for each of the plan's axes.
    pub values: Vec<Value>,
    /// The design's text with the values set; where they cannot be set, why.
    text: Result<String, String>,
}

impl Point {
    /// The design's text with the values set, where they can be set.
    pub fn text(&self) -> Option<&str> {
        self.text.as_deref().ok()
    }
}

/// Part `number`, from 1, of `of` parts of a sweep: every `of`th point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which part, from 1.
    pub number: usize,
    /// How many parts there are.
    pub of: usize,
}

impl Shard {
    /// The only part of a sweep that is not divided.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Whether the part holds a point.
    pub fn contains(&self, point: &Point) -> bool {
        point.index % self.of + 1 == self.number
    }
}

/// Why there is no such sweep.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// A point is no design that can be built.
    #[error(transparent)]
    Design(#[from] Box<DesignError>),
    /// A key is varied by two axes.
    #[error("`{0}` is varied twice")]
    Twice(String),
    /// There are more points than can be handled.
    #[error("the sweep has {0} points, more than {MOST_POINTS}")]
    TooMany(u128),
    /// Two designs have one name.
    #[error("two designs are called `{0}`: give them different names")]
    SameName(String),
    /// A key cannot be varied.
    #[error("`{path}` cannot be varied: {reason}")]
    Unknown {
        /// Its path in the design.
        path: String,
        /// Why not.
        reason: String,
    },
    /// No point is a design that can be built.
    #[error("none of the {0} points is possible; the first: {1}")]
    NonePossible(usize, String),
    /// What was read is no manifest.
    #[error("this is no manifest of a sweep: {0}")]
    Malformed(String),
    /// The manifest was written by another version.
    #[error("the manifest is of tilebind {0}, this is {here}: plan the sweep anew", here = env!("CARGO_PKG_VERSION"))]
    Version(String),
}

impl Plan {
    /// A sweep over design files.
    ///
    /// # Errors
    /// Where a design is not sound as it stands, a key cannot be varied or varies twice, or there
    /// are too many points or none is possible. A key that the design does not hold is taken for a mistake if no value
    /// of it gives a possible design.
    pub fn new(
        files: &[impl AsRef<Path>],
        axes: Vec<Axis>,
        settings: AssessmentSettings,
        seed: u64,
    ) -> Result<Self, PlanError> {
        let mut designs: Vec<Source> = Vec::new();
        for file in files {
            designs.push(Source::read(file.as_ref()).map_err(Box::new)?.0);
        }
        Self::of(designs, axes, settings, seed)
    }

    /// A sweep over designs that have been read.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of(
        mut designs: Vec<Source>,
        axes: Vec<Axis>,
        settings: AssessmentSettings,
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
        };
        plan.check()?;
        plan.check_keys()?;
        plan.check_possible()?;
        Ok(plan)
    }

    /// Refuses what leaves nothing to do, too much, or something twice.
    fn check(&self) -> Result<(), PlanError> {
        let malformed = |message: String| Err(PlanError::Malformed(message));
        if self.designs.is_empty() {
            return malformed("it holds no design".to_owned());
        }
        if let Some(axis) = self.axes.iter().find(|axis| axis.values.is_empty()) {
            return malformed(format!("`{}` has no values", axis.key));
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
        let lengths = self.axes.iter().map(|axis| axis.values.len() as u128);
        let count = lengths.fold(self.designs.len() as u128, u128::saturating_mul);
        match count <= MOST_POINTS as u128 {
            true => Ok(()),
            false => Err(PlanError::TooMany(count)),
        }
    }

    /// The manifest's text. It lists the points too, for people and schedulers.
    pub fn to_text(&self) -> String {
        let points: Vec<_> = self
            .points()
            .into_iter()
            .map(|point| {
                json!({
                    "index": point.index, "point": point.name, "seed": point.seed,
                    "design": self.designs[point.design].name, "values": point.values,
                })
            })
            .collect();
        let mut all = json!(self);
        if let Some(object) = all.as_object_mut() {
            object.insert("points".to_owned(), points.into());
        }
        // Plain values with string keys are always written.
        serde_json::to_string_pretty(&all).unwrap_or_default() + "\n"
    }

    /// Reads a manifest.
    ///
    /// # Errors
    /// Where it is none, one of another version, or one without points or of too many.
    pub fn parse(text: &str) -> Result<Self, PlanError> {
        let plan: Self =
            serde_json::from_str(text).map_err(|error| PlanError::Malformed(error.to_string()))?;
        if plan.tilebind != env!("CARGO_PKG_VERSION") {
            return Err(PlanError::Version(plan.tilebind));
        }
        plan.check()?;
        Ok(plan)
    }

    /// All points, in order.
    pub fn points(&self) -> Vec<Point> {
        let grid: usize = self.axes.iter().map(|axis| axis.values.len()).product();
        let documents: Vec<Table> = self.designs.iter().map(Source::document).collect();
        (0..self.designs.len() * grid)
            .map(|index| self.point(&documents, index, grid))
            .collect()
    }

    fn point(&self, documents: &[Table], index: usize, grid: usize) -> Point {
        let (design, mut place) = (index / grid, index % grid);
        let mut values: Vec<Value> = Vec::with_capacity(self.axes.len());
        for axis in self.axes.iter().rev() {
            values.push(axis.values[place % axis.values.len()].clone());
            place /= axis.values.len();
        }
        values.reverse();
        let mut document = documents[design].clone();
        let mut set = self.axes.iter().zip(&values);
        let text = set
            .try_for_each(|(axis, value)| document::set(&mut document, &axis.key, value.toml()))
            .map(|()| document.to_string());
        let held = &self.designs[design].drawings;
        let drawings = drawings::named(&document).into_iter();
        let drawings = drawings.filter_map(|name| held.get_key_value(name));
        let name = self.name(text.as_ref().unwrap_or_else(|reason| reason), drawings);
        Point {
            index,
            seed: u64::from_str_radix(&name[..SEED], 16).unwrap_or(0),
            name,
            design,
            values,
            text,
        }
    }

    fn name<'a>(
        &self,
        text: &str,
        drawings: impl Iterator<Item = (&'a String, &'a String)>,
    ) -> String {
        let settings = json!({"settings": self.settings, "seed": self.seed}).to_string();
        let parts = [self.tilebind.as_str(), &settings, text].into_iter();
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

    /// The design of a point; where it is impossible, why.
    pub fn design(&self, point: &Point) -> Result<Design, String> {
        let source = &self.designs[point.design];
        let text = point.text.as_ref().map_err(Clone::clone)?;
        source
            .parse(text)
            .map_err(|error| format!("{}; {}", error.message, error.help))
    }

    /// Refuses a sweep of which no point is possible.
    fn check_possible(&self) -> Result<(), PlanError> {
        let points = self.points();
        let mut first = None;
        for point in &points {
            match self.design(point) {
                Ok(_) => return Ok(()),
                Err(reason) => {
                    first.get_or_insert(reason);
                }
            }
        }
        let reason = first.unwrap_or_default();
        Err(PlanError::NonePossible(points.len(), reason))
    }

    /// Refuses a key that the designs do not hold, if no value of it gives a possible design.
    fn check_keys(&self) -> Result<(), PlanError> {
        let documents: Vec<Table> = self.designs.iter().map(Source::document).collect();
        for axis in &self.axes {
            for (source, document) in self.designs.iter().zip(&documents) {
                if document::holds(document, &axis.key) {
                    continue;
                }
                let reasons: Vec<String> = axis
                    .values
                    .iter()
                    .map_while(|value| source.fault(document, &axis.key, value))
                    .collect();
                if reasons.len() == axis.values.len() {
                    return Err(PlanError::Unknown {
                        path: axis.key.clone(),
                        reason: reasons.into_iter().next().unwrap_or_default(),
                    });
                }
            }
        }
        Ok(())
    }
}

impl Source {
    /// A design file with its drawings.
    ///
    /// # Errors
    /// Where it cannot be read or is no sound design.
    pub fn read(path: &Path) -> Result<(Self, Design), DesignError> {
        let design = Design::load(path)?;
        // What has just been read is there.
        let text = file::read_text(path).unwrap_or_default();
        Ok((Self::new(text, path.display().to_string(), &design), design))
    }

    /// The text of a design, whose drawings lie beside `file`.
    ///
    /// # Errors
    /// Where it is no sound design.
    pub fn of_text(text: &str, file: &str) -> Result<(Self, Design), DesignError> {
        let design = Design::parse(text, file)?;
        Ok((Self::new(text.to_owned(), file.to_owned(), &design), design))
    }

    fn new(text: String, file: String, design: &Design) -> Self {
        let mut source = Self {
            name: design.name.clone(),
            file,
            sha256: design.sha256.clone(),
            text,
            drawings: BTreeMap::new(),
        };
        source.hold_drawings(&[]);
        source
    }

    /// Keeps the drawings that the design names, as it stands or with varied keys set, and that can
    /// be read; those that are held already stay as they are.
    fn hold_drawings(&mut self, axes: &[Axis]) {
        let mut found = drawings::held(&self.file, &self.document(), axes);
        found.append(&mut self.drawings);
        self.drawings = found;
    }

    /// The design itself, with the drawings that are held.
    ///
    /// # Errors
    /// Where it is no sound design.
    pub fn design(&self) -> Result<Design, DesignError> {
        self.parse(&self.text)
    }

    /// The same design with the key at a dotted path set to a value; tables on the way that are
    /// missing are made.
    ///
    /// # Errors
    /// Where the path leads through something that is neither a table nor an array long enough.
    pub fn with(&self, path: &str, value: toml::Value) -> Result<Self, String> {
        let mut document = self.document();
        document::set(&mut document, path, value)?;
        let text = document.to_string();
        let mut with = Self {
            sha256: sha256(&text),
            text,
            ..self.clone()
        };
        with.hold_drawings(&[]);
        Ok(with)
    }

    /// A design made of this one, with the drawings that are held.
    fn parse(&self, text: &str) -> Result<Design, DesignError> {
        Design::parse_with(text, &self.file, &self.drawings)
    }

    /// The design as a document, always with its name.
    fn document(&self) -> Table {
        let mut document: Table = self.text.parse().unwrap_or_default();
        document
            .entry("name")
            .or_insert_with(|| self.name.clone().into());
        document
    }

    /// What is wrong with the design where only this key is set.
    fn fault(&self, document: &Table, key: &str, value: &Value) -> Option<String> {
        let mut document = document.clone();
        if let Err(reason) = document::set(&mut document, key, value.toml()) {
            return Some(reason);
        }
        let error = self.parse(&document.to_string()).err()?;
        Some(format!("{}; {}", error.message, error.help))
    }
}
