//! Temporary files on the way to their final places.

use std::cell::{Cell, RefCell};
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::{OutputError, identity, is_there, or_here};

/// The folder of files on their way is called `.tilebind-PROCESS-NUMBER.partial`.
const PREFIX: &str = ".tilebind-";
const SUFFIX: &str = ".partial";

/// What is in it: new files, by their later names;
const NEW: &str = "new";
/// old files that were taken out of their places, while there are others to be taken out;
const OLD: &str = "old";
/// the same once they all were: from then on new ones take their places.
const GONE: &str = "gone";

/// How long another process may take to write into the same folder.
const PATIENCE: Duration = Duration::from_secs(60);
/// How often it is looked whether it is done.
const BLINK: Duration = Duration::from_millis(5);

/// A place for files beside the folder's own, on the same file system. One process at a time has one
/// in a folder, where the file system has locks. It goes with all that is still in it, and with the
/// folders that were made in vain.
pub(super) struct Staging {
    folder: PathBuf,
    place: PathBuf,
    /// Whether something is in it that nobody else has.
    is_needed: Cell<bool>,
    /// Folders that were not there, outer ones first.
    made: RefCell<Vec<PathBuf>>,
    /// Released when it is closed.
    _lock: Option<File>,
}

impl Staging {
    /// Makes the folder, and waits for other processes to finish theirs.
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

    /// Writes a file that is to be in the folder by this name.
    pub fn add(&self, name: &Path, content: &[u8]) -> Result<PathBuf, OutputError> {
        let staged = self.place.join(NEW).join(name);
        make_parent(&staged)
            .and_then(|()| fs::write(&staged, content))
            .map_err(OutputError::of_file(&self.folder.join(name)))?;
        Ok(staged)
    }

    /// Writes a file beside them, to be renamed by the caller to `path`.
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

    /// Takes the old files out of their places and puts the new ones, which were added, into theirs;
    /// so there never are old and new ones together. Where that fails all are put back.
    pub fn exchange(&self, old: &[PathBuf], new: &[PathBuf]) -> Result<(), OutputError> {
        for name in new {
            let path = self.folder.join(name);
            let folder = path.parent().unwrap_or(&path);
            make(folder, &mut self.made.borrow_mut()).map_err(refused(folder))?;
        }
        let [staged, aside, gone] = [NEW, OLD, GONE].map(|it| self.place.join(it));
        // Nothing else is done to a single file but to put it into its place.
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
        // Of a folder that is not empty this takes nothing away.
        for folder in self.made.borrow().iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Makes a folder with those that it is in, and notes which were not there.
fn make(folder: &Path, made: &mut Vec<PathBuf>) -> io::Result<()> {
    let missing = folder.ancestors().take_while(|it| !or_here(it).exists());
    let missing: Vec<PathBuf> = missing.map(Path::to_owned).collect();
    made.extend(missing.into_iter().rev());
    fs::create_dir_all(folder)
}

/// Makes a folder and has it alone; `None` if the file system has no locks.
fn make_alone(folder: &Path, made: &mut Vec<PathBuf>) -> io::Result<Option<File>> {
    let mut tries = 0;
    loop {
        match make(folder, made).and_then(|()| hold(folder)) {
            // A process that gave up has taken the folder away that it had made.
            Err(error) if error.kind() == ErrorKind::NotFound && tries < 20 => tries += 1,
            held => return held,
        }
    }
}

/// Settles what killed processes left in a folder, which nobody else writes into until what is
/// returned goes.
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

/// Has a folder alone; `None` if the file system has no locks.
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

/// Whether an open folder still is the one of that name.
#[cfg(unix)]
fn is_at(held: &File, folder: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let held = held.metadata().ok().map(|it| (it.dev(), it.ino()));
    held.is_some() && held == identity(folder)
}

/// Whether an open folder still is the one of that name: elsewhere it cannot be removed.
#[cfg(not(unix))]
fn is_at(_: &File, folder: &Path) -> bool {
    identity(folder).is_some()
}

/// Makes the folder that a file is to be in.
fn make_parent(path: &Path) -> io::Result<()> {
    path.parent().map_or(Ok(()), fs::create_dir_all)
}

/// Makes the folder of files on their way, which nobody else has.
pub(super) fn make_place(folder: &Path) -> io::Result<PathBuf> {
    let process = std::process::id();
    let mut number = 0;
    loop {
        let place = folder.join(format!("{PREFIX}{process}-{number}{SUFFIX}"));
        match fs::create_dir(&place) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => number += 1,
            made => return made.map(|()| place),
        }
    }
}

/// Finishes what killed processes began, or puts back what they had taken out; for when nobody else
/// writes.
fn settle_leftovers(folder: &Path) {
    for place in folders(folder) {
        if is_ours(&place) {
            move_where_free(&place.join(OLD), folder);
            if place.join(GONE).exists() {
                move_where_free(&place.join(NEW), folder);
            }
            let _ = fs::remove_dir_all(place);
            continue;
        }
        // In folders of results it is only tried whether one can write there.
        let probes = folders(&place).filter(|probe| is_ours(probe));
        for probe in
            probes.filter(|probe| ![NEW, OLD, GONE].iter().any(|it| probe.join(it).exists()))
        {
            let _ = fs::remove_dir_all(probe);
        }
    }
}

/// The folders in a folder.
fn folders(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let folders = entries.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()));
    folders.map(|entry| entry.path())
}

/// Whether a folder has the name of those of files on their way.
fn is_ours(folder: &Path) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|c| c.is_ascii_digit());
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let inner = name
        .strip_prefix(PREFIX)
        .and_then(|name| name.strip_suffix(SUFFIX));
    let numbers = inner.and_then(|inner| inner.split_once('-'));
    numbers.is_some_and(|(process, number)| is_number(process) && is_number(number))
}

/// Moves all files of a folder into another one, but where something is already.
fn move_where_free(from: &Path, to: &Path) {
    for entry in fs::read_dir(from).into_iter().flatten().flatten() {
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            let _ = fs::create_dir(&to);
            move_where_free(&from, &to);
        } else if !is_there(&to) {
            let _ = fs::rename(from, to);
        }
    }
}
