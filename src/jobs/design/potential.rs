//! The section `[potential]`: how magnets are modelled.

use super::error::Result;
use super::reader::Section;
use physics::potential::MagnetModel;

pub(super) fn read(root: &Section) -> Result<MagnetModel> {
    let Some(section) = root.section("potential", "[potential]")? else {
        return Ok(MagnetModel::default());
    };
    section.allow(&["model"]);
    let Some(entry) = section.get("model") else {
        return Ok(MagnetModel::default());
    };
    entry.word(&MagnetModel::NAMES)
}
