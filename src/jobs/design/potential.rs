//! The section `[potential]`: how magnets are modelled.
//!
//! The default of a design is blocks, since real magnets are blocks. The default of a set of words
//! is the paper's dipoles, with which words are searched.

use super::error::Result;
use super::reader::Section;
use physics::potential::MagnetModel;

/// The model stated in the file, or else `silent`.
pub(super) fn read(root: &Section, silent: MagnetModel) -> Result<MagnetModel> {
    let Some(section) = root.section("potential", "[potential]")? else {
        return Ok(silent);
    };
    section.allow(&["model"]);
    let Some(entry) = section.get("model") else {
        return Ok(silent);
    };
    entry.word(&MagnetModel::NAMES)
}
