//! What an earlier analysis left in a folder: nothing else may be replaced or taken away.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path};

use serde::Deserialize;

use super::files::REPORT;
use crate::checksum::sha256;

/// The part of a report that tells who wrote it, and what beside it.
#[derive(Deserialize)]
pub(super) struct Earlier {
    #[serde(rename = "tilebind")]
    _version: String,
    /// Checksums of the files by their names; reports of old have none.
    #[serde(default)]
    files: BTreeMap<String, String>,
}

impl Earlier {
    /// Reads the report in a folder; `None` where there is none of tilebind.
    pub fn read(folder: &Path) -> Option<Self> {
        serde_json::from_slice(&content(&folder.join(REPORT))?).ok()
    }

    /// The listed files that still are as they were written.
    pub fn unchanged<'a>(&'a self, folder: &'a Path) -> impl Iterator<Item = &'a str> {
        let below = |name: &str| {
            let mut parts = Path::new(name).components();
            parts.all(|part| matches!(part, Component::Normal(_)))
        };
        self.files
            .iter()
            .filter(move |(name, _)| below(name))
            .filter(|(name, sum)| content(&folder.join(name)).is_some_and(|it| sha256(it) == **sum))
            .map(|(name, _)| name.as_str())
    }
}

/// The bytes of a regular file.
pub(super) fn content(path: &Path) -> Option<Vec<u8>> {
    path.is_file().then(|| fs::read(path).ok()).flatten()
}
