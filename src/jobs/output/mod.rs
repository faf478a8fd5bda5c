//! Writes output files safely: no file of the user is lost, and a set of files is either all new or
//! all old.
//!
//! - A file is replaced, or taken away with the results that it belonged to, only if the same command
//!   wrote it and nobody has changed it since. Anything else that is in the way is refused before the
//!   work, and again when the results are written; `force` replaces it all the same.
//! - What the command reads is never replaced, by whatever name it goes: see [`Output::reading`].
//! - All files are first written in full beside their places; then the old ones are taken out and the
//!   new ones put in. Where that fails, all is put back. Where the process is killed in between, the
//!   next one that looks at the folder puts the old files back, or puts the rest of the new ones in if
//!   the first was: old and new ones are never together.
//!
//! Who wrote what is known by a record in each folder, `.tilebind.json`: of every file the command and
//! the SHA-256. Several commands may have their results in one folder, as long as no two of their
//! files have one name. Results of versions without such records are not known.
//!
//! Points of sweeps ([`crate::sweep::Store`]) are outside of this: their names are hashes of what they
//! hold, each tells whether it is sound, and one that is damaged is worked on again.

mod command;
mod folder;
mod record;
mod staging;

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

pub use command::{Command, PICTURES};
pub use folder::check as check_folder;
use record::{Noted, Record};
use staging::Staging;

/// Files by their names relative to the folder they go to.
pub type Files = BTreeMap<String, Vec<u8>>;

/// Why files were not written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// Something is in the way: which file, and what to do.
    #[error("{0}")]
    Refused(String),
    /// The folder cannot be written to.
    #[error("cannot write to the folder {}: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the file system says.
        source: io::Error,
    },
    /// The file system refused; all files are as they were.
    #[error("cannot write {}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the file system says.
        source: io::Error,
    },
}

impl OutputError {
    fn of_file(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        |source| Self::File { path, source }
    }
}

/// What is in the way of a file.
#[derive(Debug, PartialEq, Eq)]
enum Obstacle {
    /// The command reads it.
    Input,
    /// A folder, a pipe, a device.
    Irregular,
    /// It is there, and no record is kept.
    There,
    /// The record does not tell of it.
    Foreign,
    /// It is not as it was written.
    Changed,
    /// Another command wrote it.
    Other(String),
}

impl Obstacle {
    fn gives_way_to_force(&self) -> bool {
        !matches!(self, Self::Input | Self::Irregular)
    }

    fn told(&self) -> String {
        match self {
            Self::Input => "is read by this command and is never replaced".to_owned(),
            Self::Irregular => "is not a regular file".to_owned(),
            Self::There => "already exists".to_owned(),
            Self::Foreign => "is not recorded as written by tilebind".to_owned(),
            Self::Changed => "was changed since tilebind wrote it".to_owned(),
            Self::Other(command) => format!("is a result of `tilebind {command}`"),
        }
    }
}

/// Where a command's files go.
#[derive(Clone, Debug)]
pub struct Output {
    command: &'static Command,
    folder: PathBuf,
    /// The only file, where it is not a folder of results.
    file: Option<PathBuf>,
    inputs: Vec<PathBuf>,
    force: bool,
    recorded: bool,
}

impl Output {
    /// A folder of results; it is made if need be.
    pub fn folder(command: &'static Command, folder: &Path) -> Self {
        Self {
            command,
            folder: folder.to_owned(),
            file: None,
            inputs: Vec::new(),
            force: false,
            recorded: true,
        }
    }

    /// A single file; its folder is made if need be.
    ///
    /// # Errors
    /// If the path names no file.
    pub fn file(command: &'static Command, file: &Path) -> Result<Self, OutputError> {
        let refused = |why| {
            let file = file.display();
            OutputError::Refused(format!("{file} {why}\n  help: give another name"))
        };
        match file.file_name() {
            Some(name) if name == record::NAME => {
                Err(refused("is where tilebind records its files"))
            }
            Some(_) if !file.is_dir() => Ok(Self {
                file: Some(file.to_owned()),
                ..Self::folder(command, file.parent().unwrap_or(file))
            }),
            _ => Err(refused("is a folder")),
        }
    }

    /// With the files that the command reads, which it never replaces.
    pub fn reading(mut self, inputs: impl IntoIterator<Item = PathBuf>) -> Self {
        self.inputs.extend(inputs);
        self
    }

    /// Replacing what is in the way, if `force` says so: files that tilebind did not write, that were
    /// changed since, and those of other commands.
    pub fn forced(self, force: bool) -> Self {
        Self { force, ..self }
    }

