//! The section `[potential]`: how magnets are modelled.
//!
//! A design that says nothing has blocks, which is what magnets are. A set of words that says nothing
//! has the paper's dipoles, by which words are searched.

use super::error::Result;
use super::reader::Section;
use physics::potential::MagnetModel;

/// The model that the file says, `silent` where it says none.
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
