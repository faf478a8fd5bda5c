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
        let same = |(name, sum): &(&String, &String)| is_unchanged(folder, name, sum);
        self.files
            .iter()
            .filter(same)
            .map(|(name, _)| name.as_str())
    }
}

/// Whether a file of this name, not one that leads out of the folder, has this checksum.
fn is_unchanged(folder: &Path, name: &str, sum: &str) -> bool {
    let mut parts = Path::new(name).components();
    parts.all(|part| matches!(part, Component::Normal(_)))
        && content(&folder.join(name)).is_some_and(|it| sha256(it) == sum)
}

/// What commands without a report wrote into a folder and nobody changed since: by name, checksums.
pub(super) struct Listed(BTreeMap<String, String>);

impl Listed {
    /// The file of lines as `sha256sum` writes them.
    pub const NAME: &str = ".tilebind.sha256";

    /// Reads the list in a folder; empty where there is none.
    pub fn read(folder: &Path) -> Self {
        let text = content(&folder.join(Self::NAME)).unwrap_or_default();
        let text = String::from_utf8_lossy(&text);
        let entries = text.lines().filter_map(|line| line.split_once("  "));
        let same = entries.filter(|(sum, name)| is_unchanged(folder, name, sum));
        Self(same.map(|(sum, name)| (name.into(), sum.into())).collect())
    }

    pub fn has(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// These files as well.
    pub fn with<'a>(mut self, files: impl Iterator<Item = (&'a str, &'a Vec<u8>)>) -> Self {
        let sums = files.map(|(name, content)| (name.to_owned(), sha256(content)));
        self.0.extend(sums);
        self
    }

    pub fn text(&self) -> String {
        let line = |(name, sum): (&String, &String)| format!("{sum}  {name}\n");
        self.0.iter().map(line).collect()
    }
}

/// The bytes of a regular file.
pub(super) fn content(path: &Path) -> Option<Vec<u8>> {
    path.is_file().then(|| fs::read(path).ok()).flatten()
}
