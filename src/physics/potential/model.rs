//! How magnets are modelled.

/// How magnets are modelled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MagnetModel {
    /// Point dipoles at the blocks' centres.
    Dipole,
    /// Uniformly magnetised blocks: what magnets are, and what is taken where nothing is said.
    #[default]
    Cuboid,
}

impl MagnetModel {
    /// What design files call each model.
    pub const NAMES: [(&'static str, Self); 2] =
        [("dipole", Self::Dipole), ("cuboid", Self::Cuboid)];

    /// What a reader calls magnets of this model: `dipoles`, `blocks`.
    pub fn plural(self) -> &'static str {
        match self {
            Self::Dipole => "dipoles",
            Self::Cuboid => "blocks",
        }
    }

    /// What design files call this model.
    pub fn name(self) -> &'static str {
        let own = Self::NAMES.iter().find(|(_, model)| *model == self);
        own.expect("all are named").0
    }
}
