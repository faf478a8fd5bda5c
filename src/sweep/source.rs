//! The designs that a sweep varies.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use toml::Table;

use super::error::PlanError;
use super::vary::{Axis, Value};
use super::{document, drawings};
use crate::design::{Design, DesignError, file};

/// A design that is varied.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// Its name.
    pub name: String,
    /// Its file as it was named.
    pub file: String,
    /// SHA-256 of the file's bytes.
    pub sha256: String,
    /// The content of the file.
    pub text: String,
    /// The text of each drawing that it refers to, by its name in the design.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub drawings: BTreeMap<String, String>,
}

impl Source {
    pub(super) fn read(path: &Path, axes: &[Axis]) -> Result<Self, PlanError> {
        let design = Design::load(path).map_err(Box::new)?;
        let text = file::read_text(path)
            .map_err(|error| PlanError::Malformed(format!("{}: {error}", path.display())))?;
        let mut source = Self {
            name: design.name,
            file: path.display().to_string(),
            sha256: design.sha256,
            text,
            drawings: BTreeMap::new(),
        };
        source.drawings = drawings::held(&source.file, &source.document(), axes);
        Ok(source)
    }

    /// A design made of this one, with the drawings that are held.
    pub(super) fn parse(&self, text: &str) -> Result<Design, DesignError> {
        Design::parse_with(text, &self.file, &self.drawings)
    }

    /// The design as a document, always with its name.
    pub(super) fn document(&self) -> Table {
        let mut document: Table = self.text.parse().unwrap_or_default();
        document
            .entry("name")
            .or_insert_with(|| self.name.clone().into());
        document
    }

    /// What is wrong with the design where only this key is set.
    pub(super) fn fault(&self, document: &Table, key: &str, value: &Value) -> Option<String> {
        let mut document = document.clone();
        if let Err(reason) = document::set(&mut document, key, value) {
            return Some(reason);
        }
        let error = self.parse(&document.to_string()).err()?;
        Some(format!("{}; {}", error.message, error.help))
    }
}
