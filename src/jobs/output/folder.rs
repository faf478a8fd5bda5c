//! Errors of folders that cannot be written to.

use std::ffi::OsStr;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

use super::{OutputError, or_here};

/// Checks that files can be written to a folder, before any work is done. It creates neither the
/// folder nor any file in it.
///
/// # Errors
/// If it cannot be created or written to.
pub fn check(folder: &Path) -> Result<(), OutputError> {
    let folder = or_here(folder);
    let refused = |source: io::Error| OutputError::Folder {
        path: folder.to_owned(),
        source,
    };
    for ancestor in folder.ancestors() {
        let path = or_here(ancestor);
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => {
                let missing = folder.strip_prefix(ancestor).unwrap_or(Path::new(""));
                let possible = missing.iter().try_for_each(|name| possible(path, name));
                return possible.and_then(|()| try_to_write(path)).map_err(refused);
            }
            Ok(_) => {
                let (folder, file) = (folder.display(), path.display());
                return Err(OutputError::Refused(format!(
                    "cannot write to the folder {folder}: {file} is a file\n  help: name a folder"
                )));
            }
            Err(error) => match error.kind() {
                // A dangling link also exists.
                ErrorKind::NotFound if path.symlink_metadata().is_err() => {}
                ErrorKind::NotADirectory => {}
                _ => return Err(refused(error)),
            },
        }
    }
    Ok(())
}

/// Whether a folder can contain such a name: not one of a thousand letters.
fn possible(folder: &Path, name: &OsStr) -> io::Result<()> {
    match folder.join(name).symlink_metadata() {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// Writes a file in a folder and removes it.
fn try_to_write(folder: &Path) -> io::Result<()> {
    match fs::remove_dir_all(super::staging::make_place(folder)?) {
        // Another process may have removed it as a leftover.
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}
