//! The files that designs and drawings are read from.

use std::io::{Error, Read, Result};
use std::path::Path;

use crate::text::{decode, open};

/// Largest size of a file (bytes).
const LARGEST: u64 = 16 << 20;

/// The bytes of a regular file.
///
/// # Errors
/// If there is no such file, or it is not regular, too large or not readable.
pub(super) fn read(path: &Path) -> Result<Vec<u8>> {
    // The size is limited here as well: a file may grow, and files in /proc claim to be empty.
    let mut bytes = Vec::new();
    open(path)?.take(LARGEST + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LARGEST {
        let message = format!("it is larger than {} MB", LARGEST >> 20);
        return Err(Error::other(message));
    }
    Ok(bytes)
}

/// The text of a regular file.
///
/// # Errors
/// As for [`read`], or if the bytes are not text.
pub(crate) fn read_text(path: &Path) -> Result<String> {
    decode(read(path)?).map_err(Error::other)
}

/// Whether a file is in a folder or below it, with links resolved.
pub(super) fn is_below(path: &Path, folder: &Path) -> bool {
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let (path, folder) = (path.canonicalize(), folder.canonicalize());
    matches!((path, folder), (Ok(path), Ok(folder)) if path.starts_with(&folder))
}
