//! The section `[potential]`: how magnets are modelled.

use super::reader::{Result, Section};

/// How magnets are modelled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MagnetModel {
    /// Point dipoles at the blocks' centres.
    #[default]
    Dipole,
    /// Uniformly magnetised blocks.
    Cuboid,
}

impl MagnetModel {
    /// What the design file calls each model.
    pub const NAMES: [(&'static str, Self); 2] =
        [("dipole", Self::Dipole), ("cuboid", Self::Cuboid)];

    /// What the design file calls this model.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dipole => "dipole",
            Self::Cuboid => "cuboid",
        }
    }
}

pub(super) fn read(root: &Section) -> Result<MagnetModel> {
    let Some(section) = root.section("potential", "[potential]")? else {
        return Ok(MagnetModel::default());
    };
    section.allow(&["model"])?;
    let Some(entry) = section.get("model") else {
        return Ok(MagnetModel::default());
    };
    entry.word(&MagnetModel::NAMES)
}
