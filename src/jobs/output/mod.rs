//! Writes output files safely: no file of the user is lost, and a set of files is either all new or
//! all old.
//!
//! - A file is replaced or removed only if the same command wrote it and it is unchanged since. Any
//!   other file in the way is an error before the work, and again when the results are written;
//!   `force` replaces it.
//! - Input files are never replaced, by whatever name they are given: see [`Output::reading`].
//! - All files are first written completely beside their places; then the old ones are moved out
//!   and the new ones in. If that fails, everything is restored. If the process is killed in
//!   between, the next process that uses the folder restores the old files, or moves in the rest of
//!   the new ones if the first was already in place: old and new ones are never mixed. It moves and
//!   removes only what the record lists with its checksum, or what bears this program's mark.
//! - Links below the folder are never followed, and folders of other file systems never written to:
//!   both are errors before the work, with `force`, too.
//!
//! Each folder has a record, `.tilebind.json`, with the command and the SHA-256 of every file.
//! Several commands can share a results folder as long as their files have different names. Results
//! of versions without such records are not recognised.
//!
//! Points of sweeps ([`crate::sweep::Store`]) are exempt: their names are hashes of their inputs,
//! each file can be verified, and a damaged one is computed again.

mod command;
mod folder;
mod noted;
mod record;
mod staging;

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

pub use command::{Command, PICTURES};
use noted::Noted;
use record::Record;
use staging::Staging;

/// Files by their names relative to the folder they go to.
pub type Files = BTreeMap<String, Vec<u8>>;

/// Why files were not written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// A file is in the way: which one, and what to do.
    #[error("{0}")]
    Refused(String),
    /// The folder cannot be written to.
    #[error("cannot write to the folder {}: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The error of the file system.
        source: io::Error,
    },
    /// The file system failed; all files are unchanged.
    #[error("cannot write {}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The error of the file system.
        source: io::Error,
    },
}

impl OutputError {
    fn of_file(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        |source| Self::File { path, source }
    }
}

/// An obstacle to writing a file.
#[derive(Debug, PartialEq, Eq)]
enum Obstacle {
    /// It is an input of the command.
    Input,
    /// It is a folder, a pipe or a device.
    Irregular,
    /// It is a link, where a folder of results is needed.
    Linked,
    /// It is a folder of another file system.
    Elsewhere,
    /// It exists, and no record is kept.
    There,
    /// It is not in the record.
    Foreign,
    /// It has changed since it was written.
    Changed,
    /// Another command wrote it.
    Other(String),
}

impl Obstacle {
    fn gives_way_to_force(&self) -> bool {
        !matches!(
            self,
            Self::Input | Self::Irregular | Self::Linked | Self::Elsewhere
        )
    }

    fn describe(&self) -> String {
        match self {
            Self::Input => "is read by this command and is never replaced".to_owned(),
            Self::Irregular => "is not a regular file".to_owned(),
            Self::Linked => "is a link, and results stay in their own folder".to_owned(),
            Self::Elsewhere => "is on another file system than the folder it is in".to_owned(),
            Self::There => "already exists".to_owned(),
            Self::Foreign => "is not recorded as written by tilebind".to_owned(),
            Self::Changed => "was changed since tilebind wrote it".to_owned(),
            Self::Other(command) => format!("is a result of `tilebind {command}`"),
        }
    }
}

/// The destination of a command's files.
#[derive(Clone, Debug)]
pub struct Output {
    command: &'static Command,
    folder: PathBuf,
    /// The single file, if it is not a results folder.
    file: Option<PathBuf>,
    inputs: Vec<PathBuf>,
    force: bool,
    recorded: bool,
}

impl Output {
    /// A results folder; created if missing.
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

    /// A single file; its folder is created if missing.
    ///
    /// # Errors
    /// If the path does not name a file.
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

    /// Adds input files, which are never replaced.
    pub fn reading(mut self, inputs: impl IntoIterator<Item = PathBuf>) -> Self {
        self.inputs.extend(inputs);
        self
    }

    /// With `force`, replaces files in the way: files that tilebind did not write, that changed
    /// since, and those of other commands.
    pub fn forced(self, force: bool) -> Self {
        Self { force, ..self }
    }

    /// Keeps no record: written files belong to the user from then on.
    pub fn unrecorded(self) -> Self {
        Self {
            recorded: false,
            ..self
        }
    }

