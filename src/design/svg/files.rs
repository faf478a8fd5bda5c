//! The drawings that a design refers to: where they are read from, and what was found.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

use sha2::{Digest, Sha256};

use super::super::error::{DesignError, Source};
use super::super::reader::{Entry, Result};
use super::super::{Drawing, hexadecimal};
use super::document::Skipped;

/// Largest drawing (bytes).
const LARGEST: u64 = 16 << 20;

/// The drawings of one design.
#[derive(Debug, Default)]
pub(in crate::design) struct Drawings<'a> {
    /// Contents of the files by their names, where files are not to be read.
    held: Option<&'a BTreeMap<String, String>>,
    used: RefCell<BTreeMap<String, Drawing>>,
    skipped: RefCell<Vec<DesignError>>,
}

/// The text of a drawing that the design at `design` calls `name`.
pub(in crate::design) fn read_text(design: &str, name: &str) -> std::io::Result<String> {
    let path = path(design, name);
    if std::fs::metadata(&path)?.len() > LARGEST {
        let message = format!("it is larger than {} MB", LARGEST >> 20);
        return Err(std::io::Error::other(message));
    }
    std::fs::read_to_string(path)
}

fn path(design: &str, name: &str) -> std::path::PathBuf {
    Path::new(design).with_file_name(name)
}

impl<'a> Drawings<'a> {
    /// Drawings that are held, or else those beside the design.
    pub fn new(held: Option<&'a BTreeMap<String, String>>) -> Self {
        Self {
            held,
            ..Self::default()
        }
    }

    /// Gives the drawing that `entry` names to `use_it`.
    pub fn with<T>(&self, entry: &Entry, use_it: impl FnOnce(&Source) -> Result<T>) -> Result<T> {
        let name = entry.string()?;
        let design = entry.source().file;
        let text = match self.held {
            Some(held) => held.get(name).cloned().ok_or_else(|| {
                let message = format!("the drawing \"{name}\" could not be read");
                entry.error(message, BESIDE)
            })?,
            None => read_text(design, name).map_err(|error| {
                let message = format!("cannot read the drawing \"{name}\": {error}");
                entry.error(message, BESIDE)
            })?,
        };
        self.used.borrow_mut().insert(
            name.to_owned(),
            Drawing {
                file: name.to_owned(),
                sha256: hexadecimal(&Sha256::digest(text.as_bytes())),
            },
        );
        use_it(&Source {
            file: &path(design, name).display().to_string(),
            text: &text,
            drawings: self,
        })
    }

    /// Notes what of a drawing is not read.
    pub fn note_skipped(&self, source: &Source, skipped: &[Skipped]) {
        let Some(&(first, _)) = skipped.first() else {
            return;
        };
        let line = |at: usize| source.text[..at].matches('\n').count() + 1;
        let all: Vec<String> = skipped
            .iter()
            .map(|(span, what)| format!("{what} in line {}", line(span.start)))
            .collect();
        let doubt = source.error(
            first,
            format!("not read of the drawing: {}", all.join(", ")),
            "what belongs to the shape is to be converted to a path; delete the rest",
        );
        let mut doubts = self.skipped.borrow_mut();
        if !doubts.contains(&doubt) {
            doubts.push(doubt);
        }
    }

    /// The drawings that were used, by name, and what of them was not read.
    pub fn finish(self) -> (Vec<Drawing>, Vec<DesignError>) {
        let used = self.used.into_inner().into_values().collect();
        (used, self.skipped.into_inner())
    }
}

const BESIDE: &str = "paths of drawings start from the design file's folder";
