//! The designs that a sweep varies.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use toml::Table;

use super::vary::{Axis, Value};
use super::{document, drawings};
use crate::checksum::sha256;
use crate::design::{Design, DesignError, file};

/// A design as it was read, which can be varied.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DesignSource {
    /// Its name.
    pub name: String,
    /// Its file name, as given.
    pub file: String,
    /// SHA-256 of the file's bytes.
    pub sha256: String,
    /// The text of the file.
    pub text: String,
    /// The text of each drawing that it refers to, by its name in the design.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub drawings: BTreeMap<String, String>,
}

impl DesignSource {
    /// A design file with its drawings.
    ///
    /// # Errors
    /// If it cannot be read or is not a valid design.
    pub fn read(path: &Path) -> Result<(Self, Design), DesignError> {
        match file::read_text(path) {
            Ok(text) => Self::of_text(&text, &path.display().to_string()),
            // Loading reports what is wrong; if nothing is wrong any more, the file is read again.
            Err(_) => Design::load(path).and_then(|_| Self::read(path)),
        }
    }

    /// A design from its text, with drawings in the folder of `file`.
    ///
    /// # Errors
    /// If it is not a valid design.
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

    /// Stores the readable drawings that the design names, as it is or with varied keys set; those
    /// already stored are unchanged.
    pub(super) fn hold_drawings(&mut self, axes: &[Axis]) {
        let mut found = drawings::held(&self.file, &self.document(), axes);
        found.append(&mut self.drawings);
        self.drawings = found;
    }

    /// The files it was read from: the design and its drawings.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> {
        let names = self.drawings.keys();
        let drawings = names.map(|name| crate::design::drawings::path(&self.file, name));
        [PathBuf::from(&self.file)].into_iter().chain(drawings)
    }

    /// The design itself, with the stored drawings.
    ///
    /// # Errors
    /// If it is not a valid design.
    pub fn design(&self) -> Result<Design, DesignError> {
        self.parse(&self.text)
    }

    /// The same design with the key at a dotted path set to a value; missing tables are created.
    ///
    /// # Errors
    /// If the path leads through something that is neither a table nor a long enough array.
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

    /// A variant of this design, with the stored drawings.
    pub(super) fn parse(&self, text: &str) -> Result<Design, DesignError> {
        Design::parse_with(text, &self.file, &self.drawings)
    }

    /// The design as a document, always with its name.
    pub fn document(&self) -> Table {
        let mut document: Table = self.text.parse().unwrap_or_default();
        document
            .entry("name")
            .or_insert_with(|| self.name.clone().into());
        document
    }

    /// What is wrong with the design if only this key is set.
    pub(super) fn fault(&self, document: &Table, key: &str, value: &Value) -> Option<String> {
        let mut document = document.clone();
        if let Err(reason) = document::set(&mut document, key, value.toml()) {
            return Some(reason);
        }
        let error = self.parse(&document.to_string()).err()?;
        Some(error.sentence())
    }
}
