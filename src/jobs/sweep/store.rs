//! The files of a sweep's points.

use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::plan::Plan;
use super::point::SweepPoint;
use crate::checksum::sha256;
use crate::comparison::Assessment;
use crate::output::{self, OutputError};
use crate::text;

/// Folder of the points' files within that of the sweep.
const POINTS: &str = "points";

/// The outcome of a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "status", rename_all = "lowercase")]
pub enum Outcome {
    /// It was assessed.
    Done {
        /// The result.
        result: Box<Assessment>,
    },
    /// The design is impossible.
    Impossible {
        /// The reason, as a message to the designer.
        reason: String,
    },
    /// The analysis failed, by a fault of tilebind.
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
    /// The checksum of the outcome as compact JSON, to detect damaged files.
    sha256: String,
    #[serde(flatten)]
    outcome: Outcome,
}

impl Record {
    fn new(point: &SweepPoint, outcome: Outcome) -> io::Result<Self> {
        Ok(Self {
            tilebind: env!("CARGO_PKG_VERSION").to_owned(),
            point: point.name.clone(),
            sha256: sha256(serde_json::to_vec(&outcome)?),
            outcome,
        })
    }

    /// The outcome, if the record is valid for this version and point.
    fn outcome_of(self, point: &SweepPoint) -> Option<Outcome> {
        let sound = Self::new(point, self.outcome).ok()?;
        let found = (self.tilebind, self.point, self.sha256);
        (found == (sound.tilebind, sound.point, sound.sha256)).then_some(sound.outcome)
    }
}

/// The numbers of points by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Progress {
    /// All points.
    pub points: usize,
    /// Assessed points.
    pub done: usize,
    /// Points with impossible designs.
    pub impossible: usize,
    /// Points whose analysis failed.
    pub failed: usize,
    /// Points not computed yet.
    pub missing: usize,
}

impl Progress {
    /// Counts the outcomes of points, `None` for those not computed yet.
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

    /// Counts the outcomes of all points of a plan.
    pub fn of(plan: &Plan, store: &Store) -> Self {
        let of_points = plan.each(|point| Self::new([store.load(&point).as_ref()]));
        of_points
            .into_iter()
            .fold(Self::default(), |all, one| Self {
                points: all.points + one.points,
                done: all.done + one.done,
                impossible: all.impossible + one.impossible,
                failed: all.failed + one.failed,
                missing: all.missing + one.missing,
            })
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

    fn path(&self, point: &SweepPoint) -> PathBuf {
        self.folder.join(name(point))
    }

    /// The outcome of a point; `None` if there is none, or if its file is damaged or of another
    /// version.
    pub fn load(&self, point: &SweepPoint) -> Option<Outcome> {
        let text = text::read(&self.path(point)).ok()?;
        let record: Record = serde_json::from_str(&text).ok()?;
        record.outcome_of(point)
    }

    /// Stores the outcome of a point: its file is complete or absent, whatever happens.
    ///
    /// # Errors
    /// If the file system reports an error.
    pub fn save(&self, point: &SweepPoint, outcome: &Outcome) -> Result<(), OutputError> {
        let record = Record::new(point, outcome.clone());
        let record = record.and_then(|record| Ok(serde_json::to_vec_pretty(&record)?));
        let content = record.map_err(|source| OutputError::File {
            path: self.path(point),
            source,
        })?;
        output::keep(&self.folder, &name(point), &content)
    }

    /// Checks that points can be stored in the folder. Nothing is written.
    ///
    /// # Errors
    /// If the file system reports an error.
    pub fn check(&self) -> Result<(), OutputError> {
        output::check_inner(&self.folder, Path::new(POINTS))
    }
}

/// The file of a point, relative to the sweep's folder. The name is a hash of the design and its
/// settings, so that no other file has it.
fn name(point: &SweepPoint) -> String {
    format!("{POINTS}/{}.json", point.name)
}