    /// Checks, before any work is done, that the folder is writable and that nothing is in the way
    /// of files that the command may write, according to `may_come`. Nothing is written.
    ///
    /// # Errors
    /// See [`OutputError`].
    pub fn check(&self, may_come: impl Fn(&str) -> bool) -> Result<(), OutputError> {
        folder::check(&self.folder)?;
        // With the lock held: files and record of other processes belong together.
        let _alone = staging::settle(&self.folder)?;
        let mut names: Vec<String> = self.file_name().into_iter().collect();
        let folders = self.command.folders().filter(|_| self.file.is_none());
        for inner in folders {
            let folder = match inner {
                "" => self.folder.clone(),
                _ => self.folder.join(inner),
            };
            check_inner(&self.folder, Path::new(inner))?;
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

    /// Whether a file of this name is an input of the command.
    pub fn reads(&self, name: &str) -> bool {
        self.is_input(&self.path(name))
    }

    /// Whether this path is one of the folder's files that the command may write.
    pub fn may_write(&self, file: &Path) -> bool {
        let folder = file.parent().zip(file.file_name());
        let place = folder.map(|(folder, name)| resolved(folder).join(name));
        let place = place.unwrap_or_default();
        let name = place.strip_prefix(resolved(&self.folder));
        name.is_ok_and(|name| self.command.writes(&name.to_string_lossy()))
    }

    /// Writes a folder's files, replacing those that the command wrote before.
    ///
    /// # Errors
    /// See [`OutputError`]; all files are then unchanged.
    pub fn write(&self, files: &Files) -> Result<(), OutputError> {
        drop(staging::settle(&self.folder)?);
        let staging = Staging::open(&self.folder)?;
        let record = self.refuse(files.keys().map(String::as_str))?;
        let stale = self.stale(&record, files);
        for (name, content) in files {
            staging.add(&self.place(name), content)?;
        }
        let noted = self.recorded.then(|| {
            let new = record.with(self.command.name, files, |name| self.path(name));
            let settled = new.settled(&self.folder, files, &stale);
            Noted::stage(&staging, &self.folder, [&new, &settled])
        });
        let noted = noted.transpose()?;
        // First, so that every file is always in the record.
        if let Some(noted) = &noted {
            noted.begin()?;
        }
        let (old, new) = self.moves(&stale, files);
        let exchanged = staging.exchange(&old, &new);
        if let Some(noted) = &noted {
            noted.end(exchanged.is_ok());
        }
        // This does not remove a folder that is not empty.
        for emptied in stale.iter().filter_map(|name| name.rsplit_once('/')) {
            let _ = fs::remove_dir(self.folder.join(emptied.0));
        }
        exchanged
    }

    /// Writes a single file.
    ///
    /// # Errors
    /// See [`OutputError`]; everything is then unchanged.
    pub fn write_file(&self, content: impl Into<Vec<u8>>) -> Result<(), OutputError> {
        let content = content.into();
        let name = self.file_name().into_iter();
        self.write(&name.map(|name| (name, content.clone())).collect())
    }

    /// The name of the single file, as in the record.
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

    /// The files to move out of their places and those to move in, in order.
    fn moves(&self, stale: &[String], files: &Files) -> (Vec<PathBuf>, Vec<PathBuf>) {
        // A report is moved out first and moved in last: if it exists, the others do too.
        let mut new: Vec<&String> = files.keys().collect();
        new.sort_by_key(|name| *name == "report.json");
        let taken = new.iter().rev().filter(|name| is_there(&self.path(name)));
        let old = taken.copied().chain(stale);
        let old = match files.len() {
            // A single file simply replaces the old one.
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
            false => Ok(Record::default()),
        };
        let mut in_the_way: Vec<(PathBuf, Obstacle)> = Vec::new();
        let record = read.unwrap_or_else(|obstacle| {
            if !self.force || !obstacle.gives_way_to_force() || self.is_input(&path) {
                in_the_way.push((path, obstacle));
            }
            Record::default()
        });
        in_the_way.extend(names.filter_map(|name| {
            let (path, obstacle) = self.obstacle(&record, name)?;
            let gives_way = self.force && obstacle.gives_way_to_force();
            (!gives_way).then_some((path, obstacle))
        }));
        // Obstacles that `force` cannot override come first.
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
            None => (ANOTHER_FOLDER, "what is in the way"),
        };
        let help = match obstacle.gives_way_to_force() {
            true => format!("{other}, or replace {what} with --force"),
            false => other.to_owned(),
        };
        Err(refusal(
            first,
            &format!("{}{more}", obstacle.describe()),
            &help,
        ))
    }

    fn obstacle(&self, record: &Record, name: &str) -> Option<(PathBuf, Obstacle)> {
        let place = self.place(name);
        let outside = place
            .parent()
            .and_then(|inner| way_out(&self.folder, inner));
        if outside.is_some() {
            return outside;
        }
        let path = self.folder.join(place);
        let obstacle = self.obstacle_at(record, name, &path)?;
        Some((path, obstacle))
    }

    fn obstacle_at(&self, record: &Record, name: &str, path: &Path) -> Option<Obstacle> {
        let found = path.symlink_metadata().ok()?;
        if self.is_input(path) {
            return Some(Obstacle::Input);
        }
        if !found.is_file() && !found.is_symlink() {
            return Some(Obstacle::Irregular);
        }
        // A link was made by somebody else. If it is replaced, its target is not touched.
        let writer = record.writer(name).filter(|_| found.is_file());
        let Some(writer) = writer else {
            return Some(match self.recorded {
                true => Obstacle::Foreign,
                false => Obstacle::There,
            });
        };
        if !record.has(name, path) {
            return Some(Obstacle::Changed);
        }
        (writer != self.command.name).then(|| Obstacle::Other(writer.to_owned()))
    }

    fn is_input(&self, path: &Path) -> bool {
        let file = identity(path);
        file.is_some() && self.inputs.iter().any(|input| identity(input) == file)
    }

    /// Unchanged earlier results of the command that are not written again.
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

/// The advice where a folder cannot take results.
const ANOTHER_FOLDER: &str = "name another folder";

/// The error of a file or folder in the way.
fn refusal(path: &Path, told: &str, help: &str) -> OutputError {
    OutputError::Refused(format!("{} {told}\n  help: {help}", path.display()))
}

/// Where files of `inner`, within a folder, would not stay in it.
fn way_out(folder: &Path, inner: &Path) -> Option<(PathBuf, Obstacle)> {
    let inner = inner.ancestors().filter(|it| !it.as_os_str().is_empty());
    inner.into_iter().find_map(|inner| {
        let path = folder.join(inner);
        let obstacle = match path.symlink_metadata().ok()? {
            found if found.is_symlink() => Obstacle::Linked,
            _ if device(&path) != device(or_here(folder)) => Obstacle::Elsewhere,
            _ => return None,
        };
        Some((path, obstacle))
    })
}

/// Checks that files can be written to `inner`, within a folder; see [`Output::check`].
///
/// # Errors
/// If it cannot be created or written to, or leads elsewhere.
pub fn check_inner(folder: &Path, inner: &Path) -> Result<(), OutputError> {
    match way_out(folder, inner) {
        Some((path, obstacle)) => Err(refusal(&path, &obstacle.describe(), ANOTHER_FOLDER)),
        None => folder::check(&folder.join(inner)),
    }
}

/// Writes an internal file and syncs it: it is complete or absent, whatever happens. `name` is
/// relative to the folder; its own folder is created if missing.
///
/// # Errors
/// See [`OutputError`].
pub fn keep(folder: &Path, name: &str, content: &[u8]) -> Result<(), OutputError> {
    let (name, path) = (Path::new(name), folder.join(name));
    if let Some((path, obstacle)) = name.parent().and_then(|inner| way_out(folder, inner)) {
        return Err(refusal(&path, &obstacle.describe(), ANOTHER_FOLDER));
    }
    let staging = Staging::open(folder)?;
    let staged = staging.add(name, content)?;
    let synced = fs::File::open(staged).and_then(|staged| staged.sync_all());
    synced.map_err(OutputError::of_file(&path))?;
    staging.exchange(&[], &[name.to_owned()])?;
    // The new name should also survive a power cut; not every file system can sync a folder.
    if let Some(Ok(folder)) = path.parent().map(fs::File::open) {
        let _ = folder.sync_all();
    }
    Ok(())
}

/// Whether this name exists, also as a dangling link.
fn is_there(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

/// The absolute path of a folder, without links as far as it exists.
fn resolved(folder: &Path) -> PathBuf {
    let folder = std::path::absolute(or_here(folder)).unwrap_or_else(|_| folder.to_owned());
    let mut place = PathBuf::new();
    for part in folder.components() {
        match part {
            Component::ParentDir => drop(place.pop()),
            part => place.push(part),
        }
        place = place.canonicalize().unwrap_or(place);
    }
    place
}

/// The identity of a file, independent of the path; `None` if it does not exist.
#[cfg(unix)]
fn identity(path: &Path) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    let found = path.metadata().ok()?;
    Some((found.dev(), found.ino()))
}

/// The file system of a file, where it can be known.
#[cfg(unix)]
fn device(path: &Path) -> Option<u64> {
    Some(identity(path)?.0)
}

/// The identity of a file, independent of the path; `None` if it does not exist.
#[cfg(not(unix))]
fn identity(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok()
}

/// The file system of a file, where it can be known.
#[cfg(not(unix))]
fn device(_: &Path) -> Option<u64> {
    None
}

/// The empty path means the current folder.
fn or_here(path: &Path) -> &Path {
    match path.as_os_str().is_empty() {
        true => Path::new("."),
        false => path,
    }
}
