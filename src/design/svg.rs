//! Profiles drawn in an SVG file: named by the design file's grammar, not read yet.

use super::DesignError;
use super::reader::Section;

/// The fault of a profile with `shape = "svg"`.
pub(super) fn refused(section: &Section) -> DesignError {
    let message = "profiles from SVG files are not supported yet";
    let help = "draw the line as shape = \"points\" with points = [[s, h], ...] in metres";
    match section.get("shape") {
        Some(entry) => entry.error(message, help),
        None => section.error(message, help),
    }
}
