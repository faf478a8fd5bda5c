//! The drawings that a design refers to: where they are read from, and their contents.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{Error, ErrorKind};
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::error::DesignError;
use super::file;
use crate::checksum::sha256;

/// A drawing that a design refers to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Drawing {
    /// Its file, as the design names it.
    pub file: String,
    /// SHA-256 of the file's bytes, in hexadecimal.
    pub sha256: String,
}

/// The drawings of one design.
#[derive(Debug, Default)]
pub(super) struct Drawings<'a> {
    /// Contents of the files by name, if files are not to be read.
    held: Option<&'a BTreeMap<String, String>>,
    used: RefCell<BTreeMap<String, Drawing>>,
    skipped: RefCell<Vec<DesignError>>,
}

/// The text of a drawing that the design at `design` calls `name`.
pub(crate) fn read_text(design: &str, name: &str) -> std::io::Result<String> {
    file::read_text(&path(design, name))
}

/// Whether messages may quote lines of a drawing: only if it is in its design's folder. A design
/// from elsewhere must not reveal the contents of other files.
pub(super) fn may_be_quoted(design: &str, name: &str) -> bool {
    let folder = Path::new(design).parent();
    folder.is_some_and(|folder| file::is_below(&path(design, name), folder))
}

pub(crate) fn path(design: &str, name: &str) -> std::path::PathBuf {
    Path::new(design).with_file_name(name)
}

impl<'a> Drawings<'a> {
    /// Drawings with given contents, or else those beside the design.
    pub fn new(held: Option<&'a BTreeMap<String, String>>) -> Self {
        Self {
            held,
            ..Self::default()
        }
    }

    /// The text of the drawing that the design at `design` calls `name`; marks it as used.
    ///
    /// # Errors
    /// If its contents are not given and it cannot be read.
    pub fn text(&self, design: &str, name: &str) -> std::io::Result<String> {
        let text = match self.held {
            Some(held) => held.get(name).cloned().ok_or_else(|| {
                Error::new(
                    ErrorKind::NotFound,
                    "it did not exist when the design was read",
                )
            }),
            None => read_text(design, name),
        }?;
        let drawing = Drawing {
            file: name.to_owned(),
            sha256: sha256(&text),
        };
        self.used.borrow_mut().insert(name.to_owned(), drawing);
        Ok(text)
    }

    /// Notes a warning about a drawing, once.
    pub fn note(&self, doubt: DesignError) {
        let mut doubts = self.skipped.borrow_mut();
        if !doubts.contains(&doubt) {
            doubts.push(doubt);
        }
    }

    /// The drawings used, by name, and warnings about parts of them that were ignored.
    pub fn finish(self) -> (Vec<Drawing>, Vec<DesignError>) {
        let used = self.used.into_inner().into_values().collect();
        (used, self.skipped.into_inner())
    }
}
