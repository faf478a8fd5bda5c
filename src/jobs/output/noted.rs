//! The record of a folder while its files are exchanged.

use std::fs;
use std::path::{Path, PathBuf};

use super::OutputError;
use super::record::{NAME, Record};
use super::staging::{RECORDS, Staging};

/// A record during the transition from one state of a folder to the next.
pub(super) struct Noted {
    path: PathBuf,
    /// The previous record, if there was one.
    before: Option<PathBuf>,
    /// The records during and after the exchange of files.
    next: [PathBuf; 2],
}

impl Noted {
    /// Writes the folder's records during and after the exchange, beside their place.
    pub fn stage(
        staging: &Staging,
        folder: &Path,
        records: [&Record; 2],
    ) -> Result<Self, OutputError> {
        let path = folder.join(NAME);
        let [before, during, after] = RECORDS;
        let staged = |name, text: &[u8]| staging.add_apart(name, text, &path);
        let old = fs::read(&path).ok().map(|text| staged(before, &text));
        let [now, then] = records.map(Record::text);
        Ok(Self {
            before: old.transpose()?,
            next: [
                staged(during, now.as_bytes())?,
                staged(after, then.as_bytes())?,
            ],
            path,
        })
    }

    /// From now on the record lists new and old files.
    pub fn begin(&self) -> Result<(), OutputError> {
        fs::rename(&self.next[0], &self.path).map_err(OutputError::of_file(&self.path))
    }

    /// Ends the exchange, successful or not. If this fails, the record lists files that do not
    /// exist, which does no harm.
    pub fn end(&self, exchanged: bool) {
        let _ = match (exchanged, &self.before) {
            (true, _) => fs::rename(&self.next[1], &self.path),
            (false, Some(before)) => fs::rename(before, &self.path),
            (false, None) => fs::remove_file(&self.path),
        };
    }
}