    /// Keeping no record: what is written is the user's from then on.
    pub fn unrecorded(self) -> Self {
        Self {
            recorded: false,
            ..self
        }
    }

    /// Refuses what is in the way of any file that the command can write and that `may_come`, and a
    /// folder that cannot be written to, before any work is done. Nothing is written.
    ///
    /// # Errors
    /// See [`OutputError`].
    pub fn check(&self, may_come: impl Fn(&str) -> bool) -> Result<(), OutputError> {
        folder::check(&self.folder)?;
        // While nobody else writes: their files and their record belong together.
        let _alone = staging::settle(&self.folder)?;
        let mut names: Vec<String> = self.file_name().into_iter().collect();
        let folders = self.command.folders().filter(|_| self.file.is_none());
        for inner in folders {
            let folder = match inner {
                "" => self.folder.clone(),
                _ => self.folder.join(inner),
            };
            folder::check(&folder)?;
            let found = fs::read_dir(or_here(&folder)).into_iter().flatten();
            let found = found.flatten().map(|entry| {
                let name = entry.file_name();
                let path = Path::new(inner).join(name);
                path.to_string_lossy().into_owned()
            });
            names.extend(found.filter(|name| self.command.writes(name) && may_come(name)));
        }
        self.refuse(names.iter().map(String::as_str)).map(drop)
    }

    /// Whether a file of this name is one of those that the command reads.
    pub fn reads(&self, name: &str) -> bool {
        self.is_input(&self.path(name))
    }

    /// Writes a folder's files in place of those that the command wrote before.
    ///
    /// # Errors
    /// See [`OutputError`]; all files are then as they were.
    pub fn write(&self, files: &Files) -> Result<(), OutputError> {
        drop(staging::settle(&self.folder)?);
        let staging = Staging::open(&self.folder)?;
        let record = self.refuse(files.keys().map(String::as_str))?;
        let stale = self.stale(&record, files);
        for (name, content) in files {
            staging.add(&self.place(name), content)?;
        }
        let noted = self.recorded.then(|| {
            let new = record.with(self.command.name, files);
            let settled = new.settled(&self.folder, files, &stale);
            Noted::stage(&staging, &self.folder, [&new, &settled])
        });
        let noted = noted.transpose()?;
        // First, so that no file is ever unknown to the record.
        if let Some(noted) = &noted {
            noted.begin()?;
        }
        let (old, new) = self.moves(&stale, files);
        let exchanged = staging.exchange(&old, &new);
        if let Some(noted) = &noted {
            noted.end(exchanged.is_ok());
        }
        // Of a folder that is not empty this takes nothing away.
        for emptied in stale.iter().filter_map(|name| name.rsplit_once('/')) {
            let _ = fs::remove_dir(self.folder.join(emptied.0));
        }
        exchanged
    }

    /// Writes a single file.
    ///
    /// # Errors
    /// See [`OutputError`]; all is then as it was.
    pub fn write_file(&self, content: impl Into<Vec<u8>>) -> Result<(), OutputError> {
        let content = content.into();
        let name = self.file_name().into_iter();
        self.write(&name.map(|name| (name, content.clone())).collect())
    }

    /// The name of the only file, as the record has it.
    fn file_name(&self) -> Option<String> {
        let name = self.file.as_ref()?.file_name()?;
        Some(name.to_string_lossy().into_owned())
    }

    /// A file's path in the folder.
    fn place(&self, name: &str) -> PathBuf {
        let file = self.file.as_ref().and_then(|file| file.file_name());
        PathBuf::from(file.unwrap_or(name.as_ref()))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(self.place(name))
    }

    /// Which files are taken out of their places, and which are put in, in order.
    fn moves(&self, stale: &[String], files: &Files) -> (Vec<PathBuf>, Vec<PathBuf>) {
        // A report is taken out first and put in last: where it is, the others are too.
        let mut new: Vec<&String> = files.keys().collect();
        new.sort_by_key(|name| *name == "report.json");
        let taken = new.iter().rev().filter(|name| is_there(&self.path(name)));
        let old = taken.copied().chain(stale);
        let old = match files.len() {
            // A single file simply takes the place of the old one.
            1 if stale.is_empty() => Vec::new(),
            _ => old.map(|name| self.place(name)).collect(),
        };
        (old, new.iter().map(|name| self.place(name)).collect())
    }

