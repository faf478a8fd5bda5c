//! Temporary files on the way to their final places.

use std::cell::{Cell, RefCell};
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::record::{self, Record};
use super::{OutputError, identity, is_there, or_here};

/// The staging folder is called `.tilebind-PROCESS-NUMBER.partial`.
const PREFIX: &str = ".tilebind-";
const SUFFIX: &str = ".partial";

/// Its contents: a file that marks it as this program's;
const MARK: &str = "0";
const MARKED: &[u8] = b"tilebind";
/// new files, by their final names;
const NEW: &str = "new";
/// old files that were moved out of their places, while others remain to be moved;
const OLD: &str = "old";
/// the same once all have been moved: from then on the new ones are moved in;
const GONE: &str = "gone";
/// and the records of the folder, from before the exchange until after it.
pub(super) const RECORDS: [&str; 3] = ["before", "during", "after"];

/// How long to wait for another process that writes into the same folder.
const PATIENCE: Duration = Duration::from_secs(60);
/// The interval of checking for that process.
const BLINK: Duration = Duration::from_millis(5);

/// A staging folder inside the results folder, on the same file system. Only one process at a time
/// has one, if the file system supports locks. When dropped, it is removed with its contents, and
/// with folders that were created in vain.
pub(super) struct Staging {
    folder: PathBuf,
    place: PathBuf,
    /// Whether it contains the only copy of a file.
    is_needed: Cell<bool>,
    /// Folders that were created, outer ones first.
    made: RefCell<Vec<PathBuf>>,
    /// Released when it is closed.
    _lock: Option<File>,
}

impl Staging {
    /// Creates the folder, and waits for other processes to finish.
    pub fn open(folder: &Path) -> Result<Self, OutputError> {
        let folder = or_here(folder);
        let mut made = Vec::new();
        let lock = make_alone(folder, &mut made).map_err(refused(folder))?;
        let mut staging = Self {
            folder: folder.to_owned(),
            place: PathBuf::new(),
            is_needed: Cell::new(false),
            made: made.into(),
            _lock: lock,
        };
        staging.place = make_place(folder).map_err(refused(folder))?;
        Ok(staging)
    }

    /// Stages a file for this name in the folder.
    pub fn add(&self, name: &Path, content: &[u8]) -> Result<PathBuf, OutputError> {
        let staged = self.place.join(NEW).join(name);
        make_parent(&staged)
            .and_then(|()| fs::write(&staged, content))
            .map_err(OutputError::of_file(&self.folder.join(name)))?;
        Ok(staged)
    }

    /// Stages a file that the caller will rename to `path`.
    pub fn add_apart(
        &self,
        name: &str,
        content: &[u8],
        path: &Path,
    ) -> Result<PathBuf, OutputError> {
        let staged = self.place.join(name);
        fs::write(&staged, content).map_err(OutputError::of_file(path))?;
        Ok(staged)
    }

