//! The record of the files that tilebind wrote into a folder.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{MAIN_SEPARATOR, Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Files, Obstacle, is_there};
use crate::checksum::{sha256, sha256_of_file};

/// The record's file.
pub(super) const NAME: &str = ".tilebind.json";

/// The files that tilebind wrote into a folder, by their names relative to it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Record {
    /// The version that wrote the record.
    tilebind: String,
    files: BTreeMap<String, Entry>,
    /// Checksums of files of others, while `--force` replaces them: they are restored if that is
    /// interrupted.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    aside: BTreeMap<String, String>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Entry {
    /// The command that wrote the file.
    command: String,
    /// The checksum of its content; of the new and the old content while it is being replaced.
    sha256: Vec<String>,
}

impl Default for Record {
    fn default() -> Self {
        Self {
            tilebind: env!("CARGO_PKG_VERSION").to_owned(),
            files: BTreeMap::new(),
            aside: BTreeMap::new(),
        }
    }
}

/// The checksum of a file's content, or of what a link says; `None` for anything else. Links are not
/// followed.
fn fingerprint(path: &Path) -> Option<String> {
    match path.symlink_metadata().ok()? {
        found if found.is_file() => sha256_of_file(path).ok(),
        found if found.is_symlink() => {
            let target = fs::read_link(path).ok()?;
            Some(sha256(format!("link to {}", target.display())))
        }
        _ => None,
    }
}

impl Record {
    /// Reads a record; it is empty if there is none.
    ///
    /// # Errors
    /// If the file is something else.
    pub fn read(path: &Path) -> Result<Self, Obstacle> {
        match path.symlink_metadata() {
            Ok(found) if found.is_file() => {
                let text = fs::read(path).map_err(|_| Obstacle::Foreign)?;
                serde_json::from_slice(&text).map_err(|_| Obstacle::Foreign)
            }
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(Self::default()),
            _ => Err(Obstacle::Irregular),
        }
    }

    /// The record as it is written.
    pub fn text(&self) -> String {
        // Plain values with string keys can always be serialised.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// The command that wrote a file.
    pub fn writer(&self, name: &str) -> Option<&str> {
        Some(&self.files.get(name)?.command)
    }

    /// Whether the file at `path` is as it was written under this name.
    pub fn has(&self, name: &str, path: &Path) -> bool {
        let known = self.files.get(name).zip(fingerprint(path));
        known.is_some_and(|(entry, sum)| entry.sha256.contains(&sum))
    }

    /// Whether the file at `path`, on its way from or to this name in the folder, was moved there by
    /// this program.
    pub fn moved(&self, name: &Path, path: &Path) -> bool {
        let name = name.to_string_lossy().replace(MAIN_SEPARATOR, "/");
        let aside = self.aside.get(&name);
        self.has(&name, path) || aside.is_some() && aside == fingerprint(path).as_ref()
    }

    /// The names of a command's files.
    pub fn of(&self, command: &str) -> impl Iterator<Item = &str> {
        let own = self
            .files
            .iter()
            .filter(move |(_, entry)| entry.command == command);
        own.map(|(name, _)| name.as_str())
    }

    /// The record while a command's files replace those in the folder, which are found at `path`: it
    /// lists both.
    pub fn with(&self, command: &str, files: &Files, path: impl Fn(&str) -> PathBuf) -> Self {
        let mut new = Self {
            files: self.files.clone(),
            ..Self::default()
        };
        for (name, content) in files {
            let mut sums = vec![sha256(content)];
            let old = self.files.get(name).filter(|old| old.command == command);
            sums.extend(old.into_iter().flat_map(|old| old.sha256.clone()));
            let found = fingerprint(&path(name)).filter(|sum| !sums.contains(sum));
            new.aside.extend(found.map(|sum| (name.clone(), sum)));
            let entry = Entry {
                command: command.to_owned(),
                sha256: sums,
            };
            new.files.insert(name.clone(), entry);
        }
        new
    }

    /// The record afterwards: without replaced, stale and missing files.
    pub fn settled(&self, folder: &Path, files: &Files, stale: &[String]) -> Self {
        let mut settled = self.clone();
        settled.aside.clear();
        settled.files.retain(|name, entry| {
            let is_new = files.contains_key(name);
            if is_new {
                entry.sha256.truncate(1);
            }
            is_new || !stale.contains(name) && is_there(&folder.join(name))
        });
        settled
    }
}