    /// The record of the folder, unless something is in the way of these files.
    fn refuse<'a>(&self, names: impl Iterator<Item = &'a str>) -> Result<Record, OutputError> {
        let path = self.folder.join(record::NAME);
        let read = match self.recorded {
            true => Record::read(&path),
            false => Some(Record::default()),
        };
        let mut in_the_way: Vec<(PathBuf, Obstacle)> = Vec::new();
        if read.is_none() && (!self.force || self.is_input(&path)) {
            in_the_way.push((path, Obstacle::Foreign));
        }
        let record = read.unwrap_or_default();
        in_the_way.extend(names.filter_map(|name| {
            let obstacle = self.obstacle(&record, name)?;
            let gives_way = self.force && obstacle.gives_way_to_force();
            (!gives_way).then(|| (self.path(name), obstacle))
        }));
        // What force does not help against comes first.
        in_the_way.sort_by_key(|(_, obstacle)| obstacle.gives_way_to_force());
        let Some((first, obstacle)) = in_the_way.first() else {
            return Ok(record);
        };
        let more = match in_the_way.len() - 1 {
            0 => String::new(),
            1 => ", and 1 more file is in the way".to_owned(),
            more => format!(", and {more} more files are in the way"),
        };
        let (other, what) = match self.file {
            Some(_) => ("give another name", "it"),
            None => ("name another folder", "what is in the way"),
        };
        let force = match obstacle.gives_way_to_force() {
            true => format!(", or replace {what} with --force"),
            false => String::new(),
        };
        Err(OutputError::Refused(format!(
            "{} {}{more}\n  help: {other}{force}",
            first.display(),
            obstacle.told()
        )))
    }

    fn obstacle(&self, record: &Record, name: &str) -> Option<Obstacle> {
        let path = self.path(name);
        let found = path.symlink_metadata().ok()?;
        if self.is_input(&path) {
            return Some(Obstacle::Input);
        }
        if !found.is_file() && !found.is_symlink() {
            return Some(Obstacle::Irregular);
        }
        // A link was made by somebody else. If it is replaced, what it leads to is not touched.
        let writer = record.writer(name).filter(|_| found.is_file());
        let Some(writer) = writer else {
            return Some(match self.recorded {
                true => Obstacle::Foreign,
                false => Obstacle::There,
            });
        };
        if !record.has(name, &path) {
            return Some(Obstacle::Changed);
        }
        (writer != self.command.name).then(|| Obstacle::Other(writer.to_owned()))
    }

    fn is_input(&self, path: &Path) -> bool {
        let file = identity(path);
        file.is_some() && self.inputs.iter().any(|input| identity(input) == file)
    }

    /// Results that the command wrote before, that are as they were, and that do not come again.
    fn stale(&self, record: &Record, files: &Files) -> Vec<String> {
        if self.file.is_some() {
            return Vec::new();
        }
        let written = record.of(self.command.name);
        let old = written.filter(|name| self.command.writes(name) && !files.contains_key(*name));
        old.filter(|name| self.obstacle(record, name).is_none() && is_there(&self.path(name)))
            .map(str::to_owned)
            .collect()
    }
}

/// Keeps a file that only tilebind has a name for, synced: it is there as a whole or not at all,
/// whatever happens. `name` is relative to the folder; its own folder is made if need be.
///
/// # Errors
/// See [`OutputError`].
pub fn keep(folder: &Path, name: &str, content: &[u8]) -> Result<(), OutputError> {
    let (name, path) = (Path::new(name), folder.join(name));
    let staging = Staging::open(folder)?;
    let staged = staging.add(name, content)?;
    let synced = fs::File::open(staged).and_then(|staged| staged.sync_all());
    synced.map_err(OutputError::of_file(&path))?;
    staging.exchange(&[], &[name.to_owned()])?;
    // The new name, too, is to survive a power cut; not every file system can sync a folder.
    if let Some(Ok(folder)) = path.parent().map(fs::File::open) {
        let _ = folder.sync_all();
    }
    Ok(())
}

/// Whether there is something by this name, be it a link that leads nowhere.
fn is_there(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

/// What tells a file from all others, whichever path leads to it; `None` if there is none.
#[cfg(unix)]
fn identity(path: &Path) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    let found = path.metadata().ok()?;
    Some((found.dev(), found.ino()))
}

/// What tells a file from all others, whichever path leads to it; `None` if there is none.
#[cfg(not(unix))]
fn identity(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok()
}

/// The empty path is the folder that one is in.
fn or_here(path: &Path) -> &Path {
    match path.as_os_str().is_empty() {
        true => Path::new("."),
        false => path,
    }
}
