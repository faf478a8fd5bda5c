//! The files of a sweep's points.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::point::Point;
use crate::checksum::sha256;
use crate::comparison::Assessment;

/// Folder of the points' files within that of the sweep.
const POINTS: &str = "points";
/// End of the name of a file that is being written.
const PARTIAL: &str = ".partial";

/// What came of a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "status", rename_all = "lowercase")]
pub enum Outcome {
    /// It was assessed.
    Done {
        /// What was found.
        result: Box<Assessment>,
    },
    /// There is no such design.
    Impossible {
        /// Why, as told to whoever wrote the design.
        reason: String,
    },
    /// The analysis broke down: a fault of tilebind.
    Failed {
        /// What went wrong.
        reason: String,
    },
}

/// The content of a point's file.
#[derive(Serialize, Deserialize)]
struct Record {
    tilebind: String,
    point: String,
    /// Of the outcome as compact JSON: a damaged file is not believed.
    sha256: String,
    #[serde(flatten)]
    outcome: Outcome,
}

impl Record {
    fn new(point: &Point, outcome: Outcome) -> io::Result<Self> {
        Ok(Self {
            tilebind: env!("CARGO_PKG_VERSION").to_owned(),
            point: point.name.clone(),
            sha256: sha256(serde_json::to_vec(&outcome)?),
            outcome,
        })
    }

    /// The outcome, if the record is what this version writes of a point.
    fn outcome_of(self, point: &Point) -> Option<Outcome> {
        let sound = Self::new(point, self.outcome).ok()?;
        let found = (self.tilebind, self.point, self.sha256);
        (found == (sound.tilebind, sound.point, sound.sha256)).then_some(sound.outcome)
    }
}

/// How many points there are of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Progress {
    /// All points.
    pub points: usize,
    /// Those that were assessed.
    pub done: usize,
    /// Those of which there is no design.
    pub impossible: usize,
    /// Those whose analysis broke down.
    pub failed: usize,
    /// Those that nothing is known of yet.
    pub missing: usize,
}

impl Progress {
    /// Counts what came of points, `None` where nothing is known.
    pub fn new<'a>(outcomes: impl IntoIterator<Item = Option<&'a Outcome>>) -> Self {
        let mut progress = Self::default();
        for outcome in outcomes {
            progress.points += 1;
            *match outcome {
                Some(Outcome::Done { .. }) => &mut progress.done,
                Some(Outcome::Impossible { .. }) => &mut progress.impossible,
                Some(Outcome::Failed { .. }) => &mut progress.failed,
                None => &mut progress.missing,
            } += 1;
        }
        progress
    }
}

/// The folder of a sweep, with a file for each of its points.
#[derive(Clone, Debug)]
pub struct Store {
    folder: PathBuf,
}

impl Store {
    /// The store of the sweep whose results are in `folder`.
    pub fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
        }
    }

    fn points(&self) -> PathBuf {
        self.folder.join(POINTS)
    }

    fn path(&self, point: &Point) -> PathBuf {
        self.points().join(format!("{}.json", point.name))
    }

    /// What came of a point; `None` where nothing is known, as of a file that is damaged or of
    /// another version.
    pub fn load(&self, point: &Point) -> Option<Outcome> {
        let text = fs::read_to_string(self.path(point)).ok()?;
        let record: Record = serde_json::from_str(&text).ok()?;
        record.outcome_of(point)
    }

    /// Keeps what came of a point: written, synced, renamed, so that the file is there as a whole
    /// or not at all, whatever happens.
    ///
    /// # Errors
    /// Where the file system refuses.
    pub fn save(&self, point: &Point, outcome: &Outcome) -> io::Result<()> {
        let folder = self.points();
        fs::create_dir_all(&folder)?;
        let record = serde_json::to_vec_pretty(&Record::new(point, outcome.clone())?)?;
        let name = format!(".{}.{}{PARTIAL}", point.name, std::process::id());
        let temporary = folder.join(name);
        let written = write_synced(&temporary, &record)
            .and_then(|()| fs::rename(&temporary, self.path(point)));
        if let Err(error) = written {
            let _ = fs::remove_file(&temporary);
            // Of a folder that is not empty this takes nothing away.
            let _ = fs::remove_dir(&folder);
            return Err(error);
        }
        // The new name, too, is to survive a power cut; not every file system can sync a folder.
        if let Ok(folder) = File::open(&folder) {
            let _ = folder.sync_all();
        }
        Ok(())
    }

    /// Takes away files that a killed process left half written. For when nobody writes any more.
    pub fn tidy(&self) {
        let folders = ["", POINTS, "pictures"].map(|name| self.folder.join(name));
        let entries = folders.iter().flat_map(fs::read_dir).flatten().flatten();
        for entry in entries {
            let name = entry.file_name().to_string_lossy().into_owned();
            if is_partial(&name) {
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

fn write_synced(path: &Path, content: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(content)?;
    file.sync_all()
}

/// Whether a name is one that tilebind writes under: `.NAME.PROCESS.partial`.
fn is_partial(name: &str) -> bool {
    let inner = name.strip_prefix('.').and_then(|n| n.strip_suffix(PARTIAL));
    inner
        .and_then(|inner| inner.rsplit_once('.'))
        .is_some_and(|(name, process)| !name.is_empty() && process.parse::<u32>().is_ok())
}