    /// Moves the old files out of their places and the staged ones in, so that old and new files
    /// are never mixed. If that fails, everything is restored.
    pub fn exchange(&self, old: &[PathBuf], new: &[PathBuf]) -> Result<(), OutputError> {
        for name in new {
            let path = self.folder.join(name);
            let folder = path.parent().unwrap_or(&path);
            make(folder, &mut self.made.borrow_mut()).map_err(refused(folder))?;
        }
        let [staged, aside, gone] = [NEW, OLD, GONE].map(|it| self.place.join(it));
        // A single file is only moved into its place.
        let is_set = !old.is_empty() || new.len() > 1;
        if is_set {
            fs::create_dir(&aside).map_err(refused(&self.place))?;
        }
        for name in old {
            make_parent(&aside.join(name)).map_err(refused(&self.place))?;
        }
        let out = old
            .iter()
            .map(|name| (self.folder.join(name), aside.join(name)));
        let then = is_set.then(|| (aside.clone(), gone));
        let into = new
            .iter()
            .map(|name| (staged.join(name), self.folder.join(name)));
        let moves: Vec<(PathBuf, PathBuf)> = out.chain(then).chain(into).collect();
        for (done, (from, to)) in moves.iter().enumerate() {
            if let Err(error) = fs::rename(from, to) {
                let mut back = moves[..done].iter().rev();
                let put_back = back.all(|(from, to)| fs::rename(to, from).is_ok());
                self.is_needed.set(!put_back);
                let theirs = if done < old.len() { from } else { to };
                return Err(OutputError::of_file(theirs)(error));
            }
        }
        Ok(())
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        if !self.is_needed.get() {
            let _ = fs::remove_dir_all(&self.place);
        }
        // This removes nothing from a folder that is not empty.
        for folder in self.made.borrow().iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Creates a folder and its parents, and notes which were missing.
fn make(folder: &Path, made: &mut Vec<PathBuf>) -> io::Result<()> {
    let missing = folder.ancestors().take_while(|it| !or_here(it).exists());
    let missing: Vec<PathBuf> = missing.map(Path::to_owned).collect();
    made.extend(missing.into_iter().rev());
    fs::create_dir_all(folder)
}

/// A folder that another process removes as soon as it is created is created this often at most.
const MOST_TRIES: usize = 20;

/// Creates a folder and locks it; `None` if the file system has no locks.
fn make_alone(folder: &Path, made: &mut Vec<PathBuf>) -> io::Result<Option<File>> {
    let mut tries = 0;
    loop {
        match make(folder, made).and_then(|()| hold(folder)) {
            // A process that failed removed the folder that it had created.
            Err(error) if error.kind() == ErrorKind::NotFound && tries < MOST_TRIES => tries += 1,
            held => return held,
        }
    }
}

/// Cleans up what killed processes left in a folder. Nobody else writes into the folder until the
/// returned lock is dropped.
pub(super) fn settle(folder: &Path) -> Result<Option<File>, OutputError> {
    let folder = or_here(folder);
    let held = match hold(folder) {
        Err(error) if error.kind() == ErrorKind::WouldBlock => return Err(refused(folder)(error)),
        held => held.ok().flatten(),
    };
    if held.is_some() {
        settle_leftovers(folder);
    }
    Ok(held)
}

/// Locks a folder; `None` if the file system has no locks.
fn hold(folder: &Path) -> io::Result<Option<File>> {
    let start = Instant::now();
    loop {
        folder.metadata()?;
        let Ok(held) = File::open(folder) else {
            return Ok(None);
        };
        match held.try_lock() {
            Ok(()) if is_at(&held, folder) => return Ok(Some(held)),
            Ok(()) => {}
            Err(TryLockError::WouldBlock) if start.elapsed() < PATIENCE => {
                std::thread::sleep(BLINK);
            }
            Err(TryLockError::WouldBlock) => {
                let message = "another process has been writing to it for a minute";
                return Err(io::Error::new(ErrorKind::WouldBlock, message));
            }
            Err(TryLockError::Error(_)) => return Ok(None),
        }
    }
}

fn refused(folder: &Path) -> impl Fn(io::Error) -> OutputError {
    let path = folder.to_owned();
    move |source| OutputError::Folder {
        path: path.clone(),
        source,
    }
}

/// Whether an open folder is still the one of that name.
#[cfg(unix)]
fn is_at(held: &File, folder: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let held = held.metadata().ok().map(|it| (it.dev(), it.ino()));
    held.is_some() && held == identity(folder)
}

/// Always true: on this system an open folder cannot be removed.
#[cfg(not(unix))]
fn is_at(_: &File, folder: &Path) -> bool {
    identity(folder).is_some()
}

/// Creates the parent folder of a file.
fn make_parent(path: &Path) -> io::Result<()> {
    path.parent().map_or(Ok(()), fs::create_dir_all)
}

/// Creates a unique staging folder, with its mark.
pub(super) fn make_place(folder: &Path) -> io::Result<PathBuf> {
    let process = std::process::id();
    let (mut number, mut tries) = (0, 0);
    loop {
        let place = folder.join(format!("{PREFIX}{process}-{number}{SUFFIX}"));
        match fs::create_dir(&place) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => number += 1,
            made => {
                let marked = made.and_then(|()| fs::write(place.join(MARK), MARKED));
                if marked.is_err() {
                    let _ = fs::remove_file(place.join(MARK));
                    let _ = fs::remove_dir(&place);
                }
                match &marked {
                    // Without its mark it was empty: another process removed it as a leftover.
                    Err(error) if error.kind() == ErrorKind::NotFound && tries < MOST_TRIES => {
                        tries += 1
                    }
                    _ => return marked.map(|()| place),
                }
            }
        }
    }
}

/// Finishes or reverts the exchanges of killed processes; requires the lock. Only files that the
/// record lists with their checksums are moved.
fn settle_leftovers(folder: &Path) {
    let record = Record::read(&folder.join(record::NAME)).unwrap_or_default();
    for place in folders(folder) {
        if is_ours(&place) {
            move_where_free(&place.join(OLD), folder, &record);
            if is_folder(&place.join(GONE)) {
                move_where_free(&place.join(NEW), folder, &record);
            }
            remove(&place, &record);
            continue;
        }
        // In results folders this only tests whether they are writable.
        let is_probe = |place: &PathBuf| is_ours(place) && files(place) == [Path::new(MARK)];
        let probes = folders(&place).filter(is_probe);
        probes.for_each(|probe| remove(&probe, &Record::default()));
    }
}

/// Removes what this program left in a staging folder, and the folder if nothing else is there. The
/// only copy of an old file is kept, as are files of others.
fn remove(place: &Path, record: &Record) {
    let is_marked = is_marked(place);
    let is_committed = is_folder(&place.join(GONE));
    let is_ours = |name: &Path| {
        let path = place.join(name);
        let mut parts = name.iter().map(|part| part.to_string_lossy());
        let first = parts.next().unwrap_or_default();
        let name = name.strip_prefix(&*first).unwrap_or(name);
        match &*first {
            NEW => (is_marked && !is_committed) || record.moved(name, &path),
            GONE => record.moved(name, &path),
            MARK => is_marked,
            other => is_marked && RECORDS.contains(&other),
        }
    };
    // The mark is the first name, and goes last.
    for name in files(place).into_iter().rev().filter(|name| is_ours(name)) {
        let _ = fs::remove_file(place.join(name));
    }
    remove_empty(place);
}

/// Whether a staging folder has its mark, or the beginning of it.
fn is_marked(place: &Path) -> bool {
    let mark = place.join(MARK);
    let is_file = mark.symlink_metadata().is_ok_and(|found| found.is_file());
    is_file && fs::read(mark).is_ok_and(|mark| MARKED.starts_with(&mark))
}

/// The folders in a folder; links are none.
fn folders(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let folders = entries.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()));
    folders.map(|entry| entry.path())
}

/// The names of everything but folders in a folder, relative to it and sorted. Links are not
/// followed.
fn files(folder: &Path) -> Vec<PathBuf> {
    fn add(folder: &Path, inner: &Path, files: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let name = inner.join(entry.file_name());
            match entry.file_type() {
                Ok(kind) if kind.is_dir() => add(&entry.path(), &name, files),
                _ => files.push(name),
            }
        }
    }
    let mut files = Vec::new();
    if is_folder(folder) {
        add(folder, Path::new(""), &mut files);
    }
    files.sort_unstable();
    files
}

/// Whether this is a folder, and not a link to one.
fn is_folder(path: &Path) -> bool {
    path.symlink_metadata().is_ok_and(|found| found.is_dir())
}

/// Removes a folder if there are no files in it.
fn remove_empty(folder: &Path) {
    folders(folder).for_each(|inner| remove_empty(&inner));
    let _ = fs::remove_dir(folder);
}

/// Whether a folder has the name of a staging folder.
fn is_ours(folder: &Path) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|c| c.is_ascii_digit());
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let inner = name
        .strip_prefix(PREFIX)
        .and_then(|name| name.strip_suffix(SUFFIX));
    let numbers = inner.and_then(|inner| inner.split_once('-'));
    numbers.is_some_and(|(process, number)| is_number(process) && is_number(number))
}

/// Moves the files that this program moved into a folder on to another one, without overwriting and
/// without following links.
fn move_where_free(from: &Path, to: &Path, record: &Record) {
    for name in files(from) {
        let (from, place) = (from.join(&name), to.join(&name));
        let inner = name.ancestors().skip(1);
        let mut inner = inner.filter(|it| !it.as_os_str().is_empty());
        let stays = inner.all(|it| is_folder(&to.join(it)) || !is_there(&to.join(it)));
        if stays && !is_there(&place) && record.moved(&name, &from) {
            let _ = make_parent(&place).and_then(|()| fs::rename(from, place));
        }
    }
}
